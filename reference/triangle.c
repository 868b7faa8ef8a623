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
  double b1 = dot(from_corner, h) / d;
  if (b1 < 0 || b1 > 1) return false;
  vector q = cross(from_corner, edge1);
  double b2 = dot(r.direction, q) / d;
  if (b2 < 0 || b1 + b2 > 1) return false;
  *m = (meeting){dot(edge2, q) / d, b1, b2};
  return m->t > r.t_min && m->t < r.t_max;
}

static const double standard_uv[3][2] = {{0, 0}, {1, 0}, {1, 1}};

static void uv_of_corner(const vlShapeDef *def, uint32_t face, int corner, double uv[2]) {
  uint32_t vertex = def->indices[3 * (size_t)face + (size_t)corner];
  for (int i = 0; i < 2; i++)
    uv[i] = def->uvs ? (double)def->uvs[2 * (size_t)vertex + (size_t)i] : standard_uv[corner][i];
}

/* The tangent dp/du solves p_k - p_0 = (u_k - u_0) dp/du + (v_k - v_0) dp/dv for the corners k = 1, 2. */
static vector tangent_of(const primitive *p, double uv[3][2], vector normal) {
  vector edge1 = subtract(p->corner[1], p->corner[0]);
  vector edge2 = subtract(p->corner[2], p->corner[0]);
  double du1 = uv[1][0] - uv[0][0], dv1 = uv[1][1] - uv[0][1];
  double du2 = uv[2][0] - uv[0][0], dv2 = uv[2][1] - uv[0][1];
  double d = du1 * dv2 - dv1 * du2;
  if (fabs(d) < 1e-12) return make_frame(normal, edge1).s;
  return scale(1 / d, subtract(scale(dv2, edge1), scale(dv1, edge2)));
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

void triangle_surface(const world *w, const primitive *p, double b1, double b2, shade_record *record) {
  const placement *where = &w->placements[p->placement];
  const vlShapeDef *def = where->def;
  double b[3] = {1 - b1 - b2, b1, b2}, uv[3][2];
  mesh_corner corners[3];
  for (int k = 0; k < 3; k++) {
    corners[k] = (mesh_corner){def->indices[3 * (size_t)p->face + (size_t)k], b[k]};
    uv_of_corner(def, p->face, k, uv[k]);
  }
  vector by_edges = cross(subtract(p->corner[1], p->corner[0]), subtract(p->corner[2], p->corner[0]));
  mesh_normals(where, corners, 3, by_edges, record);
  record->point = blend(p->corner[0], p->corner[1], p->corner[2], b[0], b[1], b[2]);
  record->u = b[0] * uv[0][0] + b[1] * uv[1][0] + b[2] * uv[2][0];
  record->v = b[0] * uv[0][1] + b[1] * uv[1][1] + b[2] * uv[2][1];
  record->tangent = tangent_of(p, uv, record->normal);
  record->area_density = 2 / length(by_edges);
  record->what = p;
  record->where = where;
}
