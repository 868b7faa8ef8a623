/* camera/rays.h: the camera as the render loop sees it: film samples in, rays out, a batch at a time.
 *
 *   film sample -> distortion (distortion.h) -> projection (projection.h and what it gathers) -> lens (lens.h)
 *   -> pose -> world-space ray
 *
 * Each stage is a plain function by value; the projection is chosen once per batch. Positions and directions are
 * computed in double and rounded to float once, at the end: a ray is the nearest float to the exact formula. */
#ifndef CAMERA_RAYS_H
#define CAMERA_RAYS_H

#include "base/isa.h"
#include "camera/aperture.h"
#include "camera/time.h"
#include "velo/camera.h"

/* Points per chunk of the double arrays below. */
enum { VL_CAMERA_CHUNK = 256 };

/* A camera ready for batches. Camera space: x right, y down, z forward. Plain data, made by vl_camera_compile. */
typedef struct vlCameraCompiled {
  vlProjection projection;
  bool has_lens;
  double cx, cy;                 /* principal point, pixels */
  double skew_ratio;             /* skew / fy */
  double aspect;                 /* fx / fy */
  double focal;                  /* fx, pixels (orthographic: pixels per scene unit) */
  double inv_fx, inv_fy;         /* orthographic: scene units per pixel */
  double rotation[9];            /* row-major 3x3 part of world_from_camera (may scale or mirror) */
  double position[3];            /* of the camera in the world */
  double lens_radius, inv_focus; /* 1 / focus distance; 0: focused at infinity */
  /* The plane in focus is p . focus = 1; read with shaped lenses and where `ahead` is set. */
  double focus[3];
  double shutter_open, shutter_time; /* seconds */
  double near_plane, far_plane;      /* z in camera space */
  /* Width of a pixel's footprint at distance t along the ray: pixel_width + pixel_spread * t (world units).
   * Perspective: the width is 0 and the spread is the angle (radians) that the central pixel subtends. Orthographic:
   * spread 0. */
  float pixel_spread, pixel_width;

  /* What follows serves all but the plain perspective and orthographic cameras. */
  bool plain;            /* perspective without distortion, or orthographic: every film point is valid */
  bool inclined;         /* perspective: depth along z, not distance, counts for lens and planes */
  double fx, fy, skew;   /* pixels */
  double shape[2];       /* of the projection; FOV: w and 2 tan(w/2) */
  double over_x, over_y; /* how far a plane that closes on itself goes on beyond its edges, for filters */
  double limit2;         /* square of the valid disc's radius in the plane */
  vlDistortionMap distortion;
  double camera_from_world[12];
  /* A lens that is not a plain disc: its points are drawn by vl_lens_points, before the loop over the rays. */
  bool shaped;
  bool ahead;      /* depth along z, not distance, counts for lens and planes */
  bool vignetting; /* rays have weights */
  vlBlades blades; /* none: count 0 */
  const vlAperture *aperture;
  double lens_turn[2];    /* cosine and sine that turn the image */
  double inv_ratio;       /* of the opening's width */
  const vlOptics *optics; /* their rays go their own way: optics.hot.c */
  double pitch;           /* side of a pixel on their film, scene units */
  double eye_circle;      /* of omnidirectional stereo: the circle's radius, signed; 0: none */
  vlCameraTime when;
} vlCameraCompiled;

/* All arrays hold VL_PAD(n) elements; those past n may hold anything, and what comes out for them means nothing.
 * A film position is pixel + film: the integer pixel (column, row from the top left) and the offset from that pixel's
 * top left corner, apart so that large images lose no precision. film may lie outside [0, 1) with wide filters.
 * lens_u, lens_v in [0, 1): not read without a lens. time in [0, 1): the share of the shutter's time that has passed.
 */
typedef struct vlCameraSamples {
  const float *film_x, *film_y;
  const int32_t *pixel_x, *pixel_y;
  const float *lens_u, *lens_v;
  const float *time;
} vlCameraSamples;

/* World space; d normalised; [t_min, t_max] from the near and far planes (0 and infinity without); time in seconds.
 * valid (may be null): 1, or 0 where the film point lies outside the camera's domain; t_max is -1 there, so that the
 * ray hits nothing, and d is some unit vector.
 * weight (may be null): what the light that comes back along the ray counts; written only if the camera is `weighted`.
 * 0 with valid 1: a part of the lens stops the ray (t_max is -1 then, too). */
typedef struct vlCameraRays {
  float *ox, *oy, *oz, *dx, *dy, *dz;
  float *t_min, *t_max;
  float *time;
  float *valid;
  float *weight;
} vlCameraRays;

/* A chunk of points or pixels in double: VL_PAD(n) elements are computed, n <= VL_CAMERA_CHUNK. */
typedef struct vlCameraPixels {
  double x[VL_CAMERA_CHUNK], y[VL_CAMERA_CHUNK], z[VL_CAMERA_CHUNK], valid[VL_CAMERA_CHUNK];
} vlCameraPixels;
typedef struct vlCameraPoints {
  double ox[VL_CAMERA_CHUNK], oy[VL_CAMERA_CHUNK], oz[VL_CAMERA_CHUNK]; /* unproject: where the ray starts */
  double x[VL_CAMERA_CHUNK], y[VL_CAMERA_CHUNK], z[VL_CAMERA_CHUNK];    /* a point; unproject: a unit direction */
  double valid[VL_CAMERA_CHUNK];
} vlCameraPoints;

typedef struct vlCameraKernels {
  void (*rays)(const vlCameraCompiled *c, uint32_t n, const vlCameraSamples *s, const vlCameraRays *r);
  /* Film positions in x, y (pixels) to world-space rays. */
  void (*unproject)(const vlCameraCompiled *c, uint32_t n, const vlCameraPixels *pixels, vlCameraPoints *points);
  /* World-space points to film positions; z is the depth. */
  void (*project)(const vlCameraCompiled *c, uint32_t n, const vlCameraPoints *points, vlCameraPixels *pixels);
} vlCameraKernels;

/* One table per instruction set; all give the same bits. */
VL_KERNEL_TABLE(vlCameraKernels, vl_camera)

/* Are there weights other than 1? */
static inline bool vl_camera_weighted(const vlCameraCompiled *c) {
  return c->vignetting || c->optics;
}

void vl_camera_compile(const vlCamera *camera, vlCameraCompiled *c);
/* Another clock from here on: rays come with (seconds - origin) * scale. */
void vl_camera_retime(vlCameraCompiled *c, double origin, double scale);

#endif
