/* quadric.c: spheres, cylinders and disks (pbrt book 6.2 to 6.4), also parts of them. Each is a profile that is turned
 * around the z axis of its own space: half a circle, a line along the axis, a line towards it. */
#include "world.h"

typedef struct profile {
  double r, z, dr, dz; /* distance of a point from the axis, height, and their derivatives by v */
} profile;

/* The angle between the z axis and a point of a sphere at height z. */
static double theta_at(const vlShapeDef *def, double z) {
  return acos(clamp(z / (double)def->radius, -1, 1));
}

/* The point of the profile at v, 0 to 1: from the bottom to the top, or from the disk's edge inwards. */
static profile profile_at(const vlShapeDef *def, double v) {
  double radius = (double)def->radius, bottom = (double)def->z_min, height = (double)def->z_max - bottom;
  double inwards = (double)def->inner_radius - radius;
  if (def->kind == VL_SHAPE_CYLINDER) return (profile){radius, bottom + v * height, 0, height};
  if (def->kind == VL_SHAPE_DISK) return (profile){radius + v * inwards, (double)def->height, inwards, 0};
  double range = theta_at(def, (double)def->z_max) - theta_at(def, bottom);
  double theta = theta_at(def, bottom) + v * range;
  double r = radius * sin(theta), z = radius * cos(theta);
  return (profile){r, z, z * range, -r * range};
}

/* (u, v) of a point of the whole sphere, disk or cylinder, as m->a and m->b. The shape keeps the part where both are 0
 * to 1: u is the angle around the axis, v the way along the profile. */
static void coordinates_of(const vlShapeDef *def, vector p, meeting *m) {
  profile start = profile_at(def, 0), end = profile_at(def, 1);
  double phi = atan2(p.y, p.x), theta0 = theta_at(def, start.z), theta1 = theta_at(def, end.z);
  m->a = (phi < 0 ? phi + 2 * PI : phi) / (double)def->phi_max;
  if (def->kind == VL_SHAPE_SPHERE) m->b = (theta_at(def, p.z) - theta0) / (theta1 - theta0);
  if (def->kind == VL_SHAPE_CYLINDER) m->b = (p.z - start.z) / (end.z - start.z);
  if (def->kind == VL_SHAPE_DISK) m->b = (sqrt(p.x * p.x + p.y * p.y) - start.r) / (end.r - start.r);
}

/* Where the point o + t d is on the surface: it is put into x^2 + y^2 + z^2 = radius^2 for a sphere, x^2 + y^2 =
 * radius^2 for a cylinder, z = height for a disk, which gives a t^2 + 2 b t + c = 0. The ray goes to the shape's space
 * as it is, without normalizing its direction there: then t is the same as in the world. */
bool meet_quadric(const world *w, const primitive *p, ray r, meeting *m) {
  const placement *where = &w->placements[p->placement];
  const vlShapeDef *def = where->def;
  vector origin = transform_point(&where->shape_from_world, r.origin);
  vector direction = transform_vector(&where->shape_from_world, r.direction);
  vector o = origin, d = direction;
  if (def->kind == VL_SHAPE_CYLINDER) o.z = d.z = 0;
  bool disk = def->kind == VL_SHAPE_DISK;
  double a = disk ? 0 : dot(d, d);
  double b = disk ? d.z / 2 : dot(o, d);
  double c = disk ? o.z - (double)def->height : dot(o, o) - square((double)def->radius);
  double discriminant = b * b - a * c;
  if (!(discriminant >= 0)) return false;
  double q = -(b + copysign(sqrt(discriminant), b)); /* equal signs: no digits cancel. A disk has a = 0 and one root */
  double t[2] = {fmin(q / a, c / q), fmax(q / a, c / q)};
  for (int i = 0; i < 2; i++) {
    if (!(t[i] > r.t_min && t[i] < r.t_max)) continue;
    m->t = t[i];
    coordinates_of(def, add(origin, scale(t[i], direction)), m);
    if (m->a >= 0 && m->a <= 1 && m->b >= 0 && m->b <= 1) return true;
  }
  return false;
}

/* The surface at (u, v), with the normal dp/du x dp/dv. (u, v) is drawn uniformly from the unit square, so a point has
 * the density 1 / |dp/du x dp/dv| per area: that holds under any transform. */
void quadric_surface(const world *w, const primitive *p, double u, double v, shade_record *record) {
  const placement *where = &w->placements[p->placement];
  double phi_max = (double)where->def->phi_max, c = cos(u * phi_max), s = sin(u * phi_max);
  profile f = profile_at(where->def, v);
  vector dpdu = scale(f.r * phi_max, make_vector(-s, c, 0)), dpdv = make_vector(f.dr * c, f.dr * s, f.dz);
  vector normal = transform_normal(&where->shape_from_world, make_vector(f.dz * c, f.dz * s, -f.dr));
  record->point = transform_point(&where->world_from_shape, make_vector(f.r * c, f.r * s, f.z));
  record->normal = scale(where->flip ? -1 : 1, normalize(normal));
  record->shading_normal = record->normal;
  record->tangent = transform_vector(&where->world_from_shape, dpdu);
  record->u = u;
  record->v = v;
  double area = length(cross(record->tangent, transform_vector(&where->world_from_shape, dpdv)));
  record->area_density = area > 0 ? 1 / area : 0;
}
