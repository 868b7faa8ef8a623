/* camera_files/fields.c: see fields.h. */
#include "camera_files/fields.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/double3.h"
#include "math/elementary.h"

/* ---- reading ----------------------------------------------------------------------------- */

const char *const vl_camera_matrix_names[4] = {"fx", "fy", "cx", "cy"};

/* Reads one row: a side of the image, a number, or a list. */
static vlResult read_field(const vlCameraFile *file, const json_t *object,
                           const vlCameraField *row) {
  if (row->side)
    return vl_camera_side(file, object, row->key, row->side);
  if (row->optional && !vl_camera_has(object, row->key))
    return VL_OK;
  if (!row->count)
    return vl_camera_number(file, object, row->key, row->values);
  return vl_camera_numbers(file, object, row->key, row->values, row->shorter ? 0 : row->count,
                           row->count, row->found);
}

vlResult vl_camera_read_fields(const vlCameraFile *file, const json_t *object,
                               const vlCameraField *rows) {
  for (; rows->key; rows++)
    VL_TRY(read_field(file, object, rows));
  return VL_OK;
}

vlResult vl_camera_read_children(const vlCameraFile *file, const json_t *element,
                                 const vlCameraField *rows) {
  for (; rows->key; rows++)
    VL_TRY(vl_camera_child_number(file, element, rows->key, !rows->optional, rows->values));
  return VL_OK;
}

vlResult vl_camera_read_named(const vlCameraFile *file, const json_t *object,
                              const char *const *names, uint32_t count, bool optional,
                              double *values) {
  for (uint32_t i = 0; i < count && names[i]; i++)
    VL_TRY(read_field(
        file, object,
        &(vlCameraField){.key = names[i], .values = &values[i], .optional = optional}));
  return VL_OK;
}

void vl_camera_offer(const vlCameraFile *file, const json_t *camera, const char *name,
                     vlCameraRecord *record, const json_t **chosen) {
  if (vl_camera_count(file, *chosen, name, record)) {
    *chosen = camera;
    vl_camera_name(record, name);
  }
}

const json_t *vl_camera_choose(const vlCameraFile *file, const json_t *list,
                               const char *name_key, vlCameraRecord *record) {
  const json_t *item, *chosen = NULL;
  record->frames = 0;
  VL_EACH(item, list)
    vl_camera_offer(file, item, name_key ? vl_camera_text(item, name_key) : NULL, record,
                    &chosen);
  return chosen;
}

vlResult vl_camera_none_in(const vlCameraFile *file, const json_t *object, const char *key,
                           const char *what, const vlCameraRecord *record) {
  return vl_camera_wrong_in(file, object, key, "%s: there is no %s \"%s\" among the %u",
                            file->dialect, what, vl_camera_asked(file, "0").text,
                            record->frames);
}

vlResult vl_camera_read_lens(const vlCameraFile *file, const json_t *object,
                             const char *name_key, const char *list_key,
                             const vlLensName *names, const char *what, const char *known,
                             vlCameraDef *def) {
  const char *name = vl_camera_text(object, name_key);
  const bool perspective = def->projection == VL_PROJECTION_PERSPECTIVE;
  double k[14] = {0.0};
  uint32_t n = 0, min = names->min, max = names->max;
  if (vl_text_is(name, "none"))
    return VL_OK;
  for (const vlLensName *lens = names; lens->name; lens++) {
    min = lens->min < min ? lens->min : min;
    max = lens->max > max ? lens->max : max;
  }
  VL_TRY(vl_camera_numbers(file, object, list_key, k, min, max, &n));
  for (; names->name; names++) {
    if (!vl_text_is(name, names->name) || n < names->min || n > names->max)
      continue;
    if (!perspective && names->family != VL_LENS_OPENCV)
      continue;
    vl_camera_set_lens(def, names->family, k, n);
    return VL_OK;
  }
  return vl_camera_wrong_in(file, object, name_key,
                            "%s: unknown %s \"%s\" of %u coefficients; %s", file->dialect, what,
                            vl_short_text(name).text, n, known);
}

bool vl_camera_is_side(double number) {
  return number >= 1.0 && number <= 1 << 24 && number == floor(number);
}

bool vl_camera_set_sides(vlCameraDef *def, const double size[2]) {
  for (int i = 0; i < 2; i++)
    if (!vl_camera_is_side(size[i]))
      return false;
  def->width = (uint32_t)size[0];
  def->height = (uint32_t)size[1];
  return true;
}

vlResult vl_camera_unknown(const vlCameraFile *file, const json_t *object, const char *key,
                           const char *word, const char *known) {
  return vl_camera_wrong_in(file, object, key, "%s: unknown %s \"%s\"; %s", file->dialect, key,
                            vl_short_text(word).text, known);
}

void vl_camera_set_rigid(vlCameraDef *def, const double world_from_camera[9],
                         const double centre[3]) {
  double m[16] = {[15] = 1.0};
  for (int i = 0; i < 12; i++)
    m[i] = i % 4 < 3 ? world_from_camera[3 * (i / 4) + i % 4] : centre[i / 4];
  vl_camera_set_matrix(def, m, false);
}

void vl_camera_set_centre(vlCameraDef *def, const double r[9], const double centre[3]) {
  double t[3];
  for (int i = 0; i < 3; i++)
    t[i] = 0.0 - vl_dot3(r + 3 * i, centre);
  vl_camera_set_pose(def, r, t);
}

void vl_camera_set_flipped(vlCameraDef *def, const double m[16]) {
  def->has_matrix = true;
  vl_camera_flip_axes(m, def->world_from_camera);
}

/* ---- writing ----------------------------------------------------------------------------- */

/* The values that every form can name, computed from the camera; fields.h says what they are.
 */
typedef struct {
  double sides[2], k[9], offset[2];
  double aspect, ratio, yfov;
  double r[9], t[3], v[3];
  double flipped[16], flipped_columns[16], view_columns[16];
  double axes[9], centre[3];
} Values;

static Values values_of(const vlCamera *c) {
  const double *m = c->world_from_camera;
  Values v = {.sides = {c->width, c->height},
              .k = {c->fx, c->skew, c->cx - 0.5, 0, c->fy, c->cy - 0.5, 0, 0, 1},
              .offset = {c->cx - 0.5, c->cy - 0.5},
              .aspect = c->fy / c->fx,
              .ratio = (double)c->width / c->height,
              .yfov = 2.0 / VL_DEGREE * vl_precise_atan(0.5 * c->height / c->fy)};
  vl_camera_get_pose(c, v.r, v.t);
  vl_rotation_to_vector(v.r, v.v);
  vl_camera_flip_axes(m, v.flipped);
  vl_camera_transpose(v.flipped, v.flipped_columns);
  vl_camera_transpose(c->camera_from_world, v.view_columns);
  vl_split_map(m, v.axes, v.centre);
  return v;
}

/* layout: the letter of vl_camera_put_form (fields.h); 0: separated by commas. */
static void put_list(vlCameraText *text, const double *values, uint32_t count, char layout) {
  const bool round = layout == 'p';
  const bool square = isdigit((unsigned char)layout);
  const char *open = round ? "(" : square ? "[" : "";
  const char *close = round ? ")" : square ? "]" : "";
  const char *mark = layout == 'q' ? "\"" : "";
  const char *separator = layout == 's' ? " " : ", ";
  const uint32_t group = square ? (uint32_t)(layout - '0') : 4; /* numbers in brackets */
  for (uint32_t i = 0; i < count; i++) {
    const double value = values[i] + 0.0; /* no -0 */
    vl_camera_put(text, "%s%s%s%.17g%s%s", i ? separator : "", i % group == 0 ? open : "", mark,
                  value, mark, (i + 1) % group == 0 ? close : "");
  }
}

/* A key of a form: $key, $key@index, each with :layout or without. */
typedef struct {
  const char *name;
  size_t length;
  int index;   /* -1: the whole list */
  char layout; /* 0: without */
} Key;

/* Returns the end of the key whose name begins at `at`. */
static const char *parse_key(const char *at, Key *key) {
  *key = (Key){.name = at, .index = -1};
  while (isalnum((unsigned char)*at))
    at++;
  key->length = (size_t)(at - key->name);
  if (*at == '@') {
    char *end;
    key->index = (int)strtol(at + 1, &end, 10);
    at = end;
  }
  if (*at != ':' || !at[1] || !strchr("sqp134", at[1]))
    return at;
  key->layout = at[1];
  return at + 2;
}

static const vlCameraValue *find_value(const vlCameraValue *list, const Key *key) {
  for (; list && list->key; list++)
    if (strlen(list->key) == key->length && memcmp(list->key, key->name, key->length) == 0)
      return list;
  return NULL;
}

static void put_name(vlCameraText *text, const vlFittedCamera *fit) {
  const char *unnamed = fit->format->unnamed ? fit->format->unnamed : "camera";
  vl_camera_put_string(text, fit->record->name[0] ? fit->record->name : unnamed);
}

static void put_named(vlCameraText *text, const vlFittedCamera *fit,
                      const vlCameraValue *list) {
  for (uint32_t i = 0; i < list->count && list->names[i]; i++)
    VL_PUT_FORM(text, fit, list->part, VL_WORD("item", list->names[i]),
                VL_VALUES("value", &list->values[i], 1));
}

static void put_value(vlCameraText *text, const vlFittedCamera *fit, const vlCameraValue *own,
                      const vlCameraValue *value, const Key *key) {
  if (value->word)
    vl_camera_put(text, "%s", value->word);
  else if (value->names)
    put_named(text, fit, value);
  else if (value->part)
    vl_camera_put_form(text, fit, own, value->part);
  else if (value->values && key->index >= 0)
    put_list(text, value->values + key->index, 1, key->layout);
  else if (value->values)
    put_list(text, value->values, value->count, key->layout);
  else
    put_name(text, fit);
}

vlResult vl_camera_put_form(vlCameraText *text, const vlFittedCamera *fit,
                            const vlCameraValue *own, const char *form) {
  const vlCamera *c = &fit->camera;
  const Values v = values_of(c);
  const vlCameraValue all[] = {VL_VALUES("width", &v.sides[0], 1),
                               VL_VALUES("height", &v.sides[1], 1),
                               VL_VALUES("fx", &c->fx, 1),
                               VL_VALUES("fy", &c->fy, 1),
                               VL_VALUES("skew", &c->skew, 1),
                               VL_VALUES("cx", &c->cx, 1),
                               VL_VALUES("cy", &c->cy, 1),
                               VL_VALUES("cx0", &v.offset[0], 1),
                               VL_VALUES("cy0", &v.offset[1], 1),
                               VL_VALUES("near", &c->near_plane, 1),
                               VL_VALUES("far", &c->far_plane, 1),
                               VL_VALUES("aspect", &v.aspect, 1),
                               VL_VALUES("ratio", &v.ratio, 1),
                               VL_VALUES("yfov", &v.yfov, 1),
                               VL_VALUES("K", v.k, 9),
                               VL_VALUES("R", v.r, 9),
                               VL_VALUES("t", v.t, 3),
                               VL_VALUES("V", v.v, 3),
                               VL_VALUES("view", c->camera_from_world, 16),
                               VL_VALUES("viewcolumns", v.view_columns, 16),
                               VL_VALUES("pose", c->world_from_camera, 16),
                               VL_VALUES("flipped", v.flipped, 16),
                               VL_VALUES("flippedcolumns", v.flipped_columns, 16),
                               VL_VALUES("axes", v.axes, 9),
                               VL_VALUES("centre", v.centre, 3),
                               {.key = "name"},
                               {.key = NULL}};
  while (*form) {
    const size_t plain = strcspn(form, "$");
    vl_camera_put_bytes(text, form, plain);
    form += plain;
    if (!*form)
      break;
    Key key;
    form = parse_key(form + 1, &key);
    const vlCameraValue *value = find_value(own, &key);
    if (!value)
      value = find_value(all, &key);
    assert(value); /* the form names what no list has */
    if (value)
      put_value(text, fit, own, value, &key);
  }
  return VL_OK;
}

const char *vl_camera_name_without(const vlFittedCamera *fit, const char *without,
                                   const char *otherwise) {
  const char *name = fit->record->name;
  return *name && !strpbrk(name, without) ? name : otherwise;
}

vlResult vl_camera_write_form(const vlCameraFormat *format, const vlFittedCamera *fit,
                              vlCameraText *text) {
  const uint32_t min = format->lenses.min;
  const uint32_t count = fit->count > min ? fit->count : min;
  return VL_PUT_FORM(text, fit, format->form, VL_VALUES("k", fit->k, count),
                     VL_WORD("lens", format->lens_words[fit->family]));
}
