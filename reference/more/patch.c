/* more/patch.c: bilinear patches, p(u, v) between four corners p00, p10, p01, p11 (pbrt book 6.6); and the choice
 * between patches and curves. */
#include "more.h"
#include "program/program.h"

/* The roots of a u^2 + b u + c in [0, 1], without cancellation. */
static int roots_in_unit_interval(double a, double b, double c, double u[2]) {
  double found[2];
  int count = 0, kept = 0;
  double d = b * b - 4 * a * c;
  if (d < 0) return 0;
  double q = -0.5 * (b + (b < 0 ? -sqrt(d) : sqrt(d)));
  if (a != 0) found[count++] = q / a;
  if (q != 0) found[count++] = c / q;
  for (int i = 0; i < count; i++) {
    if (found[i] >= 0 && found[i] <= 1) u[kept++] = found[i];
  }
  return kept;
}

/* For each u the patch has a line. Its distance from the ray is zero where a quadratic in u is zero (Reshetov 2019). */
static bool meet_patch(const primitive *p, ray r, meeting *m) {
  vector p00 = p->corner[0], p10 = p->corner[1], p01 = p->corner[2], p11 = p->corner[3], d = r.direction;
  double a = dot(cross(subtract(p10, p00), subtract(p01, p11)), d);
  double c = dot(cross(subtract(p00, r.origin), d), subtract(p01, p00));
  double b = dot(cross(subtract(p10, r.origin), d), subtract(p11, p10)) - (a + c);
  double u[2];
  int count = roots_in_unit_interval(a, b, c, u);
  bool found = false;
  for (int i = 0; i < count; i++) {
    vector start = mix(p00, p10, u[i]);
    vector line = subtract(mix(p01, p11, u[i]), start);
    vector from_ray = subtract(start, r.origin);
    vector across = cross(d, line);
    double scale2 = dot(across, across);
    double v = dot(from_ray, cross(d, across)) / scale2;
    double t = dot(from_ray, cross(line, across)) / scale2;
    if (!(v >= 0 && v <= 1 && t > r.t_min && t < r.t_max)) continue;
    *m = (meeting){t, u[i], v};
    r.t_max = t;
    found = true;
  }
  return found;
}

/* Texture coordinates: (u, v) itself, or the corners' coordinates blended. The tangent points along the first one. */
static void patch_coordinates(const vlShapeDef *def, const uint32_t *face, const double *weights, double u, double v,
                              vector dpdu, vector dpdv, shade_record *record) {
  record->u = u;
  record->v = v;
  record->tangent = dpdu;
  if (!def->uvs) return;
  double uv[4][2], du[2], dv[2];
  for (int k = 0; k < 4; k++) {
    for (int i = 0; i < 2; i++) uv[k][i] = (double)def->uvs[2 * (size_t)face[k] + (size_t)i];
  }
  for (int i = 0; i < 2; i++) {
    du[i] = (1 - v) * (uv[1][i] - uv[0][i]) + v * (uv[3][i] - uv[2][i]);
    dv[i] = (1 - u) * (uv[2][i] - uv[0][i]) + u * (uv[3][i] - uv[1][i]);
  }
  record->u = record->v = 0;
  for (int k = 0; k < 4; k++) {
    record->u += weights[k] * uv[k][0];
    record->v += weights[k] * uv[k][1];
  }
  double d = du[0] * dv[1] - du[1] * dv[0];
  if (fabs(d) > 1e-12) record->tangent = scale(1 / d, subtract(scale(dv[1], dpdu), scale(du[1], dpdv)));
}

static void patch_surface(const world *w, const primitive *p, double u, double v, shade_record *record) {
  const placement *where = &w->placements[p->placement];
  const uint32_t *face = where->def->indices + 4 * (size_t)p->face;
  double weights[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
  vector left = mix(p->corner[0], p->corner[2], v), right = mix(p->corner[1], p->corner[3], v);
  vector low = mix(p->corner[0], p->corner[1], u), high = mix(p->corner[2], p->corner[3], u);
  vector dpdu = subtract(right, left), dpdv = subtract(high, low);
  vector by_edges = cross(dpdu, dpdv);
  record->point = mix(left, right, u);
  mesh_normals(where, face, weights, 4, by_edges, record);
  patch_coordinates(where->def, face, weights, u, v, dpdu, dpdv, record);
  double area = length(by_edges);
  record->area_density = area > 0 ? 1 / area : 0;
}

uint32_t more_corners(const vlShapeDef *def) {
  return def->kind == VL_SHAPE_BILINEAR || def->kind == VL_SHAPE_CURVES ? 4 : 0;
}

static bool is_curve(const world *w, const primitive *p) {
  return w->placements[p->placement].def->kind == VL_SHAPE_CURVES;
}

bool meet_more(const world *w, const primitive *p, ray r, meeting *m) {
  return is_curve(w, p) ? meet_curve(w, p, r, m) : meet_patch(p, r, m);
}

void more_surface(const world *w, const primitive *p, double a, double b, shade_record *record) {
  if (is_curve(w, p)) curve_surface(w, p, a, b, record);
  if (!is_curve(w, p)) patch_surface(w, p, a, b, record);
}

void bound_more(const world *w, primitive *p) {
  if (is_curve(w, p)) bound_curve(w, p);
  for (int k = 0; k < 4; k++) include_point(p, p->corner[k]);
}
