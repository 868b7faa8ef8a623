/* camera/optics_points.c: pixels to rays and points to pixels through a lens of many elements,
 * by its chief rays (through the centre of the stop). The lens is rotationally symmetric, so
 * both reduce to a plane through the axis. */
#include <math.h>

#include "camera/optics.h"
#include "camera/optics_chunk.h"
#include "camera/points.h"
#include "camera/pose.h"
#include "math/double3.h"

bool vl_optics_chief_at(const vlOptics *o, double radius, vlChief *chief) {
  double position = radius / o->chief_step;
  if (!(position <= VL_CHIEFS))
    return false;
  int i = (int)position < VL_CHIEFS - 1 ? (int)position : VL_CHIEFS - 1;
  double share = position - i;
  return vl_optics_chief(
      o, radius, (1.0 - share) * o->chiefs[i].pupil + share * o->chiefs[i + 1].pupil, chief);
}

bool vl_optics_unproject(const vlOptics *o, double x, double y, vlCameraLocal *ray) {
  double radius = sqrt(x * x + y * y), cosine = radius > 0.0 ? x / radius : 1.0,
         sine = radius > 0.0 ? y / radius : 0.0;
  vlChief c;
  if (!vl_optics_chief_at(o, radius, &c))
    return false;
  /* the film point lies opposite, at -(x, y), and so do the ray's origin and direction */
  double inv = 1.0 / sqrt(1.0 + c.slope * c.slope);
  *ray = (vlCameraLocal){-c.x0 * cosine, -c.x0 * sine, -c.slope * inv * cosine,
                         -c.slope * inv * sine, inv};
  return true;
}

/* Computes the distance by which the chief ray of a film radius passes outside the point (rho,
 * z). It increases with the radius. */
static bool miss(const vlOptics *o, double radius, double rho, double z, double *value) {
  vlChief c = {0};
  bool valid = vl_optics_chief_at(o, radius, &c);
  *value = -(c.x0 + c.slope * z) - rho;
  return valid;
}

bool vl_optics_project(const vlOptics *o, double x, double y, double z, double film[2]) {
  double rho = sqrt(x * x + y * y);
  if (!(z > o->front) || !isfinite(rho) || !isfinite(z))
    return false;
  int i = 0;
  while (i < VL_CHIEFS && o->chiefs[i].valid && o->chiefs[i + 1].valid &&
         -(o->chiefs[i + 1].x0 + o->chiefs[i + 1].slope * z) < rho)
    i++;
  if (i == VL_CHIEFS || !o->chiefs[i].valid || !o->chiefs[i + 1].valid)
    return false;
  double a = o->chief_step * i, b = o->chief_step * (i + 1), fa, fb, r = a;
  if (!miss(o, a, rho, z, &fa) || !miss(o, b, rho, z, &fb) || fa > 0.0)
    return false;
  /* regula falsi (Illinois): [a, b] brackets one root */
  int side = 0;
  /* 1e-15: converges to the last digits */
  for (int step = 0; step < 100 && b - a > 1e-15 * o->half; step++) {
    double f;
    r = fb > fa ? (a * fb - b * fa) / (fb - fa) : 0.5 * (a + b);
    if (!(r > a && r < b))
      r = 0.5 * (a + b);
    if (!miss(o, r, rho, z, &f))
      return false;
    if (fabs(f) <= 1e-16 * (z + rho))
      break;
    if (f < 0.0) {
      a = r;
      fa = f;
      if (side == -1)
        fb *= 0.5;
      side = -1;
    } else {
      b = r;
      fb = f;
      if (side == 1)
        fa *= 0.5;
      side = 1;
    }
  }
  double k = rho > 0.0 ? r / rho : 0.0;
  film[0] = x * k;
  film[1] = y * k;
  return true;
}

void vl_optics_unproject_chunk(const vlCameraCompiled *c, uint32_t count,
                               const vlCameraPixels *in, vlCameraPoints *out) {
  for (uint32_t i = 0; i < count; i++) {
    vlCameraLocal r = {0.0, 0.0, 0.0, 0.0, 1.0};
    double x = in->x[i] - c->cx, y = in->y[i] - c->cy;
    bool good = isfinite(x) && isfinite(y) &&
                vl_optics_unproject(c->optics, c->pitch * x, c->pitch * y, &r);
    vlWorldRay w = vl_camera_to_world(c, r);
    vl_store_world_ray(out, i, good, w);
    out->valid[i] = good ? 1.0 : 0.0;
  }
}

void vl_optics_project_chunk(const vlCameraCompiled *c, uint32_t count,
                             const vlCameraPoints *in, vlCameraPixels *out) {
  for (uint32_t i = 0; i < count; i++) {
    const double world[3] = {in->x[i], in->y[i], in->z[i]};
    double point[3];
    vl_map_point(c->camera_from_world, world, point);
    vlPlanePoint p = vl_camera_film_point(c, point[0], point[1], point[2]);
    out->x[i] = p.x;
    out->y[i] = p.y;
    out->valid[i] = p.valid;
    out->z[i] = p.valid > 0.0 ? point[2] : 0.0;
  }
}
