/* shape.c: a primitive of any kind. */
#include "more/more.h"

static const vlShapeDef *def_of(const world *w, const primitive *p) {
  return w->placements[p->placement].def;
}

bool is_quadric(vlShapeKind kind) {
  return kind == VL_SHAPE_SPHERE || kind == VL_SHAPE_DISK || kind == VL_SHAPE_CYLINDER;
}

static bool meet_shape(const world *w, const primitive *p, ray r, meeting *m) {
  vlShapeKind kind = def_of(w, p)->kind;
  r = seen_at_rest(&w->placements[p->placement], r);
  if (kind == VL_SHAPE_TRIANGLES) return meet_triangle(p, r, m);
  return is_quadric(kind) ? meet_quadric(w, p, r, m) : meet_more(w, p, r, m);
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
  carry_along(record);
}

/* Folding the unit square on its diagonal makes a uniform point of a triangle. */
void sample_shape(const world *w, const primitive *p, sampler *s, shade_record *record) {
  square_point u = sample_unit_square(s);
  bool fold = def_of(w, p)->kind == VL_SHAPE_TRIANGLES && u.x + u.y > 1;
  shape_surface(w, p, fold ? 1 - u.x : u.x, fold ? 1 - u.y : u.y, record);
}

/* The lecture's loop over all objects. A ray may meet a curved primitive twice: the second time counts where the
 * surface is not there the first time. Alpha is the share of the surface that is there. */
bool nearest_of(const world *w, uint32_t first, uint32_t count, ray *r, sampler *s, shade_record *hit) {
  bool found = false;
  for (uint32_t i = first; i < first + count; i++) {
    meeting m;
    for (ray rest = *r; meet_shape(w, &w->primitives[i], rest, &m); rest.t_min = m.t) {
      shade_record record = {.t = m.t, .time = r->time, .a = m.a, .b = m.b, .arrival = r->direction};
      shape_surface(w, &w->primitives[i], m.a, m.b, &record);
      double alpha = number_at(w, record.where->def->alpha, &record);
      if (alpha < 1 && next_number(s) >= alpha) continue;
      *hit = record;
      r->t_max = m.t;
      found = true;
      break;
    }
  }
  return found;
}
