/* scene/thick.c: see thick.h. */
#include "scene/thick.h"

#include <math.h>
#include <string.h>

#include "math/double3.h"

enum { SIDES = 6 };

static void point_at(const vlProbe *s, int ray, double p[3]) {
  vl_along3(s->o[ray], s->seen[ray].t, s->d[ray], p);
}

/* Whether the point is as good as on the surface of the box. */
static bool is_on(const vlExtent *box, const double p[3]) {
  const double near = 0.01;
  bool on = false;
  for (int i = 0; i < 3; i++) {
    const double margin = near * vl_extent_size(box, i);
    on = on || p[i] <= box->low[i] + margin || p[i] >= box->high[i] - margin;
  }
  return on;
}

/* Whether the eye sees nothing but the faces of the box, and a few holes in them. */
static bool is_box(const vlProbe *s, const vlExtent *box) {
  const double met_least = 0.95, on_least = 0.85;
  int met = 0, on = 0;
  for (int ray = 0; ray < VL_PROBE_OUTSIDE; ray++) {
    double p[3];
    if (!s->seen[ray].placed)
      continue;
    met++;
    point_at(s, ray, p);
    on += is_on(box, p) && !(s->seen[ray].back && s->seen[ray].placed->def->one_sided);
  }
  return met >= met_least * VL_PROBE_OUTSIDE && on >= on_least * met;
}

/* Where the rays from a point meet most, in the outer third of the box: the inside of the
 * wall. Returns the number of rays that meet it. */
static int find_wall(const vlProbe *s, const vlExtent *box, int first, int side, double *at) {
  const int axis = side / 2;
  const double size = vl_extent_size(box, axis), third = size / 3, same = 0.005 * size;
  const double end = side % 2 ? box->high[axis] : box->low[axis];
  int max = 0;
  *at = end;
  for (int k = first; k < first + VL_PROBE_AROUND; k++) {
    double p[3], q[3];
    int count = 0;
    if (!s->seen[k].placed)
      continue;
    point_at(s, k, p);
    for (int j = first; j < first + VL_PROBE_AROUND && fabs(p[axis] - end) <= third; j++) {
      if (!s->seen[j].placed)
        continue;
      point_at(s, j, q);
      count += fabs(q[axis] - p[axis]) <= same;
    }
    if (count > max) {
      max = count;
      *at = p[axis];
    }
  }
  return max;
}

/* Whether a point on something is well inside of the walls: furniture. */
static bool is_inside(const vlExtent *inner, const double p[3]) {
  const double away = 0.02;
  bool inside = true;
  for (int i = 0; i < 3; i++) {
    const double margin = away * vl_extent_size(inner, i);
    inside = inside && p[i] >= inner->low[i] + margin && p[i] <= inner->high[i] - margin;
  }
  return inside;
}

/* Whether the point in the model has walls around it, and what else the rays from it meet. */
static bool find_walls(const vlProbe *s, const vlExtent *box, int first, vlExtent *inner) {
  const double thickest = 0.2, met_least = 0.9, front_least = 0.9;
  const int few = 2, walls_least = SIDES - 1;
  int met = 0, fronts = 0, things = 0, walls = 0;
  for (int side = 0; side < SIDES; side++) {
    const int axis = side / 2;
    double *at = side % 2 ? &inner->high[axis] : &inner->low[axis];
    const double end = side % 2 ? box->high[axis] : box->low[axis];
    walls += find_wall(s, box, first, side, at) >= few;
    if (fabs(*at - end) > thickest * vl_extent_size(box, axis))
      return false;
  }
  for (int k = first; k < first + VL_PROBE_AROUND; k++) {
    double p[3];
    if (!s->seen[k].placed)
      continue;
    point_at(s, k, p);
    met++;
    fronts += !s->seen[k].back;
    things += is_inside(inner, p);
  }
  return walls >= walls_least && met >= met_least * VL_PROBE_AROUND &&
         fronts >= front_least * met && things >= few;
}

bool vl_thick_find(const vlProbe *s, const vlExtent *box, vlThick *thick, double middle[3]) {
  if (!is_box(s, box))
    return false;
  for (int point = 0; point < VL_PROBE_POINTS; point++) {
    const int first = VL_PROBE_OUTSIDE + point * VL_PROBE_AROUND;
    if (!find_walls(s, box, first, &thick->inner))
      continue;
    thick->outer = *box;
    memcpy(middle, s->o[first], 3 * sizeof *middle);
    return true;
  }
  return false;
}

bool vl_thick_hides(const vlThick *thick, const double corners[3][3], const double eye[3]) {
  const double margin = 0.002;
  bool hides = false;
  for (int side = 0; side < SIDES; side++) {
    const int axis = side / 2;
    const double sign = side % 2 ? 1 : -1;
    const double outer = side % 2 ? thick->outer.high[axis] : thick->outer.low[axis];
    const double inner = side % 2 ? thick->inner.high[axis] : thick->inner.low[axis];
    const double from = sign * inner - margin * vl_extent_size(&thick->outer, axis);
    if (!(sign * (eye[axis] - outer) > 0))
      continue;
    bool in_wall = true;
    for (int k = 0; k < 3; k++)
      in_wall = in_wall && sign * corners[k][axis] >= from;
    hides = hides || in_wall;
  }
  return hides;
}
