/** @file
 * velo/lens.h: what stands between the projection and the world: the shape of a lens's opening, the plane in focus, and
 * lenses of many elements. Part of velo/camera.h. */
#ifndef VELO_LENS_H
#define VELO_LENS_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- the opening as an image ----------------------------------------------------------------------------------- */

/** Constant once made; any number of cameras may share it. It must outlive them. */
typedef struct vlAperture vlAperture;
/** width x height values, rows from the top, 0 closed; copied. The image lies over the square -1 to 1 around the
 * opening's unit circle, upright: what is blurred behind the plane in focus shows it as it is. ARGUMENT: a side above
 * 4096, values that are negative or not finite, all of them zero. */
VL_API vlResult vl_aperture_create(vlContext *context, uint32_t width, uint32_t height, const float *values,
                                   vlAperture **aperture, vlError *error);
/** pbrt's: "gaussian", "square", "pentagon", "star". ARGUMENT: another name. */
VL_API vlResult vl_aperture_create_named(vlContext *context, const char *name, vlAperture **aperture, vlError *error);
VL_API void vl_aperture_destroy(vlAperture *aperture);

/* ---- lenses of many elements ------------------------------------------------------------------------------------ */

/** A surface; mm. radius: of curvature, positive where the centre lies on the film's side; 0: the aperture stop.
 * thickness: along the axis to the next surface. ior: of what follows the surface on the film's side; 0 or 1: air.
 * aperture: diameter of the opening. */
typedef struct vlLensSurface {
  double radius, thickness, ior, aperture;
} vlLensSurface;

typedef struct vlOpticsDef {
  uint32_t cookie;
  const vlLensSurface
      *surfaces; /**< from the scene's side to the film's, at most 64; the last thickness does not count */
  uint32_t count;
  double aperture_diameter;   /**< mm, of the stop; unset, or more than the stop's own: the stop's own */
  double focus_distance;      /**< from the film, scene units; default 10 */
  double film_diagonal;       /**< mm; default 35 */
  double unit_mm;             /**< millimetres in a scene unit; default 1000 */
  const vlAperture *aperture; /**< in the stop, over its square; null: round */
} vlOpticsDef;
VL_API vlOpticsDef vl_default_optics_def(void);

/** A lens, focused; constant once made; it must outlive the cameras that have it. */
typedef struct vlOptics vlOptics;
/** Focuses by moving the film, as pbrt does (thick lens approximation, book 5.4.3); finds the exit pupil. ARGUMENT: too
 * many or no surfaces, a number out of range, a lens that cannot focus so near or passes no light; MEMORY. */
VL_API vlResult vl_optics_create(vlContext *context, const vlOpticsDef *def, vlOptics **optics, vlError *error);
/** The same; surfaces from a text file, four numbers a line (radius, thickness, ior, aperture), # comments. def's
 * surfaces are not read. SCENE: what is no such file, with its place; MISSING, IO too. */
VL_API vlResult vl_optics_load(vlContext *context, const char *path, const vlOpticsDef *def, vlOptics **optics,
                               vlError *error);
/** The same lens focused elsewhere. */
VL_API vlResult vl_optics_refocus(vlContext *context, const vlOptics *optics, double focus_distance, vlOptics **result,
                                  vlError *error);
VL_API void vl_optics_destroy(vlOptics *optics);

typedef struct vlOpticsInfo {
  double focal_length;   /**< scene units, as all that follow */
  double film_distance;  /**< from the film to the last surface */
  double length;         /**< from the film to the first surface */
  double rear_principal; /**< from the film to the principal plane that angles are seen from */
  double focus_distance; /**< from the film */
  double film_diagonal;
  double f_number; /**< focal length over the diameter of the entrance pupil; 0 with an aperture image */
} vlOpticsInfo;
/** What it was made of: def and its surfaces (room for 64). */
VL_API void vl_optics_def(const vlOptics *optics, vlOpticsDef *def, vlLensSurface *surfaces);
VL_API void vl_optics_info(const vlOptics *optics, vlOpticsInfo *info);

/* ---- the lens of a camera --------------------------------------------------------------------------------------- */

/** Beside lens_radius and focus_distance of vlCameraDef. */
typedef struct vlLensDef {
  /** The lens's radius by its f-number: focal length / (2 f_number). The focal length in mm is focal_mm, or follows
   * from sensor_width_mm; unit_mm millimetres are a scene unit (default 1000). Unset: lens_radius says it. */
  double f_number, unit_mm;
  /** The plane in focus goes through this point of the world, or through what this pixel sees (vl_autofocus finds it;
   * vl_render does so where it was not done). Unset: focus_distance says it. */
  double focus_point[3], focus_pixel[2];
  uint32_t blades; /**< of a polygon inscribed in the opening's circle: 3 to 32; 0: round */
  double rotation; /**< radians, of blades or image, clockwise as seen from behind the camera; 0: a corner is up */
  double ratio;    /**< the opening's width is its height divided by this; anamorphic lenses 2; default 1 */
  const vlAperture *aperture; /**< image of the opening, null: none */
  /** The plane in focus turned out of the parallel, about its point on the axis: x > 0 leans its top away, y > 0 its
   * left side; radians. Or the lens turned (Scheimpflug): x > 0 down, y > 0 to the right; the plane in focus then goes
   * through the line f / sin(lens_tilt) below (right of) the lens; needs the focal length in mm. Perspective and
   * orthographic cameras only. */
  double tilt_x, tilt_y, lens_tilt_x, lens_tilt_y;
  bool vignetting; /**< natural: cos^4 of the angle from the axis, 1 on it; perspective only */
  /** Exposure by the camera's numbers instead of exposure_time: seconds ISO / (120 f_number^2), the reciprocal of the
   * luminance that just saturates a sensor (ISO 12232; Lagarde and de Rousiers 2014). seconds unset: the shutter's. */
  double iso, seconds;
  const vlOptics *optics; /**< VL_PROJECTION_OPTICS: the lens; else null */
} vlLensDef;

/** The same, made. */
typedef struct vlLens {
  uint32_t blades;
  double rotation, ratio;
  double tilt[2];        /**< tangents of the plane's slant */
  double hinge[2];       /**< 1 / where the plane in focus meets the lens's plane, by lens_tilt */
  double focus_pixel[2]; /**< unset: the focus distance is known */
  bool vignetting;
  const vlAperture *aperture;
  const vlOptics *optics;
} vlLens;

#ifdef __cplusplus
}
#endif
#endif
