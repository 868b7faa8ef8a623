/* triangle.c: triangles, and the normals of all meshes. */
#include "more/more.h"

/* Moeller and Trumbore 1997. The point origin + t direction lies in the plane at corner0 + b1 edge1 + b2 edge2:
 *   -t direction + b1 edge1 + b2 edge2 = origin - corner0,
 * three equations, for x, y and z. By Cramer's rule each unknown is one determinant over another; the determinant of
 * three columns is a . (b x c). The point is in the triangle if b1, b2 and 1 - b1 - b2 are not negative. */
bool meet_triangle(const primitive *p, ray r, meeting *m) {
  vector edge1 = subtract(p->corner[1], p->corner[0]), edge2 = subtract(p->corner[2], p->corner[0]);
  vector direction_by_edge2 = cross(r.direction, edge2);
  double denominator = dot(edge1, direction_by_edge2);
  if (denominator == 0) return false; /* the ray is parallel to the plane */
  vector from_corner = subtract(r.origin, p->corner[0]);
  vector from_corner_by_edge1 = cross(from_corner, edge1);
  m->t = dot(edge2, from_corner_by_edge1) / denominator;
  m->a = dot(from_corner, direction_by_edge2) / denominator; /* b1; b is b2 */
  m->b = dot(r.direction, from_corner_by_edge1) / denominator;
  return m->a >= 0 && m->b >= 0 && m->a + m->b <= 1 && m->t > r.t_min && m->t < r.t_max;
}

/* Which side is the outside: that of the cross product of the edges, taken in the shape's own space;
 * reverse_orientation turns it. Vertex normals, where there are any, decide instead. */
void mesh_normals(const placement *where, const uint32_t *vertices, const double *weights, int count, vector by_edges,
                  shade_record *record) {
  const vlShapeDef *def = where->def;
  bool turned = where->mesh_mirrored != (def->reverse_orientation && !def->normals);
  record->normal = scale(turned ? -1 : 1, normalize(by_edges));
  record->shading_normal = record->normal;
  vector sum = make_vector(0, 0, 0);
  for (int k = 0; def->normals && k < count; k++) {
    vector own = transform_normal(&where->shape_from_world, from_floats(def->normals + 3 * (size_t)vertices[k]));
    sum = add(sum, scale(weights[k], own));
  }
  if (length(sum) == 0) return;
  record->shading_normal = scale(def->reverse_orientation ? -1 : 1, normalize(sum));
  record->normal = face_forward(record->normal, record->shading_normal);
}

/* b0, b1, b2 are the weights of the corners. Their texture coordinates are given, or (0, 0), (1, 0), (1, 1). The
 * tangent dp/du solves p_k - p_0 = (u_k - u_0) dp/du + (v_k - v_0) dp/dv for the corners k = 1, 2 (pbrt book 6.5.3). */
void triangle_surface(const world *w, const primitive *p, double b1, double b2, shade_record *record) {
  const placement *where = &w->placements[p->placement];
  const uint32_t *vertices = where->def->indices + 3 * (size_t)p->face;
  const float *uvs = where->def->uvs;
  double b[3] = {1 - b1 - b2, b1, b2}, u[3] = {0, 1, 1}, v[3] = {0, 0, 1};
  for (int k = 0; uvs && k < 3; k++) {
    u[k] = (double)uvs[2 * (size_t)vertices[k]];
    v[k] = (double)uvs[2 * (size_t)vertices[k] + 1];
  }
  vector edge1 = subtract(p->corner[1], p->corner[0]), edge2 = subtract(p->corner[2], p->corner[0]);
  vector by_edges = cross(edge1, edge2);
  mesh_normals(where, vertices, b, 3, by_edges, record);
  record->point = blend(p->corner[0], p->corner[1], p->corner[2], b[0], b[1], b[2]);
  record->u = b[0] * u[0] + b[1] * u[1] + b[2] * u[2];
  record->v = b[0] * v[0] + b[1] * v[1] + b[2] * v[2];
  record->area_density = 2 / length(by_edges); /* 1 / area */
  double uv_area = (u[1] - u[0]) * (v[2] - v[0]) - (v[1] - v[0]) * (u[2] - u[0]);
  record->tangent = scale(1 / uv_area, subtract(scale(v[2] - v[0], edge1), scale(v[1] - v[0], edge2)));
  if (fabs(uv_area) < 1e-12) record->tangent = edge1; /* coordinates on a line: there is no dp/du */
}
