/* conductor.c: metals (pbrt book 9.3.6, 9.6.5). */
#include <complex.h>

#include "microfacet.h"

/* Fresnel's equations with a complex index of refraction: the reflected share of unpolarised light at the cosine. */
static double reflected_by_metal(double cosine, double eta, double k) {
  double complex index = eta + k * (double complex)I;
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

/* Torrance and Sparrow 1967: f = D F G / (4 cos_o cos_i), by mirrors whose normal m is half way between wo and wi. */
spectrum conductor_value(const bsdf *b, vector wo, vector wi, double *density) {
  if (is_smooth(b) || wo.z * wi.z <= 0) return gray(0);
  vector m = normalize(add(wo, wi));
  double cosine = fabs(dot(wo, m));
  *density = visible_density(b, wo, m) / (4 * cosine);
  double value = mirror_distribution(b, m) * visible_from_both(b, wo, wi) / (4 * fabs(wo.z));
  return scaled(value, fresnel(b, cosine));
}

void sample_conductor(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  result->specular = is_smooth(b);
  vector m = result->specular ? make_vector(0, 0, 1) : sample_visible_normal(b, wo, s);
  result->wi = reflect(wo, m);
  result->weight = fresnel(b, fabs(wo.z));
}
