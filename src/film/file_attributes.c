/* film/file_attributes.c: the attributes of images in the header of a film file, as JSON. */
#include <math.h>

#include "base/error.h"
#include "base/json.h"
#include "base/text.h"
#include "film/file.h"

static const struct {
  const char *name;
  size_t numbers; /* 0: a string */
} types[] = {[VL_ATTRIBUTE_FLOAT] = {"float", 1},
             [VL_ATTRIBUTE_INT] = {"int", 1},
             [VL_ATTRIBUTE_STRING] = {"string", 0},
             [VL_ATTRIBUTE_V2F] = {"v2f", 2},
             [VL_ATTRIBUTE_V3F] = {"v3f", 3},
             [VL_ATTRIBUTE_M33F] = {"m33f", 9},
             [VL_ATTRIBUTE_M44F] = {"m44f", 16},
             [VL_ATTRIBUTE_BOX2I] = {"box2i", 4},
             [VL_ATTRIBUTE_DOUBLE] = {"double", 1},
             [VL_ATTRIBUTE_CHROMATICITIES] = {"chromaticities", 8},
             [VL_ATTRIBUTE_M44D] = {"m44d", 16},
             [VL_ATTRIBUTE_STRINGS] = {"strings", 0}};
enum { TYPES = VL_LENGTH(types) };

static bool append(json_t *list, json_t *value) {
  return value && json_array_append_new(list, value) == 0;
}

/* Numbers that JSON cannot hold, and strings that are not UTF-8, are left out with their
 * attribute. */
static bool can_be_kept(const vlAttribute *a) {
  if (!types[a->type].numbers)
    return !a->string || vl_is_utf8(a->string);
  for (size_t i = 0; i < types[a->type].numbers; i++)
    if (!isfinite(a->numbers[i]))
      return false;
  return true;
}

static bool put_attribute(json_t *tree, const vlAttribute *a) {
  json_t *list = json_array();
  bool good = list && append(list, json_string(types[a->type].name));
  if (!types[a->type].numbers)
    good = good && append(list, json_string(a->string ? a->string : ""));
  for (size_t i = 0; i < types[a->type].numbers && good; i++)
    good = append(list, json_real(a->numbers[i]));
  if (good)
    return json_object_set_new(tree, a->name, list) == 0;
  json_decref(list);
  return false;
}

char *vl_film_attributes_make(vlContext *context, const vlImage *image) {
  json_t *tree = json_object();
  bool good = tree != NULL;
  for (uint32_t i = 0; i < vl_image_attribute_count(image) && good; i++) {
    vlAttribute attribute;
    good = vl_image_attribute(image, i, &attribute) == VL_OK;
    if (good && can_be_kept(&attribute))
      good = put_attribute(tree, &attribute);
  }
  char *text =
      good ? vl_json_text(context, tree, JSON_COMPACT | JSON_PRESERVE_ORDER, "") : NULL;
  json_decref(tree);
  return text;
}

static bool take_attribute(const json_t *list, vlAttribute *a) {
  const char *name = json_string_value(json_array_get(list, 0));
  for (int type = 0; name && type < TYPES; type++) {
    size_t count = types[type].numbers;
    if (!vl_text_is(types[type].name, name) || json_array_size(list) != 1 + (count ? count : 1))
      continue;
    a->type = (vlAttributeType)type;
    a->string = count ? NULL : json_string_value(json_array_get(list, 1));
    if (!count)
      return a->string != NULL;
    for (size_t i = 0; i < count; i++) {
      const json_t *value = json_array_get(list, 1 + i);
      if (!json_is_number(value))
        return false;
      a->numbers[i] = json_number_value(value);
    }
    return true;
  }
  return false;
}

vlResult vl_film_attributes_set(const char *path, const char *text, vlImage *image,
                                vlError *error) {
  json_error_t location;
  json_t *tree = vl_json_parse(text, strlen(text), JSON_REJECT_DUPLICATES, &location), *list;
  const char *key;
  if (!tree)
    return vl_fail_memory(error); /* the text is that of a tree */
  vlResult result = VL_OK;
  json_object_foreach(tree, key, list) {
    vlAttribute attribute = {.name = key};
    bool good = take_attribute(list, &attribute);
    if (good)
      result = vl_image_set_attribute(image, &attribute);
    if (!good || result == VL_ERROR_ARGUMENT)
      result =
          vl_fail(error, VL_ERROR_SCENE,
                  "%s: film file: the attribute \"%.60s\" of the header is wrong", path, key);
    if (result != VL_OK)
      break;
  }
  json_decref(tree);
  return result == VL_ERROR_MEMORY ? vl_fail_memory(error) : result;
}
