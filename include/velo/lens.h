/** @file
 * velo/lens.h: the lens of a camera: the shape of its aperture, its plane in focus, and lenses
 * of many elements. velo/camera.h includes it. */
#ifndef VELO_LENS_H
#define VELO_LENS_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- aperture images --------------------------------------------------------------------- */

/** An image of the aperture. It never changes. Any number of cameras may share it, and it must
 * outlive them. */
typedef struct vlAperture vlAperture;
/** Makes an aperture from width x height transmittances, rows from the top, 0: opaque. The
 * values are copied. The image covers the square from -1 to 1 around the aperture's unit
 * circle. It is upright: a point behind the plane in focus is blurred to this shape. ARGUMENT:
 * a side is above 4096, a value is negative or not finite, or all values are 0. */
VL_API vlResult vl_aperture_create(vlContext *context, uint32_t width, uint32_t height,
                                   const float *values, vlAperture **aperture, vlError *error);
/** Makes one of pbrt's apertures: "gaussian", "square", "pentagon", "star". ARGUMENT: another
 * name. */
VL_API vlResult vl_aperture_create_named(vlContext *context, const char *name,
                                         vlAperture **aperture, vlError *error);
/** Null is allowed. */
VL_API void vl_aperture_destroy(vlAperture *aperture);

/* ---- lenses of many elements ------------------------------------------------------------- */

/** A surface of a lens. radius: radius of curvature, positive if the centre is on the film's
 * side; 0 for the aperture stop. thickness: distance along the axis to the next surface. ior:
 * index of refraction of the material between this surface and the next one towards the film; 0
 * or 1: air. aperture: diameter of the surface. */
typedef struct vlLensSurface {
  double radius, thickness, ior, aperture; /**< lengths in mm; ior has no unit */
} vlLensSurface;

/** How to make a lens of many elements. */
typedef struct vlOpticsDef {
  uint32_t cookie;
  const vlLensSurface *surfaces; /**< at most 64, in order from the scene to the film; the last
                                    thickness is ignored; copied */
  uint32_t count;                /**< number of surfaces */
  double aperture_diameter; /**< diameter of the stop, mm; unset, or larger than in `surfaces`:
                               as in `surfaces` */
  double focus_distance; /**< distance from the film to the plane in focus, scene units; default
                            10 */
  double film_diagonal;  /**< diagonal of the film, mm; default 35 */
  double unit_mm;        /**< millimetres per scene unit; default 1000 */
  const vlAperture *aperture; /**< image of the stop's opening; null: a round opening */
} vlOpticsDef;
/** The default def, without surfaces. */
VL_API vlOpticsDef vl_default_optics_def(void);

/** A focused lens of many elements. Constant; it must outlive the cameras that use it. */
typedef struct vlOptics vlOptics;
/** Makes a lens: focuses it by moving the film, as pbrt does (thick lens approximation, book
 * 5.4.3), and finds its exit pupil. Errors: ARGUMENT (too many or no surfaces, a number out of
 * range, a lens that cannot focus at this distance or transmits no light), MEMORY. */
VL_API vlResult vl_optics_create(vlContext *context, const vlOpticsDef *def, vlOptics **optics,
                                 vlError *error);
/** As vl_optics_create, with the surfaces from a text file: four numbers per line (radius,
 * thickness, ior, aperture); # starts a comment. def's surfaces are ignored. Further errors:
 * SCENE (wrong contents, with the line), MISSING, IO. */
VL_API vlResult vl_optics_load(vlContext *context, const char *path, const vlOpticsDef *def,
                               vlOptics **optics, vlError *error);
/** Makes a copy of a lens that is focused at another distance from the film, in scene units.
 * Errors as vl_optics_create. */
VL_API vlResult vl_optics_refocus(vlContext *context, const vlOptics *optics,
                                  double focus_distance, vlOptics **result, vlError *error);
/** Null is allowed. */
VL_API void vl_optics_destroy(vlOptics *optics);

/** The properties of a lens; lengths in scene units. */
typedef struct vlOpticsInfo {
  double focal_length;   /**< focal length of the whole lens */
  double film_distance;  /**< from the film to the last surface */
  double length;         /**< from the film to the first surface */
  double rear_principal; /**< from the film to the rear principal plane, at which the camera's
                            field angles are measured */
  double focus_distance; /**< from the film to the plane in focus */
  double film_diagonal;  /**< diagonal of the film */
  /** focal length / diameter of the entrance pupil; 0 with an aperture image */
  double f_number;
} vlOpticsInfo;
/** Fills *def with the def that a lens was made from, and `surfaces`, an array of 64, with its
 * surfaces. */
VL_API void vl_optics_def(const vlOptics *optics, vlOpticsDef *def, vlLensSurface *surfaces);
/** Fills *info. */
VL_API void vl_optics_info(const vlOptics *optics, vlOpticsInfo *info);

/* ---- the lens of a camera ---------------------------------------------------------------- */

/** The description of a lens (vlCameraDef.lens). It adds to lens_radius and focus_distance of
 * vlCameraDef. */
typedef struct vlLensDef {
  /** f_number sets the lens radius: focal length / (2 f_number); unset: lens_radius is used.
   * The focal length in mm is focal_mm, or follows from sensor_width_mm. unit_mm is the number
   * of millimetres per scene unit (default 1000). */
  double f_number, unit_mm;
  /** The plane in focus contains this point in world space, or the surface seen at this film
   * point in pixels. vl_autofocus finds that surface; vl_render calls it if needed. Unset:
   * focus_distance is used. */
  double focus_point[3], focus_pixel[2];
  uint32_t blades; /**< number of corners, 3 to 32, if the aperture is a regular polygon
                      inscribed in the lens's circle; 0: round */
  double rotation; /**< rotation of blades or aperture image, radians, clockwise as seen from
                      behind the camera; 0: a corner is at the top */
  double ratio;    /**< the aperture's height divided by its width: 2 for typical anamorphic
                      lenses; default 1 */
  const vlAperture *aperture; /**< image of the aperture; null: none */
  /** tilt_x, tilt_y: rotation of the plane in focus about its point on the camera's axis,
   * radians. tilt_x > 0 moves the plane's top away from the camera, tilt_y > 0 its left side.
   * lens_tilt_x, lens_tilt_y: rotation of the lens (Scheimpflug principle), radians: x > 0
   * downwards, y > 0 to the right. The plane in focus then contains the line at the distance f
   * / sin(lens_tilt) below the lens (or to its right); this requires the focal length in mm.
   * Perspective and orthographic cameras only. */
  double tilt_x, tilt_y, lens_tilt_x, lens_tilt_y;
  bool vignetting; /**< natural vignetting: a factor cos^4 of the angle from the axis;
                      perspective cameras only */
  /** The exposure from the settings of a physical camera; it replaces exposure_time. The factor
   * is seconds ISO / (120 f_number^2), the reciprocal of the luminance that just saturates a
   * sensor (ISO 12232; Lagarde and de Rousiers 2014). seconds unset: the time that the shutter
   * is open. */
  double iso, seconds;
  const vlOptics *optics; /**< VL_PROJECTION_OPTICS: the lens; else null */
} vlLensDef;

/** A compiled lens, part of vlCamera. */
typedef struct vlLens {
  uint32_t blades;        /**< as in vlLensDef */
  double rotation, ratio; /**< as in vlLensDef */
  double tilt[2];         /**< slopes of the plane in focus along camera x and y */
  double hinge[2]; /**< with lens_tilt: 1 / distance between the axis and the line where the
                      plane in focus meets the lens plane */
  double focus_pixel[2]; /**< pixel to focus on, as in vlLensDef; unset: the focus distance is
                            known */
  bool vignetting;       /**< as in vlLensDef */
  const vlAperture *aperture; /**< not owned; may be null */
  const vlOptics *optics;     /**< not owned; may be null */
} vlLens;

#ifdef __cplusplus
}
#endif
#endif
