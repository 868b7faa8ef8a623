/* camera/kinds.c: the rows of the projections. */
#include "camera/kinds.h"

#include "base/text.h"
#include "camera/parts.h"

static const double pi = 3.141592653589793;

/* ---- focal lengths where nothing is given
 * ------------------------------------------------------------------------ */

/* Perspective cameras see 90 degrees along the smaller side; orthographic cameras see -1 to 1.
 * In both cases the focal length is half of that side in pixels. */
static void half_side(const vlCameraDef *d, const vlCamera *camera, double focal[2]) {
  (void)camera;
  focal[0] = focal[1] = 0.5 * (d->width < d->height ? d->width : d->height);
}
/* The image shows the whole sphere, cylinder or cube. */
static void whole_sphere(const vlCameraDef *d, const vlCamera *camera, double focal[2]) {
  (void)camera;
  focal[0] = d->width / (2.0 * pi);
  focal[1] = d->height / pi;
}
static void whole_square(const vlCameraDef *d, const vlCamera *camera, double focal[2]) {
  (void)camera;
  focal[0] = 0.5 * d->width;
  focal[1] = 0.5 * d->height;
}
static void whole_cylinder(const vlCameraDef *d, const vlCamera *camera, double focal[2]) {
  (void)camera;
  focal[0] = focal[1] = d->width / (2.0 * pi);
}
static void whole_cube(const vlCameraDef *d, const vlCamera *camera, double focal[2]) {
  bool cross = camera->shape[0] > 0.0;
  focal[0] = d->width / (cross ? 4.0 : 6.0);
  focal[1] = d->height / (cross ? 3.0 : 1.0);
}

/* The plane's unit is a pixel. */
static void one_pixel(const vlCameraDef *d, const vlCamera *camera, double focal[2]) {
  (void)d;
  (void)camera;
  focal[0] = focal[1] = 1.0;
}

/* ---- the central pixel
 * -------------------------------------------------------------------------------------------
 */

static double cube_spread(const double shape[2]) {
  (void)shape;
  return 2.0;
}
static double equal_area_spread(const double shape[2]) {
  (void)shape;
  return 1.7724538509055159; /* 4 pi over an area of 4 */
}
static double fov_spread(const double shape[2]) {
  return shape[0] / shape[1];
}
static double unified_spread(const double shape[2]) {
  return 1.0 + shape[0];
}

/* ---- rows
 * --------------------------------------------------------------------------------------------------------
 */

#define FISHEYE VL_PROJECTION_FISHEYE | VL_PROJECTION_CIRCLE | VL_PROJECTION_RADIAL
#define CALIBRATED VL_PROJECTION_CALIBRATED | VL_PROJECTION_CIRCLE | VL_PROJECTION_RADIAL

VL_PROJECTION_ROW(PERSPECTIVE, perspective, .name = "perspective", .key = "perspective",
                  .traits = VL_PROJECTION_AHEAD | VL_PROJECTION_CIRCLE | VL_PROJECTION_RADIAL,
                  .standard_focal = half_side);
VL_PROJECTION_ROW(ORTHOGRAPHIC, orthographic, .name = "orthographic", .key = "orthographic",
                  .traits = VL_PROJECTION_AHEAD | VL_PROJECTION_RADIAL |
                            VL_PROJECTION_NO_DISTORTION,
                  .standard_focal = half_side);
VL_PROJECTION_ROW(EQUIDISTANT, equidistant, .name = "equidistant fisheye", .key = "equidistant",
                  .traits = FISHEYE, .limit = 3.141592653589793);
VL_PROJECTION_ROW(EQUISOLID, equisolid, .name = "equisolid fisheye", .key = "equisolid",
                  .traits = FISHEYE);
VL_PROJECTION_ROW(STEREOGRAPHIC, stereographic, .name = "stereographic fisheye",
                  .key = "stereographic", .traits = FISHEYE);
VL_PROJECTION_ROW(SINE, sine, .name = "orthographic fisheye", .key = "sine",
                  .traits = VL_PROJECTION_AHEAD | FISHEYE);
VL_PROJECTION_ROW(EQUIRECTANGULAR, equirectangular, .name = "equirectangular",
                  .key = "equirectangular",
                  .traits = VL_PROJECTION_STRETCHED | VL_PROJECTION_NO_DISTORTION,
                  .standard_focal = whole_sphere);
VL_PROJECTION_ROW(EQUAL_AREA, equal_area, .name = "equal-area", .key = "equal-area",
                  .traits = VL_PROJECTION_STRETCHED | VL_PROJECTION_NO_FOV |
                            VL_PROJECTION_NO_DISTORTION,
                  .spread = equal_area_spread, .standard_focal = whole_square);
VL_PROJECTION_ROW(CYLINDRICAL, cylindrical, .name = "cylindrical", .key = "cylindrical",
                  .standard_focal = whole_cylinder);
VL_PROJECTION_ROW(CUBE, cube, .name = "cube", .key = "cube",
                  .traits = VL_PROJECTION_STRETCHED | VL_PROJECTION_NO_FOV |
                            VL_PROJECTION_NO_DISTORTION,
                  .count = 1, .numbers = {{"layout", 0.0, 1.0, 0.0}}, .spread = cube_spread,
                  .standard_focal = whole_cube);
VL_PROJECTION_ROW(PANINI, panini, .name = "Panini", .key = "panini", .count = 1,
                  .numbers = {{"d", 0.0, 1e3, 1.0}});
VL_PROJECTION_ROW(FOV, fov, .name = "FOV", .key = "fov",
                  .traits = VL_PROJECTION_AHEAD | CALIBRATED, .count = 1,
                  .numbers = {{"w", 1e-6, 3.14, VL_UNSET}}, .spread = fov_spread);
VL_PROJECTION_ROW(DIVISION, division, .name = "division", .key = "division",
                  .traits = CALIBRATED, .count = 1,
                  .numbers = {{"lambda", -1e3, 1e3, VL_UNSET}});
VL_PROJECTION_ROW(UNIFIED, unified, .name = "unified", .key = "unified", .traits = CALIBRATED,
                  .count = 1, .numbers = {{"xi", 0.0, 1e3, VL_UNSET}},
                  .spread = unified_spread);
VL_PROJECTION_ROW(EUCM, eucm, .name = "EUCM", .key = "eucm", .traits = CALIBRATED, .count = 2,
                  .numbers = {{"alpha", 0.0, 1.0, VL_UNSET}, {"beta", 1e-6, 1e6, VL_UNSET}});
VL_PROJECTION_ROW(DOUBLE_SPHERE, double_sphere, .name = "double sphere", .key = "double-sphere",
                  .traits = CALIBRATED, .count = 2,
                  .numbers = {{"xi", -0.999, 0.999, VL_UNSET}, {"alpha", 0.0, 1.0, VL_UNSET}},
                  .spread = unified_spread);
VL_PROJECTION_ROW(OPTICS, optics, .name = "optics",
                  .traits = VL_PROJECTION_AHEAD | VL_PROJECTION_CIRCLE | VL_PROJECTION_RADIAL);

VL_PROJECTION_ROW(OWN, own, .name = "own",
                  .traits = VL_PROJECTION_STRETCHED | VL_PROJECTION_NO_FOV |
                            VL_PROJECTION_NO_DISTORTION,
                  .standard_focal = one_pixel);

#define ROW(NAME, name) [VL_PROJECTION_##NAME] = &vl_projection_##name,
static const vlProjectionRow *const rows[] = {VL_PROJECTION_KINDS(ROW) ROW(OWN, own)};

const vlProjectionRow *vl_projection_row(vlProjection kind) {
  return (uint32_t)kind < VL_LENGTH(rows) ? rows[kind] : NULL;
}

const char *vl_projection_name(vlProjection projection) {
  const vlProjectionRow *row = vl_projection_row(projection);
  return row ? row->name : "unknown";
}

bool vl_camera_sees_ahead(vlProjection kind) {
  return vl_projection_row(kind)->traits & VL_PROJECTION_AHEAD;
}
