/* import/obj/obj.c: Wavefront OBJ: statements become arrays of corners. See obj.h. */
#include "import/obj/obj.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/free.h"
#include "base/text.h"
#include "image/pixel.h"
#include "import/far.h"
#include "import/import.h"
#include "import/pbrt/decimal.h"
#include "import/plain.h"
#include "math/double3.h"

enum { MAX_PARTS = 4096, MAX_MATERIALS = 1 << 20 };
enum { REPORTED_CURVES = 1, REPORTED_UNKNOWN = 2 };

/* ---- errors ------------------------------------------------------------------------------ */

bool vl_obj_fail(vlObj *obj, const char *format, ...) {
  char text[500];
  VL_FORMAT(text, format);
  uint32_t column = obj->line ? (uint32_t)(obj->at - obj->line_start) + 1 : 0;
  return vl_scene_fail(obj->scene, VL_ERROR_SCENE, (vlSource){obj->path, obj->line, column},
                       "%s", text);
}

static void warn(vlObj *obj, vlLogLevel level, vlResult code, const char *text) {
  vlError where;
  vl_fail_at(&where, code, obj->path, obj->line, obj->line ? 1 : 0, " ");
  vl_log(obj->context, level, &where, "%s", text);
}

void vl_obj_warn(vlObj *obj, vlLogLevel level, const char *format, ...) {
  char text[500];
  VL_FORMAT(text, format);
  warn(obj, level, VL_ERROR_SCENE, text);
}

void vl_obj_warn_missing(vlObj *obj, const char *format, ...) {
  char text[500];
  VL_FORMAT(text, format);
  warn(obj, VL_LOG_WARNING, VL_ERROR_MISSING, text);
}

bool vl_obj_fail_memory(vlObj *obj) {
  return vl_scene_fail_memory(obj->scene);
}

/* ---- statements -------------------------------------------------------------------------- */

static bool is_blank(char c) {
  return c != '\n' && vl_is_blank(c);
}

bool vl_obj_statement(vlObj *obj, char **from, char *end) {
  obj->nothing[0] = 0;
  obj->line_start = obj->at = obj->end = obj->nothing;
  if (*from >= end)
    return false;
  char *p = *from, *stop = p;
  uint32_t lines = 0;
  for (;;) {
    stop = memchr(stop, '\n', (size_t)(end - stop));
    lines++;
    if (!stop)
      break;
    char *before = stop - 1;
    if (before >= p && *before == '\r')
      before--;
    if (before < p || *before != '\\')
      break;
    memset(before, ' ', (size_t)(stop + 1 - before)); /* a backslash continues the line */
    stop++;
    if (stop >= end) {
      stop = NULL;
      break;
    }
  }
  obj->line_start = obj->at = p;
  obj->end = stop ? stop : end;
  obj->line += 1 + obj->more_lines;
  obj->more_lines = lines - 1;
  *from = stop ? stop + 1 : end;
  /* A comment extends to the end of the line. Names may contain #, so a # counts only at the
   * start or after a blank. */
  for (char *hash = p; (hash = memchr(hash, '#', (size_t)(obj->end - hash))); hash++)
    if (hash == p || is_blank(hash[-1])) {
      obj->end = hash;
      break;
    }
  return true;
}

static void skip_blanks(vlObj *obj) {
  while (obj->at < obj->end && is_blank(*obj->at))
    obj->at++;
}

size_t vl_obj_word(vlObj *obj, const char **word) {
  skip_blanks(obj);
  *word = obj->at;
  while (obj->at < obj->end && !is_blank(*obj->at))
    obj->at++;
  return (size_t)(obj->at - *word);
}

size_t vl_obj_next_word(vlObj *obj, const char **word) {
  char *at = obj->at;
  size_t n = vl_obj_word(obj, word);
  obj->at = at;
  return n;
}

char *vl_obj_rest(vlObj *obj) {
  skip_blanks(obj);
  char *end = obj->end;
  while (end > obj->at && is_blank(end[-1]))
    end--;
  *end = 0; /* replaces the newline, the # of a comment, a blank or the terminating zero */
  return obj->at;
}

bool vl_obj_numbers(vlObj *obj, uint32_t max, double *values, uint32_t *count) {
  *count = 0;
  for (;;) {
    skip_blanks(obj);
    if (obj->at >= obj->end || *count == max)
      return true;
    const char *p = obj->at;
    if (!vl_number_scan(&p, obj->end, &values[*count]) || (p < obj->end && !is_blank(*p)))
      return false;
    if (!isfinite((float)values[*count]))
      return false;
    obj->at += p - obj->at;
    ++*count;
  }
}

static bool numbers(vlObj *obj, const char *what, uint32_t min, uint32_t max, double *values,
                    uint32_t *count) {
  if (!vl_obj_numbers(obj, max, values, count)) {
    const char *word;
    size_t n = vl_obj_next_word(obj, &word);
    return vl_obj_fail(obj, "%s: \"%s\" is not a finite number", what,
                       vl_short_text_of(word, n).text);
  }
  return *count >= min || vl_obj_fail(obj, "%s: %u numbers, %u are needed", what, *count, min);
}

bool vl_obj_push(vlObj *obj, vlObjRows *rows, uint32_t size, const double *row,
                 const char *what) {
  if (rows->count / size >= 0x7ffffff0u)
    return vl_obj_fail(obj, "too many %s", what);
  if (!VL_RESERVE(obj->context, rows, size))
    return vl_obj_fail_memory(obj);
  for (uint32_t i = 0; i < size; i++)
    rows->items[rows->count++] = (float)row[i];
  return true;
}

/* ---- vertices ---------------------------------------------------------------------------- */

static float linear_from_srgb(double v) {
  double x = v < 0 ? 0 : v > 1 ? 1 : v;
  return (float)(vl_srgb_to_linear(x));
}

/* x y z, x y z w, or x y z r g b (sRGB, as programs write it). */
static bool read_vertex(vlObj *obj) {
  double v[7] = {0};
  uint32_t count;
  if (!numbers(obj, "v", 3, 7, v, &count))
    return false;
  size_t before = obj->positions.count;
  if (!before && fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2]))) >= VL_MIN_FAR)
    vl_obj_find_origin(obj);
  vl_sub3(v, obj->origin, v);
  if (!vl_obj_push(obj, &obj->positions, 3, v, "vertices"))
    return false;
  vl_extent_grow(&obj->box, v);
  if (count < 6 && obj->colors.count == 0)
    return true;
  size_t missing = before - obj->colors.count;
  if (!VL_RESERVE(obj->context, &obj->colors, missing + 3))
    return vl_obj_fail_memory(obj);
  for (size_t i = 0; i < missing; i++)
    obj->colors.items[obj->colors.count++] = 1.0f;
  for (int i = 0; i < 3; i++)
    obj->colors.items[obj->colors.count++] = count < 6 ? 1.0f : linear_from_srgb(v[3 + i]);
  return true;
}

/* Permissive: a normal or uv of "nan" or "inf" is kept as NaN, to be repaired. */
static bool is_broken(vlObj *obj, double v[3]) {
  const char *word;
  char *at = obj->at;
  bool broken = false;
  if (!obj->permissive)
    return false;
  for (size_t n = vl_obj_word(obj, &word); n && !broken; n = vl_obj_word(obj, &word)) {
    size_t sign = word[0] == '-' || word[0] == '+';
    broken = n >= sign + 3 && (strncasecmp(word + sign, "nan", 3) == 0 ||
                               strncasecmp(word + sign, "inf", 3) == 0);
  }
  obj->at = at;
  if (broken)
    v[0] = v[1] = v[2] = NAN;
  return broken;
}

/* Reads a uv or a normal, of which `size` numbers are kept. */
static bool read_row(vlObj *obj, const char *what, uint32_t min, vlObjRows *rows, uint32_t size,
                     const char *plural) {
  double v[3] = {0, 0, 0};
  uint32_t count;
  return (is_broken(obj, v) || numbers(obj, what, min, 3, v, &count)) &&
         vl_obj_push(obj, rows, size, v, plural);
}

/* ---- faces ------------------------------------------------------------------------------- */

/* Reads an index: from 1 upwards, or from -1 downwards, counted from the last element. *index
 * 0: the field is empty. */
static bool read_index(vlObj *obj, const char *what, size_t count, uint32_t *index) {
  char *p = obj->at;
  bool negative = p < obj->end && *p == '-';
  if (negative)
    p++;
  uint64_t value = 0;
  char *digits = p;
  for (; p < obj->end && *p >= '0' && *p <= '9'; p++)
    if (value < 1u << 31)
      value = value * 10 + (uint64_t)(*p - '0');
  *index = 0;
  if (p == digits && !negative)
    return true;
  if (value == 0 || value > count)
    return vl_obj_fail(obj, "f: names %s %s%llu, but there are %zu so far", what,
                       negative ? "-" : "", (unsigned long long)value, count);
  *index = (uint32_t)(negative ? count + 1 - value : value);
  obj->at = p;
  return true;
}

static bool read_corner(vlObj *obj, vlObjCorner *c) {
  char *start = obj->at;
  *c = (vlObjCorner){0, 0, 0};
  if (!read_index(obj, "vertex", obj->positions.count / 3, &c->v))
    return false;
  bool fine = c->v != 0;
  if (fine && obj->at < obj->end && *obj->at == '/') {
    obj->at++;
    if (!read_index(obj, "uv", obj->uvs.count / 2, &c->vt))
      return false;
    if (obj->at < obj->end && *obj->at == '/') {
      obj->at++;
      if (!read_index(obj, "normal", obj->normals.count / 3, &c->vn))
        return false;
    }
  }
  if (fine && (obj->at >= obj->end || is_blank(*obj->at)))
    return true;
  const char *word;
  obj->at = start;
  size_t n = vl_obj_next_word(obj, &word);
  return vl_obj_fail(obj, "f: \"%s\" is no corner (v, v/vt, v//vn or v/vt/vn)",
                     vl_short_text_of(word, n).text);
}

/* Starts a part for successive faces with the same material and object. From MAX_PARTS parts
 * on, all faces of a material form one part. */
static bool open_part(vlObj *obj) {
  if (obj->part_open)
    return true;
  vlObjMaterial *m = &obj->materials.items[obj->material];
  obj->part_open = true;
  if (obj->parts.count >= MAX_PARTS && m->part) {
    obj->part = m->part - 1;
    obj->parts.items[obj->part].object = 0;
    return true;
  }
  vlObjPart *part = VL_PUSH(obj->context, &obj->parts);
  if (!part)
    return vl_obj_fail_memory(obj);
  part->material = obj->material;
  part->object = (uint32_t)(obj->objects.count ? obj->objects.count - 1 : 0);
  part->line = obj->line;
  m->part = (uint32_t)obj->parts.count;
  obj->part = m->part - 1;
  return true;
}

static bool read_face(vlObj *obj) {
  obj->polygon.count = 0;
  for (;;) {
    skip_blanks(obj);
    if (obj->at >= obj->end)
      break;
    vlObjCorner *c = VL_PUSH(obj->context, &obj->polygon);
    if (!c)
      return vl_obj_fail_memory(obj);
    if (!read_corner(obj, c))
      return false;
  }
  size_t n = obj->polygon.count;
  uint32_t triangles;
  if (n < 3)
    return vl_obj_fail(obj, "f: %zu corners, a face needs 3", n);
  if (!open_part(obj) || !vl_obj_triangulate(obj, &triangles))
    return false;
  vlObjPart *part = &obj->parts.items[obj->part];
  if (obj->triangle_part.count + triangles > 0x3fffffffu)
    return vl_obj_fail(obj, "too many faces");
  if (!VL_RESERVE(obj->context, &obj->corners, 3 * (size_t)triangles) ||
      !VL_RESERVE(obj->context, &obj->triangle_part, triangles) ||
      !VL_RESERVE(obj->context, &obj->triangle_smooth, triangles))
    return vl_obj_fail_memory(obj);
  for (uint32_t i = 0; i < 3 * triangles; i++) {
    vlObjCorner c = obj->polygon.items[obj->ears.items[i]];
    obj->corners.items[obj->corners.count++] = c;
    part->normals |= c.vn != 0 || obj->smooth != 0;
    part->uvs |= c.vt != 0;
  }
  for (uint32_t i = 0; i < triangles; i++) {
    obj->triangle_part.items[obj->triangle_part.count++] = obj->part;
    obj->triangle_smooth.items[obj->triangle_smooth.count++] = obj->smooth;
  }
  part->triangles += triangles;
  return true;
}

/* ---- what faces are of ------------------------------------------------------------------- */

uint32_t vl_obj_material(vlObj *obj, const char *name) {
  uint32_t index = (uint32_t)obj->materials.count;
  if (vl_names_find(&obj->material_names, name, &index))
    return index;
  if (index >= MAX_MATERIALS) {
    vl_obj_fail(obj, "too many materials");
    return UINT32_MAX;
  }
  if (!vl_scene_copy_string(obj->scene, &name))
    return UINT32_MAX;
  vlObjMaterial *m = VL_PUSH(obj->context, &obj->materials);
  if (!m || !vl_names_add(obj->context, &obj->material_names, name, index)) {
    vl_obj_fail_memory(obj);
    return UINT32_MAX;
  }
  m->name = name;
  m->mtl = vl_mtl_default();
  return index;
}

static bool use_material(vlObj *obj) {
  uint32_t index = vl_obj_material(obj, vl_obj_rest(obj));
  if (index == UINT32_MAX)
    return false;
  obj->part_open = obj->part_open && obj->material == index;
  obj->material = index;
  if (!obj->materials.items[index].line)
    obj->materials.items[index].line = obj->line;
  return true;
}

static bool use_smoothing(vlObj *obj) {
  double value;
  uint32_t count;
  obj->smooth = vl_obj_numbers(obj, 1, &value, &count) && count && value >= 1 && value < 4e9
                    ? (uint32_t)value
                    : 0;
  const char *word;
  if (vl_obj_next_word(obj, &word) == 2 && memcmp(word, "on", 2) == 0)
    obj->smooth = 1;
  return true;
}

static void once(vlObj *obj, uint32_t bit, const char *what, size_t length) {
  static const char *const texts[2] = {"curves and surfaces are not drawn",
                                       "unknown statement, ignored (as others like it)"};
  if (obj->reported & bit)
    return;
  obj->reported |= bit;
  vl_obj_warn(obj, VL_LOG_WARNING, "\"%s\": %s", vl_short_text_of(what, length).text,
              texts[bit >> 1]);
}

/* Index 0 stands for faces before the first o or g. A new object has no group. */
static bool open_object(vlObj *obj, bool group) {
  const char *name = vl_obj_rest(obj);
  obj->part_open = false;
  if (!VL_RESERVE(obj->context, &obj->objects, 2))
    return vl_obj_fail_memory(obj);
  if (!obj->objects.count)
    obj->objects.items[obj->objects.count++] = (vlObjObject){NULL, NULL};
  const char *object = group ? obj->objects.items[obj->objects.count - 1].object : name;
  if (!vl_scene_copy_string(obj->scene, &name))
    return false;
  obj->objects.items[obj->objects.count++] =
      (vlObjObject){.object = group ? object : name, .group = group ? name : NULL};
  return true;
}

static bool read_statement(vlObj *obj) {
  static const char curves[] =
      "vp cstype deg bmat step curv curv2 surf parm trim hole scrv sp end con ctech stech";
  static const char silent[] =
      "mg bevel c_interp d_interp lod shadow_obj trace_obj maplib usemap";
  const char *word;
  size_t n = vl_obj_word(obj, &word);
  if (n == 0)
    return true;
  if (n == 1)
    switch (*word) {
      case 'v':
        return read_vertex(obj);
      case 'f':
        return read_face(obj);
      case 's':
        return use_smoothing(obj);
      case 'g':
      case 'o':
        return open_object(obj, *word == 'g');
      case 'l':
      case 'p':
        return vl_obj_read_marks(obj, *word == 'l');
      default:
        break;
    }
  if (n == 2 && word[0] == 'v' && word[1] == 't')
    return read_row(obj, "vt", 1, &obj->uvs, 2, "uvs");
  if (n == 2 && word[0] == 'v' && word[1] == 'n')
    return read_row(obj, "vn", 3, &obj->normals, 3, "normals");
  if (n == 2 && word[0] == 'f' && word[1] == 'o')
    return read_face(obj); /* "fo": the obsolete form of "f" */
  if (n == 6 && memcmp(word, "usemtl", 6) == 0)
    return use_material(obj);
  if (n == 6 && memcmp(word, "mtllib", 6) == 0)
    return vl_obj_read_libraries(obj);
  if (vl_has_word_of(silent, word, n))
    return true;
  if (vl_has_word_of(curves, word, n)) {
    once(obj, REPORTED_CURVES, word, n);
    return true;
  }
  for (size_t i = 0; i < n; i++)
    if ((unsigned char)word[i] < 32)
      return vl_obj_fail(obj, "not an OBJ file: byte %d here", (unsigned char)word[i]);
  once(obj, REPORTED_UNKNOWN, word, n);
  return true;
}

static void free_all(vlObj *obj) {
  VL_FREE(obj->context, obj->positions.items, obj->colors.items, obj->uvs.items,
          obj->normals.items, obj->corners.items, obj->triangle_part.items,
          obj->triangle_smooth.items, obj->parts.items, obj->objects.items,
          obj->materials.items, obj->marks.items, obj->polygon.items, obj->ears.items,
          (void *)obj->libraries.items, obj->material_names.slots, obj);
}

vlResult vl_import_obj(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error) {
  vl_import_plain_settings(scene);
  char *data;
  size_t size;
  vlError reading;
  vl_error_clear(&reading);
  vlResult r = vl_file_read_given(scene->context, path, true, &data, &size, &reading);
  if (r != VL_OK) {
    vl_scene_fail(scene, r, (vlSource){0}, "%s", reading.message);
    return vl_scene_result(scene, error);
  }
  vlObj *obj = vl_alloc_zero(scene->context, 1, sizeof *obj);
  if (!obj) {
    vl_free(scene->context, data);
    vl_scene_fail_memory(scene);
    return vl_scene_result(scene, error);
  }
  obj->context = scene->context;
  obj->scene = scene;
  obj->path = path;
  if (def) {
    obj->permissive = def->permissive;
    obj->strict = def->strict;
    obj->search_path = def->search_path;
  }
  obj->data_end = data + size;
  obj->box = vl_extent_nothing;
  bool fine = vl_obj_material(obj, "") == 0;
  if (fine)
    obj->materials.items[0].defined = true;
  char *from = size >= 3 && memcmp(data, "\xef\xbb\xbf", 3) == 0 ? data + 3 : data;
  while (fine && vl_obj_statement(obj, &from, data + size))
    fine =
        read_statement(obj) && !(obj->line % 1024 == 0 &&
                                 vl_scene_stopped(scene, (double)(from - data) / (double)size));
  if (fine) {
    obj->line = 0;
    fine = vl_obj_add_shapes(obj);
    if (fine && obj->marks.count)
      fine = vl_obj_add_marks(obj);
  }
  vl_repairs_report(obj->context, &obj->repairs, path);
  if (fine && obj->parts.count + obj->marks.count == 0)
    vl_obj_fail(obj, "it has no faces, points (p) or lines (l): there is nothing to draw");
  free_all(obj);
  vl_free(scene->context, data);
  return vl_scene_result(scene, error);
}

/* ---- names of objects (o), groups (g) and materials become labels of shapes -------------- */

/* A mesh of several materials is one part per material. */
static bool has_neighbour(const vlObj *obj, size_t part) {
  const uint32_t own = obj->parts.items[part].object;
  return (part > 0 && obj->parts.items[part - 1].object == own) ||
         (part + 1 < obj->parts.count && obj->parts.items[part + 1].object == own);
}

bool vl_obj_label(vlObj *obj, vlNameTable *names, size_t part, vlLabel *label) {
  const vlObjPart *p = &obj->parts.items[part];
  const vlObjObject none = {NULL, NULL},
                    *o = p->object ? &obj->objects.items[p->object] : &none;
  const char *material = obj->materials.items[p->material].name;
  char name[VL_LABEL_SIZE] = "", path[VL_LABEL_SIZE];
  vl_label_append(name, o->object);
  if (!o->object || (o->group && !vl_text_is(o->object, o->group)))
    vl_label_append(name, o->group);
  memcpy(path, name, sizeof path);
  vl_label_append(path, material);
  if (!*name || has_neighbour(obj, part))
    vl_label_append(name, material);
  if (!*name)
    vl_label_of_file(obj->path, name);
  *label = (vlLabel){.path = *path ? path : NULL};
  return vl_label_make_unique(obj->scene, names, name, p->line, &label->name) &&
         vl_scene_copy_string(obj->scene, &label->path);
}
