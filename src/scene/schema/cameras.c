/* scene/schema/cameras.c: rows of the cameras in files: those of pbrt, calibrated lenses, and one per projection. */
#include "scene/schema/schema.h"
#include "velo/camera.h"

#define DEGREES 0.017453292519943295
#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlCameraDef, __VA_ARGS__)
#define NUMBER(name, member, ...) PARAMETER(DOUBLE, name, member, __VA_ARGS__)
#define OPTIONAL(name, member, ...) PARAMETER(DOUBLE, name, member, __VA_ARGS__, .flags = VL_PARAMETER_UNSET)
#define ANGLE .unit = "degrees", .factor = DEGREES
#define OPTIONAL_ANGLE(name, member, text) OPTIONAL(name, member, text, ANGLE)
#define BLOCK(name, member, type, line) PARAMETER(BLOCK, name, member, line, .text = type, .flags = VL_PARAMETER_RULE)
#define VECTOR(name, member, line, more, ...) \
  PARAMETER(DOUBLE3, name, member, line, VL_DEFAULT(__VA_ARGS__), .flags = more)
/* A name in files that sets members by a rule of the importer. */
#define WORD(file_name, TYPE, member_path, line, ...)                                                  \
  {                                                                                                    \
    .name = file_name, .type = VL_PARAMETER_##TYPE, .member = #member_path,                            \
    .offset = offsetof(vlCameraDef, member_path), .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND, \
    .description = line, __VA_ARGS__                                                                   \
  }
static const char *const axes[] = {"vertical", "horizontal", "diagonal", "smaller", "larger", NULL};
static const char *const mappings[] = {"equidistant", "equisolid", "stereographic", "orthographic", NULL};
static const char *const spherical_mappings[] = {"equalarea", "equirectangular", NULL};
static const char *const layouts[] = {"row", "cross", NULL};
static const char *const stereo_modes[] = {"none", "parallel", "off-axis", "toe-in", "omnidirectional", NULL};
static const char *const stereo_eyes[] = {"both", "left", "right", NULL};
static const char *const curves[] = {"box", "triangle", "trapezoid", NULL};
static const char *const directions[] = {"down", "up", "right", "left", NULL};

/* ---- pbrt's cameras ---------------------------------------------------------------------------------------------- */

#define SHUTTER                                                          \
  NUMBER("shutteropen", shutter_open, "the shutter opens", .unit = "s"), \
      NUMBER("shutterclose", shutter_close, "it closes", VL_DEFAULT(1), .unit = "s")
#define PBRT                                                                                                          \
  WORD("frameaspectratio", DOUBLE, screen_min_x, "width over height of the screen; unset: the film's", .unit = NULL), \
      BLOCK("screenwindow", screen_min_x, "float", "x0, x1, y0, y1 of the film on the screen at distance 1, y up"),   \
      NUMBER("lensradius", lens_radius, "of a thin lens, scene units; 0: a pinhole", VL_FROM(0)),                     \
      WORD("focaldistance", DOUBLE, focus_distance, "the plane in focus, scene units", VL_DEFAULT(1e6)), SHUTTER

static const vlParameter pbrt_perspective_parameters[] = {
    NUMBER("fov", fov, "across the film's smaller side", VL_DEFAULT(90 * DEGREES), ANGLE), PBRT};
VL_KIND_ROW(pbrt_perspective, .name = "perspective", .description = "pbrt's pinhole or thin lens")

static const vlParameter pbrt_orthographic_parameters[] = {PBRT};
VL_KIND_ROW(pbrt_orthographic, .name = "orthographic", .description = "parallel rays")

#define IGNORED(name) WORD(name, DOUBLE, fov, "ignored, as pbrt does", .unit = NULL)
static const vlParameter spherical_parameters[] = {
    WORD("mapping", CHOICE, projection, "the projection", .choices = spherical_mappings),
    SHUTTER,
    IGNORED("lensradius"),
    IGNORED("focaldistance"),
    IGNORED("frameaspectratio"),
    BLOCK("screenwindow", screen_min_x, "float", "ignored, as pbrt does"),
};
VL_KIND_ROW(spherical, .name = "spherical", .description = "pbrt's camera of the whole sphere")

static const vlParameter realistic_parameters[] = {
    WORD("lensfile", STRING, lens.optics, "required: a table of the lens's surfaces", .text = NULL),
    WORD("aperturediameter", DOUBLE, lens.optics, "of the stop", VL_DEFAULT(1), .unit = "mm"),
    WORD("focusdistance", DOUBLE, lens.optics, "the plane in focus from the film, scene units", VL_DEFAULT(10)),
    WORD("aperture", STRING, lens.optics, "circular, gaussian, square, pentagon, star or an image file", .text = NULL),
    SHUTTER,
};
VL_KIND_ROW(realistic, .name = "realistic", .description = "a lens of many elements")

/* ---- velo's words ------------------------------------------------------------------------------------------------ */

#define POSE                                                                                    \
  VECTOR("eye", eye, "position", 0, 0), VECTOR("lookat", lookat, "a point ahead", 0, 0, 0, -1), \
      VECTOR("up", up, "a direction that is up in the image", VL_PARAMETER_VECTOR, 0, 1, 0),    \
      NUMBER("roll", roll, "about the view direction, clockwise as seen from behind", ANGLE),   \
      VECTOR("eyeclose", eye_close, "eye when the shutter closes", VL_PARAMETER_UNSET, 0),      \
      VECTOR("lookatclose", lookat_close, "lookat then", VL_PARAMETER_UNSET, 0),                \
      VECTOR("upclose", up_close, "up then", VL_PARAMETER_UNSET | VL_PARAMETER_VECTOR, 0),      \
      OPTIONAL_ANGLE("rollclose", roll_close, "roll then")
#define INTRINSICS                                                                                                \
  OPTIONAL("d", view_distance, "view distance; focal length in pixels = zoom d / pixelsize", .unit = NULL),       \
      OPTIONAL("zoom", zoom, "see d; unset: 1", .unit = NULL),                                                    \
      OPTIONAL("pixelsize", pixel_size, "see d; unset: 1", .unit = NULL),                                         \
      OPTIONAL_ANGLE("fov", fov, "field of view along fovaxis"),                                                  \
      PARAMETER(CHOICE, "fovaxis", fov_axis, "what fov spans", .choices = axes, VL_DEFAULT(VL_FOV_SMALLER)),      \
      OPTIONAL("focallength", focal_mm, "focal length; with sensorwidth", .unit = "mm"),                          \
      OPTIONAL("sensorwidth", sensor_width_mm, "width of the sensor", .unit = "mm"),                              \
      OPTIONAL("fx", fx, "focal length", .unit = "pixels"), OPTIONAL("fy", fy, "focal length", .unit = "pixels"), \
      OPTIONAL("cx", cx, "principal point from the left; unset: the centre", .unit = "pixels"),                   \
      OPTIONAL("cy", cy, "principal point from the top; unset: the centre", .unit = "pixels"),                    \
      OPTIONAL("skew", skew, "of the pixel grid", .unit = "pixels")
#define TIME                                                                                                       \
  SHUTTER, WORD("shuttercurve", CHOICE, shutter_points, "how the shutter opens and closes", .choices = curves),    \
      WORD("shutterrise", DOUBLE, shutter_points, "share of the time in which a trapezoid rises", VL_DEFAULT(0.1), \
           VL_RANGE(0, 0.5)),                                                                                      \
      BLOCK("shutterpoints", shutter_at, "float", "2 to 16 pairs: share of the time, how far open"),               \
      NUMBER("readout", readout, "from the first row's exposure to the last's", .unit = "s"),                      \
      PARAMETER(CHOICE, "readoutdirection", readout_direction, "of the rolling shutter", .choices = directions)
#define STEREO                                                                                       \
  PARAMETER(CHOICE, "stereo", stereo.mode, "two eyes", .choices = stereo_modes),                     \
      PARAMETER(CHOICE, "stereoeye", stereo_eye, "which of them", .choices = stereo_eyes),           \
      NUMBER("interocular", stereo.interocular, "between the eyes, scene units", VL_DEFAULT(0.065)), \
      OPTIONAL("convergence", stereo.convergence, "depth where axes or windows meet, scene units", .unit = NULL)
#define FILM                                                                                  \
  NUMBER("exposuretime", exposure_time, "factor on the image", VL_DEFAULT(1)),                \
      NUMBER("near", near_plane, "nearest depth that is seen, scene units", .unit = NULL),    \
      NUMBER("far", far_plane, "farthest, scene units", VL_DEFAULT((double)__builtin_inff()), \
             .flags = VL_PARAMETER_INFINITE)
#define PINHOLE \
  POSE, INTRINSICS, TIME, STEREO, FILM, PARAMETER(BOOL, "vignetting", lens.vignetting, "darker towards the corners")
#define LENS                                                                                                \
  NUMBER("lensradius", lens_radius, "scene units; 0: a pinhole", VL_FROM(0)),                               \
      OPTIONAL("focusdistance", focus_distance, "the plane in focus, scene units; unset: infinity",         \
               .alias = "focaldistance"),                                                                   \
      OPTIONAL("fnumber", lens.f_number, "focal length over the lens's diameter, in place of lensradius",   \
               .unit = NULL),                                                                               \
      NUMBER("unitmm", lens.unit_mm, "a scene unit", VL_DEFAULT(1000), .unit = "mm"),                       \
      VECTOR("focuspoint", lens.focus_point, "a point of the world in focus", VL_PARAMETER_UNSET, 0),       \
      BLOCK("focuspixel", lens.focus_pixel, "float", "x, y: what this pixel sees is in focus"),             \
      PARAMETER(COUNT, "blades", lens.blades, "of the aperture; 0: round"),                                 \
      NUMBER("bladerotation", lens.rotation, "of the aperture", ANGLE),                                     \
      NUMBER("apertureratio", lens.ratio, "width over height of the aperture (anamorphic)", VL_DEFAULT(1)), \
      NUMBER("tiltx", lens.tilt_x, "of the plane in focus about x", ANGLE),                                 \
      NUMBER("tilty", lens.tilt_y, "about y", ANGLE),                                                       \
      NUMBER("lenstiltx", lens.lens_tilt_x, "of the lens about x (Scheimpflug)", ANGLE),                    \
      NUMBER("lenstilty", lens.lens_tilt_y, "about y", ANGLE),                                              \
      OPTIONAL("iso", lens.iso, "with fnumber and seconds: exposure as a camera has it", .unit = NULL),     \
      OPTIONAL("seconds", lens.seconds, "see iso", .unit = "s"),                                            \
      BLOCK("aperture", lens.aperture, "string", "circle, gaussian, square, pentagon, star or an image file")
#define MODEL PINHOLE, LENS, OPTIONAL_ANGLE("maxangle", max_angle, "the image circle's radius; unset: all there is")
#define COEFFICIENTS BLOCK("coefficients", distortion_coefficients, "float", "of the distortion, in OpenCV's order")
#define SHAPE(name, index, line, ...) OPTIONAL(name, shape[index], line, __VA_ARGS__)

static const vlParameter pinhole_parameters[] = {PINHOLE};
VL_KIND_ROW(pinhole, .name = "pinhole", .description = "the perspective, by eye, lookat and up")
static const vlParameter thin_lens_parameters[] = {PINHOLE, LENS};
VL_KIND_ROW(thin_lens, .name = "thinlens", .description = "the same with a lens")
static const vlParameter fisheye_parameters[] = {
    MODEL, WORD("mapping", CHOICE, projection, "from angle to radius", .choices = mappings)};
VL_KIND_ROW(fisheye, .name = "fisheye", .description = "four mappings from angle to radius")
static const vlParameter opencv_parameters[] = {MODEL, COEFFICIENTS};
VL_KIND_ROW(opencv, .name = "opencv", .description = "OpenCV's pinhole with distortion")
static const vlParameter opencv_fisheye_parameters[] = {MODEL, COEFFICIENTS};
VL_KIND_ROW(opencv_fisheye, .name = "opencvfisheye", .description = "OpenCV's fisheye (Kannala and Brandt)")
static const vlParameter colmap_parameters[] = {
    MODEL, WORD("model", STRING, projection, "COLMAP's name of the model", .text = "PINHOLE"),
    BLOCK("parameters", distortion_coefficients, "float", "of the model, in COLMAP's order")};
VL_KIND_ROW(colmap, .name = "colmap", .description = "a camera model of COLMAP's")

/* ---- one per projection; those without a name belong to a camera above ------------------------------------------- */

VL_KIND_ROW_EMPTY(perspective, .description = "the camera perspective, pinhole or opencv")
VL_KIND_ROW_EMPTY(orthographic, .description = "the camera orthographic")
VL_KIND_ROW_EMPTY(equidistant, .description = "the camera fisheye")
VL_KIND_ROW_EMPTY(equisolid, .description = "the camera fisheye")
VL_KIND_ROW_EMPTY(stereographic, .description = "the camera fisheye")
VL_KIND_ROW_EMPTY(sine, .description = "the camera fisheye")
VL_KIND_ROW_EMPTY(optics, .description = "the camera realistic")
static const vlParameter equirectangular_parameters[] = {
    MODEL, BLOCK("longitude", screen_min_x, "float", "limits, degrees; -180 180"),
    BLOCK("latitude", screen_min_y, "float", "limits, degrees; -90 90")};
VL_KIND_ROW(equirectangular, .name = "equirectangular", .description = "longitude and latitude")
static const vlParameter equal_area_parameters[] = {MODEL};
VL_KIND_ROW(equal_area, .name = "equalarea", .description = "the sphere in a square, octahedral")
static const vlParameter cylindrical_parameters[] = {MODEL};
VL_KIND_ROW(cylindrical, .name = "cylindrical", .description = "longitude and the latitude's tangent")
static const vlParameter cube_parameters[] = {MODEL,
                                              WORD("layout", CHOICE, shape[0], "of the faces", .choices = layouts)};
VL_KIND_ROW(cube, .name = "cube", .description = "six faces")
static const vlParameter panini_parameters[] = {
    MODEL, SHAPE("panini", 0, "d: how far behind the cylinder's axis; unset: 1", VL_RANGE(0, 1e3))};
VL_KIND_ROW(panini, .name = "panini", .description = "the general Panini projection")
static const vlParameter fov_parameters[] = {MODEL,
                                             SHAPE("omega", 0, "required", VL_RANGE(1e-6, 3.14), .unit = "radians")};
VL_KIND_ROW(fov, .name = "fov", .description = "the FOV model (Devernay and Faugeras)")
static const vlParameter division_parameters[] = {MODEL, SHAPE("lambda", 0, "required", VL_RANGE(-1e3, 1e3))};
VL_KIND_ROW(division, .name = "division", .description = "the division model (Fitzgibbon)")
static const vlParameter unified_parameters[] = {MODEL, COEFFICIENTS, SHAPE("xi", 0, "required", VL_RANGE(0, 1e3))};
VL_KIND_ROW(unified, .name = "unified", .description = "the unified model (Mei)")
static const vlParameter eucm_parameters[] = {MODEL, SHAPE("alpha", 0, "required", VL_RANGE(0, 1)),
                                              SHAPE("beta", 1, "required", VL_RANGE(1e-6, 1e6))};
VL_KIND_ROW(eucm, .name = "eucm", .description = "the enhanced unified model (Khomutenko)")
static const vlParameter double_sphere_parameters[] = {MODEL, SHAPE("xi", 0, "required", VL_RANGE(-0.999, 0.999)),
                                                       SHAPE("alpha", 1, "required", VL_RANGE(0, 1))};
VL_KIND_ROW(double_sphere, .name = "doublesphere", .description = "the double sphere model (Usenko)")

#define CAMERAS(X) VL_CAMERA_KINDS(X) VL_PROJECTION_KINDS(X)
#define ROW(NAME, name) &name##_row,
VL_KIND_FAMILY(vl_camera_family, CAMERAS, ROW, "cameras", "camera", "Camera")
