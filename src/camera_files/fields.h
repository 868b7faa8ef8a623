/* camera_files/fields.h: a dialect's table of fields: a row for each, read by one reader and
 * written by one writer. */
#ifndef CAMERA_FILES_FIELDS_H
#define CAMERA_FILES_FIELDS_H

#include "camera_files/files.h"

/* A field of a file and the variable that it is read into. */
typedef struct vlCameraField {
  const char *key;
  double *values;
  uint32_t count;  /* the field is a list of so many numbers; 0: it is a number */
  bool optional;   /* without the field the variable keeps its value */
  bool shorter;    /* a list may have fewer numbers */
  uint32_t *found; /* receives how many numbers an optional list has; may be null */
  uint32_t *side;  /* in place of values: a side of the image */
} vlCameraField;
#define VL_FIELD(name, pointer) \
  { .key = name, .values = pointer }
#define VL_FIELD_OPTIONAL(name, pointer) \
  { .key = name, .values = pointer, .optional = true }
#define VL_FIELD_LIST(name, pointer, length) \
  { .key = name, .values = pointer, .count = length }
#define VL_FIELD_LIST_OPTIONAL(name, pointer, max, number)                           \
  {                                                                                  \
    .key = name, .values = pointer, .count = max, .optional = true, .shorter = true, \
    .found = number                                                                  \
  }
#define VL_FIELD_LIST_IF_THERE(name, pointer, length) \
  { .key = name, .values = pointer, .count = length, .optional = true }
#define VL_FIELD_SIDE(name, pointer) \
  { .key = name, .side = pointer }

/* Reads the fields of an object in the order of the rows, up to the first error. The last row
 * has no key. */
vlResult vl_camera_read_fields(const vlCameraFile *file, const json_t *object,
                               const vlCameraField *rows);
#define VL_READ_FIELDS(file, object, ...) \
  vl_camera_read_fields(file, object, (const vlCameraField[]){__VA_ARGS__, {.key = NULL}})
/* The same for the child elements of an element of XML, which hold one number each. */
vlResult vl_camera_read_children(const vlCameraFile *file, const json_t *element,
                                 const vlCameraField *rows);
#define VL_READ_CHILDREN(file, element, ...) \
  vl_camera_read_children(file, element, (const vlCameraField[]){__VA_ARGS__, {.key = NULL}})
/* Reads the numbers with these names, up to the first null, into values: all required or all
 * optional. */
vlResult vl_camera_read_named(const vlCameraFile *file, const json_t *object,
                              const char *const *names, uint32_t count, bool optional,
                              double *values);
/* The names that most tools give to fx, fy, cx, cy. */
extern const char *const vl_camera_matrix_names[4];
/* The item of a list that the caller asked for by its number or by the text at name_key, which
 * may be null and becomes the record's name. Sets record->frames. Null: it is not there. */
const json_t *vl_camera_choose(const vlCameraFile *file, const json_t *list,
                               const char *name_key, vlCameraRecord *record);
/* A name that a dialect gives to a lens, and how many coefficients it may have. */
typedef struct vlLensName {
  const char *name; /* null ends a list */
  vlLensFamily family;
  uint32_t min, max;
} vlLensName;
/* Reads a lens: its name at name_key, which may be "none", and its coefficients at list_key.
 * The message about another name or number says that it is no known `what`; known: "there are
 * A, B". */
vlResult vl_camera_read_lens(const vlCameraFile *file, const json_t *object,
                             const char *name_key, const char *list_key,
                             const vlLensName *names, const char *what, const char *known,
                             vlCameraDef *def);
/* Counts a camera of the file. If it is the first that the caller asked for, by its number or
 * by this name, which may be null, *chosen becomes this camera, and the record gets the
 * name. */
void vl_camera_offer(const vlCameraFile *file, const json_t *camera, const char *name,
                     vlCameraRecord *record, const json_t **chosen);
/* Reports that the camera that the caller asked for is not in the list at object[key]. what:
 * the format's word for a camera. */
vlResult vl_camera_none_in(const vlCameraFile *file, const json_t *object, const char *key,
                           const char *what, const vlCameraRecord *record);
/* Whether a number is 1 to 16777216 whole pixels. */
bool vl_camera_is_side(double number);
/* Sets the image's size. Returns false if a side is none. */
bool vl_camera_set_sides(vlCameraDef *def, const double size[2]);
/* Reports an unknown word at object[key]. known: "there are A, B". */
vlResult vl_camera_unknown(const vlCameraFile *file, const json_t *object, const char *key,
                           const char *word, const char *known);
/* Sets the pose from the camera's rotation (world from camera) and its centre. */
void vl_camera_set_rigid(vlCameraDef *def, const double world_from_camera[9],
                         const double centre[3]);
/* Sets the pose from a rotation (camera from world) and the camera's centre. */
void vl_camera_set_centre(vlCameraDef *def, const double camera_from_world[9],
                          const double centre[3]);
/* Sets the pose from a matrix, world from camera, for the camera axes x right, y up, z back. */
void vl_camera_set_flipped(vlCameraDef *def, const double m[16]);

/* A value of a dialect's own for vl_camera_put_form. */
typedef struct vlCameraValue {
  const char *key;
  const double *values;
  uint32_t count;
  const char *word;         /* in place of values */
  const char *part;         /* in place of values: a form with the same keys */
  const char *const *names; /* of the values: part is written for each, with $item, $value */
} vlCameraValue;
#define VL_VALUES(name, pointer, length) \
  { .key = name, .values = pointer, .count = length }
#define VL_WORD(name, text) \
  { .key = name, .word = text }
/* A form for each value that has a name, up to the first null. */
#define VL_NAMED(name, item_names, pointer, length, form) \
  { .key = name, .names = item_names, .values = pointer, .count = length, .part = form }
/* A form that is left out unless it is present. */
#define VL_PART(name, present, form) \
  { .key = name, .part = (present) ? form : "" }
/* Appends a text in which $key stands for a value. Every dialect has
 *   $width $height, $fx $fy $skew $cx $cy, $cx0 $cy0 (from the centre of the first pixel),
 *     $near $far;
 *   $aspect: fy / fx; $ratio: width / height; $yfov: the vertical field of view, degrees;
 *   $name: the record's name, or "camera", in quotation marks;
 *   $K: fx skew cx0, 0 fy cy0, 0 0 1; $R $t: camera from world; $V: the rotation vector of R;
 *   $view: camera from world, 4 x 4; $pose: world from camera, 4 x 4; $flipped: $pose for axes
 *     x right, y up, z back;
 *   $viewcolumns $flippedcolumns: by columns; $axes $centre: the 3 x 3 part of $pose, and its
 *     last column.
 * $key@N is number N of a list, from 0. Lists are written as "1, 2, 3"; after :s as "1 2 3";
 * after :q with each number in quotation marks; after :1, :3 or :4 in brackets, so many at a
 * time; after :p in parentheses, four at a time. Returns VL_OK: text->failed says if memory is
 * lacking. */
vlResult vl_camera_put_form(vlCameraText *text, const vlFittedCamera *fit,
                            const vlCameraValue *own, const char *form);
#define VL_PUT_FORM(text, fit, form, ...) \
  vl_camera_put_form(text, fit, (const vlCameraValue[]){__VA_ARGS__, {.key = NULL}}, form)
/* The camera's name; `otherwise` if it has none or a character of `without`. */
const char *vl_camera_name_without(const vlFittedCamera *fit, const char *without,
                                   const char *otherwise);
/* Writes a camera by the form of its dialect's row. */
vlResult vl_camera_write_form(const vlCameraFormat *format, const vlFittedCamera *fit,
                              vlCameraText *text);

#endif
