/* light/lights.hot.h: light samples, and the lights that rays hit; private to the hot files
 * of trace. light/kinds.hot.h has the functions of each kind. */
#ifndef LIGHT_LIGHTS_HOT_H
#define LIGHT_LIGHTS_HOT_H

#include "color/kernels.h"
#include "trace/medium/rows.h"
#include "trace/surface/points.h"

struct vlTracing; /* trace/stages.h */

/* The lanes that have chosen a light. Lanes with the same light are adjacent as far as
 * possible, so they can be sampled together. */
typedef struct vlLanesByLight {
  uint32_t count, lane[VL_ROW_SIZE];
} vlLanesByLight;
/* Chooses a light for each lane. Writes light->light and light->pmf (0: no light). *rest: the
 * position of u in the chosen light's part of [0, 1), uniform again; unspecified for lanes
 * without a light. */
void vl_stage_light_choice(const vlLightTree *tree, uint32_t n, const vlSurface *surface,
                           const float *u, vlLightSamples *light, float *rest,
                           vlLanesByLight *by_light);
/* Takes one light sample for each lane. u_choice chooses the light; its rest and v choose the
 * point or direction. So the points on each light are as well distributed as the pairs
 * (u_choice, v): with a number of its own for the choice, the lanes of one light would be a
 * random part of the points. spare replaces the rest where the light's part is so small that
 * few bits are left. */
void vl_stage_lights(const vlWorld *world, uint32_t n, const vlPaths *paths,
                     const vlSurface *surface, const float *u_choice, const float *v,
                     const float *spare, vlLightSamples *light);

/* Emitted radiance in 4 channels: the light's colour times, if the light has an image, its
 * value at (s, t). */
void vl_emitted_at(const vlWorld *world, const vlEmitted *emitted, const float lambda[4],
                   float s, float t, bool sky, float out[4]);
/* A colour as a spectrum at four wavelengths (pbrt book 10.4.1). albedo: the colour is clamped
 * to 1; else it may be brighter than 1. vl_upsample_rows does the same operations for many
 * lanes. */
static inline void vl_upsample(const vlRgbTable *table, bool albedo, const float rgb[3],
                               const float lambda[4], float out[4]) {
  float c[3] = {rgb[0], rgb[1], rgb[2]};
  for (int k = 0; albedo && k < 3; k++)
    c[k] = c[k] > 1.0f ? 1.0f : c[k];
  float m = vl_max(c[0], vl_max(c[1], c[2]));
  float scale = albedo ? 1.0f : 2.0f * m, inv = scale > 0.0f ? 1.0f / scale : 0.0f;
  vlSigmoid s = vl_rgb_table_lookup(table, c[0] * inv, c[1] * inv, c[2] * inv);
  for (int k = 0; k < 4; k++)
    out[k] = scale * vl_sigmoid(s, lambda[k]);
}
/* A light that a ray has hit. pdf: density of sampling it, per solid angle, from the ray's
 * origin in the ray's direction; 0 after a specular lobe. */
typedef struct vlHitLight {
  uint32_t light;
  float radiance[4], pdf;
  vlPoint at; /* the point, for area lights */
} vlHitLight;
/* Radiance and density, as in vlHitLight, of an infinite light for up to VL_SKY_BLOCK rays that
 * hit nothing. */
enum { VL_SKY_BLOCK = 64 };
typedef struct vlSkyHits {
  float radiance[4][VL_SKY_BLOCK], pdf[VL_SKY_BLOCK];
} vlSkyHits;
void vl_upsample_rows(const vlRgbTable *table, bool albedo, uint32_t padded,
                      float (*rgb)[VL_SKY_BLOCK], float (*lambda)[VL_SKY_BLOCK],
                      float (*value)[VL_SKY_BLOCK]);
/* vl_hit_emission: the emissive surface at hit i; returns false if the surface does not emit on
 * this side. */
bool vl_hit_emission(const vlWorld *world, const vlPaths *p, const vlHits *h, uint32_t i,
                     vlHitLight *met);
/* Calls `add` for each light that the n rays hit: for the infinite lights of rays that hit
 * nothing (shape VL_NONE), with the light's `at` unset, and for emissive surfaces. rows, ends:
 * of the rays; null without media. */
typedef void vlAddLight(struct vlTracing *t, const vlPaths *rays, const vlVolumeRows *rows,
                        const vlFlightEnds *ends, uint32_t i, const vlHitLight *met, bool sky);
void vl_stage_lights_hit(struct vlTracing *t, uint32_t n, const vlPaths *rays,
                         const vlHits *hits, const vlVolumeRows *rows, const vlFlightEnds *ends,
                         vlAddLight *add);
/* uv of the emission's image at a point of an area light that a ray has hit. */
vlVec2 vl_emission_uv(const vlWorld *world, const vlWorldLight *light, const vlPoint *at);
/* Radiance of an infinite light for a ray from o in direction d that hits nothing, and the
 * density of sampling it. */
void vl_infinite_at(const vlWorld *world, const vlWorldLight *light, vlVec3 o, vlVec3 d,
                    const float lambda[4], float out[4]);
float vl_infinite_pdf(const vlWorld *world, const vlWorldLight *light, vlVec3 o, vlVec3 d);
/* Whether p lies outside of the light's portal, where the light is not seen. */
bool vl_is_outside_portal(const vlWorld *world, const vlWorldLight *light, vlVec3 p);
/* Density per solid angle, seen from `from`, of sampling this point of an area light. It
 * excludes the probability of choosing the light. */
float vl_area_pdf(const vlWorld *world, const vlWorldLight *light, vlVec3 from,
                  const vlPoint *at);

static inline float vl_power_heuristic(float a, float b) {
  float a2 = a * a, b2 = b * b;
  return a2 < VL_INFINITY ? (a2 + b2 > 0.0f ? a2 / (a2 + b2) : 0.0f) : 1.0f;
}

#endif
