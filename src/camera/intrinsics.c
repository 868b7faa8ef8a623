/* camera/intrinsics.c: converts the alternative parameters of a focal length and a principal
 * point to fx, fy, skew, cx, cy in pixels. */
#include <math.h>
#include <stdio.h>

#include "base/error.h"
#include "base/text.h"
#include "camera/parts.h"
#include "math/elementary.h"
#include "projection/properties.row.h"
#include "velo/projection.h"

static const double agreement = 1e-6; /* relative; values written with 7 digits agree */
/* factor that moves a singular angle inwards by about 9 rounding errors */
static const double just_inside = 1.0 - 1e-15;

/* A quantity that several parameters can determine: its first value, and the parameter that
 * gave it (for messages). */
typedef struct {
  const char *what; /* "focal length fx" */
  double value;     /* unset until given */
  char from[160];
} Quantity;

/* Adds the value from one more parameter. If it disagrees with the known value, the error names
 * both parameters. */
static vlResult take(Quantity *q, double value, const char *from, vlError *error) {
  if (vl_is_unset(value) || isinf(value))
    return vl_fail_argument(error, "camera: %s gives no finite %s", from, q->what);
  if (vl_is_unset(q->value)) {
    q->value = value;
    snprintf(q->from, sizeof q->from, "%s", from);
    return VL_OK;
  }
  double largest = fmax(fabs(value), fabs(q->value));
  if (fabs(value - q->value) > agreement * largest)
    return vl_fail_argument(
        error, "camera: %s gives a %s of %.9g, but %s gives %.9g; give one of them", q->from,
        q->what, q->value, from, value);
  return VL_OK;
}

static vlResult check_fov(const vlCameraDef *d, vlError *error) {
  if (d->fov <= 0.0)
    return vl_fail_argument(error,
                            "camera: fov is %g radians (%g degrees); it must be above zero",
                            d->fov, d->fov * 180.0 / M_PI);
  if (d->fov > 2.0 * M_PI)
    return vl_fail_argument(error,
                            "camera: fov is %g radians (%g degrees); all round is 360 degrees",
                            d->fov, d->fov * 180.0 / M_PI);
  if (d->fov >= M_PI && d->projection <= VL_PROJECTION_ORTHOGRAPHIC)
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "camera: fov is %g radians (%g degrees); a flat view plane needs less than 180 degrees",
        d->fov, d->fov * 180.0 / M_PI);
  return VL_OK;
}

/* Returns half the window in pixels along the axis of the field of view. *horizontal and
 * *vertical tell which focal lengths the field of view determines. The diagonal determines
 * both, with square pixels. */
static double half_window(const vlCameraDef *d, bool *horizontal, bool *vertical) {
  double w = d->width, h = d->height;
  vlFovAxis axis = d->fov_axis;
  if (axis == VL_FOV_SMALLER)
    axis = w < h ? VL_FOV_HORIZONTAL : VL_FOV_VERTICAL;
  if (axis == VL_FOV_LARGER)
    axis = w < h ? VL_FOV_VERTICAL : VL_FOV_HORIZONTAL;
  *horizontal = axis != VL_FOV_VERTICAL;
  *vertical = axis != VL_FOV_HORIZONTAL;
  return 0.5 * (axis == VL_FOV_DIAGONAL   ? sqrt(w * w + h * h)
                : axis == VL_FOV_VERTICAL ? h
                                          : w);
}

/* Checks that either all four sides of the screen window are given, or none. */
static vlResult screen_given(const vlCameraDef *d, bool *given, vlError *error) {
  int sides = !vl_is_unset(d->screen_min_x) + !vl_is_unset(d->screen_max_x) +
              !vl_is_unset(d->screen_min_y) + !vl_is_unset(d->screen_max_y);
  *given = sides == 4;
  if (sides != 0 && sides != 4)
    return vl_fail_argument(error, "camera: the screen window has %d of its 4 sides", sides);
  if (sides == 4 && !(d->screen_min_x < d->screen_max_x && d->screen_min_y < d->screen_max_y))
    return vl_fail_argument(error, "camera: the screen window x %g to %g, y %g to %g is empty",
                            d->screen_min_x, d->screen_max_x, d->screen_min_y, d->screen_max_y);
  return VL_OK;
}

typedef struct {
  Quantity fx, fy, cx, cy;
} Gathered;

/* The screen window (pbrt's): extent of the film, y up, on a plane at distance 1, scaled by
 * tan(fov / 2). */
static vlResult take_screen(const vlCameraDef *d, double tangent, const char *from, Gathered *g,
                            vlError *error) {
  double across = d->screen_max_x - d->screen_min_x, down = d->screen_max_y - d->screen_min_y;
  VL_TRY(take(&g->fx, d->width / across / tangent, from, error));
  VL_TRY(take(&g->fy, d->height / down / tangent, from, error));
  VL_TRY(take(&g->cx, -d->screen_min_x / across * d->width, "the screen window", error));
  return take(&g->cy, d->screen_max_y / down * d->height, "the screen window", error);
}

/* Computes half the extent of a field of view along an axis, in plane units. */
static vlResult plane_half(const vlCameraDef *d, const vlCamera *camera, bool vertical,
                           double *half, vlError *error) {
  vlProjection kind = d->projection;
  if (kind == VL_PROJECTION_PERSPECTIVE) {
    *half = vl_precise_tan(0.5 * d->fov);
    return VL_OK;
  }
  const char *name = vl_projection_name(kind);
  uint32_t traits = vl_projection_row(kind)->traits;
  if (traits & VL_PROJECTION_NO_FOV)
    return vl_fail_argument(error, "camera: a fov has no meaning for the %s projection", name);
  if (d->fov_axis == VL_FOV_DIAGONAL && !(traits & VL_PROJECTION_RADIAL))
    return vl_fail_argument(
        error, "camera: a diagonal fov has no meaning for the %s projection", name);
  /* 360 degrees: the direction straight back is singular; approach it from the image's side */
  double angle = 0.5 * d->fov < M_PI ? 0.5 * d->fov : M_PI * just_inside;
  if (!vl_camera_plane_radius(camera, angle, vertical, half))
    return vl_fail_argument(error, "camera: the %s projection cannot show a fov of %g degrees",
                            name, d->fov * 180.0 / M_PI);
  return VL_OK;
}

/* The focal lengths that a screen window gives, with the field of view of a perspective
 * camera. */
static vlResult gather_screen(const vlCameraDef *d, Gathered *g, vlError *error) {
  char from[160];
  bool has_fov = !vl_is_unset(d->fov);
  if (d->projection == VL_PROJECTION_PERSPECTIVE) {
    double fov = has_fov ? d->fov : 0.5 * M_PI;
    snprintf(from, sizeof from, "the screen window with fov %.9g degrees%s", fov * 180.0 / M_PI,
             has_fov ? "" : " (the default)");
    return take_screen(d, vl_precise_tan(0.5 * fov), from, g, error);
  }
  if (has_fov)
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "camera: fov and a screen window are given; for the %s projection the window "
        "alone says it",
        vl_projection_name(d->projection));
  return take_screen(d, 1.0, "the screen window", g, error);
}

/* The focal lengths that a field of view gives. */
static vlResult gather_fov(const vlCameraDef *d, const vlCamera *camera, Gathered *g,
                           vlError *error) {
  static const char *const axes[] = {"vertical", "horizontal", "diagonal", "smaller side",
                                     "larger side"};
  char from[160];
  bool horizontal, vertical;
  double window = half_window(d, &horizontal, &vertical), half;
  VL_TRY(plane_half(d, camera, !horizontal, &half, error));
  double f = window / half;
  snprintf(from, sizeof from, "fov %.9g degrees (%s)", d->fov * 180.0 / M_PI,
           axes[d->fov_axis]);
  if (horizontal)
    VL_TRY(take(&g->fx, f, from, error));
  if (vertical)
    VL_TRY(take(&g->fy, f, from, error));
  return VL_OK;
}

/* The focal length that focal_mm and sensor_width_mm give. */
static vlResult gather_millimetres(const vlCameraDef *d, Gathered *g, vlError *error) {
  char from[160];
  bool has_mm = !vl_is_unset(d->focal_mm), has_width = !vl_is_unset(d->sensor_width_mm);
  /* with an f-number or a tilted lens, one of them may describe the lens alone if the focal
   * length in pixels is known */
  bool known = !vl_is_unset(g->fx.value) || !vl_is_unset(g->fy.value);
  bool lens = !vl_is_unset(d->lens.f_number) || d->lens.lens_tilt_x != 0.0 ||
              d->lens.lens_tilt_y != 0.0;
  if (has_mm != has_width && !(lens && known))
    return vl_fail_argument(error, "camera: %s is given without %s",
                            has_mm ? "focal_mm" : "sensor_width_mm",
                            has_mm ? "sensor_width_mm" : "focal_mm");
  if (!has_mm || !has_width)
    return VL_OK;
  snprintf(from, sizeof from, "focal_mm %.9g on sensor_width_mm %.9g", d->focal_mm,
           d->sensor_width_mm);
  return take(&g->fx, d->focal_mm / d->sensor_width_mm * d->width, from, error);
}

/* Collects the focal lengths of perspective cameras, and of all others whose plane scales with
 * a focal length. */
static vlResult gather_focal(const vlCameraDef *d, const vlCamera *camera, bool screen,
                             Gathered *g, vlError *error) {
  char from[160];
  double zoom = vl_is_unset(d->zoom) ? 1.0 : d->zoom,
         size = vl_is_unset(d->pixel_size) ? 1.0 : d->pixel_size;
  if (screen)
    VL_TRY(gather_screen(d, g, error));
  else if (!vl_is_unset(d->fov))
    VL_TRY(gather_fov(d, camera, g, error));
  if (!vl_is_unset(d->view_distance)) {
    double f = zoom * d->view_distance / size;
    snprintf(from, sizeof from, "d %.9g with zoom %.9g and pixel size %.9g", d->view_distance,
             zoom, size);
    VL_TRY(take(&g->fx, f, from, error));
    VL_TRY(take(&g->fy, f, from, error));
  } else if (zoom != 1.0) {
    return vl_fail_argument(
        error, "camera: zoom %g is given without the view distance d that it acts on", zoom);
  } else if (size != 1.0) {
    return vl_fail_argument(
        error, "camera: pixel size %g is given without the view distance d that it divides",
        size);
  }
  return gather_millimetres(d, g, error);
}

static vlResult gather_orthographic(const vlCameraDef *d, bool screen, Gathered *g,
                                    vlError *error) {
  char from[160];
  const struct {
    const char *name;
    double value;
  } foreign[] = {{"fov", d->fov},
                 {"view distance d", d->view_distance},
                 {"focal_mm", d->focal_mm},
                 {"sensor_width_mm", d->sensor_width_mm}};
  for (size_t i = 0; i < VL_LENGTH(foreign); i++)
    if (!vl_is_unset(foreign[i].value))
      return vl_fail_argument(error, "camera: %s %g has no meaning for an orthographic camera",
                              foreign[i].name, foreign[i].value);
  if (screen)
    VL_TRY(take_screen(d, 1.0, "the screen window", g, error));
  if (!vl_is_unset(d->pixel_size)) {
    double zoom = vl_is_unset(d->zoom) ? 1.0 : d->zoom;
    snprintf(from, sizeof from, "pixel size %.9g with zoom %.9g", d->pixel_size, zoom);
    VL_TRY(take(&g->fx, zoom / d->pixel_size, from, error));
    VL_TRY(take(&g->fy, zoom / d->pixel_size, from, error));
  } else if (!vl_is_unset(d->zoom) && d->zoom != 1.0) {
    return vl_fail_argument(
        error, "camera: zoom %g is given without the pixel size that it divides", d->zoom);
  }
  return VL_OK;
}

/* Sets the projection's default focal length, because none is given. */
static void standard_focal(const vlCameraDef *d, const vlCamera *camera, Gathered *g) {
  const vlProjectionRow *row = vl_projection_row(d->projection);
  double half = 0.5 * (d->width < d->height ? d->width : d->height), radius, focal[2];
  if (row->standard_focal) {
    row->standard_focal(d, camera, focal);
    g->fx.value = focal[0];
    g->fy.value = focal[1];
    return;
  }
  /* along the smaller side: 180 degrees for fisheyes, 90 for others if the model covers that
   * angle */
  bool fisheye = row->traits & VL_PROJECTION_FISHEYE;
  if (!vl_camera_plane_radius(camera, fisheye ? 0.5 * M_PI * just_inside : 0.25 * M_PI,
                              d->width >= d->height, &radius))
    radius = 1.0;
  g->fx.value = g->fy.value = half / radius;
}

vlResult vl_camera_intrinsics(const vlCameraDef *d, vlCamera *camera, vlError *error) {
  Gathered g = {{"focal length fx", VL_UNSET, ""},
                {"focal length fy", VL_UNSET, ""},
                {"principal point cx", VL_UNSET, ""},
                {"principal point cy", VL_UNSET, ""}};
  bool orthographic = d->projection == VL_PROJECTION_ORTHOGRAPHIC, screen;
  VL_TRY(check_fov(d, error));
  VL_TRY(screen_given(d, &screen, error));
  if (!vl_is_unset(d->fx))
    VL_TRY(take(&g.fx, d->fx, "fx", error));
  if (!vl_is_unset(d->fy))
    VL_TRY(take(&g.fy, d->fy, "fy", error));
  if (!vl_is_unset(d->cx))
    VL_TRY(take(&g.cx, d->cx, "cx", error));
  if (!vl_is_unset(d->cy))
    VL_TRY(take(&g.cy, d->cy, "cy", error));
  VL_TRY(orthographic ? gather_orthographic(d, screen, &g, error)
                      : gather_focal(d, camera, screen, &g, error));

  /* a single focal length: square pixels */
  if (vl_is_unset(g.fx.value) && vl_is_unset(g.fy.value))
    standard_focal(d, camera, &g);
  camera->fx = vl_is_unset(g.fx.value) ? g.fy.value : g.fx.value;
  camera->fy = vl_is_unset(g.fy.value) ? g.fx.value : g.fy.value;
  camera->skew = vl_is_unset(d->skew) ? 0.0 : d->skew;
  /* the faces of a cube start at the corner, and so do the film points of a camera of one's
   * own */
  double centre =
      d->projection == VL_PROJECTION_CUBE || d->projection == VL_PROJECTION_OWN ? 0.0 : 0.5;
  camera->cx = vl_is_unset(g.cx.value) ? centre * d->width : g.cx.value;
  camera->cy = vl_is_unset(g.cy.value) ? centre * d->height : g.cy.value;
  /* outside of these limits the rays' arithmetic would overflow or underflow */
  if (camera->fx > 1e30 || camera->fy > 1e30 || camera->fx < 1e-30 || camera->fy < 1e-30)
    return vl_fail_argument(error, "camera: focal lengths of %g and %g pixels are out of range",
                            camera->fx, camera->fy);
  return VL_OK;
}
