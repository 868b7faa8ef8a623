/* import/gltf/topology.c: every primitive mode becomes triangles (specification, 3.7.2.1).
 * Points and lines become small solids. Unused vertices are dropped. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/gltf/gltf.h"

#include "base/free.h"
#include "math/axis.h"
#include "math/double3.h"
#include "math/elementary.h"

enum { POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN };

void vl_gltf_free_primitive(vlContext *context, vlGltfPrimitive *p) {
  VL_FREE(context, p->positions, p->normals, p->positions_close, p->normals_close, p->tangents,
          p->colors);
  for (int i = 0; i < 4; i++)
    vl_free(context, p->uvs[i]);
  vl_free(context, p->indices);
  memset(p, 0, sizeof *p);
}

/* ---- points and lines -------------------------------------------------------------------- */

typedef struct NewMesh { /* room for the vertices and faces to be made */
  vlGltfPrimitive made;
  size_t vertices, faces;
} NewMesh;

static bool make_room(vlGltf *g, const vlGltfLocation *at, const vlGltfPrimitive *p,
                      size_t vertices, size_t faces, NewMesh *b) {
  memset(b, 0, sizeof *b);
  if (vertices > UINT32_MAX)
    return vl_gltf_fail(at, "too many points");
  if (!vl_gltf_spend(at, 36 * (uint64_t)vertices + 12 * (uint64_t)faces))
    return false;
  b->made.positions = vl_alloc_array(g->context, vertices, 3 * sizeof(float));
  b->made.indices = vl_alloc_array(g->context, faces, 3 * sizeof(uint32_t));
  bool ok = b->made.positions && b->made.indices;
  if (p->colors)
    ok = (b->made.colors = vl_alloc_array(g->context, vertices, 4 * sizeof(float))) && ok;
  for (int i = 0; i < 4; i++)
    if (p->uvs[i])
      ok = (b->made.uvs[i] = vl_alloc_array(g->context, vertices, 2 * sizeof(float))) && ok;
  if (!ok)
    vl_gltf_free_primitive(g->context, &b->made);
  return ok || vl_gltf_fail_memory(g);
}

/* Appends a copy of vertex `from`. */
static uint32_t put_vertex(NewMesh *b, const vlGltfPrimitive *p, uint32_t from,
                           const float position[3]) {
  size_t i = b->vertices++;
  memcpy(b->made.positions + 3 * i, position, 3 * sizeof(float));
  if (p->colors)
    memcpy(b->made.colors + 4 * i, p->colors + 4 * (size_t)from, 4 * sizeof(float));
  for (int k = 0; k < 4; k++)
    if (p->uvs[k])
      memcpy(b->made.uvs[k] + 2 * i, p->uvs[k] + 2 * (size_t)from, 2 * sizeof(float));
  return (uint32_t)i;
}

static void put_face(NewMesh *b, uint32_t i, uint32_t j, uint32_t k) {
  uint32_t *f = b->made.indices + 3 * b->faces++;
  f[0] = i;
  f[1] = j;
  f[2] = k;
}

/* An octahedron subdivided once and projected to the sphere: 18 vertices, 32 faces. */
enum {
  BALL_VERTICES = 18,
  BALL_FACES = 32,
  TUBE_SIDES = 6,
  TUBE_VERTICES = 12,
  TUBE_FACES = 20
};

static void put_ball(NewMesh *b, const vlGltfPrimitive *p, uint32_t at, float radius) {
  uint32_t grid[3][3][3];
  const float *c = p->positions + 3 * (size_t)at;
  for (int x = -1; x <= 1; x++)
    for (int y = -1; y <= 1; y++)
      for (int z = -1; z <= 1; z++) {
        int n = abs(x) + abs(y) + abs(z);
        if (n != 1 && n != 2)
          continue;
        float l = radius / sqrtf((float)n),
              q[3] = {c[0] + l * (float)x, c[1] + l * (float)y, c[2] + l * (float)z};
        grid[x + 1][y + 1][z + 1] = put_vertex(b, p, at, q);
      }
  for (int k = 0; k < 8; k++) {
    int x = k & 1 ? 2 : 0, y = k & 2 ? 2 : 0, z = k & 4 ? 2 : 0;
    bool turned = ((k & 1) + ((k >> 1) & 1) + ((k >> 2) & 1)) % 2 == 0;
    uint32_t a = grid[x][1][1], e = grid[1][y][1], i = grid[1][1][z];
    uint32_t ae = grid[x][y][1], ei = grid[1][y][z], ia = grid[x][1][z];
    uint32_t faces[4][3] = {{a, ae, ia}, {ae, e, ei}, {ia, ei, i}, {ae, ei, ia}};
    for (int f = 0; f < 4; f++)
      put_face(b, faces[f][0], faces[f][turned ? 2 : 1], faces[f][turned ? 1 : 2]);
  }
}

static void put_tube(NewMesh *b, const vlGltfPrimitive *p, uint32_t from, uint32_t to,
                     float radius) {
  const float *ends[2] = {p->positions + 3 * (size_t)from, p->positions + 3 * (size_t)to};
  double d[3], u[3], v[3];
  for (int i = 0; i < 3; i++)
    d[i] = (double)ends[1][i] - ends[0][i];
  double l = vl_normalize3(d);
  if (!(l > 0) || !isfinite(l))
    return;
  int least = vl_least_axis3(d);
  double e[3] = {least == 0, least == 1, least == 2};
  vl_cross3(d, e, u);
  vl_normalize3(u);
  vl_cross3(d, u, v);
  uint32_t ring[2][TUBE_SIDES];
  for (int side = 0; side < 2; side++)
    for (int k = 0; k < TUBE_SIDES; k++) {
      double angle = 6.283185307179586 * k / TUBE_SIDES;
      float q[3];
      for (int i = 0; i < 3; i++)
        q[i] = (float)(ends[side][i] +
                       radius * (vl_precise_cos(angle) * u[i] + vl_precise_sin(angle) * v[i]));
      ring[side][k] = put_vertex(b, p, side ? to : from, q);
    }
  for (int k = 0; k < TUBE_SIDES; k++) {
    int next = (k + 1) % TUBE_SIDES;
    put_face(b, ring[0][k], ring[0][next], ring[1][next]);
    put_face(b, ring[0][k], ring[1][next], ring[1][k]);
  }
  for (int k = 1; k + 1 < TUBE_SIDES; k++) {
    put_face(b, ring[0][0], ring[0][k + 1], ring[0][k]);
    put_face(b, ring[1][0], ring[1][k], ring[1][k + 1]);
  }
}

/* See vl_gltf_point_radius. Where the file does not give its size, a share of the mesh's. */
static float point_radius(const vlGltf *g, const vlGltfPrimitive *p) {
  double radius = g->scale > 0 ? g->point_radius / g->scale : 0;
  if (radius > 1e-30 && radius < 1e30)
    return (float)radius;
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY},
         d = 0;
  for (size_t i = 0; i < 3 * p->vertices; i++) {
    double x = p->positions[i];
    low[i % 3] = x < low[i % 3] ? x : low[i % 3];
    high[i % 3] = x > high[i % 3] ? x : high[i % 3];
  }
  for (int i = 0; i < 3; i++)
    d += (high[i] - low[i]) * (high[i] - low[i]);
  return d > 0 && isfinite(d) ? (float)(0.003 * sqrt(d)) : 0.003f;
}

static bool make_solids(vlGltf *g, const vlGltfLocation *at, uint32_t mode,
                        const uint32_t *indices, size_t count, vlGltfPrimitive *p) {
  size_t solids = mode == POINTS      ? count
                  : mode == LINES     ? count / 2
                  : mode == LINE_LOOP ? count
                                      : count - 1;
  if (mode != POINTS && count < 2)
    solids = 0;
  NewMesh b;
  if (solids == 0) {
    p->faces = 0;
    return true;
  }
  if (vl_gltf_once(g, VL_GLTF_REPORTED_POINTS))
    vl_gltf_warn(VL_LOG_INFO, at, "points and lines are drawn as small balls and tubes");
  if (!make_room(g, at, p, solids * (mode == POINTS ? BALL_VERTICES : TUBE_VERTICES),
                 solids * (mode == POINTS ? BALL_FACES : TUBE_FACES), &b))
    return false;
  float radius = point_radius(g, p);
  for (size_t i = 0; i < solids; i++) {
    size_t first = mode == LINES ? 2 * i : i;
    if (mode == POINTS)
      put_ball(&b, p, indices[i], radius);
    else
      put_tube(&b, p, indices[first], indices[(first + 1) % count], radius);
  }
  b.made.vertices = b.vertices;
  b.made.faces = b.faces;
  vl_gltf_free_primitive(g->context, p);
  *p = b.made;
  return true;
}

/* ---- triangles --------------------------------------------------------------------------- */

bool vl_gltf_triangles(vlGltf *g, const vlGltfLocation *at, uint32_t mode, uint32_t *indices,
                       size_t count, vlGltfPrimitive *p) {
  if (mode <= LINE_STRIP) {
    bool ok = make_solids(g, at, mode, indices, count, p);
    vl_free(g->context, indices);
    return ok;
  }
  if (mode == TRIANGLES) {
    p->indices = indices;
    p->faces = count / 3;
    return true;
  }
  p->faces = count < 3 ? 0 : count - 2;
  bool ok = vl_gltf_spend(at, 12 * (uint64_t)p->faces);
  if (ok && p->faces) {
    p->indices = vl_alloc_array(g->context, p->faces, 3 * sizeof *p->indices);
    ok = p->indices || vl_gltf_fail_memory(g);
  }
  for (size_t i = 0; ok && i < p->faces; i++) {
    uint32_t *f = p->indices + 3 * i;
    if (mode == TRIANGLE_STRIP) {
      f[0] = indices[i];
      f[1] = indices[i + 1 + i % 2];
      f[2] = indices[i + 2 - i % 2];
    } else {
      f[0] = indices[i + 1];
      f[1] = indices[i + 2];
      f[2] = indices[0];
    }
  }
  vl_free(g->context, indices);
  return ok;
}

static void move_rows(float *rows, size_t width, const uint32_t *from, size_t count) {
  for (size_t i = 0; rows && i < count;
       i++) /* `from` ascends: rows are not overwritten before they are read */
    for (size_t c = 0; c < width; c++)
      rows[i * width + c] = rows[(size_t)from[i] * width + c];
}

bool vl_gltf_compact(vlGltf *g, vlGltfPrimitive *p) {
  uint32_t *to = vl_alloc_zero(g->context, p->vertices + 1, sizeof *to), *from = NULL;
  if (!to)
    return vl_gltf_fail_memory(g);
  size_t count = 0;
  for (size_t i = 0; i < 3 * p->faces; i++)
    to[p->indices[i]] = 1;
  for (size_t i = 0; i < p->vertices; i++)
    count += to[i];
  if (count < p->vertices) {
    if (!(from = vl_alloc_array(g->context, count + 1, sizeof *from))) {
      vl_free(g->context, to);
      return vl_gltf_fail_memory(g);
    }
    size_t n = 0;
    for (size_t i = 0; i < p->vertices; i++)
      if (to[i]) {
        from[n] = (uint32_t)i;
        to[i] = (uint32_t)n++;
      }
    for (size_t i = 0; i < 3 * p->faces; i++)
      p->indices[i] = to[p->indices[i]];
    move_rows(p->positions, 3, from, count);
    move_rows(p->normals, 3, from, count);
    move_rows(p->positions_close, 3, from, count);
    move_rows(p->normals_close, 3, from, count);
    move_rows(p->tangents, 4, from, count);
    move_rows(p->colors, 4, from, count);
    for (int k = 0; k < 4; k++)
      move_rows(p->uvs[k], 2, from, count);
    p->vertices = count;
    vl_free(g->context, from);
  }
  vl_free(g->context, to);
  return true;
}
