/* import/gltf/tangent.c: tangents by the rules of MikkTSpace (Mikkelsen 2008, "Simulation of
 * Wrinkled Surfaces Revisited", and its published reference). Own implementation.
 *   - Vertices with the same position, normal and uv are one vertex.
 *   - Faces that share an edge and have the same uv orientation form a group at each vertex.
 *   - A group's tangent is the sum of its faces' directions of u, projected onto the plane of
 *     the normal and weighted by the faces' angles at the vertex.
 *
 * v points upwards, so that sign * (n x t) is the direction in which v grows: glTF's rule for
 * tangent.w. */
#include <math.h>
#include <string.h>

#include "base/free.h"
#include "import/gltf/gltf.h"
#include "math/approx_double.h"
#include "math/double3.h"
#include "math/hash.h"

typedef struct Maker {
  const vlMesh *p;
  const float *uvs;
  uint32_t *welded; /* vertex -> the first vertex equal to it */
  uint32_t *group;  /* corner -> a corner of its group (a union-find forest) */
  float *direction; /* face -> unit direction of u (3); 0 when undefined */
  int8_t *sign;     /* face -> uv orientation 1 or -1; 0: degenerate */
} Maker;

static uint32_t hash_floats(uint32_t h, const float *v, int n) {
  for (int i = 0; i < n; i++) {
    float x = v[i] + 0.0f; /* turns -0 into 0 */
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    h = vl_hash2(h, bits);
  }
  return h;
}

static bool alike(const Maker *m, uint32_t a, uint32_t b) {
  const vlMesh *p = m->p;
  for (size_t i = 0; i < 3; i++)
    if (p->positions[3 * (size_t)a + i] != p->positions[3 * (size_t)b + i] ||
        p->normals[3 * (size_t)a + i] != p->normals[3 * (size_t)b + i])
      return false;
  return m->uvs[2 * (size_t)a] == m->uvs[2 * (size_t)b] &&
         m->uvs[2 * (size_t)a + 1] == m->uvs[2 * (size_t)b + 1];
}

static bool weld(vlContext *context, Maker *m) {
  size_t size = vl_table_size(m->p->vertices);
  uint32_t *table = vl_alloc_zero(context, size, sizeof *table);
  if (!table)
    return false;
  for (size_t i = 0; i < m->p->vertices; i++) {
    uint32_t h = hash_floats(
        hash_floats(hash_floats(1, m->p->positions + 3 * i, 3), m->p->normals + 3 * i, 3),
        m->uvs + 2 * i, 2);
    size_t slot = h & (size - 1);
    while (table[slot] && !alike(m, table[slot] - 1, (uint32_t)i))
      slot = (slot + 1) & (size - 1);
    if (!table[slot])
      table[slot] = (uint32_t)i + 1;
    m->welded[i] = table[slot] - 1;
  }
  vl_free(context, table);
  return true;
}

static void face_directions(Maker *m) {
  const vlMesh *p = m->p;
  for (size_t f = 0; f < p->triangles; f++) {
    const uint32_t *k = p->indices + 3 * f;
    double e1[3], e2[3], t[3];
    for (int i = 0; i < 3; i++) {
      e1[i] = (double)p->positions[3 * (size_t)k[1] + (size_t)i] -
              p->positions[3 * (size_t)k[0] + (size_t)i];
      e2[i] = (double)p->positions[3 * (size_t)k[2] + (size_t)i] -
              p->positions[3 * (size_t)k[0] + (size_t)i];
    }
    const float *a = m->uvs + 2 * (size_t)k[0], *b = m->uvs + 2 * (size_t)k[1],
                *c = m->uvs + 2 * (size_t)k[2];
    double s1 = (double)b[0] - a[0], t1 = (double)b[1] - a[1], s2 = (double)c[0] - a[0],
           t2 = (double)c[1] - a[1];
    double area = s1 * t2 - s2 * t1;
    for (int i = 0; i < 3; i++)
      t[i] = (t2 * e1[i] - t1 * e2[i]) * (area < 0 ? -1 : 1);
    const double l = vl_norm3(t);
    m->sign[f] = fabs(area) > 1e-30 && l > 0 ? (area > 0 ? 1 : -1) : 0;
    for (int i = 0; i < 3; i++)
      m->direction[3 * f + (size_t)i] = m->sign[f] ? (float)(t[i] / l) : 0.0f;
  }
}

static uint32_t find(uint32_t *group, uint32_t i) {
  while (group[i] != i) {
    group[i] = group[group[i]];
    i = group[i];
  }
  return i;
}

static void join(uint32_t *group, uint32_t a, uint32_t b) {
  a = find(group, a);
  b = find(group, b);
  if (a < b)
    group[b] = a;
  else
    group[a] = b;
}

/* Largest number of probes for one edge: a damaged file may use one edge a million times. */
enum { MAX_PROBES = 200 };

/* Joins the groups of the two faces at an edge. The faces must run along the edge in opposite
 * directions. Of more than two faces the first matching pairs are joined. A degenerate face
 * joins either orientation. */
static bool join_edges(vlContext *context, Maker *m) {
  size_t corners = 3 * m->p->triangles, size = vl_table_size(corners);
  uint32_t *table = vl_alloc_zero(context, size, sizeof *table);
  if (!table)
    return false;
  const uint32_t *index = m->p->indices;
  for (uint32_t c = 0; c < corners; c++) {
    uint32_t f = c / 3, next = 3 * f + (c + 1) % 3;
    uint32_t from = m->welded[index[c]], to = m->welded[index[next]];
    size_t slot = vl_hash2(to, from) & (size - 1);
    bool partner = false;
    int probes = MAX_PROBES;
    /* looks for the reversed edge that has no partner yet */
    for (; from != to && table[slot] && probes-- > 0; slot = (slot + 1) & (size - 1)) {
      uint32_t d = table[slot] - 1;
      if (d == UINT32_MAX - 1)
        continue;
      uint32_t g = d / 3, d_next = 3 * g + (d + 1) % 3;
      bool same = m->sign[f] == m->sign[g] || !m->sign[f] || !m->sign[g];
      if (m->welded[index[d]] != to || m->welded[index[d_next]] != from || !same || g == f)
        continue;
      partner = true;
      table[slot] = UINT32_MAX; /* taken */
      join(m->group, c, d_next);
      join(m->group, next, d);
      break;
    }
    if (partner || from == to)
      continue;
    slot = vl_hash2(from, to) & (size - 1);
    for (probes = MAX_PROBES; table[slot] && probes > 0; probes--)
      slot = (slot + 1) & (size - 1);
    if (!table[slot])
      table[slot] = c + 1;
  }
  vl_free(context, table);
  return true;
}

/* The part of v orthogonal to the unit vector n, normalised. False when it vanishes. */
static bool project(const float *v, const float *n, double out[3]) {
  double d = 0;
  for (int i = 0; i < 3; i++)
    d += (double)v[i] * n[i];
  for (int i = 0; i < 3; i++)
    out[i] = v[i] - d * n[i];
  return vl_normalize3(out) > 1e-12;
}

/* sums: 3 per corner, kept at the corner that represents the group. */
static void add_corner(const Maker *m, uint32_t c, double *sums) {
  const vlMesh *p = m->p;
  uint32_t f = c / 3;
  if (!m->sign[f])
    return;
  const uint32_t *k = p->indices + 3 * (size_t)f;
  const float *n = p->normals + 3 * (size_t)p->indices[c];
  const float *x = p->positions + 3 * (size_t)p->indices[c];
  const float *a = p->positions + 3 * (size_t)k[(c + 1) % 3 == 0 ? 0 : (c % 3 + 1) % 3];
  const float *b = p->positions + 3 * (size_t)k[(c % 3 + 2) % 3];
  float to_a[3], to_b[3];
  for (int i = 0; i < 3; i++) {
    to_a[i] = a[i] - x[i];
    to_b[i] = b[i] - x[i];
  }
  double pa[3], pb[3], t[3];
  if (!project(to_a, n, pa) || !project(to_b, n, pb) ||
      !project(m->direction + 3 * (size_t)f, n, t))
    return;
  double dot = vl_dot3(pa, pb);
  double angle = vl_acos_double(dot > 1 ? 1 : dot < -1 ? -1 : dot);
  for (int i = 0; i < 3; i++)
    sums[3 * (size_t)m->group[c] + (size_t)i] += angle * t[i];
}

/* ---- the new vertices -------------------------------------------------------------------- */

/* Flat normals of faces that share no vertices. */
static float *flat_normals(vlGltf *g, const float *positions, size_t faces) {
  float *normals = vl_alloc_zero(g->context, 3 * faces, 3 * sizeof *normals);
  for (size_t f = 0; normals && f < faces; f++) {
    const float *v = positions + 9 * f;
    double n[3];
    vl_triangle_normal(v, v + 3, v + 6, n);
    double l = vl_norm3(n);
    for (int k = 0; k < 9; k++)
      normals[9 * f + (size_t)k] = l > 0 ? (float)(n[k % 3] / l) : (k % 3 == 2);
  }
  return normals;
}

/* Gives each face its own vertices and its flat normal (specification: flat normals when none
 * are given). */
static bool make_flat(vlGltf *g, vlMesh *p) {
  if (!vl_mesh_separate(g->context, p))
    return vl_gltf_fail_memory(g);
  vl_mesh_drop(g->context, p, VL_MESH_NORMALS_CLOSE);
  p->normals = flat_normals(g, p->positions, p->triangles);
  if (p->positions_close)
    p->normals_close = flat_normals(g, p->positions_close, p->triangles);
  return (p->normals && (p->normals_close || !p->positions_close)) || vl_gltf_fail_memory(g);
}

/* Makes one vertex for each pair of a vertex and a group. */
static bool split(vlGltf *g, vlMesh *p, const Maker *m, const double *sums) {
  size_t corners = 3 * p->triangles, size = vl_table_size(corners), count = 0;
  uint32_t *table = vl_alloc_zero(g->context, size, sizeof *table);
  uint32_t *from = vl_alloc_array(g->context, corners, sizeof *from);
  uint32_t *group = vl_alloc_array(g->context, corners, sizeof *group);
  uint32_t *indices = vl_alloc_array(g->context, corners, sizeof *indices);
  int8_t *signs = vl_alloc_array(g->context, corners, 1);
  bool ok = table && from && group && indices && signs;
  for (size_t c = 0; ok && c < corners; c++) {
    uint32_t vertex = p->indices[c], of = m->group[c];
    size_t slot = vl_hash2(vertex, of) & (size - 1);
    while (table[slot] && (from[table[slot] - 1] != vertex || group[table[slot] - 1] != of))
      slot = (slot + 1) & (size - 1);
    if (!table[slot]) {
      from[count] = vertex;
      group[count] = of;
      signs[count] = 0;
      table[slot] = (uint32_t)++count;
    }
    indices[c] = table[slot] - 1;
    if (m->sign[c / 3])
      signs[indices[c]] = m->sign[c / 3];
  }
  ok = ok && vl_mesh_reorder(g->context, p, from, count) &&
       vl_mesh_add_attributes(g->context, p, VL_MESH_TANGENTS);
  if (ok)
    memcpy(p->indices, indices, corners * sizeof *indices);
  for (size_t i = 0; ok && i < count; i++) {
    const double *s = sums + 3 * (size_t)group[i];
    double l = vl_norm3(s);
    for (int k = 0; k < 3; k++)
      p->tangents[4 * i + (size_t)k] = l > 0 ? (float)(s[k] / l) : 0.0f;
    p->tangents[4 * i + 3] = signs[i] < 0 ? -1.0f : 1.0f;
  }
  VL_FREE(g->context, table, from, group, indices, signs);
  return ok || vl_gltf_fail_memory(g);
}

bool vl_gltf_make_tangents(vlGltf *g, uint32_t set, vlMesh *p) {
  if (!p->normals && !make_flat(g, p))
    return false;
  size_t corners = 3 * p->triangles;
  if (!vl_gltf_spend(&g->top, 40 * (uint64_t)corners))
    return false;
  Maker m = {.p = p, .uvs = p->uvs[set]};
  m.welded = vl_alloc_array(g->context, p->vertices, sizeof *m.welded);
  m.group = vl_alloc_array(g->context, corners, sizeof *m.group);
  m.direction = vl_alloc_array(g->context, p->triangles, 3 * sizeof *m.direction);
  m.sign = vl_alloc_array(g->context, p->triangles, 1);
  double *sums = vl_alloc_zero(g->context, corners, 3 * sizeof *sums);
  bool ok = m.welded && m.group && m.direction && m.sign && sums && weld(g->context, &m);
  for (uint32_t c = 0; ok && c < corners; c++)
    m.group[c] = c;
  if (ok)
    face_directions(&m);
  ok = ok && join_edges(g->context, &m);
  for (uint32_t c = 0; ok && c < corners; c++)
    m.group[c] = find(m.group, c);
  for (uint32_t c = 0; ok && c < corners; c++)
    add_corner(&m, c, sums);
  ok = (ok || vl_gltf_fail_memory(g)) && split(g, p, &m, sums);
  VL_FREE(g->context, m.welded, m.group, m.direction, m.sign, sums);
  return ok;
}
