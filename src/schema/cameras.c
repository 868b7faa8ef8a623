/* schema/cameras.c: the table of the projections' rows, each from the file of its kind
 * (projection/NAME.row.c); rows of the cameras in files: those of pbrt and calibrated
 * lenses. */
#include "base/text.h"
#include "distortion/distortion.row.h"
#include "projection/projection.row.h"
#include "velo/projection.h"

/* ---- projections ------------------------------------------------------------------------- */

#define VL_PROJECTION_ROW(kind, name, row) extern const vlProjectionRow row;
VL_PROJECTION_KINDS(VL_PROJECTION_ROW)
#undef VL_PROJECTION_ROW

/* Perspective cameras see 90 degrees along the smaller side; orthographic cameras see -1 to 1.
 * In both cases the focal length is half of that side in pixels. */
void vl_projection_half_side(const vlCameraDef *d, VL_UNUSED const vlCamera *camera,
                             double focal[2]) {
  focal[0] = focal[1] = 0.5 * (d->width < d->height ? d->width : d->height);
}

/* The plane's unit is a pixel. */
static void one_pixel(VL_UNUSED const vlCameraDef *d, VL_UNUSED const vlCamera *camera,
                      double focal[2]) {
  focal[0] = focal[1] = 1.0;
}

static const vlProjectionRow own_row = {
    .name = "own",
    .traits = VL_PROJECTION_STRETCHED | VL_PROJECTION_NO_FOV | VL_PROJECTION_NO_DISTORTION,
    .standard_focal = one_pixel,
};

#define ROW(kind, name, row) [kind] = &row,
static const vlProjectionRow *const projection_rows[] = {[VL_PROJECTION_OWN] = &own_row,
                                                         VL_PROJECTION_KINDS(ROW)};
#undef ROW

const vlProjectionRow *vl_projection_row(vlProjection kind) {
  return (uint32_t)kind < VL_LENGTH(projection_rows) ? projection_rows[kind] : NULL;
}

const char *vl_projection_name(vlProjection projection) {
  const vlProjectionRow *row = vl_projection_row(projection);
  return row ? row->name : "unknown";
}

/* ---- words of parameters ----------------------------------------------------------------- */

const char *const vl_camera_fov_axes[] = {"vertical", "horizontal", "diagonal",
                                          "smaller",  "larger",     NULL};
static const char *const mappings[] = {"equidistant", "equisolid", "stereographic",
                                       "orthographic", NULL};
static const char *const spherical_mappings[] = {"equalarea", "equirectangular", NULL};
const char *const vl_camera_stereo_modes[] = {"none",   "parallel",        "off-axis",
                                              "toe-in", "omnidirectional", NULL};
const char *const vl_camera_stereo_eyes[] = {"both", "left", "right", NULL};
const char *const vl_camera_shutter_curves[] = {"box", "triangle", "trapezoid", NULL};
const char *const vl_camera_readout_directions[] = {"down", "up", "right", "left", NULL};

/* ---- pbrt's cameras ---------------------------------------------------------------------- */

#define PBRT                                                                                  \
  WORD("frameaspectratio", DOUBLE, screen_min_x,                                              \
       "width of the screen window divided by its height; unset: that of the film",           \
       .unit = NULL),                                                                         \
      BLOCK("screenwindow", screen_min_x, "float",                                            \
            "screen window: x0, x1, y0, y1 of the image on the plane at distance 1, y up"),   \
      NUMBER("lensradius", lens_radius, "radius of the thin lens, scene units; 0: a pinhole", \
             VL_RANGE(0, 1e30)),                                                              \
      WORD("focaldistance", DOUBLE, focus_distance,                                           \
           "distance to the plane in focus, scene units", VL_DEFAULT(1e6)),                   \
      SHUTTER

static const vlParameter pbrt_perspective_parameters[] = {
    NUMBER("fov", fov, "field of view across the smaller side of the image",
           VL_DEFAULT(90 * DEGREES), ANGLE),
    PBRT};
static const vlKindRow pbrt_perspective_row = {
    VL_ROW_PARAMETERS(pbrt_perspective_parameters), .name = "perspective",
    .description = "pbrt's perspective camera: a pinhole or a thin lens"};

static const vlParameter pbrt_orthographic_parameters[] = {PBRT};
static const vlKindRow pbrt_orthographic_row = {VL_ROW_PARAMETERS(pbrt_orthographic_parameters),
                                                .name = "orthographic",
                                                .description = "orthographic projection"};

#define IGNORED(name) WORD(name, DOUBLE, fov, "ignored, as in pbrt", .unit = NULL)
static const vlParameter spherical_parameters[] = {
    WORD("mapping", CHOICE, projection, "map from directions to the image",
         .choices = spherical_mappings),
    SHUTTER,
    IGNORED("lensradius"),
    IGNORED("focaldistance"),
    IGNORED("frameaspectratio"),
    BLOCK("screenwindow", screen_min_x, "float", "ignored, as in pbrt"),
};
static const vlKindRow spherical_row = {
    VL_ROW_PARAMETERS(spherical_parameters), .name = "spherical",
    .description = "pbrt's camera that sees in all directions"};

static const vlParameter realistic_parameters[] = {
    WORD("lensfile", STRING, lens.optics,
         "required: a file with the table of the lens's surfaces", .text = NULL),
    WORD("aperturediameter", DOUBLE, lens.optics, "diameter of the aperture stop",
         VL_DEFAULT(1), .unit = "mm"),
    WORD("focusdistance", DOUBLE, lens.optics,
         "distance from the film to the plane in focus, scene units", VL_DEFAULT(10)),
    WORD("aperture", STRING, lens.optics,
         "shape of the aperture: circular, gaussian, square, pentagon, star or an image file",
         .text = NULL),
    SHUTTER,
};
static const vlKindRow realistic_row = {
    VL_ROW_PARAMETERS(realistic_parameters), .name = "realistic",
    .description = "a lens of many elements, simulated surface by surface"};

/* ---- velo's words ------------------------------------------------------------------------ */

static const vlParameter pinhole_parameters[] = {PINHOLE};
static const vlKindRow pinhole_row = {
    VL_ROW_PARAMETERS(pinhole_parameters), .name = "pinhole",
    .description = "a pinhole camera, posed by eye, lookat and up"};
static const vlParameter thin_lens_parameters[] = {PINHOLE, LENS};
static const vlKindRow thin_lens_row = {VL_ROW_PARAMETERS(thin_lens_parameters),
                                        .name = "thinlens",
                                        .description = "a perspective camera with a thin lens"};
static const vlParameter fisheye_parameters[] = {
    MODEL,
    WORD("mapping", CHOICE, projection,
         "map from the angle to the axis to the radius in the image", .choices = mappings)};
static const vlKindRow fisheye_row = {
    VL_ROW_PARAMETERS(fisheye_parameters), .name = "fisheye",
    .description = "a fisheye lens with one of four mappings"};
static const vlParameter opencv_parameters[] = {MODEL, COEFFICIENTS};
static const vlKindRow opencv_row = {
    VL_ROW_PARAMETERS(opencv_parameters), .name = "opencv",
    .description = "OpenCV's pinhole camera with lens distortion"};
static const vlParameter opencv_fisheye_parameters[] = {MODEL, COEFFICIENTS};
static const vlKindRow opencv_fisheye_row = {
    VL_ROW_PARAMETERS(opencv_fisheye_parameters), .name = "opencvfisheye",
    .description = "OpenCV's fisheye camera (Kannala and Brandt)"};
static const vlParameter colmap_parameters[] = {
    MODEL,
    WORD("model", STRING, projection, "name of the camera model in COLMAP", .text = "PINHOLE"),
    BLOCK("parameters", distortion_coefficients, "float",
          "parameters of the camera model, in COLMAP's order")};
static const vlKindRow colmap_row = {VL_ROW_PARAMETERS(colmap_parameters), .name = "colmap",
                                     .description = "one of COLMAP's camera models"};

/* ---- the settings of cameras, in calls and messages -------------------------------------- */

static const char *const projections[] = {
#define NAME(kind, name, row) #name,
    VL_PROJECTION_KINDS(NAME)
#undef NAME
        NULL};
#define SIDE(member, line) \
  PARAMETER(COUNT, NULL, member, line, VL_RANGE(1, 16777216), VL_DEFAULT(640), .unit = "pixels")
#define SCREEN(member, line) OPTIONAL(NULL, member, line, .unit = NULL)
static const vlParameter camera_settings_parameters[] = {
    PARAMETER(CHOICE, NULL, projection, "map from directions to the image",
              .choices = projections),
    SIDE(width, "width of the image"),
    SIDE(height, "height of the image"),
    SCREEN(screen_min_x, "left edge of the window at distance 1"),
    SCREEN(screen_max_x, "right edge of this window"),
    SCREEN(screen_min_y, "lower edge of this window"),
    SCREEN(screen_max_y, "upper edge of this window"),
    OPTIONAL(NULL, shape[0], "first parameter of the projection", .unit = NULL),
    OPTIONAL(NULL, shape[1], "second parameter of the projection", .unit = NULL),
    OPTIONAL(NULL, lens.focus_pixel[0], "column of the point in focus", .unit = "pixels"),
    OPTIONAL(NULL, lens.focus_pixel[1], "row of the point in focus", .unit = "pixels"),
    OPTIONAL(NULL, pose_times[0], "time of the first pose; unset: when the shutter opens",
             .unit = "s"),
    OPTIONAL(NULL, pose_times[1],
             "time of the second pose; unset: when the last row's shutter closes", .unit = "s"),
    PARAMETER(CHOICE, NULL, distortion, "model of the lens distortion",
              .choices = vl_distortion_names),
    MODEL};
const vlKindRow vl_camera_settings_row = {
    .name = "camera",
    .description = "a camera, in calls and in the messages of the page",
    .parameters = camera_settings_parameters,
    .parameter_count = VL_LENGTH(camera_settings_parameters)};

#define ROW_OF_PROJECTION(kind, name, row) [VL_CAMERA_OF_PROJECTION + kind] = &row.in_files,
#define CAMERA_ROWS(X)                                  \
  X(VL_CAMERA_PBRT_PERSPECTIVE, pbrt_perspective_row)   \
  X(VL_CAMERA_PBRT_ORTHOGRAPHIC, pbrt_orthographic_row) \
  X(VL_CAMERA_SPHERICAL, spherical_row)                 \
  X(VL_CAMERA_REALISTIC, realistic_row)                 \
  X(VL_CAMERA_PINHOLE, pinhole_row)                     \
  X(VL_CAMERA_THIN_LENS, thin_lens_row)                 \
  X(VL_CAMERA_FISHEYE, fisheye_row)                     \
  X(VL_CAMERA_OPENCV, opencv_row)                       \
  X(VL_CAMERA_OPENCV_FISHEYE, opencv_fisheye_row)       \
  X(VL_CAMERA_COLMAP, colmap_row)
_Static_assert(0 CAMERA_ROWS(VL_COUNT_KIND) == 0 VL_CAMERA_KINDS(VL_COUNT_KIND),
               "each camera has a row");
#define CAMERA_KINDS(X) VL_CAMERA_KINDS(X) VL_PROJECTION_KINDS(X)
const vlKindFamily vl_camera_family =
    VL_KIND_FAMILY(CAMERA_ROWS(VL_LIST_ROW) VL_PROJECTION_KINDS(ROW_OF_PROJECTION),
                   CAMERA_KINDS, "cameras", "camera", "Camera");
