/* import/ply/ply_header.c: reads the header of a PLY file into a table of elements and
 * properties, and reports errors. */
#include <strings.h>

#include "base/text.h"
#include "import/ply/ply_reader.h"

bool vl_ply_fail(vlPlyReader *r, const char *format, ...) {
  char text[400];
  VL_FORMAT(text, format);
  vl_fail_at(r->error, VL_ERROR_SCENE, r->name, r->line, r->line ? 1 : 0, "PLY: %s", text);
  return false;
}

bool vl_ply_fail_memory(vlPlyReader *r) {
  vl_fail_memory(r->error);
  return false;
}

bool vl_ply_goes_on(vlPlyReader *r, uint64_t row) {
  if (row % 16384 != 0 || !vl_task_stopped(r->options->task, NULL, 0))
    return true;
  vl_fail(r->error, VL_CANCELLED, "stopped");
  return false;
}

/* ---- header ------------------------------------------------------------------------------ */

typedef struct Words {
  char text[1024];
  char *word[8];
  uint32_t count;
} Words;

/* The next line, split into words. */
static bool next_line(vlPlyReader *r, Words *w) {
  const char *start = r->at;
  while (r->at < r->end && *r->at != '\n' && *r->at != '\r')
    r->at++;
  if (r->at >= r->end)
    return vl_ply_fail(r, "the header has no end_header");
  size_t length = (size_t)(r->at - start);
  r->at += r->at[0] == '\r' && r->at + 1 < r->end && r->at[1] == '\n' ? 2 : 1;
  r->line++;
  if (length >= sizeof w->text)
    length = sizeof w->text - 1;
  memcpy(w->text, start, length);
  w->text[length] = 0;
  w->count = 0;
  char *p = w->text;
  for (;;) {
    while (*p == ' ' || *p == '\t')
      *p++ = 0;
    if (!*p || w->count == 8)
      return true;
    w->word[w->count++] = p;
    while (*p && *p != ' ' && *p != '\t')
      p++;
  }
}

static bool find_type(const char *name, vlPlyType *type) {
  static const char *const names[VL_PLY_TYPES] = {
      "char int8", "uchar uint8", "short int16",   "ushort uint16",
      "int int32", "uint uint32", "float float32", "double float64"};
  for (int t = 0; t < VL_PLY_TYPES; t++)
    if (vl_has_word(names[t], name)) {
      *type = (vlPlyType)t;
      return true;
    }
  return false;
}

static const char *const role_names[VL_PLY_ROLES] = {[VL_PLY_NOTHING] = "",
                                                     [VL_PLY_X] = "x",
                                                     [VL_PLY_Y] = "y",
                                                     [VL_PLY_Z] = "z",
                                                     [VL_PLY_NX] = "nx",
                                                     [VL_PLY_NY] = "ny",
                                                     [VL_PLY_NZ] = "nz",
                                                     [VL_PLY_U] = "u s texture_u texture_s",
                                                     [VL_PLY_V] = "v t texture_v texture_t",
                                                     [VL_PLY_RED] = "red r diffuse_red",
                                                     [VL_PLY_GREEN] = "green g diffuse_green",
                                                     [VL_PLY_BLUE] = "blue b diffuse_blue",
                                                     [VL_PLY_ALPHA] = "alpha",
                                                     [VL_PLY_INDICES] = ""};

static vlPlyRole vertex_role(const char *name) {
  for (int role = 0; role < VL_PLY_ROLES; role++)
    if (vl_has_word(role_names[role], name))
      return (vlPlyRole)role;
  return VL_PLY_NOTHING;
}

bool vl_ply_fail_number(vlPlyReader *r, uint64_t vertex, vlPlyRole role, double value) {
  const char *names = role_names[role];
  return vl_ply_fail(r, "vertex %llu: %.*s is not finite (%g)", (unsigned long long)vertex,
                     (int)strcspn(names, " "), names, value);
}

static bool read_element(vlPlyReader *r, const Words *w) {
  if (w->count != 3)
    return vl_ply_fail(r, "an element line has the form \"element name count\"");
  if (r->element_count == VL_PLY_MAX_ELEMENTS)
    return vl_ply_fail(r, "more than %d elements", VL_PLY_MAX_ELEMENTS);
  vlPlyElement *e = &r->elements[r->element_count++];
  memset(e, 0, sizeof *e);
  snprintf(e->name, sizeof e->name, "%s", w->word[1]);
  e->kind = vl_text_is(w->word[1], "vertex")      ? VL_PLY_VERTEX
            : vl_text_is(w->word[1], "face")      ? VL_PLY_FACE
            : vl_text_is(w->word[1], "tristrips") ? VL_PLY_STRIPS
                                                  : VL_PLY_OTHER;
  const char *p = w->word[2];
  for (; *p >= '0' && *p <= '9' && e->count < 1000000000000000ull; p++)
    e->count = e->count * 10 + (uint64_t)(*p - '0');
  if (*p || p == w->word[2])
    return vl_ply_fail(r, "element %s: \"%s\" is not a count", vl_short_text(e->name).text,
                       vl_short_text(w->word[2]).text);
  for (uint32_t i = 0; i + 1 < r->element_count; i++)
    if (e->kind != VL_PLY_OTHER && r->elements[i].kind == e->kind)
      return vl_ply_fail(r, "element %s appears twice", e->name);
  return true;
}

static bool read_property(vlPlyReader *r, const Words *w) {
  if (r->element_count == 0)
    return vl_ply_fail(r, "a property before any element");
  vlPlyElement *e = &r->elements[r->element_count - 1];
  if (e->property_count == VL_PLY_MAX_PROPERTIES)
    return vl_ply_fail(r, "element %s has more than %d properties", e->name,
                       VL_PLY_MAX_PROPERTIES);
  vlPlyProperty *p = &e->properties[e->property_count++];
  bool list = w->count == 5 && vl_text_is(w->word[1], "list");
  *p = (vlPlyProperty){.is_list = list};
  if (!list && w->count != 3)
    return vl_ply_fail(r,
                       "a property line has the form \"property type name\" or \"property list "
                       "type type name\"");
  if (!find_type(w->word[list ? 3 : 1], &p->type))
    return vl_ply_fail(r, "unknown type \"%s\"", vl_short_text(w->word[list ? 3 : 1]).text);
  if (list && !find_type(w->word[2], &p->count_type))
    return vl_ply_fail(r, "unknown type \"%s\"", vl_short_text(w->word[2]).text);
  if (list && p->count_type >= VL_PLY_F32)
    return vl_ply_fail(r, "the length of a list must be of an integer type");
  const char *name = w->word[list ? 4 : 2];
  if (e->kind == VL_PLY_VERTEX && !list)
    p->role = vertex_role(name);
  if (e->kind == VL_PLY_FACE && !list && r->options->given && vertex_role(name) >= VL_PLY_RED)
    p->role = vertex_role(name);
  if ((e->kind == VL_PLY_FACE || e->kind == VL_PLY_STRIPS) && list &&
      (vl_text_is(name, "vertex_indices") || vl_text_is(name, "vertex_index"))) {
    if (p->type >= VL_PLY_F32)
      return vl_ply_fail(r, "%s must be of an integer type", name);
    p->role = VL_PLY_INDICES;
  }
  e->has_list = e->has_list || list;
  return true;
}

static bool read_format(vlPlyReader *r, const Words *w) {
  static const char *const formats[] = {[VL_PLY_ASCII] = "ascii",
                                        [VL_PLY_LITTLE] = "binary_little_endian",
                                        [VL_PLY_BIG] = "binary_big_endian"};
  for (size_t i = 0; i < VL_LENGTH(formats) && w->count == 3; i++)
    if (vl_text_is(formats[i], w->word[1])) {
      r->format = (vlPlyFormat)i;
      return true;
    }
  return vl_ply_fail(
      r, "unknown format \"%s\" (known: ascii, binary_little_endian, binary_big_endian)",
      vl_short_text(w->count > 1 ? w->word[1] : "").text);
}

/* The bytes of a row; for a text file a lower bound of two bytes, a digit and a blank, per
 * value. */
static void measure(const vlPlyReader *r, vlPlyElement *e) {
  e->row_size = 0;
  for (uint32_t i = 0; i < e->property_count; i++) {
    const vlPlyProperty *p = &e->properties[i];
    e->row_size +=
        r->format == VL_PLY_ASCII ? 2 : vl_ply_type_size(p->is_list ? p->count_type : p->type);
  }
}

bool vl_ply_read_header(vlPlyReader *r) {
  Words w;
  bool has_format = false;
  r->line = 0;
  if (r->end - r->at < 4 || memcmp(r->at, "ply", 3) != 0 ||
      (r->at[3] != '\n' && r->at[3] != '\r')) {
    r->line = 1;
    return vl_ply_fail(r, "the file does not begin with \"ply\"");
  }
  if (!next_line(r, &w))
    return false;
  for (;;) {
    if (!next_line(r, &w))
      return false;
    bool fine = true;
    if (w.count == 0 || vl_text_is(w.word[0], "comment") || vl_text_is(w.word[0], "obj_info"))
      continue;
    /* Blender 2.4x wrote "Created by Blender3D ..." without the word comment. */
    if (w.count > 1 && strcasecmp(w.word[0], "created") == 0 &&
        strcasecmp(w.word[1], "by") == 0)
      continue;
    if (vl_text_is(w.word[0], "end_header"))
      break;
    if (vl_text_is(w.word[0], "format"))
      fine = has_format = read_format(r, &w);
    else if (vl_text_is(w.word[0], "element"))
      fine = read_element(r, &w);
    else if (vl_text_is(w.word[0], "property"))
      fine = read_property(r, &w);
    else
      fine = vl_ply_fail(r, "unknown word \"%s\" in the header", vl_short_text(w.word[0]).text);
    if (!fine)
      return false;
  }
  if (!has_format)
    return vl_ply_fail(r, "the header has no format line");
  for (uint32_t i = 0; i < r->element_count; i++)
    measure(r, &r->elements[i]);
  return true;
}
