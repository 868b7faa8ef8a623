/* more/patch.c: bilinear patches, p(u, v) between four corners p00, p10, p01, p11 (pbrt book 6.6); and the choice
 * between patches and curves. */
#include "more.h"

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

/* What lies at (u, v) between four corners, and how it changes along u and along v. */
static void between_corners(const vector corner[4], double u, double v, vector *at, vector *along_u, vector *along_v) {
  vector left = mix(corner[0], corner[2], v), right = mix(corner[1], corner[3], v);
  *at = mix(left, right, u);
  *along_u = subtract(right, left);
  *along_v = subtract(mix(corner[2], corner[3], u), mix(corner[0], corner[1], u));
}

/* Texture coordinates: (u, v) itself, or the corners' coordinates blended. The tangent points along the first one. */
static void patch_coordinates(const vlShapeDef *def, const uint32_t *face, double u, double v, vector dpdu, vector dpdv,
                              shade_record *record) {
  record->u = u;
  record->v = v;
  record->tangent = dpdu;
  if (!def->uvs) return;
  vector corner[4], uv, du, dv;
  for (int k = 0; k < 4; k++) {
    const float *own = def->uvs + 2 * (size_t)face[k];
    corner[k] = make_vector((double)own[0], (double)own[1], 0);
  }
  between_corners(corner, u, v, &uv, &du, &dv);
  record->u = uv.x;
  record->v = uv.y;
  double d = du.x * dv.y - du.y * dv.x;
  if (fabs(d) > 1e-12) record->tangent = scale(1 / d, subtract(scale(dv.y, dpdu), scale(du.y, dpdv)));
}

static void patch_surface(const world *w, const primitive *p, double u, double v, shade_record *record) {
  const placement *where = &w->placements[p->placement];
  const uint32_t *face = where->def->indices + 4 * (size_t)p->face;
  double weights[4] = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
  vector dpdu, dpdv;
  between_corners(p->corner, u, v, &record->point, &dpdu, &dpdv);
  vector by_edges = cross(dpdu, dpdv);
  mesh_normals(where, face, weights, 4, by_edges, record);
  patch_coordinates(where->def, face, u, v, dpdu, dpdv, record);
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
