/* render/channel_pass.h: the ground-truth pass: declarations shared by its files. */
#ifndef RENDER_CHANNEL_PASS_H
#define RENDER_CHANNEL_PASS_H

#include "render/cryptomatte.h"
#include "render/feature_grid.h"
#include "render/film_rays.h"
#include "render/reconstruct.h"
#include "render/stop.h"
#include "trace/ground_truth/ground_truth.h"
#include "velo/channels.h"

enum { VL_CHANNEL_TILE = 32, VL_TILE_PIXELS = VL_CHANNEL_TILE * VL_CHANNEL_TILE };
_Static_assert((int)VL_TILE_PIXELS <= (int)VL_BATCH, "a tile is a batch");

/* Bit numbers of the channels: indices into the tables below. */
enum {
  VL_INDEX_Z,
  VL_INDEX_DISTANCE,
  VL_INDEX_P,
  VL_INDEX_N,
  VL_INDEX_NG,
  VL_INDEX_UV,
  VL_INDEX_ALBEDO,
  VL_INDEX_RAY,
  VL_INDEX_IDS,
  VL_INDEX_SAMPLES = 12,
  VL_INDEX_FILM,
  VL_INDEX_ERROR,
  VL_INDEX_FORWARD,
  VL_INDEX_BACKWARD,
  VL_INDEX_CRYPTO,
  VL_INDEX_FEATURES = VL_INDEX_CRYPTO + 3,
  VL_INDEX_LUMINANCE,
  VL_INDEX_ILLUMINANCE
};

/* A small hash table: the weight of each id (object, material, instance) in one pixel. A pixel
 * with more than VL_MAX_TALLY ids loses the later ones. */
enum { VL_TALLY_SLOTS = 1024, VL_MAX_TALLY = 768 };
typedef struct vlTallyEntry {
  uint64_t key;
  int64_t weight;  /* units of 2^-24 */
  float off, x, y; /* the sample closest to the pixel's centre: squared distance, film point */
  uint32_t round;  /* the entry is valid where this equals the tally's round */
} vlTallyEntry;
typedef struct vlTally {
  uint32_t round, count, last; /* last: the slot of the previous lookup */
  uint32_t used[VL_MAX_TALLY];
  vlTallyEntry slots[VL_TALLY_SLOTS];
} vlTally;

/* The first hit of a sample of the image: ids (0: none), film point, depth (infinity: nothing
 * was hit, or not asked). */
typedef struct vlSampleHit {
  uint32_t ids[3]; /* object, material, instance */
  float x, y, z;
} vlSampleHit;
enum { VL_SHARED_HITS = 1 << 17 }; /* most hits that a worker holds at once */

typedef struct vlChannelWorker {
  vlGroundTruthScratch *scratch;
  vlGroundTruthBatch *batch;
  float *rows;      /* VL_CHANNEL_ROWS arrays of VL_ROW_SIZE */
  vlTally *tallies; /* three for Cryptomatte or one for the choice of a point; null where
                       nothing is counted */
  vlGroundTruthBatch *other; /* hits of the other camera's rays; null without flow */
  uint32_t *lanes;           /* for each lane of `other`: its lane of the batch */
  vlSampleHit *hits;         /* VL_SHARED_HITS; null where no samples are shared */
  vlFeatureGrid *features;   /* null without features */
  uint32_t x[VL_BATCH], y[VL_BATCH];
  /* film point of each pixel of the tile */
  float film_x[VL_TILE_PIXELS], film_y[VL_TILE_PIXELS];
  float lane_x[VL_BATCH], lane_y[VL_BATCH]; /* film point of each lane */
  double depth[VL_CHANNEL_TILE][4]; /* with rows: of each of the tile's rows or columns, depth
                                       of a world point in its camera */
} vlChannelWorker;
enum { VL_CHANNEL_ROWS = 28 };

/* t_min and t_max of a camera's rays. */
typedef struct vlChannelEnds {
  const vlCameraCompiled *camera;
  const uint32_t *x, *y;
  const float *film_x, *film_y;
} vlChannelEnds;

typedef struct vlChannelPass {
  const vlWorld *world;
  const vlChannelsDef *def;
  vlCamera camera;            /* a pinhole, held at the time of the pass */
  vlCamera rolling;           /* with rows: the pinhole whose rows have times of their own */
  bool rows;                  /* each pixel is seen when its row is exposed, or its column */
  bool columns;               /* the pixels of a column are exposed together */
  double time, other_time[2]; /* seconds: of this pass, and of the other two cameras */
  double open, close;         /* seconds: the exposure, at the middle of the image */
  vlCameraCompiled compiled;
  const vlCameraKernels *camera_kernels;
  const vlGroundTruthKernels *ground_truth_kernels;
  vlGroundTruthDef ground_truth, features;
  uint32_t tiles_x, tile_x0, tile_y0, tiles;
  uint32_t feature_tiles; /* tiles along a side of a square whose features a worker makes */
  uint32_t first[2][VL_CHANNEL_COUNT]; /* index of each channel's first component among the
                                          floats and among the ids */
  vlImage *images[2];                  /* floats, ids */
  uint32_t step[2];                    /* values per pixel */
  vlChannelWorker *workers;
  vlStop *stop;
  /* rays of the image's samples: through the middle of the lens, and unchanged */
  vlFilmRays choice, image;
  uint32_t spp;          /* samples per pixel of the film; 0: they are not needed */
  bool adaptive;         /* the film's blocks have different numbers of samples */
  uint32_t first_sample; /* index of the first */
  bool shares;           /* pixels of the image share samples */
  vlReconstruction reconstruction;
  vlCryptomatte crypto[3];
  vlCamera other[2]; /* forward, backward: pinholes, held at other_time; of rolling shutters not
                        held */
  vlCameraCompiled other_compiled[2];
} vlChannelPass;

static inline bool vl_channel_wanted(const vlChannelPass *p, uint32_t bits) {
  return (p->def->channels & bits) != 0;
}
/* The first pixel of a tile; it may lie before the crop window. */
static inline void vl_channel_corner(const vlChannelPass *p, uint32_t tile, uint32_t *x,
                                     uint32_t *y) {
  *x = (p->tile_x0 + tile % p->tiles_x) * VL_CHANNEL_TILE;
  *y = (p->tile_y0 + tile / p->tiles_x) * VL_CHANNEL_TILE;
}
/* Coordinates of pixel k of a tile, row by row; false: outside the crop window. */
static inline bool vl_channel_pixel(const vlChannelPass *p, uint32_t tile, uint32_t k,
                                    uint32_t *x, uint32_t *y) {
  vl_channel_corner(p, tile, x, y);
  *x += k % VL_CHANNEL_TILE;
  *y += k / VL_CHANNEL_TILE;
  const uint32_t *crop = p->def->crop;
  return *x >= crop[0] && *y >= crop[1] && *x < crop[2] && *y < crop[3];
}
/* Pixel k of a tile with the pixels that are exposed together in sequence. */
static inline uint32_t vl_channel_order(const vlChannelPass *p, uint32_t k) {
  return p->columns ? k % VL_CHANNEL_TILE * VL_CHANNEL_TILE + k / VL_CHANNEL_TILE : k;
}
/* The time (s) at which a pixel is seen. */
static inline double vl_channel_time(const vlChannelPass *p, int32_t x, int32_t y) {
  return p->rows ? vl_camera_seconds(&p->compiled, x, y, 0.5f) : p->time;
}
/* Samples per pixel of the image in a tile, which lies in one block of the film. */
uint32_t vl_channel_spp(const vlChannelPass *p, uint32_t tile);
static inline size_t vl_channel_at(const vlChannelPass *p, uint32_t x, uint32_t y) {
  return (size_t)(y - p->def->crop[1]) * (p->def->crop[2] - p->def->crop[0]) +
         (x - p->def->crop[0]);
}
static inline float *vl_channel_floats(const vlChannelPass *p, size_t at, uint32_t index) {
  return (float *)vl_image_pixels(p->images[0]) + at * p->step[0] + p->first[0][index];
}
static inline uint32_t *vl_channel_ids(const vlChannelPass *p, size_t at, uint32_t index) {
  return (uint32_t *)vl_image_pixels(p->images[1]) + at * p->step[1] + p->first[1][index];
}
static inline float *vl_channel_row(vlChannelWorker *w, uint32_t row) {
  return w->rows + (size_t)row * VL_ROW_SIZE;
}

/* In channels.c: sets cameras, kernels and tiles from def and world. */
void vl_channel_prepare(vlChannelPass *p, const vlCamera *camera);
/* Allocates the workers, with what the pass's channels need; vl_channel_free_workers frees them
 * whatever the result. */
vlResult vl_channel_make_workers(vlChannelPass *p, vlError *error);
void vl_channel_free_workers(vlChannelPass *p);
/* In channel_samples.c: traces the image's samples of one tile; fills film_x and film_y of the
 * tile and writes Cryptomatte. */
void vl_channel_count(const vlChannelPass *p, vlChannelWorker *w, uint32_t tile);
/* In illuminance.c: renders the illuminance of the visible surfaces and writes its channel, if
 * it is wanted. MEMORY, CANCELLED. */
vlResult vl_channel_illuminance(const vlChannelPass *p, const vlCamera *camera, vlError *error);
/* In channel_features.c. plan: how many tiles a worker takes at once, which changes no value.
 */
void vl_channel_plan_features(vlChannelPass *p);
/* Means over the image's samples of the square of tiles that begins with this one. Does nothing
 * for the square's other tiles. */
void vl_channel_features(const vlChannelPass *p, vlChannelWorker *w, uint32_t tile);
/* In flow.c: optical flow of the n lanes of the batch towards camera `which`. */
void vl_channel_flow(const vlChannelPass *p, vlChannelWorker *w, int which);
/* In channel_tile.c: makes the batch's rays through the film points (lane_x, lane_y) of the n
 * pixels (x, y), at each pixel's time, and removes the lanes without a ray. Pixels that are
 * exposed together must follow each other. Returns the number of lanes. */
uint32_t vl_channel_rays(const vlChannelPass *p, vlChannelWorker *w, uint32_t n);
/* In channel_tile.c: t_min and t_max of rays, from the kernel that makes the image's camera
 * rays. */
void vl_channel_ends(const vlChannelPass *p, vlChannelWorker *w, uint32_t n,
                     const vlChannelEnds *ends, float *t_min, float *t_max);
/* does nothing once the pass is stopped */
void vl_channel_tile(void *pass, uint32_t tile, uint32_t worker);

#endif
