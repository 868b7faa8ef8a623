/** @file
 * velo/camera.h: the camera, a value. Four independent factors: time, projection (intrinsics), lens, pose. Both ways:
 * pixels to rays and points to pixels. It knows neither world nor film. */
#ifndef VELO_CAMERA_H
#define VELO_CAMERA_H

#include "velo/base.h"
#include "velo/lens.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Which point of the plane a direction lands on: docs/cameras.md has the equations. The plane's unit is the focal
 * length (fx, fy pixels); for angles it is a radian. */
typedef enum vlProjection {
  VL_PROJECTION_PERSPECTIVE,
  VL_PROJECTION_ORTHOGRAPHIC,
  VL_PROJECTION_EQUIDISTANT,     /**< fisheyes: r = theta */
  VL_PROJECTION_EQUISOLID,       /**< 2 sin(theta / 2) */
  VL_PROJECTION_STEREOGRAPHIC,   /**< 2 tan(theta / 2) */
  VL_PROJECTION_SINE,            /**< the "orthographic" fisheye: sin(theta) */
  VL_PROJECTION_EQUIRECTANGULAR, /**< longitude, latitude; limits are the screen window, in radians */
  VL_PROJECTION_EQUAL_AREA,      /**< octahedral: the sphere in a square -1 to 1 */
  VL_PROJECTION_CYLINDRICAL,     /**< longitude, tangent of the latitude */
  VL_PROJECTION_CUBE,            /**< six faces; shape: 0 (default) in a row, 1 in a cross: docs/cameras.md */
  VL_PROJECTION_PANINI,          /**< shape: d >= 0 */
  VL_PROJECTION_FOV,             /**< shape: w, radians */
  VL_PROJECTION_DIVISION,        /**< shape: lambda */
  VL_PROJECTION_UNIFIED,         /**< shape: xi >= 0 (Mei) */
  VL_PROJECTION_EUCM,            /**< shape: alpha in [0, 1], beta > 0 */
  VL_PROJECTION_DOUBLE_SPHERE,   /**< shape: xi in (-1, 1), alpha in [0, 1] */
  VL_PROJECTION_OPTICS           /**< a lens of many elements: lens.optics */
} vlProjection;

/** "perspective", "equidistant fisheye", ...; "unknown" for another number. */
VL_API const char *vl_projection_name(vlProjection projection);

/** How a calibrated lens's coefficients are written. They act on the plane of the projection. */
typedef enum vlDistortion {
  VL_DISTORTION_NONE,
  VL_DISTORTION_OPENCV,    /**< k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]]: 4, 5, 8, 12 or 14 numbers */
  VL_DISTORTION_RADIAL,    /**< k1 [k2 [k3 [k4]]]: with EQUIDISTANT it is OpenCV's and COLMAP's fisheye */
  VL_DISTORTION_THIN_PRISM /**< COLMAP's k1 k2 p1 p2 k3 k4 sx1 sy1 */
} vlDistortion;

typedef enum vlFovAxis { VL_FOV_VERTICAL, VL_FOV_HORIZONTAL, VL_FOV_DIAGONAL, VL_FOV_SMALLER, VL_FOV_LARGER } vlFovAxis;

/** Two eyes from one camera: it stands between them, the eyes half of `interocular` to its left and right.
 * PARALLEL: the axes are parallel. OFF_AXIS: they too, and both windows are shifted so that they meet at the distance
 * `convergence`: a rectangle that both see whole, without keystone (perspective without distortion only). TOE_IN: the
 * eyes are turned until their axes cross there. OMNIDIRECTIONAL: each direction has its own eye on a circle about the
 * camera's vertical axis, so that all of a panorama has depth (equirectangular, cylindrical, equal-area, cube); its
 * eyes converge at infinity. */
typedef enum vlStereoMode {
  VL_STEREO_NONE,
  VL_STEREO_PARALLEL,
  VL_STEREO_OFF_AXIS,
  VL_STEREO_TOE_IN,
  VL_STEREO_OMNIDIRECTIONAL
} vlStereoMode;
/** Which image a camera takes; BOTH: from between them, until vl_camera_stereo or vl_camera_eye makes two. */
typedef enum vlEye { VL_EYE_BOTH, VL_EYE_LEFT, VL_EYE_RIGHT } vlEye;
typedef struct vlStereo {
  vlStereoMode mode;
  double interocular; /**< between the eyes, scene units; default 0.065 (metres, a grown person's) */
  double
      convergence; /**< z where the axes or windows meet, scene units; unset: infinity. OFF_AXIS and TOE_IN need it */
} vlStereo;

/** A rolling shutter: which way the rows (or columns) of the sensor are read, one after the other. */
typedef enum vlReadout { VL_READOUT_DOWN, VL_READOUT_UP, VL_READOUT_RIGHT, VL_READOUT_LEFT } vlReadout;
enum { VL_SHUTTER_POINTS = 16 };

/** Several equivalent ways in, one compiled form out. Everything optional is VL_UNSET. Ways that are given together
 * must agree (1e-6 relative), else ARGUMENT with both values named in the error.
 *
 * Focal length, any of: fov + fov_axis; view_distance d, zoom, pixel_size s (f_px = zoom d / s, the lecture);
 * focal_mm + sensor_width_mm; fx, fy in pixels. Principal point cx, cy in pixels from the window's top left corner;
 * default the centre. fov is that of a centred window. With no way given: fov 90 degrees across the smaller side. zoom
 * and pixel_size act on d only: given without it they are an error. fx alone or fy alone, focal_mm: square pixels.
 * Orthographic: fx, fy (pixels per scene unit); pixel_size (scene units per pixel) with zoom; or screen_* in scene
 * units; default -1 to 1 across the smaller side.
 *
 * Pose: eye, lookat, up, roll (the lecture); or world_from_camera (then eye, lookat, up are ignored).
 *
 * Time: a sample of pixel row r of `height`, counted in the direction of readout, falls at
 *   shutter_open + r/height readout + s (shutter_close - shutter_open), s in [0, 1) spread as the shutter's curve says.
 */
typedef struct vlCameraDef {
  uint32_t cookie;
  vlProjection projection;
  uint32_t width, height; /**< pixels: h_res, v_res */

  double fov; /**< radians */
  vlFovAxis fov_axis;
  double view_distance, zoom, pixel_size; /**< d, zoom (unset: 1), s (unset: 1) of the lecture */
  double focal_mm, sensor_width_mm;
  double fx, fy, skew, cx, cy;
  double screen_min_x, screen_max_x, screen_min_y,
      screen_max_y; /**< pbrt's screenwindow (y up, at distance 1, before fov) */

  double eye[3], lookat[3], up[3];
  double roll; /**< radians about the view direction; positive turns the camera clockwise as seen from behind it */
  bool has_matrix;
  double world_from_camera[16]; /**< camera x right, y down, z forward; may mirror or scale */

  double lens_radius;    /**< scene units; 0 pinhole */
  double focus_distance; /**< z of the plane in focus (distance from the eye, as the planes below), scene units; unset:
                          * infinity, or what `lens` says */
  vlLensDef lens;
  double shutter_open, shutter_close; /**< seconds; default 0, 1 */
  /** How far open the shutter is: straight between points (share of the time from open to close, ascending; any unit),
   * shut before the first and after the last. 0 points: open throughout. Says when light comes, not how much. */
  uint32_t shutter_points;
  double shutter_at[VL_SHUTTER_POINTS], shutter_value[VL_SHUTTER_POINTS];
  double readout; /**< seconds from the first row's exposure to the (not existing) one after the last; 0: all at once */
  vlReadout readout_direction;
  /** A camera that moves: its pose at pose_times[1]; all above is that at pose_times[0]. Between them position,
   * rotation and stretch each go their own way (rotation by the shortest arc, evenly), before and after it rests. What
   * is unset is as above; with a matrix only has_matrix_close, world_from_camera_close and roll_close count. pose_times
   * in seconds; unset: shutter_open and shutter_close + readout. */
  double eye_close[3], lookat_close[3], up_close[3], roll_close;
  bool has_matrix_close;
  double world_from_camera_close[16], pose_times[2];
  double exposure_time; /**< a factor on radiance, as in the lecture; default 1 */
  /** z in camera space; distance from the eye for projections that can look back (all but perspective, orthographic,
   * the orthographic fisheye, FOV and OPTICS). Default 0, infinity. Cut what the camera sees, nothing else */
  double near_plane, far_plane;

  double shape[2];  /**< the projection's own numbers; unset: Panini 1, cube 0, the others must be given */
  double max_angle; /**< fisheyes and calibrated models: the image circle, radians from the axis; unset: as far as the
                     * projection goes, or half of fov where a fisheye's fov is given or its default (180 degrees) */
  vlDistortion distortion;
  uint32_t distortion_count;
  double distortion_coefficients[14];

  vlStereo stereo;
  vlEye stereo_eye;
} vlCameraDef;

VL_API vlCameraDef vl_default_camera_def(uint32_t width, uint32_t height);

/** Sets projection, distortion, fx, fy, cx, cy from one of COLMAP's camera models by its name (SIMPLE_PINHOLE, PINHOLE,
 * SIMPLE_RADIAL, RADIAL, OPENCV, OPENCV_FISHEYE, FULL_OPENCV, FOV, SIMPLE_RADIAL_FISHEYE, RADIAL_FISHEYE,
 * THIN_PRISM_FISHEYE) with its parameters in COLMAP's order. COLMAP's first pixel is centred at (0.5, 0.5), as here.
 * ARGUMENT: an unknown name (the nearest is told), a wrong count. */
VL_API vlResult vl_camera_def_colmap(vlCameraDef *def, const char *model, const double *parameters, uint32_t count,
                                     vlError *error);

/** The distortion in one form (equations in docs/cameras.md), made by vl_camera_make. */
typedef struct vlDistortionMap {
  double numerator[4], denominator[3], tangential[2], prism[4];
  double tilt[9], untilt[9]; /**< row-major homographies */
  double radius;             /**< of the disc of the plane around its centre inside which nothing folds */
  uint32_t steps;            /**< of Newton's method that the inverse takes everywhere in it; 0: no distortion */
} vlDistortionMap;

/** Compiled. Plain data: copy freely. Pixel (x, y), column and row from the top left corner:
 *   x_cam = (x - cx - skew (y - cy)/fy)/fx, y_cam = (y - cy)/fy: the point of the plane; perspective: z_cam = 1. */
typedef struct vlCamera {
  vlProjection projection;
  uint32_t width, height;
  double fx, fy, skew, cx, cy;
  double world_from_camera[16], camera_from_world[16];
  double lens_radius, focus_distance;
  vlLens lens;
  double shutter_open, shutter_close, exposure_time, near_plane, far_plane;
  uint32_t shutter_points;
  double shutter_at[VL_SHUTTER_POINTS], shutter_value[VL_SHUTTER_POINTS];
  double readout;
  vlReadout readout_direction;
  bool moves;                         /**< from world_from_camera at pose_times[0] to */
  double world_from_camera_close[16]; /**< at pose_times[1] */
  double pose_times[2];
  double shape[2];
  double limit; /**< radius of the plane's valid disc: image circle, the model's own end; infinity */
  vlDistortionMap distortion;
  double outside;    /**< share of the image that sees nothing */
  double eye_circle; /**< omnidirectional stereo: the circle's radius, above 0 for the right eye; 0: one eye point */
} vlCamera;

/** Errors: ARGUMENT with a message (fov out of range, eye = lookat, disagreeing ways, NaN, singular matrix).
 * up parallel to the view direction: a defined fallback basis, and *warning set to a static text (may be null).
 * So too when a lens's distortion folds inside the image, or its model ends there: `outside` then tells the share of
 * the image that sees nothing. */
VL_API vlResult vl_camera_make(const vlCameraDef *def, vlCamera *camera, const char **warning, vlError *error);

/** One eye of a camera that stands between them; BOTH: the camera itself. Any number of cameras from one. ARGUMENT: a
 * mode that the projection cannot have, a number out of range. */
VL_API vlResult vl_camera_eye(const vlCamera *camera, const vlStereo *stereo, vlEye eye, vlCamera *result,
                              vlError *error);
/** Both eyes of a def, whatever its `stereo_eye`; warning as in vl_camera_make. ARGUMENT: a def without stereo, too. */
VL_API vlResult vl_camera_stereo(const vlCameraDef *def, vlCamera *left, vlCamera *right, const char **warning,
                                 vlError *error);
/** The same camera elsewhere: only its pose changes, and nothing is measured anew; cheap enough for each frame of a
 * trajectory. ARGUMENT: not finite, singular. */
VL_API vlResult vl_camera_move(const vlCamera *camera, const double world_from_camera[16], vlCamera *result,
                               vlError *error);
/** The same on the way from one pose at times[0] to another at times[1], seconds: blurred by its motion. ARGUMENT: as
 * above; one pose mirrors and the other does not; times that do not ascend. */
VL_API vlResult vl_camera_travel(const vlCamera *camera, const double open[16], const double close[16],
                                 const double times[2], vlCamera *result, vlError *error);
/** The camera held at one time, in seconds: at rest where it is then, its shutter open for that instant, all rows at
 * once. What moves in the world is seen as it is then. ARGUMENT: null, time not finite. */
VL_API vlResult vl_camera_at(const vlCamera *camera, double time, vlCamera *result);
/** When light falls on the pixel around film point (x, y): u in [0, 1] is the share of it that came before; 0.5: the
 * middle of that pixel's exposure. */
VL_API double vl_camera_time(const vlCamera *camera, double x, double y, double u);

/** The same camera for another resolution: the framing of the smaller field of view is kept as pbrt keeps it for fov
 * cameras: focal length and principal point scale with the smaller image side. */
VL_API vlResult vl_camera_resize(const vlCamera *camera, uint32_t width, uint32_t height, vlCamera *result);

/** One ray, in double: pinhole direction through film point (x, y) in pixels; direction normalised, world space.
 * false outside the domain. All that follow see a camera that moves where it is at pose_times[0]; ask vl_camera_at for
 * another time. */
VL_API bool vl_camera_unproject(const vlCamera *camera, double x, double y, double origin[3], double direction[3]);
/** World point to film point; z is the depth along the view axis. false behind the camera or outside the domain. */
VL_API bool vl_camera_project(const vlCamera *camera, const double point[3], double pixel[2], double *z);

/** The same for arrays of triples and pairs, the same bits as one by one. valid[i] is 1 or 0; where it is 0 the other
 * outputs are 0. z, origins and valid may be null. */
VL_API void vl_camera_unproject_batch(const vlCamera *camera, size_t count, const double *pixels, double *origins,
                                      double *directions, uint8_t *valid);
VL_API void vl_camera_project_batch(const vlCamera *camera, size_t count, const double *points, double *pixels,
                                    double *z, uint8_t *valid);

/** Solid angle (steradians) that a pixel-sized square of the film around (x, y) sees, by the derivative there; 0
 * outside the domain and for orthographic cameras. A matrix that mirrors or scales does not enter. */
VL_API double vl_camera_solid_angle(const vlCamera *camera, double x, double y);

#ifdef __cplusplus
}
#endif
#endif
