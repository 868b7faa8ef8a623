/* schema/cameras.c: rows of the cameras in files: those of pbrt, calibrated lenses, and one per
 * projection. */
#include "schema/schema.h"
#include "velo/camera.h"

#define DEGREES 0.017453292519943295
#define PI 3.14159265358979323846
#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlCameraDef, __VA_ARGS__)
#define NUMBER(name, member, ...) PARAMETER(DOUBLE, name, member, __VA_ARGS__)
#define OPTIONAL(name, member, ...) \
  PARAMETER(DOUBLE, name, member, __VA_ARGS__, .flags = VL_PARAMETER_UNSET)
#define ABOVE_0 VL_FROM(0), .flags = VL_PARAMETER_ABOVE_LOW
#define UNSET_OR_ABOVE_0 VL_FROM(0), .flags = VL_PARAMETER_UNSET | VL_PARAMETER_ABOVE_LOW
#define POSITIVE(name, member, ...) \
  PARAMETER(DOUBLE, name, member, __VA_ARGS__, UNSET_OR_ABOVE_0)
#define WITHIN(least, most, name, member, ...)                        \
  PARAMETER(DOUBLE, name, member, __VA_ARGS__, VL_RANGE(least, most), \
            .flags = VL_PARAMETER_UNSET)
#define ANGLE .unit = "degrees", .factor = DEGREES
#define TILT                            \
  ANGLE, VL_RANGE(-0.5 * PI, 0.5 * PI), \
      .flags = VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_BELOW_HIGH
#define OPTIONAL_ANGLE(name, member, text) OPTIONAL(name, member, text, ANGLE)
#define BLOCK(name, member, type, line) \
  PARAMETER(BLOCK, name, member, line, .text = type, .flags = VL_PARAMETER_RULE)
#define VECTOR(name, member, line, more, ...) \
  PARAMETER(DOUBLE3, name, member, line, VL_DEFAULT(__VA_ARGS__), .flags = more)
/* A name in files that sets members by a rule of the importer. */
#define WORD(file_name, TYPE, member_path, line, ...)                                     \
  {                                                                                       \
    .name = file_name, .type = VL_PARAMETER_##TYPE, .member = #member_path,               \
    .offset = offsetof(vlCameraDef, member_path),                                         \
    .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND, .description = line, __VA_ARGS__ \
  }
static const char *const axes[] = {"vertical", "horizontal", "diagonal",
                                   "smaller",  "larger",     NULL};
static const char *const mappings[] = {"equidistant", "equisolid", "stereographic",
                                       "orthographic", NULL};
static const char *const spherical_mappings[] = {"equalarea", "equirectangular", NULL};
static const char *const layouts[] = {"row", "cross", NULL};
static const char *const stereo_modes[] = {"none",   "parallel",        "off-axis",
                                           "toe-in", "omnidirectional", NULL};
static const char *const stereo_eyes[] = {"both", "left", "right", NULL};
static const char *const curves[] = {"box", "triangle", "trapezoid", NULL};
static const char *const directions[] = {"down", "up", "right", "left", NULL};

/* ---- pbrt's cameras
 * ----------------------------------------------------------------------------------------------
 */

#define SHUTTER                                                                                \
  NUMBER("shutteropen", shutter_open, "time at which the shutter opens", .unit = "s"),         \
      NUMBER("shutterclose", shutter_close, "time at which the shutter closes", VL_DEFAULT(1), \
             .unit = "s")
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
VL_KIND_ROW(pbrt_perspective, .name = "perspective",
            .description = "pbrt's perspective camera: a pinhole or a thin lens")

static const vlParameter pbrt_orthographic_parameters[] = {PBRT};
VL_KIND_ROW(pbrt_orthographic, .name = "orthographic", .description = "orthographic projection")

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
VL_KIND_ROW(spherical, .name = "spherical",
            .description = "pbrt's camera that sees in all directions")

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
VL_KIND_ROW(realistic, .name = "realistic",
            .description = "a lens of many elements, simulated surface by surface")

/* ---- velo's words
 * ------------------------------------------------------------------------------------------------
 */

#define POSE                                                                                   \
  VECTOR("eye", eye, "position of the camera", 0, 0),                                          \
      VECTOR("lookat", lookat, "a point on the view axis", 0, 0, 0, -1),                       \
      VECTOR("up", up, "the direction that points up in the image", VL_PARAMETER_VECTOR, 0, 1, \
             0),                                                                               \
      NUMBER("roll", roll,                                                                     \
             "rotation of the camera about the view axis, clockwise as seen from behind",      \
             ANGLE),                                                                           \
      VECTOR("eyeclose", eye_close,                                                            \
             "eye at the end of the camera's motion, when the shutter closes; unset: eye",     \
             VL_PARAMETER_UNSET, 0),                                                           \
      VECTOR("lookatclose", lookat_close, "lookat when the shutter closes; unset: lookat",     \
             VL_PARAMETER_UNSET, 0),                                                           \
      VECTOR("upclose", up_close, "up when the shutter closes; unset: up",                     \
             VL_PARAMETER_UNSET | VL_PARAMETER_VECTOR, 0),                                     \
      OPTIONAL_ANGLE("rollclose", roll_close, "roll when the shutter closes; unset: roll")
#define INTRINSICS                                                                             \
  POSITIVE("d", view_distance,                                                                 \
           "view distance; the focal length in pixels is zoom * d / pixelsize", .unit = NULL), \
      POSITIVE("zoom", zoom, "factor on d; unset: 1", .unit = NULL),                           \
      POSITIVE("pixelsize", pixel_size, "side of a pixel in the unit of d; unset: 1",          \
               .unit = NULL),                                                                  \
      OPTIONAL_ANGLE("fov", fov, "field of view along fovaxis"),                               \
      PARAMETER(CHOICE, "fovaxis", fov_axis, "the extent of the image that fov spans",         \
                .choices = axes, VL_DEFAULT(VL_FOV_SMALLER)),                                  \
      POSITIVE("focallength", focal_mm, "focal length; requires sensorwidth", .unit = "mm"),   \
      POSITIVE("sensorwidth", sensor_width_mm, "width of the sensor, for focallength",         \
               .unit = "mm"),                                                                  \
      POSITIVE("fx", fx, "horizontal focal length", .unit = "pixels"),                         \
      POSITIVE("fy", fy, "vertical focal length", .unit = "pixels"),                           \
      OPTIONAL("cx", cx,                                                                       \
               "column of the principal point from the image's left edge; unset: the centre",  \
               .unit = "pixels"),                                                              \
      OPTIONAL("cy", cy,                                                                       \
               "row of the principal point from the image's top edge; unset: the centre",      \
               .unit = "pixels"),                                                              \
      OPTIONAL("skew", skew, "skew coefficient of the camera matrix", .unit = "pixels")
#define TIME                                                                               \
  SHUTTER,                                                                                 \
      WORD("shuttercurve", CHOICE, shutter_points,                                         \
           "shape of the shutter curve: how far the shutter is open over time",            \
           .choices = curves),                                                             \
      WORD("shutterrise", DOUBLE, shutter_points,                                          \
           "trapezoid: fraction of the shutter's time in which it opens", VL_DEFAULT(0.1), \
           VL_RANGE(0, 0.5)),                                                              \
      BLOCK("shutterpoints", shutter_at, "float",                                          \
            "shutter curve, 2 to 16 pairs: fraction of the shutter's time, and opening"),  \
      NUMBER("readout", readout,                                                           \
             "rolling shutter: time from the first row's exposure to the last one's",      \
             .unit = "s", VL_FROM(0)),                                                     \
      PARAMETER(CHOICE, "readoutdirection", readout_direction,                             \
                "direction in which the rolling shutter reads the sensor",                 \
                .choices = directions)
#define STEREO                                                                                 \
  PARAMETER(CHOICE, "stereo", stereo.mode,                                                     \
            "arrangement of the two cameras (eyes) of a stereo pair", .choices = stereo_modes, \
            .keyword = "stereo_mode"),                                                         \
      PARAMETER(CHOICE, "stereoeye", stereo_eye, "which eyes are rendered",                    \
                .choices = stereo_eyes),                                                       \
      NUMBER("interocular", stereo.interocular, "distance between the eyes, scene units",      \
             VL_DEFAULT(0.065), VL_RANGE(1e-9, 1e9)),                                          \
      WITHIN(1e-9, 1e12, "convergence", stereo.convergence,                                    \
             "depth where the eyes' axes or image windows meet, scene units", .unit = NULL)
#define FILM                                                                                   \
  NUMBER("exposuretime", exposure_time, "exposure: factor on the image's values",              \
         VL_DEFAULT(1), ABOVE_0),                                                              \
      NUMBER("near", near_plane, "depth of the near clipping plane, scene units", VL_FROM(0)), \
      NUMBER("far", far_plane, "depth of the far clipping plane, scene units",                 \
             VL_DEFAULT((double)__builtin_inff()), VL_FROM(0),                                 \
             .flags = VL_PARAMETER_INFINITE | VL_PARAMETER_ABOVE_LOW)
#define PINHOLE                                      \
  POSE, INTRINSICS, TIME, STEREO, FILM,              \
      PARAMETER(BOOL, "vignetting", lens.vignetting, \
                "natural vignetting: the image darkens with cos^4 of the angle from the axis")
#define LENS                                                                                   \
  NUMBER("lensradius", lens_radius, "radius of the lens, scene units; 0: a pinhole",           \
         VL_RANGE(0, 1e30)),                                                                   \
      PARAMETER(DOUBLE, "focusdistance", focus_distance,                                       \
                "distance to the plane in focus, scene units; unset: infinity",                \
                .alias = "focaldistance", VL_FROM(0),                                          \
                .flags = VL_PARAMETER_UNSET | VL_PARAMETER_INFINITE | VL_PARAMETER_ABOVE_LOW), \
      WITHIN(1e-6, 1e6, "fnumber", lens.f_number,                                              \
             "f-number: focal length divided by the lens's diameter; replaces lensradius",     \
             .unit = NULL),                                                                    \
      NUMBER("unitmm", lens.unit_mm, "length of one scene unit", VL_DEFAULT(1000),             \
             .unit = "mm", VL_RANGE(1e-12, 1e12)),                                             \
      VECTOR("focuspoint", lens.focus_point,                                                   \
             "a world-space point that the plane in focus contains", VL_PARAMETER_UNSET, 0),   \
      BLOCK("focuspixel", lens.focus_pixel, "float",                                           \
            "x, y of a pixel: the surface that it shows is in focus"),                         \
      PARAMETER(COUNT, "blades", lens.blades,                                                  \
                "number of corners of a polygonal aperture, from 3; 0: round",                 \
                VL_RANGE(0, 32)),                                                              \
      NUMBER("bladerotation", lens.rotation, "rotation of the aperture", ANGLE),               \
      NUMBER("apertureratio", lens.ratio,                                                      \
             "height of the aperture divided by its width; 2 for typical anamorphic lenses",   \
             VL_DEFAULT(1), ABOVE_0),                                                          \
      NUMBER("tiltx", lens.tilt_x, "tilt of the plane in focus about the camera's x axis",     \
             TILT),                                                                            \
      NUMBER("tilty", lens.tilt_y, "tilt of the plane in focus about the camera's y axis",     \
             TILT),                                                                            \
      NUMBER("lenstiltx", lens.lens_tilt_x,                                                    \
             "tilt of the lens about the camera's x axis (Scheimpflug principle)", TILT),      \
      NUMBER("lenstilty", lens.lens_tilt_y, "tilt of the lens about the camera's y axis",      \
             TILT),                                                                            \
      WITHIN(1e-6, 1e12, "iso", lens.iso,                                                      \
             "sensitivity: the exposure is seconds * iso / (120 fnumber^2)", .unit = NULL),    \
      WITHIN(1e-12, 1e12, "seconds", lens.seconds,                                             \
             "exposure time for iso; unset: the shutter's time", .unit = "s"),                 \
      BLOCK(                                                                                   \
          "aperture", lens.aperture, "string",                                                 \
          "shape of the aperture: circle, gaussian, square, pentagon, star or an image file")
#define MODEL                                                                             \
  PINHOLE, LENS,                                                                          \
      PARAMETER(                                                                          \
          DOUBLE, "maxangle", max_angle,                                                  \
          "angle from the axis to the edge of the image circle; unset: the projection's " \
          "limit, or half of a "                                                          \
          "fisheye's fov",                                                                \
          ANGLE, VL_RANGE(0, PI), .flags = VL_PARAMETER_UNSET | VL_PARAMETER_ABOVE_LOW)
#define COEFFICIENTS                                      \
  BLOCK("coefficients", distortion_coefficients, "float", \
        "distortion coefficients, in OpenCV's order")
#define SHAPE(name, index, line, ...) OPTIONAL(name, shape[index], line, __VA_ARGS__)

static const vlParameter pinhole_parameters[] = {PINHOLE};
VL_KIND_ROW(pinhole, .name = "pinhole",
            .description = "a pinhole camera, posed by eye, lookat and up")
static const vlParameter thin_lens_parameters[] = {PINHOLE, LENS};
VL_KIND_ROW(thin_lens, .name = "thinlens",
            .description = "a perspective camera with a thin lens")
static const vlParameter fisheye_parameters[] = {
    MODEL,
    WORD("mapping", CHOICE, projection,
         "map from the angle to the axis to the radius in the image", .choices = mappings)};
VL_KIND_ROW(fisheye, .name = "fisheye",
            .description = "a fisheye lens with one of four mappings")
static const vlParameter opencv_parameters[] = {MODEL, COEFFICIENTS};
VL_KIND_ROW(opencv, .name = "opencv",
            .description = "OpenCV's pinhole camera with lens distortion")
static const vlParameter opencv_fisheye_parameters[] = {MODEL, COEFFICIENTS};
VL_KIND_ROW(opencv_fisheye, .name = "opencvfisheye",
            .description = "OpenCV's fisheye camera (Kannala and Brandt)")
static const vlParameter colmap_parameters[] = {
    MODEL,
    WORD("model", STRING, projection, "name of the camera model in COLMAP", .text = "PINHOLE"),
    BLOCK("parameters", distortion_coefficients, "float",
          "parameters of the camera model, in COLMAP's order")};
VL_KIND_ROW(colmap, .name = "colmap", .description = "one of COLMAP's camera models")

/* ---- one per projection; those without a name belong to a camera above
 * ------------------------------------------- */

VL_KIND_ROW_EMPTY(perspective, .description = "the camera perspective, pinhole or opencv")
VL_KIND_ROW_EMPTY(orthographic, .description = "the camera orthographic")
VL_KIND_ROW_EMPTY(equidistant, .description = "the camera fisheye")
VL_KIND_ROW_EMPTY(equisolid, .description = "the camera fisheye")
VL_KIND_ROW_EMPTY(stereographic, .description = "the camera fisheye")
VL_KIND_ROW_EMPTY(sine, .description = "the camera fisheye")
VL_KIND_ROW_EMPTY(optics, .description = "the camera realistic")
static const vlParameter equirectangular_parameters[] = {
    MODEL,
    BLOCK("longitude", screen_min_x, "float",
          "smallest and largest longitude in the image, degrees; unset: -180 180"),
    BLOCK("latitude", screen_min_y, "float",
          "smallest and largest latitude in the image, degrees; unset: -90 90")};
VL_KIND_ROW(equirectangular, .name = "equirectangular",
            .description = "panorama: x is the longitude, y the latitude")
static const vlParameter equal_area_parameters[] = {MODEL};
VL_KIND_ROW(equal_area, .name = "equalarea",
            .description = "panorama: equal-area octahedral map of the sphere to a square")
static const vlParameter cylindrical_parameters[] = {MODEL};
VL_KIND_ROW(cylindrical, .name = "cylindrical",
            .description = "panorama: x is the longitude, y the tangent of the latitude")
static const vlParameter cube_parameters[] = {
    MODEL,
    WORD("layout", CHOICE, shape[0], "arrangement of the six faces", .choices = layouts)};
VL_KIND_ROW(cube, .name = "cube", .description = "panorama: the six faces of a cube")
static const vlParameter panini_parameters[] = {
    MODEL, SHAPE("panini", 0,
                 "d: distance of the projection centre from the cylinder's axis; unset: 1",
                 VL_RANGE(0, 1e3))};
VL_KIND_ROW(panini, .name = "panini", .description = "the general Panini projection")
static const vlParameter fov_parameters[] = {
    MODEL, SHAPE("omega", 0, "required: the model's field-of-view parameter",
                 VL_RANGE(1e-6, 3.14), .unit = "radians")};
VL_KIND_ROW(fov, .name = "fov", .description = "the FOV model (Devernay and Faugeras)")
static const vlParameter division_parameters[] = {
    MODEL,
    SHAPE("lambda", 0, "required: the model's distortion parameter", VL_RANGE(-1e3, 1e3))};
VL_KIND_ROW(division, .name = "division", .description = "the division model (Fitzgibbon)")
static const vlParameter unified_parameters[] = {
    MODEL, COEFFICIENTS,
    SHAPE("xi", 0, "required: the model's mirror parameter", VL_RANGE(0, 1e3))};
VL_KIND_ROW(unified, .name = "unified", .description = "the unified model (Mei)")
static const vlParameter eucm_parameters[] = {
    MODEL, SHAPE("alpha", 0, "required: the model's parameter alpha", VL_RANGE(0, 1)),
    SHAPE("beta", 1, "required: the model's parameter beta", VL_RANGE(1e-6, 1e6))};
VL_KIND_ROW(eucm, .name = "eucm", .description = "the enhanced unified model (Khomutenko)")
static const vlParameter double_sphere_parameters[] = {
    MODEL, SHAPE("xi", 0, "required: the model's parameter xi", VL_RANGE(-0.999, 0.999)),
    SHAPE("alpha", 1, "required: the model's parameter alpha", VL_RANGE(0, 1))};
VL_KIND_ROW(double_sphere, .name = "doublesphere",
            .description = "the double sphere model (Usenko)")

/* ---- the settings of cameras, in calls and messages
 * ---------------------------------------------------------------
 */

static const char *const projections[] = {
#define NAME(NAME, name) #name,
    VL_PROJECTION_KINDS(NAME)
#undef NAME
        NULL};
static const char *const distortions[] = {"none", "opencv", "radial", "thin_prism", NULL};
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
    PARAMETER(CHOICE, NULL, distortion, "model of the lens distortion", .choices = distortions),
    MODEL};
const vlKindRow vl_camera_settings_row = {
    .name = "camera",
    .description = "a camera, in calls and in the messages of the page",
    .parameters = camera_settings_parameters,
    .parameter_count = sizeof camera_settings_parameters / sizeof *camera_settings_parameters};

#define CAMERAS(X) VL_CAMERA_KINDS(X) VL_PROJECTION_KINDS(X)
#define ROW(NAME, name) &name##_row,
VL_KIND_FAMILY(vl_camera_family, CAMERAS, ROW, "cameras", "camera", "Camera")
