/* scene/mesh_solid.c: see mesh_solid.h. Vertices at exactly the same position are welded.
 * Vertices on edges that are still open after that are welded within a tolerance of a millionth
 * of the solid's size. */
#include "scene/mesh_solid.h"

#include <math.h>
#include <string.h>

#include "base/free.h"
#include "math/double3.h"
#include "math/transform.h"
#include "schema/schema.h"
#include "velo/shape_kinds.h"

void vl_mesh_solid_free(const vlScene *scene, vlMeshSolid *b) {
  VL_FREE(scene->context, b->points, b->faces3, b->part, b->parts);
  *b = (vlMeshSolid){0};
}

static uint32_t table_size(size_t count) {
  uint32_t size = 16;
  while (size < 2 * count && size < 0x80000000u)
    size *= 2;
  return size;
}

static uint64_t mix(uint64_t h) {
  h ^= h >> 32;
  h *= 0xd6e8feb86659fd93ull;
  h ^= h >> 32;
  h *= 0xd6e8feb86659fd93ull;
  return h ^ (h >> 32);
}

static uint64_t hash_point(const double p[3]) {
  uint64_t h = 0;
  for (int i = 0; i < 3; i++) {
    double x = p[i] + 0.0; /* adding 0 turns -0 into 0 */
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    h = mix(h ^ bits);
  }
  return h;
}

/* ---- gathering --------------------------------------------------------------------------- */

/* Transforms a shape's vertices to group space and welds them. welded[i]: the corner that
 * vertex i becomes. */
static void weld(const vlShapeDef *d, vlMeshSolid *b, uint32_t *table, uint32_t mask,
                 uint32_t *welded) {
  vlMat4 m = vl_mat4_load(d->group_from_shape);
  for (uint32_t i = 0; i < d->vertices; i++) {
    double q[3];
    vl_mat4_vertex(&m, d->positions + 3 * (size_t)i, q);
    for (int k = 0; k < 3; k++)
      q[k] = (double)(float)q[k] + 0.0; /* rounded to float as in the renderer */
    uint32_t slot = (uint32_t)hash_point(q) & mask;
    while (table[slot] && memcmp(b->points + 3 * (size_t)(table[slot] - 1), q, sizeof q) != 0)
      slot = (slot + 1) & mask;
    if (!table[slot]) {
      memcpy(b->points + 3 * (size_t)b->corners, q, sizeof q);
      table[slot] = ++b->corners;
    }
    welded[i] = table[slot] - 1;
  }
}

/* Whether the outside of a face is opposite to the side that its winding gives. Vertex normals,
 * if present, decide, as in rendering. */
static bool is_turned(const vlShapeDef *d, const uint32_t *f, bool mirrored) {
  if (!d->normals)
    return d->reverse_orientation != mirrored;
  const float *p[3];
  double n[3] = {0, 0, 0}, g[3];
  for (int j = 0; j < 3; j++) {
    size_t vertex = 3 * (size_t)f[j];
    p[j] = d->positions + vertex;
    for (int k = 0; k < 3; k++)
      n[k] += (double)d->normals[vertex + (size_t)k];
  }
  vl_triangle_normal(p[0], p[1], p[2], g);
  bool against = vl_dot3(g, n) < 0;
  /* The test above is in shape space. A mirroring transform to group space reverses the
   * winding. The normals are reversed only by reverse_orientation. */
  return against != (d->reverse_orientation != mirrored);
}

static void add_face(vlMeshSolid *b, uint32_t x, uint32_t y, uint32_t z, bool turned) {
  if (x == y || y == z || z == x)
    return; /* the face is degenerate */
  uint32_t *f = b->faces3 + 3 * (size_t)b->faces++;
  f[0] = x;
  f[1] = turned ? z : y;
  f[2] = turned ? y : z;
}

static void add_faces(const vlShapeDef *d, vlMeshSolid *b, const uint32_t *welded) {
  bool mirrored = vl_determinant3(d->group_from_shape) < 0;
  for (uint32_t i = 0; i < d->faces; i++) {
    const uint32_t *f = d->indices + (d->kind == VL_SHAPE_TRIANGLES ? 3 : 4) * (size_t)i;
    if (d->kind == VL_SHAPE_TRIANGLES) {
      add_face(b, welded[f[0]], welded[f[1]], welded[f[2]], is_turned(d, f, mirrored));
    } else { /* the corners are p00 p10 p01 p11, whose cyclic order is 0 1 3 2 */
      bool turned = is_turned(d, f, mirrored);
      add_face(b, welded[f[0]], welded[f[1]], welded[f[3]], turned);
      add_face(b, welded[f[0]], welded[f[3]], welded[f[2]], turned);
    }
  }
}

static bool gather(const vlScene *scene, const uint32_t *shapes, size_t count, vlMeshSolid *b) {
  size_t vertices = 0, faces = 0, max = 0;
  for (size_t i = 0; i < count; i++) {
    const vlShapeDef *d = &scene->shapes.items[shapes[i]];
    if (!vl_shape_is_mesh(d->kind))
      continue;
    vertices += d->vertices;
    faces += (d->kind == VL_SHAPE_TRIANGLES ? 1 : 2) * (size_t)d->faces;
    max = d->vertices > max ? d->vertices : max;
  }
  if (vertices > 0x3fffffff || faces > 0x3fffffff)
    return true; /* too large to check: no faces, no findings */
  uint32_t size = table_size(vertices);
  uint32_t *table = vl_alloc_zero(scene->context, size, sizeof *table);
  uint32_t *welded = vl_alloc_array(scene->context, max + 1, sizeof *welded);
  b->points = vl_alloc_array(scene->context, vertices + 1, 3 * sizeof *b->points);
  b->faces3 = vl_alloc_array(scene->context, faces + 1, 3 * sizeof *b->faces3);
  bool fine = table && welded && b->points && b->faces3;
  for (size_t i = 0; i < count && fine; i++) {
    const vlShapeDef *d = &scene->shapes.items[shapes[i]];
    if (!vl_shape_is_mesh(d->kind))
      continue;
    weld(d, b, table, size - 1, welded);
    add_faces(d, b, welded);
  }
  VL_FREE(scene->context, table, welded);
  return fine;
}

/* ---- edges ------------------------------------------------------------------------------- */

typedef struct Edge {
  uint32_t a, b, face; /* a < b; face: one of its faces */
  int32_t count;       /* number of faces at the edge */
} Edge;

typedef struct Edges {
  Edge *slots;
  uint32_t mask;
} Edges;

static Edge *find_edge(const Edges *e, uint32_t a, uint32_t b) {
  if (a > b) {
    uint32_t t = a;
    a = b;
    b = t;
  }
  uint32_t i = (uint32_t)mix(((uint64_t)a << 32) | b) & e->mask;
  while (e->slots[i].count && (e->slots[i].a != a || e->slots[i].b != b))
    i = (i + 1) & e->mask;
  e->slots[i].a = a;
  e->slots[i].b = b;
  return &e->slots[i];
}

static bool count_edges(const vlScene *scene, const vlMeshSolid *b, Edges *e) {
  uint32_t size = table_size((size_t)b->faces * 3);
  e->mask = size - 1;
  e->slots = vl_alloc_zero(scene->context, size, sizeof *e->slots);
  if (!e->slots)
    return false;
  for (uint32_t i = 0; i < b->faces; i++)
    for (int k = 0; k < 3; k++) {
      Edge *edge = find_edge(e, b->faces3[3 * (size_t)i + (size_t)k],
                             b->faces3[3 * (size_t)i + (size_t)((k + 1) % 3)]);
      edge->count++;
      edge->face = i;
    }
  return true;
}

/* Corners that were kept, in a grid whose cells are two tolerances wide. */
typedef struct Weld {
  const double *points;
  double low[3];   /* the lower corner of the mesh's bounds */
  double reach;    /* the tolerance: corners no further apart along each axis are one */
  uint32_t *table; /* hash table by cell: a corner plus 1; 0: empty */
  uint32_t slots;
} Weld;

/* The first slot of the cell that contains p moved by `shift` cells along each axis. */
static uint32_t first_slot(const Weld *w, const double *p, const double shift[3]) {
  double cell[3];
  for (int k = 0; k < 3; k++)
    cell[k] = floor((p[k] - w->low[k]) / (2 * w->reach) + shift[k]);
  return (uint32_t)hash_point(cell) & (w->slots - 1);
}

/* A kept corner within reach of p in the cells that begin with this slot, or UINT32_MAX. */
static uint32_t find_in_cell(const Weld *w, const double *p, uint32_t slot) {
  for (int tries = 0; w->table[slot] && tries < 64; tries++) {
    const uint32_t corner = w->table[slot] - 1;
    const double *q = w->points + 3 * (size_t)corner;
    if (fabs(p[0] - q[0]) <= w->reach && fabs(p[1] - q[1]) <= w->reach &&
        fabs(p[2] - q[2]) <= w->reach)
      return corner;
    slot = (slot + 1) & (w->slots - 1);
  }
  return UINT32_MAX;
}

/* The corner that stands for this one: a kept corner within reach, or itself, which is then
 * kept. Whatever is within reach lies in the eight cells around the nearest cell corner. */
static uint32_t weld_corner(const Weld *w, uint32_t corner) {
  const double *p = w->points + 3 * (size_t)corner;
  for (int c = 0; c < 8; c++) {
    const double shift[3] = {c & 1 ? 0.5 : -0.5, c & 2 ? 0.5 : -0.5, c & 4 ? 0.5 : -0.5};
    const uint32_t found = find_in_cell(w, p, first_slot(w, p, shift));
    if (found != UINT32_MAX)
      return found;
  }
  uint32_t slot = first_slot(w, p, (double[3]){0, 0, 0});
  while (w->table[slot])
    slot = (slot + 1) & (w->slots - 1);
  w->table[slot] = corner + 1;
  return corner;
}

/* Sets low to the lower corner of the mesh's bounds. Returns their longest side. */
static double bounds_of(const vlMeshSolid *b, double low[3]) {
  vlExtent box = vl_extent_nothing;
  double longest = 0;
  for (size_t i = 0; i < b->corners; i++)
    vl_extent_grow(&box, b->points + 3 * i);
  for (int k = 0; k < 3; k++)
    longest = fmax(longest, vl_extent_size(&box, k));
  memcpy(low, box.low, sizeof box.low);
  return longest;
}

/* Welds corners of open edges that lie within the tolerance of each other. */
static bool weld_open(const vlScene *scene, vlMeshSolid *b, const Edges *e, bool *changed) {
  Weld w = {.points = b->points};
  w.reach = 1e-6 * bounds_of(b, w.low);
  uint32_t *same = vl_alloc_array(scene->context, b->corners + 1, sizeof *same);
  uint8_t *open = vl_alloc_zero(scene->context, b->corners + 1, 1);
  size_t opens = 0;
  for (uint32_t i = 0; open && i <= e->mask; i++)
    if (e->slots[i].count == 1)
      open[e->slots[i].a] = open[e->slots[i].b] = 1;
  for (uint32_t i = 0; open && i < b->corners; i++)
    opens += open[i];
  w.slots = table_size(opens);
  w.table = vl_alloc_zero(scene->context, w.slots, sizeof *w.table);
  const bool fine = same && open && w.table;
  *changed = false;
  for (uint32_t i = 0; fine && i < b->corners; i++) {
    same[i] = open[i] && w.reach > 0 ? weld_corner(&w, i) : i;
    *changed = *changed || same[i] != i;
  }
  const uint32_t faces = b->faces;
  b->faces = *changed ? 0 : faces;
  for (uint32_t i = 0; fine && *changed && i < faces; i++) {
    const uint32_t *f = b->faces3 + 3 * (size_t)i;
    add_face(b, same[f[0]], same[f[1]], same[f[2]], false);
  }
  VL_FREE(scene->context, same, open, w.table);
  return fine;
}

/* ---- parts ------------------------------------------------------------------------------- */

static uint32_t root_of(uint32_t *parent, uint32_t i) {
  while (parent[i] != i)
    i = parent[i] = parent[parent[i]];
  return i;
}

static bool find_parts(const vlScene *scene, vlMeshSolid *b, const Edges *e) {
  uint32_t *parent = vl_alloc_array(scene->context, b->corners + 1, sizeof *parent);
  uint32_t *index = vl_alloc_zero(scene->context, b->corners + 1, sizeof *index);
  b->part = vl_alloc_array(scene->context, b->faces + 1, sizeof *b->part);
  bool fine = parent && index && b->part;
  for (uint32_t i = 0; fine && i < b->corners; i++)
    parent[i] = i;
  for (uint32_t i = 0; fine && i < b->faces; i++) {
    const uint32_t *f = b->faces3 + 3 * (size_t)i;
    parent[root_of(parent, f[1])] = root_of(parent, f[0]);
    parent[root_of(parent, f[2])] = root_of(parent, f[0]);
  }
  for (uint32_t i = 0; fine && i < b->faces; i++) {
    uint32_t *part = &index[root_of(parent, b->faces3[3 * (size_t)i])];
    if (!*part)
      *part = ++b->part_count;
    b->part[i] = *part - 1;
  }
  if (fine)
    fine =
        (b->parts = vl_alloc_zero(scene->context, b->part_count + 1, sizeof *b->parts)) != NULL;
  for (uint32_t i = 0; fine && i < b->part_count; i++)
    b->parts[i].box = vl_extent_nothing;
  for (uint32_t i = 0; fine && i < b->faces; i++) {
    vlMeshSolidPart *part = &b->parts[b->part[i]];
    const uint32_t *f = b->faces3 + 3 * (size_t)i;
    const double *o = b->points; /* volume relative to a nearby point, for precision */
    double v[3][3];
    part->faces++;
    for (int j = 0; j < 3; j++) {
      const double *p = b->points + 3 * (size_t)f[j];
      vl_sub3(p, o, v[j]);
      vl_extent_grow(&part->box, p);
    }
    part->volume += vl_triple3(v[0], v[1], v[2]) / 6;
  }
  for (uint32_t i = 0; fine && i <= e->mask; i++)
    if (e->slots[i].count == 1)
      b->parts[b->part[e->slots[i].face]].open_edges++;
  VL_FREE(scene->context, parent, index);
  return fine;
}

bool vl_mesh_solid_make(const vlScene *scene, const uint32_t *shapes, size_t count,
                        vlMeshSolid *b) {
  *b = (vlMeshSolid){0};
  Edges e = {0};
  bool changed = false;
  bool fine = gather(scene, shapes, count, b) && count_edges(scene, b, &e) &&
              weld_open(scene, b, &e, &changed);
  if (fine && changed) {
    vl_free(scene->context, e.slots);
    fine = count_edges(scene, b, &e);
  }
  fine = fine && find_parts(scene, b, &e);
  vl_free(scene->context, e.slots);
  return fine;
}

int vl_mesh_solid_winding(const vlMeshSolid *b, const double p[3], uint32_t only) {
  /* direction of the ray, not along an axis or a diagonal */
  const double d[3] = {0.5773, 0.2113, 0.7887};
  int winding = 0;
  for (uint32_t i = 0; i < b->faces; i++) {
    if (only != UINT32_MAX && b->part[i] != only)
      continue;
    const uint32_t *f = b->faces3 + 3 * (size_t)i;
    double v[3][3], s[3];
    for (int j = 0; j < 3; j++)
      vl_sub3(b->points + 3 * (size_t)f[j], p, v[j]);
    for (int j = 0; j < 3; j++)
      /* on which side of each edge the ray passes */
      s[j] = vl_triple3(d, v[j], v[(j + 1) % 3]);
    bool out = s[0] > 0 && s[1] > 0 && s[2] > 0, in = s[0] < 0 && s[1] < 0 && s[2] < 0;
    if (!out && !in)
      continue;
    double volume = vl_triple3(v[0], v[1], v[2]);
    if (out && volume > 0)
      winding++; /* the ray leaves through the front side, ahead of p */
    if (in && volume < 0)
      winding--;
  }
  return winding;
}
