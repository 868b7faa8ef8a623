/* import/ply.c: see ply.h. The header becomes a small table of elements and properties; then the body is walked once.
 */
#include "import/ply.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/array.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "import/token.h"

enum { MAX_ELEMENTS = 32, MAX_PROPERTIES = 256 };

typedef enum Type { I8, U8, I16, U16, I32, U32, F32, F64, TYPES } Type;
static const uint32_t type_size[TYPES] = {1, 1, 2, 2, 4, 4, 4, 8};

typedef enum Format { ASCII, LITTLE, BIG } Format;

/* What a property is to us. */
typedef enum Role { NOTHING, X, Y, Z, NX, NY, NZ, U, V, RED, GREEN, BLUE, ALPHA, INDICES, ROLES } Role;

typedef struct Property {
  Type type, count_type;
  bool is_list;
  Role role;
} Property;

typedef enum ElementKind { OTHER, VERTEX, FACE } ElementKind;

typedef struct Element {
  ElementKind kind;
  char name[32];
  uint64_t count;
  Property properties[MAX_PROPERTIES];
  uint32_t property_count;
  bool has_list;
  uint64_t row_size; /* bytes of a row: exact when there is no list in a binary file, else at least so many */
} Element;

typedef struct Reader {
  vlContext *context;
  const char *name;
  const char *at, *end;
  uint32_t line; /* of text; 0 in a binary body */
  Format format;
  Element *elements;
  uint32_t element_count;
  vlPlyMesh *mesh;
  bool has_vertices;
  size_t triangle_capacity, quad_capacity; /* numbers */
  VL_ARRAY(uint32_t) face;
  vlError *error;
} Reader;

static bool fail(Reader *r, const char *format, ...) __attribute__((format(printf, 2, 3)));
static bool fail(Reader *r, const char *format, ...) {
  char text[400];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  vl_fail_at(r->error, VL_ERROR_SCENE, r->name, r->line, r->line ? 1 : 0, "PLY: %s", text);
  return false;
}

static bool fail_memory(Reader *r) {
  vl_fail_memory(r->error);
  return false;
}

/* ---- header ----------------------------------------------------------------------------------------------------- */

typedef struct Words {
  char text[1024];
  char *word[8];
  uint32_t count;
} Words;

/* The next line, cut into words. */
static bool next_line(Reader *r, Words *w) {
  const char *start = r->at;
  while (r->at < r->end && *r->at != '\n' && *r->at != '\r') r->at++;
  if (r->at >= r->end) return fail(r, "the header has no end_header");
  size_t length = (size_t)(r->at - start);
  r->at += r->at[0] == '\r' && r->at + 1 < r->end && r->at[1] == '\n' ? 2 : 1;
  r->line++;
  if (length >= sizeof w->text) length = sizeof w->text - 1;
  memcpy(w->text, start, length);
  w->text[length] = 0;
  w->count = 0;
  char *p = w->text;
  for (;;) {
    while (*p == ' ' || *p == '\t') *p++ = 0;
    if (!*p || w->count == 8) return true;
    w->word[w->count++] = p;
    while (*p && *p != ' ' && *p != '\t') p++;
  }
}

static bool find_type(const char *name, Type *type) {
  static const char *const names[2][TYPES] = {
      {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"},
      {"int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"}};
  for (int i = 0; i < 2; i++)
    for (int t = 0; t < TYPES; t++)
      if (strcmp(name, names[i][t]) == 0) return *type = (Type)t, true;
  return false;
}

static Role vertex_role(const char *name) {
  static const struct {
    const char *name;
    Role role;
  } roles[] = {{"x", X},
               {"y", Y},
               {"z", Z},
               {"nx", NX},
               {"ny", NY},
               {"nz", NZ},
               {"u", U},
               {"v", V},
               {"s", U},
               {"t", V},
               {"texture_u", U},
               {"texture_v", V},
               {"texture_s", U},
               {"texture_t", V},
               {"red", RED},
               {"green", GREEN},
               {"blue", BLUE},
               {"alpha", ALPHA},
               {"r", RED},
               {"g", GREEN},
               {"b", BLUE},
               {"diffuse_red", RED},
               {"diffuse_green", GREEN},
               {"diffuse_blue", BLUE}};
  for (size_t i = 0; i < sizeof roles / sizeof *roles; i++)
    if (strcmp(name, roles[i].name) == 0) return roles[i].role;
  return NOTHING;
}

static bool read_element(Reader *r, const Words *w) {
  if (w->count != 3) return fail(r, "an element line has the form \"element name count\"");
  if (r->element_count == MAX_ELEMENTS) return fail(r, "more than %d elements", MAX_ELEMENTS);
  Element *e = &r->elements[r->element_count++];
  memset(e, 0, sizeof *e);
  snprintf(e->name, sizeof e->name, "%s", w->word[1]);
  e->kind = strcmp(w->word[1], "vertex") == 0 ? VERTEX : strcmp(w->word[1], "face") == 0 ? FACE : OTHER;
  const char *p = w->word[2];
  for (; *p >= '0' && *p <= '9' && e->count < 1000000000000000ull; p++) e->count = e->count * 10 + (uint64_t)(*p - '0');
  if (*p || p == w->word[2]) return fail(r, "element %.30s: \"%.30s\" is not a count", e->name, w->word[2]);
  for (uint32_t i = 0; i + 1 < r->element_count; i++)
    if (e->kind != OTHER && r->elements[i].kind == e->kind) return fail(r, "element %s appears twice", e->name);
  return true;
}

static bool read_property(Reader *r, const Words *w) {
  if (r->element_count == 0) return fail(r, "a property before any element");
  Element *e = &r->elements[r->element_count - 1];
  if (e->property_count == MAX_PROPERTIES)
    return fail(r, "element %s has more than %d properties", e->name, MAX_PROPERTIES);
  Property *p = &e->properties[e->property_count++];
  bool list = w->count == 5 && strcmp(w->word[1], "list") == 0;
  *p = (Property){.is_list = list};
  if (!list && w->count != 3)
    return fail(r, "a property line has the form \"property type name\" or \"property list type type name\"");
  if (!find_type(w->word[list ? 3 : 1], &p->type)) return fail(r, "unknown type \"%.30s\"", w->word[list ? 3 : 1]);
  if (list && !find_type(w->word[2], &p->count_type)) return fail(r, "unknown type \"%.30s\"", w->word[2]);
  if (list && p->count_type >= F32) return fail(r, "the length of a list must be of an integer type");
  const char *name = w->word[list ? 4 : 2];
  if (e->kind == VERTEX && !list) p->role = vertex_role(name);
  if (e->kind == FACE && list && (strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0)) {
    if (p->type >= F32) return fail(r, "%s must be of an integer type", name);
    p->role = INDICES;
  }
  e->has_list = e->has_list || list;
  return true;
}

static bool read_format(Reader *r, const Words *w) {
  if (w->count == 3 && strcmp(w->word[1], "ascii") == 0)
    r->format = ASCII;
  else if (w->count == 3 && strcmp(w->word[1], "binary_little_endian") == 0)
    r->format = LITTLE;
  else if (w->count == 3 && strcmp(w->word[1], "binary_big_endian") == 0)
    r->format = BIG;
  else
    return fail(r, "unknown format \"%.40s\" (known: ascii, binary_little_endian, binary_big_endian)",
                w->count > 1 ? w->word[1] : "");
  return true;
}

/* A row's bytes; in text each value takes a digit and a blank at least. */
static void measure(const Reader *r, Element *e) {
  e->row_size = 0;
  for (uint32_t i = 0; i < e->property_count; i++) {
    const Property *p = &e->properties[i];
    e->row_size += r->format == ASCII ? 2 : type_size[p->is_list ? p->count_type : p->type];
  }
}

static bool read_header(Reader *r) {
  Words w;
  bool has_format = false;
  r->line = 0;
  if (r->end - r->at < 4 || memcmp(r->at, "ply", 3) != 0 || (r->at[3] != '\n' && r->at[3] != '\r'))
    return r->line = 1, fail(r, "the file does not begin with \"ply\"");
  if (!next_line(r, &w)) return false;
  for (;;) {
    if (!next_line(r, &w)) return false;
    bool fine = true;
    if (w.count == 0 || strcmp(w.word[0], "comment") == 0 || strcmp(w.word[0], "obj_info") == 0) continue;
    if (strcmp(w.word[0], "end_header") == 0) break;
    if (strcmp(w.word[0], "format") == 0)
      fine = has_format = read_format(r, &w);
    else if (strcmp(w.word[0], "element") == 0)
      fine = read_element(r, &w);
    else if (strcmp(w.word[0], "property") == 0)
      fine = read_property(r, &w);
    else
      fine = fail(r, "unknown word \"%.40s\" in the header", w.word[0]);
    if (!fine) return false;
  }
  if (!has_format) return fail(r, "the header has no format line");
  for (uint32_t i = 0; i < r->element_count; i++) measure(r, &r->elements[i]);
  return true;
}

/* ---- body ------------------------------------------------------------------------------------------------------- */

static bool is_space(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

/* The next number of text. "nan" and "inf" are read too: what becomes of them is the caller's business. */
static bool read_text(Reader *r, double *value) {
  while (r->at < r->end && is_space(*r->at)) r->line += *r->at++ == '\n';
  const char *start = r->at, *p = start;
  if (vl_number_scan(&p, r->end, value) && (p == r->end || is_space(*p))) {
    r->at = p;
    return true;
  }
  if (r->at >= r->end) return fail(r, "the file ends too early");
  const char *stop = start;
  while (stop < r->end && !is_space(*stop)) stop++;
  const char *word = start + (*start == '-' || *start == '+');
  size_t length = (size_t)(stop - word);
  if (length >= 3 && length <= 8 &&
      (strncmp(word, "nan", 3) == 0 || strncmp(word, "NaN", 3) == 0 || strncmp(word, "inf", 3) == 0 ||
       strncmp(word, "Inf", 3) == 0)) {
    *value = word[0] == 'i' || word[0] == 'I' ? INFINITY : NAN;
    r->at = stop;
    return true;
  }
  return fail(r, "expected a number, found \"%.*s\"", (int)(stop - start < 30 ? stop - start : 30), start);
}

/* A binary value whose bytes are there. */
static double load(const char *at, Type type, Format format) {
  unsigned char b[8];
  uint32_t n = type_size[type];
  if (format == BIG)
    for (uint32_t i = 0; i < n; i++) b[i] = (unsigned char)at[n - 1 - i];
  else
    memcpy(b, at, n);
  switch (type) {
    case I8: return (int8_t)b[0];
    case U8: return b[0];
    case I16: {
      int16_t v;
      memcpy(&v, b, 2);
      return v;
    }
    case U16: {
      uint16_t v;
      memcpy(&v, b, 2);
      return v;
    }
    case I32: {
      int32_t v;
      memcpy(&v, b, 4);
      return v;
    }
    case U32: {
      uint32_t v;
      memcpy(&v, b, 4);
      return v;
    }
    case F32: {
      float v;
      memcpy(&v, b, 4);
      return (double)v;
    }
    default: {
      double v;
      memcpy(&v, b, 8);
      return v;
    }
  }
}

static bool read_value(Reader *r, Type type, double *value) {
  if (r->format == ASCII) return read_text(r, value);
  if ((size_t)(r->end - r->at) < type_size[type]) return fail(r, "the file ends too early");
  *value = load(r->at, type, r->format);
  r->at += type_size[type];
  return true;
}

/* Length of a list, with the bytes of its items known to be there. */
static bool read_length(Reader *r, const Property *p, uint64_t *length) {
  double value;
  if (!read_value(r, p->count_type, &value)) return false;
  if (!(value >= 0.0) || value != floor(value)) return fail(r, "%g is not the length of a list", value);
  uint64_t left = (uint64_t)(r->end - r->at), item = r->format == ASCII ? 2 : type_size[p->type];
  if (value > (double)(left / item + 1))
    return fail(r, "a list promises %.0f values, but only %llu bytes follow", value, (unsigned long long)left);
  *length = (uint64_t)value;
  return true;
}

static bool skip_rows(Reader *r, const Element *e) {
  double ignored;
  if (r->format != ASCII && !e->has_list) return r->at += e->count * e->row_size, true;
  if (e->property_count == 0) return true;
  for (uint64_t i = 0; i < e->count; i++)
    for (uint32_t j = 0; j < e->property_count; j++) {
      const Property *p = &e->properties[j];
      uint64_t n = 1;
      if (p->is_list && !read_length(r, p, &n)) return false;
      for (uint64_t k = 0; k < n; k++)
        if (!read_value(r, p->type, &ignored)) return false;
    }
  return true;
}

static bool has_roles(const Element *e, Role first, int count) {
  for (int i = 0; i < count; i++) {
    bool found = false;
    for (uint32_t j = 0; j < e->property_count; j++) found = found || e->properties[j].role == first + (Role)i;
    if (!found) return false;
  }
  return true;
}

static bool not_finite(Reader *r, uint64_t vertex, Role role, double value) {
  static const char *const names[ROLES] = {"",  "x", "y",   "z",     "nx",   "ny",    "nz",
                                           "u", "v", "red", "green", "blue", "alpha", ""};
  return fail(r, "vertex %llu: %s is not finite (%g)", (unsigned long long)vertex, names[role], value);
}

/* Whole numbers reach from 0 to the largest of their type; colours are in sRGB, as the programs that write them have
 * it.
 */
static float color_value(Type type, bool alpha, double value) {
  double x = type == U8 ? value / 255 : type == U16 ? value / 65535 : value;
  if (!isfinite(x)) return (float)x;
  x = x < 0 ? 0 : x > 1 ? 1 : x;
  return (float)(alpha ? x : x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4));
}

static bool read_vertices(Reader *r, const Element *e) {
  vlPlyMesh *m = r->mesh;
  if (!has_roles(e, X, 3)) return fail(r, "vertices have no x, y and z");
  if (e->count > 0x7fffffff) return fail(r, "too many vertices");
  bool normals = has_roles(e, NX, 3), uvs = has_roles(e, U, 2), colors = has_roles(e, RED, 3);
  m->vertices = (uint32_t)e->count;
  m->positions = vl_alloc_array(r->context, e->count, 3 * sizeof(float));
  if (normals) m->normals = vl_alloc_array(r->context, e->count, 3 * sizeof(float));
  if (uvs) m->uvs = vl_alloc_array(r->context, e->count, 2 * sizeof(float));
  if (colors) m->colors = vl_alloc_array(r->context, e->count, 4 * sizeof(float));
  if (!m->positions || (normals && !m->normals) || (uvs && !m->uvs) || (colors && !m->colors)) return fail_memory(r);
  for (uint64_t i = 0; colors && i < e->count; i++) m->colors[4 * i + 3] = 1.0f;
  r->has_vertices = true;
  for (uint64_t i = 0; i < e->count; i++) {
    for (uint32_t j = 0; j < e->property_count; j++) {
      const Property *p = &e->properties[j];
      double value;
      uint64_t n = 1;
      if (p->is_list && !read_length(r, p, &n)) return false;
      for (uint64_t k = 0; k < n; k++)
        if (!read_value(r, p->type, &value)) return false;
      if (p->role == NOTHING) continue;
      float *to = p->role <= Z    ? &m->positions[3 * i + (p->role - X)]
                  : p->role <= NZ ? (normals ? &m->normals[3 * i + (p->role - NX)] : NULL)
                  : p->role <= V  ? (uvs ? &m->uvs[2 * i + (p->role - U)] : NULL)
                                  : (colors ? &m->colors[4 * i + (p->role - RED)] : NULL);
      if (!to) continue;
      *to = p->role >= RED ? color_value(p->type, p->role == ALPHA, value) : (float)value;
      if (!isfinite(*to)) return not_finite(r, i, p->role, value);
    }
  }
  return true;
}

static bool grow(Reader *r, uint32_t **items, size_t *capacity, size_t count) {
  if (count <= *capacity) return true;
  size_t wanted = *capacity + *capacity / 2 + 1024;
  uint32_t *fresh = vl_realloc_array(r->context, *items, wanted, sizeof *fresh);
  if (!fresh) return fail_memory(r);
  *items = fresh;
  *capacity = wanted;
  return true;
}

static bool add_face(Reader *r, const uint32_t *v, uint64_t n) {
  vlPlyMesh *m = r->mesh;
  if (n < 3) return true; /* points and lines have no surface */
  if (n == 4) {
    if (m->quads == 0x3fffffff) return fail(r, "too many faces");
    if (!grow(r, &m->quad_indices, &r->quad_capacity, 4 * ((size_t)m->quads + 1))) return false;
    uint32_t *q = m->quad_indices + 4 * (size_t)m->quads++;
    q[0] = v[0], q[1] = v[1], q[2] = v[3], q[3] = v[2]; /* around the face to p00 p10 p01 p11 */
    return true;
  }
  for (uint64_t i = 2; i < n; i++) {
    if (m->triangles == 0x3fffffff) return fail(r, "too many faces");
    if (!grow(r, &m->triangle_indices, &r->triangle_capacity, 3 * ((size_t)m->triangles + 1))) return false;
    uint32_t *t = m->triangle_indices + 3 * (size_t)m->triangles++;
    t[0] = v[0], t[1] = v[i - 1], t[2] = v[i];
  }
  return true;
}

static bool read_corners(Reader *r, const Property *p, uint64_t face) {
  uint64_t n;
  if (!read_length(r, p, &n)) return false;
  r->face.count = 0;
  if (n > r->face.capacity && !VL_RESERVE(r->context, &r->face, n)) return fail_memory(r);
  for (uint64_t k = 0; k < n; k++) {
    double value;
    if (!read_value(r, p->type, &value)) return false;
    if (!(value >= 0.0 && value < 4294967296.0) || (r->has_vertices && value >= (double)r->mesh->vertices))
      return fail(r, "face %llu names vertex %.0f, but there are %u vertices", (unsigned long long)face, value,
                  r->mesh->vertices);
    r->face.items[k] = (uint32_t)value;
  }
  return add_face(r, r->face.items, n);
}

static bool read_faces(Reader *r, const Element *e) {
  const Property *indices = NULL;
  for (uint32_t j = 0; j < e->property_count; j++)
    if (e->properties[j].role == INDICES) indices = &e->properties[j];
  if (!indices) return fail(r, "faces have no vertex_indices");
  /* Room for all faces as triangles, if the bytes could be that many. */
  uint64_t row = r->format == ASCII ? e->row_size + 6 : e->row_size + 3 * type_size[indices->type];
  uint64_t likely = (uint64_t)(r->end - r->at) / row;
  if (likely > e->count) likely = e->count;
  if (!grow(r, &r->mesh->triangle_indices, &r->triangle_capacity, 1)) return false;
  if (likely * 3 > r->triangle_capacity) {
    r->triangle_capacity = likely * 3;
    vl_free(r->context, r->mesh->triangle_indices);
    r->mesh->triangle_indices = vl_alloc_array(r->context, r->triangle_capacity, sizeof(uint32_t));
    if (!r->mesh->triangle_indices) return fail_memory(r);
  }
  double ignored;
  for (uint64_t i = 0; i < e->count; i++)
    for (uint32_t j = 0; j < e->property_count; j++) {
      const Property *p = &e->properties[j];
      uint64_t n = 1;
      if (p == indices) {
        if (!read_corners(r, p, i)) return false;
        continue;
      }
      if (p->is_list && !read_length(r, p, &n)) return false;
      for (uint64_t k = 0; k < n; k++)
        if (!read_value(r, p->type, &ignored)) return false;
    }
  return true;
}

static bool read_body(Reader *r) {
  if (r->format != ASCII)
    r->line = 0;
  else
    r->line++;
  for (uint32_t i = 0; i < r->element_count; i++) {
    const Element *e = &r->elements[i];
    uint64_t left = (uint64_t)(r->end - r->at);
    /* The last value of a text needs no blank after it. */
    if (e->row_size && e->count > (left + 1) / e->row_size)
      return fail(r, "the header promises %llu of element %s, but only %llu bytes follow", (unsigned long long)e->count,
                  e->name, (unsigned long long)left);
    bool fine = e->kind == VERTEX ? read_vertices(r, e) : e->kind == FACE ? read_faces(r, e) : skip_rows(r, e);
    if (!fine) return false;
  }
  return true;
}

/* Faces that came before their vertices could not be checked on the way. */
static bool check(Reader *r) {
  const vlPlyMesh *m = r->mesh;
  r->line = 0;
  if (!r->has_vertices || m->vertices == 0) return fail(r, "the mesh has no vertices");
  if (m->triangles == 0 && m->quads == 0) return fail(r, "the mesh has no faces");
  for (size_t i = 0; i < 3 * (size_t)m->triangles; i++)
    if (m->triangle_indices[i] >= m->vertices)
      return fail(r, "a face names vertex %u, but there are %u vertices", m->triangle_indices[i], m->vertices);
  for (size_t i = 0; i < 4 * (size_t)m->quads; i++)
    if (m->quad_indices[i] >= m->vertices)
      return fail(r, "a face names vertex %u, but there are %u vertices", m->quad_indices[i], m->vertices);
  return true;
}

/* Arrays without slack, or null when empty. */
static bool fit(Reader *r, uint32_t **items, size_t capacity, size_t count) {
  if (count == 0) {
    vl_free(r->context, *items);
    *items = NULL;
    return true;
  }
  if (count == capacity) return true;
  uint32_t *fresh = vl_realloc_array(r->context, *items, count, sizeof *fresh);
  if (!fresh) return fail_memory(r);
  *items = fresh;
  return true;
}

void vl_ply_free(vlContext *context, vlPlyMesh *mesh) {
  vl_free(context, mesh->positions);
  vl_free(context, mesh->normals);
  vl_free(context, mesh->uvs);
  vl_free(context, mesh->colors);
  vl_free(context, mesh->triangle_indices);
  vl_free(context, mesh->quad_indices);
  *mesh = (vlPlyMesh){0};
}

vlResult vl_ply_parse(vlContext *context, const char *name, const char *data, size_t size, vlPlyMesh *mesh,
                      vlError *error) {
  vlError local;
  if (!error) error = &local;
  vl_error_clear(error);
  *mesh = (vlPlyMesh){0};
  Reader r = {.context = context, .name = name, .at = data, .end = data + size, .mesh = mesh, .error = error};
  r.elements = vl_alloc_array(context, MAX_ELEMENTS, sizeof *r.elements);
  bool fine = r.elements ? true : fail_memory(&r);
  fine = fine && read_header(&r) && read_body(&r) && check(&r) &&
         fit(&r, &mesh->triangle_indices, r.triangle_capacity, 3 * (size_t)mesh->triangles) &&
         fit(&r, &mesh->quad_indices, r.quad_capacity, 4 * (size_t)mesh->quads);
  vl_free(context, r.elements);
  VL_ARRAY_FREE(context, &r.face);
  if (!fine) vl_ply_free(context, mesh);
  return fine ? VL_OK : error->code;
}

vlResult vl_ply_read_colored(vlContext *context, const char *path, vlPlyMesh *mesh, vlError *error) {
  char *data;
  size_t size;
  *mesh = (vlPlyMesh){0};
  vlResult result = vl_file_read(context, path, true, &data, &size, error);
  if (result != VL_OK) return result;
  result = vl_ply_parse(context, path, data, size, mesh, error);
  vl_free(context, data);
  return result;
}

vlResult vl_ply_read(vlContext *context, const char *path, vlPlyMesh *mesh, vlError *error) {
  vlResult result = vl_ply_read_colored(context, path, mesh, error);
  vl_free(context, mesh->colors);
  mesh->colors = NULL;
  return result;
}
