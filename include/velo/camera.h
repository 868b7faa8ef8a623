/* velo/camera.h: the camera, a value. Four independent factors: time, projection (intrinsics), lens, pose. Both ways:
 * pixels to rays and points to pixels. It knows neither world nor film. */
#ifndef VELO_CAMERA_H
#define VELO_CAMERA_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum vlProjection { VL_PROJECTION_PERSPECTIVE, VL_PROJECTION_ORTHOGRAPHIC } vlProjection;

typedef enum vlFovAxis { VL_FOV_VERTICAL, VL_FOV_HORIZONTAL, VL_FOV_DIAGONAL, VL_FOV_SMALLER, VL_FOV_LARGER } vlFovAxis;

/* Several equivalent ways in, one compiled form out. Everything optional is VL_UNSET. Ways that are given together must
 * agree (1e-6 relative), else ARGUMENT with both values named in the error.
 *
 * Focal length, any of: fov + fov_axis; view_distance d, zoom, pixel_size s (f_px = zoom d / s, the lecture);
 * focal_mm + sensor_width_mm; fx, fy in pixels. Principal point cx, cy in pixels from the window's top left corner;
 * default the centre. fov is that of a centred window. With no way given: fov 90 degrees across the smaller side. zoom
 * and pixel_size act on d only: given without it they are an error. fx alone or fy alone, focal_mm: square pixels.
 * Orthographic: fx, fy (pixels per scene unit); pixel_size (scene units per pixel) with zoom; or screen_* in scene
 * units; default -1 to 1 across the smaller side.
 *
 * Pose: eye, lookat, up, roll (the lecture); or world_from_camera (then eye, lookat, up are ignored). */
typedef struct vlCameraDef {
  uint32_t cookie;
  vlProjection projection;
  uint32_t width, height; /* pixels: h_res, v_res */

  double fov; /* radians */
  vlFovAxis fov_axis;
  double view_distance, zoom, pixel_size; /* d, zoom (unset: 1), s (unset: 1) of the lecture */
  double focal_mm, sensor_width_mm;
  double fx, fy, skew, cx, cy;
  double screen_min_x, screen_max_x, screen_min_y,
      screen_max_y; /* pbrt's screenwindow (y up, at distance 1, before fov) */

  double eye[3], lookat[3], up[3];
  double roll; /* radians about the view direction; positive turns the camera clockwise as seen from behind it */
  bool has_matrix;
  double world_from_camera[16]; /* camera x right, y down, z forward; may mirror or scale */

  double lens_radius;                 /* scene units; 0 pinhole */
  double focus_distance;              /* z of the plane in focus, scene units; unset: infinity */
  double shutter_open, shutter_close; /* seconds; default 0, 1 */
  double exposure_time;               /* a factor on radiance, as in the lecture; default 1 */
  double near_plane, far_plane; /* z in camera space; default 0, infinity. Cut what the camera sees, nothing else */
} vlCameraDef;

VL_API vlCameraDef vl_default_camera_def(uint32_t width, uint32_t height);

/* Compiled. Plain data: copy freely. Pixel (x, y), column and row from the top left corner:
 *   x_cam = (x - cx - skew (y - cy)/fy)/fx, y_cam = (y - cy)/fy, z_cam = 1. */
typedef struct vlCamera {
  vlProjection projection;
  uint32_t width, height;
  double fx, fy, skew, cx, cy;
  double world_from_camera[16], camera_from_world[16];
  double lens_radius, focus_distance;
  double shutter_open, shutter_close, exposure_time, near_plane, far_plane;
} vlCamera;

/* Errors: ARGUMENT with a message (fov out of range, eye = lookat, disagreeing ways, NaN, singular matrix).
 * up parallel to the view direction: a defined fallback basis, and *warning set to a static text (may be null). */
VL_API vlResult vl_camera_make(const vlCameraDef *def, vlCamera *camera, const char **warning, vlError *error);

/* The same camera for another resolution: the framing of the smaller field of view is kept as pbrt keeps it for fov
 * cameras: focal length and principal point scale with the smaller image side. */
VL_API vlResult vl_camera_resize(const vlCamera *camera, uint32_t width, uint32_t height, vlCamera *result);

/* One ray, in double: pinhole direction through film point (x, y) in pixels; direction normalised, world space.
 * false outside the domain. */
VL_API bool vl_camera_unproject(const vlCamera *camera, double x, double y, double origin[3], double direction[3]);
/* World point to film point; z is the depth along the view axis. false behind the camera or outside the domain. */
VL_API bool vl_camera_project(const vlCamera *camera, const double point[3], double pixel[2], double *z);

#ifdef __cplusplus
}
#endif
#endif
