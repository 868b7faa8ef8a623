/* quadric.c: spheres, disks and cylinders (pbrt book 6.2 to 6.4), also parts of them. Rays are taken to the space of
 * the shape, where the axis is z; t stays the same if the direction keeps its length. */
#include "world.h"

/* Polar angles of the sphere's edges z_min and z_max. */
static double theta_at(const vlShapeDef *def, double z) {
  return acos(clamp(z / (double)def->radius, -1, 1));
}

/* The coordinates of a point of the whole sphere, disk or cylinder. They are 0 to 1 on the part that the shape keeps:
 * u goes around the axis, v from the bottom to the top, or from the disk's edge inwards. */
static void coordinates_of(const vlShapeDef *def, vector p, meeting *m) {
  double phi = atan2(p.y, p.x);
  double bottom = (double)def->z_min, top = (double)def->z_max, radius = (double)def->radius;
  m->a = (phi < 0 ? phi + 2 * PI : phi) / (double)def->phi_max;
  if (def->kind == VL_SHAPE_SPHERE) {
    bottom = theta_at(def, bottom);
    top = theta_at(def, top);
    m->b = (theta_at(def, p.z) - bottom) / (top - bottom);
  } else if (def->kind == VL_SHAPE_CYLINDER) {
    m->b = (p.z - bottom) / (top - bottom);
  } else {
    m->b = (radius - sqrt(p.x * p.x + p.y * p.y)) / (radius - (double)def->inner_radius);
  }
}

/* The points o + t d of the surface are the roots of a t^2 + 2 b t + c: put into x^2 + y^2 + z^2 = radius^2 for a
 * sphere, x^2 + y^2 = radius^2 for a cylinder, z = height for a disk. */
bool meet_quadric(const world *w, const primitive *p, ray r, meeting *m) {
  const placement *where = &w->placements[p->placement];
  const vlShapeDef *def = where->def;
  vector origin = transform_point(&where->shape_from_world, r.origin);
  vector direction = transform_vector(&where->shape_from_world, r.direction);
  vector o = origin, d = direction;
  if (def->kind == VL_SHAPE_CYLINDER) o.z = d.z = 0;
  double a = dot(d, d), b = dot(o, d), c = dot(o, o) - square((double)def->radius);
  if (def->kind == VL_SHAPE_DISK) {
    a = 0;
    b = d.z / 2;
    c = o.z - (double)def->height;
  }
  double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return false;
  double q = -(b + copysign(sqrt(discriminant), b)); /* a sum of equal signs: nothing cancels */
  double t[2] = {fmin(q / a, c / q), fmax(q / a, c / q)};
  for (int i = 0; i < 2; i++) {
    if (!(t[i] > r.t_min && t[i] < r.t_max)) continue;
    m->t = t[i];
    coordinates_of(def, add(origin, scale(t[i], direction)), m);
    if (m->a >= 0 && m->a <= 1 && m->b >= 0 && m->b <= 1) return true;
  }
  return false;
}

/* The point at (u, v), its derivatives and its normal, in the space of the shape. */
static vector point_at(const vlShapeDef *def, double u, double v, vector *dpdu, vector *dpdv, vector *normal) {
  double phi_max = (double)def->phi_max, radius = (double)def->radius;
  double bottom = (double)def->z_min, top = (double)def->z_max;
  double c = cos(u * phi_max), s = sin(u * phi_max);
  vector p;
  if (def->kind == VL_SHAPE_SPHERE) {
    double range = theta_at(def, top) - theta_at(def, bottom);
    double theta = theta_at(def, bottom) + v * range;
    p = make_vector(radius * sin(theta) * c, radius * sin(theta) * s, radius * cos(theta));
    *dpdv = scale(range, make_vector(p.z * c, p.z * s, -radius * sin(theta)));
    *normal = p;
  } else if (def->kind == VL_SHAPE_CYLINDER) {
    p = make_vector(radius * c, radius * s, bottom + v * (top - bottom));
    *dpdv = make_vector(0, 0, top - bottom);
    *normal = make_vector(c, s, 0);
  } else {
    double inwards = (double)def->inner_radius - radius;
    p = make_vector((radius + v * inwards) * c, (radius + v * inwards) * s, (double)def->height);
    *dpdv = make_vector(inwards * c, inwards * s, 0);
    *normal = make_vector(0, 0, 1);
  }
  *dpdu = make_vector(-phi_max * p.y, phi_max * p.x, 0);
  return p;
}

/* The surface at (u, v). (u, v) is drawn uniformly from the unit square, so a point has the density 1 / |dp/du x dp/dv|
 * per area: that holds under any transform. */
void quadric_surface(const world *w, const primitive *p, double u, double v, shade_record *record) {
  const placement *where = &w->placements[p->placement];
  vector dpdu, dpdv, normal;
  vector point = point_at(where->def, u, v, &dpdu, &dpdv, &normal);
  normal = normalize(transform_normal(&where->shape_from_world, normal));
  record->point = transform_point(&where->world_from_shape, point);
  record->normal = where->flip ? negate(normal) : normal;
  record->shading_normal = record->normal;
  record->tangent = transform_vector(&where->world_from_shape, dpdu);
  record->u = u;
  record->v = v;
  double area = length(cross(record->tangent, transform_vector(&where->world_from_shape, dpdv)));
  record->area_density = area > 0 ? 1 / area : 0;
}
