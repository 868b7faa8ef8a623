/* light/kinds.hot.h: the kernels of each kind of light, and what they share. Each kind has
 * three (light/kinds.row.h names them):
 *
 *   vl_light_sample_KIND     a direction from a point towards the light, and the radiance that
 *                            arrives (pbrt book 12)
 *   vl_light_emit_KIND       a ray that leaves the light, for the two-way tracers
 *   vl_light_emit_pdf_KIND   the density of those rays
 *
 * A kind that lacks one of them is a link error. */
#ifndef LIGHT_KINDS_HOT_H
#define LIGHT_KINDS_HOT_H

#include "math/warp.h"
#include "trace/two_way/stages.h"

/* The input of a light sample. */
typedef struct vlLightQuery {
  const vlWorld *world;
  const vlWorldLight *light;
  const vlEmitted *emitted; /* the light's emission */
  const float *lambda;      /* 4 wavelengths, nm */
  vlVec3 p;                 /* the point that receives light, world space */
  float u, v;               /* random numbers in [0, 1) */
} vlLightQuery;

typedef struct vlLightSample {
  vlVec3 w;      /* unit, towards the light */
  vlVec3 target; /* the point that must be visible from p; for a distant light, the same as w */
  float pdf;     /* per solid angle; 1 for a delta light; 0: no sample (the initial value) */
  float radiance[4]; /* radiance that arrives from direction w */
  bool delta;        /* no ray can hit the light; initially false */
  bool distant;      /* the light is infinitely far; initially false */
} vlLightSample;

/* The input of a ray that leaves a light. */
typedef struct vlEmissionQuery {
  const vlWorld *world;
  const vlWorldLight *light;
  const vlEmitted *emitted;
  const float *lambda;
  /* random numbers in [0, 1): u, v for the position, s, t for the direction */
  float u, v, s, t;
} vlEmissionQuery;

/* emit fills *out, which is all zero on entry. *out stays invalid if the light emits nothing.
 * Its flux is divided by the density of the sampled position and direction, but not by the
 * probability of choosing the light. density: as vl_emission_density; p: probability of
 * choosing the light, a factor of the result. */
typedef void vlSampleLight(const vlLightQuery *q, vlLightSample *out);
typedef void vlEmitLight(const vlEmissionQuery *q, vlEmission *out);
typedef float vlLightDensity(const vlWorld *world, const vlWorldLight *light, float p, vlVec3 w,
                             float distance, const vlPoint *at);

/* The emission at (s, t) of its image, which lights without do not read, times a factor. */
static inline void vl_light_emission(const vlWorld *world, const vlEmitted *emitted,
                                     const float lambda[4], vlVec2 st, float factor,
                                     float out[4]) {
  vl_emitted_at(world, emitted, lambda, st.x, st.y, true, out);
  for (int c = 0; c < 4; c++)
    out[c] *= factor;
}

/* ---- many lanes at once ------------------------------------------------------------------ */

/* Largest number of lanes for the functions below. With it, their data stays in the L1
 * cache. */
enum { VL_AREA_BLOCK = 64 };

/* Whether a light is an environment map without portal. vl_sample_environment samples such
 * lights. */
static inline bool vl_light_is_environment(const vlWorld *world, const vlWorldLight *light) {
  return light->environment != VL_NONE && !world->environments.items[light->environment].portal;
}
/* Samples an environment map for the given lanes, which have chosen this light. u, v: by
 * lane. */
void vl_sample_environment(const vlWorld *world, const vlWorldLight *light,
                           const vlPaths *paths, const uint32_t *lanes, uint32_t count,
                           const float *u, const float *v, vlLightSamples *out);
/* Sample the lights that the given lanes have chosen: plain triangles, or plain spheres seen
 * from outside. */
void vl_sample_triangles(const vlWorld *world, const vlPaths *paths, const vlSurface *f,
                         const uint32_t *lanes, uint32_t count, const float *u, const float *v,
                         vlLightSamples *out);
void vl_sample_spheres(const vlWorld *world, const vlPaths *paths, const vlSurface *f,
                       const uint32_t *lanes, uint32_t count, const float *u, const float *v,
                       vlLightSamples *out);
/* Radiance and density of an environment map for the given rays, without the probability of
 * choosing the light. */
void vl_hit_environment(const vlWorld *world, const vlWorldLight *light, const vlPaths *paths,
                        const uint32_t *lanes, uint32_t count, vlSkyHits *out);

/* ---- lights at a point ------------------------------------------------------------------- */

static inline vlVec3 vl_light_axis(const vlWorldLight *light) {
  return vl_load3(light->direction);
}

/* Transforms a world direction to the light's frame (`corners`); not normalized. */
static inline vlVec3 vl_light_local(const vlWorldLight *light, vlVec3 d) {
  return vl_turn(light->corners, d);
}

/* The world's direction (unit) of one in the light's frame: by the transpose of a rotation
 * times a scale, or for skewed frames by its inverse. */
static inline vlVec3 vl_light_from_local(const vlWorldLight *light, vlVec3 d) {
  const float *m = light->corners;
  vlVec3 x = vl_load3(m);
  vlVec3 y = vl_load3(m + 3);
  vlVec3 z = vl_load3(m + 6);
  vlVec3 a = vl_cross(y, z), b = vl_cross(z, x), c = vl_cross(x, y);
  float sign = vl_dot(x, a) < 0.0f ? -1.0f : 1.0f;
  vlVec3 sum = vl_add(vl_mul(a, d.x), vl_add(vl_mul(b, d.y), vl_mul(c, d.z)));
  return vl_normalize(vl_mul(sum, sign));
}

/* Solid angle in the light's frame per solid angle of the world, for a unit direction d of the
 * world that is `local` = m d there, not normalized: |det m| / |m d|^3. 1 without skew. */
static inline float vl_light_stretch(const vlWorldLight *light, vlVec3 local) {
  const float *m = light->corners;
  vlVec3 x = vl_load3(m);
  vlVec3 y = vl_load3(m + 3);
  vlVec3 z = vl_load3(m + 6);
  float length2 = vl_length2(local);
  return vl_abs(vl_dot(x, vl_cross(y, z))) / (length2 * __builtin_sqrtf(length2));
}

/* Sets target, direction and density of a sample of a point light. Returns 1 / distance^2. */
static inline float vl_light_towards_point(const vlLightQuery *q, vlLightSample *out) {
  out->target = vl_load3(q->light->position);
  vlVec3 to = vl_sub(out->target, q->p);
  float d2 = vl_length2(to);
  out->w = vl_normalize(to);
  out->pdf = 1.0f;
  out->delta = true;
  return d2 > 0.0f ? 1.0f / d2 : 0.0f;
}

/* Sends a ray from a point light along d (unit), with this density per solid angle. */
static inline void vl_light_emit_along(const vlEmissionQuery *q, vlVec3 d, float density,
                                       vlEmission *out) {
  out->o = out->at = vl_load3(q->light->position);
  out->d = d;
  out->density = density;
  out->delta = out->valid = true;
}

/* Samples a ray from a point light, uniformly in a cone around the light's axis. span: 1 -
 * cosine of the cone's half angle; 2 for the whole sphere. For a cone, returns the cosine
 * between ray and axis. The ray's flux is the intensity times 2 pi span. */
static inline float vl_light_emit_from_point(const vlEmissionQuery *q, float span,
                                             vlEmission *out) {
  float c = 1.0f, density = 1.0f / (2.0f * VL_PI * span);
  if (span == 2.0f) {
    vl_light_emit_along(q, vl_warp_sphere(q->s, q->t), density, out);
  } else {
    vlVec3 local = vl_warp_cone(q->s, q->t, span);
    vlVec3 d = vl_from_local(vl_frame_from_z(vl_light_axis(q->light)), local);
    vl_light_emit_along(q, vl_normalize(d), density, out);
    c = local.z;
  }
  return c;
}

/* Density of the rays of vl_light_emit_from_point, for a ray that arrives from direction w
 * after `distance`. */
static inline float vl_light_emit_pdf_from_point(const vlWorldLight *light, float span, float p,
                                                 vlVec3 w, float distance) {
  float c = -vl_dot(w, vl_light_axis(light));
  return span == 2.0f || c >= 1.0f - span ? p * VL_INV_2PI / (span * distance * distance)
                                          : 0.0f;
}

/* ---- lights infinitely far away ---------------------------------------------------------- */

/* Area of a disk that covers the world. */
static inline float vl_light_disk(const vlWorld *world) {
  return VL_PI * world->radius * world->radius;
}
/* Samples a ray that arrives from direction w (unit, towards the light) through a disk of this
 * area, which is perpendicular to w. Sets origin, direction and `at` of the emission. */
void vl_light_emit_from_afar(const vlWorld *world, vlVec3 w, float u, float v, vlEmission *out);

#endif
