/* projection/projection.row.h: for the files that hold rows of cameras and projections: macros
 * for parameters by type, and lists of the parameters that several cameras share. MODEL is the
 * list of all that velo's own cameras share. */
#ifndef PROJECTION_PROJECTION_ROW_H
#define PROJECTION_PROJECTION_ROW_H

#include "projection/properties.row.h"
#include "schema/schema.h"

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
#define WITHIN(min, max, name, member, ...) \
  PARAMETER(DOUBLE, name, member, __VA_ARGS__, VL_RANGE(min, max), .flags = VL_PARAMETER_UNSET)
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

extern const char *const vl_camera_fov_axes[];
extern const char *const vl_camera_stereo_modes[];
extern const char *const vl_camera_stereo_eyes[];
extern const char *const vl_camera_shutter_curves[];
extern const char *const vl_camera_readout_directions[];

/* Parameters that several kinds share. */
#define SHUTTER                                                                                \
  NUMBER("shutteropen", shutter_open, "time at which the shutter opens", .unit = "s"),         \
      NUMBER("shutterclose", shutter_close, "time at which the shutter closes", VL_DEFAULT(1), \
             .unit = "s")
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
                .choices = vl_camera_fov_axes, VL_DEFAULT(VL_FOV_SMALLER)),                    \
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
           .choices = vl_camera_shutter_curves),                                           \
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
                .choices = vl_camera_readout_directions)
#define STEREO                                                                            \
  PARAMETER(CHOICE, "stereo", stereo.mode,                                                \
            "arrangement of the two cameras (eyes) of a stereo pair",                     \
            .choices = vl_camera_stereo_modes, .keyword = "stereo_mode"),                 \
      PARAMETER(CHOICE, "stereoeye", stereo_eye, "which eyes are rendered",               \
                .choices = vl_camera_stereo_eyes),                                        \
      NUMBER("interocular", stereo.interocular, "distance between the eyes, scene units", \
             VL_DEFAULT(0.065), VL_RANGE(1e-9, 1e9)),                                     \
      WITHIN(1e-9, 1e12, "convergence", stereo.convergence,                               \
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
          "limit, or half of a fisheye's fov",                                            \
          ANGLE, VL_RANGE(0, PI), .flags = VL_PARAMETER_UNSET | VL_PARAMETER_ABOVE_LOW)
#define COEFFICIENTS                                      \
  BLOCK("coefficients", distortion_coefficients, "float", \
        "distortion coefficients, in OpenCV's order")

/* ---- projections ------------------------------------------------------------------------- */

/* The image shows -1 to 1 along its smaller side: for a perspective camera 90 degrees. */
void vl_projection_half_side(const vlCameraDef *def, const vlCamera *camera, double focal[2]);

#define FISHEYE VL_PROJECTION_FISHEYE | VL_PROJECTION_CIRCLE | VL_PROJECTION_RADIAL
#define CALIBRATED VL_PROJECTION_CALIBRATED | VL_PROJECTION_CIRCLE | VL_PROJECTION_RADIAL
/* A parameter of the projection: a number of vlCameraDef.shape. */
#define SHAPE(name, index, line, ...) OPTIONAL(name, shape[index], line, __VA_ARGS__)

#endif
