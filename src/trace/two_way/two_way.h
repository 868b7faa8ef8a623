/* trace/two_way/two_way.h: the two-way tracers: light paths connect to the camera (splats), to
 * inner vertices of camera paths, and merge with camera paths at surfaces and in media (Veach
 * 1997, Georgiev et al. 2012, Hachisuka et al. 2012). This file has the declarations that both
 * sides share; src/render runs the passes.
 *
 *   light paths (one pass) -> splats (film points, radiance) and photons -> vlPhotonMap ->
 *     camera paths -> radiance
 *
 * Several strategies can make the same path, and the balance heuristic weights them. The camera
 * path hits a light or samples one (next-event estimation), a light path connects to the
 * camera, an inner vertex of the camera path connects to one of the light path, or the two
 * paths merge within `radius` at any non-specular vertex between. Let P_j be the density of the
 * camera path's first j vertices, L_j the density of the light path from its start to vertex j,
 * N the number of light paths, and H = N pi radius^2. Merging at j has density H P_j L_j;
 * connecting to the camera has N L_1. The sum S_t of the strategies before vertex t, divided by
 * P_t L_t, is S_1 = N / p(z_1),   S_(t+1) = (S_t + H) rev_(t+1) cos_t / (fwd_t cos_(t+1)) where
 * fwd and rev are the densities of sampling the path's direction forwards and backwards.
 * Distances cancel, so each path carries only one number (`carry` = (S + H) cos / fwd). The sum
 * on the light's side is the same, counted from the light. At deltas, fwd = rev and H = 0.
 *
 * Connecting vertex t of the camera path to vertex t + 1 of the light path has density C P_t
 * L_(t+1). It adds C distance^2 / (fwd_t cos_(t+1)) to S_(t+1), if the path does not scatter
 * specularly at either end, and if t + 1, the light path's end, is in a medium or on a diffuse
 * surface: only there the vertex is kept (vlLightVertex). For the sum on the light's side, this
 * must hold for the vertex before. C is a constant; the weights sum to one for any. A
 * connection itself competes with (S_t + H) fwd'_(t+1) cos_t / distance^2 and the same of the
 * other side.
 *
 * The camera also sees lights directly: a ray hits one, with density P_1, or the point where a
 * light path starts is connected to the camera, with density N p(z_0) / p(z_1), p(z_0) the
 * density per area of such points. Only the second finds lights that are much smaller than a
 * pixel. Where a light covers several pixels every ray hits it, and has no noise, but the
 * number of light paths that start there has. So the second is used only where the shape, if it
 * faced the camera, would cover less than a pixel (vlTwoWay.pixel).
 *
 * In media, H = N 4/3 pi radius^3, and the medium's density at the vertex
 * (vl_medium_extinction) replaces cos. It does not depend on the wavelength, so both kinds of
 * paths compute the same weights. The probabilities of flights are the same in both directions
 * and cancel, too. Light samples and connections make their segments without a flight; there,
 * the odds of the flight (vlFlight.odds) are a factor of the other strategies. Within each
 * strategy, a second balance heuristic weights the four wavelengths by their densities
 * (trace/medium/volume.h). */
#ifndef TRACE_TWO_WAY_TWO_WAY_H
#define TRACE_TWO_WAY_TWO_WAY_H

#include "trace/trace.h"

/* A connection of a scene point to a point on the lens. */
typedef struct vlCameraSample {
  bool seen;
  vlVec3 w;         /* unit, towards the lens */
  vlVec3 from;      /* point on the lens */
  float x, y;       /* film point, pixels */
  float end;        /* fraction of the segment at which it crosses the near plane */
  float per_square; /* 1 / (solid angle of a pixel * distance squared) */
  float weight;     /* factor on the radiance */
  float area[3];    /* of a camera of one's own: at distance t a pixel is |area[0] + area[1] t +
                       area[2] t^2| large */
} vlCameraSample;
/* Fills the samples of n points (world space), n <= VL_BATCH. camera: vlCameraView.camera. */
typedef void vlCameraLookFn(const struct vlCameraView *view, uint32_t n, const float *x,
                            const float *y, const float *z, vlCameraSample *samples);

/* A camera to which light paths connect: a perspective one with a round lens or a pinhole, or
 * one of one's own. Axes have unit length; lengths are in world units. */
typedef struct vlCameraView {
  bool sees;            /* false: the camera is of another kind, and there are no splats */
  vlCameraLookFn *look; /* of a camera of one's own: connects points to it; null: perspective.
                           Then only it, `camera` and the bounds are set */
  const void *camera;   /* for look: the compiled camera */
  vlVec3 position, right, down, ahead;
  float fx, fy, cx, cy;
  float lens_radius, focus; /* focus: focus distance (depth); lens_radius 0: pinhole */
  float near_plane, far_plane;
  float low_x, low_y, high_x, high_y; /* bounds of film points that reach a pixel */
  float reach_x, reach_y; /* how far from its pixel's middle a camera sample may be, with room
                             for rounding; pixels */
} vlCameraView;

/* A photon: a vertex of a light path. power is the flux divided by |w . geometric normal|; the
 * radiance is the BSDF's value (with its cosine) times power / (pi radius^2 N). */
typedef struct vlPhoton {
  float p[3], w[3]; /* w: unit, towards the previous vertex */
  float power[4];
  float a, b; /* the strategies on the light's side sum to a * rev + b, divided by P L at this
                 vertex */
  uint32_t bounce : 31; /* number of vertices of the light path so far, without the one on the
                           light; from 1 */
  uint32_t alone : 1; /* only the hero wavelength is left, and carries the weight of all four */
  uint32_t id;        /* unique in a pass, and independent of the order of work */
  uint32_t passed;    /* vlTracing.passed, packed (stages.h); only with vlWorld.by_channel */
  uint32_t medium;    /* 1 + the medium of the vertex; power is then divided by sigma_s. 0: on a
                         surface */
} vlPhoton;
_Static_assert(sizeof(vlPhoton) == 64, "a photon is one cache line");

/* A vertex of a light path which camera paths connect to, on a diffuse surface or in a medium.
 * power is the flux; on surfaces times the BSDF's value and |w . shading normal| / |w .
 * geometric normal|, where w points to the previous vertex. */
typedef struct vlLightVertex {
  float p[3];
  union {
    float g[3];
    struct { /* in media */
      /* a: vlPhoton; vl_medium_extinction; g of the phase function */
      float a, dense, asymmetry;
    };
  };
  float n[3]; /* the shading normal on the side of w; in media, -w */
  float power[4];
  float back;   /* the strategies on the light's side, with merging here, divided by P L at this
                   vertex; in media without a times the phase function */
  float offset; /* as vlSurface.offset */
  uint32_t path : 18, bounce : 8; /* number of the path in the pass; as vlPhoton */
  uint32_t alone : 1, inside : 1; /* as vlPhoton; the vertex is in a medium */
  uint32_t air : 4;               /* vl_air of the medium before the vertex */
} vlLightVertex;
_Static_assert(sizeof(vlLightVertex) == 64, "a vertex is one cache line");

/* The vertices of the light paths numbered below `paths`. The paths are dealt to groups in
 * turn; all paths of a group have the same wavelengths and, if the world moves, the same time.
 * The vertices are sorted by group, path and bounce. */
enum { VL_MAX_GROUPS = 16 };
typedef struct vlLightVertices {
  const vlLightVertex *vertices;
  const uint32_t *passed; /* by vertex: vlPhoton.passed; null without vlWorld.by_channel */
  uint32_t start[VL_MAX_GROUPS + 1]; /* by group: its vertices */
  uint32_t groups, paths;
} vlLightVertices;

/* Photons sorted by the hash of their grid cell, then by id, so that sums always have the same
 * order. */
typedef struct vlPhotonMap {
  const vlPhoton *photons;
  const uint32_t *start; /* buckets + 1 */
  uint32_t buckets;      /* a power of two */
  float radius2, inv_cell;
} vlPhotonMap;

/* Builds the map. sorted has `count` elements, start has buckets + 1. Cells are 2 radius wide.
 * The map keeps both pointers, which the caller owns. */
void vl_photon_map_build(vlPhotonMap *map, const vlPhoton *photons, uint32_t count,
                         float radius, vlPhoton *sorted, uint32_t *start, uint32_t buckets);

typedef struct vlTwoWay {
  vlCameraView eye;
  bool merge; /* false: light paths only connect to the camera */
  bool apart; /* smooth vertices at the camera path's beginning do not count as bounces (as in
                 pbrt's sppm) */
  bool light_only; /* no next-event estimation and no merging: weights are 1 */
  bool alone;      /* camera paths are not traced, but count in the weights */
  /* lights that cover less than this part of a pixel are connected to the camera */
  float pixel;
  float paths;         /* N: light paths of a pass */
  float merged;        /* H = N pi radius^2; 0 without merging */
  float merged_volume; /* in media: H = N 4/3 pi radius^3 */
  float shared;  /* random number in [0, 1) that samples the wavelengths of all paths of the
                    pass; below 0: each path has its own number */
  float connect; /* C: density of connections between inner vertices, relative to one light
                    path; 0: none */
  float turn; /* with connections: random number in [0, 1) of the pass, for the wavelengths of
                 all groups */
  vlLightVertices inner; /* of this pass; paths is 0 without connections */
  const float *choice; /* lights + 1 elements: cumulated probabilities that a light path starts
                          at each light */
  const float *extent; /* by light: the area of its shape, of which it may be one face */
  const uint32_t *medium; /* by light: the medium in which its paths start
                             (vlTraceKernels.light_media); null without media */
  vlSampler sampler;      /* sampler of the light paths */
  vlPhotonMap map;        /* photons of this pass */
} vlTwoWay;

/* The random number that samples the wavelengths of a group. */
static inline float vl_group_wavelength(const vlTwoWay *way, uint32_t group) {
  return vl_min(((float)group + way->turn) / (float)way->inner.groups, VL_ONE_MINUS_EPSILON);
}

/* A batch of n <= VL_BATCH light paths. Photons and splats go to the callbacks, up to VL_BATCH
 * elements per call. */
typedef struct vlLightBatch {
  uint32_t n;
  const int32_t *px, *py; /* VL_PAD(n): the path's number, as a pixel of the sampler */
  const uint32_t *index;
  uint32_t first;    /* number of the batch's first path in the pass; the others follow */
  const float *time; /* the world's time, by path; null if nothing moves */
  /* the camera's view by path, if the camera moves; null: vlTwoWay.eye */
  const vlCameraView *eyes;
  void *user;
  /* Receives radiance for the film at points x, y (pixels from the top left corner). lambda and
   * inv_pdf: wavelengths and 1 / PDF in spectral mode, else undefined. odds: the density of all
   * other strategies over that of this one. Rows have VL_ROW_SIZE elements; the callback may
   * write to all but odds. */
  void (*splat)(void *user, uint32_t n, const float *x, const float *y, const float *odds,
                float *const value[4], float *const lambda[4], float *const inv_pdf[4]);
  void (*store)(void *user, uint32_t n, const vlPhoton *photons);
  /* passed: vlPhoton.passed of each vertex, undefined without vlWorld.by_channel */
  void (*leave)(void *user, uint32_t n, const vlLightVertex *vertices, const uint32_t *passed);
  uint64_t bounce_rays, shadow_rays; /* the kernel adds its numbers of rays */
} vlLightBatch;

/* Computes the cumulated probabilities that a light path starts at each light, in proportion to
 * power. choice has light_count + 1 elements. Returns false if no light emits. */
bool vl_two_way_choice(const vlWorld *world, float *choice);

#endif
