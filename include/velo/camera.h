/** @file
 * velo/camera.h: the camera: a plain value that maps pixels to rays and points to pixels. It
 * consists of four independent parts: time, projection (intrinsics), lens and pose. It does not
 * refer to a world or a film. */
#ifndef VELO_CAMERA_H
#define VELO_CAMERA_H

#include "velo/base.h"
#include "velo/lens.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The map from directions to points of the projection plane: a constant of velo/projection.h.
 */
typedef uint32_t vlProjection;
/** The projections onto a plane; velo/projection.h has these and the others. */
enum {
  VL_PROJECTION_PERSPECTIVE, /**< all rays meet in one point */
  VL_PROJECTION_ORTHOGRAPHIC /**< all rays are parallel */
};

/** "perspective", "equidistant fisheye", ...; a constant string; "unknown" for another
 * number. */
VL_API const char *vl_projection_name(vlProjection projection);

/** The distortion model of a calibrated lens: a number, VL_DISTORTION_NONE (0) or another kind
 * of velo/distortion.h. It acts on the plane of the projection. */
typedef uint32_t vlDistortion;

/** "none", "opencv", "radial", "thinprism", "rad_tan_thin_prism": the name in headers of images
 * (velo.distortion); a constant string; "unknown" for another number. */
VL_API const char *vl_distortion_name(vlDistortion distortion);

/** The extent of the image that vlCameraDef.fov spans. SMALLER and LARGER mean the smaller and
 * the larger of width and height. */
typedef enum vlFovAxis {
  VL_FOV_VERTICAL,
  VL_FOV_HORIZONTAL,
  VL_FOV_DIAGONAL,
  VL_FOV_SMALLER,
  VL_FOV_LARGER
} vlFovAxis;

/** The arrangement of the two cameras (eyes) of a stereo pair. They are `interocular` apart;
 * the described camera is in the middle between them. PARALLEL: the axes are parallel.
 * OFF_AXIS: the axes are parallel, and the windows are shifted so that both images show the
 * same rectangle at the distance `convergence`, without keystone distortion (only for
 * perspective cameras without distortion). TOE_IN: the eyes are turned so that their axes cross
 * at that distance. OMNIDIRECTIONAL: each direction has its own eye on a circle around the
 * camera's vertical axis, so that a whole panorama has depth (only equirectangular,
 * cylindrical, equal-area and cube projections); the eyes converge at infinity. */
typedef enum vlStereoMode {
  VL_STEREO_NONE,
  VL_STEREO_PARALLEL,
  VL_STEREO_OFF_AXIS,
  VL_STEREO_TOE_IN,
  VL_STEREO_OMNIDIRECTIONAL
} vlStereoMode;
/** The eye that a camera stands for. BOTH: the described camera in the middle, from which
 * vl_camera_stereo and vl_camera_eye make the two eyes. */
typedef enum vlEye { VL_EYE_BOTH, VL_EYE_LEFT, VL_EYE_RIGHT } vlEye;
/** A stereo pair. */
typedef struct vlStereo {
  vlStereoMode mode;  /**< default VL_STEREO_NONE */
  double interocular; /**< distance between the eyes, scene units; default 0.065 (an adult's, in
                         metres) */
  double convergence; /**< depth z where the axes or windows meet, scene units; unset: infinity;
                         required by OFF_AXIS and TOE_IN */
} vlStereo;

/** The direction in which a rolling shutter reads the rows (DOWN, UP) or columns (RIGHT, LEFT)
 * of the sensor. */
typedef enum vlReadout {
  VL_READOUT_DOWN,
  VL_READOUT_UP,
  VL_READOUT_RIGHT,
  VL_READOUT_LEFT
} vlReadout;
/** The most points of a shutter curve. */
enum { VL_SHUTTER_POINTS = 16 };

/** The description of a camera. Its parameters are given in one of several equivalent ways;
 * vl_camera_make compiles it to a vlCamera. All optional numbers are VL_UNSET by default.
 * Parameters that determine the same quantity must agree (to 1e-6, relative); otherwise the
 * result is ARGUMENT, and the error names both values.
 *
 * The focal length is given by any of: fov with fov_axis; view_distance d, zoom and pixel_size
 * s (f_px = zoom d / s, as in the lecture); focal_mm with sensor_width_mm; fx, fy in pixels.
 * The principal point is cx, cy in pixels from the window's top left corner; by default it is
 * the centre. fov describes a window centred on the axis. If nothing is given, fov is 90
 * degrees across the smaller side. zoom and pixel_size are errors without view_distance. fx
 * alone, fy alone and focal_mm imply square pixels. Orthographic cameras use fx, fy (pixels per
 * scene unit), pixel_size (scene units per pixel) with zoom, or screen_* in scene units; their
 * default window is -1 to 1 across the smaller side.
 *
 * The pose is given by eye, lookat, up and roll (the lecture's), or by world_from_camera, which
 * replaces eye, lookat and up.
 *
 * A sample of pixel row r of `height` rows, counted in the direction of readout, is taken at
 * the time
 *   shutter_open + r/height readout + s (shutter_close - shutter_open);
 * s in [0, 1) is distributed by the shutter curve. */
typedef struct vlCameraDef {
  uint32_t cookie;
  vlProjection projection; /**< default VL_PROJECTION_PERSPECTIVE */
  uint32_t width, height;  /**< size of the image, pixels (the lecture's h_res, v_res) */

  double fov;         /**< field of view, radians */
  vlFovAxis fov_axis; /**< what fov spans */
  /** d, zoom (unset: 1), s (unset: 1) of the lecture */
  double view_distance, zoom, pixel_size;
  double focal_mm, sensor_width_mm; /**< focal length and sensor width, millimetres */
  /** calibration matrix, pixels: K = [fx skew cx; 0 fy cy; 0 0 1] */
  double fx, fy, skew, cx, cy;
  /** pbrt's screenwindow: the window at distance 1, y up, before fov scales it */
  double screen_min_x, screen_max_x, screen_min_y, screen_max_y;

  /** world space: position, a point on the view axis, the direction of image up */
  double eye[3], lookat[3], up[3];
  double roll;     /**< radians about the view direction; positive turns the camera clockwise as
                      seen from behind it */
  bool has_matrix; /**< world_from_camera is given, in place of eye, lookat, up */
  double world_from_camera[16]; /**< camera x right, y down, z forward; may mirror or scale */

  double lens_radius;    /**< radius of the aperture, scene units; 0: pinhole */
  double focus_distance; /**< z of the plane in focus (distance from the eye for the projections
                            listed at near_plane), scene units; unset: infinity, or set by
                            `lens` */
  vlLensDef lens;        /**< aperture shape, tilt, f-number, lenses of many elements */
  double shutter_open, shutter_close; /**< seconds; default 0, 1 */
  /** The shutter curve: how far open the shutter is over time. It is linear between its points
   * and 0 before the first and after the last. With 0 points the shutter is fully open
   * throughout. The curve distributes the samples over time and does not change the
   * exposure. */
  uint32_t shutter_points;
  /** The points of the shutter curve. shutter_at: time as a share of the interval from open to
   * close, 0 to 1, ascending. shutter_value: the opening at that time, in any unit. */
  double shutter_at[VL_SHUTTER_POINTS], shutter_value[VL_SHUTTER_POINTS];
  double readout; /**< seconds between the exposures of the first row and of row `height`; 0:
                     all rows at once */
  vlReadout readout_direction; /**< default VL_READOUT_DOWN */
  /** Camera motion. These fields give the pose at pose_times[1]; the fields above give the pose
   * at pose_times[0]. Between these times translation, rotation (along the shortest arc, at
   * constant speed) and scale are interpolated separately; before and after them the camera is
   * at rest. Unset vectors equal those of the first pose. With has_matrix_close only
   * world_from_camera_close and roll_close are used, also beside eye and lookat; with
   * has_matrix alone the vectors are an error. */
  double eye_close[3], lookat_close[3], up_close[3], roll_close;
  bool has_matrix_close; /**< world_from_camera_close is given */
  /** The pose at pose_times[1], and both times in seconds. Unset times are shutter_open and
   * shutter_close + readout. */
  double world_from_camera_close[16], pose_times[2];
  double exposure_time; /**< factor on radiance, as in the lecture; default 1 */
  /** Clipping planes of the rays that leave the camera, in scene units: z in camera space, or
   * the distance from the eye for projections that can see backwards (all but perspective,
   * orthographic, the orthographic fisheye, FOV and OPTICS). Defaults: 0 and infinity. Other
   * rays are not clipped. */
  double near_plane, far_plane;

  double shape[2];  /**< parameters of the projection (VL_PROJECTION_KINDS); unset: Panini 1,
                       cube 0; other projections with parameters require them */
  double max_angle; /**< fisheyes and calibrated models: radius of the image circle, radians
                     * from the axis; unset: the projection's limit, or half of a fisheye's fov
                     * (given, or its default of 180 degrees) */
  vlDistortion distortion;            /**< default none */
  uint32_t distortion_count;          /**< number of coefficients */
  double distortion_coefficients[14]; /**< in the order of the kind */

  vlStereo stereo;  /**< default none */
  vlEye stereo_eye; /**< the eye that vl_camera_make makes; default BOTH */

  /** A camera of one's own (velo/own.h); must outlive the def and its cameras. It replaces
   * projection, lens, distortion, focal length and principal point, whose members are then
   * ignored. Size, pose, time, planes (as distances from the rays' origins), exposure_time and
   * stereo keep their meanings. Default null: none. */
  const struct vlOwnCamera *own;
} vlCameraDef;

/** The default def for an image of this size, in pixels: a pinhole camera at the origin that
 * looks along -z. */
VL_API vlCameraDef vl_default_camera_def(uint32_t width, uint32_t height);

/** Sets projection, distortion, fx, fy, cx, cy from one of COLMAP's camera models by its name
 * (SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, OPENCV_FISHEYE, FULL_OPENCV, FOV,
 * SIMPLE_RADIAL_FISHEYE, RADIAL_FISHEYE, THIN_PRISM_FISHEYE, SIMPLE_DIVISION, DIVISION,
 * SIMPLE_FISHEYE, FISHEYE, EUCM, EQUIRECTANGULAR, RAD_TAN_THIN_PRISM_FISHEYE) with its
 * parameters in COLMAP's order. COLMAP's first pixel is centred at (0.5, 0.5), as here.
 * ARGUMENT: an unknown name (the message has the nearest), a wrong count. */
VL_API vlResult vl_camera_def_colmap(vlCameraDef *def, const char *model,
                                     const double *parameters, uint32_t count, vlError *error);

/** All distortion models in one common form (equations: docs/cameras.md), made by
 * vl_camera_make. */
typedef struct vlDistortionMap {
  /** Rational radial (k1 k2 k3 .. over k4 k5 k6), tangential and thin prism coefficients. */
  double numerator[6], denominator[3], tangential[2], prism[4];
  bool radial_first; /**< the tangential and thin prism terms are those of the point after its
                        radial distortion; false: of the point before it */
  double tilt[9], untilt[9]; /**< row-major homography of a tilted sensor, and its inverse */
  double radius;  /**< radius of the disc around the projection plane's centre in which the map
                     is one-to-one */
  uint32_t steps; /**< number of Newton iterations that suffice to invert the map in that disc;
                     0: no distortion */
} vlDistortionMap;

/** A compiled camera (vl_camera_make). It is plain data that may be copied; the aperture and
 * the optics that it points to must outlive it. Fields have the meanings of vlCameraDef's, and
 * all are set. A film point (x, y), in pixels from the top left corner, is on the projection
 * plane at x_cam = (x - cx - skew (y - cy)/fy)/fx, y_cam = (y - cy)/fy; the perspective
 * projection's plane is z_cam = 1. */
typedef struct vlCamera {
  vlProjection projection;     /**< the map from directions to the plane */
  uint32_t width, height;      /**< pixels */
  double fx, fy, skew, cx, cy; /**< pixels */
  /** the pose (at pose_times[0]) and its inverse */
  double world_from_camera[16], camera_from_world[16];
  double lens_radius, focus_distance; /**< scene units */
  vlLens lens;                        /**< compiled lens */
  /** seconds; factor; scene units */
  double shutter_open, shutter_close, exposure_time, near_plane, far_plane;
  uint32_t shutter_points; /**< number of points of the shutter curve */
  /** points of the shutter curve */
  double shutter_at[VL_SHUTTER_POINTS], shutter_value[VL_SHUTTER_POINTS];
  double readout;              /**< seconds */
  vlReadout readout_direction; /**< direction in which the rolling shutter reads the sensor */
  bool moves;                  /**< whether the camera has a second pose */
  double world_from_camera_close[16]; /**< the pose at pose_times[1] */
  double pose_times[2];               /**< seconds */
  double shape[2];                    /**< parameters of the projection */
  double limit; /**< radius of the projection plane's valid disc (image circle, or limit of the
                   model); may be infinity */
  vlDistortionMap distortion; /**< compiled distortion */
  double outside; /**< share of the image, 0 to 1, that is outside the camera's domain */
  /** omnidirectional stereo: radius of the circle of eyes, scene units; positive for the right
   * eye, negative for the left; 0: a single eye point */
  double eye_circle;
  const struct vlOwnCamera *own; /**< the projection OWN: its functions; else null */
  double own_size[2];  /**< OWN: width and height of the image whose pixels its functions count.
                          (x_cam, y_cam) is a film point in these pixels: fx, fy are 1 and cx,
                          cy 0 unless the camera was resized */
  double own_pixel[2]; /**< OWN: the side of that image's central pixel: angle, radians; width,
                          units of camera space */
} vlCamera;

/** Compiles a def. Errors: ARGUMENT with a message (fov out of range, eye = lookat, parameters
 * that disagree, NaN, singular matrix). *warning (may be null) is set to null or to a constant
 * string. There is a warning when up is parallel to the view direction (a defined fallback is
 * used), and when the distortion is not one-to-one in the whole image or its model ends inside
 * it: `outside` is then the share of the image without rays. */
VL_API vlResult vl_camera_make(const vlCameraDef *def, vlCamera *camera, const char **warning,
                               vlError *error);

/** Makes one eye of a stereo pair from the camera in the middle between the eyes; for BOTH the
 * result is that camera. ARGUMENT: the projection does not support the mode, or a number is out
 * of range. */
VL_API vlResult vl_camera_eye(const vlCamera *camera, const vlStereo *stereo, vlEye eye,
                              vlCamera *result, vlError *error);
/** Makes both eyes of a def and ignores its `stereo_eye`. warning: as in vl_camera_make.
 * Errors: as vl_camera_make; ARGUMENT also for a def without stereo. */
VL_API vlResult vl_camera_stereo(const vlCameraDef *def, vlCamera *left, vlCamera *right,
                                 const char **warning, vlError *error);
/** Makes the same camera with another pose, at rest. Only the pose is recomputed, so the call
 * is cheap enough for each frame of a trajectory. ARGUMENT: the matrix is not finite, or
 * singular. */
VL_API vlResult vl_camera_move(const vlCamera *camera, const double world_from_camera[16],
                               vlCamera *result, vlError *error);
/** Makes the same camera in motion, for motion blur: from the pose `open` at times[0] to the
 * pose `close` at times[1], in seconds. ARGUMENT: a matrix is not finite or is singular, only
 * one of the poses mirrors, or the times do not ascend. */
VL_API vlResult vl_camera_travel(const vlCamera *camera, const double open[16],
                                 const double close[16], const double times[2],
                                 vlCamera *result, vlError *error);
/** Freezes the camera at one time, in seconds: the result is at rest with the pose of that
 * time, and its shutter is open for that instant only, for all rows at once. It sees moving
 * objects at that time, too. ARGUMENT: a null pointer, or a time that is not finite. */
VL_API vlResult vl_camera_at(const vlCamera *camera, double time, vlCamera *result);
/** The time, in seconds, of a sample at film point (x, y), in pixels. It is the quantile u,
 * from 0 to 1, of the exposure of that pixel's row; u = 0.5 is the middle of the exposure. */
VL_API double vl_camera_time(const vlCamera *camera, double x, double y, double u);

/** Makes the same camera for another image size, in pixels, 1 to 2^24. Focal length and
 * principal point scale with the smaller side, as pbrt frames cameras given by fov. Projection
 * planes that hold the whole sphere or a cube are stretched to the new size; OPTICS keeps the
 * film's diagonal. ARGUMENT: the size is out of range. */
VL_API vlResult vl_camera_resize(const vlCamera *camera, uint32_t width, uint32_t height,
                                 vlCamera *result);

/** The largest factor of vl_camera_coarse. */
enum { VL_MAX_COARSE = 64 };
/** Makes the same camera with pixels that are `factor` times as wide and as high, for a first
 * coarse image. Pixel (x, y) covers the pixels from (factor x, factor y) on; the last column
 * and row may reach beyond the image. ARGUMENT: factor is not 1 to 64. */
VL_API vlResult vl_camera_coarse(const vlCamera *camera, uint32_t factor, vlCamera *result);

/** The pinhole ray through film point (x, y), in pixels: origin and normalised direction in
 * world space, in double precision. Returns false if the point is outside the camera's domain.
 *
 * A moving camera has the pose of the middle of its exposure (vl_camera_time with u = 0.5),
 * with a rolling shutter that of the row (or column) of the film point, linear in time between
 * the rows' centres; beyond the image's edges that at the edge. vl_camera_at holds it at
 * another time. */
VL_API bool vl_camera_unproject(const vlCamera *camera, double x, double y, double origin[3],
                                double direction[3]);
/** The film point, in pixels, of a world point; *z: its depth along the view axis, scene units
 * (may be null). Returns false if the point is behind the camera or outside its domain.
 *
 * For a moving camera with a rolling shutter, the film point and the time of its row are solved
 * for together, so that vl_camera_unproject's ray at the film point leads to the point. If
 * several rows of the image see the point, the result is of the one that is read first (rows
 * less than 1/16 of the readout apart may be taken for each other). If none does, the result is
 * outside the image: as the row read first sees it beyond its edge, else as the last one does,
 * else false. */
VL_API bool vl_camera_project(const vlCamera *camera, const double point[3], double pixel[2],
                              double *z);

/** The times, in seconds, at which `count` film points (x, y), pixels, see the world: those of
 * vl_camera_unproject's rays, and of the points that vl_camera_project finds there. The middle
 * of the exposure, with a rolling shutter of each film point's row, linear between the rows'
 * centres, beyond the image's edges (and where x or y is NaN) that at an edge. Writes nothing
 * if a pointer is null. */
VL_API void vl_camera_film_times(const vlCamera *camera, size_t count, const double *pixels,
                                 double *times);

/** vl_camera_unproject for `count` film points (x, y) in `pixels`, with bitwise equal results.
 * Writes 3 numbers per point to `origins` (may be null) and to `directions`. valid[i] (may be
 * null) is 1; for a point outside the domain it is 0, and its other outputs are 0. */
VL_API void vl_camera_unproject_batch(const vlCamera *camera, size_t count,
                                      const double *pixels, double *origins, double *directions,
                                      uint8_t *valid);
/** vl_camera_project for `count` points (x, y, z) in `points`, with bitwise equal results.
 * Writes 2 numbers per point to `pixels` and 1 to `z` (may be null). valid[i] (may be null) is
 * 1; for a point without a projection it is 0, and its other outputs are 0. */
VL_API void vl_camera_project_batch(const vlCamera *camera, size_t count, const double *points,
                                    double *pixels, double *z, uint8_t *valid);

/** Solid angle, in steradians, of the pixel-sized square of the film around (x, y), computed
 * from the projection's derivative at that point. It is 0 outside the domain and for
 * orthographic cameras. Mirroring and scaling of the pose are ignored. */
VL_API double vl_camera_solid_angle(const vlCamera *camera, double x, double y);

#ifdef __cplusplus
}
#endif
#endif
