/* import/ply/ply_file.c: see ply.h. The data is read once, as the table made from the header
 * describes it. */
#include "import/ply/ply.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/file.h"
#include "base/free.h"
#include "base/text.h"
#include "import/pbrt/decimal.h"
#include "import/ply/ply_reader.h"

/* ---- data -------------------------------------------------------------------------------- */

static bool is_space(char c) {
  return c == ' ' || c == '\n' || c == '\r' || c == '\t';
}

/* The next number of a text file. "nan" and "inf" are read; the caller checks them. */
static bool read_text(vlPlyReader *r, double *value) {
  while (r->at < r->end && is_space(*r->at))
    r->line += *r->at++ == '\n';
  const char *start = r->at, *p = start;
  if (vl_number_scan(&p, r->end, value) && (p == r->end || is_space(*p))) {
    r->at = p;
    return true;
  }
  if (r->at >= r->end)
    return vl_ply_fail(r, "the file ends too early");
  const char *stop = start;
  while (stop < r->end && !is_space(*stop))
    stop++;
  const char *word = start + (*start == '-' || *start == '+');
  size_t length = (size_t)(stop - word);
  if (length >= 3 && length <= 8 &&
      (strncmp(word, "nan", 3) == 0 || strncmp(word, "NaN", 3) == 0 ||
       strncmp(word, "inf", 3) == 0 || strncmp(word, "Inf", 3) == 0)) {
    *value = word[0] == 'i' || word[0] == 'I' ? INFINITY : NAN;
    r->at = stop;
    return true;
  }
  return vl_ply_fail(r, "expected a number, found \"%s\"",
                     vl_short_text_of(start, (size_t)(stop - start)).text);
}

/* A binary value; the caller has checked that its bytes exist. */
static double load(const char *at, vlPlyType type, vlPlyFormat format) {
  union {
    unsigned char bytes[8];
    int8_t i8;
    uint8_t u8;
    int16_t i16;
    uint16_t u16;
    int32_t i32;
    uint32_t u32;
    float f32;
    double f64;
  } v;
  uint32_t n = vl_ply_type_size(type);
  for (uint32_t i = 0; i < n; i++)
    v.bytes[i] = (unsigned char)at[format == VL_PLY_BIG ? n - 1 - i : i];
  switch (type) {
    case VL_PLY_I8:
      return v.i8;
    case VL_PLY_U8:
      return v.u8;
    case VL_PLY_I16:
      return v.i16;
    case VL_PLY_U16:
      return v.u16;
    case VL_PLY_I32:
      return v.i32;
    case VL_PLY_U32:
      return v.u32;
    case VL_PLY_F32:
      return (double)v.f32;
    case VL_PLY_F64:
    case VL_PLY_TYPES:
      break;
  }
  return v.f64;
}

bool vl_ply_read_value(vlPlyReader *r, vlPlyType type, double *value) {
  if (r->format == VL_PLY_ASCII)
    return read_text(r, value);
  if ((size_t)(r->end - r->at) < vl_ply_type_size(type))
    return vl_ply_fail(r, "the file ends too early");
  *value = load(r->at, type, r->format);
  r->at += vl_ply_type_size(type);
  return true;
}

/* Reads the length of a list and checks that the file has enough bytes for its items. */
bool vl_ply_read_length(vlPlyReader *r, const vlPlyProperty *p, uint64_t *length) {
  double value;
  if (!vl_ply_read_value(r, p->count_type, &value))
    return false;
  if (!(value >= 0.0) || value != floor(value))
    return vl_ply_fail(r, "%g is not the length of a list", value);
  uint64_t left = (uint64_t)(r->end - r->at),
           item = r->format == VL_PLY_ASCII ? 2 : vl_ply_type_size(p->type);
  if (value > (double)(left / item + 1))
    return vl_ply_fail(r, "a list promises %.0f values, but only %llu bytes follow", value,
                       (unsigned long long)left);
  *length = (uint64_t)value;
  return true;
}

bool vl_ply_read_property(vlPlyReader *r, const vlPlyProperty *p, double *value) {
  uint64_t n = 1;
  if (p->is_list && !vl_ply_read_length(r, p, &n))
    return false;
  for (uint64_t k = 0; k < n; k++)
    if (!vl_ply_read_value(r, p->type, value))
      return false;
  return true;
}

static bool skip_rows(vlPlyReader *r, const vlPlyElement *e) {
  if (r->format != VL_PLY_ASCII && !e->has_list) {
    r->at += e->count * e->row_size;
    return true;
  }
  if (e->property_count == 0)
    return true;
  double ignored;
  for (uint64_t i = 0; i < e->count; i++)
    for (uint32_t j = 0; j < e->property_count; j++)
      if (!vl_ply_read_property(r, &e->properties[j], &ignored))
        return false;
  return true;
}

static bool read_body(vlPlyReader *r) {
  if (r->format != VL_PLY_ASCII)
    r->line = 0;
  else
    r->line++;
  for (uint32_t i = 0; i < r->element_count; i++) {
    const vlPlyElement *e = &r->elements[i];
    uint64_t left = (uint64_t)(r->end - r->at);
    /* The last value of a text file needs no blank after it. */
    if (e->row_size && e->count > (left + 1) / e->row_size)
      return vl_ply_fail(r,
                         "the header promises %llu of element %s, but only %llu bytes follow",
                         (unsigned long long)e->count, e->name, (unsigned long long)left);
    if (e->kind == VL_PLY_FACE || e->kind == VL_PLY_STRIPS)
      r->faces_first = r->faces_first || !r->has_vertices;
    bool fine = e->kind == VL_PLY_VERTEX   ? vl_ply_read_vertices(r, e)
                : e->kind == VL_PLY_FACE   ? vl_ply_read_faces(r, e)
                : e->kind == VL_PLY_STRIPS ? vl_ply_read_strips(r, e)
                                           : skip_rows(r, e);
    if (!fine)
      return false;
  }
  return true;
}

static bool check_indices(vlPlyReader *r, const uint32_t *indices, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (indices[i] >= r->mesh->vertices)
      return vl_ply_fail(r, "a face names vertex %u, but there are %zu vertices", indices[i],
                         r->mesh->vertices);
  return true;
}

/* Checks the faces that were read before the vertices. */
static bool check(vlPlyReader *r) {
  const vlMesh *m = r->mesh;
  r->line = 0;
  if (!r->has_vertices || m->vertices == 0)
    return vl_ply_fail(r, "the mesh has no vertices");
  if (m->triangles == 0 && m->quads == 0 && !r->options->given)
    return vl_ply_fail(r, "the mesh has no faces");
  return !r->faces_first || (check_indices(r, m->indices, 3 * m->triangles) &&
                             check_indices(r, m->quad_indices, 4 * m->quads));
}

vlResult vl_ply_parse(vlContext *context, const char *name, const char *data, size_t size,
                      const vlPlyOptions *options, vlMesh *mesh, vlError *error) {
  vlError local;
  if (!error)
    error = &local;
  vl_error_clear(error);
  *mesh = (vlMesh){0};
  vlPlyReader r = {.context = context,
                   .options = options,
                   .name = name,
                   .at = data,
                   .end = data + size,
                   .mesh = mesh,
                   .error = error};
  r.elements = vl_alloc_array(context, VL_PLY_MAX_ELEMENTS, sizeof *r.elements);
  bool fine = r.elements ? true : vl_ply_fail_memory(&r);
  fine = fine && vl_ply_read_header(&r) && read_body(&r) && check(&r) &&
         (vl_mesh_fit(context, mesh) || vl_ply_fail_memory(&r));
  vl_free(context, r.elements);
  VL_ARRAY_FREE(context, &r.face);
  if (!fine)
    vl_mesh_free(context, mesh);
  return fine ? VL_OK : error->code;
}

vlResult vl_ply_read(vlContext *context, const char *path, const vlPlyOptions *options,
                     vlMesh *mesh, vlError *error) {
  char *data;
  size_t size;
  *mesh = (vlMesh){0};
  VL_TRY(options->given ? vl_file_read_given(context, path, true, &data, &size, error)
                        : vl_file_read(context, path, true, &data, &size, error));
  vlResult result = vl_ply_parse(context, path, data, size, options, mesh, error);
  vl_free(context, data);
  if (!options->given)
    vl_mesh_drop(context, mesh, VL_MESH_COLORS);
  return result;
}
