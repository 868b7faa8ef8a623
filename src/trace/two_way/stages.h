/* trace/two_way/stages.h: declarations that the hot files of the two-way tracers share; private
 * to them. */
#ifndef TRACE_TWO_WAY_STAGES_H
#define TRACE_TWO_WAY_STAGES_H

#include "math/ggx.h"
#include "trace/medium/volume.h"
#include "trace/stages.h"
#include "trace/two_way/rows.h"

/* The shadow rays of a two-way tracer, with what media (null in worlds without) and weights
 * need to know of them. */
typedef struct vlTwoWayShadows {
  vlShadowRays *rays;
  vlShadowFlights *flights;
  vlStrategies *strategies;
} vlTwoWayShadows;

/* Vertices of paths, on surfaces or in media. */
typedef struct vlTwoWayVertices {
  const vlPaths *paths;
  const vlVolumeRows *rows; /* null in worlds without media */
  const vlVertices *at;     /* null: the vertices are in media */
  const vlWays *ways;
} vlTwoWayVertices;

void vl_bidirectional_tracer(vlTracing *t);
void vl_light_tracer(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *scratch,
                     vlTwoWayRows *rows, vlLightBatch *batch);
/* Adds the radiance of the photons near n vertices on surfaces or in media. depth: bounces of
 * the camera path so far. there, back, list: memory for what is between. */
void vl_stage_merge(vlTracing *t, uint32_t n, uint32_t depth, const vlTwoWayVertices *x,
                    vlBsdfValues *there, vlBsdfValues *back, vlMergeList *list);
void vl_stage_merge_media(vlTracing *t, uint32_t n, uint32_t depth, const vlTwoWayVertices *x);
/* Assigns camera paths to groups by the numbers u that sample their wavelengths, and replaces u
 * by the group's. */
void vl_stage_groups(const vlTracing *t, uint32_t n, float *u);
/* Connects each of n vertices on surfaces to a vertex of a light path. there, back: memory for
 * what is between. */
void vl_stage_connect(vlTracing *t, uint32_t n, uint32_t depth, const vlTwoWayVertices *x,
                      vlBsdfValues *there, vlBsdfValues *back, const vlTwoWayShadows *q);
/* The same for vertices in media. */
void vl_connect_from_media(vlTracing *t, uint32_t n, uint32_t depth, const vlTwoWayVertices *x,
                           const vlTwoWayShadows *q);

/* The end of a connection on the camera path. */
typedef struct vlEnd {
  vlVec3 p, g, n; /* n: shading normal on the side of wo; in media, the direction of flight */
  float tint[4];  /* throughput; on diffuse surfaces times the reflectance */
  float ways;     /* the strategies on the camera's side, with merging; an estimate for surfaces
                     that are not diffuse; in media without a times the phase function */
  bool diffuse;
  uint32_t room;             /* largest number of bounces that a light path may have */
  bool inside;               /* in a medium; then: */
  float a, dense, asymmetry; /* vlWays; vl_medium_extinction; g of the phase function */
  uint32_t air;              /* with media: vl_air of the medium before the vertex */
} vlEnd;

/* What the shadow ray of a connection needs to know of vertex i of the camera paths. */
typedef struct vlConnection {
  uint32_t i;
  vlVec3 at, o, w; /* the vertex, the ray's origin, the direction (unit) */
  float value[4];  /* of the BSDF with its cosine, or of the phase function */
  float forth;     /* density of sampling w */
  float ways;      /* the strategies on the camera's side, with merging */
  float cosine;    /* of w to the geometric normal; in media: the extinction */
  float factor;
  uint32_t medium; /* the medium in which the ray starts */
} vlConnection;

/* Chooses a light path's vertex, or VL_NONE, for each of n vertices. factor: 1 over the
 * product of its probability and the number of light paths. */
void vl_choose_vertices(const vlTracing *t, uint32_t n, uint32_t depth,
                        const vlTwoWayVertices *x, uint32_t *chosen, float *factor);
enum {
  VL_CANDIDATES = 8,
  VL_CONNECTION_KEY = 1 << 20 /* its random numbers differ from those of light samples */
};
/* Sets the candidates' vertices. near: 1, or 0 where the path would be too long. */
static inline void vl_gather(const vlTwoWay *way, const vlEnd *e,
                             const uint32_t at[VL_CANDIDATES], float p[3][VL_CANDIDATES],
                             float g[3][VL_CANDIDATES], float n[3][VL_CANDIDATES],
                             float power[4][VL_CANDIDATES], float back[VL_CANDIDATES],
                             float near[VL_CANDIDATES]) {
  for (uint32_t k = 0; k < VL_CANDIDATES; k++) {
    const vlLightVertex *x = &way->inner.vertices[at[k]];
    for (int j = 0; j < 3; j++) {
      p[j][k] = x->p[j];
      g[j][k] = x->g[j];
      n[j][k] = x->n[j];
    }
    for (int c = 0; c < 4; c++)
      power[c][k] = x->power[c];
    back[k] = x->back;
    near[k] = x->bounce > e->room ? 0.0f : 1.0f;
  }
}
/* In worlds with media: what the connections to the candidates would contribute if they were
 * visible. */
void vl_worths_in_media(const vlTracing *t, const vlEnd *e, const uint32_t at[VL_CANDIDATES],
                        float worth[VL_CANDIDATES]);
/* The probability that the path of a lane traces a connection that is expected to contribute
 * this much. */
float vl_connection_survival(const vlTracing *t, uint32_t lane, float expected);
/* Adds the connection to a vertex as shadow ray `count`. */
void vl_push_connection(const vlTracing *t, const vlPaths *p, const vlVolumeRows *rows,
                        const vlConnection *c, uint32_t vertex, uint32_t count,
                        const vlTwoWayShadows *q);
/* With attenuation by RGB channel, multiplies shadow ray `count` of camera path i so that the
 * transmittance is that of the whole path. eye: vlTracing.passed up to the connection; light:
 * that of the light path, packed. Starts the ray's own passed. */
void vl_join_channels(const vlPaths *p, uint32_t i, const float eye[3], uint32_t light,
                      uint32_t count, const vlTwoWayShadows *q);
void vl_light_media(const vlWorld *world, const float eye[3], uint32_t *medium);

/* Light paths have at most so many bounces: longer ones carry almost nothing, and would need
 * memory for their photons. */
static inline uint32_t vl_light_bounces(const vlTraceDef *def) {
  return def->max_depth < 255 ? def->max_depth : 255;
}
/* vlBounceSteps.in_media. vl_eye_in_media is for camera paths, which sample lights and merge.
 * vl_light_in_media is for light paths, which store photons and connect to the camera. */
uint32_t vl_eye_in_media(vlTracing *t, uint32_t n, uint32_t depth);
uint32_t vl_light_in_media(vlTracing *t, uint32_t n, uint32_t depth);
/* Traces the `count` shadow rays of light samples and adds the radiance that arrives, with
 * weight own / (own + odds * others). */
void vl_two_way_shadows(vlTracing *t, const vlPaths *p, uint32_t count, uint32_t depth,
                        const vlTwoWayShadows *q);
/* Connects n vertices on surfaces to the camera. Visible vertices become splats. back, views,
 * splats: memory for what is between. */
void vl_connect_to_camera(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                          const vlTwoWayVertices *x, vlBsdfValues *back, vlCameraSample *views,
                          vlSplatRows *splats, const vlTwoWayShadows *q);
/* Traces the shadow rays of the paths p towards the camera. Those that arrive become splats
 * with weight own / (own + odds * others). */
void vl_two_way_splats(vlTracing *t, const vlPaths *p, uint32_t count, uint32_t depth,
                       vlSplatRows *splats, const vlTwoWayShadows *q);
/* Sets the strategies that begin on the light's side of vertex i, which receives the light of
 * path i after `distance`. cosine: to the geometric normal; in media: the extinction. */
void vl_arrive_from_light(const vlTracing *t, uint32_t depth, const vlPaths *p, uint32_t i,
                          vlReceiver at, float cosine, float distance, const vlFlightEnds *ends,
                          vlWays *to);

/* Fills the views of n points, which belong to the paths p, with points on the lens by the
 * random numbers of `dimension`. */
void vl_look_from(const vlTracing *t, uint32_t n, const vlPaths *p, uint32_t dimension,
                  const vlVec3Row *at, vlCameraSample *views);
/* For cameras of one's own: fills vlTwoWayLanes.area, by which the camera paths of the batch
 * weigh light paths. views: memory. */
void vl_measure_camera_rays(const vlTracing *t, vlCameraSample *views);

/* The BSDFs of n vertices for paths that come from wi (local) and leave in direction wo:
 * back->pdf is the density of sampling wo, back->value is f(wi, wo) |cos wo|. */
void vl_stage_reverse(const vlTracing *t, uint32_t n, const vlVertices *at,
                      const float wi[3][VL_ROW_SIZE], vlBsdfValues *back);
/* The BSDFs for the directions `toward` (world space), and vl_stage_reverse for the way
 * back. */
void vl_stage_there_and_back(const vlTracing *t, uint32_t n, const vlVertices *at,
                             const vlVec3Row *toward, vlBsdfValues *there, vlBsdfValues *back);

/* (S + H) cos / fwd of vertex i (two_way.h), from which a path goes on with this density and
 * cosine. back: density of the way back. */
static inline float vl_carried(const vlWays *ways, uint32_t i, float back, bool specular,
                               float pdf, float merged, float cosine) {
  if (specular)
    return ways->a[i] * cosine;
  return pdf > 0.0f ? (ways->a[i] * back + ways->b[i] + merged) * cosine / pdf : 0.0f;
}

/* A ray that leaves a light. */
typedef struct vlEmission {
  bool valid;
  vlVec3 o, d;
  vlVec3 at, n; /* point and normal on an area light; for other lights, `at` is the argument of
                   vl_emission_density */
  float flux[4];
  float density; /* as vl_emission_density, but for point lights without 1 / distance^2 */
  bool delta;    /* no ray can hit the light */
  /* Of area lights that rays can hit: density of the point per area; as vlSurface.offset; the
   * side that emits: along n (1), against it (-1), or both (0). */
  float area_pdf, offset, side;
  float share; /* of area lights: factor of the spread in direction d (light/spread.h) */
  uint32_t light;
} vlEmission;
vlEmission vl_emission_sample(const vlWorld *world, const vlTwoWay *way, const float lambda[4],
                              float u_choice, float u, float v, float s, float t);
/* Density of the light paths that arrive at a point from direction w (unit, towards the light)
 * after `distance`: per area perpendicular to w and solid angle of w; for delta lights, per
 * area only. The caller multiplies it by the cosine at the point. */
float vl_emission_density(const vlWorld *world, const vlTwoWay *way, uint32_t light, vlVec3 w,
                          float distance, const vlPoint *at);
/* The same for the light of sample i, seen from a point. */
static inline float vl_sampled_density(const vlTracing *t, const vlLightSamples *l, uint32_t i,
                                       vlVec3 from) {
  vlPoint at;
  __builtin_memset(&at, 0, sizeof at);
  at.p = vl_row3(&l->target, i);
  return vl_emission_density(t->world, t->def->two_way, l->light[i], vl_row3(&l->w, i),
                             vl_length(vl_sub(at.p, from)), &at);
}

/* vlEmission.area_pdf at a point of an area light. */
float vl_emission_area_pdf(const vlWorld *world, const vlTwoWay *way, uint32_t light,
                           vlVec3 at);
/* The number of light paths by which a point of an area light is shown to the camera itself
 * (two_way.h), relative to the camera rays that hit it: both are densities per film area.
 * per_square: vlCameraSample; cosine: at the light. */
static inline float vl_shown(const vlTwoWay *way, uint32_t light, float area_pdf,
                             float per_square, float cosine) {
  return way->extent[light] * per_square < way->pixel
             ? way->paths * area_pdf / (per_square * cosine)
             : 0.0f;
}
/* Shows the points at which the n light paths start to the camera. */
void vl_show_lights(vlTracing *t, uint32_t n, const vlPaths *p, const vlLightStarts *starts,
                    vlCameraSample *views, vlSplatRows *splats, const vlTwoWayShadows *q);

/* Whether the BSDF of lane i is all specular, so that the vertex cannot be connected. */
static inline bool vl_all_specular(const vlWorld *world, const vlVertices *at, uint32_t i) {
  const float *x = at->shade.alpha_x, *y = at->shade.alpha_y;
  switch (world->materials.items[at->hits.material[i]].smooth) {
    case VL_SMOOTH_NEVER:
      return false;
    case VL_SMOOTH_BY_ALPHA:
      return vl_ggx_is_smooth(x[i], y[i]);
    case VL_SMOOTH_BY_ALPHA_OR_INDEX:
      return vl_ggx_is_smooth(x[i], y[i]) || at->shade.eta_s[i] == 1.0f;
    case VL_SMOOTH_ALWAYS:
      return true;
  }
  return false;
}

/* Whether camera paths connect to a light path's vertex on the surface of lane i. */
static inline bool vl_is_inner_end(const vlWorld *world, const vlVertices *at, uint32_t i) {
  return world->materials.items[at->hits.material[i]].diffuse;
}

static inline bool vl_has_media(const vlTracing *t) {
  return t->world->media.count > 0;
}
/* The rays' flights, and what vertices on surfaces have in media; null in worlds without. */
static inline vlFlightEnds *vl_flight_ends(const vlTracing *t) {
  return vl_has_media(t) ? &t->s->volume->ends : NULL;
}
static inline vlTwoWayShadows vl_two_way_shadows_of(const vlTracing *t) {
  vlTwoWayRows *r = t->batch->two_way;
  return (vlTwoWayShadows){&t->s->shadow, vl_has_media(t) ? &t->s->volume->shadow : NULL,
                           &r->strategies};
}
/* The vertices of a bounce, on surfaces and in media. */
static inline vlTwoWayVertices vl_two_way_at(const vlTracing *t) {
  const vlTraceScratch *s = t->s;
  return (vlTwoWayVertices){&s->at.paths, vl_has_media(t) ? &s->volume->at : NULL, &s->at,
                            &t->batch->two_way->ways};
}
static inline vlTwoWayVertices vl_two_way_scattered(const vlTracing *t) {
  const vlMediumVertices *in = &t->s->volume->scattered;
  return (vlTwoWayVertices){&in->paths, &in->rows, NULL, &t->batch->two_way->ways};
}
/* Scatters the paths of the n vertices on surfaces; evaluates the way back. Returns how many go
 * on: the scratch's rays, which leave the vertices in its order. */
static inline uint32_t vl_two_way_scatter(vlTracing *t, uint32_t n, uint32_t depth,
                                          uint32_t dimension) {
  vlTraceScratch *s = t->s;
  uint32_t count =
      vl_stage_scatter(t, n, depth + 1, dimension, &s->at, &s->samples, s->order, &s->rays);
  if (vl_has_media(t))
    vl_volume_go_on(t, count, &s->at, &s->volume->at, s->order, &s->rays, &s->volume->rays);
  vl_stage_reverse(t, n, &s->at, s->samples.wi, &t->batch->two_way->back);
  return count;
}
/* The odds (vlFlight.odds) of the path's last flight. ends: null without media. */
static inline float vl_last_odds(const vlFlightEnds *ends, uint32_t lane) {
  return ends ? ends->odds[lane] : 1.0f;
}
static inline const vlCameraView *vl_eye_of(const vlTracing *t, uint32_t lane) {
  return t->batch->eyes ? &t->batch->eyes[lane] : &t->def->two_way->eye;
}
/* What connections over the path's last flight add to S (two_way.h). inv: 1 / cosine, or 1 /
 * extinction. Bounded, so that products with it are finite. */
static inline float vl_linked(const vlTracing *t, const vlFlightEnds *ends, uint32_t lane,
                              float distance, float inv) {
  float linked = t->lanes->link[lane] * distance * distance * inv;
  return ends ? vl_min(linked / ends->odds[lane], 1e25f) : linked;
}
/* 1 + a uniform medium, if this is below 16; else 0. It tells whether the ends of a connection
 * are in the same air. */
static inline uint32_t vl_air(const vlWorld *world, uint32_t medium) {
  return medium < 15 && world->media.items[medium].uniform ? medium + 1 : 0;
}

/* Solid angle of a pixel in a direction whose cosine with the camera's axis is c. At depth 1
 * the pixel's sides are 1 / fx and 1 / fy. */
static inline float vl_camera_view_pixel_area(const vlCameraView *eye, float c) {
  return c * c * c / (eye->fx * eye->fy);
}
/* The same for the camera ray d of a lane; of a camera of one's own, a pixel's area at a
 * distance, divided by the distance squared. 0: no light path is connected there. */
static inline float vl_eye_pixel(const vlTracing *t, uint32_t lane, vlVec3 d, float distance) {
  const vlCameraView *eye = vl_eye_of(t, lane);
  if (!eye->look)
    return vl_camera_view_pixel_area(eye, vl_dot(d, eye->ahead));
  const float(*area)[VL_ROW_SIZE] = (const float(*)[VL_ROW_SIZE])t->lanes->area;
  float at = vl_abs(area[0][lane] + distance * (area[1][lane] + distance * area[2][lane])) /
             (distance * distance);
  return at < VL_INFINITY ? at : 0.0f; /* not for NaN */
}

/* Cell coordinates of the photon map, and the bucket of a cell. */
static inline int32_t vl_photon_cell(float x, float inv_cell) {
  float c = vl_clamp(x * inv_cell, -1e9f, 1e9f);
  int32_t i = (int32_t)c;
  return i - ((float)i > c);
}
static inline uint32_t vl_photon_bucket(int32_t x, int32_t y, int32_t z, uint32_t buckets) {
  uint32_t h = (uint32_t)x * 73856093u ^ (uint32_t)y * 19349663u ^ (uint32_t)z * 83492791u;
  h ^= h >> 15;
  return h & (buckets - 1);
}

/* What of shadow ray k arrives, after vl_volume_pass_media if there are media. passes: one
 * factor per wavelength; scale: a common factor, which includes the MIS weight. Returns false
 * if nothing arrives. */
bool vl_two_way_arrives(const vlTracing *t, uint32_t k, float passes[4], float *scale,
                        const vlTwoWayShadows *q);

/* Packs vlTracing.passed of a light path into 32 bits, for a photon. Only ratios matter,
 * so the largest value counts as 1, and 2 bits give its index. The other two are stored as -512
 * ln(ratio) in 15 bits each, which is exact to 0.1 % down to e^-64. */
static inline uint32_t vl_pack_passed(const vlTracing *t, uint32_t lane) {
  if (!t->world->by_channel)
    return 0;
  const float p[3] = {t->passed[0][lane], t->passed[1][lane], t->passed[2][lane]};
  uint32_t largest = p[0] >= p[1]   ? (p[0] >= p[2] ? 0 : 2)
                     : p[1] >= p[2] ? 1
                                    : 2,
           packed = largest;
  for (uint32_t k = 1; k < 3; k++) {
    float ratio = p[(largest + k) % 3] / vl_max(p[largest], VL_MIN_NORMAL);
    float steps = ratio > 1e-27f ? -512.0f * vl_ln(ratio) + 0.5f : 32767.0f;
    packed |= (uint32_t)vl_clamp(steps, 0.0f, 32767.0f) << (2 + 15 * (k - 1));
  }
  return packed;
}
static inline void vl_unpack_passed(uint32_t packed, float p[3]) {
  uint32_t largest = packed & 3;
  p[largest] = 1.0f;
  for (uint32_t k = 1; k < 3; k++)
    p[(largest + k) % 3] =
        vl_exp((float)(packed >> (2 + 15 * (k - 1)) & 32767u) * (-1.0f / 512.0f));
}
/* The factor on two joined paths that attenuate by RGB channel, a and b as
 * vlTracing.passed: the transmittance at a wavelength of the whole path over the product
 * of those of its parts. */
static inline float vl_joined_factor(const float a[3], const float b[3], float lambda) {
  float both[3] = {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
  float apart = vl_channels_at(a, lambda) * vl_channels_at(b, lambda);
  return apart > 0.0f ? vl_channels_at(both, lambda) / apart : 0.0f;
}

/* Whether path i has only its hero wavelength left. material.hot.c marks such paths by equal
 * wavelengths. */
static inline bool vl_hero_only(const vlPaths *p, uint32_t i) {
  return p->lambda[0][i] == p->lambda[1][i] && p->lambda[0][i] > 0.0f;
}

/* ---- what light paths leave -------------------------------------------------------------- */

/* Whether a photon or vertex of this power is kept. */
static inline bool vl_carries_power(const float power[4]) {
  float sum = ((power[0] + power[1]) + power[2]) + power[3];
  return sum > 0.0f && sum < VL_INFINITY;
}

/* Sets all of the photon of vertex i at `at` but its power. medium: vlPhoton.medium. */
static inline void vl_leave_photon(const vlTracing *t, uint32_t depth,
                                   const vlTwoWayVertices *v, uint32_t i, vlVec3 at,
                                   uint32_t medium, vlPhoton *x) {
  const vlPaths *p = v->paths;
  uint32_t lane = p->lane[i];
  vl_store3(x->p, at);
  vl_store3(x->w, vl_neg(vl_row3(&p->d, i)));
  x->a = v->ways->a[i];
  x->b = v->ways->b[i];
  x->bounce = depth + 1;
  x->id = t->light->first + lane;
  x->alone = vl_hero_only(p, i);
  x->passed = vl_pack_passed(t, lane);
  x->medium = medium;
}

/* Sets what a vertex at `at` that camera paths connect to has of its light path: path, bounce,
 * alone, and vlPhoton.passed in *passed; `air` where there are media. */
static inline void vl_leave_path(const vlTracing *t, uint32_t depth, const vlTwoWayVertices *v,
                                 uint32_t i, vlVec3 at, vlLightVertex *x, uint32_t *passed) {
  uint32_t lane = v->paths->lane[i];
  vl_store3(x->p, at);
  x->path = (t->light->first + lane) & 0x3ffffu;
  x->bounce = (depth + 1) & 255u;
  x->alone = vl_hero_only(v->paths, i);
  x->air = v->rows ? vl_air(t->world, v->rows->medium[i]) & 15u : 0;
  *passed = vl_pack_passed(t, lane);
}

#endif
