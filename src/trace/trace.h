/* trace/trace.h: rays in, radiance out, a batch at a time. Knows neither camera nor film.
 *
 * A batch is at most VL_BATCH paths; all working memory is one vlTraceScratch per worker (some 800 KB, inside L2), so
 * nothing is allocated while rendering. Paths are independent of each other: the same path gives the same bits in any
 * batch. */
#ifndef TRACE_TRACE_H
#define TRACE_TRACE_H

#include "base/isa.h"
#include "trace/sampler/sampler.h"
#include "world/world.h"

struct vlTwoWay; /* two_way.h */
struct vlTwoWayRows;
struct vlCameraView;
struct vlLightBatch;

enum { VL_BATCH = 1024 };

/* Elements of an array of a batch: one cache line more than the batch, so that element i of different arrays falls into
 * different sets of the first-level cache (rows of 4096 bytes would all fight for the same ones). */
enum { VL_ROW_SIZE = VL_BATCH + 16 };

/* Dimensions of the sampler: the render loop uses those before VL_DIM_BOUNCE, bounce b starts at
 * VL_DIM_BOUNCE + b * VL_DIM_STRIDE. */
enum {
  VL_DIM_FILM = 0,       /* 2 */
  VL_DIM_WAVELENGTH = 2, /* 1 */
  VL_DIM_TIME = 3,       /* 1 */
  VL_DIM_LENS = 4,       /* 2 */
  VL_DIM_BOUNCE = 6,
  VL_DIM_LIGHT = 0,    /* 1: which */
  VL_DIM_LIGHT_UV = 1, /* 2: where */
  VL_DIM_LOBE = 3,     /* 1 */
  VL_DIM_BSDF_UV = 4,  /* 2 */
  VL_DIM_ROULETTE = 6, /* 1 */
  VL_DIM_FLIGHT = 7,   /* 1: how far through a medium */
  VL_DIM_STRIDE = 8,
  /* Where a bounce goes through a body (subsurface.hot.c), as many numbers again, from here on: light at its exit as
   * above, and */
  VL_DIM_SUBSURFACE = 1 << 20,
  VL_DIM_PROBE_AXIS = 3, /* 1 */
  VL_DIM_PROBE = 4,      /* 2 */
  VL_DIM_EXIT_UV = 6     /* 2 */
};

typedef struct vlTraceDef {
  vlTracer tracer;
  const vlSampler *sampler;
  vlIsa isa;
  uint32_t max_depth;
  float ao_distance;
  bool ao_cosine;
  bool same_wavelengths;           /* of all paths */
  float lambda_low, lambda_span;   /* nm; span above 0: wavelengths are uniform there, else as the eye sees */
  float pixel_spread, pixel_width; /* footprint of a camera ray: width + spread * t */
  const struct vlTwoWay *two_way;  /* of the tracers that follow light both ways (two_way.h), else null */
} vlTraceDef;

/* Rays of the camera, world space, d of unit length, and what comes back. Arrays of VL_PAD(n), n <= VL_BATCH. */
typedef struct vlTraceBatch {
  uint32_t n;
  const float *ox, *oy, *oz, *dx, *dy, *dz, *t_min, *t_max;
  const int32_t *px, *py;
  const uint32_t *index;
  const float *time;                 /* the world's, 0 to 1 (world/shape/moving.h); null where nothing moves */
  float *radiance[4];                /* out; spectral: per wavelength; RGB mode: r, g, b, 0 */
  float *lambda[4];                  /* out, spectral: wavelengths, nm; RGB mode: null */
  float *inv_pdf[4];                 /* out, spectral: 1 / their density */
  float *alpha;                      /* out: 1 where the ray meets a surface */
  uint64_t bounce_rays, shadow_rays; /* added to */
  struct vlTwoWayRows *two_way;      /* with vlTraceDef.two_way: a worker's own memory, as vlTraceScratch is */
  const struct vlCameraView *eyes;   /* with it, of a camera that moves: each lane's; else null */
} vlTraceBatch;

typedef struct vlTraceScratch vlTraceScratch;
size_t vl_trace_scratch_size(void); /* allocate 64-byte aligned, zeroed */
size_t vl_two_way_rows_size(void);  /* the same */

typedef struct vlTraceKernels {
  void (*trace)(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *scratch, vlTraceBatch *batch);
  /* Paths from the lights (two_way.h); def->sampler is not asked, def->two_way->sampler is. */
  void (*light)(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *scratch, struct vlTwoWayRows *rows,
                struct vlLightBatch *batch);
  /* Which medium each light's paths start in, as far as its shape does not tell; eye: where the camera is. */
  void (*light_media)(const vlWorld *world, const float eye[3], uint32_t *medium);
} vlTraceKernels;
VL_KERNEL_TABLE(vlTraceKernels, vl_trace)

#endif
