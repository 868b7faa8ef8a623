/** @file
 * velo/own.h: code of one's own in a render: a camera given by functions. docs/own-code.md has
 * complete examples.
 *
 * The functions work on arrays of up to VL_OWN_BATCH elements. They are called from several
 * threads at once, in any order and grouping. If the outputs of element i depend on the inputs
 * of element i alone, the image has the same bits for any number of threads, crop and pass.
 * Arrays are valid during the call only. A function must not call vl_render or destroy an
 * object that the render uses. It runs in the floating-point state of the process. Where it
 * fails, it leaves or writes NaN: NaN and infinity are counted (vlRenderStats.not_finite), and
 * their samples are left out. It ends the whole render by vl_cancel_request
 * (vlRenderDef.cancel). */
#ifndef VELO_OWN_H
#define VELO_OWN_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

enum {
  VL_OWN_BATCH = 1024, /**< the most elements of one call */
  VL_OWN_NAME = 64     /**< the most bytes of a name, with its zero */
};

/** What code of one's own stands for. */
typedef enum vlOwnKind { VL_OWN_CAMERA, VL_OWN_SAMPLER, VL_OWN_TRACER, VL_OWN_KINDS } vlOwnKind;

/** Film points that need rays. Arrays have `count` elements, at least 1. */
typedef struct vlOwnFilmPoints {
  uint32_t count;         /**< length of the arrays */
  uint32_t width, height; /**< the size of the image for which the camera was made, pixels */
  const double *x, *y;    /**< film points, pixels from the top left corner; the first pixel's
                             centre is (0.5, 0.5). By the reconstruction filter, points may be
                             up to 16 pixels outside the image */
  /** a pair of numbers in [0, 1) for a point of the lens; 0.5 without vlOwnCamera.lens, and
   * where rays pass the centre of the lens */
  const double *lens_u, *lens_v;
  const double *time; /**< seconds, by shutter and readout of the camera */
} vlOwnFilmPoints;
/** Rays in camera space (x right, y down, z forward; scene units); the camera's pose is applied
 * to them afterwards. */
typedef struct vlOwnRays {
  double *ox, *oy, *oz; /**< origins; 0 before the call */
  double *dx, *dy, *dz; /**< directions of any length; 0 before the call. 0 0 0: the film point
                           has no ray, and the pixel there has radiance 0 and alpha 0 */
  double *weight;       /**< factor on the radiance, at least 0; 1 before the call */
} vlOwnRays;
/** Makes the rays of film points. */
typedef void vlOwnRaysFn(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays);

/** Points in camera space, scene units, of which the film points are asked. Arrays have `count`
 * elements. */
typedef struct vlOwnSpacePoints {
  uint32_t count;          /**< length of the arrays */
  uint32_t width, height;  /**< as vlOwnFilmPoints */
  const double *x, *y, *z; /**< points */
  double *film_x, *film_y; /**< output: film points, pixels. NaN before the call: the camera
                              does not see the point */
} vlOwnSpacePoints;
/** Finds the film points of points in space, through the centre of the lens: the inverse of
 * vlOwnRaysFn. */
typedef void vlOwnPixelsFn(void *user, const vlOwnSpacePoints *points);

/** A camera of one's own, for vlCameraDef.own. The name must be UTF-8 without control
 * characters, 1 to VL_OWN_NAME - 1 bytes; it stands in receipts and films, and films of other
 * names are not continued or merged. */
typedef struct vlOwnCamera {
  const char *name;      /**< required; it must live as long as the camera */
  vlOwnRaysFn *rays;     /**< required */
  vlOwnPixelsFn *pixels; /**< null: the camera cannot project; vl_camera_project then returns
                            false, and light paths are not connected to it */
  bool lens;             /**< rays reads lens_u and lens_v */
  void *user;            /**< passed to both functions */
} vlOwnCamera;

/** Samples that need numbers. Arrays have `count` elements, at least 1. */
typedef struct vlOwnSamples {
  uint32_t count;        /**< length of the arrays */
  const int32_t *x, *y;  /**< their pixels: column and row from the top left. Pixels that share
                            samples (vlRenderDef.share_samples) need some up to 2 pixels outside
                            the image, also negative ones */
  const uint32_t *index; /**< index of the sample in its pixel */
  /** What the numbers are for: 0 and 1 the film point, 2 and 3 the light sample at the first
   * hit, 4 the wavelength, 5 the time, 6 and 7 the lens; 8 + 8 b and up: bounce b
   * (docs/own-code.md). Numbers of different dimensions must be independent. */
  uint32_t dimension;
  uint32_t dimensions; /**< 1 or 2: `dimension` alone, or the pair of it and the next. A
                          dimension is always asked for in the same way */
  uint32_t seed;       /**< vlRenderDef.seed */
  float *u;            /**< output: numbers in [0, 1). NaN before the call */
  float *v;            /**< output: the second of each pair; null with 1 dimension */
} vlOwnSamples;
/** Fills numbers. Each must depend on its pixel, its index, the dimension and the seed alone.
 * Numbers outside [0, 1) and NaN are replaced by the nearest number in it, NaN by 0.5, and
 * counted (vlRenderStats.own_numbers). */
typedef void vlOwnNumbersFn(void *user, const vlOwnSamples *samples);

/** A sampler of one's own, for vlRenderDef.own_sampler. The name is as that of vlOwnCamera. */
typedef struct vlOwnSampler {
  const char *name;        /**< required; it must live as long as the sampler */
  vlOwnNumbersFn *numbers; /**< required */
  void *user;              /**< passed to numbers */
} vlOwnSampler;

#ifdef __cplusplus
}
#endif
#endif
