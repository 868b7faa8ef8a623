/** @file
 * velo/lens.h: the lens of a camera: the shape of its aperture, the plane in focus, lenses of many elements. Part of
 * velo/camera.h. */
#ifndef VELO_LENS_H
#define VELO_LENS_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- aperture images -------------------------------------------------------------------------------------------- */

/** An image of the aperture. Constant; shared by any number of cameras; it must outlive them. */
typedef struct vlAperture vlAperture;
/** Makes an aperture from width x height values, rows from the top, 0 closed; copied. The image covers the square from
 * -1 to 1 around the aperture's unit circle, upright: blur behind the plane in focus has its shape. ARGUMENT: a side
 * above 4096, values that are negative or not finite, all of them zero. */
VL_API vlResult vl_aperture_create(vlContext *context, uint32_t width, uint32_t height, const float *values,
                                   vlAperture **aperture, vlError *error);
/** Makes one of pbrt's apertures: "gaussian", "square", "pentagon", "star". ARGUMENT: another name. */
VL_API vlResult vl_aperture_create_named(vlContext *context, const char *name, vlAperture **aperture, vlError *error);
/** Null is allowed. */
VL_API void vl_aperture_destroy(vlAperture *aperture);

/* ---- lenses of many elements ------------------------------------------------------------------------------------ */

/** A surface of a lens. Lengths in mm. radius: of curvature, positive where the centre is on the film's side; 0: the
 * aperture stop. thickness: along the axis to the next surface. ior: of the material behind the surface, on the film's
 * side; 0 or 1: air. aperture: diameter of the opening. */
typedef struct vlLensSurface {
  double radius, thickness, ior, aperture; /**< mm; ior has no unit */
} vlLensSurface;

/** How to make a lens of many elements. */
typedef struct vlOpticsDef {
  uint32_t cookie;
  const vlLensSurface
      *surfaces;  /**< from the scene's side to the film's, at most 64; the last thickness is ignored; copied */
  uint32_t count; /**< number of surfaces */
  double aperture_diameter;   /**< mm, of the stop; unset, or above the stop's own: the stop's own */
  double focus_distance;      /**< from the film, scene units; default 10 */
  double film_diagonal;       /**< mm; default 35 */
  double unit_mm;             /**< millimetres per scene unit; default 1000 */
  const vlAperture *aperture; /**< image of the stop's opening; null: round */
} vlOpticsDef;
/** The default def, without surfaces. */
VL_API vlOpticsDef vl_default_optics_def(void);

/** A focused lens of many elements. Constant; it must outlive the cameras that use it. */
typedef struct vlOptics vlOptics;
/** Makes a lens: focuses it by moving the film, as pbrt does (thick lens approximation, book 5.4.3), and finds its exit
 * pupil. Errors: ARGUMENT (too many or no surfaces, a number out of range, a lens that cannot focus at this distance or
 * transmits no light), MEMORY. */
VL_API vlResult vl_optics_create(vlContext *context, const vlOpticsDef *def, vlOptics **optics, vlError *error);
/** The same with surfaces from a text file: four numbers a line (radius, thickness, ior, aperture), # comments. def's
 * surfaces are ignored. Errors also: SCENE (wrong contents, with the place), MISSING, IO. */
VL_API vlResult vl_optics_load(vlContext *context, const char *path, const vlOpticsDef *def, vlOptics **optics,
                               vlError *error);
/** A copy of a lens focused at another distance from the film, scene units. Errors as vl_optics_create. */
VL_API vlResult vl_optics_refocus(vlContext *context, const vlOptics *optics, double focus_distance, vlOptics **result,
                                  vlError *error);
/** Null is allowed. */
VL_API void vl_optics_destroy(vlOptics *optics);

/** The properties of a lens; lengths in scene units. */
typedef struct vlOpticsInfo {
  double focal_length;   /**< of the whole lens */
  double film_distance;  /**< from the film to the last surface */
  double length;         /**< from the film to the first surface */
  double rear_principal; /**< from the film to the rear principal plane, from which angles are measured */
  double focus_distance; /**< from the film */
  double film_diagonal;  /**< of the film */
  double f_number;       /**< focal length / diameter of the entrance pupil; 0 with an aperture image */
} vlOpticsInfo;
/** The def that a lens was made of, and its surfaces (room for 64). */
VL_API void vl_optics_def(const vlOptics *optics, vlOpticsDef *def, vlLensSurface *surfaces);
/** Fills *info. */
VL_API void vl_optics_info(const vlOptics *optics, vlOpticsInfo *info);

/* ---- the lens of a camera --------------------------------------------------------------------------------------- */

/** The description of a lens (vlCameraDef.lens), with lens_radius and focus_distance of vlCameraDef. */
typedef struct vlLensDef {
  /** The lens radius by its f-number: focal length / (2 f_number); unset: lens_radius is used. The focal length in mm
   * is focal_mm, or follows from sensor_width_mm; unit_mm is the number of millimetres per scene unit (default 1000).
   */
  double f_number, unit_mm;
  /** The plane in focus contains this point of the world, or what this pixel sees (found by vl_autofocus, which
   * vl_render calls where needed). Unset: focus_distance is used. */
  double focus_point[3], focus_pixel[2];
  uint32_t blades; /**< corners of the aperture, a polygon inscribed in its circle: 3 to 32; 0: round */
  double rotation; /**< of blades or image, radians, clockwise as seen from behind the camera; 0: a corner is up */
  double ratio;    /**< the aperture's height / width; anamorphic lenses 2; default 1 */
  const vlAperture *aperture; /**< image of the aperture; null: none */
  /** tilt_x, tilt_y: rotation of the plane in focus, radians, about its point on the axis: x > 0 moves its top away, y
   * > 0 its left side. lens_tilt_x, lens_tilt_y: rotation of the lens (Scheimpflug), radians: x > 0 down, y > 0 to the
   * right; the plane in focus then contains the line f / sin(lens_tilt) below (right of) the lens; requires the focal
   * length in mm. Perspective and orthographic cameras only. */
  double tilt_x, tilt_y, lens_tilt_x, lens_tilt_y;
  bool vignetting; /**< natural vignetting: cos^4 of the angle from the axis; perspective only */
  /** Exposure by the camera's settings instead of exposure_time: seconds ISO / (120 f_number^2), the reciprocal of the
   * luminance that just saturates a sensor (ISO 12232; Lagarde and de Rousiers 2014). seconds unset: the shutter's. */
  double iso, seconds;
  const vlOptics *optics; /**< VL_PROJECTION_OPTICS: the lens; else null */
} vlLensDef;

/** A compiled lens, part of vlCamera. */
typedef struct vlLens {
  uint32_t blades;        /**< as in vlLensDef */
  double rotation, ratio; /**< as in vlLensDef */
  double tilt[2];         /**< slopes of the plane in focus along x and y */
  double
      hinge[2]; /**< 1 / distance from the axis of the line where the plane in focus meets the lens plane (lens_tilt) */
  double focus_pixel[2];      /**< unset: the focus distance is known */
  bool vignetting;            /**< as in vlLensDef */
  const vlAperture *aperture; /**< not owned; may be null */
  const vlOptics *optics;     /**< not owned; may be null */
} vlLens;

#ifdef __cplusplus
}
#endif
#endif
