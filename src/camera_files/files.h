/* camera_files/files.h: functions shared by the readers and writers of camera files. A JSON,
 * YAML, XML or USD file is first parsed into a tree (jansson's). A writer collects text, which
 * is written as a whole. */
#ifndef CAMERA_FILES_FILES_H
#define CAMERA_FILES_FILES_H

#include <jansson.h>

#include "base/array.h"
#include "base/error.h"
#include "base/text.h"
#include "camera/parts.h"
#include "velo/camera_file.h"
#include "velo/setting.h"

/* The position of each value of a tree in the file, as line << 32 | column. A value precedes
 * the values that it contains. */
typedef struct vlCameraLocations {
  const json_t *root;
  VL_ARRAY(uint64_t) at;
} vlCameraLocations;

/* The state of one read or write. */
typedef struct vlCameraFile {
  vlContext *context;
  const char *path, *dialect; /* name of the dialect, for messages */
  const vlCameraFileDef *def;
  vlError *error;
  vlCameraLocations *locations; /* may be null; then errors have no line */
  /* number of the camera to read, which overrides the def; may be null */
  const uint32_t *ordinal;
  bool *looked; /* becomes true when the def's frame is looked for; may be null */
} vlCameraFile;

/* ---- reading ----------------------------------------------------------------------------- */

vlResult vl_camera_wrong(const vlCameraFile *file, const char *format, ...) VL_PRINTF(2, 3);
/* UNSUPPORTED: the message begins with the dialect's name and "cannot hold". */
vlResult vl_camera_cannot_hold(const vlCameraFile *file, const char *format, ...)
    VL_PRINTF(2, 3);
/* Like vl_camera_wrong, with a location. line is 0 if it is unknown. */
vlResult vl_camera_wrong_at(const vlCameraFile *file, uint32_t line, uint32_t column,
                            const char *format, ...) VL_PRINTF(4, 5);
/* Reports an error at object[key], or at the object itself if key is null or missing. */
vlResult vl_camera_wrong_in(const vlCameraFile *file, const json_t *object, const char *key,
                            const char *format, ...) VL_PRINTF(4, 5);
/* The line of object[key]; 0 if it is unknown. */
uint32_t vl_camera_line(const vlCameraFile *file, const json_t *object, const char *key);
/* Parses JSON, YAML or XML, which the first character tells apart. FileStorage's XML becomes a
 * tree of the same form as its YAML; other XML becomes the elements of vl_camera_xml. A list at
 * the top level is wrapped: {"[]": list}. If file->locations is set, the positions of the
 * values are recorded there. */
vlResult vl_camera_tree(const vlCameraFile *file, const char *text, size_t size, json_t **tree);
vlResult vl_camera_yaml(const vlCameraFile *file, const char *text, size_t size, json_t **tree);
vlResult vl_camera_storage(const vlCameraFile *file, const char *text, size_t size,
                           json_t **tree);
/* Records the position of the next value. Returns false if out of memory. */
bool vl_camera_push_location(const vlCameraFile *file, uint32_t line, uint32_t column);
/* Adds a position to an error that has none: the position of the first field that the message
 * quotes, or of the top-level value. */
void vl_camera_locate_error(const vlCameraFile *file);
void vl_camera_locations_free(vlCameraFile *file);

/* Parses XML. Below the root, only elements whose tags are in the list `wanted` are kept,
 * unless the list contains the root itself. Null ends the list. If the list is null, all
 * elements are kept with their text ("$"). */
vlResult vl_camera_xml(const vlCameraFile *file, const char *text, size_t size,
                       const char *const *wanted, json_t **tree);
/* Gets the tag of the root element, after declaration and comments. Returns false if the text
 * is not XML. */
bool vl_camera_xml_root(const char *text, char tag[64]);
/* Whether the element has this tag. */
bool vl_camera_has_tag(const json_t *element, const char *tag);
/* Returns the first child element with this tag, or null. */
const json_t *vl_camera_child(const json_t *element, const char *tag);
/* Reports an error at an element. */
vlResult vl_camera_wrong_element(const vlCameraFile *file, const json_t *element,
                                 const char *format, ...) VL_PRINTF(3, 4);
/* Reads exactly count finite numbers from an element's text. */
vlResult vl_camera_element_numbers(const vlCameraFile *file, const json_t *element,
                                   double *values, uint32_t count);
/* Reads one number from the child with this tag. If the child is missing, *value is unchanged,
 * and it is an error if the number is required. */
vlResult vl_camera_child_number(const vlCameraFile *file, const json_t *element,
                                const char *tag, bool needed, double *value);

/* Parses USD's text form. */
vlResult vl_camera_usda(const vlCameraFile *file, const char *text, size_t size, json_t **tree);

/* Reads a required number. If it is missing, the error names the nearest key. */
vlResult vl_camera_field(const vlCameraFile *file, const json_t *object, const char *key,
                         const json_t **value);
/* Reads a required text; *text is null if the field is something else. */
vlResult vl_camera_word(const vlCameraFile *file, const json_t *object, const char *key,
                        const char **text);
/* A value of the tree, for its row. */
vlGiven vl_json_given(const json_t *item);
vlResult vl_camera_number(const vlCameraFile *file, const json_t *object, const char *key,
                          double *value);
/* Reads an optional number; *value is unchanged if the key is missing. */
vlResult vl_camera_optional(const vlCameraFile *file, const json_t *object, const char *key,
                            double *value);
/* Reads the width or height of an image. */
vlResult vl_camera_side(const vlCameraFile *file, const json_t *object, const char *key,
                        uint32_t *value);
/* Sets the image's size if the file has none. It is the size of the def, or else 720 rows with
 * this aspect ratio (width / height). */
vlResult vl_camera_size(const vlCameraFile *file, double aspect, vlCameraRecord *record);
/* Sets the image's size for a file that has none. It is the size of the def, or else of the
 * first of the named images that exists. The names are relative to the file's folder, and null
 * ends the list. It is an error if there is neither. */
vlResult vl_camera_size_beside(const vlCameraFile *file, const char *const *images,
                               vlCameraRecord *record);
/* The same for the image whose name is the file's with another suffix. */
vlResult vl_camera_size_of_image(const vlCameraFile *file, vlCameraRecord *record);
/* Reads the image's size from two keys if both exist. Otherwise sets the size like
 * vl_camera_size_beside without images. */
vlResult vl_camera_sides(const vlCameraFile *file, const json_t *object, const char *width,
                         const char *height, vlCameraRecord *record);
/* Reads a list of two numbers, width and height. */
vlResult vl_camera_side_pair(const vlCameraFile *file, const json_t *object, const char *key,
                             vlCameraRecord *record);
/* The same if the key exists; otherwise like vl_camera_size_beside without images. */
vlResult vl_camera_size_pair(const vlCameraFile *file, const json_t *object, const char *key,
                             vlCameraRecord *record);
/* Reads between `min` and `max` numbers from a list, a list of lists, or FileStorage's
 * {rows, cols, data}. */
vlResult vl_camera_numbers(const vlCameraFile *file, const json_t *object, const char *key,
                           double *values, uint32_t min, uint32_t max, uint32_t *count);
/* The same of a value of the file, which messages call by the key. */
vlResult vl_camera_numbers_of(const vlCameraFile *file, const json_t *object, const char *key,
                              const json_t *field, double *values, uint32_t min, uint32_t max,
                              uint32_t *count);
/* The same for exactly `count` numbers. */
vlResult vl_camera_list(const vlCameraFile *file, const json_t *object, const char *key,
                        double *values, uint32_t count);
/* Parses the next number of a text, after blanks and commas. If there is no number, *end is
 * text. */
double vl_camera_parse(const char *text, char **end);
/* Parses the numbers of a text, `max` at most. Returns their count; max + 1: there are more,
 * one is not finite, or the text holds something else. */
uint32_t vl_camera_parse_all(const char *text, double *values, uint32_t max);
/* Returns the string at key, or null if it is missing or not a string. */
const char *vl_camera_text(const json_t *object, const char *key);
/* The row of a table with this name, which is the row's first member and may be null where it
 * is looked for. Returns null if there is none. */
const void *vl_camera_row(const void *rows, size_t count, size_t size, const char *name);
#define VL_CAMERA_ROW(rows, name) vl_camera_row(rows, VL_LENGTH(rows), sizeof *(rows), name)
/* Goes through the items of a list, or through the child elements of an element of XML. */
#define VL_EACH(item, list) \
  for (size_t vl_each = 0; ((item) = json_array_get(list, vl_each)) != NULL; vl_each++)
#define VL_EACH_CHILD(item, element) VL_EACH(item, json_object_get(element, "/"))
/* Returns whether the camera or pose with this index and name is the requested one. The name
 * may be null. */
bool vl_camera_is_frame(const vlCameraFile *file, uint32_t index, const char *name);
/* Counts a camera of the file in record->frames. Returns whether it is the requested one,
 * unless one was taken before. */
bool vl_camera_count(const vlCameraFile *file, bool taken, const char *name,
                     vlCameraRecord *record);
void vl_camera_name(vlCameraRecord *record, const char *name);
/* The camera that the caller asked for, as messages show it; `otherwise` if none was. */
vlArgumentText vl_camera_asked(const vlCameraFile *file, const char *otherwise);
/* Reports that the requested camera is not among the record->frames cameras of the file. what:
 * the format's word for one. */
vlResult vl_camera_no_frame(const vlCameraFile *file, const char *what,
                            const vlCameraRecord *record);
/* Sets fx, fy, cx, cy and skew from a matrix by rows, for which the centre of the first pixel
 * is (0, 0). It is an error at object[key] if the matrix is not fx skew cx, 0 fy cy, 0 0 1. */
vlResult vl_camera_set_k(const vlCameraFile *file, const json_t *object, const char *key,
                         const double k[9], vlCameraDef *def);

/* ---- writing ----------------------------------------------------------------------------- */

typedef struct vlCameraText {
  vlContext *context;
  VL_ARRAY(char) text;
  bool failed; /* out of memory */
} vlCameraText;

/* Flags: the properties that a dialect can express besides fx, fy, cx, cy. */
enum {
  VL_HOLDS_POSE = 1,
  VL_HOLDS_SCALE = 2, /* a pose that scales or mirrors */
  VL_HOLDS_SKEW = 4,
  VL_HOLDS_LENS = 8,
  VL_HOLDS_PLANES = 16,
  VL_HOLDS_TIME = 32, /* shutter */
  VL_HOLDS_EXPOSURE = 64,
  VL_HOLDS_MOTION = 128,
  VL_HOLDS_ALL = 256 /* every property; nothing is checked */
};

void vl_camera_put(vlCameraText *text, const char *format, ...) VL_PRINTF(2, 3);
void vl_camera_put_bytes(vlCameraText *text, const char *bytes, size_t count);
/* Writes a text as a whole file. */
vlResult vl_camera_write_text(const vlCameraFile *file, const char *path,
                              const vlCameraText *text);
/* Writes the text of a camera's file in the dialect of file->def, which must not be one of
 * folders. Errors: as of vl_camera_write. */
vlResult vl_camera_write_memory(const vlCameraFile *file, const vlCameraRecord *record,
                                vlCameraText *text);
/* Appends all of another text. */
void vl_camera_put_text(vlCameraText *text, const vlCameraText *other);
/* Appends a quoted string, for JSON and YAML. */
void vl_camera_put_string(vlCameraText *text, const char *string);
/* Returns VL_OK if the camera does not use the field or if it may be dropped. Otherwise returns
 * an error that names the field. */
vlResult vl_camera_refuse(const vlCameraFile *file, const char *field, bool present);
/* Returns VL_ERROR_ARGUMENT if def->drop has a name that no field has; the message has the
 * nearest one. */
vlResult vl_camera_check_drop(const vlCameraFileDef *def, vlError *error);
/* Returns whether the field is in the list of fields that may be dropped. */
bool vl_camera_drops(const vlCameraFile *file, const char *field);
/* The lens models that calibration tools name. */
typedef enum vlLensFamily {
  VL_LENS_PINHOLE,
  VL_LENS_OPENCV,  /* k has count coefficients */
  VL_LENS_FISHEYE, /* k1 to k4 */
  VL_LENS_FOV,     /* its only coefficient is shape[0] */
  VL_LENS_UNIFIED, /* shape[0], and OpenCV's distortion, whose count may be 0 */
  VL_LENS_EUCM,
  VL_LENS_DOUBLE_SPHERE,
  VL_LENS_OTHER
} vlLensFamily;
/* The lenses that a dialect can hold. */
typedef struct vlLensSet {
  uint32_t families; /* a bit for each (1 << VL_LENS_FOV) */
  uint32_t min;      /* $k of a form has at least so many coefficients */
  uint32_t max;      /* how many coefficients there may be */
  uint32_t terms;    /* only so many of OpenCV's may differ from 0; 0: any */
} vlLensSet;
enum {
  VL_LENSES_PINHOLE = 1 << VL_LENS_PINHOLE,
  VL_LENSES_OPENCV = VL_LENSES_PINHOLE | 1 << VL_LENS_OPENCV,
  VL_LENSES_COMMON = VL_LENSES_OPENCV | 1 << VL_LENS_FISHEYE /* those that most tools have */
};
struct vlCameraFormat;
/* A camera that its dialect can hold. */
typedef struct vlFittedCamera {
  const vlCameraFile *file;
  const struct vlCameraFormat *format;
  const vlCameraRecord *record;
  vlCamera camera;     /* of the record */
  vlLensFamily family; /* of the lens; k: its coefficients (vl_camera_lens_family) */
  double k[14];
  uint32_t count;
  bool sphere; /* the image is equirectangular or equal-area, and shows the whole sphere */
} vlFittedCamera;
/* Makes it from the record. Returns an error for what the dialect's row does not include. */
vlResult vl_camera_fit(const vlCameraFile *file, const vlCameraRecord *record,
                       const struct vlCameraFormat *format, vlFittedCamera *fit);
/* vl_camera_refuse for a principal point that is not the image's centre. */
vlResult vl_camera_refuse_off_centre(const vlCameraFile *file, const vlCamera *camera);
/* Reports that the dialect cannot express the def's projection, or the distortion of that
 * projection. */
vlResult vl_camera_no_model(const vlCameraFile *file, const vlCameraDef *def);
/* Converts the distortion to OpenCV's 14 coefficients. *count is 0, 4, 5, 8, 12 or 14; the
 * coefficients after it are 0. Returns false if the model is not one of OpenCV's. */
bool vl_camera_as_opencv(const vlCameraDef *def, double k[14], uint32_t *count);

/* ---- lenses ------------------------------------------------------------------------------ */

/* Sets fx, fy, cx, cy from values for which the centre of the first pixel is (0, 0). */
void vl_camera_set_centred(vlCameraDef *def, const double f[4]);
/* The same and the skew from the matrix fx skew cx, 0 fy cy, 0 0 1; false: it is none, or skew
 * is not allowed. */
bool vl_camera_set_intrinsics(vlCameraDef *def, const double k[9], bool skew);
/* Sets OpenCV's distortion. Zeros are appended up to the next number of coefficients that
 * OpenCV allows. */
void vl_camera_set_opencv(vlCameraDef *def, const double *k, uint32_t count);
/* The same with as few coefficients as the values need. */
void vl_camera_set_shortest(vlCameraDef *def, const double *k, uint32_t count);
/* Sets OpenCV's fisheye: k1 to k4. */
void vl_camera_set_fisheye(vlCameraDef *def, const double k[4]);
/* Whether these coefficients have no effect. */
bool vl_camera_all_zero(const double *k, uint32_t count);
/* Sets the lens of a family, with its coefficients; a pinhole leaves the def as it is. */
void vl_camera_set_lens(vlCameraDef *def, vlLensFamily family, const double *k, uint32_t count);
/* The family of a camera's lens, with its coefficients. */
vlLensFamily vl_camera_lens_family(const vlCameraDef *def, double k[14], uint32_t *count);

/* A degree in radians. */
#define VL_DEGREE (3.14159265358979323846 / 180.0)

/* ---- rotations: row-major 3 x 3 ---------------------------------------------------------- */

void vl_rotation_from_vector(const double v[3], double r[9]);
void vl_rotation_to_vector(const double r[9], double v[3]);
/* Converts a quaternion w x y z to a rotation. Returns false if its length is 0 or not
 * finite. */
bool vl_rotation_from_quaternion(const double q[4], double r[9]);
void vl_rotation_to_quaternion(const double r[9], double q[4]);
/* Both functions use camera-from-world rotation and translation. The first sets the def's pose;
 * the second reads the pose of a camera. */
void vl_camera_set_pose(vlCameraDef *def, const double r[9], const double t[3]);
void vl_camera_get_pose(const vlCamera *camera, double r[9], double t[3]);
/* Sets the pose from a row-major 4 x 4 matrix, world from camera or camera from world. Returns
 * false if the matrix is singular. */
bool vl_camera_set_matrix(vlCameraDef *def, const double m[16], bool from_world);
void vl_camera_set_origin(vlCameraDef *def);
/* Returns an error if the pose, given as a matrix, scales, shears or mirrors by more than the
 * rounding of numbers with two digits. */
vlResult vl_camera_check_rotation(const vlCameraFile *file, const vlCameraRecord *record);
/* How far the columns of the 3x3 part are from length 1 and right angles: the largest
 * difference of their products from those of a rotation's. */
double vl_rotation_error(const double m[12]);
/* Converts a world-from-camera matrix between the camera axes x right, y up, z back and velo's
 * axes, in either direction. It negates columns y and z. */
void vl_camera_flip_axes(const double m[16], double result[16]);
/* The same for other camera axes: multiplies columns x, y, z by the given factors, 1 or -1. */
void vl_camera_flip_columns(const double m[16], double x, double y, double z,
                            double result[16]);
/* Rows become columns. */
void vl_camera_transpose(const double m[16], double result[16]);

/* ---- dialects ---------------------------------------------------------------------------- */

typedef vlResult vlCameraReadTree(const vlCameraFile *file, const json_t *tree,
                                  vlCameraRecord *record);
/* A function that reads a camera from the file's text. */
typedef vlResult vlCameraReadText(const vlCameraFile *file, const char *text, size_t size,
                                  vlCameraRecord *record);
typedef vlResult vlCameraWriteText(const vlFittedCamera *fit, vlCameraText *text);
typedef vlResult vlCameraWriteFolder(const vlCameraFile *file, const vlCameraRecord *record);

/* A row of the table of dialects. Each row is defined at the end of the dialect's own file. */
typedef struct vlCameraFormat {
  const char *name;
  /* Return whether a tree (JSON, YAML, FileStorage's XML) or a text is in this dialect. They
   * look for content that no other dialect has. */
  bool (*is_tree)(const json_t *tree);
  /* In place of is_tree: the keys that the object has, all of them or one, with blanks between.
   * marks_in: the object is the value of this key or, if that is a list, its first item; null:
   * the tree. */
  const char *marks, *marks_in;
  bool one_mark;
  bool (*is_text)(const char *text, size_t size);
  vlCameraReadTree *read;
  vlCameraReadText *read_text;
  vlCameraWriteText *write;
  vlCameraWriteFolder *write_folder; /* in place of write: the path is that of a folder of
                                        files, or of one of them */
  const char *not_written;           /* why there is no writer */
  /* The names of all fields that the reader takes or that have no effect on the camera, with
   * blanks between. A name that ends in * stands for all that begin so; in the object of a name
   * that ends in /, names are those of cameras or images; the value of a name that ends in !
   * is not looked into; / alone: the file's own fields have such names where they are objects.
   * In XML they are the names of elements and attributes. Others are counted in
   * vlCameraRecord.unread. Null, and no `knows`: they are not looked for. */
  const char *known;
  const char *geometry;            /* names, as in `known`, that change the camera though the
                                      general ones (unread.c) do not say so: errors; may be null */
  bool (*knows)(const char *name); /* further names; may be null */
  char separator; /* of texts whose lines are NAME, this character, a value; 0: of no others */
  /* What the dialect can hold (vl_camera_fit). holds: VL_HOLDS_POSE, ... lenses: of no
   * families: the writer checks the lens. plain, in place of lenses: perspective and
   * orthographic cameras without distortion. spheres: also equirectangular and equal-area
   * images of the whole sphere. centred, square: the principal point must be the image's
   * centre; fx must be fy. */
  uint32_t holds;
  vlLensSet lenses;
  bool plain, spheres, centred, square;
  /* In place of write: a text for vl_camera_put_form (fields.h), with $k, the coefficients of
   * the lens, and $lens, its word. */
  const char *form;
  const char *lens_words[VL_LENS_OTHER]; /* by family */
  const char *unnamed;                   /* $name of a record without a name; null: "camera" */
  bool rotates; /* poses are rotations and translations: vl_camera_check_rotation */
} vlCameraFormat;

/* For files of which the camera is a part: counts what is not in the list of names (as
 * vlCameraFormat.known) of this object, or is an error (unread.c). */
vlResult vl_camera_check_part(const vlCameraFile *file, const char *known, const json_t *object,
                              vlCameraRecord *record);
/* The same for one name, such as that of a table's column. */
typedef struct {
  const char *name, *value;
  uint32_t line;
} vlCameraName;
vlResult vl_camera_check_name(const vlCameraFile *file, const char *known,
                              const vlCameraName *name, vlCameraRecord *record);

/* X(dialect, format) for each dialect, in the order in which they are tried on a parsed file
 * (JSON, YAML or XML): a dialect that is recognised by fields of its own comes before one that
 * is recognised by fields that several tools use. The last ones are recognised otherwise. */
#define VL_CAMERA_FORMATS(X)                                    \
  X(VL_CAMERA_DIALECT_REALITYCAPTURE, vl_format_realitycapture) \
  X(VL_CAMERA_DIALECT_ARIA, vl_format_aria)                     \
  X(VL_CAMERA_DIALECT_COLLADA, vl_format_collada)               \
  X(VL_CAMERA_DIALECT_NERFSTUDIO, vl_format_nerfstudio)         \
  X(VL_CAMERA_DIALECT_CALIBIO, vl_format_calibio)               \
  X(VL_CAMERA_DIALECT_DEPTHAI, vl_format_depthai)               \
  X(VL_CAMERA_DIALECT_KINECT, vl_format_kinect)                 \
  X(VL_CAMERA_DIALECT_PANOPTIC, vl_format_panoptic)             \
  X(VL_CAMERA_DIALECT_NUSCENES, vl_format_nuscenes)             \
  X(VL_CAMERA_DIALECT_NERFIES, vl_format_nerfies)               \
  X(VL_CAMERA_DIALECT_THREEJS, vl_format_threejs)               \
  X(VL_CAMERA_DIALECT_POLYCAM, vl_format_polycam)               \
  X(VL_CAMERA_DIALECT_RECORD3D, vl_format_record3d)             \
  X(VL_CAMERA_DIALECT_SCANNER3D, vl_format_scanner3d)           \
  X(VL_CAMERA_DIALECT_REALSENSE, vl_format_realsense)           \
  X(VL_CAMERA_DIALECT_OPENMVG, vl_format_openmvg)               \
  X(VL_CAMERA_DIALECT_METASHAPE, vl_format_metashape)           \
  X(VL_CAMERA_DIALECT_VISP, vl_format_visp)                     \
  X(VL_CAMERA_DIALECT_VELO, vl_format_velo)                     \
  X(VL_CAMERA_DIALECT_GLTF, vl_format_gltf)                     \
  X(VL_CAMERA_DIALECT_OPENGL, vl_format_opengl)                 \
  X(VL_CAMERA_DIALECT_VULKAN, vl_format_vulkan)                 \
  X(VL_CAMERA_DIALECT_D3D, vl_format_d3d)                       \
  X(VL_CAMERA_DIALECT_BASALT, vl_format_basalt)                 \
  X(VL_CAMERA_DIALECT_MESHROOM, vl_format_meshroom)             \
  X(VL_CAMERA_DIALECT_GAUSSIANS, vl_format_gaussians)           \
  X(VL_CAMERA_DIALECT_OPENSFM, vl_format_opensfm)               \
  X(VL_CAMERA_DIALECT_OPEN3D, vl_format_open3d)                 \
  X(VL_CAMERA_DIALECT_BOP, vl_format_bop)                       \
  X(VL_CAMERA_DIALECT_NERF, vl_format_nerf)                     \
  X(VL_CAMERA_DIALECT_CAMODOCAL, vl_format_camodocal)           \
  X(VL_CAMERA_DIALECT_ORBSLAM, vl_format_orbslam)               \
  X(VL_CAMERA_DIALECT_OKVIS, vl_format_okvis)                   \
  X(VL_CAMERA_DIALECT_SVO, vl_format_svo)                       \
  X(VL_CAMERA_DIALECT_EUROC, vl_format_euroc)                   \
  X(VL_CAMERA_DIALECT_KALIBR, vl_format_kalibr)                 \
  X(VL_CAMERA_DIALECT_ROS, vl_format_ros)                       \
  X(VL_CAMERA_DIALECT_BLENDER, vl_format_blender)               \
  X(VL_CAMERA_DIALECT_OPENCV, vl_format_opencv)                 \
  X(VL_CAMERA_DIALECT_COLMAP, vl_format_colmap)                 \
  X(VL_CAMERA_DIALECT_PBRT, vl_format_pbrt)                     \
  X(VL_CAMERA_DIALECT_MITSUBA, vl_format_mitsuba)               \
  X(VL_CAMERA_DIALECT_EXR, vl_format_exr)                       \
  X(VL_CAMERA_DIALECT_USD, vl_format_usd)                       \
  X(VL_CAMERA_DIALECT_KITTI, vl_format_kitti)                   \
  X(VL_CAMERA_DIALECT_MIDDLEBURY, vl_format_middlebury)         \
  X(VL_CAMERA_DIALECT_MVSNET, vl_format_mvsnet)                 \
  X(VL_CAMERA_DIALECT_BUNDLER, vl_format_bundler)               \
  X(VL_CAMERA_DIALECT_VISUALSFM, vl_format_visualsfm)           \
  X(VL_CAMERA_DIALECT_ZED, vl_format_zed)                       \
  X(VL_CAMERA_DIALECT_DSO, vl_format_dso)                       \
  X(VL_CAMERA_DIALECT_LLFF, vl_format_llff)                     \
  X(VL_CAMERA_DIALECT_MATRIX, vl_format_matrix)
#define VL_DECLARE_FORMAT(dialect, format) extern const vlCameraFormat format;
VL_CAMERA_FORMATS(VL_DECLARE_FORMAT)

/* The first returns whether an object has the key. The second returns whether the value at the
 * key has the second key; if that value is a list, its first item is tested. */
bool vl_camera_has(const json_t *object, const char *key);
bool vl_camera_has_in(const json_t *object, const char *key, const char *inner);

vlCameraReadTree vl_camera_read_velo, vl_camera_read_opencv, vl_camera_read_kalibr;
vlCameraWriteText vl_camera_write_velo;
/* Appends the camera in the form of vl_camera_write_velo, but without the aperture image and
 * the lens surfaces. */
void vl_camera_put_velo(const vlCameraRecord *record, vlCameraText *text);
vlResult vl_camera_read_colmap(const vlCameraFile *file, vlCameraRecord *record);

/* Receives each camera of a file. */
typedef struct vlCameraSink {
  vlResult (*add)(void *data, const vlCameraFile *file, const vlCameraRecord *record,
                  uint32_t index);
  void *data;
} vlCameraSink;
/* Reads all cameras of a file of any dialect except COLMAP's. */
vlResult vl_camera_read_each(const vlCameraFile *file, const vlCameraSink *sink);

#endif
