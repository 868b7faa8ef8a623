/* more/bump.c: bump maps and normal maps. The surface p + h n has other normals than p. Shapes are maps of two
 * coordinates (a, b); so the displaced surface is one, too, and its slopes are differences. Where a mesh has vertex
 * normals, p is the smooth surface that they stand for: its tangents are those of the face, turned as its normal is. */
#include "more.h"

/* The point at (a, b), with `share` of its displacement. */
static vector displaced(const world *w, const vlMaterialDef *m, const shade_record *at, double a, double b,
                        double share) {
  shade_record near = {.arrival = at->arrival, .time = at->time};
  shape_surface(w, at->what, a, b, &near);
  return add(near.point, scale(share * number_at(w, m->displacement, &near), near.shading_normal));
}

/* A vector, turned by the rotation from g to n (Rodrigues). */
static vector turned(vector v, vector g, vector n) {
  vector axis = cross(g, n), along = scale(dot(axis, v) / (1 + dot(g, n)), axis);
  return add(along, add(scale(dot(g, n), v), cross(axis, v)));
}

static void follow_bumps(const world *w, const vlMaterialDef *m, shade_record *at) {
  const double d = 1e-5;
  vector along_a = subtract(displaced(w, m, at, at->a + d, at->b, 1), displaced(w, m, at, at->a - d, at->b, 1));
  vector along_b = subtract(displaced(w, m, at, at->a, at->b + d, 1), displaced(w, m, at, at->a, at->b - d, 1));
  vector pa = subtract(displaced(w, m, at, at->a + d, at->b, 0), displaced(w, m, at, at->a - d, at->b, 0));
  vector pb = subtract(displaced(w, m, at, at->a, at->b + d, 0), displaced(w, m, at, at->a, at->b - d, 0));
  vector g = face_forward(normalize(cross(pa, pb)), at->shading_normal);
  along_a = add(along_a, subtract(turned(pa, g, at->shading_normal), pa));
  along_b = add(along_b, subtract(turned(pb, g, at->shading_normal), pb));
  vector n = cross(along_a, along_b);
  if (length(n) == 0) return;
  /* the tangent is a mixture of the slopes, and becomes the same mixture of the new ones */
  double aa = dot(pa, pa), ab = dot(pa, pb), bb = dot(pb, pb), area2 = aa * bb - ab * ab;
  double ta = dot(at->tangent, pa), tb = dot(at->tangent, pb);
  if (area2 > 0) {
    vector by_a = scale((ta * bb - tb * ab) / area2, along_a), by_b = scale((tb * aa - ta * ab) / area2, along_b);
    at->tangent = add(by_a, by_b);
  }
  at->shading_normal = face_forward(normalize(n), at->shading_normal);
}

/* The tangents of a mesh's vertices, where it has them, take the place of dp/du. */
static void follow_tangents(shade_record *at) {
  const vlShapeDef *def = at->where->def;
  double weights[3] = {1 - at->a - at->b, at->a, at->b};
  vector sum = make_vector(0, 0, 0);
  for (uint32_t k = 0; k < 3; k++) {
    const float *own = def->tangents + 3 * (size_t)def->indices[3 * (size_t)at->what->face + k];
    sum = add(sum, scale(weights[k], from_floats(own)));
  }
  at->tangent = transform_vector(&at->where->world_from_shape, sum);
}

/* The principled material's own map is a texture. Its y grows along the sign of the vertices times n x t. */
static void bend_principled(const world *w, const vlPrincipledDef *d, shade_record *at) {
  const vlShapeDef *def = at->where->def;
  vlSpectrumInput map = {.texture = d->normal};
  spectrum t = spectrum_at(w, &map, VL_PARAMETER_UNBOUNDED, at, &(wavelengths){.rgb = true});
  double factor = (double)d->normal_scale, sign = (double)def->tangent_signs[def->indices[3 * (size_t)at->what->face]];
  vector n = make_vector(factor * (2 * t.c[0] - 1), sign * factor * (2 * t.c[1] - 1), 2 * t.c[2] - 1);
  at->shading_normal = normalize(from_local(make_frame(at->shading_normal, at->tangent), n));
}

/* A texel of a normal map has a normal's coordinates, from -1 to 1, in the frame of the tangent and the normal. */
void bend_normal(const world *w, const vlMaterialDef *m, shade_record *at) {
  if (at->where->def->tangents) follow_tangents(at);
  if (m->displacement.texture.index) follow_bumps(w, m, at);
  if (m->kind == VL_MATERIAL_PRINCIPLED && m->principled.normal.index) bend_principled(w, &m->principled, at);
  if (!m->normal_map) return;
  uint32_t i = 0;
  while (vl_scene_material(w->scene, (vlMaterialId){i + 1}) != m) i++;
  double rgb[4];
  pixels_around(&w->normal_maps[i], at->u, 1 - at->v, VL_WRAP_REPEAT, VL_WRAP_REPEAT, rgb);
  frame f = make_frame(at->shading_normal, at->tangent);
  at->shading_normal = normalize(from_local(f, make_vector(2 * rgb[0] - 1, 2 * rgb[1] - 1, 2 * rgb[2] - 1)));
}
