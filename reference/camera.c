/* camera.c: pinhole, orthographic camera, thin lens and two fisheyes. The camera looks along its z axis, x to the
 * right, y down. Its description has been made uniform by the library: fx and fy, in pixels, are the lecture's zoom d /
 * s; cx, cy is where the axis meets the view plane; the pose is world_from_camera, see more/motion.c. */
#include "more/more.h"

/* The lecture's pinhole: direction = x_v u + y_v v - d w, divided by d. Here the axes are x right, y down, z forward,
 * so that the view plane at distance 1 has the point (x, y, 1). */
static vector pinhole_direction(double x, double y) {
  return make_vector(x, y, 1);
}

/* A fisheye's distance from the middle of the image is a function of the angle from the axis: r = theta, or
 * r = 2 sin(theta / 2), which keeps areas. */
static vector fisheye_direction(const vlCamera *c, double x, double y) {
  double r = sqrt(x * x + y * y);
  double theta = c->projection == VL_PROJECTION_EQUIDISTANT ? r : 2 * asin(fmin(r / 2, 1));
  double share = r > 0 ? sin(theta) / r : 1;
  return make_vector(share * x, share * y, cos(theta));
}

/* A thin lens: all rays of a film point meet in the plane in focus; each starts at another point of the lens (pbrt book
 * 5.2.3). Fisheyes focus on a sphere. */
static void through_lens(const vlCamera *c, sampler *s, vector *origin, vector *direction) {
  if (!(c->lens_radius > 0) || !isfinite(c->focus_distance)) return;
  vector in_focus = add(*origin, scale(c->focus_distance, *direction));
  square_point p = sample_unit_disk(s);
  *origin = add(*origin, make_vector(c->lens_radius * p.x, c->lens_radius * p.y, 0));
  *direction = subtract(in_focus, *origin);
}

bool camera_ray(const vlCamera *c, double x, double y, sampler *s, ray *r) {
  double y_plane = (y - c->cy) / c->fy;
  double x_plane = (x - c->cx - c->skew * y_plane) / c->fx;
  if (c->distortion.steps > 0 && !without_distortion(c, &x_plane, &y_plane)) return false;
  vector origin = make_vector(0, 0, 0), direction = make_vector(0, 0, 1);
  bool fisheye = c->projection == VL_PROJECTION_EQUIDISTANT || c->projection == VL_PROJECTION_EQUISOLID;
  bool flat = c->projection == VL_PROJECTION_PERSPECTIVE || c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  if (c->projection == VL_PROJECTION_PERSPECTIVE)
    direction = pinhole_direction(x_plane, y_plane);
  else if (c->projection == VL_PROJECTION_ORTHOGRAPHIC) /* parallel rays, each from its own point of the view plane */
    origin = make_vector(x_plane, y_plane, 0);
  else if (fisheye && hypot(x_plane, y_plane) <= fmin(c->limit, c->projection == VL_PROJECTION_EQUIDISTANT ? PI : 2))
    direction = fisheye_direction(c, x_plane, y_plane);
  else if (fisheye || !more_direction(c, x_plane, y_plane, &direction))
    return false;
  through_lens(c, s, &origin, &direction);
  frame uvw = camera_pose(c, r->time);
  vector in_world = transform_vector(&uvw, direction);
  r->origin = transform_point(&uvw, origin);
  r->direction = normalize(in_world);
  /* near and far are depths along the axis, or distances for fisheyes, in units of the camera's space */
  double world_per_unit = length(in_world) / (flat ? direction.z : length(direction));
  r->t_min = c->near_plane * world_per_unit;
  r->t_max = c->far_plane * world_per_unit;
  return true;
}
