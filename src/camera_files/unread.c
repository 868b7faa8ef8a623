/* camera_files/unread.c: the fields of a file that its dialect does not know. None is passed
 * over without a word: the record counts them, and those whose names say that they change the
 * image's geometry are errors. */
#include <ctype.h>
#include <stdio.h>

#include "base/text.h"
#include "camera_files/formats.h"

enum { MAX_DEPTH = 32 };

/* Parts of names that speak of another image than that of the camera as read. */
static const char *const parts[] = {
    "binning", "crop",   "flip", "mirror", "rolling",   "skew",  "shear",  "distort",
    "fisheye", "ftheta", "warp", "shift",  "principal", "ortho", "resize", "downsampl"};
/* Whole names that do. */
static const char *const whole[] = {"roi", "xi"};
/* Coefficients of lens models: a letter and a digit. */
static const char coefficients[] = "kpsb";

static bool is_among(const char *word, const char *const *words, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (vl_text_is(word, words[i]))
      return true;
  return false;
}

static bool names_geometry(const char *key) {
  char name[64];
  size_t length = 0;
  for (; key[length] && length + 1 < sizeof name; length++)
    name[length] = (char)tolower((unsigned char)key[length]);
  name[length] = 0;
  if (length == 2 && strchr(coefficients, name[0]) && isdigit((unsigned char)name[1]))
    return true;
  if (is_among(name, whole, VL_LENGTH(whole)))
    return true;
  if (strstr(name, "undistort")) /* says what was done, not what is to be done */
    return false;
  for (size_t i = 0; i < VL_LENGTH(parts); i++)
    if (strstr(name, parts[i]))
      return true;
  return false;
}

/* Whether a value says that the field has no effect: null, false, 0, "", "none", and lists and
 * objects of these alone. depth: how many levels may still follow. */
static bool is_off(const json_t *value, int depth) {
  const char *key;
  json_t *child;
  size_t i;
  if (json_is_object(value)) {
    json_object_foreach((json_t *)value, key,
                        child) if (!depth || !is_off(child, depth - 1)) return false;
    return true;
  }
  if (json_is_array(value)) {
    json_array_foreach((json_t *)value, i,
                       child) if (!depth || !is_off(child, depth - 1)) return false;
    return true;
  }
  if (json_is_number(value))
    return json_number_value(value) == 0.0;
  if (json_is_string(value))
    return !*json_string_value(value) || vl_text_is(json_string_value(value), "none");
  return !json_is_true(value);
}

/* Counts a field; the names of the first three are kept. */
static void count_field(const vlCameraFile *file, const json_t *object, const char *key,
                        vlCameraRecord *record) {
  const size_t used = strlen(record->unread_names);
  if (record->unread < 3)
    snprintf(record->unread_names + used, sizeof record->unread_names - used, "%s\"%s\"",
             used ? ", " : "", vl_short_text(key).text);
  if (record->unread == 0)
    record->unread_line = vl_camera_line(file, object, key);
  record->unread++;
}

/* Whether one of the words, with blanks between, is this name or its beginning and a *. */
static bool is_listed(const char *words, const char *name) {
  const size_t length = strlen(name);
  for (const char *at = words; at && *at;) {
    at += strspn(at, " ");
    const size_t n = strcspn(at, " ");
    const bool begins = n > 0 && at[n - 1] == '*';
    if (begins ? strncmp(at, name, n - 1) == 0 : n == length && memcmp(at, name, n) == 0)
      return true;
    at += n;
  }
  return false;
}

static bool is_known(const vlCameraFormat *format, const char *name) {
  /* names that begin so are those of parsers: "<" is an element's name, "[]" a list */
  bool known = strchr("<[_!", name[0]) != NULL;
  known = known || is_listed(format->known, name) || (format->knows && format->knows(name));
  for (size_t i = 0; i < VL_LENGTH(format->marks) && format->marks[i]; i++)
    known = known || vl_text_is(name, format->marks[i]);
  return known || (format->marks_in && vl_text_is(name, format->marks_in));
}

static vlResult check(const vlCameraFile *file, const vlCameraFormat *format,
                      const json_t *item, int depth, vlCameraRecord *record) {
  vlResult result = VL_OK;
  if (depth == MAX_DEPTH)
    return VL_OK;
  /* a list of numbers is passed at its first one */
  for (size_t i = 0; i < json_array_size(item) && result == VL_OK; i++) {
    if (json_is_number(json_array_get(item, i)))
      break;
    result = check(file, format, json_array_get(item, i), depth + 1, record);
  }
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)item, key, value) {
    if (result != VL_OK)
      return result;
    if (is_known(format, key)) {
      result = check(file, format, value, depth + 1, record);
      continue;
    }
    if (names_geometry(key) && !is_off(value, 4))
      return vl_camera_wrong_in(
          file, item, key,
          "%s: \"%s\" is not understood, and by its name it changes the image; take it out if "
          "it does not",
          file->dialect, vl_short_text(key).text);
    count_field(file, item, key, record);
  }
  return result;
}

vlResult vl_camera_check_unread(const vlCameraFile *file, const vlCameraFormat *format,
                                const json_t *tree, vlCameraRecord *record) {
  return format->known || format->knows ? check(file, format, tree, 0, record) : VL_OK;
}
