/* quadric.c: spheres, disks and cylinders (pbrt book 6.2 to 6.4), also parts of them. Rays are taken to the space of
 * the shape, where the axis is z; t stays the same if the direction keeps its length. */
#include "world.h"

/* The angle around the axis, 0 to 2 pi. */
static double angle_of(vector p) {
  double phi = atan2(p.y, p.x);
  return phi < 0 ? phi + 2 * PI : phi;
}

/* Whether a point of the whole sphere, disk or cylinder is on the part that the shape keeps. */
static bool is_kept(const vlShapeDef *def, vector p) {
  if (angle_of(p) > (double)def->phi_max) return false;
  double from_axis = p.x * p.x + p.y * p.y;
  switch (def->kind) {
    case VL_SHAPE_SPHERE:
      return (p.z >= (double)def->z_min || def->z_min <= -def->radius) &&
             (p.z <= (double)def->z_max || def->z_max >= def->radius);
    case VL_SHAPE_DISK:
      return from_axis <= square((double)def->radius) && from_axis >= square((double)def->inner_radius);
    case VL_SHAPE_CYLINDER: return p.z >= (double)def->z_min && p.z <= (double)def->z_max;
    default: return false;
  }
}

/* The roots of a t^2 + 2 half_b t + c, computed without cancellation: the second is c / (a times the first). */
static int roots(double a, double half_b, double c, double t[2]) {
  double d = half_b * half_b - a * c;
  if (d < 0 || a == 0) return 0;
  double q = half_b < 0 ? -half_b + sqrt(d) : -half_b - sqrt(d);
  t[0] = q / a;
  t[1] = q != 0 ? c / q : 0;
  if (t[0] > t[1]) {
    double swap = t[0];
    t[0] = t[1];
    t[1] = swap;
  }
  return 2;
}

/* (u, v) of a point on the shape, in its space. */
static void uv_at(const vlShapeDef *def, vector p, double *u, double *v) {
  double radius = (double)def->radius;
  *u = angle_of(p) / (double)def->phi_max;
  if (def->kind == VL_SHAPE_CYLINDER) {
    *v = (p.z - (double)def->z_min) / ((double)def->z_max - (double)def->z_min);
  } else if (def->kind == VL_SHAPE_DISK) {
    *v = (radius - sqrt(p.x * p.x + p.y * p.y)) / (radius - (double)def->inner_radius);
  } else {
    double theta_min = acos(clamp((double)def->z_min / radius, -1, 1));
    double theta_max = acos(clamp((double)def->z_max / radius, -1, 1));
    *v = (acos(clamp(p.z / radius, -1, 1)) - theta_min) / (theta_max - theta_min);
  }
}

bool meet_quadric(const world *w, const primitive *p, ray r, meeting *m) {
  const placement *where = &w->placements[p->placement];
  const vlShapeDef *def = where->def;
  vector o = transform_point(&where->shape_from_world, r.origin);
  vector d = transform_vector(&where->shape_from_world, r.direction);
  double candidates[2], radius = (double)def->radius;
  int count = 0;
  if (def->kind == VL_SHAPE_SPHERE) {
    /* The discriminant from the ray's distance to the centre: exact also far away (Haines et al. 2019). */
    double along = dot(o, d) / dot(d, d);
    vector nearest = subtract(o, scale(along, d));
    double half = square(radius) - dot(nearest, nearest);
    if (half < 0) return false;
    half = sqrt(half / dot(d, d));
    candidates[count++] = -along - half;
    candidates[count++] = -along + half;
  } else if (def->kind == VL_SHAPE_CYLINDER) {
    count = roots(d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y, o.x * o.x + o.y * o.y - square(radius), candidates);
  } else if (d.z != 0) {
    candidates[count++] = ((double)def->height - o.z) / d.z;
  }
  for (int i = 0; i < count; i++) {
    if (!(candidates[i] > r.t_min && candidates[i] < r.t_max)) continue;
    vector point = add(o, scale(candidates[i], d));
    if (!is_kept(def, point)) continue;
    m->t = candidates[i];
    uv_at(def, point, &m->a, &m->b);
    return true;
  }
  return false;
}

/* The point at (u, v), 0 to 1 each, and its derivatives, in the space of the shape. */
static vector point_at(const vlShapeDef *def, double u, double v, vector *dpdu, vector *dpdv) {
  double phi_max = (double)def->phi_max, radius = (double)def->radius;
  double phi = u * phi_max, c = cos(phi), s = sin(phi);
  if (def->kind == VL_SHAPE_CYLINDER) {
    double height = (double)def->z_max - (double)def->z_min;
    *dpdu = make_vector(-phi_max * radius * s, phi_max * radius * c, 0);
    *dpdv = make_vector(0, 0, height);
    return make_vector(radius * c, radius * s, (double)def->z_min + v * height);
  }
  if (def->kind == VL_SHAPE_DISK) {
    double inner = (double)def->inner_radius, r = radius + v * (inner - radius);
    *dpdu = make_vector(-phi_max * r * s, phi_max * r * c, 0);
    *dpdv = make_vector((inner - radius) * c, (inner - radius) * s, 0);
    return make_vector(r * c, r * s, (double)def->height);
  }
  double theta_min = acos(clamp((double)def->z_min / radius, -1, 1));
  double theta_max = acos(clamp((double)def->z_max / radius, -1, 1));
  double theta = theta_min + v * (theta_max - theta_min);
  vector p = make_vector(radius * sin(theta) * c, radius * sin(theta) * s, radius * cos(theta));
  *dpdu = make_vector(-phi_max * p.y, phi_max * p.x, 0);
  *dpdv = scale(theta_max - theta_min, make_vector(p.z * c, p.z * s, -radius * sin(theta)));
  return p;
}

/* The surface at (u, v). (u, v) is drawn uniformly from the unit square, so a point has the density 1 / |dp/du x dp/dv|
 * per area: that holds under any transform. */
void quadric_surface(const world *w, const primitive *p, double u, double v, shade_record *record) {
  const placement *where = &w->placements[p->placement];
  const vlShapeDef *def = where->def;
  vector dpdu, dpdv;
  vector point = point_at(def, u, v, &dpdu, &dpdv);
  vector n = cross(dpdu, dpdv);
  if (length(n) == 0) n = def->kind == VL_SHAPE_SPHERE ? point : make_vector(0, 0, 1); /* a pole */
  n = normalize(transform_normal(&where->shape_from_world, n));
  vector along_u = transform_vector(&where->world_from_shape, dpdu);
  vector along_v = transform_vector(&where->world_from_shape, dpdv);
  double area = length(cross(along_u, along_v));
  record->point = transform_point(&where->world_from_shape, point);
  record->normal = where->flip ? negate(n) : n;
  record->shading_normal = record->normal;
  record->tangent = along_u;
  record->u = u;
  record->v = v;
  record->area_density = area > 0 ? 1 / area : 0;
  record->what = p;
  record->where = where;
}
