/* trace/medium/volume.h: declarations shared by the files of the volumetric path tracer and the
 * two-way tracers. */
#ifndef TRACE_MEDIUM_VOLUME_H
#define TRACE_MEDIUM_VOLUME_H

#include "trace/medium/medium.h"
#include "trace/medium/rows.h"
#include "trace/stages.h"

/* A shadow ray ends at this share of the way to its light. */
#define VL_SHADOW_END (1.0f - 0x1p-21f)
/* Keeps odds above 0, so that a weight of at most 1e20 times a radiance of up to 1e18 is
 * finite. */
static inline float vl_some_odds(float odds) {
  return vl_max(odds, 1e-20f);
}

/* Sets `passed` of shadow ray k, which leaves a path's lane in a medium, or the vertex i on a
 * surface in a direction with cosine wi_z to the normal. */
static inline void vl_shadow_from_medium(const vlTracing *t, uint32_t lane, uint32_t k,
                                         vlShadowFlights *f) {
  for (int c = 0; t->world->by_channel && c < 3; c++)
    f->passed[c][k] = t->passed[c][lane];
}
static inline void vl_shadow_from_surface(const vlTracing *t, const vlVertices *at, uint32_t i,
                                          float wi_z, uint32_t k, vlShadowFlights *f) {
  vl_passed_store(t, at, i, wi_z, k, f->passed);
}

static inline void vl_volume_copy(const vlVolumeRows *a, uint32_t i, vlVolumeRows *b,
                                  uint32_t k) {
  for (int c = 0; c < 4; c++) {
    b->u[c][k] = a->u[c][i];
    b->l[c][k] = a->l[c][i];
  }
  b->medium[k] = a->medium[i];
}

/* The medium on the side of the surface to which w points. */
static inline uint32_t vl_medium_beyond(const vlWorldShape *s, vlVec3 g, vlVec3 w,
                                        uint32_t here) {
  if (s->inside == s->outside)
    return here;
  return vl_dot(w, g) > 0.0f ? s->outside : s->inside;
}

static inline bool vl_is_interface(const vlWorld *world, uint32_t shape) {
  return world->shapes.items[shape].pass_shadow;
}

/* A block of rays on their way through media and interfaces: the n rays of rows from the
 * block's first lane on. The lanes `open` have not arrived yet. */
typedef struct vlTravel {
  vlFlights f;
  vlCrossings x; /* the next surface */
  uint32_t open[VL_FLIGHTS], count;
  bool clear;  /* media are crossed as if they were vacuum */
  bool camera; /* camera rays, which pass what is hidden from the camera */
} vlTravel;
static inline bool vl_meets_interface(const vlWorld *world, const vlCrossings *x, uint32_t i) {
  return x->shape[i] != VL_NONE && vl_is_interface(world, x->shape[i]);
}
/* Clears what may be read of it before it is set. */
void vl_travel_start(vlTravel *k);
/* The surfaces that the open rays meet beyond f.from. */
void vl_travel_closest(const vlTracing *t, vlTravel *k);
/* The next flights of the open lanes: each leads to the surface ahead or to the end of the
 * ray. */
void vl_travel_aim(const vlTracing *t, vlTravel *k, const uint32_t *medium);
/* Lane i passes the interface that it has met: f.from moves past it. Returns the medium that
 * follows. */
uint32_t vl_travel_pass(const vlTracing *t, vlTravel *k, uint32_t i, uint32_t medium);

/* With vlTraceDef.fit: compare the medium of a path that arrives in direction d at a border, of
 * the n shaded vertices, and of the `count` shadow rays that have passed media, with the medium
 * that border or light names (fit.hot.c). */
void vl_fit_border(const vlTracing *t, uint32_t lane, uint32_t shape, vlVec3 g, vlVec3 d,
                   uint32_t medium);
void vl_fit_endless(const vlTracing *t, uint32_t medium);
void vl_fit_surfaces(const vlTracing *t, uint32_t n, const vlVertices *at,
                     const vlVolumeRows *rows);
void vl_fit_shadows(const vlTracing *t, uint32_t count, const vlLightSamples *light,
                    const vlShadowRays *q, const vlShadowFlights *f);

/* Traces the n rays through media and interfaces to their events. depth: number of the bounce;
 * emission: add the emission of the media that the rays cross; pass_light: adds that of the
 * interfaces, may be null. Densities, weights and media change in place; ray origins stay at
 * the last scattering. */
void vl_volume_travel(vlTracing *t, uint32_t n, uint32_t depth, bool emission,
                      vlAddLight *pass_light, vlPaths *rays, vlVolumeRows *rows, vlHits *hits,
                      vlFlightEnds *ends);
void vl_volume_permute(const vlVolumeRows *a, vlVolumeRows *b, const uint32_t *order,
                       uint32_t n);
/* Normalises path i: the mean of its densities becomes 1, and beta becomes its weight. */
void vl_volume_normalise(const vlTracing *t, vlPaths *p, vlVolumeRows *v, uint32_t i);
/* paths [0, n) */
void vl_volume_normalise_all(const vlTracing *t, vlPaths *p, vlVolumeRows *v, uint32_t n);
/* Copies those of the n rays that scatter in media, normalised and moved to the scattering
 * points, which are also written to `points` for light sampling. Returns their number. */
uint32_t vl_volume_gather(const vlTracing *t, uint32_t n, const vlPaths *rays,
                          const vlVolumeRows *rows, const vlFlightEnds *ends,
                          vlMediumVertices *to, vlSurface *points);
/* Samples new directions by the phase function, with Russian roulette as on surfaces. Returns
 * the number of paths that go on, which kept lists. */
uint32_t vl_volume_phase_scatter(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                                 vlMediumVertices *in, uint32_t *kept);
/* Sets what n rays that set out have in media. medium: by lane; null: all paths start in the
 * camera's medium. */
void vl_volume_start(const vlTracing *t, uint32_t n, const uint32_t *medium, vlPaths *rays,
                     vlVolumeRows *rows);
/* After scattering on surfaces: what the `count` rays that leave the vertices in `order` have
 * in media. at_rows: of the vertices. */
void vl_volume_go_on(const vlTracing *t, uint32_t count, const vlVertices *at,
                     const vlVolumeRows *at_rows, const uint32_t *order, const vlPaths *rays,
                     vlVolumeRows *rows);
/* Appends the `count` kept paths to the n rays. Returns their new number. */
uint32_t vl_volume_append(const vlMediumVertices *in, const uint32_t *kept, uint32_t count,
                          uint32_t n, vlPaths *rays, vlVolumeRows *rows);
/* The flights of the `count` shadow rays that are not occluded. beta is the transmittance; the
 * path's densities are relative to the density of light sampling. */
void vl_volume_pass_media(vlTracing *t, const vlPaths *p, uint32_t count, uint32_t depth,
                          const vlShadowRays *q, vlShadowFlights *f);
/* Where the shadow ray of a light sample starts, and the value and density there of the BSDF or
 * phase function. */
typedef struct vlShadowStart {
  vlVec3 o;
  float value[4], pdf;
  uint32_t medium;
} vlShadowStart;
/* Adds the light sample of vertex i as shadow ray number `count`. */
static inline void vl_volume_push_shadow(const vlTracing *t, const vlPaths *p,
                                         const vlVolumeRows *rows, const vlLightSamples *l,
                                         uint32_t i, const vlShadowStart *start, uint32_t count,
                                         vlShadowRays *q, vlShadowFlights *f) {
  vlVec3 w = vl_row3(&l->w, i);
  float length = VL_INFINITY;
  if (!l->distant[i]) { /* unit length: distances to interfaces are needed */
    vlVec3 to = vl_sub(vl_row3(&l->target, i), start->o);
    length = vl_length(to);
    w = vl_normalize(to);
  }
  vl_shadow_way(p, i, start->o, w, length * VL_SHADOW_END, count, q);
  for (int c = 0; c < 4; c++) {
    q->radiance[c][count] = p->beta[c][i] * start->value[c] * l->radiance[c][i] * l->pdf[i];
    f->density[c][count] = rows->u[c][i];
  }
  f->light_pdf[count] = l->pdf[i];
  f->pdf[count] = l->delta[i] ? 0.0f : start->pdf;
  f->medium[count] = start->medium;
  f->from[count] = i;
  vl_shadow_from_medium(t, p->lane[i], count, f);
}
/* Traces `count` shadow rays of light samples and adds the radiance that arrives. */
void vl_volume_shadows(vlTracing *t, const vlPaths *p, const vlLightSamples *light,
                       uint32_t count, uint32_t depth, vlShadowRays *q, vlShadowFlights *f);

/* The inverse of the mean density of ray i over the techniques that could have made it.
 * light_pdf: density of light sampling; 0 if light sampling could not make this path. */
static inline float vl_volume_inverse_density(const vlTracing *t, const vlVolumeRows *v,
                                              uint32_t i, float light_pdf) {
  float density[4];
  for (int c = 0; c < 4; c++)
    density[c] = v->u[c][i] + (light_pdf > 0.0f ? v->l[c][i] * light_pdf : 0.0f);
  return 1.0f / vl_flight_mean(density, vl_volume_rgb(t) ? 3 : 4);
}

/* The mean density of shadow ray k over the channels and over light sampling and BSDF or phase
 * sampling (pdf; 0: light sampling alone). */
static inline float vl_volume_shadow_density(const vlTracing *t, const vlShadowFlights *f,
                                             uint32_t k, float pdf) {
  float density[4];
  for (int c = 0; c < 4; c++)
    density[c] = f->density[c][k] * (f->l[c][k] * f->light_pdf[k] + f->u[c][k] * pdf);
  return vl_flight_mean(density, vl_volume_rgb(t) ? 3 : 4);
}

/* Recorded paths (tracer/record.h): what travel and the lights that rays hit have added to the
 * n rays; and the `count` shadow rays, after they were traced. */
void vl_volume_record_travel(vlTracing *t, uint32_t n, uint32_t depth, const vlPaths *rays,
                             const vlVolumeRows *rows, const vlHits *hits,
                             const vlFlightEnds *ends);
void vl_volume_record_shadows(vlTracing *t, uint32_t count, const vlLightSamples *light,
                              const vlShadowRays *q, const vlShadowFlights *f);

#endif
