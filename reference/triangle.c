/* triangle.c: triangles. */
#include "world.h"

/* Moeller and Trumbore 1997: the point origin + t direction lies in the plane at corner0 + b1 edge1 + b2 edge2.
 * Cramer's rule gives t, b1 and b2; the point is in the triangle if b1, b2 and 1 - b1 - b2 are not negative. */
bool meet_triangle(const primitive *p, ray r, double *t) {
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
  *t = dot(edge2, q) / d;
  return *t > r.t_min && *t < r.t_max;
}

/* The weights of the corners at a point of the plane: the areas of the three parts. */
static void weights_at(const primitive *p, vector point, double b[3]) {
  vector edge1 = subtract(p->corner[1], p->corner[0]);
  vector edge2 = subtract(p->corner[2], p->corner[0]);
  vector n = cross(edge1, edge2);
  vector from_corner = subtract(point, p->corner[0]);
  double area = dot(n, n);
  b[1] = dot(cross(from_corner, edge2), n) / area;
  b[2] = dot(cross(edge1, from_corner), n) / area;
  b[0] = 1 - b[1] - b[2];
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
void triangle_surface(const world *w, const primitive *p, vector point, shade_record *record) {
  const placement *where = &w->placements[p->placement];
  const vlShapeDef *def = where->def;
  double b[3], uv[3][2];
  weights_at(p, point, b);
  for (int k = 0; k < 3; k++) uv_of_corner(def, p->face, k, uv[k]);
  vector n = cross(subtract(p->corner[1], p->corner[0]), subtract(p->corner[2], p->corner[0]));
  double area = 0.5 * length(n);
  n = normalize(n);
  if (where->mesh_mirrored) n = negate(n);
  vector interpolated = n;
  if (def->normals) {
    vector corner[3];
    for (int k = 0; k < 3; k++) {
      const float *own = def->normals + 3 * (size_t)def->indices[3 * (size_t)p->face + (size_t)k];
      corner[k] = normalize(transform_normal(&where->shape_from_world, from_floats(own)));
    }
    interpolated = blend(corner[0], corner[1], corner[2], b[0], b[1], b[2]);
    if (length(interpolated) > 0) interpolated = normalize(interpolated);
    if (length(interpolated) == 0) interpolated = n;
    if (def->reverse_orientation) interpolated = negate(interpolated);
    n = face_forward(n, interpolated);
  } else if (def->reverse_orientation) {
    n = negate(n);
    interpolated = n;
  }
  record->point = point;
  record->normal = n;
  record->shading_normal = interpolated;
  record->u = b[0] * uv[0][0] + b[1] * uv[1][0] + b[2] * uv[2][0];
  record->v = b[0] * uv[0][1] + b[1] * uv[1][1] + b[2] * uv[2][1];
  record->tangent = tangent_of(p, uv, n);
  record->area_density = 1 / area;
  record->what = p;
  record->where = where;
}

/* Folding the unit square on its diagonal makes a uniform point of a triangle. */
void sample_triangle(const world *w, const primitive *p, sampler *s, shade_record *record) {
  square_point u = sample_unit_square(s);
  if (u.x + u.y > 1) {
    u.x = 1 - u.x;
    u.y = 1 - u.y;
  }
  vector point = blend(p->corner[0], p->corner[1], p->corner[2], 1 - u.x - u.y, u.x, u.y);
  triangle_surface(w, p, point, record);
}
