/* trace/two_way/two_way.h: light followed both ways: paths from the lights meet the eye's paths at the eye (splats) and
 * at surfaces (merging; Georgiev et al. 2012, Hachisuka et al. 2012). What the two sides share; who runs them is
 * render.
 *
 *   light paths (a pass's worth) -> splats (film points, radiance) and photons -> vlPhotonMap -> eye's paths ->
 * radiance
 *
 * Ways to make one path, each weighed by the balance heuristic: the eye's path runs into a light, it asks for one (next
 * event), a light's path is seen by the eye, and both meet within `radius` at any vertex between that scatters at all.
 * Let P_j be the density of the eye's first j vertices, L_j that of the light's from its start to vertex j, N light
 * paths, H = N pi radius^2. Merging at j: H P_j L_j; seen by the eye: N L_1. Divided by P_t L_t, the ways before t are
 *   S_1 = N / p(z_1),   S_(t+1) = (S_t + H) rev_(t+1) cos_t / (fwd_t cos_(t+1))
 * with fwd and rev the densities of the directions as sampled and the other way round: distances cancel, so one number
 * a path (`carry` = (S + H) cos / fwd) is all that travels. The light's side is the same, from its end. At deltas fwd =
 * rev and H = 0.
 *
 * In media cos is the density of the medium at the vertex: vl_medium_extinction, which no wavelength changes, so that
 * weights are the same whoever finds the path; H = N 4/3 pi radius^3. What flights make likelier or not is the same
 * both ways and cancels, too, but for the pieces that light samples and splats connect, without a flight: there the
 * odds of the flight (vlFlight.odds) come in. Wavelengths have their own balance, within each way: over what the four
 * would have made of its flights (trace/medium/volume.h). */
#ifndef TRACE_TWO_WAY_TWO_WAY_H
#define TRACE_TWO_WAY_TWO_WAY_H

#include "trace/trace.h"

/* A perspective camera with a round lens or none, as light sees it. Unit axes; world units. */
typedef struct vlCameraView {
  bool sees; /* false: a camera of another kind; no splats */
  vlVec3 position, right, down, ahead;
  float fx, fy, cx, cy;
  float lens_radius, focus; /* focus: depth of the plane in focus; lens_radius 0: all is */
  float near_plane, far_plane;
  float low_x, low_y, high_x, high_y; /* film points that can show */
} vlCameraView;

/* Light that arrived: where, from where, how much. power: flux over |w . geometric normal|, so that a BSDF's value
 * (with its cosine) times power over (pi radius^2 N) is radiance. */
typedef struct vlPhoton {
  float p[3], w[3]; /* w: towards where the light came from */
  float power[4];
  float a, b;           /* ways that begin further on the light's side: a * rev + b, over this vertex */
  uint32_t bounce : 31; /* from 1: vertices of the light's path so far, without the one on the light */
  uint32_t alone : 1;   /* the hero wavelength alone is left, with the weight of all */
  uint32_t id;          /* unique in a pass, whatever the order of work */
  uint32_t passed;      /* vlVolumeRows.passed, packed (stages.h); means something where vlWorld.absorbs_by_channel */
  uint32_t medium;      /* 1 + the medium that it scatters in; power is then divided by sigma_s. 0: on a surface */
} vlPhoton;
_Static_assert(sizeof(vlPhoton) == 64, "a photon is one cache line");

/* Photons by the cell of a grid that they lie in, cells by hash; in a cell by id, so that sums have one order. */
typedef struct vlPhotonMap {
  const vlPhoton *photons;
  const uint32_t *start; /* buckets + 1 */
  uint32_t buckets;      /* a power of two */
  float radius2, inv_cell;
} vlPhotonMap;

/* sorted: count elements; start: buckets + 1. Cells are 2 radius wide. */
void vl_photon_map_build(vlPhotonMap *map, const vlPhoton *photons, uint32_t count, float radius, vlPhoton *sorted,
                         uint32_t *start, uint32_t buckets);

typedef struct vlTwoWay {
  vlCameraView eye;
  bool merge;          /* else the only meetings are at the eye */
  bool apart;          /* smooth vertices that the eye's path begins with are no bounces, as pbrt's sppm counts */
  bool light_only;     /* no next event, no merging: weights are 1 */
  float paths;         /* N: the light's paths of a pass */
  float merged;        /* H = N pi radius^2; 0 without merging */
  float merged_volume; /* in media: H = N 4/3 pi radius^3 */
  float inv_merged;    /* 1 / H */
  float shared;        /* all paths of the pass have the wavelengths of this number in [0, 1); below 0: each its own */
  const float *choice; /* lights + 1: cumulated probabilities of starting from each */
  const uint32_t *medium; /* of each light: what its paths start in (vlTraceKernels.light_media); null without media */
  vlSampler sampler;      /* of the light's paths */
  vlPhotonMap map;        /* of this pass */
} vlTwoWay;

/* The light's paths of `n` <= VL_BATCH indices; what they leave goes to the sinks, up to VL_BATCH elements a call. */
typedef struct vlLightBatch {
  uint32_t n;
  const int32_t *px, *py; /* VL_PAD(n): which path, as a pixel of the sampler's */
  const uint32_t *index;
  uint32_t first;           /* number of the first path in the pass; the others follow */
  const float *time;        /* the world's, by path; null where nothing moves */
  const vlCameraView *eyes; /* by path, of a camera that moves; null: vlTwoWay.eye */
  void *user;
  /* Radiance for the film at points x, y (pixels from the top left corner): value at wavelengths of density 1 / inv_pdf
   * (spectral; else those rows mean nothing). Rows of VL_ROW_SIZE; may be written to. */
  void (*splat)(void *user, uint32_t n, const float *x, const float *y, float *const value[4], float *const lambda[4],
                float *const inv_pdf[4]);
  void (*store)(void *user, uint32_t n, const vlPhoton *photons);
  uint64_t bounce_rays, shadow_rays; /* added to */
} vlLightBatch;

/* Cumulated probabilities of starting a light's path, by power; light_count + 1 elements. False: no light at all. */
bool vl_two_way_choice(const vlWorld *world, float *choice);

#endif
