/* trace/trace.h: camera rays in, radiance out, a batch at a time. Independent of camera and film.
 *
 * A batch is at most VL_BATCH paths. All working memory is one vlTraceScratch per worker (about 800 KB, inside L2), so
 * that rendering allocates nothing. Paths are independent of each other: the same path gives the same bits in any
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

/* Elements of a batch's array: one cache line more than the batch, so that element i of different arrays maps to
 * different sets of the L1 cache (rows of 4096 bytes would share one set). */
enum { VL_ROW_SIZE = VL_BATCH + 16 };

/* Dimensions of the sampler: the render loop uses those before VL_DIM_BOUNCE, bounce b starts at
 * VL_DIM_BOUNCE + b * VL_DIM_STRIDE. */
enum {
  VL_DIM_FILM = 0,       /* 2 */
  VL_DIM_WAVELENGTH = 2, /* 1 */
  VL_DIM_TIME = 3,       /* 1 */
  VL_DIM_LENS = 4,       /* 2 */
  VL_DIM_BOUNCE = 6,
  VL_DIM_LIGHT = 0,    /* 1: choice of the light */
  VL_DIM_LIGHT_UV = 1, /* 2: point on the light */
  VL_DIM_LOBE = 3,     /* 1 */
  VL_DIM_BSDF_UV = 4,  /* 2 */
  VL_DIM_ROULETTE = 6, /* 1 */
  VL_DIM_FLIGHT = 7,   /* 1: distance of flight in a medium */
  VL_DIM_STRIDE = 8,
  /* A bounce through a subsurface material (subsurface.hot.c) uses a second range of numbers that starts here: the
     light sample at its exit as above, and */
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
  bool same_wavelengths;         /* all paths have the same wavelengths */
  float lambda_low, lambda_span; /* nm; span above 0: wavelengths are uniform in this range; else sampled by the visible
                                    response (pbrt book 4.5.4) */
  float pixel_spread, pixel_width; /* footprint of a camera ray: width + spread * t */
  const struct vlTwoWay *two_way;  /* for the two-way tracers (two_way.h), else null */
} vlTraceDef;

/* Camera rays (world space, d of unit length) and their results. Arrays of VL_PAD(n), n <= VL_BATCH. */
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
  uint64_t bounce_rays, shadow_rays; /* the batch's counts are added */
  struct vlTwoWayRows *two_way;      /* with vlTraceDef.two_way: memory of one worker, like vlTraceScratch */
  const struct vlCameraView *eyes;   /* with two_way and a camera that moves: the view of each lane; else null */
} vlTraceBatch;

typedef struct vlTraceScratch vlTraceScratch;
size_t vl_trace_scratch_size(void); /* allocate 64-byte aligned, zeroed */
size_t vl_two_way_rows_size(void);  /* allocate 64-byte aligned, zeroed */

typedef struct vlTraceKernels {
  void (*trace)(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *scratch, vlTraceBatch *batch);
  /* Traces light paths (two_way.h). Their sampler is def->two_way->sampler; def->sampler is not used. */
  void (*light)(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *scratch, struct vlTwoWayRows *rows,
                struct vlLightBatch *batch);
  /* Finds the medium in which each light's paths start, unless its shape defines it; eye: the camera's position. */
  void (*light_media)(const vlWorld *world, const float eye[3], uint32_t *medium);
} vlTraceKernels;
VL_KERNEL_TABLE(vlTraceKernels, vl_trace)

#endif
