/* camera_files/velo.c: velo's own JSON: every parameter of the cameras' rows (velo/schema.h) by
 * the name of its member, exactly, in the unit of the def. Fields that have their defaults are
 * not written. Unknown fields are errors. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>

#include "base/text.h"
#include "camera_files/fields.h"
#include "distortion/distortion.row.h"
#include "projection/properties.row.h"
#include "schema/schema.h"
#include "velo/distortion.h"
#include "velo/projection.h"
#include "velo/setting.h"

/* By vlProjection; "" for those that the file cannot hold: a lens of many elements. */
enum { PROJECTIONS = 0 VL_PROJECTION_KINDS(VL_COUNT_KIND) };
static const char *projection_key(vlProjection kind) {
  const char *key = vl_projection_row(kind)->key;
  return key ? key : "";
}

/* ---- fields ------------------------------------------------------------------------------ */

typedef struct Field Field;
typedef void Put(vlCameraText *text, const Field *field, const vlCameraDef *def);
typedef vlResult Read(const vlCameraFile *file, const json_t *tree, const Field *field,
                      vlCameraDef *def);
static Put put_fov_axis, put_curve, put_shape, put_distortion, put_vector, put_pose;
static Read read_curve, read_shape, read_distortion, read_pose;

/* How the file holds a parameter. */
typedef enum Form { NOT_HELD, NUMBERS, COUNT, CHOICE, BOOL } Form;

/* A field of the file: a parameter of a row, or numbers that no row holds, or what a function
 * writes and reads. */
struct Field {
  const char *member;     /* of the row's parameter; null: no row holds it */
  const char *name;       /* in the file; null: the last word of member */
  size_t offset;          /* of numbers that no row holds */
  size_t given;           /* of the flag that says whether a matrix is given */
  uint32_t count;         /* how many; more than one is a list, in which null is unset */
  Put *put;               /* null: by type */
  Read *read;             /* null: by type */
  const vlParameter *row; /* found by member */
  Form form;              /* by the row's type; without a row: NUMBERS */
};
#define FIELD(path) \
  { .member = path }
#define FIELD_AS(path, file_name) \
  { .member = path, .name = file_name }
#define DOUBLES(file_name, path)                              \
  {                                                           \
    .name = file_name, .offset = offsetof(vlCameraDef, path), \
    .count = sizeof((vlCameraDef *)0)->path / sizeof(double)  \
  }
#define FIELD_BY(path, putter) \
  { .member = path, .put = putter }
#define RULE(file_name, putter, reader) \
  { .name = file_name, .put = putter, .read = reader }
#define POSE(file_name, matrix, flag)                                        \
  {                                                                          \
    .name = file_name, .offset = offsetof(vlCameraDef, matrix),              \
    .given = offsetof(vlCameraDef, flag), .put = put_pose, .read = read_pose \
  }

/* The fields in the order in which they are written. Parameters of the rows that are not here
 * follow by themselves. */
static const Field known_fields[] = {
    FIELD("fov"), FIELD("view_distance"), FIELD("zoom"), FIELD("pixel_size"), FIELD("focal_mm"),
    FIELD("sensor_width_mm"), FIELD("fx"), FIELD("fy"), FIELD("skew"), FIELD("cx"), FIELD("cy"),
    DOUBLES("screen_min_x", screen_min_x), DOUBLES("screen_max_x", screen_max_x),
    DOUBLES("screen_min_y", screen_min_y), DOUBLES("screen_max_y", screen_max_y), FIELD("roll"),
    FIELD("lens_radius"), FIELD("focus_distance"), FIELD("shutter_open"),
    FIELD("shutter_close"), FIELD("exposure_time"), FIELD("near_plane"), FIELD("far_plane"),
    FIELD("max_angle"),
    /* the lens */
    FIELD("lens.f_number"), FIELD("lens.unit_mm"), FIELD("lens.focus_point"),
    DOUBLES("focus_pixel", lens.focus_pixel), FIELD_AS("lens.rotation", "aperture_rotation"),
    FIELD_AS("lens.ratio", "aperture_ratio"), FIELD("lens.tilt_x"), FIELD("lens.tilt_y"),
    FIELD("lens.lens_tilt_x"), FIELD("lens.lens_tilt_y"), FIELD("lens.iso"),
    FIELD_AS("lens.seconds", "exposure_seconds"),
    /* time */
    FIELD("readout"), FIELD("eye_close"), FIELD("lookat_close"), FIELD("up_close"),
    FIELD("roll_close"), DOUBLES("pose_times", pose_times),
    /* stereo */
    FIELD("stereo.interocular"), FIELD("stereo.convergence"),
    /* not numbers, or not one by one */
    FIELD_BY("fov_axis", put_fov_axis), FIELD("lens.blades"), FIELD("lens.vignetting"),
    FIELD("readout_direction"), RULE("shutter_curve", put_curve, read_curve),
    FIELD_AS("stereo.mode", "stereo"), FIELD("stereo_eye"),
    RULE("shape", put_shape, read_shape), RULE("distortion", put_distortion, read_distortion),
    FIELD_BY("eye", put_vector), FIELD_BY("lookat", put_vector), FIELD_BY("up", put_vector),
    POSE("world_from_camera", world_from_camera, has_matrix),
    POSE("world_from_camera_close", world_from_camera_close, has_matrix_close)};

/* The numbers of a field in a def. */
static double *numbers_of(vlCameraDef *def, const Field *field) {
  return (double *)(void *)((char *)def + field->offset);
}
static const double *const_numbers_of(const vlCameraDef *def, const Field *field) {
  return (const double *)(const void *)((const char *)def + field->offset);
}

enum { MAX_FIELDS = 128 };
typedef struct {
  Field items[MAX_FIELDS];
  size_t count;
} Fields;

/* Functions write and read blocks and the list `shape`. */
static Form form_of(const vlParameter *p) {
  static const Form forms[] = {[VL_PARAMETER_BOOL] = BOOL,
                               [VL_PARAMETER_COUNT] = COUNT,
                               [VL_PARAMETER_CHOICE] = CHOICE,
                               [VL_PARAMETER_DOUBLE] = NUMBERS,
                               [VL_PARAMETER_DOUBLE3] = NUMBERS};
  const bool held = !(p->flags & VL_PARAMETER_SHORTHAND) &&
                    strncmp(p->member, "shape[", 6) != 0 && p->type < VL_LENGTH(forms);
  return held ? forms[p->type] : NOT_HELD;
}

static void add_parameter(Fields *fields, const vlParameter *p) {
  if (form_of(p) == NOT_HELD)
    return;
  VL_EACH_ITEM(Field, field, fields) {
    if (!vl_text_is(field->member, p->member))
      continue;
    if (!field->row)
      field->row = p;
    return;
  }
  if (fields->count < MAX_FIELDS)
    fields->items[fields->count++] = (Field){.member = p->member, .row = p};
}

/* The known fields, then those of the rows, from the last row on: the first rows are pbrt's
 * cameras, in which some parameters have other defaults. */
static void list_fields(Fields *fields) {
  const vlKindFamily *cameras = vl_kind_family_find("cameras");
  fields->count = VL_LENGTH(known_fields);
  memcpy(fields->items, known_fields, sizeof known_fields);
  for (uint32_t i = cameras->kind_count; i-- > 0;)
    for (uint32_t k = 0; k < cameras->rows[i]->parameter_count; k++)
      add_parameter(fields, &cameras->rows[i]->parameters[k]);
  VL_EACH_ITEM(Field, field, fields) {
    if (!field->name)
      field->name = vl_last_part(field->member);
    field->form = NUMBERS;
    if (!field->row)
      continue;
    field->form = form_of(field->row);
    field->offset = field->row->offset;
    field->count = field->row->type == VL_PARAMETER_DOUBLE3 ? 3 : 1;
  }
}

/* ---- reading ----------------------------------------------------------------------------- */

static vlResult check_names(const vlCameraFile *file, const json_t *tree,
                            const Fields *fields) {
  static const char *const others[] = {"velo_camera", "name",  "pixel_origin", "axes",
                                       "projection",  "width", "height"};
  enum { OTHERS = VL_LENGTH(others) };
  const char *known[MAX_FIELDS + OTHERS], *key;
  size_t count = 0;
  json_t *unused;
  for (size_t i = 0; i < fields->count; i++)
    known[count++] = fields->items[i].name;
  for (size_t i = 0; i < OTHERS; i++)
    known[count++] = others[i];
  json_object_foreach((json_t *)tree, key, unused) {
    if (vl_name_index(key, known, count) < count)
      continue;
    char message[VL_GIVEN_MESSAGE];
    vl_unknown_name("field", "", vl_short_text(key).text, known, count, message);
    return vl_camera_wrong(file, "velo: %s", message);
  }
  return VL_OK;
}

/* Index of a field's word in a list; *index is unchanged if the field is missing. */
static vlResult word(const vlCameraFile *file, const json_t *object, const char *key,
                     const char *const *names, uint32_t count, uint32_t *index) {
  if (!json_object_get(object, key))
    return VL_OK;
  const char *text = vl_camera_text(object, key);
  if (!text)
    return vl_camera_wrong(file, "velo: \"%s\" must be a word", key);
  const size_t found = vl_name_index(text, names, count);
  if (found < count) {
    *index = (uint32_t)found;
    return VL_OK;
  }
  char known[300];
  vl_tell_names(known, sizeof known, text, names, count);
  return vl_camera_wrong(file, "velo: unknown %s \"%s\"%s", key, vl_short_text(text).text,
                         known);
}

static vlResult read_distortion(const vlCameraFile *file, const json_t *tree,
                                const Field *field, vlCameraDef *d) {
  const json_t *lens = json_object_get(tree, field->name);
  uint32_t kind = 0;
  if (!lens)
    return VL_OK;
  if (!json_is_object(lens))
    return vl_camera_wrong(file, "velo: \"distortion\" must have a model and coefficients");
  const char *keys[VL_DISTORTION_KIND_COUNT];
  for (uint32_t i = 0; i < VL_DISTORTION_KIND_COUNT; i++)
    keys[i] = vl_distortion_row(i)->key;
  VL_TRY(word(file, lens, "model", keys, VL_DISTORTION_KIND_COUNT, &kind));
  d->distortion = (vlDistortion)kind;
  if (kind)
    VL_TRY(vl_camera_numbers(file, lens, "coefficients", d->distortion_coefficients, 1, 14,
                             &d->distortion_count));
  return VL_OK;
}

static vlResult read_shape(const vlCameraFile *file, const json_t *tree, const Field *field,
                           vlCameraDef *d) {
  uint32_t count = 0;
  return json_object_get(tree, field->name)
             ? vl_camera_numbers(file, tree, field->name, d->shape, 1, 2, &count)
             : VL_OK;
}

static vlResult read_curve(const vlCameraFile *file, const json_t *tree, const Field *field,
                           vlCameraDef *d) {
  uint32_t count = 0;
  double curve[2 * VL_SHUTTER_POINTS];
  if (!json_object_get(tree, field->name))
    return VL_OK;
  VL_TRY(vl_camera_numbers(file, tree, field->name, curve, 2, 2 * VL_SHUTTER_POINTS, &count));
  if (count % 2)
    return vl_camera_wrong(file, "velo: \"%s\" must be a list of pairs, time and value",
                           field->name);
  d->shutter_points = count / 2;
  for (uint32_t i = 0; i < d->shutter_points; i++) {
    d->shutter_at[i] = curve[2 * i];
    d->shutter_value[i] = curve[2 * i + 1];
  }
  return VL_OK;
}

static vlResult read_pose(const vlCameraFile *file, const json_t *tree, const Field *field,
                          vlCameraDef *d) {
  bool *given = (bool *)((char *)d + field->given);
  *given = vl_camera_has(tree, field->name);
  return *given ? vl_camera_list(file, tree, field->name, numbers_of(d, field), 16) : VL_OK;
}

/* Checks one value by the field's row, or a finite number where no row holds it; null is
 * unset. */
static vlResult read_item(const vlCameraFile *file, const json_t *item, const Field *field,
                          double *number) {
  static const vlParameter any = {.type = VL_PARAMETER_DOUBLE, .flags = VL_PARAMETER_UNSET};
  char name[80];
  char message[VL_GIVEN_MESSAGE];
  const vlGiven given = vl_json_given(item);
  snprintf(name, sizeof name, "velo: \"%s\"", field->name);
  if (vl_given_check(field->row ? field->row : &any, name, &given, number, message))
    return VL_OK;
  return vl_camera_wrong_in(file, item, NULL, "%s", message);
}

/* Reads one number, or a list with null for unset. */
static vlResult read_numbers(const vlCameraFile *file, const json_t *value, const Field *field,
                             double *values) {
  if (field->count == 1)
    return read_item(file, value, field, values);
  if (json_array_size(value) != field->count)
    return vl_camera_wrong_in(file, value, NULL, "velo: \"%s\" must be a list of %u numbers",
                              field->name, field->count);
  for (uint32_t i = 0; i < field->count; i++)
    VL_TRY(read_item(file, json_array_get(value, i), field, &values[i]));
  return VL_OK;
}

/* The def is unchanged if the field is missing. */
static vlResult read_field(const vlCameraFile *file, const json_t *tree, const Field *field,
                           vlCameraDef *def) {
  const json_t *value = json_object_get(tree, field->name);
  if (field->read)
    return field->read(file, tree, field, def);
  if (!value)
    return VL_OK;
  if (field->form == NUMBERS)
    return read_numbers(file, value, field, numbers_of(def, field));
  double number;
  VL_TRY(read_item(file, value, field, &number));
  vl_given_put(field->row, number, def);
  return VL_OK;
}

vlResult vl_camera_read_velo(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  static const char *const origins[] = {"corner", "center"};
  vlCameraDef *d = &record->camera;
  uint32_t projection = 0, origin = 0;
  const char *projections[PROJECTIONS];
  for (int i = 0; i < PROJECTIONS; i++)
    projections[i] = projection_key((vlProjection)i);
  Fields fields;
  list_fields(&fields);
  VL_TRY(check_names(file, tree, &fields));
  VL_TRY(VL_READ_FIELDS(file, tree, VL_FIELD_SIDE("width", &d->width),
                        VL_FIELD_SIDE("height", &d->height)));
  VL_TRY(word(file, tree, "projection", projections, PROJECTIONS, &projection));
  VL_TRY(word(file, tree, "pixel_origin", origins, 2, &origin));
  for (size_t i = 0; i < fields.count; i++)
    VL_TRY(read_field(file, tree, &fields.items[i], d));
  d->projection = (vlProjection)projection;
  if (origin) { /* unset values stay unset */
    d->cx += 0.5;
    d->cy += 0.5;
    d->lens.focus_pixel[0] += 0.5;
    d->lens.focus_pixel[1] += 0.5;
  }
  vl_camera_name(record, vl_camera_text(tree, "name"));
  return VL_OK;
}

/* ---- writing ----------------------------------------------------------------------------- */

static void put_fov_axis(vlCameraText *text, const Field *field, const vlCameraDef *d) {
  if (!vl_is_unset(d->fov))
    vl_camera_put(text, ",\n  \"%s\": \"%s\"", field->name, field->row->choices[d->fov_axis]);
}

static void put_curve(vlCameraText *text, const Field *field, const vlCameraDef *d) {
  if (d->shutter_points)
    vl_camera_put(text, ",\n  \"%s\": [", field->name);
  for (uint32_t i = 0; i < d->shutter_points; i++)
    vl_camera_put(text, "%s[%.17g, %.17g]", i ? ", " : "", d->shutter_at[i],
                  d->shutter_value[i]);
  if (d->shutter_points)
    vl_camera_put(text, "]");
}

/* Appends numbers in brackets; null: unset. */
static void put_list(vlCameraText *text, const double *values, uint32_t count) {
  for (uint32_t i = 0; i < count; i++) {
    vl_camera_put(text, i ? ", " : "[");
    vl_camera_put(text, vl_is_unset(values[i]) ? "null" : "%.17g", values[i]);
  }
  vl_camera_put(text, count ? "]" : "[]");
}

static void put_key(vlCameraText *text, const Field *field) {
  vl_camera_put(text, ",\n  \"%s\": ", field->name);
}

static void put_shape(vlCameraText *text, const Field *field, const vlCameraDef *d) {
  if (vl_is_unset(d->shape[0]))
    return;
  put_key(text, field);
  put_list(text, d->shape, vl_is_unset(d->shape[1]) ? 1 : 2);
}

static void put_distortion(vlCameraText *text, const Field *field, const vlCameraDef *d) {
  if (d->distortion == VL_DISTORTION_NONE)
    return;
  put_key(text, field);
  vl_camera_put(
      text, "{\"model\": \"%s\", \"coefficients\": ", vl_distortion_row(d->distortion)->key);
  put_list(text, d->distortion_coefficients, d->distortion_count);
  vl_camera_put(text, "}");
}

/* A vector of the pose, also where it is the default; not beside a matrix. */
static void put_vector(vlCameraText *text, const Field *field, const vlCameraDef *d) {
  if (d->has_matrix)
    return;
  put_key(text, field);
  put_list(text, const_numbers_of(d, field), 3);
}

static void put_pose(vlCameraText *text, const Field *field, const vlCameraDef *d) {
  const double *m = const_numbers_of(d, field);
  if (!*((const bool *)(const void *)((const char *)d + field->given)))
    return;
  put_key(text, field);
  for (int i = 0; i < 16; i += 4) {
    vl_camera_put(text, i ? ",\n    " : "[\n    ");
    put_list(text, m + i, 4);
  }
  vl_camera_put(text, "\n  ]");
}

static double default_of(const Field *field, const vlCameraDef *standard, uint32_t i) {
  if (!field->row)
    return const_numbers_of(standard, field)[i];
  return field->row->flags & VL_PARAMETER_UNSET ? VL_UNSET : field->row->value[i];
}

static void put_numbers(vlCameraText *text, const Field *field, const vlCameraDef *def,
                        const vlCameraDef *standard) {
  const double *values = const_numbers_of(def, field);
  bool differs = false;
  for (uint32_t i = 0; i < field->count; i++)
    differs = differs || (!vl_is_unset(values[i]) && !isinf(values[i]) &&
                          values[i] != default_of(field, standard, i));
  if (!differs)
    return;
  put_key(text, field);
  if (field->count > 1)
    put_list(text, values, field->count);
  else
    vl_camera_put(text, "%.17g", *values);
}

/* Writes a field if it differs from its default. */
static void put_field(vlCameraText *text, const Field *field, const vlCameraDef *def,
                      const vlCameraDef *standard) {
  double number;
  if (field->put) {
    field->put(text, field, def);
  } else if (field->form == NUMBERS) {
    put_numbers(text, field, def, standard);
  } else if (vl_parameter_number(field->row, def, &number) && number != field->row->value[0]) {
    put_key(text, field);
    if (field->form == COUNT)
      vl_camera_put(text, "%u", (uint32_t)number);
    else if (field->form == BOOL)
      vl_camera_put(text, "%s", number != 0.0 ? "true" : "false");
    else
      vl_camera_put(text, "\"%s\"", field->row->choices[(int)number]);
  }
}

void vl_camera_put_velo(const vlCameraRecord *record, vlCameraText *text) {
  const vlCameraDef *d = &record->camera;
  const vlCameraDef standard = vl_default_camera_def(1, 1);
  Fields fields;
  list_fields(&fields);
  vl_camera_put(text, "{\n  \"velo_camera\": 1,\n");
  if (record->name[0]) {
    vl_camera_put(text, "  \"name\": ");
    vl_camera_put_string(text, record->name);
    vl_camera_put(text, ",\n");
  }
  vl_camera_put(
      text, "  \"pixel_origin\": \"corner\",\n  \"axes\": \"x right, y down, z forward\",\n");
  const char *key = projection_key(d->projection);
  vl_camera_put(text, "  \"projection\": \"%s\",\n  \"width\": %u,\n  \"height\": %u",
                *key ? key : vl_projection_name(d->projection), d->width, d->height);
  for (size_t i = 0; i < fields.count; i++)
    put_field(text, &fields.items[i], d, &standard);
  vl_camera_put(text, "\n}\n");
}

vlResult vl_camera_write_velo(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCameraDef *d = &fit->record->camera;
  VL_TRY(vl_camera_refuse(fit->file, "aperture", d->lens.aperture != NULL));
  if (d->projection == VL_PROJECTION_OPTICS)
    return vl_camera_cannot_hold(fit->file, "a lens of many elements");
  vl_camera_put_velo(fit->record, text);
  return VL_OK;
}

const vlCameraFormat vl_format_velo = {.name = "velo",
                                       .marks = "velo_camera",
                                       .read = vl_camera_read_velo,
                                       .holds = VL_HOLDS_ALL,
                                       .write = vl_camera_write_velo};
