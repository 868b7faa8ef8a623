/* import/mesh.c: see mesh.h. */
#include "import/mesh.h"

#include <string.h>

#include "base/array.h"
#include "base/free.h"

/* Numbers per vertex. */
static const uint32_t widths[VL_MESH_ATTRIBUTES] = {3, 3, 4, 4, 3, 3, 2, 2, 2, 2};

enum { MAX_TRIANGLES = 0x7fffffff };

bool vl_all_finite(const float *v, size_t count) {
  uint32_t wrong = 0; /* a loop that vectorises */
  for (size_t i = 0; v && i < count; i++) {
    uint32_t bits;
    memcpy(&bits, &v[i], sizeof bits);
    wrong |= (bits & 0x7f800000u) == 0x7f800000u;
  }
  return !wrong;
}

void vl_mesh_drop(vlContext *context, vlMesh *m, uint32_t attributes) {
  for (uint32_t k = 0; k < VL_MESH_ATTRIBUTES; k++) {
    if (!(attributes & 1u << k))
      continue;
    vl_free(context, m->rows[k]);
    m->rows[k] = NULL;
  }
}

void vl_mesh_free(vlContext *context, vlMesh *m) {
  vl_mesh_drop(context, m, ~0u);
  VL_FREE(context, m->face_colors, m->indices, m->quad_indices);
  *m = (vlMesh){0};
}

bool vl_mesh_add_attributes(vlContext *context, vlMesh *m, uint32_t attributes) {
  for (uint32_t k = 0; k < VL_MESH_ATTRIBUTES; k++) {
    if (!(attributes & 1u << k))
      continue;
    m->rows[k] = vl_alloc_array(context, m->vertices, widths[k] * sizeof(float));
    if (!m->rows[k])
      return false;
  }
  return true;
}

bool vl_mesh_reorder(vlContext *context, vlMesh *m, const uint32_t *order, size_t count) {
  vlMesh made = {.vertices = count};
  for (uint32_t k = 0; k < VL_MESH_ATTRIBUTES; k++) {
    const size_t width = widths[k];
    if (!m->rows[k])
      continue;
    made.rows[k] = vl_alloc_array(context, count, width * sizeof(float));
    if (!made.rows[k]) {
      vl_mesh_free(context, &made);
      return false;
    }
    for (size_t i = 0; i < count; i++)
      memcpy(made.rows[k] + i * width, m->rows[k] + order[i] * width, width * sizeof(float));
  }
  vl_mesh_drop(context, m, ~0u);
  memcpy(m->rows, made.rows, sizeof m->rows);
  m->vertices = count;
  return true;
}

/* ---- faces ------------------------------------------------------------------------------- */

bool vl_mesh_add_triangle(vlContext *context, vlMesh *m, uint32_t a, uint32_t b, uint32_t c) {
  const uint32_t corners[3] = {a, b, c};
  if (!vl_array_reserve(context, (void **)&m->indices, &m->index_capacity, 3 * m->triangles,
                        sizeof *m->indices, 3))
    return false;
  memcpy(m->indices + 3 * m->triangles++, corners, sizeof corners);
  return true;
}

bool vl_mesh_add_quad(vlContext *context, vlMesh *m, const uint32_t v[4]) {
  const uint32_t corners[4] = {v[0], v[1], v[3], v[2]};
  if (!vl_array_reserve(context, (void **)&m->quad_indices, &m->quad_capacity, 4 * m->quads,
                        sizeof *m->quad_indices, 4))
    return false;
  memcpy(m->quad_indices + 4 * m->quads++, corners, sizeof corners);
  return true;
}

bool vl_mesh_color_triangles(vlContext *context, vlMesh *m, size_t first,
                             const float color[3]) {
  if (!vl_array_reserve(context, (void **)&m->face_colors, &m->color_capacity, 3 * first,
                        sizeof *m->face_colors, 3 * (m->triangles - first)))
    return false;
  for (size_t i = first; i < m->triangles; i++)
    memcpy(m->face_colors + 3 * i, color, 3 * sizeof *color);
  return true;
}

bool vl_mesh_split_quads(vlContext *context, vlMesh *m) {
  if (m->triangles + 2 * m->quads > MAX_TRIANGLES)
    return false;
  const size_t before = m->triangles;
  for (size_t i = 0; i < m->quads; i++) {
    const uint32_t *q = m->quad_indices + 4 * i;
    if (vl_mesh_add_triangle(context, m, q[0], q[1], q[3]) &&
        vl_mesh_add_triangle(context, m, q[0], q[3], q[2]))
      continue;
    m->triangles = before;
    return false;
  }
  vl_free(context, m->quad_indices);
  m->quad_indices = NULL;
  m->quads = m->quad_capacity = 0;
  return true;
}

bool vl_mesh_separate(vlContext *context, vlMesh *m) {
  const size_t count = 3 * m->triangles;
  if (count > MAX_TRIANGLES || !vl_mesh_reorder(context, m, m->indices, count))
    return false;
  for (size_t i = 0; i < count; i++)
    m->indices[i] = (uint32_t)i;
  return true;
}

static bool fit(vlContext *context, uint32_t **items, size_t *capacity, size_t count) {
  uint32_t *fresh = NULL;
  if (count == *capacity)
    return true;
  if (count && !(fresh = vl_realloc_array(context, *items, count, sizeof *fresh)))
    return false;
  if (!count)
    vl_free(context, *items);
  *items = fresh;
  *capacity = count;
  return true;
}

bool vl_mesh_fit(vlContext *context, vlMesh *m) {
  return fit(context, &m->indices, &m->index_capacity, 3 * m->triangles) &&
         fit(context, &m->quad_indices, &m->quad_capacity, 4 * m->quads);
}

void vl_mesh_to_shape(const vlMesh *m, vlShapeDef *def) {
  def->vertices = (uint32_t)m->vertices;
  def->faces = (uint32_t)m->triangles;
  def->positions = m->positions;
  def->normals = m->normals;
  def->uvs = m->uvs[0];
  for (int k = 0; k < 3; k++)
    def->more_uvs[k] = m->uvs[k + 1];
  def->colors = m->colors;
  def->positions_close = m->positions_close;
  def->normals_close = m->normals_close;
  def->indices = m->indices;
}
