/* import/ply/ply_rows.c: vertices and faces of a PLY file. Any layout is read value by value.
 * The layout of nearly all binary files (rows of floats, triangles of 32-bit indices) has a
 * fast path; it falls back to the general path on anything else. */
#include <math.h>
#include <string.h>

#include "import/ply/ply_reader.h"

#include "image/pixel.h"
#include "import/far.h"

enum { MAX_FACES = 0x3fffffff };

static bool has_roles(const vlPlyElement *e, vlPlyRole first, int count) {
  for (int i = 0; i < count; i++) {
    bool found = false;
    for (uint32_t j = 0; j < e->property_count; j++)
      found = found || e->properties[j].role == first + (vlPlyRole)i;
    if (!found)
      return false;
  }
  return true;
}

/* Unsigned integers map from [0, largest value]; colours are sRGB, as programs write them. */
static float color_value(vlPlyType type, bool alpha, double value) {
  double x = type == VL_PLY_U8 ? value / 255 : type == VL_PLY_U16 ? value / 65535 : value;
  if (!isfinite(x))
    return (float)x;
  x = x < 0 ? 0 : x > 1 ? 1 : x;
  return (float)(alpha ? x : vl_srgb_to_linear(x));
}

/* Fast path: rows without lists whose coordinates are little-endian floats, which
 * is the byte order of all processors that velo is built for (film/file.h). False when
 * the layout is another or a value is not finite: the general path then reports it. */
static bool copy_float_rows(vlPlyReader *r, const vlPlyElement *e) {
  vlMesh *m = r->mesh;
  size_t offsets[8] = {0}, at = 0, row = (size_t)e->row_size;
  if (r->format != VL_PLY_LITTLE || e->has_list || m->colors)
    return false;
  for (uint32_t j = 0; j < e->property_count; j++) {
    const vlPlyProperty *p = &e->properties[j];
    if (p->role >= VL_PLY_X && p->role <= VL_PLY_V) {
      if (p->type != VL_PLY_F32)
        return false;
      offsets[p->role - VL_PLY_X] = at;
    }
    at += vl_ply_type_size(p->type);
  }
  const char *from = r->at;
  for (size_t i = 0; i < m->vertices; i++, from += row) {
    for (int k = 0; k < 3; k++)
      memcpy(&m->positions[3 * i + (size_t)k], from + offsets[k], 4);
    for (int k = 0; m->normals && k < 3; k++)
      memcpy(&m->normals[3 * i + (size_t)k], from + offsets[3 + k], 4);
    for (int k = 0; m->uvs[0] && k < 2; k++)
      memcpy(&m->uvs[0][2 * i + (size_t)k], from + offsets[6 + k], 4);
  }
  size_t n = m->vertices;
  if (!vl_all_finite(m->positions, 3 * n))
    return false;
  if (!r->options->broken &&
      (!vl_all_finite(m->normals, 3 * n) || !vl_all_finite(m->uvs[0], 2 * n)))
    return false;
  r->at = from;
  return true;
}

/* Whether the file has coordinates that are finer than single precision. */
static bool has_finer_rows(const vlPlyReader *r, const vlPlyElement *e) {
  bool finer = r->format == VL_PLY_ASCII;
  for (uint32_t j = 0; j < e->property_count; j++) {
    const vlPlyProperty *p = &e->properties[j];
    finer = finer || (p->role >= VL_PLY_X && p->role <= VL_PLY_Z && p->type != VL_PLY_F32);
  }
  return finer;
}

/* The vertex's number of this role; null: the mesh has none. */
static float *member(const vlMesh *m, size_t vertex, vlPlyRole role) {
  const int color = role >= VL_PLY_RED, uv = !color && role >= VL_PLY_U,
            normal = !color && !uv && role >= VL_PLY_NX;
  const vlPlyRole first = color ? VL_PLY_RED : uv ? VL_PLY_U : normal ? VL_PLY_NX : VL_PLY_X;
  float *row = color ? m->colors : uv ? m->uvs[0] : normal ? m->normals : m->positions;
  return row ? row + (color ? 4 : uv ? 2 : 3) * vertex + (role - first) : NULL;
}

/* Reads all rows of vertices, about the mesh's origin. */
static bool read_vertex_rows(vlPlyReader *r, const vlPlyElement *e) {
  vlMesh *m = r->mesh;
  for (uint64_t i = 0; i < e->count; i++) {
    if (!vl_ply_goes_on(r, i))
      return false;
    for (uint32_t j = 0; j < e->property_count; j++) {
      const vlPlyProperty *p = &e->properties[j];
      double value = 0;
      if (!vl_ply_read_property(r, p, &value))
        return false;
      if (p->role == VL_PLY_NOTHING)
        continue;
      float *to = member(m, i, p->role);
      if (!to)
        continue;
      if (p->role <= VL_PLY_Z)
        value -= m->origin[p->role - VL_PLY_X];
      *to = p->role >= VL_PLY_RED ? color_value(p->type, p->role == VL_PLY_ALPHA, value)
                                  : (float)value;
      bool may_break = r->options->broken && p->role >= VL_PLY_NX && p->role <= VL_PLY_V;
      if (!isfinite(*to) && !may_break)
        return vl_ply_fail_number(r, i, p->role, value);
    }
  }
  return true;
}

bool vl_ply_read_vertices(vlPlyReader *r, const vlPlyElement *e) {
  vlMesh *m = r->mesh;
  if (!has_roles(e, VL_PLY_X, 3))
    return vl_ply_fail(r, "vertices have no x, y and z");
  if (e->count > 0x7fffffff)
    return vl_ply_fail(r, "too many vertices");
  const bool colors = has_roles(e, VL_PLY_RED, 3);
  m->vertices = e->count;
  uint32_t attributes = VL_MESH_POSITIONS | (colors ? VL_MESH_COLORS : 0);
  if (has_roles(e, VL_PLY_NX, 3))
    attributes |= VL_MESH_NORMALS;
  if (has_roles(e, VL_PLY_U, 2))
    attributes |= VL_MESH_UVS;
  if (!vl_mesh_add_attributes(r->context, m, attributes))
    return vl_ply_fail_memory(r);
  for (uint64_t i = 0; colors && i < e->count; i++)
    m->colors[4 * i + 3] = 1.0f;
  r->has_vertices = true;
  if (copy_float_rows(r, e))
    return true;
  const char *start = r->at;
  const uint32_t line = r->line;
  if (!read_vertex_rows(r, e))
    return false;
  if (!r->options->given || !has_finer_rows(r, e) ||
      !vl_far_vertices(m->positions, m->vertices, m->origin))
    return true;
  r->at = start; /* once more, about the origin */
  r->line = line;
  return read_vertex_rows(r, e);
}

static bool add_triangle(vlPlyReader *r, uint32_t a, uint32_t b, uint32_t c) {
  if (r->mesh->triangles == MAX_FACES)
    return vl_ply_fail(r, "too many faces");
  return vl_mesh_add_triangle(r->context, r->mesh, a, b, c) || vl_ply_fail_memory(r);
}

/* Faces of fewer than three corners, points and lines, have no area. */
static bool add_face(vlPlyReader *r, const uint32_t *v, uint64_t n) {
  vlMesh *m = r->mesh;
  if (n == 4 && !r->face_colors) {
    if (m->quads == MAX_FACES)
      return vl_ply_fail(r, "too many faces");
    return vl_mesh_add_quad(r->context, m, v) || vl_ply_fail_memory(r);
  }
  for (uint64_t i = 2; i < n; i++)
    if (!add_triangle(r, v[0], v[i - 1], v[i]))
      return false;
  return true;
}

static bool read_corners(vlPlyReader *r, const vlPlyProperty *p, uint64_t face) {
  uint64_t n;
  if (!vl_ply_read_length(r, p, &n))
    return false;
  r->face.count = 0;
  if (n > r->face.capacity && !VL_RESERVE(r->context, &r->face, n))
    return vl_ply_fail_memory(r);
  for (uint64_t k = 0; k < n; k++) {
    double value;
    if (!vl_ply_read_value(r, p->type, &value))
      return false;
    if (!(value >= 0.0 && value < 4294967296.0) ||
        (r->has_vertices && value >= (double)r->mesh->vertices))
      return vl_ply_fail(r, "face %llu names vertex %.0f, but there are %zu vertices",
                         (unsigned long long)face, value, r->mesh->vertices);
    r->face.items[k] = (uint32_t)value;
  }
  return add_face(r, r->face.items, n);
}

static bool read_face_row(vlPlyReader *r, const vlPlyElement *e, const vlPlyProperty *indices,
                          uint64_t face, float color[4]) {
  double value = 0;
  for (uint32_t j = 0; j < e->property_count; j++) {
    const vlPlyProperty *p = &e->properties[j];
    if (!(p == indices ? read_corners(r, p, face) : vl_ply_read_property(r, p, &value)))
      return false;
    if (p->role < VL_PLY_RED || p->role > VL_PLY_ALPHA)
      continue;
    color[p->role - VL_PLY_RED] = color_value(p->type, p->role == VL_PLY_ALPHA, value);
    if (!isfinite(color[p->role - VL_PLY_RED]))
      return vl_ply_fail(r, "face %llu: its colour is not finite", (unsigned long long)face);
  }
  return true;
}

/* Fast path: rows that hold only a triangle: a byte 3 and three 32-bit indices. Reads as many
 * as follow each other and returns the first face of another form. */
static uint64_t copy_triangles(vlPlyReader *r, const vlPlyElement *e) {
  vlMesh *m = r->mesh;
  const vlPlyProperty *p = &e->properties[0];
  bool plain = r->format == VL_PLY_LITTLE && e->property_count == 1 && p->is_list &&
               r->has_vertices && vl_ply_type_size(p->count_type) == 1 &&
               (p->type == VL_PLY_I32 || p->type == VL_PLY_U32) && !m->triangles;
  uint64_t room = m->index_capacity / 3, left = (uint64_t)(r->end - r->at) / 13, i = 0;
  uint64_t max = e->count < room ? e->count : room;
  max = max < left ? max : left;
  max = max < MAX_FACES ? max : MAX_FACES;
  for (; plain && i < max && *r->at == 3; i++) {
    uint32_t *to = m->indices + 3 * i;
    memcpy(to, r->at + 1, 12);
    if (to[0] >= m->vertices || to[1] >= m->vertices || to[2] >= m->vertices)
      break;
    r->at += 13;
  }
  m->triangles += i;
  return i;
}

bool vl_ply_read_faces(vlPlyReader *r, const vlPlyElement *e) {
  const vlPlyProperty *indices = NULL;
  for (uint32_t j = 0; j < e->property_count; j++)
    if (e->properties[j].role == VL_PLY_INDICES)
      indices = &e->properties[j];
  if (!indices)
    return vl_ply_fail(r, "faces have no vertex_indices");
  /* Reserves room for all faces as triangles when the file's bytes could hold that many. */
  uint64_t row = r->format == VL_PLY_ASCII ? e->row_size + 6
                                           : e->row_size + 3 * vl_ply_type_size(indices->type);
  uint64_t likely = (uint64_t)(r->end - r->at) / row;
  if (likely > e->count)
    likely = e->count;
  vlMesh *m = r->mesh;
  if (!vl_array_reserve(r->context, (void **)&m->indices, &m->index_capacity, 3 * m->triangles,
                        sizeof *m->indices, 3 * likely))
    return vl_ply_fail_memory(r);
  r->face_colors = has_roles(e, VL_PLY_RED, 3);
  if (r->face_colors && m->triangles)
    return vl_ply_fail(r, "faces with colours and strips in one file are not supported");
  for (uint64_t i = copy_triangles(r, e); i < e->count; i++) {
    float color[4] = {0, 0, 0, 1};
    const size_t first = m->triangles;
    if (!vl_ply_goes_on(r, i))
      return false;
    if (!read_face_row(r, e, indices, i, color))
      return false;
    if (r->face_colors && !vl_mesh_color_triangles(r->context, m, first, color))
      return vl_ply_fail_memory(r);
  }
  return true;
}

/* A strip names a vertex after another; -1 ends a strip. Every second triangle is turned
 * over. */
static bool read_strip(vlPlyReader *r, const vlPlyProperty *p) {
  uint64_t n, run = 0;
  uint32_t last[2] = {0, 0};
  if (!vl_ply_read_length(r, p, &n))
    return false;
  for (uint64_t k = 0; k < n; k++) {
    double value;
    if (!vl_ply_read_value(r, p->type, &value))
      return false;
    if (value == -1 || value == 4294967295.0) {
      run = 0;
      continue;
    }
    if (!(value >= 0 && value < 4294967295.0) ||
        (r->has_vertices && value >= (double)r->mesh->vertices))
      return vl_ply_fail(r, "a strip names vertex %.0f, but there are %zu vertices", value,
                         r->mesh->vertices);
    uint32_t v = (uint32_t)value;
    if (run >= 2 && !(run & 1 ? add_triangle(r, last[1], last[0], v)
                              : add_triangle(r, last[0], last[1], v)))
      return false;
    last[0] = last[1];
    last[1] = v;
    run++;
  }
  return true;
}

bool vl_ply_read_strips(vlPlyReader *r, const vlPlyElement *e) {
  if (r->face_colors)
    return vl_ply_fail(r, "faces with colours and strips in one file are not supported");
  double ignored;
  for (uint64_t i = 0; i < e->count; i++)
    for (uint32_t j = 0; j < e->property_count; j++) {
      const vlPlyProperty *p = &e->properties[j];
      if (!(p->role == VL_PLY_INDICES ? read_strip(r, p)
                                      : vl_ply_read_property(r, p, &ignored)))
        return false;
    }
  return true;
}
