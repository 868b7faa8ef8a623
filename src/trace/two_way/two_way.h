/* trace/two_way/two_way.h: the two-way tracers: light paths connect to the camera (splats) and merge with camera paths
 * at surfaces and in media (Georgiev et al. 2012, Hachisuka et al. 2012). The declarations shared by both sides; render
 * runs the passes.
 *
 *   light paths (one pass) -> splats (film points, radiance) and photons -> vlPhotonMap -> camera paths -> radiance
 *
 * One path can be made by several strategies, weighted by the balance heuristic: the camera path hits a light, it
 * samples a light (next event), a light path connects to the camera, and both merge within `radius` at any vertex
 * between that is not specular. Let P_j be the density of the camera path's first j vertices, L_j that of the light
 * path's from its start to vertex j, N light paths, H = N pi radius^2. Merging at j: H P_j L_j; connecting to the
 * camera: N L_1. Divided by P_t L_t, the strategies before t sum to
 *   S_1 = N / p(z_1),   S_(t+1) = (S_t + H) rev_(t+1) cos_t / (fwd_t cos_(t+1))
 * with fwd and rev the densities of the directions as sampled and reversed. Distances cancel, so that each path carries
 * only one number (`carry` = (S + H) cos / fwd). The light's side is the same, from its end. At deltas fwd = rev and
 * H = 0.
 *
 * In media cos is the density of the medium at the vertex, vl_medium_extinction: it does not depend on the wavelength,
 * so that both kinds of paths compute the same weights; H = N 4/3 pi radius^3. The probabilities of flights are the
 * same both ways and cancel, too. The exceptions are the segments that light samples and camera connections make
 * without a flight: there the odds of the flight (vlFlight.odds) are a factor. Wavelengths have their own balance
 * heuristic, within each strategy: over the densities of the four wavelengths (trace/medium/volume.h). */
#ifndef TRACE_TWO_WAY_TWO_WAY_H
#define TRACE_TWO_WAY_TWO_WAY_H

#include "trace/trace.h"

/* A perspective camera with a round lens or none, as light paths connect to it. Unit axes; world units. */
typedef struct vlCameraView {
  bool sees; /* false: another kind of camera; no splats */
  vlVec3 position, right, down, ahead;
  float fx, fy, cx, cy;
  float lens_radius, focus; /* focus: depth of the plane of focus; lens_radius 0: pinhole */
  float near_plane, far_plane;
  float low_x, low_y, high_x, high_y; /* bounds of film points that reach a pixel */
} vlCameraView;

/* A photon: a vertex of a light path. power: flux over |w . geometric normal|, so that a BSDF's value (with its cosine)
 * times power over (pi radius^2 N) is radiance. */
typedef struct vlPhoton {
  float p[3], w[3]; /* w: unit, towards the previous vertex */
  float power[4];
  float a, b;           /* strategies that begin nearer to the light: a * rev + b, relative to this vertex */
  uint32_t bounce : 31; /* from 1: vertices of the light path so far, without the one on the light */
  uint32_t alone : 1;   /* only the hero wavelength is left, with the weight of all four */
  uint32_t id;          /* unique in a pass, whatever the order of work */
  uint32_t passed;      /* vlVolumeRows.passed, packed (stages.h); only with vlWorld.absorbs_by_channel */
  uint32_t medium;      /* 1 + the medium of the vertex; power is then divided by sigma_s. 0: on a surface */
} vlPhoton;
_Static_assert(sizeof(vlPhoton) == 64, "a photon is one cache line");

/* Photons sorted by grid cell, cells by hash; within a cell by id, so that sums have one order. */
typedef struct vlPhotonMap {
  const vlPhoton *photons;
  const uint32_t *start; /* buckets + 1 */
  uint32_t buckets;      /* a power of two */
  float radius2, inv_cell;
} vlPhotonMap;

/* Builds the map. sorted: count elements; start: buckets + 1. Cells are 2 radius wide. The map keeps both pointers. */
void vl_photon_map_build(vlPhotonMap *map, const vlPhoton *photons, uint32_t count, float radius, vlPhoton *sorted,
                         uint32_t *start, uint32_t buckets);

typedef struct vlTwoWay {
  vlCameraView eye;
  bool merge;          /* false: light paths only connect to the camera */
  bool apart;          /* smooth vertices at the camera path's beginning do not count as bounces (as in pbrt's sppm) */
  bool light_only;     /* no next event, no merging: weights are 1 */
  float paths;         /* N: light paths of a pass */
  float merged;        /* H = N pi radius^2; 0 without merging */
  float merged_volume; /* in media: H = N 4/3 pi radius^3 */
  float inv_merged;    /* 1 / H */
  float shared; /* in [0, 1): the number that samples the wavelengths of all paths of the pass; below 0: each path has
                   its own */
  const float *choice; /* lights + 1: cumulated probabilities of starting from each */
  const uint32_t
      *medium;       /* by light: the medium that its paths start in (vlTraceKernels.light_media); null without media */
  vlSampler sampler; /* of the light paths */
  vlPhotonMap map;   /* of this pass */
} vlTwoWay;

/* `n` <= VL_BATCH light paths; photons and splats go to the sinks, up to VL_BATCH elements a call. */
typedef struct vlLightBatch {
  uint32_t n;
  const int32_t *px, *py; /* VL_PAD(n): the path's number, as a pixel of the sampler */
  const uint32_t *index;
  uint32_t first;           /* number of the first path in the pass; the others follow */
  const float *time;        /* the world's, by path; null where nothing moves */
  const vlCameraView *eyes; /* by path, of a camera that moves; null: vlTwoWay.eye */
  void *user;
  /* Radiance for the film at points x, y (pixels from the top left corner): value at wavelengths of density 1 / inv_pdf
   * (spectral; else those rows are undefined). Rows of VL_ROW_SIZE; the sink may write to them. */
  void (*splat)(void *user, uint32_t n, const float *x, const float *y, float *const value[4], float *const lambda[4],
                float *const inv_pdf[4]);
  void (*store)(void *user, uint32_t n, const vlPhoton *photons);
  uint64_t bounce_rays, shadow_rays; /* the batch's counts are added */
} vlLightBatch;

/* Cumulated probabilities of starting a light path, by power; light_count + 1 elements. False: no light emits. */
bool vl_two_way_choice(const vlWorld *world, float *choice);

#endif
