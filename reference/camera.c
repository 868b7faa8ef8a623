/* camera.c: pinhole, orthographic camera, thin lens and two fisheyes. The camera looks along its z axis, x to the
 * right, y down. Its description has been made uniform by the library: fx and fy, in pixels, are the lecture's zoom d /
 * s; cx, cy is where the axis meets the view plane; the pose is world_from_camera. */
#include "camera.h"

#include "refuse.h"

bool check_camera(const vlCamera *c, vlSource source, vlError *error) {
  switch (c->projection) {
    case VL_PROJECTION_PERSPECTIVE:
    case VL_PROJECTION_ORTHOGRAPHIC:
    case VL_PROJECTION_EQUIDISTANT:
    case VL_PROJECTION_EQUISOLID: break;
    default: return refuse_kind(error, source, "cameras", UINT32_MAX);
  }
  const vlLens *l = &c->lens;
  if (c->distortion.steps > 0) return refuse(error, source, "lens distortion", NULL);
  if (c->moves || c->readout != 0) return refuse(error, source, "a moving camera or a rolling shutter", NULL);
  if (l->blades || l->aperture || l->ratio != 1 || l->tilt[0] != 0 || l->tilt[1] != 0 || l->vignetting ||
      l->hinge[0] != 0 || l->hinge[1] != 0 || c->eye_circle != 0)
    return refuse(error, source, "this lens", NULL);
  return true;
}

/* The lecture's pinhole: direction = x_v u + y_v v - d w, divided by d. Here the axes are x right, y down, z forward,
 * so that the view plane at distance 1 has the point (x, y, 1). */
static void pinhole_ray(double x, double y, vector *origin, vector *direction) {
  *origin = make_vector(0, 0, 0);
  *direction = make_vector(x, y, 1);
}

/* Parallel rays, each from its own point of the view plane. */
static void orthographic_ray(double x, double y, vector *origin, vector *direction) {
  *origin = make_vector(x, y, 0);
  *direction = make_vector(0, 0, 1);
}

/* A fisheye's distance from the middle of the image is a function of the angle from the axis: r = theta, or
 * r = 2 sin(theta / 2), which keeps areas. */
static bool fisheye_ray(const vlCamera *c, double x, double y, vector *origin, vector *direction) {
  double r = sqrt(x * x + y * y);
  if (r > c->limit) return false;
  bool equidistant = c->projection == VL_PROJECTION_EQUIDISTANT;
  if (r > (equidistant ? PI : 2)) return false;
  double theta = equidistant ? r : 2 * asin(r / 2);
  double share = r > 0 ? sin(theta) / r : 1;
  *origin = make_vector(0, 0, 0);
  *direction = make_vector(share * x, share * y, cos(theta));
  return true;
}

/* A thin lens: all rays of a film point meet in the plane in focus; each starts at another point of the lens (pbrt book
 * 5.2.3). Fisheyes focus on a sphere. */
static void through_lens(const vlCamera *c, bool focus_on_plane, sampler *s, vector *origin, vector *direction) {
  if (!(c->lens_radius > 0) || !isfinite(c->focus_distance)) return;
  double t = focus_on_plane ? c->focus_distance / direction->z : c->focus_distance / length(*direction);
  vector in_focus = add(*origin, scale(t, *direction));
  square_point p = sample_unit_disk(s);
  *origin = add(*origin, make_vector(c->lens_radius * p.x, c->lens_radius * p.y, 0));
  *direction = subtract(in_focus, *origin);
}

bool camera_ray(const vlCamera *c, double x, double y, sampler *s, ray *r) {
  vector origin, direction;
  double y_plane = (y - c->cy) / c->fy;
  double x_plane = (x - c->cx - c->skew * y_plane) / c->fx;
  bool flat = c->projection == VL_PROJECTION_PERSPECTIVE || c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  if (c->projection == VL_PROJECTION_PERSPECTIVE)
    pinhole_ray(x_plane, y_plane, &origin, &direction);
  else if (c->projection == VL_PROJECTION_ORTHOGRAPHIC)
    orthographic_ray(x_plane, y_plane, &origin, &direction);
  else if (!fisheye_ray(c, x_plane, y_plane, &origin, &direction))
    return false;
  through_lens(c, flat, s, &origin, &direction);
  matrix world_from_camera = load_matrix(c->world_from_camera);
  r->origin = transform_point(&world_from_camera, origin);
  /* near and far are depths along the axis, or distances for fisheyes, in units of the camera's space */
  double unit = flat ? direction.z : length(direction);
  vector in_world = transform_vector(&world_from_camera, direction);
  double l = length(in_world);
  r->direction = scale(1 / l, in_world);
  r->t_min = c->near_plane / unit * l;
  r->t_max = c->far_plane / unit * l;
  return true;
}
