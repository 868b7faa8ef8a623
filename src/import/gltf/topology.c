/* import/gltf/topology.c: every primitive mode becomes triangles (specification, 3.7.2.1).
 * Points and lines become small solids. Unused vertices are dropped. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/far.h"
#include "import/gltf/gltf.h"

#include "base/free.h"
#include "math/axis.h"
#include "math/double3.h"
#include "math/elementary.h"

/* Any set of uvs. */
enum { ALL_UVS = 15 * VL_MESH_UVS };

enum { POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN };

/* ---- points and lines -------------------------------------------------------------------- */

/* The solids of points and lines: copies of their vertices, at other positions. */
typedef struct Solids {
  vlContext *context;
  const vlMesh *p;
  vlMesh made;    /* positions and faces */
  uint32_t *from; /* vertex of p, per vertex */
} Solids;

static uint32_t put_vertex(Solids *s, uint32_t from, const float position[3]) {
  const size_t i = s->made.vertices++;
  memcpy(s->made.positions + 3 * i, position, 3 * sizeof(float));
  s->from[i] = from;
  return (uint32_t)i;
}

static bool put_face(Solids *s, uint32_t i, uint32_t j, uint32_t k) {
  return vl_mesh_add_triangle(s->context, &s->made, i, j, k);
}

/* An octahedron subdivided once and projected to the sphere: 18 vertices, 32 faces. */
enum {
  BALL_VERTICES = 18,
  BALL_FACES = 32,
  TUBE_SIDES = 6,
  TUBE_VERTICES = 12,
  TUBE_FACES = 20
};

static bool put_ball(Solids *s, uint32_t at, float radius) {
  uint32_t grid[3][3][3];
  const float *c = s->p->positions + 3 * (size_t)at;
  bool ok = true;
  for (int x = -1; x <= 1; x++)
    for (int y = -1; y <= 1; y++)
      for (int z = -1; z <= 1; z++) {
        int n = abs(x) + abs(y) + abs(z);
        if (n != 1 && n != 2)
          continue;
        float l = radius / sqrtf((float)n),
              q[3] = {c[0] + l * (float)x, c[1] + l * (float)y, c[2] + l * (float)z};
        grid[x + 1][y + 1][z + 1] = put_vertex(s, at, q);
      }
  for (int k = 0; k < 8; k++) {
    int x = k & 1 ? 2 : 0, y = k & 2 ? 2 : 0, z = k & 4 ? 2 : 0;
    bool turned = ((k & 1) + ((k >> 1) & 1) + ((k >> 2) & 1)) % 2 == 0;
    uint32_t a = grid[x][1][1], e = grid[1][y][1], i = grid[1][1][z];
    uint32_t ae = grid[x][y][1], ei = grid[1][y][z], ia = grid[x][1][z];
    uint32_t faces[4][3] = {{a, ae, ia}, {ae, e, ei}, {ia, ei, i}, {ae, ei, ia}};
    for (int f = 0; ok && f < 4; f++)
      ok = put_face(s, faces[f][0], faces[f][turned ? 2 : 1], faces[f][turned ? 1 : 2]);
  }
  return ok;
}

static bool put_tube(Solids *s, uint32_t from, uint32_t to, float radius) {
  const float *ends[2] = {s->p->positions + 3 * (size_t)from, s->p->positions + 3 * (size_t)to};
  double d[3], u[3], v[3];
  for (int i = 0; i < 3; i++)
    d[i] = (double)ends[1][i] - ends[0][i];
  double l = vl_normalize3(d);
  if (!(l > 0) || !isfinite(l))
    return true;
  int axis = vl_least_axis3(d);
  double e[3] = {axis == 0, axis == 1, axis == 2};
  vl_cross3(d, e, u);
  vl_normalize3(u);
  vl_cross3(d, u, v);
  uint32_t ring[2][TUBE_SIDES];
  for (int side = 0; side < 2; side++)
    for (int k = 0; k < TUBE_SIDES; k++) {
      double angle = 2 * M_PI * k / TUBE_SIDES;
      float q[3];
      for (int i = 0; i < 3; i++)
        q[i] = (float)(ends[side][i] +
                       radius * (vl_precise_cos(angle) * u[i] + vl_precise_sin(angle) * v[i]));
      ring[side][k] = put_vertex(s, side ? to : from, q);
    }
  bool ok = true;
  for (int k = 0; ok && k < TUBE_SIDES; k++) {
    int next = (k + 1) % TUBE_SIDES;
    ok = put_face(s, ring[0][k], ring[0][next], ring[1][next]) &&
         put_face(s, ring[0][k], ring[1][next], ring[1][k]);
  }
  for (int k = 1; ok && k + 1 < TUBE_SIDES; k++)
    ok = put_face(s, ring[0][0], ring[0][k + 1], ring[0][k]) &&
         put_face(s, ring[1][0], ring[1][k], ring[1][k + 1]);
  return ok;
}

/* See vl_gltf_point_radius. Where the file does not give its size, a share of the mesh's. */
static float point_radius(const vlGltf *g, const vlMesh *p) {
  double radius = g->scale > 0 ? g->point_radius / g->scale : 0;
  if (radius > 1e-30 && radius < 1e30)
    return (float)radius;
  vlExtent box = vl_extent_nothing;
  vl_grow_box(p->positions, p->vertices, &box);
  const double d = vl_extent_diagonal(&box);
  return d > 0 && isfinite(d) ? (float)(0.003 * d) : 0.003f;
}

static size_t count_solids(uint32_t mode, size_t count) {
  if (mode == POINTS)
    return count;
  if (count < 2)
    return 0;
  return mode == LINES ? count / 2 : mode == LINE_LOOP ? count : count - 1;
}

/* Puts the solids in place of the mesh's vertices. */
static bool replace(Solids *s, vlMesh *p) {
  vl_mesh_drop(s->context, p, ~(uint32_t)(VL_MESH_POSITIONS | VL_MESH_COLORS | ALL_UVS));
  if (!vl_mesh_reorder(s->context, p, s->from, s->made.vertices))
    return false;
  memcpy(p->positions, s->made.positions, 3 * s->made.vertices * sizeof(float));
  p->indices = s->made.indices;
  p->triangles = s->made.triangles;
  s->made.indices = NULL;
  return true;
}

static bool make_solids(vlGltf *g, const vlGltfLocation *at, uint32_t mode,
                        const uint32_t *indices, size_t count, vlMesh *p) {
  const size_t solids = count_solids(mode, count);
  const size_t vertices = solids * (mode == POINTS ? BALL_VERTICES : TUBE_VERTICES),
               faces = solids * (mode == POINTS ? BALL_FACES : TUBE_FACES);
  if (solids == 0)
    return true;
  if (vl_gltf_once(g, VL_GLTF_REPORTED_POINTS))
    vl_gltf_warn(VL_LOG_INFO, at, "points and lines are drawn as small balls and tubes");
  if (vertices > UINT32_MAX)
    return vl_gltf_fail(at, "too many points");
  if (!vl_gltf_spend(at, 36 * (uint64_t)vertices + 12 * (uint64_t)faces))
    return false;
  Solids s = {.context = g->context, .p = p};
  s.made.positions = vl_alloc_array(g->context, vertices, 3 * sizeof(float));
  s.from = vl_alloc_array(g->context, vertices, sizeof *s.from);
  bool ok = s.made.positions && s.from;
  float radius = point_radius(g, p);
  for (size_t i = 0; ok && i < solids; i++) {
    size_t first = mode == LINES ? 2 * i : i;
    ok = mode == POINTS ? put_ball(&s, indices[i], radius)
                        : put_tube(&s, indices[first], indices[(first + 1) % count], radius);
  }
  ok = ok && replace(&s, p);
  vl_mesh_free(g->context, &s.made);
  vl_free(g->context, s.from);
  return ok || vl_gltf_fail_memory(g);
}

/* ---- triangles --------------------------------------------------------------------------- */

bool vl_gltf_triangles(vlGltf *g, const vlGltfLocation *at, uint32_t mode, uint32_t *indices,
                       size_t count, vlMesh *p) {
  if (mode <= LINE_STRIP) {
    bool ok = make_solids(g, at, mode, indices, count, p);
    vl_free(g->context, indices);
    return ok;
  }
  if (mode == TRIANGLES) {
    p->indices = indices;
    p->triangles = count / 3;
    return true;
  }
  const size_t faces = count < 3 ? 0 : count - 2;
  bool ok = vl_gltf_spend(at, 12 * (uint64_t)faces);
  for (size_t i = 0; ok && i < faces; i++) {
    ok = mode == TRIANGLE_STRIP
             ? vl_mesh_add_triangle(g->context, p, indices[i], indices[i + 1 + i % 2],
                                    indices[i + 2 - i % 2])
             : vl_mesh_add_triangle(g->context, p, indices[i + 1], indices[i + 2], indices[0]);
    ok = ok || vl_gltf_fail_memory(g);
  }
  vl_free(g->context, indices);
  return ok;
}

bool vl_gltf_compact(vlGltf *g, vlMesh *p) {
  uint32_t *to = vl_alloc_zero(g->context, p->vertices + 1, sizeof *to);
  uint32_t *from = vl_alloc_array(g->context, p->vertices + 1, sizeof *from);
  size_t count = 0;
  bool ok = to && from;
  for (size_t i = 0; ok && i < 3 * p->triangles; i++)
    to[p->indices[i]] = 1;
  for (size_t i = 0; ok && i < p->vertices; i++) {
    if (!to[i])
      continue;
    from[count] = (uint32_t)i;
    to[i] = (uint32_t)count++;
  }
  for (size_t i = 0; ok && i < 3 * p->triangles; i++)
    p->indices[i] = to[p->indices[i]];
  if (ok && count < p->vertices)
    ok = vl_mesh_reorder(g->context, p, from, count);
  VL_FREE(g->context, to, from);
  return ok || vl_gltf_fail_memory(g);
}
