/* camera/rays.h: the camera as the render loop sees it: film samples in, rays out, a batch at a time.
 *
 *   film sample -> projection (perspective.h, orthographic.h) -> lens (lens.h) -> pose -> world-space ray
 *
 * Each stage is a plain function by value; the projection is chosen once per batch. Positions and directions are
 * computed in double and rounded to float once, at the end: a ray is the nearest float to the exact formula. */
#ifndef CAMERA_RAYS_H
#define CAMERA_RAYS_H

#include "base/isa.h"
#include "velo/camera.h"

/* A camera ready for batches. Camera space: x right, y down, z forward. Plain data, made by vl_camera_compile. */
typedef struct vlCameraCompiled {
  vlProjection projection;
  bool has_lens;
  double cx, cy;                     /* principal point, pixels */
  double skew_ratio;                 /* skew / fy */
  double aspect;                     /* fx / fy */
  double focal;                      /* fx, pixels (orthographic: pixels per scene unit) */
  double inv_fx, inv_fy;             /* orthographic: scene units per pixel */
  double rotation[9];                /* row-major 3x3 part of world_from_camera (may scale or mirror) */
  double position[3];                /* of the camera in the world */
  double lens_radius, inv_focus;     /* 1 / focus distance; 0: focused at infinity */
  double shutter_open, shutter_time; /* seconds */
  double near_plane, far_plane;      /* z in camera space */
  /* Width of a pixel's footprint at distance t along the ray: pixel_width + pixel_spread * t (world units).
   * Perspective: the width is 0 and the spread is the angle (radians) that the central pixel subtends. Orthographic:
   * spread 0. */
  float pixel_spread, pixel_width;
} vlCameraCompiled;

/* All arrays hold VL_PAD(n) elements; those past n may hold anything, and what comes out for them means nothing.
 * A film position is pixel + film: the integer pixel (column, row from the top left) and the offset from that pixel's
 * top left corner, apart so that large pictures lose no precision. film may lie outside [0, 1) with wide filters.
 * lens_u, lens_v in [0, 1): not read without a lens. time in [0, 1): the share of the shutter's time that has passed.
 */
typedef struct vlCameraSamples {
  const float *film_x, *film_y;
  const int32_t *pixel_x, *pixel_y;
  const float *lens_u, *lens_v;
  const float *time;
} vlCameraSamples;

/* World space; d normalised; [t_min, t_max] from the near and far planes (0 and infinity without); time in seconds. */
typedef struct vlCameraRays {
  float *ox, *oy, *oz, *dx, *dy, *dz;
  float *t_min, *t_max;
  float *time;
} vlCameraRays;

typedef struct vlCameraKernels {
  void (*rays)(const vlCameraCompiled *c, uint32_t n, const vlCameraSamples *s, const vlCameraRays *r);
} vlCameraKernels;

/* One table per instruction set; all give the same bits. */
extern const vlCameraKernels vl_camera_kernels_v2, vl_camera_kernels_v3, vl_camera_kernels_v4;
/* AUTO is not a set: anything but V3 and V4 gives V2's table. */
const vlCameraKernels *vl_camera_kernels(vlIsa isa);

void vl_camera_compile(const vlCamera *camera, vlCameraCompiled *c);

#endif
