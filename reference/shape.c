/* shape.c: a primitive of any kind. */
#include "more/more.h"

bool is_quadric(vlShapeKind kind) {
  return kind == VL_SHAPE_SPHERE || kind == VL_SHAPE_DISK || kind == VL_SHAPE_CYLINDER;
}

static bool meet_shape(const world *w, const primitive *p, ray r, meeting *m) {
  const placement *where = &w->placements[p->placement];
  vlShapeKind kind = where->def->kind;
  r = seen_at_rest(where, r);
  if (kind == VL_SHAPE_TRIANGLES) return meet_triangle(p, r, m);
  return is_quadric(kind) ? meet_quadric(w, p, r, m) : meet_more(w, p, r, m);
}

void shape_surface(const world *w, const primitive *p, double a, double b, shade_record *record) {
  record->what = p;
  record->where = &w->placements[p->placement];
  vlShapeKind kind = record->where->def->kind;
  if (kind == VL_SHAPE_TRIANGLES)
    triangle_surface(w, p, a, b, record);
  else if (is_quadric(kind))
    quadric_surface(w, p, a, b, record);
  else
    more_surface(w, p, a, b, record);
  carry_along(record);
}

/* (a, b) is a point of the unit square. A triangle is one half of it: points of the other half are turned onto it. */
void sample_shape(const world *w, const primitive *p, sampler *s, shade_record *record) {
  square_point u = sample_unit_square(s);
  bool fold = w->placements[p->placement].def->kind == VL_SHAPE_TRIANGLES && u.x + u.y > 1;
  shape_surface(w, p, fold ? 1 - u.x : u.x, fold ? 1 - u.y : u.y, record);
}

/* The first meeting of the ray with a primitive; a ray may meet a curved one twice. Alpha is the share of the surface
 * that is there: a lot decides whether the ray meets it, or goes through the hole to what is behind. */
static bool hit_primitive(const world *w, const primitive *p, ray r, sampler *s, shade_record *hit) {
  meeting m;
  while (meet_shape(w, p, r, &m)) {
    *hit = (shade_record){.t = m.t, .time = r.time, .a = m.a, .b = m.b, .arrival = r.direction};
    shape_surface(w, p, m.a, m.b, hit);
    double alpha = number_at(w, hit->where->def->alpha, hit);
    if (alpha >= 1 || next_number(s) < alpha) return true;
    r.t_min = m.t;
  }
  return false;
}

/* The lecture's loop over all objects. */
bool nearest_of(const world *w, uint32_t first, uint32_t count, ray *r, sampler *s, shade_record *hit) {
  bool found = false;
  for (uint32_t i = first; i < first + count; i++) {
    shade_record at;
    if (!hit_primitive(w, &w->primitives[i], *r, s, &at)) continue;
    *hit = at;
    r->t_max = at.t;
    found = true;
  }
  return found;
}
