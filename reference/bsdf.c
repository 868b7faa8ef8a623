/* bsdf.c: the kinds of BSDFs by name, and the simplest of them. */
#include "bsdf.h"

/* A diffuse surface looks equally bright from everywhere: f = reflectance / pi, on the side that the light comes from.
 */
spectrum diffuse_value(const bsdf *b, vector wo, vector wi, double *density) {
  if (wo.z * wi.z <= 0) {
    *density = 0;
    return gray(0);
  }
  *density = fabs(wi.z) / PI;
  return scaled(fabs(wi.z) / PI, b->reflectance);
}

bool sample_diffuse(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  vector wi = sample_cosine_hemisphere(s);
  if (wo.z < 0) wi.z = -wi.z;
  result->wi = wi;
  result->density = fabs(wi.z) / PI;
  result->weight = b->reflectance; /* f cos / density */
  result->specular = false;
  result->transmitted = false;
  return wi.z != 0;
}

spectrum bsdf_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density) {
  vector o = to_local(b->frame, wo);
  vector i = to_local(b->frame, wi);
  switch (b->kind) {
    case BSDF_DIFFUSE: return diffuse_value(b, o, i, density);
    case BSDF_CONDUCTOR: return conductor_value(b, o, i, density);
    case BSDF_DIELECTRIC: return dielectric_value(b, o, i, density);
    case BSDF_COATED_DIFFUSE: return coated_value(b, o, i, s, density);
  }
  *density = 0;
  return gray(0);
}

bool sample_bsdf(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  vector o = to_local(b->frame, wo);
  bool found = false;
  if (o.z == 0) return false;
  switch (b->kind) {
    case BSDF_DIFFUSE: found = sample_diffuse(b, o, s, result); break;
    case BSDF_CONDUCTOR: found = sample_conductor(b, o, s, result); break;
    case BSDF_DIELECTRIC: found = sample_dielectric(b, o, s, result); break;
    case BSDF_COATED_DIFFUSE: found = sample_coated(b, o, s, result); break;
  }
  if (!found) return false;
  result->wi = normalize(from_local(b->frame, result->wi));
  return true;
}
