/* import/pbrt/loop.c: see loop.h. The mesh of each level is a set of arrays. A walk around a
 * vertex goes from face to face across shared edges. The two faces of an edge must have it in
 * opposite directions, so that each walk ends at a border or where it began. */
#include "import/pbrt/loop.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/free.h"
#include "math/approx_double.h"
#include "math/vec.h"

static const uint32_t NONE = UINT32_MAX;
/* Limits the output of a short file. Beyond 5 levels (1024 times as many faces) the smaller
 * limit applies. */
enum { MAX_FACES = 1 << 24, MAX_DEEP_FACES = 1 << 20, DEEP = 5 };

typedef struct Level {
  uint32_t vertices, faces;
  float *p;           /* 3 per vertex */
  uint32_t *start;    /* per vertex: one of its faces, or NONE */
  uint8_t *border;    /* per vertex: whether it lies on a border */
  uint32_t *v, *next; /* 3 per face: the vertices; the face across edge k (from vertex k to k +
                         1), or NONE */
} Level;

static uint32_t after(uint32_t k) {
  return k == 2 ? 0 : k + 1;
}

static uint32_t before(uint32_t k) {
  return k == 0 ? 2 : k - 1;
}

static void free_level(vlContext *context, Level *l) {
  VL_FREE(context, l->p, l->start, l->border, l->v, l->next);
  *l = (Level){0};
}

static bool make_level(vlContext *context, Level *l, uint32_t vertices, uint32_t faces) {
  *l = (Level){.vertices = vertices, .faces = faces};
  l->p = vl_alloc_array(context, vertices, 3 * sizeof *l->p);
  l->start = vl_alloc_array(context, vertices, sizeof *l->start);
  l->border = vl_alloc_zero(context, vertices, sizeof *l->border);
  l->v = vl_alloc_array(context, faces, 3 * sizeof *l->v);
  l->next = vl_alloc_array(context, faces, 3 * sizeof *l->next);
  if (l->p && l->start && l->border && l->v && l->next)
    return true;
  free_level(context, l);
  return false;
}

/* ---- walks ------------------------------------------------------------------------------- */

static uint32_t corner(const Level *l, uint32_t face, uint32_t vertex) {
  const uint32_t *v = &l->v[3 * (size_t)face];
  return v[0] == vertex ? 0 : v[1] == vertex ? 1 : 2;
}

/* A walk over the neighbours of a vertex in cyclic order. At a border it starts at one end. */
typedef struct Ring {
  const Level *l;
  uint32_t vertex, first, face;
  bool border, opened;
} Ring;

static Ring ring_start(const Level *l, uint32_t vertex) {
  Ring r = {l, vertex, l->start[vertex], l->start[vertex], l->border[vertex], false};
  if (r.face == NONE || !r.border)
    return r;
  for (uint32_t f; (f = l->next[3 * (size_t)r.face + corner(l, r.face, vertex)]) != NONE;)
    r.face = f;
  r.first = r.face;
  return r;
}

/* The next neighbour; NONE after the last. */
static uint32_t ring_next(Ring *r) {
  const Level *l = r->l;
  if (r->face == NONE)
    return NONE;
  uint32_t k = corner(l, r->face, r->vertex), neighbour;
  const uint32_t *v = &l->v[3 * (size_t)r->face], *next = &l->next[3 * (size_t)r->face];
  if (!r->border) {
    neighbour = v[after(k)];
    r->face = next[k];
    if (r->face == r->first)
      r->face = NONE;
  } else if (!r->opened) {
    neighbour = v[after(k)];
    r->opened = true;
  } else {
    neighbour = v[before(k)];
    r->face = next[before(k)];
  }
  return neighbour;
}

static uint32_t valence(const Level *l, uint32_t vertex) {
  uint32_t n = 0;
  for (Ring r = ring_start(l, vertex); ring_next(&r) != NONE;)
    n++;
  return n;
}

/* ---- masks ------------------------------------------------------------------------------- */

static float beta(uint32_t n) {
  return n == 3 ? 3.0f / 16.0f : 3.0f / (8.0f * (float)n);
}

static void add(float sum[3], float weight, const float *p) {
  for (int i = 0; i < 3; i++)
    sum[i] += weight * p[i];
}

/* The weighted mean of a vertex and its n neighbours; on a border, of the two along it. */
static void weight_ring(const Level *l, uint32_t vertex, uint32_t n, float weight,
                        float result[3]) {
  const bool border = l->border[vertex];
  float sum[3] = {0, 0, 0};
  add(sum, 1.0f - (border ? 2.0f : (float)n) * weight, &l->p[3 * (size_t)vertex]);
  Ring r = ring_start(l, vertex);
  for (uint32_t u, k = 0; (u = ring_next(&r)) != NONE; k++)
    if (!border || k == 0 || k == n - 1)
      add(sum, weight, &l->p[3 * (size_t)u]);
  memcpy(result, sum, sizeof sum);
}

/* ---- the mesh as given ------------------------------------------------------------------- */

typedef struct Edge {
  uint32_t a, b, at; /* a < b; at: 3 face + k, or NONE when both faces are known */
} Edge;

static uint32_t edge_hash(uint32_t a, uint32_t b) {
  uint64_t h = ((uint64_t)a << 32 | b) * 0x9e3779b97f4a7c15ull;
  return (uint32_t)(h >> 32);
}

/* Finds the neighbours. slots: a zeroed hash table; capacity is a power of two. */
static vlResult connect_faces(Level *l, Edge *slots, uint32_t capacity, vlError *error) {
  for (size_t at = 0; at < 3 * (size_t)l->faces; at++) {
    uint32_t k = (uint32_t)(at % 3), u = l->v[at], w = l->v[at - k + after(k)];
    l->next[at] = NONE;
    if (u == w)
      return vl_fail(error, VL_ERROR_SCENE, "face %zu names vertex %u twice", at / 3, u);
    uint32_t a = u < w ? u : w, b = u < w ? w : u, i = edge_hash(a, b) & (capacity - 1);
    while (slots[i].b && (slots[i].a != a || slots[i].b != b))
      i = (i + 1) & (capacity - 1);
    if (!slots[i].b || slots[i].at == NONE) {
      slots[i] = (Edge){a, b, (uint32_t)at};
      continue;
    }
    uint32_t other = slots[i].at;
    if (l->v[other] == u)
      return vl_fail(error, VL_ERROR_SCENE,
                     "faces %u and %zu run along their common edge (vertices %u, %u) in the "
                     "same direction",
                     other / 3, at / 3, a, b);
    l->next[other] = (uint32_t)(at / 3);
    l->next[at] = other / 3;
    slots[i].at = NONE;
  }
  return VL_OK;
}

static vlResult first_level(vlContext *context, uint32_t vertices, const float *positions,
                            uint32_t faces, const uint32_t *indices, Level *l, vlError *error) {
  uint32_t capacity = 16;
  while (capacity < 6 * (uint64_t)faces)
    capacity *= 2;
  Edge *slots = vl_alloc_zero(context, capacity, sizeof *slots);
  bool made = slots && make_level(context, l, vertices, faces);
  if (!made) {
    vl_free(context, slots);
    return vl_fail_memory(error);
  }
  memcpy(l->p, positions, 3 * sizeof(float) * vertices);
  memcpy(l->v, indices, 3 * sizeof(uint32_t) * faces);
  for (uint32_t i = 0; i < vertices; i++)
    l->start[i] = NONE;
  for (size_t i = 0; i < 3 * (size_t)faces; i++)
    l->start[l->v[i]] = (uint32_t)(i / 3);
  vlResult result = connect_faces(l, slots, capacity, error);
  vl_free(context, slots);
  if (result != VL_OK)
    return result;
  for (uint32_t i = 0; i < vertices; i++) {
    uint32_t f = l->start[i];
    if (f == NONE)
      continue;
    do
      f = l->next[3 * (size_t)f + corner(l, f, i)];
    while (f != NONE && f != l->start[i]);
    l->border[i] = f == NONE;
  }
  return VL_OK;
}

/* ---- one step ---------------------------------------------------------------------------- */

/* Assigns an index to the new vertex on each edge of each face. */
static uint32_t number_edges(const Level *l, uint32_t *odd) {
  uint32_t count = l->vertices;
  for (uint32_t f = 0; f < l->faces; f++)
    for (uint32_t k = 0; k < 3; k++) {
      uint32_t g = l->next[3 * (size_t)f + k];
      bool seen = g != NONE && g < f;
      /* the neighbour's edge is reversed: it starts at this face's vertex k + 1 */
      odd[3 * (size_t)f + k] =
          seen ? odd[3 * (size_t)g + corner(l, g, l->v[3 * (size_t)f + after(k)])] : count++;
    }
  return count;
}

/* The position of vertex i after one subdivision, or after infinitely many. */
static void weigh(const Level *l, uint32_t i, bool limit, float *p) {
  const uint32_t n = valence(l, i);
  if (l->start[i] == NONE)
    memcpy(p, &l->p[3 * (size_t)i], 3 * sizeof *p);
  else if (l->border[i])
    weight_ring(l, i, n, limit ? 1.0f / 5.0f : 1.0f / 8.0f, p);
  else
    weight_ring(l, i, n, limit ? 1.0f / ((float)n + 3.0f / (8.0f * beta(n))) : beta(n), p);
}

static void move_vertices(const Level *l, Level *c) {
  for (uint32_t i = 0; i < l->vertices; i++) {
    float *p = &c->p[3 * (size_t)i];
    c->border[i] = l->border[i];
    c->start[i] = l->start[i] == NONE ? NONE : 4 * l->start[i] + corner(l, l->start[i], i);
    weigh(l, i, false, p);
  }
}

static void place_odd(const Level *l, Level *c, const uint32_t *odd) {
  for (uint32_t f = 0; f < l->faces; f++)
    for (uint32_t k = 0; k < 3; k++) {
      const uint32_t *v = &l->v[3 * (size_t)f];
      uint32_t g = l->next[3 * (size_t)f + k], o = odd[3 * (size_t)f + k];
      if (g != NONE && g < f)
        continue;
      float sum[3] = {0, 0, 0};
      const float *a = &l->p[3 * (size_t)v[k]], *b = &l->p[3 * (size_t)v[after(k)]];
      if (g == NONE) {
        add(sum, 0.5f, a);
        add(sum, 0.5f, b);
      } else {
        uint32_t across = l->v[3 * (size_t)g + before(corner(l, g, v[after(k)]))];
        add(sum, 3.0f / 8.0f, a);
        add(sum, 3.0f / 8.0f, b);
        add(sum, 1.0f / 8.0f, &l->p[3 * (size_t)v[before(k)]]);
        add(sum, 1.0f / 8.0f, &l->p[3 * (size_t)across]);
      }
      memcpy(&c->p[3 * (size_t)o], sum, sizeof sum);
      c->border[o] = g == NONE;
      c->start[o] = 4 * f + 3;
    }
}

/* Children 0, 1, 2 of a face lie at its vertices, child 3 in the middle. */
static void split_faces(const Level *l, Level *c, const uint32_t *odd) {
  for (uint32_t f = 0; f < l->faces; f++) {
    const uint32_t *v = &l->v[3 * (size_t)f], *next = &l->next[3 * (size_t)f],
                   *o = &odd[3 * (size_t)f];
    uint32_t *cv = &c->v[12 * (size_t)f], *cn = &c->next[12 * (size_t)f];
    for (uint32_t j = 0; j < 3; j++) {
      uint32_t g = next[j], h = next[before(j)];
      cn[9 + j] = 4 * f + after(j);
      cn[3 * j + after(j)] = 4 * f + 3;
      cn[3 * j + j] = g == NONE ? NONE : 4 * g + corner(l, g, v[j]);
      cn[3 * j + before(j)] = h == NONE ? NONE : 4 * h + corner(l, h, v[j]);
      cv[3 * j + j] = v[j];
      cv[3 * j + after(j)] = o[j];
      cv[3 * after(j) + j] = o[j];
      cv[9 + j] = o[j];
    }
  }
}

static bool refine(vlContext *context, Level *l) {
  Level c;
  uint32_t *odd = vl_alloc_array(context, l->faces, 3 * sizeof *odd);
  if (!odd)
    return false;
  uint32_t vertices = number_edges(l, odd);
  if (!make_level(context, &c, vertices, 4 * l->faces)) {
    vl_free(context, odd);
    return false;
  }
  move_vertices(l, &c);
  place_odd(l, &c, odd);
  split_faces(l, &c, odd);
  vl_free(context, odd);
  free_level(context, l);
  *l = c;
  return true;
}

/* ---- the limit --------------------------------------------------------------------------- */

static float sine(float x) {
  return (float)vl_sincos_double((double)x).sin;
}

static float cosine(float x) {
  return (float)vl_sincos_double((double)x).cos;
}

/* Weight of neighbour k of n in the mask of the tangent that crosses the border. */
static float border_weight(uint32_t n, uint32_t k) {
  if (n == 2)
    return 1.0f;
  if (n == 3)
    return k == 1 ? 1.0f : 0.0f;
  if (n == 4)
    return k == 0 || k == 3 ? -1.0f : 2.0f;
  float theta = 3.14159265358979f / (float)(n - 1);
  return k == 0 || k == n - 1 ? -sine(theta)
                              : -(2.0f * cosine(theta) - 2.0f) * sine((float)k * theta);
}

static void tangents(const Level *l, uint32_t vertex, float s[3], float t[3]) {
  uint32_t n = valence(l, vertex), k = 0;
  const float *p = &l->p[3 * (size_t)vertex];
  Ring r = ring_start(l, vertex);
  for (uint32_t u; (u = ring_next(&r)) != NONE; k++) {
    const float *q = &l->p[3 * (size_t)u];
    float angle = 2.0f * 3.14159265358979f * (float)k / (float)n;
    add(s, l->border[vertex] ? (k == n - 1 ? 1.0f : k == 0 ? -1.0f : 0.0f) : cosine(angle), q);
    add(t, l->border[vertex] ? border_weight(n, k) : sine(angle), q);
  }
  if (l->border[vertex])
    add(t, n == 2 || n == 4 ? -2.0f : n == 3 ? -1.0f : 0.0f, p);
}

static vlResult finish(vlContext *context, Level *l, vlMesh *mesh, vlError *error) {
  float *limit = vl_alloc_array(context, l->vertices, 3 * sizeof *limit);
  float *normals = vl_alloc_zero(context, l->vertices, 3 * sizeof *normals);
  if (!limit || !normals) {
    VL_FREE(context, limit, normals);
    return vl_fail_memory(error);
  }
  for (uint32_t i = 0; i < l->vertices; i++)
    weigh(l, i, true, &limit[3 * (size_t)i]);
  vl_free(context, l->p);
  l->p = limit;
  for (uint32_t i = 0; i < l->vertices; i++) {
    float s[3] = {0, 0, 0}, t[3] = {0, 0, 0};
    if (l->start[i] == NONE)
      continue;
    tangents(l, i, s, t);
    vl_store3(&normals[3 * (size_t)i], vl_cross(vl_load3(s), vl_load3(t)));
  }
  *mesh = (vlMesh){.vertices = l->vertices, .triangles = l->faces, .indices = l->v};
  mesh->positions = l->p;
  mesh->normals = normals;
  l->p = NULL;
  l->v = NULL;
  return VL_OK;
}

vlResult vl_loop_subdivide(vlContext *context, uint32_t vertices, const float *positions,
                           uint32_t faces, const uint32_t *indices, uint32_t levels,
                           vlMesh *mesh, vlError *error) {
  *mesh = (vlMesh){0};
  uint64_t total = faces;
  for (uint32_t i = 0; i < levels && total <= MAX_FACES; i++)
    total *= 4;
  if (total > MAX_FACES || vertices > MAX_FACES || (levels > DEEP && total > MAX_DEEP_FACES))
    return vl_fail(error, VL_ERROR_SCENE, "%u levels of %u faces are too many", levels, faces);
  Level level = {0};
  vlResult result = first_level(context, vertices, positions, faces, indices, &level, error);
  for (uint32_t i = 0; i < levels && result == VL_OK; i++)
    if (!refine(context, &level))
      result = vl_fail_memory(error);
  if (result == VL_OK)
    result = finish(context, &level, mesh, error);
  free_level(context, &level);
  return result;
}
