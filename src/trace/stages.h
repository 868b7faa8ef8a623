/* trace/stages.h: the stages of a bounce, the batch that they work on, and a worker's memory;
 * private to the hot files of trace. A stage is a function of the arrays in trace/rows.h: what
 * it reads is const, what it writes is not. */
#ifndef TRACE_STAGES_H
#define TRACE_STAGES_H

#include "light/lights.hot.h"
#include "trace/medium/rows.h"
#include "trace/rows.h"
#include "trace/surface/points.h"
#include "world/accel/occluders.h"

/* Materials are evaluated for VL_MATERIAL_LANES lanes at a time, so that the stack of rows for
 * nested textures and bump maps is small. A multiple of VL_LANES. */
enum {
  VL_BUMP_ROWS = 9,
  VL_TEXTURE_ROWS = VL_NODE_ROWS + VL_BUMP_ROWS,
  VL_MATERIAL_LANES = 48
};

/* Memory for worlds in which something attenuates by channel of linear sRGB. */
typedef struct vlByChannel {
  vlTint tint;          /* vlShade.tint of vlTraceScratch.at */
  vlFloatRow passed[3]; /* vlTracing.passed */
} vlByChannel;

typedef struct vlSubsurfaceScratch vlSubsurfaceScratch; /* trace/surface/probes.h */

/* A worker's memory. vl_trace_scratch_size says how large it is for a world, and
 * vl_trace_scratch_begin sets the pointers to what the world needs of the rest. */
struct vlTraceScratch {
  /* From one bounce to the next. */
  vlPaths rays;
  vlHits hits;
  /* Within a bounce. */
  vlVertices at;
  vlLightSamples light;
  union {                  /* one after the other */
    vlBsdfValues values;   /* for light samples */
    vlBsdfSamples samples; /* for the next rays */
  };
  vlShadowRays shadow;
  vlUintRow order; /* by vertex or next ray: where it comes from */
  /* Within a stage. */
  vlCorners corners; /* while vertices are shaded */
  /* stack of rows for nested textures */
  VL_ROW float textures[VL_TEXTURE_ROWS][VL_MATERIAL_LANES];
  /* From batch to batch. */
  vlOccluders occluders; /* of the shadow rays so far */
  /* As long as a path, by lane of the batch; see vlTracing. */
  VL_ROW uint8_t scattered[VL_ROW_SIZE];
  VL_ROW uint16_t bounces[VL_BOUNCE_KINDS][VL_ROW_SIZE];
  vlByChannel *by_channel; /* null: nothing in the world attenuates by channel */
  vlVolumeScratch *volume; /* null: the world has neither media nor subsurface materials */
  vlSubsurfaceScratch *subsurface; /* null: the world has no subsurface materials */
};

/* A batch in progress. A bounce takes its rays from s->rays, and leaves there the rays of the
 * next. */
typedef struct vlTracing {
  const vlWorld *world;
  const vlTraceDef *def;
  vlTraceScratch *s;
  vlTraceBatch *batch;
  const vlSamplerKernels *sampler;
  const vlBsdfKernels *bsdf;
  /* By lane of the batch, only if vlWorld.by_channel: transmittance of the path so far through
   * all that attenuates by channel, for each channel of linear sRGB. vl_channels_at gives the
   * transmittance at a wavelength from these three; beta includes it. */
  float (*passed)[VL_ROW_SIZE];
  uint8_t *scattered; /* by lane of the batch, only with regularisation: 1 if a non-specular
                         lobe has scattered the path */
  uint16_t (*bounces)[VL_ROW_SIZE]; /* by kind and lane of the batch, only with
                                       vlTraceDef.limited: the path's bounces of the kind */
  struct vlTwoWayLanes *lanes;      /* what the paths of two-way tracers carry; else null */
  struct vlLightBatch *light;       /* the paths are light paths; null: camera paths */
} vlTracing;
static inline vlTracing vl_tracing_of(const vlWorld *world, const vlTraceDef *def,
                                      vlTraceScratch *s, vlTraceBatch *batch) {
  return (vlTracing){.world = world,
                     .def = def,
                     .s = s,
                     .batch = batch,
                     .sampler = vl_sampler_kernels(def->isa),
                     .bsdf = vl_bsdf_kernels(def->isa),
                     .passed = s->by_channel ? s->by_channel->passed : NULL,
                     .scattered = s->scattered,
                     .bounces = s->bounces};
}

/* The sampler's numbers for n paths: of one dimension; of a pair of dimensions. */
static inline void vl_draw_1d(const vlTracing *t, uint32_t n, const vlPaths *p,
                              uint32_t dimension, float *u) {
  t->sampler->get_1d(t->def->sampler, n, p->px, p->py, p->index, dimension, u);
}
static inline void vl_draw_2d(const vlTracing *t, uint32_t n, const vlPaths *p,
                              uint32_t dimension, float *u, float *v) {
  t->sampler->get_2d(t->def->sampler, n, p->px, p->py, p->index, dimension, u, v);
}

/* What a tracer does at each bounce with the paths of t->s. */
typedef struct vlBounceSteps {
  /* The n rays have arrived at t->s->hits. Adds the lights that they hit. False: all paths end.
   * May be null. */
  bool (*arrive)(vlTracing *t, uint32_t n, uint32_t depth);
  /* Samples lights and new directions of those of the n paths that scatter in media. Returns
   * the number of paths that go on, which s->volume->kept lists. Null: paths do not meet media.
   */
  uint32_t (*in_media)(vlTracing *t, uint32_t n, uint32_t depth);
  /* The same for n shaded vertices of t->s->at. The rays that go on are in t->s->rays. */
  uint32_t (*on_surfaces)(vlTracing *t, uint32_t n, uint32_t depth);
  /* Adds the light of an emissive interface that a ray passes: a camera ray, and a later one.
   * Null: none is added. */
  vlAddLight *pass_first, *pass_later;
} vlBounceSteps;
/* The bounces of all tracers: traces n paths from t->s->rays on, for at most `max` bounces. */
void vl_trace_bounces(vlTracing *t, uint32_t n, uint32_t max, const vlBounceSteps *steps);
static inline uint32_t vl_bounce_dimension(uint32_t depth) {
  return VL_DIM_BOUNCE + depth * VL_DIM_STRIDE;
}

/* ---- stages ------------------------------------------------------------------------------ */

/* Finds the closest hits of n rays: ids and materials. Rays pass through interfaces;
 * pass_light adds the light of those that emit, may be null; for a mixed material, one of its
 * materials is chosen. camera: the rays are camera rays and have the batch's t_min and t_max.
 */
void vl_stage_hits(vlTracing *t, uint32_t n, bool camera, vlAddLight *pass_light,
                   const vlPaths *rays, vlHits *hits);
/* Adds the radiance of a light that ray i has hit, weighted against light sampling; without
 * media. */
void vl_add_hit_light(vlTracing *t, const vlPaths *rays, const vlVolumeRows *rows,
                      const vlFlightEnds *ends, uint32_t i, const vlHitLight *met, bool sky);
/* Adds radiance that arrives along ray i, times the path's throughput and a weight. */
static inline void vl_add_radiance(vlTracing *t, const vlPaths *rays, uint32_t i,
                                   const float radiance[4], float weight) {
  for (int c = 0; c < 4; c++)
    t->batch->radiance[c][rays->lane[i]] += rays->beta[c][i] * radiance[c] * weight;
}
/* Finds the closest hits of n rays, and writes only ids. camera: the rays have the batch's
 * t_min and t_max, and pass what is hidden from the camera. */
void vl_closest_hits(const vlTracing *t, uint32_t n, bool camera, const vlPaths *rays,
                     vlHits *hits);
/* Replaces the hits of n camera rays on shapes that are hidden from the camera by what the rays
 * meet behind them. */
void vl_pass_hidden(const vlTracing *t, uint32_t n, const vlRays *rays, uint32_t *shape,
                    uint32_t *prim, uint32_t *instance, float *hit);
/* Returns the material of a hit. For a mixed material, chooses one of its materials. */
uint32_t vl_hit_material(const vlWorld *world, const vlPaths *p, const vlHits *h, uint32_t i);
/* Adds the radiance of the lights that the n rays hit: infinite lights and emissive
 * surfaces. */
void vl_stage_emission(vlTracing *t, uint32_t n, const vlPaths *rays, const vlHits *hits);
/* Sets the batch's alpha from its camera rays' hits. */
void vl_stage_alpha(const vlTracing *t, const vlHits *hits);
/* Copies the rays with a hit to vertices, sorted by material. Returns their number. order: by
 * vertex, its ray. */
uint32_t vl_stage_sort(const vlWorld *world, uint32_t n, const vlPaths *rays,
                       const vlHits *hits, uint32_t *order, vlVertices *at);
/* Computes surfaces, materials and shading frames of n vertices that are sorted. Dispersive
 * materials leave their paths only one wavelength. */
void vl_stage_shade(const vlTracing *t, uint32_t n, vlVertices *at);
/* Copies path order[k] of a to path k of b. */
void vl_permute_paths(const vlPaths *a, vlPaths *b, const uint32_t *order, uint32_t n);
/* The rays that go on: of the rays of `to`, ray i from path i of p, keeps those in `order`,
 * which rises, and completes them by what remains the same along a path. */
void vl_gather_rays(const vlPaths *p, const uint32_t *order, uint32_t n, vlPaths *to);
/* Regularisation, where the world's definition enables it: makes lobes rougher for those of the
 * n shaded lanes whose paths have been scattered by a non-specular lobe (regularize.hot.c), and
 * records such scattering by lane of the batch. */
void vl_stage_regularize(const vlTracing *t, uint32_t n, vlVertices *at);
static inline void vl_note_scattered(const vlTracing *t, uint32_t lane) {
  if (t->world->def.regularize)
    t->scattered[lane] = 1;
}
/* The film drops and counts the sample of a path whose throughput is not a number. */
static inline void vl_note_unsound(const vlTracing *t, const vlPaths *p, uint32_t i) {
  float sum = p->beta[0][i] + p->beta[1][i] + p->beta[2][i] + p->beta[3][i];
  if (sum != sum)
    t->batch->radiance[0][p->lane[i]] = __builtin_nanf("");
}
/* Limits of bounces of one kind (limits.hot.c), where vlTraceDef.limited. Begins n paths. */
void vl_limits_start(const vlTracing *t, uint32_t n);
/* Counts the bounces of those of the n sampled vertices whose paths go on: alive[i] is 1. */
void vl_limits_count(const vlTracing *t, uint32_t n, const vlVertices *at,
                     const vlBsdfSamples *samples, const uint32_t *alive);
/* Counts a scattering in a medium. */
static inline void vl_limits_count_medium(const vlTracing *t, uint32_t lane) {
  if (t->def->limited)
    t->bounces[VL_BOUNCE_VOLUME][lane]++;
}
/* Of the n rays, ends those whose paths have reached a limit: they have no hit, and no event in
 * a medium. ends: null without media. */
void vl_limits_end(const vlTracing *t, uint32_t n, const vlPaths *rays, vlHits *hits,
                   struct vlFlightEnds *ends);
/* Sets vlTracing.passed for paths that begin in lanes 0 to n - 1. */
static inline void vl_passed_start(const vlTracing *t, uint32_t n) {
  for (int c = 0; t->world->by_channel && c < 3; c++)
    for (uint32_t i = 0; i < n; i++)
      t->passed[c][i] = 1.0f;
}
/* vlTracing.passed of the path of vertex i if it goes on in direction wi; wi_z is wi's
 * cosine to the normal. Only for worlds with vlWorld.by_channel. */
static inline void vl_passed_on(const vlTracing *t, const vlVertices *at, uint32_t i,
                                float wi_z, float passed[3]) {
  bool crosses = (at->shade.wo[2][i] < 0.0f) != (wi_z < 0.0f);
  for (int c = 0; c < 3; c++)
    passed[c] = t->passed[c][at->paths.lane[i]] * (crosses ? at->shade.tint->rgb[c][i] : 1.0f);
}
/* Stores it in entry k of the rows `to`; for all worlds. */
static inline void vl_passed_store(const vlTracing *t, const vlVertices *at, uint32_t i,
                                   float wi_z, uint32_t k, float (*to)[VL_ROW_SIZE]) {
  float passed[3];
  if (!t->world->by_channel)
    return;
  vl_passed_on(t, at, i, wi_z, passed);
  for (int c = 0; c < 3; c++)
    to[c][k] = passed[c];
}
/* The path of vertex i goes on in a direction with this cosine to the normal. */
static inline void vl_passed_go_on(const vlTracing *t, const vlVertices *at, uint32_t i,
                                   float wi_z) {
  vl_passed_store(t, at, i, wi_z, at->paths.lane[i], t->passed);
}
/* The directions w (world space) of n vertices in their local frames. */
void vl_stage_local(uint32_t n, const vlVertices *at, const vlVec3Row *w,
                    float wi[3][VL_ROW_SIZE]);
/* Evaluates the BSDFs of n vertices for wo (local) and to->wi. */
void vl_stage_bsdf(const vlTracing *t, uint32_t n, const vlVertices *at,
                   const float wo[3][VL_ROW_SIZE], vlBsdfValues *to);
/* Samples them for the vertices' wo, with the random numbers of `dimension`. */
void vl_stage_bsdf_samples(const vlTracing *t, uint32_t n, uint32_t dimension,
                           const vlVertices *at, vlBsdfSamples *to);
/* Evaluates them for the vertices' wo and the directions of their light samples. */
void vl_stage_light_bsdf(const vlTracing *t, uint32_t n, const vlVertices *at,
                         const vlLightSamples *light, vlBsdfValues *to);
/* Whether the value of lane i is not 0; that of no number counts. */
VL_INLINE int vl_has_value(const vlBsdfValues *bsdf, uint32_t i) {
  float sum = bsdf->value[0][i] + bsdf->value[1][i] + bsdf->value[2][i] + bsdf->value[3][i];
  return (sum > 0.0f) | (sum != sum);
}
/* Where a ray in direction w leaves lane i of a surface. */
VL_INLINE vlVec3 vl_surface_origin(const vlSurface *f, uint32_t i, vlVec3 w) {
  return vl_offset_origin(vl_vec3(f->p.x[i], f->p.y[i], f->p.z[i]),
                          vl_vec3(f->g.x[i], f->g.y[i], f->g.z[i]), f->offset[i], w);
}
/* Takes one light sample for each of n paths on their surfaces, with the random numbers of
 * `dimension`. */
void vl_stage_light_samples(const vlTracing *t, uint32_t n, const vlPaths *p,
                            const vlSurface *surface, uint32_t dimension,
                            vlLightSamples *light);
/* Russian roulette: the probability that a path goes on after bounce `depth` (from 1). carried:
 * its largest throughput times its eta scale (pbrt book 14.2.3). The efficiency 1 / (variance *
 * time) is greatest where the probability is proportional to the throughput (Bolin and Meyer
 * 1997). The factor depends on the scene: it grows with the light that a path still meets and
 * falls with the rays that it still takes. The constants are the best over the scenes in
 * docs/performance.md. The first bounces have no roulette, since it spoils the stratification
 * of their samples. */
static inline float vl_roulette_survival(float carried, uint32_t depth) {
  const float factor = 2.0f;
  const uint32_t bounces_without = 2;
  float survive = factor * carried;
  return depth > bounces_without && survive < 1.0f ? survive : 1.0f;
}
/* Finds which of the shadow rays of the paths p are occluded. The radiance of the others is
 * weakened by the surfaces with an alpha that they cross. Chance decides there instead in
 * worlds with interfaces: media between them are passed by rays that find the closest hits. */
void vl_stage_occluded(vlTracing *t, uint32_t count, const vlPaths *p, vlShadowRays *shadow);
/* Samples the BSDFs of n vertices, and writes the rays that go on to `next`: ray k leaves
 * vertex order[k]. Returns their number. depth: the number of this bounce, from 1. */
uint32_t vl_stage_scatter(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                          const vlVertices *at, vlBsdfSamples *samples, uint32_t *order,
                          vlPaths *next);
void vl_path_tracer(vlTracing *t);
void vl_volume_tracer(vlTracing *t); /* in volume.hot.c: path tracer with participating media
                                        and subsurface materials */

/* Evaluates textures, bump maps, normal maps and BSDF parameters for lanes [first, last), which
 * have the same material. */
void vl_stage_material(const vlWorld *world, uint32_t first, uint32_t last, uint32_t material,
                       vlVertices *at, vlTraceScratch *s);
void vl_stage_frames(uint32_t n, const vlPaths *paths, vlSurface *surface, vlShade *shade);

#endif
