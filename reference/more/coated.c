/* more/coated.c: a diffuse surface or a metal under a coat (pbrt book 14.3), by random walk: light enters through the
 * coat, is scattered by the medium under it and by the base, and is reflected between base and coat until it leaves.
 * Walks give values with noise; directions are drawn from a simple density, so that density and value may be asked for
 * any direction. */
#include "more.h"

#include "microfacet.h"

/* The coat's surface, and what lies under it, as BSDFs of their own. */
bsdf coat_of(const bsdf *b) {
  double x = b->more.coat_alpha_x, y = b->more.coat_alpha_y;
  return (bsdf){.kind = BSDF_DIELECTRIC, .frame = IDENTITY, .ior = b->ior, .alpha_x = x, .alpha_y = y};
}

static bsdf base_of(const bsdf *b) {
  bsdf base = *b;
  base.kind = b->more.metal ? BSDF_CONDUCTOR : BSDF_DIFFUSE;
  base.frame = IDENTITY;
  return base;
}

/* The share of light that is left after a height of the coat. */
static double absorbed(double height, vector w) {
  return height > 0 ? exp(-height / fabs(w.z)) : 1;
}

/* The sum of all reflections: F + T^2 R a^2 / (1 - F R a^2), R of the metal, a what one way through the coat leaves. */
static spectrum all_reflections(const bsdf *b, vector wo) {
  vector down;
  double eta;
  double f = reflected_by_glass(wo.z, b->ior);
  if (!refract(wo, make_vector(0, 0, 1), b->ior, &eta, &down)) return gray(1);
  double twice = square(absorbed(b->more.coat_thickness, down));
  bsdf_sample metal;
  sample_conductor(b, negate(down), NULL, &metal);
  for (int i = 0; i < CHANNELS; i++) {
    double r = metal.weight.c[i] * twice;
    metal.weight.c[i] = f + square(1 - f) * r / (1 - f * r);
  }
  return metal.weight;
}

/* What light from wi, which goes down inside along `in`, adds at height z of the medium: straight, by the metal, and by
 * all further reflections between metal and coat. No walk finds these directions. */
static spectrum haze_from(const bsdf *b, vector travel, double z, vector wi, vector in) {
  double thickness = b->more.coat_thickness, g = b->more.coat_g;
  vector up = make_vector(in.x, in.y, -in.z);
  double straight = absorbed(thickness - z, in) * phase(g, negate(travel), negate(in));
  double mirrored = absorbed(thickness + z, in) * phase(g, negate(travel), negate(up));
  double turn = reflected_by_glass(wi.z, b->ior) * square(absorbed(thickness, in));
  bsdf_sample metal;
  sample_conductor(b, negate(in), NULL, &metal);
  spectrum sum = b->more.coat_albedo;
  for (int i = 0; i < CHANNELS; i++) {
    double r = metal.weight.c[i];
    sum.c[i] *= (straight + r * mirrored) / (1 - r * turn);
  }
  return sum;
}

static bool is_all_smooth(const bsdf *b, const bsdf *coat) {
  return b->more.metal && is_smooth(coat) && is_smooth(b);
}

/* A mirror under a rough coat: no light that comes in at wi has just the direction that the mirror needs. So paths ask
 * the coat for wi where they leave, not where they are scattered. */
static bool asks_at_exit(const bsdf *b, const bsdf *coat) {
  return b->more.metal && !is_smooth(coat) && b->alpha_x < coat->alpha_x;
}

/* What light from wi adds where it is scattered at height z into the direction that the walk came from, -travel. Only
 * what comes through the coat counts: as light, not as radiance, which is divided by the square of the index. */
static spectrum light_from(const bsdf *b, const bsdf *coat, vector travel, double z, bool at_base, vector wi,
                           sampler *s) {
  bsdf_sample in;
  if (!sample_bsdf(coat, wi, s, &in) || in.wi.z >= 0) return gray(0);
  double through = in.weight.c[0] * square(b->ior) * fabs(wi.z / in.wi.z), density;
  if (!at_base && is_all_smooth(b, coat)) return scaled(through, haze_from(b, travel, z, wi, in.wi));
  through *= absorbed(b->more.coat_thickness - z, in.wi);
  bsdf base = base_of(b);
  if (at_base) return scaled(through, bsdf_value(&base, negate(travel), negate(in.wi), s, &density));
  return scaled(through * phase(b->more.coat_g, negate(travel), negate(in.wi)), b->more.coat_albedo);
}

static bool has_haze(const bsdf *b) {
  return largest(b->more.coat_albedo) > 0 && b->more.coat_thickness > 0;
}

/* One walk from wo. Its height is z: the base's is 0. It ends where light is reflected before it is in, or goes out. */
static spectrum walk(const bsdf *b, const bsdf *coat, vector wo, vector wi, sampler *s) {
  double z = b->more.coat_thickness, density;
  bool at_exit = asks_at_exit(b, coat), medium = has_haze(b);
  bsdf base = base_of(b);
  bsdf_sample next;
  if (!sample_bsdf(coat, wo, s, &next) || next.wi.z >= 0) return gray(0);
  spectrum sum = gray(0), throughput = next.weight;
  vector travel = next.wi;
  for (uint32_t depth = 0; depth < b->more.coat_depth && largest(throughput) > 0; depth++) {
    double end = travel.z < 0 ? 0 : b->more.coat_thickness;
    double flight = medium ? -log1p(-next_number(s)) * travel.z : travel.z * (double)INFINITY;
    bool scatters = fabs(flight) < fabs(end - z), at_base = !scatters && travel.z < 0, at_coat = !scatters && !at_base;
    if (!medium) throughput = scaled(absorbed(fabs(end - z), travel), throughput);
    z = scatters ? z + flight : end;
    if (at_coat && at_exit) sum = plus(sum, times(throughput, bsdf_value(coat, negate(travel), wi, s, &density)));
    if (!at_coat && !at_exit) sum = plus(sum, times(throughput, light_from(b, coat, travel, z, at_base, wi, s)));
    if (scatters) {
      throughput = times(throughput, b->more.coat_albedo);
      frame f = make_frame(negate(travel), make_vector(0.3, 0.5, 0.8));
      travel = from_local(f, sample_phase(b->more.coat_g, s));
      continue;
    }
    if (!sample_bsdf(at_base ? &base : coat, negate(travel), s, &next) || next.wi.z * travel.z >= 0) break;
    throughput = times(throughput, next.weight);
    travel = next.wi;
  }
  return sum;
}

/* Roughly what the base's mirrors look like from above. */
static bsdf seen_base(const bsdf *b) {
  double x = fmin(1, 1.5 * b->alpha_x + b->more.coat_alpha_x), y = fmin(1, 1.5 * b->alpha_y + b->more.coat_alpha_y);
  return (bsdf){.alpha_x = fmax(x, 2e-3), .alpha_y = fmax(y, 2e-3)};
}

static double mirror_density(const bsdf *mirrors, vector wo, vector wi) {
  vector m = normalize(add(wo, wi));
  return visible_density(mirrors, wo, m) / (4 * fabs(dot(wo, m)));
}

/* The density of sampled directions: half by the cosine, or by a metal's mirrors, half by the coat's reflection. A
 * smooth coat's reflection is none of these, and leaves its share out: half where the metal is smooth, too. */
static double direction_density(const bsdf *b, const bsdf *coat, vector wo, vector wi) {
  bsdf base = seen_base(b);
  double density = fabs(wi.z) / PI;
  if (is_all_smooth(b, coat)) return 0.5 * density;
  if (b->more.metal) density = 0.2 * density + 0.8 * mirror_density(&base, wo, wi);
  if (is_smooth(coat)) return (1 - reflected_by_glass(wo.z, coat->ior)) * density;
  return 0.5 * density + 0.5 * mirror_density(coat, wo, wi);
}

enum { WALKS = 4 };

/* The coat lies on both sides. */
spectrum coated_value(const bsdf *b, vector wo, vector wi, sampler *s, double *density) {
  bsdf coat = coat_of(b);
  double ignored;
  if (wo.z * wi.z <= 0 || (is_all_smooth(b, &coat) && !has_haze(b))) return gray(0);
  if (wo.z < 0) {
    wo = negate(wo);
    wi = negate(wi);
  }
  spectrum value = dielectric_value(&coat, wo, wi, &ignored);
  for (int i = 0; i < WALKS; i++) value = plus(value, scaled(1.0 / WALKS, walk(b, &coat, wo, wi, s)));
  *density = direction_density(b, &coat, wo, wi);
  return value;
}

bool sample_coated(const bsdf *b, vector wo, sampler *s, bsdf_sample *result) {
  bsdf coat = coat_of(b), base = seen_base(b);
  vector o = wo.z < 0 ? negate(wo) : wo;
  double reflected = is_smooth(&coat) ? reflected_by_glass(o.z, coat.ior) : 0.5;
  bool all_smooth = is_all_smooth(b, &coat);
  if (all_smooth) reflected = has_haze(b) ? 0.5 : 1;
  bool reflects = next_number(s) < reflected;
  result->specular = reflects && is_smooth(&coat);
  if (all_smooth) result->weight = scaled(1 / reflected, all_reflections(b, o));
  bool by_mirrors = !reflects && b->more.metal && !all_smooth && next_number(s) < 0.8;
  vector wi = sample_cosine_hemisphere(s);
  if (result->specular) wi = make_vector(-o.x, -o.y, o.z);
  if (reflects && !result->specular) wi = reflect(o, sample_visible_normal(&coat, o, s));
  if (by_mirrors) wi = reflect(o, sample_visible_normal(&base, o, s));
  result->wi = wo.z < 0 ? negate(wi) : wi;
  return wi.z > 0;
}
