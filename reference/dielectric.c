/* dielectric.c: glass and water, smooth or rough (pbrt book 9.5, 9.7). */
#include "microfacet.h"

/* Fresnel's equations for unpolarised light. The cosine is negative on the inside; eta is the index inside over the
 * index outside. */
double reflected_by_glass(double cosine, double eta) {
  if (cosine < 0) eta = 1 / eta;
  cosine = fmin(fabs(cosine), 1);
  double sine2 = (1 - square(cosine)) / square(eta);
  if (sine2 >= 1) return 1; /* total reflection */
  double inner = sqrt(1 - sine2);
  double parallel = (eta * cosine - inner) / (eta * cosine + inner);
  double perpendicular = (cosine - eta * inner) / (cosine + eta * inner);
  return (square(parallel) + square(perpendicular)) / 2;
}

/* Snell's law at a mirror with the normal m: the part of the direction along the mirror becomes smaller by *eta, the
 * index on the other side over the index on this one. False: total reflection. */
bool refract(vector wo, vector m, double ior, double *eta, vector *wi) {
  *eta = dot(wo, m) < 0 ? 1 / ior : ior;
  m = face_forward(m, wo);
  double cosine = dot(wo, m);
  double sine2 = (1 - square(cosine)) / square(*eta);
  if (sine2 >= 1) return false;
  *wi = add(scale(-1 / *eta, wo), scale(cosine / *eta - sqrt(1 - sine2), m));
  return true;
}

/* Walter et al. 2007, pbrt book 9.7. Mirrors that send wo to wi have their normal m along wo + eta wi; eta is 1 for
 * reflection, where f is that of a metal. For refraction, with i = wi . m and o = wo . m,
 *   f = D G (1 - F) |i o| / (|wi . n| |wo . n| (i + o / eta)^2) / eta^2,
 * the last since light that enters glass is refracted into a smaller cone. */
spectrum dielectric_value(const bsdf *b, vector wo, vector wi, double *density) {
  if (is_smooth(b) || b->ior == 1 || wo.z == 0 || wi.z == 0) return gray(0);
  bool reflects = wo.z * wi.z > 0;
  double eta = reflects ? 1 : wo.z > 0 ? b->ior : 1 / b->ior;
  vector m = face_forward(normalize(add(scale(eta, wi), wo)), make_vector(0, 0, 1));
  /* a mirror must be seen from the same side as the surface */
  if (dot(m, wi) * wi.z < 0 || dot(m, wo) * wo.z < 0) return gray(0);
  double reflected = reflected_by_glass(dot(wo, m), b->ior);
  double mirrors = mirror_distribution(b, m) * visible_from_both(b, wo, wi);
  if (reflects) {
    *density = visible_density(b, wo, m) / (4 * fabs(dot(wo, m))) * reflected;
    return gray(mirrors * reflected / (4 * fabs(wo.z)));
  }
  double m_per_wi = fabs(dot(wi, m)) / square(dot(wi, m) + dot(wo, m) / eta); /* how solid angles change */
  *density = visible_density(b, wo, m) * m_per_wi * (1 - reflected);
  double value = mirrors * (1 - reflected) * m_per_wi * fabs(dot(wo, m) / wo.z);
  return gray(value / square(eta));
}

/* Reflects or refracts by lot, with the probabilities F and 1 - F, which thus are no factors. */
bool sample_dielectric(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  result->specular = is_smooth(b) || b->ior == 1;
  vector m = result->specular ? make_vector(0, 0, 1) : sample_visible_normal(b, wo, s);
  bool transmits = next_number(s) >= reflected_by_glass(dot(wo, m), b->ior);
  double eta = 1;
  if (!transmits)
    result->wi = reflect(wo, m);
  else if (!refract(wo, m, b->ior, &eta, &result->wi))
    return false;
  result->weight = gray(1 / square(eta));
  return (wo.z * result->wi.z < 0) == transmits; /* else a tilted mirror sends it to the wrong side */
}
