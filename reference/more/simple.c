/* more/simple.c: diffuse transmission, and thin glass (pbrt book 9.1.2, 9.5). */
#include "more.h"

/* Diffuse on both sides: one colour comes back, another goes through. */
spectrum diffuse_transmission_value(const bsdf *b, vector wo, vector wi, double *density) {
  bool reflects = wo.z * wi.z > 0;
  double r = largest(b->reflectance), t = largest(b->more.transmittance);
  if (r + t > 0) *density = (reflects ? r : t) / (r + t) * fabs(wi.z) / PI;
  return scaled(fabs(wi.z) / PI, reflects ? b->reflectance : b->more.transmittance);
}

bool sample_diffuse_transmission(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  double r = largest(b->reflectance), t = largest(b->more.transmittance);
  bool reflects = next_number(s) * (r + t) < r;
  result->wi = face_forward(sample_cosine_hemisphere(s), make_vector(0, 0, reflects ? wo.z : -wo.z));
  return r + t > 0;
}

/* Two parallel faces: light that enters is reflected between them any number of times. Of that, R + T R T + T R R R T +
 * ... = R + T^2 R / (1 - R^2) comes back, and the rest goes straight on. */
void sample_thin_glass(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  double r = reflected_by_glass(fabs(wo.z), b->ior);
  if (r < 1) r += square(1 - r) * r / (1 - square(r));
  result->specular = true;
  bool reflects = next_number(s) < r;
  result->wi = make_vector(-wo.x, -wo.y, reflects ? wo.z : -wo.z);
}
