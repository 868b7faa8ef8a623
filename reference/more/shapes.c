/* more/shapes.c: the shapes of more/, by kind. */
#include "more.h"
#include "patch.h"

uint32_t more_corners(const vlShapeDef *def) {
  return def->kind == VL_SHAPE_BILINEAR ? 4 : 0;
}

bool meet_more(const world *w, const primitive *p, ray r, meeting *m) {
  (void)w;
  return meet_patch(p, r, m);
}

void more_surface(const world *w, const primitive *p, double a, double b, shade_record *record) {
  patch_surface(w, p, a, b, record);
}

void bound_more(const world *w, primitive *p) {
  (void)w;
  for (int k = 0; k < 4; k++) include_point(p, p->corner[k]);
}
