/* more/shapes.c: the shapes of more/, by kind. */
#include "more.h"
#include "program/program.h"

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
  if (is_curve(w, p))
    curve_surface(w, p, a, b, record);
  else
    patch_surface(w, p, a, b, record);
}

void bound_more(const world *w, primitive *p) {
  if (is_curve(w, p)) bound_curve(w, p);
  for (int k = 0; k < 4; k++) include_point(p, p->corner[k]);
}
