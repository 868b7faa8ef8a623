/* image/exr_attributes.c: conversion of attributes between vlImage and OpenEXR headers. */
#include <stdio.h>

#include "base/text.h"
#include "image/exr.h"

void vl_exr_on_error(exr_const_context_t context, VL_UNUSED exr_result_t code,
                     const char *message) {
  void *user = NULL;
  if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user)
    return;
  vlExr *x = user;
  if (!atomic_flag_test_and_set(&x->failed))
    snprintf(x->message, sizeof x->message, "%s", message ? message : "");
}

/* Attributes that describe the file's layout. The reader skips them and the writer makes new
 * ones. */
static const char *const layout[] = {
    "channels",          "compression", "lineOrder", "tiles",   "type",
    "version",           "chunkCount",  "name",      "preview", "dwaCompressionLevel",
    "maxSamplesPerPixel"};

static bool is_layout(const char *name) {
  for (size_t i = 0; i < VL_LENGTH(layout); i++)
    if (vl_text_is(name, layout[i]))
      return true;
  return false;
}

/* The types that are floats, `count` of them. */
static const struct {
  exr_attribute_type_t from;
  vlAttributeType to;
  int count;
} floats[] = {{EXR_ATTR_V2F, VL_ATTRIBUTE_V2F, 2},
              {EXR_ATTR_V3F, VL_ATTRIBUTE_V3F, 3},
              {EXR_ATTR_M33F, VL_ATTRIBUTE_M33F, 9},
              {EXR_ATTR_M44F, VL_ATTRIBUTE_M44F, 16},
              {EXR_ATTR_CHROMATICITIES, VL_ATTRIBUTE_CHROMATICITIES, 8}};

/* False: the attribute has another type. */
static bool copy_floats(const exr_attribute_t *from, vlAttribute *to) {
  for (size_t i = 0; i < VL_LENGTH(floats); i++) {
    if (from->type != floats[i].from)
      continue;
    float numbers[16];
    memcpy(numbers, from->rawptr, (size_t)floats[i].count * sizeof *numbers);
    to->type = floats[i].to;
    for (int k = 0; k < floats[i].count; k++)
      to->numbers[k] = numbers[k];
    return true;
  }
  return false;
}

static void copy_box(vlAttribute *to, const exr_attr_box2i_t *box) {
  to->type = VL_ATTRIBUTE_BOX2I;
  to->numbers[0] = box->min.x;
  to->numbers[1] = box->min.y;
  to->numbers[2] = box->max.x;
  to->numbers[3] = box->max.y;
}

/* Joins strings with newlines. A string vector that does not fit is truncated. */
static void join_strings(const exr_attr_string_vector_t *from, char *text, size_t size) {
  size_t length = 0;
  text[0] = 0;
  for (int32_t i = 0; i < from->n_strings && length + 1 < size; i++) {
    const char *string = from->strings[i].str ? from->strings[i].str : "";
    int n = snprintf(text + length, size - length, "%s%.*s", i ? "\n" : "",
                     (int)from->strings[i].length, string);
    length += n > 0 ? (size_t)n : 0;
  }
}

/* Converts an attribute. Returns false for a type that vlAttribute does not support. `text` is
 * a buffer for joined strings. */
static bool convert(const exr_attribute_t *from, vlAttribute *to, char *text, size_t size) {
  memset(to, 0, sizeof *to);
  to->name = from->name;
  switch ((int)from->type) { /* the library may know more */
    case EXR_ATTR_FLOAT:
      to->type = VL_ATTRIBUTE_FLOAT;
      to->numbers[0] = from->f;
      return true;
    case EXR_ATTR_DOUBLE:
      to->type = VL_ATTRIBUTE_DOUBLE;
      to->numbers[0] = from->d;
      return true;
    case EXR_ATTR_INT:
      to->type = VL_ATTRIBUTE_INT;
      to->numbers[0] = from->i;
      return true;
    case EXR_ATTR_STRING:
      to->type = VL_ATTRIBUTE_STRING;
      to->string = from->string->str ? from->string->str : "";
      return true;
    case EXR_ATTR_STRING_VECTOR:
      to->type = VL_ATTRIBUTE_STRINGS;
      join_strings(from->stringvector, text, size);
      to->string = text;
      return true;
    case EXR_ATTR_M44D:
      to->type = VL_ATTRIBUTE_M44D;
      memcpy(to->numbers, from->m44d->m, sizeof to->numbers);
      return true;
    case EXR_ATTR_BOX2I:
      copy_box(to, from->box2i);
      return true;
    default:
      return copy_floats(from, to);
  }
}

/* Whether an attribute that every header has is at its default; such attributes are not
 * kept. */
static bool is_default(const vlAttribute *a, const vlImage *image) {
  if (vl_text_is(a->name, "pixelAspectRatio") || vl_text_is(a->name, "screenWindowWidth"))
    return a->numbers[0] == 1.0;
  if (vl_text_is(a->name, "screenWindowCenter"))
    return a->numbers[0] == 0.0 && a->numbers[1] == 0.0;
  if (vl_text_is(a->name, "dataWindow") || vl_text_is(a->name, "displayWindow"))
    return a->numbers[0] == 0.0 && a->numbers[1] == 0.0 &&
           a->numbers[2] == image->width - 1.0 && a->numbers[3] == image->height - 1.0;
  return false;
}

vlResult vl_exr_attributes_in(exr_const_context_t exr, vlImage *image) {
  int32_t count = 0;
  exr_get_attribute_count(exr, 0, &count);
  vlAttribute windows[2];
  uint32_t plain = 0;
  for (int32_t i = 0; i < count; i++) {
    const exr_attribute_t *from;
    vlAttribute to;
    char text[2048];
    if (exr_get_attribute_by_index(exr, 0, EXR_ATTR_LIST_FILE_ORDER, i, &from) !=
        EXR_ERR_SUCCESS)
      continue;
    if (!from->name || !from->name[0] || is_layout(from->name) ||
        !convert(from, &to, text, sizeof text))
      continue;
    const bool data = vl_text_is(to.name, "dataWindow");
    if (data || vl_text_is(to.name, "displayWindow")) {
      windows[data ? 0 : 1] = to;
      plain += is_default(&to, image);
      continue;
    }
    if (is_default(&to, image))
      continue;
    vlResult result = vl_image_set_attribute(image, &to);
    if (result == VL_ERROR_MEMORY)
      return result;
  }
  if (plain == 2)
    return VL_OK; /* both windows equal the image */
  for (int i = 0; i < 2; i++)
    if (vl_image_set_attribute(image, &windows[i]) == VL_ERROR_MEMORY)
      return VL_ERROR_MEMORY;
  return VL_OK;
}

static exr_attr_box2i_t box_of(const double n[16]) {
  exr_attr_box2i_t box;
  box.min.x = (int32_t)n[0];
  box.min.y = (int32_t)n[1];
  box.max.x = (int32_t)n[2];
  box.max.y = (int32_t)n[3];
  return box;
}

static exr_result_t set_strings(exr_context_t exr, const char *name, const char *text) {
  enum { MAX_STRINGS = 64 };
  const char *strings[MAX_STRINGS];
  char copy[2048];
  int count = 0;
  if (strlen(text) >= sizeof copy)
    return EXR_ERR_INVALID_ATTR;
  memcpy(copy, text, strlen(text) + 1);
  for (char *at = copy; at;) {
    char *end = strchr(at, '\n');
    if (end)
      *end = 0;
    if (count == MAX_STRINGS)
      return EXR_ERR_INVALID_ATTR;
    strings[count++] = at;
    at = end ? end + 1 : NULL;
  }
  return exr_attr_set_string_vector(exr, 0, name, count, strings);
}

static exr_result_t set_attribute(exr_context_t exr, const vlImageAttribute *a) {
  const double *n = a->numbers;
  float f[16];
  union {
    exr_attr_v2f_t v2f;
    exr_attr_v3f_t v3f;
    exr_attr_m33f_t m33f;
    exr_attr_m44f_t m44f;
    exr_attr_chromaticities_t chromaticities;
  } v;
  for (int i = 0; i < 16; i++)
    f[i] = (float)n[i];
  memcpy(&v, f, sizeof f);
  switch (a->type) {
    case VL_ATTRIBUTE_FLOAT:
      if (vl_text_is(a->name, "pixelAspectRatio"))
        return exr_set_pixel_aspect_ratio(exr, 0, f[0]);
      if (vl_text_is(a->name, "screenWindowWidth"))
        return exr_set_screen_window_width(exr, 0, f[0]);
      return exr_attr_set_float(exr, 0, a->name, f[0]);
    case VL_ATTRIBUTE_DOUBLE:
      return exr_attr_set_double(exr, 0, a->name, n[0]);
    case VL_ATTRIBUTE_INT:
      return exr_attr_set_int(exr, 0, a->name, (int32_t)n[0]);
    case VL_ATTRIBUTE_STRING:
      return exr_attr_set_string(exr, 0, a->name, a->string);
    case VL_ATTRIBUTE_STRINGS:
      return set_strings(exr, a->name, a->string);
    case VL_ATTRIBUTE_V2F:
      if (vl_text_is(a->name, "screenWindowCenter"))
        return exr_set_screen_window_center(exr, 0, &v.v2f);
      return exr_attr_set_v2f(exr, 0, a->name, &v.v2f);
    case VL_ATTRIBUTE_V3F:
      return exr_attr_set_v3f(exr, 0, a->name, &v.v3f);
    case VL_ATTRIBUTE_M33F:
      return exr_attr_set_m33f(exr, 0, a->name, &v.m33f);
    case VL_ATTRIBUTE_M44F:
      return exr_attr_set_m44f(exr, 0, a->name, &v.m44f);
    case VL_ATTRIBUTE_M44D: {
      exr_attr_m44d_t m;
      memcpy(m.m, n, sizeof m.m);
      return exr_attr_set_m44d(exr, 0, a->name, &m);
    }
    case VL_ATTRIBUTE_CHROMATICITIES:
      return exr_attr_set_chromaticities(exr, 0, a->name, &v.chromaticities);
    case VL_ATTRIBUTE_BOX2I: {
      const exr_attr_box2i_t box = box_of(n);
      if (vl_text_is(a->name, "displayWindow"))
        return exr_set_display_window(exr, 0, &box);
      if (vl_text_is(a->name, "dataWindow"))
        return exr_set_data_window(exr, 0, &box);
      return exr_attr_set_box2i(exr, 0, a->name, &box);
    }
  }
  return EXR_ERR_INVALID_ARGUMENT;
}

vlResult vl_exr_attributes_out(exr_context_t exr, const vlImage *image, vlError *error) {
  VL_EACH_ITEM(const vlImageAttribute, a, &image->attributes) {
    if (is_layout(a->name))
      continue;
    bool ok = !vl_text_is(a->name, "dataWindow") ||
              (a->numbers[2] - a->numbers[0] + 1.0 == image->width &&
               a->numbers[3] - a->numbers[1] + 1.0 == image->height);
    exr_result_t code = ok ? set_attribute(exr, a) : EXR_ERR_INVALID_ATTR;
    if (code == EXR_ERR_OUT_OF_MEMORY)
      return vl_fail_memory(error);
    if (code != EXR_ERR_SUCCESS)
      return vl_fail(
          error, VL_ERROR_ARGUMENT, "cannot write the attribute \"%s\": %s",
          vl_short_text(a->name).text,
          ok ? exr_get_default_error_message(code) : "it is not of the image's size");
  }
  return VL_OK;
}
