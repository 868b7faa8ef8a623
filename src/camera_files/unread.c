/* camera_files/unread.c: the fields of a file that its dialect does not know. None is passed
 * over without a word: the record counts them, and those whose names say that they change the
 * image's geometry are errors. */
#include <ctype.h>
#include <stdio.h>

#include "base/text.h"
#include "camera_files/fields.h"

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

vlResult vl_camera_check_rest(const vlCameraFile *file, const json_t *object,
                              const char *const *known, vlCameraRecord *record) {
  size_t count = 0;
  while (known[count])
    count++;
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)object, key, value) {
    if (is_among(key, known, count))
      continue;
    if (names_geometry(key) && !is_off(value, 4))
      return vl_camera_wrong_in(
          file, object, key,
          "%s: \"%s\" is not understood, and by its name it changes the image; take it out if "
          "it does not",
          file->dialect, vl_short_text(key).text);
    count_field(file, object, key, record);
  }
  return VL_OK;
}
