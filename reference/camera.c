/* camera.c: pinhole, orthographic camera, thin lens and two fisheyes. The camera looks along its z axis, x to the
 * right, y down. The library has made its description uniform: fx and fy, in pixels, are the lecture's zoom d / s, and
 * the axis meets the view plane at the pixel (cx, cy). more/motion.c has the camera's u, v, w and eye. */
#include "more/more.h"

/* The lecture's pinhole: direction = x_v u + y_v v - d w. Its v points up and its w back; here y points down and z
 * forward. Divided by d, that is the direction of the point (x, y, 1) of the view plane at distance 1. */
static vector pinhole_direction(double x, double y) {
  return make_vector(x, y, 1);
}

/* In a fisheye the angle theta from the axis decides the distance r from the middle of the image: r = theta
 * (equidistant), or r = 2 sin(theta / 2), which keeps areas (equisolid). Here theta is found from r. */
static vector fisheye_direction(const vlCamera *c, double x, double y) {
  double r = sqrt(x * x + y * y);
  double theta = c->projection == VL_PROJECTION_EQUIDISTANT ? r : 2 * asin(fmin(r / 2, 1));
  double factor = r > 0 ? sin(theta) / r : 1; /* (x, y) becomes as long as sin(theta) */
  return make_vector(factor * x, factor * y, cos(theta));
}

/* A thin lens: each ray of a film point starts at another point of the lens, and all of them meet where the pinhole's
 * ray meets the plane in focus (pbrt book 5.2.3); for fisheyes that is a sphere. */
static void through_lens(const vlCamera *c, sampler *s, vector *origin, vector *direction) {
  if (!(c->lens_radius > 0) || !isfinite(c->focus_distance)) return;
  vector in_focus = add(*origin, scale(c->focus_distance, *direction));
  square_point p = sample_unit_disk(s);
  *origin = add(*origin, make_vector(c->lens_radius * p.x, c->lens_radius * p.y, 0));
  *direction = subtract(in_focus, *origin);
}

/* The ray of a point of the view plane at distance 1, without a lens, in the camera's axes. False: there is none. */
static bool ray_without_lens(const vlCamera *c, double x, double y, vector *origin, vector *direction) {
  *origin = make_vector(0, 0, 0);
  *direction = make_vector(0, 0, 1);
  switch (c->projection) {
    case VL_PROJECTION_PERSPECTIVE: *direction = pinhole_direction(x, y); return true;
    case VL_PROJECTION_ORTHOGRAPHIC: *origin = make_vector(x, y, 0); return true; /* all rays are parallel */
    case VL_PROJECTION_EQUIDISTANT:
    case VL_PROJECTION_EQUISOLID:
      *direction = fisheye_direction(c, x, y);
      return hypot(x, y) <= fmin(c->limit, c->projection == VL_PROJECTION_EQUIDISTANT ? PI : 2);
    default: return more_direction(c, x, y, direction);
  }
}

bool camera_ray(const vlCamera *c, double x, double y, sampler *s, ray *r) {
  double y_plane = (y - c->cy) / c->fy;
  double x_plane = (x - c->cx - c->skew * y_plane) / c->fx;
  vector origin, direction;
  if (c->distortion.steps > 0 && !without_distortion(c, &x_plane, &y_plane)) return false;
  if (!ray_without_lens(c, x_plane, y_plane, &origin, &direction)) return false;
  through_lens(c, s, &origin, &direction);
  frame uvw = camera_pose(c, r->time);
  vector in_world = transform_vector(&uvw, direction);
  r->origin = transform_point(&uvw, origin);
  r->direction = normalize(in_world);
  /* near and far planes are depths along the axis, for fisheyes distances; t is a distance along the ray in the world
   */
  bool flat = c->projection == VL_PROJECTION_PERSPECTIVE || c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  double world_per_depth = length(in_world) / (flat ? direction.z : length(direction));
  r->t_min = c->near_plane * world_per_depth;
  r->t_max = c->far_plane * world_per_depth;
  return true;
}
