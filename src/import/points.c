/* import/points.c: see points.h. */
#include "import/points.h"
#include "import/far.h"
#include "math/axis.h"
#include "math/double3.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  NEIGHBOURS = 4,
  PROBES = 128,        /* points whose neighbours are looked for */
  MAX_POINTS = 8000000 /* of which a neighbour is one */
};

/* A disc is a hexagon; a ball an octahedron with the normals of a sphere. */
enum { CORNERS = 6, DISC_FACES = 4, BALL_FACES = 8 };

static double distance2(const float *a, const float *b) {
  double sum = 0;
  for (int i = 0; i < 3; i++)
    sum += ((double)a[i] - (double)b[i]) * ((double)a[i] - (double)b[i]);
  return sum;
}

/* The median distance of a point to its fourth neighbour, which in grids and in random surfaces
 * is that of points side by side; equal points are no neighbours. */
static double spacing(const vlMesh *m) {
  double nearest[PROBES];
  size_t n = 0, step = m->vertices / PROBES + 1, others = m->vertices / MAX_POINTS + 1;
  for (size_t i = 0; i < m->vertices && n < PROBES; i += step) {
    double best[NEIGHBOURS] = {INFINITY, INFINITY, INFINITY, INFINITY};
    for (size_t k = 0; k < m->vertices; k += others) {
      double d = distance2(m->positions + 3 * i, m->positions + 3 * k);
      if (!(d > 0 && d < best[NEIGHBOURS - 1]))
        continue;
      int at = NEIGHBOURS - 1;
      for (; at > 0 && best[at - 1] > d; at--)
        best[at] = best[at - 1];
      best[at] = d;
    }
    int last = NEIGHBOURS - 1;
    while (last > 0 && !isfinite(best[last]))
      last--;
    if (isfinite(best[last]))
      nearest[n++] = sqrt(best[last]);
  }
  if (n == 0)
    return 0;
  qsort(nearest, n, sizeof *nearest, vl_by_value);
  return nearest[n / 2];
}

/* Six points around a normal. */
static void disc(const float *n, float radius, float corners[CORNERS][3]) {
  static const double turn[CORNERS][2] = {
      {1, 0},  {0.5, 0.8660254037844386},   {-0.5, 0.8660254037844386},
      {-1, 0}, {-0.5, -0.8660254037844386}, {0.5, -0.8660254037844386}};
  double l = sqrt((double)n[0] * n[0] + (double)n[1] * n[1] + (double)n[2] * n[2]), u[3], v[3],
         w[3];
  for (int i = 0; i < 3; i++)
    w[i] = l > 0 ? n[i] / l : i == 2;
  int axis = vl_least_axis3(w);
  for (int i = 0; i < 3; i++)
    u[i] = (i == axis) - w[axis] * w[i];
  vl_normalize3(u);
  vl_cross3(w, u, v);
  for (int k = 0; k < CORNERS; k++)
    for (int i = 0; i < 3; i++)
      corners[k][i] = radius * (float)(turn[k][0] * u[i] + turn[k][1] * v[i]);
}

static void ball(float radius, float corners[CORNERS][3]) {
  for (int k = 0; k < CORNERS; k++)
    for (int i = 0; i < 3; i++)
      corners[k][i] = i == k / 2 ? (k & 1 ? -radius : radius) : 0;
}

/* Moves the vertices of point i, which are equal, apart, and joins them by faces. */
static bool put_point(vlContext *context, vlMesh *m, size_t i, float radius, bool discs) {
  static const uint32_t disc_faces[DISC_FACES][3] = {
      {0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
  static const uint32_t ball_faces[BALL_FACES][3] = {
      {0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  const size_t first = i * CORNERS;
  float corners[CORNERS][3];
  if (discs)
    disc(m->normals + 3 * first, radius, corners);
  else
    ball(radius, corners);
  for (size_t k = 0; k < CORNERS; k++)
    for (size_t c = 0; c < 3; c++) {
      m->positions[3 * (first + k) + c] += corners[k][c];
      if (!discs)
        m->normals[3 * (first + k) + c] = corners[k][c];
    }
  bool ok = true;
  for (int f = 0; ok && f < (discs ? DISC_FACES : BALL_FACES); f++) {
    const uint32_t *face = discs ? disc_faces[f] : ball_faces[f], from = (uint32_t)first;
    ok = vl_mesh_add_triangle(context, m, from + face[0], from + face[1], from + face[2]);
  }
  return ok;
}

/* Makes the vertices of all points, still at their places. */
static bool repeat_points(vlContext *context, vlMesh *m, bool discs) {
  const size_t count = m->vertices * CORNERS;
  uint32_t *order = vl_alloc_array(context, count, sizeof *order);
  for (size_t i = 0; order && i < count; i++)
    order[i] = (uint32_t)(i / CORNERS);
  vl_mesh_drop(context, m, VL_MESH_UVS);
  bool ok = order && vl_mesh_reorder(context, m, order, count) &&
            (discs || vl_mesh_add_attributes(context, m, VL_MESH_NORMALS));
  vl_free(context, order);
  return ok;
}

bool vl_import_points(vlContext *context, const char *path, vlMesh *m) {
  const size_t count = m->vertices;
  const bool discs = m->normals;
  if (count * BALL_FACES > 0x3fffffff)
    return false;
  vlExtent box = vl_extent_nothing;
  vl_grow_box(m->positions, count, &box);
  double size = vl_extent_diagonal(&box), radius = spacing(m);
  radius = fmin(fmax(radius, size / 2000), size / 50);
  radius = radius > 0 ? radius : 1;
  bool ok = repeat_points(context, m, discs);
  for (size_t i = 0; ok && i < count; i++)
    ok = put_point(context, m, i, (float)radius, discs);
  vlError where = {0};
  strncpy(where.file, path, sizeof where.file - 1);
  if (ok)
    vl_log(context, VL_LOG_INFO, &where,
           "it has no faces: its %zu points are %s of radius %.4g", count,
           discs ? "discs" : "balls", radius);
  return ok;
}
