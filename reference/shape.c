/* shape.c: a primitive of any kind. */
#include "more/more.h"

static const vlShapeDef *def_of(const world *w, const primitive *p) {
  return w->placements[p->placement].def;
}

static bool is_quadric(vlShapeKind kind) {
  return kind == VL_SHAPE_SPHERE || kind == VL_SHAPE_DISK || kind == VL_SHAPE_CYLINDER;
}

bool meet_shape(const world *w, const primitive *p, ray r, meeting *m) {
  vlShapeKind kind = def_of(w, p)->kind;
  if (kind == VL_SHAPE_TRIANGLES) return meet_triangle(p, r, m);
  if (is_quadric(kind)) return meet_quadric(w, p, r, m);
  return meet_more(w, p, r, m);
}

void shape_surface(const world *w, const primitive *p, double a, double b, shade_record *record) {
  vlShapeKind kind = def_of(w, p)->kind;
  record->what = p;
  record->where = &w->placements[p->placement];
  if (kind == VL_SHAPE_TRIANGLES)
    triangle_surface(w, p, a, b, record);
  else if (is_quadric(kind))
    quadric_surface(w, p, a, b, record);
  else
    more_surface(w, p, a, b, record);
}

/* Folding the unit square on its diagonal makes a uniform point of a triangle. */
void sample_shape(const world *w, const primitive *p, sampler *s, shade_record *record) {
  square_point u = sample_unit_square(s);
  bool fold = def_of(w, p)->kind == VL_SHAPE_TRIANGLES && u.x + u.y > 1;
  if (fold) u = (square_point){1 - u.x, 1 - u.y};
  shape_surface(w, p, u.x, u.y, record);
}

void include_point(primitive *p, vector point) {
  p->low = least(p->low, point);
  p->high = greatest(p->high, point);
}

/* The box around the corners; of a quadric those of its box in the space of the shape, taken to the world. */
void bound_shape(const world *w, primitive *p) {
  const vlShapeDef *def = def_of(w, p);
  p->low = make_vector(INFINITY, INFINITY, INFINITY);
  p->high = negate(p->low);
  if (def->kind == VL_SHAPE_TRIANGLES) {
    for (int k = 0; k < 3; k++) include_point(p, p->corner[k]);
    return;
  }
  if (!is_quadric(def->kind)) {
    bound_more(w, p);
    return;
  }
  double radius = (double)def->radius, bottom = (double)def->z_min, top = (double)def->z_max;
  if (def->kind == VL_SHAPE_DISK) bottom = top = (double)def->height;
  for (int k = 0; k < 8; k++) {
    vector corner = make_vector(k & 1 ? radius : -radius, k & 2 ? radius : -radius, k & 4 ? top : bottom);
    include_point(p, transform_point(&w->placements[p->placement].world_from_shape, corner));
  }
}
