/* camera_files/files.h: functions shared by the readers and writers of camera files. A JSON, YAML, XML or USD file
 * is first parsed into a tree (jansson's). A writer collects text, which is written as a whole. */
#ifndef CAMERA_FILES_FILES_H
#define CAMERA_FILES_FILES_H

#include <jansson.h>

#include "base/array.h"
#include "base/error.h"
#include "camera/parts.h"
#include "velo/camera_file.h"

/* The state of one read or write. */
typedef struct vlCameraFile {
  vlContext *context;
  const char *path, *dialect; /* name of the dialect, for messages */
  const vlCameraFileDef *def;
  vlError *error;
} vlCameraFile;

/* ---- reading ----------------------------------------------------------------------------------------------------- */

vlResult vl_camera_wrong(const vlCameraFile *file, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Like vl_camera_wrong, with a location. line 0: not known. */
vlResult vl_camera_wrong_at(const vlCameraFile *file, uint32_t line, uint32_t column, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
/* Parses JSON or YAML, distinguished by the first character. */
vlResult vl_camera_tree(const vlCameraFile *file, const char *text, size_t size, json_t **tree);
vlResult vl_camera_yaml(const vlCameraFile *file, const char *text, size_t size, json_t **tree);

/* Parses XML. Below the root (unless the root is wanted itself), only elements with the wanted tags are kept; null
 * ends the list. */
vlResult vl_camera_xml(const vlCameraFile *file, const char *text, size_t size, const char *const *wanted,
                       json_t **tree);

/* Parses USD's text form. */
vlResult vl_camera_usda(const vlCameraFile *file, const char *text, size_t size, json_t **tree);

/* Reads a required number. If it is missing, the error names the nearest key. */
vlResult vl_camera_field(const vlCameraFile *file, const json_t *object, const char *key, const json_t **value);
vlResult vl_camera_number(const vlCameraFile *file, const json_t *object, const char *key, double *value);
/* Reads an optional number; *value is unchanged if the key is missing. */
vlResult vl_camera_optional(const vlCameraFile *file, const json_t *object, const char *key, double *value);
/* Reads the width or height of an image. */
vlResult vl_camera_side(const vlCameraFile *file, const json_t *object, const char *key, uint32_t *value);
/* Sets the image's size if the file has none: the def's, or 720 rows with this aspect ratio (width / height). */
vlResult vl_camera_size(const vlCameraFile *file, double aspect, vlCameraRecord *record);
/* Reads least to most numbers from a list, a list of lists, or FileStorage's {rows, cols, data}. */
vlResult vl_camera_numbers(const vlCameraFile *file, const json_t *object, const char *key, double *values,
                           uint32_t least, uint32_t most, uint32_t *count);
/* Parses the next number of a text, after blanks and commas; *end is text if there is none. */
double vl_camera_parse(const char *text, char **end);
/* The string at key; null if it is missing or not a string. */
const char *vl_camera_text(const json_t *object, const char *key);
/* Whether the camera or pose with this index and name (may be null) is the requested one. */
bool vl_camera_is_frame(const vlCameraFile *file, uint32_t index, const char *name);
void vl_camera_name(vlCameraRecord *record, const char *name);

/* ---- writing ----------------------------------------------------------------------------------------------------- */

typedef struct vlCameraText {
  vlContext *context;
  VL_ARRAY(char) text;
  bool failed; /* out of memory */
} vlCameraText;

/* What a dialect can express besides fx, fy, cx, cy. */
enum {
  VL_HOLDS_POSE = 1,
  VL_HOLDS_SCALE = 2, /* a pose that scales or mirrors */
  VL_HOLDS_SKEW = 4,
  VL_HOLDS_LENS = 8,
  VL_HOLDS_PLANES = 16,
  VL_HOLDS_TIME = 32, /* shutter */
  VL_HOLDS_EXPOSURE = 64
};

void vl_camera_put(vlCameraText *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Appends all of another text. */
void vl_camera_put_text(vlCameraText *text, const vlCameraText *other);
/* Appends numbers as "1, 2, 3". */
void vl_camera_put_numbers(vlCameraText *text, const double *values, uint32_t count);
/* Appends a quoted string, for JSON and YAML. */
void vl_camera_put_string(vlCameraText *text, const char *string);
/* VL_OK if the field is absent or may be dropped, else an error that names it. */
vlResult vl_camera_refuse(const vlCameraFile *file, const char *field, bool present);
/* Whether the field is in the list of fields that may be dropped. */
bool vl_camera_drops(const vlCameraFile *file, const char *field);
/* Refuses everything that the bits `holds` do not allow; also makes *camera from the record. */
vlResult vl_camera_fit(const vlCameraFile *file, const vlCameraRecord *record, uint32_t holds, vlCamera *camera);
/* The error that the dialect has no such projection, or no such distortion of it. */
vlResult vl_camera_no_model(const vlCameraFile *file, const vlCameraDef *def);
/* The distortion as OpenCV's 14 coefficients, zeros after *count (0, 4, 5, 8, 12, 14). false: the model is not one
 * of OpenCV's. */
bool vl_camera_as_opencv(const vlCameraDef *def, double k[14], uint32_t *count);

/* ---- rotations: row-major 3 x 3 -------------------------------------------------------------------------------------
 */

void vl_rotation_from_vector(const double v[3], double r[9]);
void vl_rotation_to_vector(const double r[9], double v[3]);
/* From w x y z; false: the length is 0 or not finite. */
bool vl_rotation_from_quaternion(const double q[4], double r[9]);
void vl_rotation_to_quaternion(const double r[9], double q[4]);
/* Camera-from-world rotation and translation: stored in the def's pose, and read from a camera. */
void vl_camera_set_pose(vlCameraDef *def, const double r[9], const double t[3]);
void vl_camera_get_pose(const vlCamera *camera, double r[9], double t[3]);
/* Converts a world-from-camera matrix between axes x right, y up, z back and velo's: negates columns y and z. Its
 * own inverse. */
void vl_camera_flip_axes(const double m[16], double result[16]);
/* The same for other axes: columns x, y, z are multiplied by 1 or -1. */
void vl_camera_flip_columns(const double m[16], double x, double y, double z, double result[16]);

/* ---- dialects ---------------------------------------------------------------------------------------------------- */

typedef vlResult vlCameraReadTree(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record);
typedef vlResult vlCameraWriteText(const vlCameraFile *file, const vlCameraRecord *record, vlCameraText *text);
vlCameraReadTree vl_camera_read_velo, vl_camera_read_opencv, vl_camera_read_ros, vl_camera_read_nerf,
    vl_camera_read_kalibr, vl_camera_read_blender, vl_camera_read_gltf, vl_camera_read_matrices;
/* Reads from the file's text. */
typedef vlResult vlCameraReadText(const vlCameraFile *file, const char *text, size_t size, vlCameraRecord *record);
vlCameraReadText vl_camera_read_mitsuba, vl_camera_read_usd;
vlCameraWriteText vl_camera_write_velo, vl_camera_write_opencv, vl_camera_write_ros, vl_camera_write_nerf,
    vl_camera_write_kalibr, vl_camera_write_blender, vl_camera_write_pbrt, vl_camera_write_gltf,
    vl_camera_write_matrices, vl_camera_write_mitsuba, vl_camera_write_usd;
/* The camera as vl_camera_write_velo writes it, without the image of its aperture and the surfaces of its lens. */
void vl_camera_put_velo(const vlCameraRecord *record, vlCameraText *text);
vlResult vl_camera_read_colmap(const vlCameraFile *file, vlCameraRecord *record);
vlResult vl_camera_write_colmap(const vlCameraFile *file, const vlCameraRecord *record);

#endif
