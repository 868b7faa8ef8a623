/* camera_files/unread.c: the fields of a file that its dialect does not know. None is passed
 * over without a word: the record counts them, and those whose names say that they change the
 * image's geometry are errors. */
#include <ctype.h>
#include <stdio.h>
#include <strings.h>

#include "base/text.h"
#include "camera_files/formats.h"
#include "camera_files/lines.h"

enum { MAX_DEPTH = 32 };

/* Parts of names that speak of another image than that of the camera as read. */
static const char *const parts[] = {"binning",   "crop",   "flip",      "mirror",    "rolling",
                                    "skew",      "shear",  "distort",   "fisheye",   "ftheta",
                                    "warp",      "shift",  "principal", "ortho",     "resize",
                                    "downsampl", "rotate", "readout",   "line_delay"};
/* Values that name a lens which is none of perspective. */
static const char *const lenses[] = {"fisheye",  "ftheta",       "f-theta", "equirectangular",
                                     "ortho",    "orthographic", "omni",    "panoramic",
                                     "spherical"};
/* Whole names that do. */
static const char whole[] = "roi xi cx cy";
/* Coefficients of lens models: a letter and a digit. */
static const char coefficients[] = "kpsbdt";

static bool names_geometry(const char *key) {
  char name[64];
  size_t length = 0;
  for (; key[length] && length + 1 < sizeof name; length++)
    name[length] = (char)tolower((unsigned char)key[length]);
  name[length] = 0;
  if (length == 2 && strchr(coefficients, name[0]) && isdigit((unsigned char)name[1]))
    return true;
  if (vl_has_word(whole, name))
    return true;
  if (strstr(name, "undistort")) /* says what was done, not what is to be done */
    return false;
  for (size_t i = 0; i < VL_LENGTH(parts); i++)
    if (strstr(name, parts[i]))
      return true;
  return false;
}

static bool is_off_word(const char *text) {
  char *end;
  const double number = vl_camera_parse(text, &end); /* numbers are texts in XML, and in .sfm */
  return !*text || vl_has_word("none None NONE false False", text) ||
         (end != text && !*end && number == 0.0);
}

/* Whether a value says that the field has no effect: null, false, 0, "", "none", and lists and
 * objects of these alone. depth: how many levels may still follow. */
static bool is_off(const json_t *value, int depth) {
  const char *key;
  json_t *child;
  if (json_is_object(value)) {
    json_object_foreach((json_t *)value, key,
                        child) if (!depth || !is_off(child, depth - 1)) return false;
    return true;
  }
  if (json_is_array(value)) {
    VL_EACH(child, value)
      if (!depth || !is_off(child, depth - 1))
        return false;
    return true;
  }
  if (json_is_number(value))
    return json_number_value(value) == 0.0;
  if (json_is_string(value))
    return is_off_word(json_string_value(value));
  return !json_is_true(value);
}

/* Counts a field; the names of the first are kept. */
static void count_field(const vlCameraFile *file, const json_t *object, const char *key,
                        const char *name, vlCameraRecord *record) {
  const size_t used = strlen(record->unread_names);
  if (record->unread < VL_UNREAD_NAMES)
    snprintf(record->unread_names + used, sizeof record->unread_names - used, "%s\"%s\"",
             used ? ", " : "", vl_short_text(name).text);
  if (record->unread == 0 && vl_camera_has(object, "<")) /* of XML, and its attributes */
    record->unread_line = (uint32_t)json_number_value(json_object_get(object, "#"));
  else if (record->unread == 0)
    record->unread_line = vl_camera_line(file, object, key);
  record->unread++;
}

/* Whether a text of the value is the name of a lens. */
static bool names_lens(const json_t *value, int depth) {
  const char *key;
  json_t *child;
  bool found = false;
  if (json_is_object(value) && depth > 0)
    json_object_foreach((json_t *)value, key, child) found =
        found || names_lens(child, depth - 1);
  for (size_t i = 0; json_is_string(value) && i < VL_LENGTH(lenses); i++)
    found = found || strcasecmp(json_string_value(value), lenses[i]) == 0;
  return found;
}

typedef enum { UNKNOWN, KNOWN, OF_NAMES, CLOSED } Knowledge;

/* What a list of words, with blanks between, says of a name (vlCameraFormat.known). */
static Knowledge knowledge(const char *words, const char *name) {
  const size_t length = strlen(name);
  for (const char *at = words; at && *at;) {
    at += strspn(at, " ");
    size_t n = strcspn(at, " ");
    const char *word = at;
    const char last = n > 1 ? at[n - 1] : 0;
    at += n;
    n -= last == '*' || last == '/' || last == '!';
    if (last == '*' ? length >= n && memcmp(word, name, n) == 0
                    : n == length && memcmp(word, name, n) == 0)
      return last == '/' ? OF_NAMES : last == '!' ? CLOSED : KNOWN;
  }
  return UNKNOWN;
}

static Knowledge knowledge_of(const vlCameraFormat *format, const char *name) {
  /* names that begin so are those of parsers: "<" is an element's name, "[]" a list */
  const bool known = strchr("<[_!/#|$", name[0]) || (format->knows && format->knows(name)) ||
                     (format->marks && vl_has_word(format->marks, name)) ||
                     vl_text_is(format->marks_in, name);
  const Knowledge listed = knowledge(format->known, name);
  return listed == UNKNOWN && known ? KNOWN : listed;
}

/* The object of a field, or an element of XML, that is not known. value: its value. */
static vlResult take_unknown(const vlCameraFile *file, const vlCameraFormat *format,
                             const json_t *object, const char *key, const char *name,
                             const json_t *value, vlCameraRecord *record) {
  if (is_off(value, 4) || !(names_geometry(name) || names_lens(value, 2) ||
                            knowledge(format->geometry, name) != UNKNOWN)) {
    count_field(file, object, key, name, record);
    return VL_OK;
  }
  char message[300];
  snprintf(message, sizeof message,
           "\"%s\" is not understood, and by its name it changes the image; take it out if it "
           "does not",
           vl_short_text(name).text);
  return vl_camera_has(object, "<")
             ? vl_camera_wrong_element(file, object, "%s", message)
             : vl_camera_wrong_in(file, object, key, "%s: %s", file->dialect, message);
}

/* Where an object is in the tree. */
typedef struct {
  int depth;  /* of objects and lists around it */
  bool names; /* the fields of this object have the names of cameras or images */
} Level;

static vlResult check(const vlCameraFile *file, const vlCameraFormat *format,
                      const json_t *item, Level level, vlCameraRecord *record) {
  const Level below = {level.depth + 1, false};
  if (level.depth == MAX_DEPTH)
    return VL_OK;
  /* a list of numbers is passed at its first one */
  for (size_t i = 0; i < json_array_size(item); i++) {
    if (json_is_number(json_array_get(item, i)))
      break;
    VL_TRY(check(file, format, json_array_get(item, i), below, record));
  }
  const char *element = vl_camera_text(item, "<");
  const Knowledge tag = element ? knowledge_of(format, element) : KNOWN;
  if (tag == UNKNOWN) {
    const json_t *text = json_object_get(item, "$");
    return take_unknown(file, format, item, NULL, element, text ? text : item, record);
  }
  const char *key;
  json_t *value;
  if (tag != CLOSED)
    json_object_foreach((json_t *)item, key, value) {
      const Knowledge known = knowledge_of(format, key);
      if (known == UNKNOWN && level.names && json_is_object(value))
        VL_TRY(check(file, format, value, below, record));
      else if (known == UNKNOWN)
        VL_TRY(take_unknown(file, format, item, key, key, value, record));
      else if (known != CLOSED)
        VL_TRY(check(file, format, value, (Level){level.depth + 1, known == OF_NAMES}, record));
    }
  return VL_OK;
}

vlResult vl_camera_check_unread(const vlCameraFile *file, const vlCameraFormat *format,
                                const json_t *tree, vlCameraRecord *record) {
  const Level top = {0, knowledge(format->known, "/") != UNKNOWN};
  return format->known || format->knows ? check(file, format, tree, top, record) : VL_OK;
}

vlResult vl_camera_check_part(const vlCameraFile *file, const char *known, const json_t *object,
                              vlCameraRecord *record) {
  const vlCameraFormat part = {.name = file->dialect, .known = known};
  return check(file, &part, object, (Level){0, false}, record);
}

/* The name is looked at like that of an element of XML. length: of the name. */
static vlResult check_name(const vlCameraFile *file, const vlCameraFormat *format,
                           const vlCameraName *name, size_t length, vlCameraRecord *record) {
  json_t *element = json_pack("{s:s%,s:i,s:i,s:s}", "<", name->name, length, "#",
                              (int)name->line, "|", 1, "$", name->value);
  if (!element) /* no text in UTF-8 */
    return VL_OK;
  vlResult result = check(file, format, element, (Level){0, false}, record);
  json_decref(element);
  return result;
}

vlResult vl_camera_check_name(const vlCameraFile *file, const char *known,
                              const vlCameraName *name, vlCameraRecord *record) {
  const vlCameraFormat part = {.name = file->dialect, .known = known};
  return check_name(file, &part, name, strlen(name->name), record);
}

static vlResult check_line(const vlCameraFile *file, const vlCameraFormat *format,
                           const vlCameraLines *line, vlCameraRecord *record) {
  const char *sign = strchr(line->text, format->separator);
  if (!sign || sign == line->text)
    return VL_OK;
  size_t length = (size_t)(sign - line->text);
  while (length > 0 && strchr(" \t", line->text[length - 1]))
    length--;
  sign += 1 + strspn(sign + 1, " \t");
  const vlCameraName name = {line->text, sign, line->number};
  return check_name(file, format, &name, length, record);
}

vlResult vl_camera_check_lines(const vlCameraFile *file, const vlCameraFormat *format,
                               const char *text, size_t size, vlCameraRecord *record) {
  vlCameraLines line = {.at = text, .end = text + size};
  vlResult result = VL_OK;
  while (result == VL_OK && vl_camera_next_line(&line))
    result = check_line(file, format, &line, record);
  return result;
}
