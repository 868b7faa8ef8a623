/* more/bump.c: bump maps. The surface p + h n has other normals than p. Shapes are maps of two coordinates (a, b); so
 * the displaced surface is one, too, and its slopes are differences. */
#include "more.h"

static vector displaced(const world *w, const vlMaterialDef *m, const shade_record *at, double a, double b) {
  shade_record near = {.arrival = at->arrival, .time = at->time};
  shape_surface(w, at->what, a, b, &near);
  return add(near.point, scale(number_at(w, m->displacement, &near), near.shading_normal));
}

static vector point_of(const world *w, const shade_record *at, double a, double b) {
  shade_record near = {.arrival = at->arrival, .time = at->time};
  shape_surface(w, at->what, a, b, &near);
  return near.point;
}

void bend_normal(const world *w, const vlMaterialDef *m, shade_record *at) {
  const double d = 1e-5;
  if (!m->displacement.texture.index) return;
  vector along_a = subtract(displaced(w, m, at, at->a + d, at->b), displaced(w, m, at, at->a - d, at->b));
  vector along_b = subtract(displaced(w, m, at, at->a, at->b + d), displaced(w, m, at, at->a, at->b - d));
  vector n = cross(along_a, along_b);
  if (length(n) == 0) return;
  /* the tangent is a mixture of the slopes, and becomes the same mixture of the new ones */
  vector pa = subtract(point_of(w, at, at->a + d, at->b), point_of(w, at, at->a - d, at->b));
  vector pb = subtract(point_of(w, at, at->a, at->b + d), point_of(w, at, at->a, at->b - d));
  double aa = dot(pa, pa), ab = dot(pa, pb), bb = dot(pb, pb), area2 = aa * bb - ab * ab;
  double ta = dot(at->tangent, pa), tb = dot(at->tangent, pb);
  if (area2 > 0) {
    vector by_a = scale((ta * bb - tb * ab) / area2, along_a), by_b = scale((tb * aa - ta * ab) / area2, along_b);
    at->tangent = add(by_a, by_b);
  }
  at->shading_normal = face_forward(normalize(n), at->shading_normal);
}
