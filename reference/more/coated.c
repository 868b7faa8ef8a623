/* more/coated.c: a diffuse surface under a clear coat (pbrt book 14.3), by random walk: light enters through the coat,
 * is scattered by the base, and is reflected between base and coat until it leaves. The coat absorbs; it does not
 * scatter. Walks give values with noise; directions are drawn from a simple density, so that density and value may be
 * asked for any direction. */
#include "bsdfs.h"

#include "microfacet.h"

static bsdf coat_of(const bsdf *b) {
  return (bsdf){.kind = BSDF_DIELECTRIC, .ior = b->ior, .alpha_x = b->alpha_x, .alpha_y = b->alpha_y};
}

/* The share of light that is left after one way through the coat. */
static double absorbed(const bsdf *b, vector w) {
  return b->more.coat_thickness > 0 ? exp(-b->more.coat_thickness / fabs(w.z)) : 1;
}

static vector mirror_normal(const bsdf *coat, vector w, sampler *s) {
  return is_smooth(coat) ? make_vector(0, 0, 1) : sample_visible_normal(coat, w, s);
}

/* G / G1: what masking leaves of a sample drawn by visible normals. */
static double masking(const bsdf *coat, vector from, vector to) {
  return is_smooth(coat) ? 1 : visible_from_both(coat, from, to) / visible(coat, from);
}

/* Light goes through the coat's surface. The result is its weight, 0 where it does not get through. */
static double go_through(const bsdf *coat, vector from, sampler *s, vector *to, double *eta) {
  vector m = mirror_normal(coat, from, s);
  if (!refract(from, m, coat->ior, eta, to) || from.z * to->z >= 0) return 0;
  return (1 - reflected_by_glass(dot(from, m), coat->ior)) * masking(coat, from, *to);
}

/* Light inside is reflected back down at the coat's surface. */
static double go_back(const bsdf *coat, vector from, sampler *s, vector *to) {
  vector m = mirror_normal(coat, from, s);
  *to = reflect(from, m);
  if (from.z * to->z <= 0) return 0;
  return reflected_by_glass(dot(from, m), coat->ior) * masking(coat, from, *to);
}

/* One walk from wo. At each meeting with the base, the way out to wi is asked for (next-event estimation). */
static spectrum walk(const bsdf *b, const bsdf *coat, vector wo, vector wi, sampler *s) {
  spectrum sum = gray(0), throughput;
  double eta;
  vector down;
  double entered = go_through(coat, wo, s, &down, &eta);
  throughput = gray(entered / square(eta));
  for (uint32_t depth = 0; depth < b->more.coat_depth && largest(throughput) > 0; depth += 2) {
    throughput = scaled(absorbed(b, down), throughput);
    vector in; /* the direction in which light from wi reaches the base */
    double out_eta, out = go_through(coat, wi, s, &in, &out_eta);
    if (out > 0) sum = plus(sum, scaled(out * absorbed(b, in) * fabs(wi.z) / PI, times(throughput, b->reflectance)));
    vector up = sample_cosine_hemisphere(s);
    throughput = scaled(absorbed(b, up), times(throughput, b->reflectance));
    /* from inside, the coat's surface is met by the direction that points away from it: down */
    vector back;
    throughput = scaled(up.z > 0 ? go_back(coat, negate(up), s, &back) : 0, throughput);
    down = back;
  }
  return sum;
}

/* The density of sampled directions: half by the coat's reflection, half by the cosine; under a smooth coat by the
 * cosine alone, for the share of light that is not reflected. */
static double direction_density(const bsdf *coat, vector wo, vector wi) {
  double by_cosine = fabs(wi.z) / PI;
  if (is_smooth(coat)) return (1 - reflected_by_glass(wo.z, coat->ior)) * by_cosine;
  vector m = normalize(add(wo, wi));
  return 0.5 * by_cosine + 0.5 * visible_density(coat, wo, m) / (4 * fabs(dot(wo, m)));
}

enum { WALKS = 4 };

/* The coat lies on both sides. */
spectrum coated_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density) {
  *density = 0;
  if (wo.z * wi.z <= 0) return gray(0);
  if (wo.z < 0) {
    wo = negate(wo);
    wi = negate(wi);
  }
  bsdf coat = coat_of(b);
  double ignored;
  spectrum value = dielectric_value(&coat, wo, wi, &ignored);
  for (int i = 0; i < WALKS; i++) value = plus(value, scaled(1.0 / WALKS, walk(b, &coat, wo, wi, s)));
  *density = direction_density(&coat, wo, wi);
  return value;
}

bool sample_coated(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  bsdf coat = coat_of(b);
  vector o = wo.z < 0 ? negate(wo) : wo;
  double reflected = is_smooth(&coat) ? reflected_by_glass(o.z, coat.ior) : 0.5;
  bool reflects = next_number(s) < reflected;
  vector wi = reflects ? reflect(o, mirror_normal(&coat, o, s)) : sample_cosine_hemisphere(s);
  result->specular = reflects && is_smooth(&coat);
  result->wi = wo.z < 0 ? negate(wi) : wi;
  return wi.z > 0;
}
