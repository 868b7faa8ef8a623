/* triangle.c: triangles. */
#include "world.h"

/* Moeller and Trumbore 1997: the point origin + t direction lies in the plane at corner0 + b1 edge1 + b2 edge2.
 * Cramer's rule gives t, b1 and b2; the point is in the triangle if b1, b2 and 1 - b1 - b2 are not negative. */
bool meet_triangle(const primitive *p, ray r, meeting *m) {
  vector edge1 = subtract(p->corner[1], p->corner[0]);
  vector edge2 = subtract(p->corner[2], p->corner[0]);
  vector h = cross(r.direction, edge2);
  double d = dot(edge1, h);
  if (d == 0) return false; /* the ray is parallel to the plane */
  vector from_corner = subtract(r.origin, p->corner[0]);
  vector q = cross(from_corner, edge1);
  *m = (meeting){dot(edge2, q) / d, dot(from_corner, h) / d, dot(r.direction, q) / d};
  return m->a >= 0 && m->b >= 0 && m->a + m->b <= 1 && m->t > r.t_min && m->t < r.t_max;
}

/* Sides: the normal of a mesh is the cross product of its edges in the space of its shape, turned by
 * reverse_orientation; vertex normals, where there are any, decide the side instead. */
void mesh_normals(const placement *where, const mesh_corner *corners, int count, vector by_edges,
                  shade_record *record) {
  const vlShapeDef *def = where->def;
  vector n = normalize(by_edges);
  if (where->mesh_mirrored != (def->reverse_orientation && !def->normals)) n = negate(n);
  record->normal = n;
  record->shading_normal = n;
  if (!def->normals) return;
  vector sum = make_vector(0, 0, 0);
  for (int k = 0; k < count; k++) {
    vector own = from_floats(def->normals + 3 * (size_t)corners[k].vertex);
    sum = add(sum, scale(corners[k].weight, transform_normal(&where->shape_from_world, own)));
  }
  if (length(sum) == 0) return;
  record->shading_normal = scale(def->reverse_orientation ? -1 : 1, normalize(sum));
  record->normal = face_forward(n, record->shading_normal);
}

/* The texture coordinates of the corners are given, or (0, 0), (1, 0), (1, 1). The tangent dp/du solves
 * p_k - p_0 = (u_k - u_0) dp/du + (v_k - v_0) dp/dv for the corners k = 1, 2. */
void triangle_surface(const world *w, const primitive *p, double b1, double b2, shade_record *record) {
  const placement *where = &w->placements[p->placement];
  const vlShapeDef *def = where->def;
  double b[3] = {1 - b1 - b2, b1, b2}, u[3] = {0, 1, 1}, v[3] = {0, 0, 1};
  mesh_corner corners[3];
  for (int k = 0; k < 3; k++) {
    corners[k] = (mesh_corner){def->indices[3 * (size_t)p->face + (size_t)k], b[k]};
    if (def->uvs) u[k] = (double)def->uvs[2 * (size_t)corners[k].vertex];
    if (def->uvs) v[k] = (double)def->uvs[2 * (size_t)corners[k].vertex + 1];
  }
  vector edge1 = subtract(p->corner[1], p->corner[0]), edge2 = subtract(p->corner[2], p->corner[0]);
  vector by_edges = cross(edge1, edge2);
  mesh_normals(where, corners, 3, by_edges, record);
  record->point = blend(p->corner[0], p->corner[1], p->corner[2], b[0], b[1], b[2]);
  record->u = b[0] * u[0] + b[1] * u[1] + b[2] * u[2];
  record->v = b[0] * v[0] + b[1] * v[1] + b[2] * v[2];
  record->area_density = 2 / length(by_edges);
  double d = (u[1] - u[0]) * (v[2] - v[0]) - (v[1] - v[0]) * (u[2] - u[0]);
  record->tangent = edge1;
  if (fabs(d) < 1e-12) return;
  record->tangent = scale(1 / d, subtract(scale(v[2] - v[0], edge1), scale(v[1] - v[0], edge2)));
}
