/* dielectric.c: glass and water, smooth or rough (pbrt book 9.5, 9.7). */
#include "microfacet.h"

/* Fresnel's equations for unpolarised light. The cosine is negative on the inside; eta is the index inside over the
 * index outside. */
double reflected_by_glass(double cosine, double eta) {
  if (cosine < 0) {
    cosine = -cosine;
    eta = 1 / eta;
  }
  cosine = clamp(cosine, 0, 1);
  double sine2 = (1 - square(cosine)) / square(eta);
  if (sine2 >= 1) return 1; /* total reflection */
  double inner = sqrt(1 - sine2);
  double parallel = (eta * cosine - inner) / (eta * cosine + inner);
  double perpendicular = (cosine - eta * inner) / (cosine + eta * inner);
  return (square(parallel) + square(perpendicular)) / 2;
}

/* Snell's law at a mirror's normal m. *eta: the index on the other side over the index on this one. */
bool refract(vector wo, vector m, double ior, double *eta, vector *wi) {
  double cosine = dot(wo, m);
  *eta = ior;
  if (cosine < 0) {
    *eta = 1 / ior;
    cosine = -cosine;
    m = negate(m);
  }
  double sine2 = (1 - square(cosine)) / square(*eta);
  if (sine2 >= 1) return false;
  *wi = add(scale(-1 / *eta, wo), scale(cosine / *eta - sqrt(1 - sine2), m));
  return true;
}

/* Walter et al. 2007. Light that enters glass is refracted into a smaller cone: radiance seen through the surface is
 * divided by eta^2. */
spectrum dielectric_value(const bsdf *b, vector wo, vector wi, double *density) {
  *density = 0;
  if (is_smooth(b) || b->ior == 1 || wo.z == 0 || wi.z == 0) return gray(0);
  bool reflects = wo.z * wi.z > 0;
  double eta = reflects ? 1 : wo.z > 0 ? b->ior : 1 / b->ior;
  vector m = add(scale(eta, wi), wo);
  if (length(m) == 0) return gray(0);
  m = face_forward(normalize(m), make_vector(0, 0, 1));
  /* a mirror must be seen from the same side as the surface */
  if (dot(m, wi) * wi.z < 0 || dot(m, wo) * wo.z < 0) return gray(0);
  double reflected = reflected_by_glass(dot(wo, m), b->ior);
  double mirrors = mirror_distribution(b, m) * visible_from_both(b, wo, wi);
  if (reflects) {
    *density = visible_density(b, wo, m) / (4 * fabs(dot(wo, m))) * reflected;
    return gray(mirrors * reflected / (4 * fabs(wo.z)));
  }
  double denominator = square(dot(wi, m) + dot(wo, m) / eta);
  double solid_angle = fabs(dot(wi, m)) / denominator; /* of m, per solid angle of wi */
  *density = visible_density(b, wo, m) * solid_angle * (1 - reflected);
  double value = mirrors * (1 - reflected) * solid_angle * fabs(dot(wo, m) / wo.z);
  return gray(value / square(eta));
}

static bool sample_smooth(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  double reflected = reflected_by_glass(wo.z, b->ior);
  result->specular = true;
  result->density = 1;
  result->transmitted = next_number(s) >= reflected;
  if (!result->transmitted) {
    result->wi = make_vector(-wo.x, -wo.y, wo.z);
    result->weight = gray(1);
    return true;
  }
  double eta;
  if (!refract(wo, make_vector(0, 0, 1), b->ior, &eta, &result->wi)) return false;
  result->weight = gray(1 / square(eta));
  return true;
}

bool sample_dielectric(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  if (is_smooth(b) || b->ior == 1) return sample_smooth(b, wo, s, result);
  vector m = sample_visible_normal(b, wo, s);
  double reflected = reflected_by_glass(dot(wo, m), b->ior);
  result->specular = false;
  result->transmitted = next_number(s) >= reflected;
  double eta;
  if (!result->transmitted)
    result->wi = reflect(wo, m);
  else if (!refract(wo, m, b->ior, &eta, &result->wi))
    return false;
  if ((wo.z * result->wi.z > 0) == result->transmitted) return false;
  spectrum value = dielectric_value(b, wo, result->wi, &result->density);
  if (!(result->density > 0)) return false;
  result->weight = scaled(1 / result->density, value);
  return true;
}
