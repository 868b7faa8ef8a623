/* trace/stages.h: the stages of a bounce and the arrays that they exchange; private to the hot
 * files of trace. A stage is a function: what it reads is const, what it writes is not.
 *
 *   vlPaths (rays) -> vlHits -> vlVertices: sorted by material, with vlSurface and vlShade
 * (frame, wo, BSDF parameters) vlVertices -> vlLightSamples -> vlBsdfValues -> vlShadowRays ->
 * radiance vlVertices -> vlBsdfSamples -> vlPaths of the next bounce
 *
 * Every array has VL_ROW_SIZE elements. Elements from n on hold old data, which is safe to
 * read: numbers are finite, and indices are valid. */
#ifndef TRACE_STAGES_H
#define TRACE_STAGES_H

#include "color/kernels.h"
#include "trace/bsdf/bsdf.h"
#include "trace/surface/offset.h"
#include "trace/trace.h"
#include "world/accel/occluders.h"

#define VL_ROW __attribute__((aligned(64)))

/* Paths: the ray, the throughput, and what multiple importance sampling needs at the next hit.
 */
typedef struct vlPaths {
  VL_ROW float ox[VL_ROW_SIZE], oy[VL_ROW_SIZE], oz[VL_ROW_SIZE];
  VL_ROW float dx[VL_ROW_SIZE], dy[VL_ROW_SIZE], dz[VL_ROW_SIZE];
  VL_ROW float beta[4][VL_ROW_SIZE];
  VL_ROW float lambda[4][VL_ROW_SIZE];
  VL_ROW float pdf[VL_ROW_SIZE]; /* density per solid angle with which BSDF sampling drew the
                                    direction */
  VL_ROW float from_nx[VL_ROW_SIZE], from_ny[VL_ROW_SIZE],
      from_nz[VL_ROW_SIZE]; /* surface normal at the ray's origin; the light tree uses it */
  VL_ROW float from_side[VL_ROW_SIZE]; /* vlSurface.side at the ray's origin */
  VL_ROW float eta_scale[VL_ROW_SIZE];
  VL_ROW float cone[VL_ROW_SIZE];   /* width of the footprint at the ray's origin */
  VL_ROW float spread[VL_ROW_SIZE]; /* growth of the footprint's width per unit length; negative
                                       where the cone converges */
  VL_ROW uint32_t specular[VL_ROW_SIZE]; /* 1: the ray comes from the camera or a specular lobe,
                                            so MIS has no light sample to weigh it against */
  VL_ROW int32_t px[VL_ROW_SIZE], py[VL_ROW_SIZE];
  VL_ROW uint32_t index[VL_ROW_SIZE];
  VL_ROW uint32_t lane[VL_ROW_SIZE]; /* the path's element of the batch */
  const float *time; /* by lane: the world's time, 0 to 1; null if nothing moves */
} vlPaths;
static inline float vl_path_time(const vlPaths *p, uint32_t i) {
  return p->time ? p->time[p->lane[i]] : 0.0f;
}

/* The world's times of the first n paths, in `room`; null if nothing moves. */
static inline const float *vl_path_times(const vlPaths *p, uint32_t n, float *room) {
  for (uint32_t i = 0; p->time && i < n; i++)
    room[i] = vl_path_time(p, i);
  return p->time ? room : NULL;
}

typedef struct vlHits {
  VL_ROW uint32_t shape[VL_ROW_SIZE], prim[VL_ROW_SIZE], instance[VL_ROW_SIZE],
      material[VL_ROW_SIZE];
  VL_ROW float t[VL_ROW_SIZE]; /* distance along the ray, set for shapes other than triangles;
                                  it identifies the crossing (world/accel/accel.h) */
} vlHits;

typedef struct vlSurface {
  VL_ROW float px[VL_ROW_SIZE], py[VL_ROW_SIZE], pz[VL_ROW_SIZE];
  VL_ROW float t[VL_ROW_SIZE];
  VL_ROW float gx[VL_ROW_SIZE], gy[VL_ROW_SIZE], gz[VL_ROW_SIZE]; /* geometric normal, unit */
  VL_ROW float nx[VL_ROW_SIZE], ny[VL_ROW_SIZE], nz[VL_ROW_SIZE]; /* shading normal, unit */
  VL_ROW float ux[VL_ROW_SIZE], uy[VL_ROW_SIZE], uz[VL_ROW_SIZE]; /* dpdu */
  VL_ROW float vx[VL_ROW_SIZE], vy[VL_ROW_SIZE], vz[VL_ROW_SIZE]; /* dpdv */
  VL_ROW float u[VL_ROW_SIZE], v[VL_ROW_SIZE];
  VL_ROW float offset[VL_ROW_SIZE]; /* distance along the geometric normal by which a new ray's
                                       origin is moved off the   surface */
  VL_ROW float uv_scale[VL_ROW_SIZE]; /* uv per world length */
  VL_ROW float width[VL_ROW_SIZE];    /* width of the footprint, world units */
  VL_ROW float across_u[VL_ROW_SIZE],
      across_v[VL_ROW_SIZE]; /* the footprint's axes in uv; only set if the world */
  VL_ROW float along_u[VL_ROW_SIZE],
      along_v[VL_ROW_SIZE]; /* has image textures (footprint.hot.c) */
  VL_ROW float
      curvature[VL_ROW_SIZE]; /* mean curvature of the shading normals: positive where convex */
  VL_ROW float dn[6][VL_ROW_SIZE]; /* dndu, dndv; for triangles only if the material has a bump
                                      map (material.hot.c) */
  VL_ROW float
      no_cosine[VL_ROW_SIZE];     /* 1: light from all directions counts equally (in media); 0:
                                     light is weighted by the cosine to the normal */
  VL_ROW float side[VL_ROW_SIZE]; /* 1 or -1: only light on the side of n or -n counts, the
                                     viewer's; 0: on both sides */
} vlSurface;

/* Corners of the triangles that a batch hits, one triangle per lane. */
typedef struct vlCorners {
  VL_ROW float p[9][VL_ROW_SIZE]; /* x y z of corners 0, 1, 2; world space */
  VL_ROW float n[9][VL_ROW_SIZE]; /* vertex normals; zero if the mesh has none */
  VL_ROW float uv[6][VL_ROW_SIZE];
  VL_ROW float error[VL_ROW_SIZE]; /* bound of the rounding error of the instance's transform */
  VL_ROW float flip[VL_ROW_SIZE];  /* -1: the shape's normals are reversed; else 1 */
} vlCorners;

typedef struct vlShade {
  VL_ROW float tx[VL_ROW_SIZE], ty[VL_ROW_SIZE],
      tz[VL_ROW_SIZE]; /* frame: tangent; bitangent = n x t */
  VL_ROW float bx[VL_ROW_SIZE], by[VL_ROW_SIZE], bz[VL_ROW_SIZE];
  VL_ROW float wo[3][VL_ROW_SIZE]; /* local */
  VL_ROW float reflectance[4][VL_ROW_SIZE], eta[4][VL_ROW_SIZE], k[4][VL_ROW_SIZE];
  /* Only set if vlWorld.by_channel. tint_rgb: factor of each channel of linear sRGB on light
   * that crosses the surface (the fourth row is not used). tint: the factor at the path's
   * wavelengths, after all that the path has crossed. */
  VL_ROW float tint_rgb[4][VL_ROW_SIZE], tint[4][VL_ROW_SIZE];
  VL_ROW float alpha_x[VL_ROW_SIZE], alpha_y[VL_ROW_SIZE], eta_s[VL_ROW_SIZE];
  const vlCoatTable *coat[VL_ROW_SIZE];
  VL_ROW float own[VL_BSDF_ROWS][VL_ROW_SIZE]; /* rows that depend on the kind;
                                                  trace/bsdf/bsdf.h names them */
  VL_ROW uint32_t seed[VL_ROW_SIZE];
  const vlMeasured *measured[VL_ROW_SIZE];
} vlShade;

/* The paths of a bounce that have hit surfaces, sorted by material. */
typedef struct vlVertices {
  vlPaths paths; /* the rays that have arrived */
  vlHits hits;
  vlSurface surface;
  vlShade shade;
} vlVertices;

/* The BSDFs for given directions; trace/bsdf/bsdf.h says what value and pdf are. */
typedef struct vlBsdfValues {
  VL_ROW float wi[3][VL_ROW_SIZE]; /* local */
  VL_ROW float value[4][VL_ROW_SIZE], pdf[VL_ROW_SIZE];
} vlBsdfValues;

/* Directions that the BSDFs have sampled. */
typedef struct vlBsdfSamples {
  VL_ROW float wi[3][VL_ROW_SIZE]; /* local */
  VL_ROW float weight[4][VL_ROW_SIZE], pdf[VL_ROW_SIZE], eta_scale[VL_ROW_SIZE];
  VL_ROW uint32_t flags[VL_ROW_SIZE];
} vlBsdfSamples;

/* Random numbers of a stage, by lane. */
typedef struct vlNumbers {
  VL_ROW float u0[VL_ROW_SIZE], u1[VL_ROW_SIZE], u2[VL_ROW_SIZE];
} vlNumbers;

typedef struct vlLightSamples {
  VL_ROW uint32_t light[VL_ROW_SIZE]; /* index of the chosen light; VL_INNER: not chosen yet */
  VL_ROW float pmf[VL_ROW_SIZE];
  VL_ROW float wx[VL_ROW_SIZE], wy[VL_ROW_SIZE], wz[VL_ROW_SIZE]; /* towards the light, unit */
  VL_ROW float tx[VL_ROW_SIZE], ty[VL_ROW_SIZE],
      tz[VL_ROW_SIZE];                   /* point that must be visible */
  VL_ROW float radiance[4][VL_ROW_SIZE]; /* already divided by the pdf */
  VL_ROW float pdf[VL_ROW_SIZE];      /* per solid angle, times the probability of choosing the
                                         light; 0:      no sample */
  VL_ROW uint32_t delta[VL_ROW_SIZE]; /* a delta light: a BSDF sample cannot hit it */
  VL_ROW uint32_t distant[VL_ROW_SIZE]; /* 1: the target is infinitely far, and tx, ty, tz hold
                                           the direction */
} vlLightSamples;

typedef struct vlShadowRays {
  VL_ROW float ox[VL_ROW_SIZE], oy[VL_ROW_SIZE], oz[VL_ROW_SIZE], dx[VL_ROW_SIZE],
      dy[VL_ROW_SIZE], dz[VL_ROW_SIZE], t_max[VL_ROW_SIZE];
  VL_ROW float radiance[4][VL_ROW_SIZE];
  VL_ROW uint32_t lane[VL_ROW_SIZE];
  VL_ROW float time[VL_ROW_SIZE]; /* the world's time; only set if something moves */
  uint8_t occluded[VL_ROW_SIZE];
} vlShadowRays;

/* Moves the way and the radiance of shadow ray i to place k. */
static inline void vl_shadow_move(vlShadowRays *q, uint32_t i, uint32_t k) {
  q->ox[k] = q->ox[i];
  q->oy[k] = q->oy[i];
  q->oz[k] = q->oz[i];
  q->dx[k] = q->dx[i];
  q->dy[k] = q->dy[i];
  q->dz[k] = q->dz[i];
  q->t_max[k] = q->t_max[i];
  for (int c = 0; c < 4; c++)
    q->radiance[c][k] = q->radiance[c][i];
}

/* Materials are evaluated for VL_MATERIAL_LANES lanes at a time, so that the stack of rows for
 * nested textures and bump maps is small. A multiple of VL_LANES. */
enum {
  VL_BUMP_ROWS = 9,
  VL_TEXTURE_ROWS = VL_NODE_ROWS + VL_BUMP_ROWS,
  VL_MATERIAL_LANES = 48
};

/* Additional data of paths through media (volume.hot.c). u and l are the path's rescaled
 * densities (pbrt book 14.2.2): u for the directions as they were sampled, l as if light
 * sampling had drawn the last direction. */
typedef struct vlVolumeRows {
  VL_ROW float u[4][VL_ROW_SIZE], l[4][VL_ROW_SIZE];
  VL_ROW uint32_t medium[VL_ROW_SIZE]; /* medium at the ray's origin; VL_NONE: vacuum */
} vlVolumeRows;

/* How a ray ends: values of vlVolumeScratch.event. */
enum { VL_ON_SURFACE, VL_IN_SKY, VL_IN_MEDIUM, VL_AT_END };
typedef struct vlVolumeScratch {
  vlPaths scattered;    /* paths that scatter in media */
  vlVolumeRows a, b, c; /* data of vlTraceScratch.rays, of its vertices and of `scattered` */
  VL_ROW uint8_t event[VL_ROW_SIZE];
  VL_ROW float t[VL_ROW_SIZE];        /* distance along the ray at which a medium scatters */
  VL_ROW float odds[VL_ROW_SIZE];     /* by lane: vlFlight.odds of the path's last flight */
  VL_ROW float given[4][VL_ROW_SIZE]; /* only if paths are recorded: radiance that media added
                                         to the last flight */
  /* by shadow ray: densities of the light sample and of the BSDF or phase function */
  VL_ROW float light_pdf[VL_ROW_SIZE], pdf[VL_ROW_SIZE], density[4][VL_ROW_SIZE];
  VL_ROW uint32_t shadow_medium[VL_ROW_SIZE], from[VL_ROW_SIZE];
  /* by shadow ray: beta, u, l and odds of its flight (vlFlight) */
  VL_ROW float shadow_beta[4][VL_ROW_SIZE], shadow_u[4][VL_ROW_SIZE], shadow_l[4][VL_ROW_SIZE],
      shadow_odds[VL_ROW_SIZE];
  VL_ROW float
      shadow_passed[3][VL_ROW_SIZE]; /* vlTraceScratch.passed at the shadow ray's origin */
  VL_ROW uint32_t kept[VL_ROW_SIZE]; /* indices of the paths of `scattered` that go on */
} vlVolumeScratch;

/* Working memory for paths through subsurface materials (subsurface.hot.c). */
typedef struct vlSubsurfaceScratch {
  vlPaths paths; /* copy of all paths of the bounce */
  vlVolumeRows rows;
  VL_ROW uint8_t alive[VL_ROW_SIZE]; /* by path: 1 if the path goes on */
  /* by probe: index of its path, material, and medium of the path before it entered the solid
   */
  VL_ROW uint32_t place[VL_ROW_SIZE], material[VL_ROW_SIZE], medium[VL_ROW_SIZE];
  VL_ROW float px[VL_ROW_SIZE], py[VL_ROW_SIZE], pz[VL_ROW_SIZE], nx[VL_ROW_SIZE],
      ny[VL_ROW_SIZE], nz[VL_ROW_SIZE];
  VL_ROW float sigma[4][VL_ROW_SIZE], albedo[4][VL_ROW_SIZE];
  VL_ROW float
      entry_eta_scale[VL_ROW_SIZE]; /* by path: eta_scale of the refraction into the solid */
  VL_ROW float length[VL_ROW_SIZE], t_min[VL_ROW_SIZE]; /* length of the probe's segment; start
                                                           of the part not yet searched */
  VL_ROW uint32_t found[VL_ROW_SIZE];                   /* number of crossings found so far */
  vlHits hits;                        /* one of these crossings, chosen at random */
  VL_ROW uint32_t entry[VL_ROW_SIZE]; /* by exit: index of its probe */
  VL_ROW float from[VL_ROW_SIZE];
} vlSubsurfaceScratch;

/* vl_trace_scratch_size says how large it is for a world, and vl_trace_scratch_begin sets the
 * pointers to what the world needs of the rest. */
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
  VL_ROW uint32_t order[VL_ROW_SIZE];
  /* Within a stage. */
  vlNumbers numbers;
  vlCorners corners; /* while vertices are shaded */
  VL_ROW float textures[VL_TEXTURE_ROWS]
                       [VL_MATERIAL_LANES]; /* stack of rows for nested textures */
  /* From batch to batch. */
  vlOccluders occluders; /* of the shadow rays so far */
  /* As long as a path. */
  /* By lane of the batch, only if vlWorld.by_channel: transmittance of the path so far through
   * all that attenuates by channel, for each channel of linear sRGB. vl_channels_at gives the
   * transmittance at a wavelength from these three; beta includes it. */
  VL_ROW float passed[3][VL_ROW_SIZE];
  VL_ROW uint8_t scattered[VL_ROW_SIZE]; /* by lane of the batch, only with regularisation: 1 if
                                            a non-specular lobe has scattered the path */
  vlVolumeScratch *volume; /* null: the world has neither media nor subsurface materials */
  vlSubsurfaceScratch *subsurface; /* null: the world has no subsurface materials */
};

/* A batch in progress. A bounce takes its rays from s->rays, and leaves there the rays of the
 * next.
 */
typedef struct vlTracing {
  const vlWorld *world;
  const vlTraceDef *def;
  vlTraceScratch *s;
  vlTraceBatch *batch;
  const vlSamplerKernels *sampler;
  const vlBsdfKernels *bsdf;
  struct vlLightBatch *light; /* the paths are light paths; null: camera paths */
} vlTracing;

/* What a tracer does at each bounce with the paths of t->s. */
typedef struct vlBounceSteps {
  /* The n rays have arrived at t->s->hits. Adds the lights that they hit. False: all paths end.
   * May be null. */
  bool (*arrive)(vlTracing *t, uint32_t n, uint32_t depth);
  /* Samples lights and new directions of those of the n paths that scatter in media. Returns
   * the number of paths that go on, which volume.kept lists. Null: paths do not meet media. */
  uint32_t (*in_media)(vlTracing *t, uint32_t n, uint32_t depth);
  /* The same for n shaded vertices of t->s->at. The rays that go on are in t->s->rays. */
  uint32_t (*on_surfaces)(vlTracing *t, uint32_t n, uint32_t depth);
} vlBounceSteps;
/* The bounces of all tracers: traces n paths from t->s->rays on, for at most `most` bounces. */
void vl_trace_bounces(vlTracing *t, uint32_t n, uint32_t most, const vlBounceSteps *steps);
static inline uint32_t vl_bounce_dimension(uint32_t depth) {
  return VL_DIM_BOUNCE + depth * VL_DIM_STRIDE;
}

/* ---- stages
 * ------------------------------------------------------------------------------------------------------
 */

/* Finds the closest hits of n rays: ids and materials. Rays pass through interfaces, whose
 * emission is added; for a mixed material, one of its materials is chosen. camera: the rays are
 * camera rays and have the batch's t_min and t_max. */
void vl_stage_hits(vlTracing *t, uint32_t n, bool camera, const vlPaths *rays, vlHits *hits);
/* Finds the closest hits of n rays, and writes only ids. camera: the rays have the batch's
 * t_min and t_max. */
void vl_closest_hits(const vlTracing *t, uint32_t n, bool camera, const vlPaths *rays,
                     vlHits *hits);
/* Traces lane i's ray again from t_min on, and writes the hit to h. t_max: the batch's row, or
 * null for no limit. The ray is counted. */
void vl_closest_beyond(vlTracing *t, const vlPaths *p, vlHits *h, uint32_t i, float t_min,
                       const float *t_max);
/* Returns the material of a hit. For a mixed material, chooses one of its materials. */
uint32_t vl_hit_material(const vlWorld *world, const vlPaths *p, const vlHits *h, uint32_t i);
/* Adds the radiance of the lights that the n rays hit: infinite lights and emissive surfaces.
 */
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
    t->s->scattered[lane] = 1;
}
/* Sets vlTraceScratch.passed for paths that begin in lanes 0 to n - 1. */
static inline void vl_passed_start(const vlTracing *t, uint32_t n) {
  for (int c = 0; t->world->by_channel && c < 3; c++)
    for (uint32_t i = 0; i < n; i++)
      t->s->passed[c][i] = 1.0f;
}
/* vlTraceScratch.passed of the path of vertex i if it goes on in direction wi; wi_z is wi's
 * cosine to the normal. Only for worlds with vlWorld.by_channel. */
static inline void vl_passed_on(const vlTracing *t, const vlVertices *at, uint32_t i,
                                float wi_z, float passed[3]) {
  bool crosses = (at->shade.wo[2][i] < 0.0f) != (wi_z < 0.0f);
  for (int c = 0; c < 3; c++)
    passed[c] =
        t->s->passed[c][at->paths.lane[i]] * (crosses ? at->shade.tint_rgb[c][i] : 1.0f);
}
/* The path of vertex i goes on in a direction with this cosine to the normal. */
static inline void vl_passed_go_on(const vlTracing *t, const vlVertices *at, uint32_t i,
                                   float wi_z) {
  float passed[3];
  if (!t->world->by_channel)
    return;
  vl_passed_on(t, at, i, wi_z, passed);
  for (int c = 0; c < 3; c++)
    t->s->passed[c][at->paths.lane[i]] = passed[c];
}
/* The directions w (world space) of n vertices in their local frames. */
void vl_stage_local(uint32_t n, const vlVertices *at, const float *wx, const float *wy,
                    const float *wz, float wi[3][VL_ROW_SIZE]);
/* Evaluates the BSDFs of n vertices for wo (local) and to->wi. */
void vl_stage_bsdf(const vlTracing *t, uint32_t n, const vlVertices *at,
                   const float wo[3][VL_ROW_SIZE], vlBsdfValues *to);
/* The same for the vertices' wo and the directions of their light samples. */
void vl_stage_light_bsdf(const vlTracing *t, uint32_t n, const vlVertices *at,
                         const vlLightSamples *light, vlBsdfValues *to);
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
/* Finds which of the shadow rays of the paths p are occluded. */
void vl_stage_occluded(vlTracing *t, uint32_t count, const vlPaths *p, vlShadowRays *shadow);
/* Samples the BSDFs of n vertices, and writes the rays that go on to `next`: ray k leaves
 * vertex order[k]. Returns their number. depth: the number of this bounce, from 1. */
uint32_t vl_stage_scatter(vlTracing *t, uint32_t n, uint32_t depth, uint32_t dimension,
                          const vlVertices *at, vlBsdfSamples *samples, uint32_t *order,
                          vlPaths *next);
void vl_path_tracer(vlTracing *t);
void vl_volume_tracer(vlTracing *t); /* in volume.hot.c: path tracer with participating media
                                        and subsurface materials */
/* Subsurface scattering for the n rays; ray k was just sampled at vertex s->order[k]. A path
 * that entered a subsurface material is moved to an exit point, where lights are sampled, or
 * ends. Returns the number of all paths that go on. */
uint32_t vl_stage_subsurface(vlTracing *t, uint32_t n, uint32_t depth);

/* Computes the surface points that the rays hit. Of the hits, it reads only the ids. */
void vl_stage_surface(const vlWorld *world, uint32_t n, const vlPaths *paths,
                      const vlHits *hits, vlCorners *corners, vlSurface *surface);
/* What media need of the surfaces that the rays of a block hit: distance, geometric normal and
 * offset (vlSurface), with the same bits. shape, prim, instance, hit (vlHits.t): rows of the
 * hits' ids. */
enum { VL_CROSSINGS = 64 };
typedef struct vlCrossings {
  uint32_t *shape, *prim, *instance;
  float *hit;
  VL_ROW float t[VL_CROSSINGS], gx[VL_CROSSINGS], gy[VL_CROSSINGS], gz[VL_CROSSINGS],
      offset[VL_CROSSINGS];
  VL_ROW float corner[3][3][VL_CROSSINGS], normal[3][3][VL_CROSSINGS], error[VL_CROSSINGS],
      flip[VL_CROSSINGS];
} vlCrossings;
/* Computes the crossings of `count` lanes of a block of n rays. */
void vl_stage_crossings(const vlWorld *world, uint32_t n, const vlRays *rays,
                        const uint32_t *lanes, uint32_t count, vlCrossings *x);
/* Computes the footprints' axes in uv. The surfaces must be computed already. */
void vl_stage_footprints(uint32_t n, const vlPaths *paths, vlSurface *surface);
/* Evaluates textures, bump maps, normal maps and BSDF parameters for lanes [first, last), which
 * have the same material. */
void vl_stage_material(const vlWorld *world, uint32_t first, uint32_t last, uint32_t material,
                       vlVertices *at, vlTraceScratch *s);
void vl_stage_frames(uint32_t n, const vlPaths *paths, vlSurface *surface, vlShade *shade);
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

/* One surface point, for lanes that are computed one by one (hit lights, mixed materials). t:
 * as in vlHits. */
typedef struct vlPoint {
  vlVec3 p, g, n; /* geometric, shading normal */
  float u, v, t, offset;
} vlPoint;
/* A hit's distance t is a float. When the distance is computed again in double, it lies within
 * t (1
 * -+ VL_REFIND), which allows 8 float roundings. VL_REFIND_LEAST keeps that interval from being
 * empty at t = 0. */
#define VL_REFIND 0x1p-21
#define VL_REFIND_LEAST 1e-37

/* The start of a ray segment past t by a margin. It is larger than t_min even if t_min and
 * margin are 0. */
static inline float vl_past(float t, float margin, float t_min) {
  return vl_max(t, t_min) + vl_max(margin, VL_MIN_POSITIVE);
}
/* Returns the start of a ray segment just past a surface point. The margin comes from the bound
 * of the point's error, and from that of distances from the ray's origin (as in vl_offset_end).
 * The result is larger than t_min. */
static inline float vl_past_crossing(float t, vlVec3 g, float offset, vlVec3 d, float t_min) {
  float error = 2.0f * (offset + 2.0f * VL_GAMMA(5) * vl_abs(t) * vl_abs_dot(g, d));
  return vl_past(t, error / vl_max(vl_abs(vl_dot(g, d)), 0.01f) + VL_GAMMA(8) * vl_abs(t),
                 t_min);
}
static inline float vl_past_surface(const vlPoint *at, vlVec3 d, float t_min) {
  return vl_past_crossing(at->t, at->g, at->offset, d, t_min);
}
/* The surface point that lane i's ray meets. */
vlPoint vl_hit_point(const vlWorld *world, const vlPaths *p, const vlHits *h, uint32_t i);
vlPoint vl_point_at_time(const vlWorld *world, float time, vlVec3 o, vlVec3 d, uint32_t shape,
                         uint32_t prim, uint32_t instance, float t);
static inline vlPoint vl_point_at(const vlWorld *world, vlVec3 o, vlVec3 d, uint32_t shape,
                                  uint32_t prim, uint32_t instance, float t) {
  return vl_point_at_time(world, 0.0f, o, d, shape, prim, instance, t);
}

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
/* Evaluates infinite light k of the world for up to VL_SKY_BLOCK rays that hit nothing. out:
 * radiance and density as in vlHitLight, in the order of lanes. */
enum { VL_SKY_BLOCK = 64 };
typedef struct vlSkyHits {
  float radiance[4][VL_SKY_BLOCK], pdf[VL_SKY_BLOCK];
} vlSkyHits;
void vl_hit_sky(const vlWorld *world, const vlPaths *p, const uint32_t *lanes, uint32_t count,
                size_t k, vlSkyHits *out);
void vl_upsample_rows(const vlRgbTable *table, bool albedo, uint32_t padded,
                      float (*rgb)[VL_SKY_BLOCK], float (*lambda)[VL_SKY_BLOCK],
                      float (*value)[VL_SKY_BLOCK]);
/* vl_hit_infinite: infinite light k of the world as seen by ray i. vl_hit_emission: the
 * emissive surface at hit i; returns false if the surface does not emit on this side. */
vlHitLight vl_hit_infinite(const vlWorld *world, const vlPaths *p, uint32_t i, size_t k);
bool vl_hit_emission(const vlWorld *world, const vlPaths *p, const vlHits *h, uint32_t i,
                     vlHitLight *met);
/* Calls `add` for each light that the n rays hit: for the infinite lights of rays that hit
 * nothing (shape VL_NONE), with the light's `at` unset, and for emissive surfaces. event: how
 * the rays end (vlVolumeScratch); null: without media. */
typedef void vlAddLight(vlTracing *t, const vlPaths *rays, uint32_t i, const vlHitLight *met,
                        bool sky);
void vl_stage_lights_hit(vlTracing *t, uint32_t n, const vlPaths *rays, const vlHits *hits,
                         const uint8_t *event, vlAddLight *add);
/* uv of the emission's image at a point of an area light that a ray has hit. */
vlVec2 vl_emission_uv(const vlWorld *world, const vlWorldLight *light, const vlPoint *at);
/* Radiance of an infinite light for a ray from o in direction d that hits nothing, and the
 * density of sampling it. */
void vl_infinite_at(const vlWorld *world, const vlWorldLight *light, vlVec3 o, vlVec3 d,
                    const float lambda[4], float out[4]);
float vl_infinite_pdf(const vlWorld *world, const vlWorldLight *light, vlVec3 o, vlVec3 d);
/* Density per solid angle, seen from `from`, of sampling this point of an area light. It
 * excludes the probability of choosing the light. */
float vl_area_pdf(const vlWorld *world, const vlWorldLight *light, vlVec3 from,
                  const vlPoint *at);

/* Copies element i of a to element k of b. */
static inline void vl_path_copy(const vlPaths *a, uint32_t i, vlPaths *b, uint32_t k) {
  b->ox[k] = a->ox[i];
  b->oy[k] = a->oy[i];
  b->oz[k] = a->oz[i];
  b->dx[k] = a->dx[i];
  b->dy[k] = a->dy[i];
  b->dz[k] = a->dz[i];
  for (int c = 0; c < 4; c++) {
    b->beta[c][k] = a->beta[c][i];
    b->lambda[c][k] = a->lambda[c][i];
  }
  b->pdf[k] = a->pdf[i];
  b->from_nx[k] = a->from_nx[i];
  b->from_ny[k] = a->from_ny[i];
  b->from_nz[k] = a->from_nz[i];
  b->from_side[k] = a->from_side[i];
  b->eta_scale[k] = a->eta_scale[i];
  b->cone[k] = a->cone[i];
  b->spread[k] = a->spread[i];
  b->specular[k] = a->specular[i];
  b->px[k] = a->px[i];
  b->py[k] = a->py[i];
  b->index[k] = a->index[i];
  b->lane[k] = a->lane[i];
}

/* ---- small common pieces
 * ----------------------------------------------------------------------------------------- */

static inline float vl_power_heuristic(float a, float b) {
  float a2 = a * a, b2 = b * b;
  return a2 < VL_INFINITY ? (a2 + b2 > 0.0f ? a2 / (a2 + b2) : 0.0f) : 1.0f;
}

/* How surface lane i receives light, and how the point that ray i left did. */
static inline __attribute__((always_inline)) vlReceiver vl_receiver(const vlSurface *f,
                                                                    uint32_t i) {
  vlVec3 n = vl_mul(vl_vec3(f->nx[i], f->ny[i], f->nz[i]), 1.0f - f->no_cosine[i]);
  return (vlReceiver){vl_vec3(f->px[i], f->py[i], f->pz[i]), n, f->side[i]};
}
static inline vlReceiver vl_receiver_before(const vlPaths *p, uint32_t i) {
  vlReceiver r = {vl_lane3(p->ox, p->oy, p->oz, i),
                  vl_lane3(p->from_nx, p->from_ny, p->from_nz, i), p->from_side[i]};
  return r;
}
static inline void vl_set_lane3(float *x, float *y, float *z, uint32_t i, vlVec3 v) {
  x[i] = v.x;
  y[i] = v.y;
  z[i] = v.z;
}
/* Axes (full widths) of the ellipse in which a cone around a ray of direction d meets a surface
 * with normal g. width: the cone's width there. The axis along the ray is at most 64 times as
 * long as the axis across the ray. */
typedef struct vlFootprint {
  vlVec3 across, along;
} vlFootprint;
static inline vlFootprint vl_footprint_of(vlVec3 d, vlVec3 g, float width) {
  float cosine = vl_abs(vl_dot(d, g));
  vlVec3 a = vl_cross(g, d);
  float l2 = vl_length2(a),
        inv =
            l2 > 1e-12f
                ? /* the sine is above 1e-6, so the cross product is more than rounding error */
                1.0f / __builtin_sqrtf(l2)
                : 0.0f;
  vlFrame any = vl_frame_from_z(g);
  a.x = inv > 0.0f ? a.x * inv : any.x.x;
  a.y = inv > 0.0f ? a.y * inv : any.x.y;
  a.z = inv > 0.0f ? a.z * inv : any.x.z;
  vlFootprint r = {vl_mul(a, width),
                   vl_mul(vl_cross(a, g), width / vl_max(cosine, 1.0f / 64.0f))};
  return r;
}
static inline void vl_path_lambda(const vlPaths *p, uint32_t i, float lambda[4]) {
  for (int c = 0; c < 4; c++)
    lambda[c] = p->lambda[c][i];
}

#endif
