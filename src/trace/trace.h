/* trace/trace.h: computes the radiance of batches of camera rays. It does not depend on cameras
 * or films.
 *
 * A batch is at most VL_BATCH paths. Each worker has one vlTraceScratch as its whole working
 * memory, so rendering allocates nothing: 0.94 MB, with media 1.30 MB, with subsurface
 * materials 1.55 MB, and 0.05 MB more where something attenuates by RGB channel. The two-way
 * tracers have another 0.36 MB. A path's result does not depend on the other paths of its
 * batch, bit for bit.
 */
#ifndef TRACE_TRACE_H
#define TRACE_TRACE_H

#include "base/cancel.h"
#include "base/isa.h"
#include "sampler/sampler.h"
#include "world/world.h"

struct vlTwoWay; /* two_way.h */
struct vlTwoWayRows;
struct vlCameraView;
struct vlLightBatch;
struct vlPathRecorder; /* tracer/record.h */

enum { VL_BATCH = 1024 };

/* Number of elements of a batch's array. The array is one cache line longer than the batch, so
 * that element i of different arrays maps to different sets of the L1 cache. (With arrays of
 * 4096 bytes, all would map to one set.) */
enum { VL_ROW_SIZE = VL_BATCH + 16 };

/* Dimensions of the sampler. The camera sample uses the dimensions below VL_DIM_BOUNCE. Bounce
 * b starts at VL_DIM_BOUNCE + b * VL_DIM_STRIDE; VL_DIM_LIGHT to VL_DIM_FLIGHT count from
 * there. Each comment gives the number of dimensions used. */
enum {
  VL_DIM_FILM = 0,        /* 2 */
  VL_DIM_FIRST_LIGHT = 2, /* 2: VL_DIM_LIGHT_UV of the first hit, drawn together with
                             VL_DIM_FILM. Low dimensions, where halton is best */
  VL_DIM_WAVELENGTH = 4,  /* 1 */
  VL_DIM_TIME = 5,        /* 1 */
  VL_DIM_LENS = 6,        /* 2 */
  VL_DIM_BOUNCE = 8,
  VL_DIM_LIGHT = 0,    /* 1: spare; replaces the rest of the next where too few bits are left */
  VL_DIM_LIGHT_UV = 1, /* 2: choose the light and the point on it */
  VL_DIM_LOBE = 3,     /* 1 */
  VL_DIM_BSDF_UV = 4,  /* 2 */
  VL_DIM_ROULETTE = 6, /* 1 */
  VL_DIM_FLIGHT = 7,   /* 1: samples the distance to the next event in a medium */
  VL_DIM_STRIDE = 8,
  /* A bounce through a subsurface material (subsurface.hot.c) uses a second range of dimensions
   * that starts here. In it, the light sample at the exit point uses the offsets above; the
   * offsets below are used too. */
  VL_DIM_SUBSURFACE = 1 << 20,
  VL_DIM_PROBE_AXIS = 3, /* 1 */
  VL_DIM_PROBE = 4,      /* 2 */
  VL_DIM_EXIT_UV = 6     /* 2 */
};

/* Kinds of bounces, which have limits of their own. */
typedef enum vlBounceKind {
  VL_BOUNCE_DIFFUSE,
  VL_BOUNCE_GLOSSY, /* glossy and specular reflection */
  VL_BOUNCE_TRANSMISSION,
  VL_BOUNCE_VOLUME, /* scattering in a medium */
  VL_BOUNCE_KINDS
} vlBounceKind;

/* Asks volpath whether the media of the world fit together (medium/fit.hot.c). */
typedef struct vlMediaFit {
  const uint32_t *light_medium; /* by light: vlTraceKernels.light_media */
  bool has_sky;                 /* there are lights at infinity, in the medium sky_medium */
  uint32_t sky_medium;
  uint32_t endless; /* output: number of segments to infinity in another medium */
  /* Output, by path: 1 where two ends of a segment name different media; and the path's
   * radiance before it. */
  uint8_t wrong[VL_BATCH];
  float before[4][VL_BATCH];
} vlMediaFit;

typedef struct vlTraceDef {
  uint32_t tracer;               /* vlTracer */
  const struct vlOwnTracer *own; /* in place of tracer (tracer/own.h); null: none */
  const vlSampler *sampler;
  vlIsa isa;
  uint32_t max_depth;
  uint32_t max_of_kind[VL_BOUNCE_KINDS]; /* limits of bounces of one kind; VL_NONE: none */
  bool limited;                          /* there is such a limit */
  float ao_distance;
  bool ao_cosine;
  bool same_wavelengths; /* all paths share the same four wavelengths */
  /* nm; if the span is above 0, wavelengths are uniform in [low, low + span]; else they are
   * drawn from the visible response (pbrt book 4.5.4) */
  float lambda_low, lambda_span;
  float pixel_spread, pixel_width; /* width of a camera ray's footprint at distance t:
                                      pixel_width + pixel_spread * t */
  const vlCancel *cancel; /* once it is requested, tracers end early, and their results must not
                             be used; may be null */
  vlMediaFit *fit;        /* null: nothing is asked */
  const struct vlTwoWay *two_way; /* only for the two-way tracers (two_way.h); else null */
  /* Only for the tracers path and volpath. The radiance is that of a white diffuse surface in
   * the place of the first surface that the ray meets, as if nothing absorbed or shone before
   * it: its irradiance / pi. The shading normal stays that of the surface. */
  bool irradiance;
} vlTraceDef;

/* Camera rays and their results. d has unit length. Each array has VL_PAD(n) elements, n <=
 * VL_BATCH. */
typedef struct vlTraceBatch {
  uint32_t n;
  vlRays rays; /* time: null if nothing in the world moves */
  const int32_t *px, *py;
  const uint32_t *index;
  /* output; spectral mode: one value per wavelength; RGB mode: r, g, b, 0 */
  float *radiance[4];
  float *lambda[4];  /* output in spectral mode: wavelengths, nm; null in RGB mode */
  float *inv_pdf[4]; /* output in spectral mode: 1 / PDF of each wavelength, nm */
  float *alpha;      /* output: 1 where the ray hits a surface, else 0 */
  uint64_t bounce_rays, shadow_rays; /* the kernel adds its numbers of rays */
  uint64_t merge_work; /* the kernel adds the number of photons that it visits; with a BSDF, a
                          photon counts several times (merge.hot.c) */
  struct vlTwoWayRows *two_way; /* if vlTraceDef.two_way is set: working memory of one worker,
                                   like vlTraceScratch */
  const struct vlCameraView *eyes; /* if two_way is set and the camera moves: the camera's view
                                      for each lane; else null */
  /* records the paths of the tracers path and volpath; null: none */
  struct vlPathRecorder *recorder;
} vlTraceBatch;

typedef struct vlTraceScratch vlTraceScratch;
/* Allocate 64-byte aligned, zeroed. It depends on whether the world has media and subsurface
 * materials. */
size_t vl_trace_scratch_size(const vlWorld *world);
/* Before each render. Memory that a render of another world has used may be used again if its
 * size is the same. */
void vl_trace_scratch_begin(vlTraceScratch *scratch, const vlWorld *world);
size_t vl_two_way_rows_size(void); /* allocate 64-byte aligned, zeroed */

typedef struct vlTraceKernels {
  void (*trace)(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *scratch,
                vlTraceBatch *batch);
  /* Traces light paths (two_way.h). Their sampler is def->two_way->sampler; def->sampler is not
   * used. */
  void (*light)(const vlWorld *world, const vlTraceDef *def, vlTraceScratch *scratch,
                struct vlTwoWayRows *rows, struct vlLightBatch *batch);
  /* Finds the medium in which each light's paths start, for lights whose shape does not define
   * it. eye: the camera's position in world space. */
  void (*light_media)(const vlWorld *world, const float eye[3], uint32_t *medium);
} vlTraceKernels;
VL_KERNEL_TABLE(vlTraceKernels, vl_trace)

#endif
