/* camera/rays.h: the camera's interface to the render loop: film samples in, rays out, a batch
 * at a time.
 *
 *     film sample -> distortion (distortion/distortion.h) -> projection (projection.h and what
 * it includes) -> lens (lens.h)
 *     -> pose -> world-space ray
 *
 * Each stage is a plain function by value; the projection is chosen once per batch. Positions
 * and directions are computed in double and rounded to float once, at the end: a ray is the
 * float nearest to the exact formula. */
#ifndef CAMERA_RAYS_H
#define CAMERA_RAYS_H

#include "base/isa.h"
#include "camera/aperture.h"
#include "camera/time.h"
#include "velo/camera.h"
#include "velo/own.h"

/* Number of points in each chunk of the double arrays below. */
enum { VL_CAMERA_CHUNK = 256 };

/* A ray in camera space. Every projection returns one; the lens and the pose then transform it.
 * Origin (ox, oy, 0), direction (dx, dy, dz) of any length; dz > 0 for perspective and
 * orthographic cameras. */
typedef struct vlCameraLocal {
  double ox, oy;
  double dx, dy, dz;
} vlCameraLocal;

/* A camera ready for batches. Camera space: x right, y down, z forward. Plain data, made by
 * vl_camera_compile. */
typedef struct vlCameraCompiled {
  vlProjection projection;
  bool has_lens;
  double cx, cy;         /* principal point, pixels */
  double skew_ratio;     /* skew / fy */
  double aspect;         /* fx / fy */
  double focal;          /* fx, pixels (orthographic: pixels per scene unit) */
  double inv_fx, inv_fy; /* orthographic: scene units per pixel */
  double rotation[9];    /* row-major 3x3 part of world_from_camera (may scale or mirror) */
  double position[3];    /* the camera's position in the world */
  /* inv_focus: 1 / focus distance, or 0 if focused at infinity */
  double lens_radius, inv_focus;
  /* Points p of the plane in focus satisfy p . focus = 1. Used by shaped lenses and if `ahead`
   * is set. */
  double focus[3];
  double shutter_open, shutter_time; /* seconds */
  double near_plane, far_plane;      /* z in camera space */
  /* Width of a pixel's footprint at distance t along the ray: pixel_width + pixel_spread * t
   * (world units). Perspective: the width is 0 and the spread is the angle (radians) that the
   * central pixel subtends. Orthographic: spread 0. */
  float pixel_spread, pixel_width;

  /* The fields below are used by all cameras except plain perspective and orthographic ones. */
  bool plain; /* perspective without distortion, or orthographic: every film point is valid */
  bool inclined; /* perspective: lens and near/far planes use depth along z, not distance */
  double fx, fy, skew; /* pixels */
  double shape[2];     /* shape numbers of the projection; for FOV: w and 2 tan(w/2) */
  /* how far a plane that wraps around extends beyond its edges, for filters */
  double over_x, over_y;
  double limit2; /* squared radius of the plane's valid disc */
  vlDistortionMap distortion;
  double camera_from_world[12];
  /* Set if the aperture is not a plain disc. Then vl_lens_points samples the aperture before
   * the loop over the rays. */
  bool shaped;
  bool ahead;      /* lens and near/far planes use depth along z, not distance */
  bool vignetting; /* rays have weights */
  vlBlades blades; /* polygonal aperture; count 0: none */
  const vlAperture *aperture;
  double lens_turn[2];    /* cosine and sine of the aperture image's rotation */
  double inv_ratio;       /* inverse of the aperture's width ratio */
  const vlOptics *optics; /* lens of many elements or null; optics.hot.c makes its rays */
  double pitch;           /* with optics: side of a pixel on the film, scene units */
  double eye_circle; /* omnidirectional stereo: radius of the eye circle, < 0 for the left eye;
                        0: none */
  vlCameraTime when;
  const vlOwnCamera *own;     /* the camera's own functions make its rays (own.h); else null */
  uint32_t own_size[2];       /* size of the image whose pixels they count */
  double own_from, own_clock; /* they get seconds: own_from + own_clock * time of a ray */
} vlCameraCompiled;

/* All arrays hold VL_PAD(n) elements. Elements past n may hold anything; the results for them
 * are undefined. A film position is pixel + film. pixel is the integer column and row, counted
 * from the top left; film is the offset from that pixel's top left corner. The two are stored
 * separately so that large images lose no precision. With wide filters film may lie outside [0,
 * 1). lens_u and lens_v are in [0, 1) and are not read without a lens. time in [0, 1) is the
 * fraction of the shutter interval. */
typedef struct vlCameraSamples {
  const float *film_x, *film_y;
  const int32_t *pixel_x, *pixel_y;
  const float *lens_u, *lens_v;
  const float *time;
} vlCameraSamples;

/* Rays in world space. d is normalised. The near and far planes give [t_min, t_max]; without
 * them it is [0, infinity). time is in seconds. valid (may be null) is 1, or 0 if the film
 * point lies outside the camera's domain. An invalid ray has t_max = -1, so that it hits
 * nothing, and an arbitrary unit vector d. weight (may be null) is a factor on the radiance
 * along the ray; it is written only if vl_camera_weighted. If weight is 0 and valid is 1, a
 * part of the lens blocks the ray; then t_max is -1 too. A weight of NaN (and valid 1, t_max
 * -1) stands for a sample that must be left out. */
typedef struct vlCameraRays {
  float *ox, *oy, *oz, *dx, *dy, *dz;
  float *t_min, *t_max;
  float *time;
  float *valid;
  float *weight;
} vlCameraRays;
/* The rays from number `first` on. */
VL_INLINE vlCameraRays vl_camera_rays_from(const vlCameraRays *r, uint32_t first) {
  return (vlCameraRays){.ox = r->ox + first,
                        .oy = r->oy + first,
                        .oz = r->oz + first,
                        .dx = r->dx + first,
                        .dy = r->dy + first,
                        .dz = r->dz + first,
                        .t_min = r->t_min + first,
                        .t_max = r->t_max + first,
                        .time = r->time + first,
                        .valid = r->valid ? r->valid + first : NULL,
                        .weight = r->weight ? r->weight + first : NULL};
}

/* A chunk of points or pixels in double: VL_PAD(n) elements are computed, n <=
 * VL_CAMERA_CHUNK. */
typedef struct vlCameraPixels {
  double x[VL_CAMERA_CHUNK], y[VL_CAMERA_CHUNK], z[VL_CAMERA_CHUNK], valid[VL_CAMERA_CHUNK];
} vlCameraPixels;
typedef struct vlCameraPoints {
  /* unproject: origin of the ray */
  double ox[VL_CAMERA_CHUNK], oy[VL_CAMERA_CHUNK], oz[VL_CAMERA_CHUNK];
  /* project: a point; unproject: a unit direction */
  double x[VL_CAMERA_CHUNK], y[VL_CAMERA_CHUNK], z[VL_CAMERA_CHUNK];
  double valid[VL_CAMERA_CHUNK];
} vlCameraPoints;

typedef struct vlCameraKernels {
  void (*rays)(const vlCameraCompiled *c, uint32_t n, const vlCameraSamples *s,
               const vlCameraRays *r);
  /* Maps film positions x, y (pixels) to world-space rays. */
  void (*unproject)(const vlCameraCompiled *c, uint32_t n, const vlCameraPixels *pixels,
                    vlCameraPoints *points);
  /* Maps world-space points to film positions x, y (pixels); pixels->z is the depth. */
  void (*project)(const vlCameraCompiled *c, uint32_t n, const vlCameraPoints *points,
                  vlCameraPixels *pixels);
} vlCameraKernels;

/* There is one table per instruction set. All tables give the same bits. */
VL_KERNEL_TABLE(vlCameraKernels, vl_camera)

/* Returns whether rays may have weights other than 1. */
static inline bool vl_camera_weighted(const vlCameraCompiled *c) {
  return c->vignetting || c->optics || c->own;
}

/* The time of a ray of a camera whose `when` is timed. share: of the exposure, 0 to 1. */
static inline double vl_camera_seconds(const vlCameraCompiled *c, int32_t pixel_x,
                                       int32_t pixel_y, float share) {
  const vlCameraTime *t = &c->when;
  double late = ((double)pixel_x - t->first_column) * t->per_column +
                ((double)pixel_y - t->first_row) * t->per_row;
  return c->shutter_open + late + c->shutter_time * vl_shutter_share(t, (double)share);
}

void vl_camera_compile(const vlCamera *camera, vlCameraCompiled *c);
/* The pose at a time: both 3 x 4, row-major. */
void vl_camera_pose_at(const vlCameraCompiled *c, double seconds, double world_from_camera[12],
                       double camera_from_world[12]);
/* The derivative of the world_from_camera of vl_camera_pose_at by the seconds; 0 outside the
 * camera's motion and at its ends. */
vlAffine vl_camera_rate_at(const vlCameraCompiled *c, double seconds);
/* Changes the clock: the time of rays becomes (seconds - origin) * scale. */
void vl_camera_retime(vlCameraCompiled *c, double origin, double scale);

#endif
