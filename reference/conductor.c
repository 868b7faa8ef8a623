/* conductor.c: metals (pbrt book 9.3.6, 9.6.5). */
#include <complex.h>

#include "microfacet.h"

/* Fresnel's equations with a complex index of refraction: the reflected share of unpolarised light at the cosine. */
static double reflected_by_metal(double cosine, double eta, double k) {
  double complex index = eta + k * I;
  double complex sine = sqrt(fmax(0, 1 - square(cosine))) / index;
  double complex inner = csqrt(1 - sine * sine);
  double complex parallel = (index * cosine - inner) / (index * cosine + inner);
  double complex perpendicular = (cosine - index * inner) / (cosine + index * inner);
  return (square(cabs(parallel)) + square(cabs(perpendicular))) / 2;
}

static spectrum fresnel(const bsdf *b, double cosine) {
  spectrum f;
  for (int i = 0; i < CHANNELS; i++) f.c[i] = reflected_by_metal(clamp(cosine, 0, 1), b->eta.c[i], b->k.c[i]);
  return f;
}

/* f = D F G / (4 cos_o cos_i) (Torrance and Sparrow 1967), times cos_i. */
spectrum conductor_value(const bsdf *b, vector wo, vector wi, double *density) {
  *density = 0;
  if (is_smooth(b) || wo.z * wi.z <= 0) return gray(0);
  vector m = add(wo, wi);
  if (length(m) == 0) return gray(0);
  m = normalize(m);
  double cosine = fabs(dot(wo, m));
  m = face_forward(m, make_vector(0, 0, 1));
  *density = visible_density(b, wo, m) / (4 * cosine);
  double value = mirror_distribution(b, m) * visible_from_both(b, wo, wi) / (4 * fabs(wo.z));
  return scaled(value, fresnel(b, cosine));
}

bool sample_conductor(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  result->transmitted = false;
  if (is_smooth(b)) {
    result->wi = make_vector(-wo.x, -wo.y, wo.z);
    result->weight = fresnel(b, fabs(wo.z));
    result->specular = true;
    result->density = 1;
    return true;
  }
  vector m = sample_visible_normal(b, wo, s);
  result->wi = reflect(wo, face_forward(m, wo));
  if (wo.z * result->wi.z <= 0) return false;
  spectrum value = conductor_value(b, wo, result->wi, &result->density);
  if (!(result->density > 0)) return false;
  result->weight = scaled(1 / result->density, value);
  result->specular = false;
  return true;
}
