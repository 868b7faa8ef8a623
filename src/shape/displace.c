/* shape/displace.c: subdivides meshes until every edge is short enough, and displaces the
 * vertices along their normals by a texture, as pbrt-v4 displaces PLY meshes. Every edge that
 * is too long is split at its middle, where both adjacent triangles use the same vertex, so
 * that no cracks appear. The longest edge of a triangle is split first. After the displacement,
 * the normals of the displaced surface are computed. */
#include "shape/displace.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/free.h"
#include "math/double3.h"
#include "velo/shape.h"

enum { MAX_TRIANGLES = 1 << 22 }; /* take about 600 MB with their BVH */

typedef struct Edge {
  uint64_t key; /* an edge: its lower vertex index << 32 | its higher one; 0: the entry is free
                   (no edge joins vertex 0 to itself) */
  uint32_t middle;
} Edge;

typedef struct Corners {
  uint32_t v[3];
} Corners;

typedef struct Cutter {
  vlContext *context;
  const vlMat4 *m; /* group from shape: edge lengths are measured in group space */
  double longest2;
  VL_ARRAY(float) p; /* positions, 3 per vertex, shape space */
  VL_ARRAY(float) n;
  VL_ARRAY(float) uv;
  VL_ARRAY(uint32_t) indices;
  VL_ARRAY(Corners) stack;
  Edge *edges;
  size_t edge_count, edge_capacity;
} Cutter;

static void release(Cutter *c) {
  VL_FREE(c->context, c->p.items, c->n.items, c->uv.items, c->indices.items, c->stack.items,
          c->edges);
}

/* ---- edges ------------------------------------------------------------------------------- */

static size_t slot_of(const Edge *edges, size_t capacity, uint64_t key) {
  uint64_t h = key * 0x9e3779b97f4a7c15u;
  size_t at = (size_t)(h >> 32 ^ h) & (capacity - 1);
  while (edges[at].key && edges[at].key != key)
    at = (at + 1) & (capacity - 1);
  return at;
}

static bool grow_edges(Cutter *c) {
  size_t capacity = c->edge_capacity ? 2 * c->edge_capacity : 1024;
  Edge *edges = vl_alloc_zero(c->context, capacity, sizeof *edges);
  if (!edges)
    return false;
  for (size_t i = 0; i < c->edge_capacity; i++)
    if (c->edges[i].key)
      edges[slot_of(edges, capacity, c->edges[i].key)] = c->edges[i];
  vl_free(c->context, c->edges);
  c->edges = edges;
  c->edge_capacity = capacity;
  return true;
}

static bool normalize(float n[3]) {
  double l = sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]);
  for (int i = 0; i < 3 && l > 0; i++)
    n[i] = (float)(n[i] / l);
  return l > 0;
}

static bool add_middle(Cutter *c, uint32_t a, uint32_t b, uint32_t *middle) {
  if (!VL_RESERVE(c->context, &c->p, 3) || !VL_RESERVE(c->context, &c->n, 3) ||
      !VL_RESERVE(c->context, &c->uv, 2))
    return false;
  *middle = (uint32_t)(c->p.count / 3);
  float n[3];
  for (int i = 0; i < 3; i++) {
    c->p.items[c->p.count++] =
        0.5f * c->p.items[3 * (size_t)a + i] + 0.5f * c->p.items[3 * (size_t)b + i];
    n[i] = c->n.items[3 * (size_t)a + i] + c->n.items[3 * (size_t)b + i];
  }
  if (!normalize(n))
    memcpy(n, &c->n.items[3 * (size_t)a], sizeof n);
  for (int i = 0; i < 3; i++)
    c->n.items[c->n.count++] = n[i];
  for (int i = 0; i < 2; i++)
    c->uv.items[c->uv.count++] =
        0.5f * c->uv.items[2 * (size_t)a + i] + 0.5f * c->uv.items[2 * (size_t)b + i];
  return true;
}

/* Gives the vertex at the middle of an edge. The vertex is created at its first use. */
static bool middle_of(Cutter *c, uint32_t a, uint32_t b, uint32_t *middle) {
  if (2 * (c->edge_count + 1) > c->edge_capacity && !grow_edges(c))
    return false;
  uint64_t key = a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
  Edge *e = &c->edges[slot_of(c->edges, c->edge_capacity, key)];
  if (!e->key) {
    if (!add_middle(c, a, b, &e->middle))
      return false;
    e->key = key;
    c->edge_count++;
  }
  *middle = e->middle;
  return true;
}

/* ---- cutting ----------------------------------------------------------------------------- */

static double length2(const Cutter *c, uint32_t a, uint32_t b) {
  const float *p = c->p.items + 3 * (size_t)a, *q = c->p.items + 3 * (size_t)b;
  double d[3] = {(double)q[0] - p[0], (double)q[1] - p[1], (double)q[2] - p[2]}, r[3];
  vl_mat4_vector(c->m, d, r);
  return vl_dot3(r, r);
}

static bool push(Cutter *c, uint32_t a, uint32_t b, uint32_t d) {
  Corners *top = VL_PUSH(c->context, &c->stack);
  if (top)
    *top = (Corners){{a, b, d}};
  return top != NULL;
}

/* Subdivides a triangle. Error VL_ERROR_SCENE: too many triangles. */
static vlResult cut(Cutter *c, Corners first) {
  if (!push(c, first.v[0], first.v[1], first.v[2]))
    return VL_ERROR_MEMORY;
  while (c->stack.count) {
    Corners t = c->stack.items[--c->stack.count];
    int longest = 0;
    double l2[3];
    for (int k = 0; k < 3; k++) {
      l2[k] = length2(c, t.v[k], t.v[(k + 1) % 3]);
      if (l2[k] > l2[longest])
        longest = k;
    }
    uint32_t a = t.v[longest], b = t.v[(longest + 1) % 3], d = t.v[(longest + 2) % 3], m;
    if (a == b || !(l2[longest] > c->longest2)) {
      if (!VL_RESERVE(c->context, &c->indices, 3))
        return VL_ERROR_MEMORY;
      for (int k = 0; k < 3; k++)
        c->indices.items[c->indices.count++] = t.v[k];
    } else if (!middle_of(c, a, b, &m) || !push(c, m, b, d) || !push(c, a, m, d)) {
      return VL_ERROR_MEMORY;
    }
    if (c->indices.count / 3 + c->stack.count > MAX_TRIANGLES || c->p.count / 3 > MAX_TRIANGLES)
      return VL_ERROR_SCENE;
  }
  return VL_OK;
}

/* Lower bound of the number of triangles after subdivision: no triangle is larger than the
 * equilateral triangle with the longest allowed edge. The bound lets a far too fine subdivision
 * fail at once. */
static double least_triangles(const Cutter *c, const vlShapeDef *def) {
  double sum = 0;
  for (size_t f = 0; f < def->faces; f++) {
    const uint32_t *v = def->indices + 3 * f;
    double a = length2(c, v[0], v[1]), b = length2(c, v[1], v[2]), d = length2(c, v[2], v[0]);
    /* Heron's formula: (4 area)^2 */
    double area2 = 2 * (a * b + b * d + d * a) - a * a - b * b - d * d;
    double longest = fmax(a, fmax(b, d)) / c->longest2;
    sum += fmax(sqrt(fmax(0, area2)) / (1.7320508 * c->longest2), sqrt(longest));
  }
  return sum;
}

/* Computes vertex normals: area-weighted means of the normals of the adjacent faces. */
static void find_normals(Cutter *c, const uint32_t *indices, size_t faces) {
  memset(c->n.items, 0, c->n.count * sizeof *c->n.items);
  for (size_t f = 0; f < faces; f++) {
    const uint32_t *v = indices + 3 * f;
    const float *p = c->p.items + 3 * (size_t)v[0], *q = c->p.items + 3 * (size_t)v[1],
                *r = c->p.items + 3 * (size_t)v[2];
    float n[3];
    vl_store3(n, vl_cross(vl_sub(vl_load3(q), vl_load3(p)), vl_sub(vl_load3(r), vl_load3(p))));
    for (int k = 0; k < 3; k++)
      for (int i = 0; i < 3; i++)
        c->n.items[3 * (size_t)v[k] + i] += n[i];
  }
  for (size_t i = 0; i < c->n.count; i += 3)
    normalize(c->n.items + i);
}

static bool start(Cutter *c, const vlShapeDef *def) {
  size_t n = def->vertices;
  if (!VL_RESERVE(c->context, &c->p, 3 * n) || !VL_RESERVE(c->context, &c->n, 3 * n) ||
      !VL_RESERVE(c->context, &c->uv, 2 * n))
    return false;
  c->p.count = c->n.count = 3 * n;
  c->uv.count = 2 * n;
  memcpy(c->p.items, def->positions, 3 * n * sizeof(float));
  memset(c->uv.items, 0, 2 * n * sizeof(float));
  if (def->uvs)
    memcpy(c->uv.items, def->uvs, 2 * n * sizeof(float));
  if (!def->normals) {
    find_normals(c, def->indices, def->faces);
    return true;
  }
  memcpy(c->n.items, def->normals, 3 * n * sizeof(float));
  for (size_t i = 0; i < 3 * n; i += 3)
    normalize(c->n.items + i);
  return true;
}

static void move(Cutter *c, const vlWorld *world, int32_t node) {
  vlMat4 inverse;
  bool invertible = vl_mat4_inverse(*c->m, &inverse);
  for (size_t i = 0; i < c->p.count / 3; i++) {
    float *p = c->p.items + 3 * i;
    double at[3] = {p[0], p[1], p[2]}, q[3];
    vl_mat4_point(c->m, at, q);
    const float *n = c->n.items + 3 * i;
    double along[3] = {n[0], n[1], n[2]}, normal[3] = {0, 0, 0};
    if (invertible)
      vl_mat4_normal(&inverse, along, normal);
    vlTextureQuery where = {c->uv.items[2 * i], c->uv.items[2 * i + 1],
                            vl_vec3((float)q[0], (float)q[1], (float)q[2]),
                            vl_vec3((float)normal[0], (float)normal[1], (float)normal[2]),
                            NULL};
    float d = vl_texture_float_at(world, node, &where);
    for (int k = 0; k < 3; k++)
      p[k] += d * n[k];
  }
}

/* Converts a pointer to const, as the members of a def are. The caller still owns the array. */
static const void *take(void *items) {
  return items;
}

vlResult vl_world_displace(vlWorld *world, const vlScene *scene, const vlShapeDef *def,
                           const vlMat4 *m, vlShapeDef *fine, vlError *error) {
  Cutter c = {.context = world->context,
              .m = m,
              .longest2 = (double)def->edge_length * def->edge_length};
  int32_t node = -1;
  VL_TRY(vl_world_float_node(world, scene, def->displacement, &node, error));
  vlResult r = start(&c, def) ? VL_OK : VL_ERROR_MEMORY;
  if (r == VL_OK && !(least_triangles(&c, def) <= MAX_TRIANGLES))
    r = VL_ERROR_SCENE;
  for (uint32_t f = 0; r == VL_OK && f < def->faces; f++) {
    Corners t;
    memcpy(t.v, def->indices + 3 * (size_t)f, sizeof t.v);
    r = cut(&c, t);
  }
  if (r != VL_OK) {
    release(&c);
    if (r == VL_ERROR_MEMORY)
      return vl_fail_memory(error);
    return vl_fail_source(error, r, def->source,
                          "displacement: edges of length %g need more than %d triangles",
                          (double)def->edge_length, MAX_TRIANGLES);
  }
  move(&c, world, node);
  find_normals(&c, c.indices.items, c.indices.count / 3);
  *fine = *def;
  fine->vertices = (uint32_t)(c.p.count / 3);
  fine->faces = (uint32_t)(c.indices.count / 3);
  fine->positions = take(c.p.items);
  fine->normals = take(c.n.items);
  fine->uvs = def->uvs ? take(c.uv.items) : NULL;
  if (!def->uvs)
    vl_free(c.context, c.uv.items);
  fine->indices = take(c.indices.items);
  fine->tangents = fine->tangent_signs = fine->colors = NULL;
  fine->more_uvs[0] = fine->more_uvs[1] = fine->more_uvs[2] = NULL;
  VL_FREE(c.context, c.stack.items, c.edges);
  return VL_OK;
}

void vl_world_displace_free(vlWorld *world, const vlShapeDef *fine) {
  VL_FREE(world->context, vl_owned(fine->positions), vl_owned(fine->normals),
          vl_owned(fine->uvs), vl_owned(fine->indices));
}
