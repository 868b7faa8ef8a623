/* film/file_header.c: the header of a film file as JSON: the film's def and the receipt of its
 * render. */
#include <math.h>
#include <stddef.h>

#include "base/array.h"
#include "base/error.h"
#include "base/free.h"
#include "base/json.h"
#include "base/text.h"
#include "color/color.h"
#include "film/file.h"
#include "schema/schema.h"
#include "velo/filter_kinds.h"
#include "velo/schema.h"

/* A number of the film's def. */
typedef struct Field {
  char name[48];
  vlParameterType type; /* COUNT, FLOAT, DOUBLE or BOOL */
  size_t offset;
  bool optional; /* a parameter of another filter than the film's */
} Field;
#define FIELD(name, type, member) \
  { name, type, offsetof(vlFilmDef, member), false }
static const Field size_fields[] = {FIELD("width", VL_PARAMETER_COUNT, width),
                                    FIELD("height", VL_PARAMETER_COUNT, height)};
static const Field film_fields[] = {FIELD("white_balance", VL_PARAMETER_DOUBLE, white_balance),
                                    FIELD("max_component", VL_PARAMETER_FLOAT, max_component),
                                    FIELD("errors", VL_PARAMETER_BOOL, errors),
                                    FIELD("buckets", VL_PARAMETER_COUNT, buckets),
                                    FIELD("lambda_min", VL_PARAMETER_DOUBLE, lambda_min),
                                    FIELD("lambda_max", VL_PARAMETER_DOUBLE, lambda_max)};
typedef struct FieldList {
  Field items[32];
  size_t count;
} FieldList;

static void add_field(FieldList *list, const Field *field) {
  VL_EACH_ITEM(Field, known, list) {
    if (known->offset != field->offset)
      continue;
    known->optional = known->optional && field->optional; /* a parameter of several filters */
    return;
  }
  if (list->count < VL_LENGTH(list->items))
    list->items[list->count++] = *field;
}

/* All numbers of a film's def that are in its header, in their order there. Those of filters
 * are the parameters of their rows. */
static FieldList list_fields(const vlFilmDef *def) {
  FieldList list = {.count = 0};
  const vlKindFamily *filters = vl_kind_family_find("filters");
  for (size_t i = 0; i < VL_LENGTH(size_fields); i++)
    add_field(&list, &size_fields[i]);
  for (uint32_t kind = 0; kind < filters->kind_count; kind++)
    VL_EACH_PARAMETER(parameter, filters->rows[kind]) {
      Field field = {.type = parameter->type,
                     .offset = offsetof(vlFilmDef, filter) + parameter->offset,
                     .optional = kind != (uint32_t)def->filter.kind};
      snprintf(field.name, sizeof field.name, "filter_%s", parameter->member);
      add_field(&list, &field);
    }
  for (size_t i = 0; i < VL_LENGTH(film_fields); i++)
    add_field(&list, &film_fields[i]);
  return list;
}

static bool put(json_t *object, const char *key, json_t *value) {
  return value && json_object_set_new(object, key, value) == 0;
}

/* ---- making ------------------------------------------------------------------------------ */

static json_t *number(double value) {
  return isinf(value) ? json_string("infinity") : json_real(value);
}

static double field_number(const vlFilmDef *def, const Field *field) {
  return vl_member_number(&vl_member_types[field->type], (const char *)def + field->offset, 0);
}

static json_t *field_value(const vlFilmDef *def, const Field *field) {
  double value = field_number(def, field);
  if (field->type == VL_PARAMETER_BOOL)
    return json_boolean(value != 0);
  return field->type == VL_PARAMETER_COUNT ? json_integer((json_int_t)value) : number(value);
}

/* {"camera": name, ...}: of the kinds that have names; none: nothing is put. */
static bool put_own(json_t *film, const vlFilmOwn *own) {
  json_t *names = NULL;
  for (int i = 0; i < VL_OWN_KINDS; i++) {
    if (!own->name[i][0])
      continue;
    if (!names && !put(film, "own", names = json_object()))
      return false;
    if (!put(names, vl_own_words[i], json_string(own->name[i])))
      return false;
  }
  return true;
}

static json_t *film_tree(const vlFilmShape *shape) {
  const vlFilmDef *def = &shape->def;
  json_t *film = json_object();
  bool good = film != NULL;
  const FieldList list = list_fields(def);
  for (size_t i = 0; i < list.count && good; i++)
    good = put(film, list.items[i].name, field_value(def, &list.items[i]));
  const uint32_t *c = def->crop;
  good = good &&
         put(film, "crop",
             json_pack("[I,I,I,I]", (json_int_t)c[0], (json_int_t)c[1], (json_int_t)c[2],
                       (json_int_t)c[3])) &&
         put(film, "filter",
             json_string(vl_kind_family_find("filters")->rows[def->filter.kind]->name)) &&
         put(film, "space", json_string(vl_color_space_names[def->space])) &&
         put(film, "sensor", json_string(def->sensor ? def->sensor : vl_sensor_name(0))) &&
         put(film, "sequence", json_integer(shape->sequence)) && put_own(film, &shape->own);
  if (!good) {
    json_decref(film);
    film = NULL;
  }
  return film;
}

static bool put_text(json_t *tree, const char *key, const char *text) {
  json_error_t location;
  return !text ||
         put(tree, key, vl_json_parse(text, strlen(text), JSON_REJECT_DUPLICATES, &location));
}

bool vl_film_same_shape(const vlFilmShape *a, const vlFilmShape *b) {
  const vlFilmDef *p = &a->def, *q = &b->def;
  const FieldList list = list_fields(p);
  bool same = a->sequence == b->sequence && memcmp(p->crop, q->crop, sizeof p->crop) == 0 &&
              p->filter.kind == q->filter.kind && p->space == q->space &&
              p->sensor == q->sensor;
  for (size_t i = 0; i < list.count && same; i++)
    same = field_number(p, &list.items[i]) == field_number(q, &list.items[i]);
  return same;
}

char *vl_film_header_make(vlContext *context, const vlFilmShape *shape,
                          const vlFilmTexts *texts) {
  json_t *tree = json_object(), *film = film_tree(shape);
  bool good = put(tree, "film", film) && put_text(tree, "receipt", texts->receipt) &&
              put_text(tree, "attributes", texts->attributes);
  char *text =
      good ? vl_json_text(context, tree, JSON_INDENT(1) | JSON_PRESERVE_ORDER, "\n") : NULL;
  json_decref(tree);
  return text;
}

/* ---- reading ----------------------------------------------------------------------------- */

static vlResult wrong(const char *path, const char *what, vlError *error) {
  return vl_fail(error, VL_ERROR_SCENE,
                 "%s: film file: \"%s\" of the header is missing or wrong", path, what);
}

static bool count_of(const json_t *value, uint32_t *count) {
  if (!json_is_integer(value) || json_integer_value(value) < 0 ||
      json_integer_value(value) > UINT32_MAX)
    return false;
  *count = (uint32_t)json_integer_value(value);
  return true;
}

static bool number_of(const json_t *value, double *result) {
  const char *text = json_string_value(value);
  if (vl_text_is(text, "infinity")) {
    *result = INFINITY;
    return true;
  }
  *result = json_number_value(value);
  return json_is_number(value);
}

static bool take_field(const json_t *film, const Field *field, vlFilmDef *def) {
  const json_t *value = json_object_get(film, field->name);
  uint32_t count = 0;
  double number = json_is_true(value);
  bool good = field->type == VL_PARAMETER_BOOL    ? json_is_boolean(value)
              : field->type == VL_PARAMETER_COUNT ? count_of(value, &count)
                                                  : number_of(value, &number);
  if (good)
    vl_member_types[field->type].put((char *)def + field->offset, 0,
                                     field->type == VL_PARAMETER_COUNT ? count : number);
  return good || (!value && field->optional);
}

static bool take_names(const json_t *film, vlFilmDef *def) {
  const char *filter = json_string_value(json_object_get(film, "filter"));
  const char *space = json_string_value(json_object_get(film, "space"));
  const char *sensor = json_string_value(json_object_get(film, "sensor")), *name;
  const vlKindFamily *family = vl_kind_family_find("filters");
  bool found[3] = {false, false, false};
  for (uint32_t i = 0; filter && i < family->kind_count; i++)
    if (vl_text_is(family->rows[i]->name, filter)) {
      def->filter.kind = (vlPixelFilterKind)i;
      found[0] = true;
    }
  for (int i = 0; space && vl_color_space_names[i]; i++)
    if (vl_text_is(vl_color_space_names[i], space)) {
      def->space = (vlColorSpace)i;
      found[1] = true;
    }
  for (uint32_t i = 0; sensor && (name = vl_sensor_name(i)); i++)
    if (vl_text_is(name, sensor)) {
      def->sensor = i ? name : NULL;
      found[2] = true;
    }
  return found[0] && found[1] && found[2];
}

static bool take_own(const json_t *names, vlFilmOwn *own) {
  memset(own, 0, sizeof *own);
  for (int i = 0; i < VL_OWN_KINDS; i++) {
    const json_t *value = json_object_get(names, vl_own_words[i]);
    const char *name = json_string_value(value);
    if (value && (!name || strlen(name) >= VL_OWN_NAME))
      return false;
    if (name)
      memcpy(own->name[i], name, strlen(name) + 1);
  }
  return !names || json_is_object(names);
}

static vlResult take_film(const char *path, const json_t *film, vlFilmShape *shape,
                          vlError *error) {
  vlFilmDef *def = &shape->def;
  *def = vl_default_film_def(1, 1);
  if (!take_names(film, def))
    return wrong(path, "filter, space or sensor", error);
  const FieldList list = list_fields(def);
  for (size_t i = 0; i < list.count; i++)
    if (!take_field(film, &list.items[i], def))
      return wrong(path, list.items[i].name, error);
  const json_t *crop = json_object_get(film, "crop");
  for (size_t i = 0; i < 4; i++)
    if (!count_of(json_array_get(crop, i), &def->crop[i]))
      return wrong(path, "crop", error);
  if (!count_of(json_object_get(film, "sequence"), &shape->sequence) || !shape->sequence)
    return wrong(path, "sequence", error);
  if (!take_own(json_object_get(film, "own"), &shape->own))
    return wrong(path, "own", error);
  return VL_OK;
}

/* Takes a member of the header as text; *text null: it has none. */
static vlResult take_text(vlContext *context, const char *path, const json_t *tree,
                          const char *key, char **text, vlError *error) {
  const json_t *held = json_object_get(tree, key);
  if (!held)
    return VL_OK;
  if (!json_is_object(held))
    return wrong(path, key, error);
  *text = vl_json_text(context, held, JSON_COMPACT | JSON_PRESERVE_ORDER, "");
  return *text ? VL_OK : vl_fail_memory(error);
}

vlResult vl_film_header_read(vlContext *context, const char *path, const char *text,
                             size_t size, vlFilmShape *shape, vlFilmTexts *texts,
                             vlError *error) {
  *texts = (vlFilmTexts){NULL, NULL};
  json_error_t location;
  json_t *tree = vl_json_parse(text, size, JSON_REJECT_DUPLICATES, &location);
  if (!tree && vl_json_lacks_memory(&location))
    return vl_fail_memory(error);
  if (!tree)
    return vl_fail(error, VL_ERROR_SCENE, "%s: film file: header, line %d: %s", path,
                   location.line, location.text);
  vlResult result = take_film(path, json_object_get(tree, "film"), shape, error);
  if (result == VL_OK)
    result = take_text(context, path, tree, "receipt", &texts->receipt, error);
  if (result == VL_OK)
    result = take_text(context, path, tree, "attributes", &texts->attributes, error);
  json_decref(tree);
  /* vl_film_create checks the def; it allocates no memory for pixels yet */
  vlFilm *film = NULL;
  if (result == VL_OK) {
    result = vl_film_create(context, &shape->def, &film);
    vl_film_destroy(film);
    if (result != VL_OK)
      result = result == VL_ERROR_MEMORY ? vl_fail_memory(error) : wrong(path, "film", error);
  }
  if (result == VL_OK)
    return VL_OK;
  VL_FREE(context, texts->receipt, texts->attributes);
  *texts = (vlFilmTexts){NULL, NULL};
  return result;
}
