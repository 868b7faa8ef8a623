/* shape.c: a primitive of any kind. */
#include "world.h"

static vlShapeKind kind_of(const world *w, const primitive *p) {
  return w->placements[p->placement].def->kind;
}

bool meet_shape(const world *w, const primitive *p, ray r, meeting *m) {
  switch (kind_of(w, p)) {
    case VL_SHAPE_TRIANGLES: return meet_triangle(p, r, m);
    case VL_SHAPE_BILINEAR: return meet_patch(p, r, m);
    default: return meet_quadric(w, p, r, m);
  }
}

void shape_surface(const world *w, const primitive *p, double a, double b, shade_record *record) {
  switch (kind_of(w, p)) {
    case VL_SHAPE_TRIANGLES: triangle_surface(w, p, a, b, record); break;
    case VL_SHAPE_BILINEAR: patch_surface(w, p, a, b, record); break;
    default: quadric_surface(w, p, a, b, record); break;
  }
}

/* Folding the unit square on its diagonal makes a uniform point of a triangle. */
void sample_shape(const world *w, const primitive *p, sampler *s, shade_record *record) {
  square_point u = sample_unit_square(s);
  bool fold = kind_of(w, p) == VL_SHAPE_TRIANGLES && u.x + u.y > 1;
  if (fold) u = (square_point){1 - u.x, 1 - u.y};
  shape_surface(w, p, u.x, u.y, record);
}

static void include(vector p, vector *low, vector *high) {
  *low = make_vector(fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z));
  *high = make_vector(fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z));
}

/* The box around the corners; of a quadric those of its box in the space of the shape, taken to the world. */
void bound_shape(const world *w, const primitive *p, vector *low, vector *high) {
  const placement *where = &w->placements[p->placement];
  const vlShapeDef *def = where->def;
  *low = make_vector(INFINITY, INFINITY, INFINITY);
  *high = negate(*low);
  if (def->kind == VL_SHAPE_TRIANGLES || def->kind == VL_SHAPE_BILINEAR) {
    for (int k = 0; k < (def->kind == VL_SHAPE_TRIANGLES ? 3 : 4); k++) include(p->corner[k], low, high);
    return;
  }
  double radius = (double)def->radius, bottom = (double)def->z_min, top = (double)def->z_max;
  if (def->kind == VL_SHAPE_DISK) bottom = top = (double)def->height;
  for (int k = 0; k < 8; k++) {
    vector corner = make_vector(k & 1 ? radius : -radius, k & 2 ? radius : -radius, k & 4 ? top : bottom);
    include(transform_point(&where->world_from_shape, corner), low, high);
  }
}
