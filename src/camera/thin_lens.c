/* camera/thin_lens.c: the part of vl_camera_make for the lens: radius or f-number, the plane in
 * focus, the aperture's shape, and the exposure from the camera's settings. Runs after
 * intrinsics and pose. */
#include <math.h>

#include "base/error.h"
#include "base/text.h"
#include "camera/lens.h"
#include "camera/optics.h"
#include "camera/parts.h"
#include "math/double3.h"
#include "math/elementary.h"
#include "velo/projection.h"

static const double agreement = 1e-6; /* relative; values written with 7 digits agree */

/* Whether a projection sees only the half-space z > 0. Its surfaces of focus and clipping are
 * planes of constant z; those of other projections are spheres around the eye. */
static bool given(double value) {
  return !vl_is_unset(value);
}

static vlResult check(const vlCameraDef *def, vlError *error) {
  const vlLensDef *d = &def->lens;
  if (d->blades != 0 && d->blades < 3)
    return vl_fail_argument(error,
                            "camera: %u blades; there are 0 (a round opening) or 3 to %d",
                            d->blades, VL_MAX_BLADES);
  if (d->blades != 0 && d->aperture)
    return vl_fail_argument(
        error, "camera: %u blades and an aperture image are given; give one of them",
        d->blades);
  if (d->vignetting && def->projection != VL_PROJECTION_PERSPECTIVE)
    return vl_fail_argument(error,
                            "camera: natural vignetting has no meaning for the %s projection",
                            vl_projection_name(def->projection));
  return VL_OK;
}

/* Focal length in millimetres; unset if the def does not give it. */
static double focal_length(const vlCameraDef *def, const vlCamera *camera) {
  if (given(def->focal_mm) || def->projection == VL_PROJECTION_ORTHOGRAPHIC)
    return def->focal_mm;
  return camera->fx * def->sensor_width_mm / def->width;
}

static vlResult radius(const vlCameraDef *def, double focal_mm, vlCamera *camera,
                       vlError *error) {
  const vlLensDef *d = &def->lens;
  if (vl_is_unset(d->f_number))
    return VL_OK;
  if (vl_is_unset(focal_mm)) {
    if (given(d->iso))
      return VL_OK; /* the ISO value affects only the exposure */
    return vl_fail_argument(
        error,
        "camera: f_number %g needs the focal length in millimetres (focal_mm or "
        "sensor_width_mm); or give lens_radius",
        d->f_number);
  }
  double r = 0.5 * focal_mm / (d->f_number * d->unit_mm);
  if (def->lens_radius > 0.0 &&
      fabs(r - def->lens_radius) > agreement * fmax(r, def->lens_radius))
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "camera: f_number %.9g at %.9g mm gives a lens radius of %.9g, but lens_radius is "
        "%.9g; give one of them",
        d->f_number, focal_mm, r, def->lens_radius);
  camera->lens_radius = r;
  return VL_OK;
}

static vlResult tilt(const vlCameraDef *def, double focal_mm, vlCamera *camera,
                     vlError *error) {
  const vlLensDef *d = &def->lens;
  bool plane = d->tilt_x != 0.0 || d->tilt_y != 0.0,
       lens = d->lens_tilt_x != 0.0 || d->lens_tilt_y != 0.0;
  if (!plane && !lens)
    return VL_OK;
  if (plane && lens)
    return vl_fail_argument(
        error,
        "camera: tilt_x %g, tilt_y %g turn the plane in focus and lens_tilt_x %g, "
        "lens_tilt_y %g the lens; give one of them",
        d->tilt_x, d->tilt_y, d->lens_tilt_x, d->lens_tilt_y);
  if (def->projection > VL_PROJECTION_ORTHOGRAPHIC)
    return vl_fail_argument(
        error, "camera: a tilted plane in focus has no meaning for the %s projection",
        vl_projection_name(def->projection));
  camera->lens.tilt[0] = vl_precise_tan(d->tilt_y);
  camera->lens.tilt[1] = vl_precise_tan(d->tilt_x);
  if (!lens)
    return VL_OK;
  if (vl_is_unset(focal_mm))
    return vl_fail_argument(
        error,
        "camera: lens_tilt needs the focal length in millimetres (focal_mm or "
        "sensor_width_mm); or give tilt_x and tilt_y of the plane");
  /* the hinge rule: the plane in focus meets the plane through the lens, parallel to the film,
   * f / sin(tilt) away */
  camera->lens.hinge[0] = vl_precise_sin(d->lens_tilt_y) * d->unit_mm / focal_mm;
  camera->lens.hinge[1] = vl_precise_sin(d->lens_tilt_x) * d->unit_mm / focal_mm;
  return VL_OK;
}

bool vl_camera_focus_at(const vlCamera *camera, const double p[3], double *distance) {
  double c[3];
  vl_map_point(camera->camera_from_world, p, c);
  const vlLens *l = &camera->lens;
  if (vl_camera_sees_ahead(camera->projection))
    *distance = (c[2] + l->tilt[0] * c[0] + l->tilt[1] * c[1]) /
                (1.0 - l->hinge[0] * c[0] - l->hinge[1] * c[1]);
  else
    *distance = vl_norm3(c);
  return *distance > 0.0 && isfinite(*distance);
}

static vlResult focus(const vlCameraDef *def, vlCamera *camera, vlError *error) {
  const vlLensDef *d = &def->lens;
  const double *p = d->focus_point;
  int point = given(p[0]) + given(p[1]) + given(p[2]),
      pixel = given(d->focus_pixel[0]) + given(d->focus_pixel[1]);
  if ((point != 0 && point != 3) || (pixel != 0 && pixel != 2))
    return vl_fail_argument(error, "camera: focus_%s has not all of its numbers",
                            point != 0 && point != 3 ? "point" : "pixel");
  if ((point && pixel) || (pixel && given(def->focus_distance)))
    return vl_fail_argument(error,
                            "camera: focus_pixel and focus_%s are given; give one of them",
                            point ? "point" : "distance");
  if (pixel) {
    for (int i = 0; i < 2; i++)
      if (!(d->focus_pixel[i] >= 0.0 && d->focus_pixel[i] <= (i ? def->height : def->width)))
        return vl_fail_argument(error,
                                "camera: focus_pixel %g, %g lies outside the image of %u x %u",
                                d->focus_pixel[0], d->focus_pixel[1], def->width, def->height);
    camera->lens.focus_pixel[0] = d->focus_pixel[0];
    camera->lens.focus_pixel[1] = d->focus_pixel[1];
  }
  if (!point)
    return VL_OK;
  double distance;
  if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]) ||
      !vl_camera_focus_at(camera, p, &distance))
    return vl_fail_argument(error, "camera: focus_point %g %g %g is not before the camera",
                            p[0], p[1], p[2]);
  double other = def->focus_distance;
  if (given(other) && fabs(distance - other) > agreement * fmax(distance, other))
    return vl_fail_argument(
        error,
        "camera: focus_point gives a focus distance of %.9g, but focus_distance is "
        "%.9g; give one of them",
        distance, other);
  camera->focus_distance = distance;
  return VL_OK;
}

static vlResult exposure(const vlCameraDef *def, vlCamera *camera, vlError *error) {
  const vlLensDef *d = &def->lens;
  if (vl_is_unset(d->iso)) {
    if (given(d->seconds))
      return vl_fail_argument(error, "camera: seconds %g is given without iso", d->seconds);
    return VL_OK;
  }
  if (vl_is_unset(d->f_number))
    return vl_fail_argument(error, "camera: iso %g is given without f_number", d->iso);
  if (def->exposure_time != 1.0)
    return vl_fail_argument(error,
                            "camera: exposure_time %g and iso %g are given; give one of them",
                            def->exposure_time, d->iso);
  double seconds = given(d->seconds) ? d->seconds : def->shutter_close - def->shutter_open;
  camera->exposure_time = seconds * d->iso / (120.0 * d->f_number * d->f_number);
  if (!(camera->exposure_time > 0.0) || isinf(camera->exposure_time))
    return vl_fail_argument(error, "camera: an exposure of %g seconds at iso %g, f/%g is none",
                            seconds, d->iso, d->f_number);
  return VL_OK;
}

/* A lens of many elements determines focal length, focus and aperture itself. */
static vlResult optics(const vlCameraDef *def, vlCamera *camera, vlError *error) {
  const vlLensDef *d = &def->lens;
  if (def->projection != VL_PROJECTION_OPTICS || !d->optics)
    return vl_fail_argument(error, "camera: %s",
                            d->optics ? "lens.optics needs the projection OPTICS"
                                      : "the projection OPTICS needs lens.optics");
  const struct {
    const char *name;
    bool there;
  } foreign[] = {{"fov", given(def->fov)},
                 {"view_distance", given(def->view_distance)},
                 {"focal_mm", given(def->focal_mm)},
                 {"sensor_width_mm", given(def->sensor_width_mm)},
                 {"fx", given(def->fx)},
                 {"fy", given(def->fy)},
                 {"skew", given(def->skew) && def->skew != 0.0},
                 {"a screen window", given(def->screen_min_x)},
                 {"lens_radius", def->lens_radius != 0.0},
                 {"focus_distance", given(def->focus_distance)},
                 {"focus_point", given(d->focus_point[0])},
                 {"focus_pixel", given(d->focus_pixel[0])},
                 {"f_number", given(d->f_number)},
                 {"iso", given(d->iso)},
                 {"blades", d->blades != 0},
                 {"ratio", d->ratio != 1.0},
                 {"an aperture image", d->aperture != NULL},
                 {"a tilt", d->tilt_x != 0.0 || d->tilt_y != 0.0 || d->lens_tilt_x != 0.0 ||
                                d->lens_tilt_y != 0.0}};
  for (size_t i = 0; i < VL_LENGTH(foreign); i++)
    if (foreign[i].there)
      return vl_fail_argument(
          error, "camera: %s is given; a lens of many elements has its own, or none",
          foreign[i].name);
  double width = def->width, height = def->height;
  camera->fx = camera->fy = d->optics->info.rear_principal / (2.0 * d->optics->half) *
                            sqrt(width * width + height * height);
  camera->lens_radius = sqrt(d->optics->pupils[0].area / M_PI);
  camera->focus_distance = d->optics->info.focus_distance;
  return VL_OK;
}

vlResult vl_camera_lens(const vlCameraDef *def, vlCamera *camera, vlError *error) {
  const vlLensDef *d = &def->lens;
  camera->lens = (vlLens){.blades = d->blades,
                          .rotation = d->rotation,
                          .ratio = d->ratio,
                          .focus_pixel = {VL_UNSET, VL_UNSET},
                          .vignetting = d->vignetting,
                          .aperture = d->aperture,
                          .optics = d->optics};
  VL_TRY(check(def, error));
  if (def->projection == VL_PROJECTION_OPTICS || d->optics)
    return optics(def, camera, error);
  double focal_mm = focal_length(def, camera);
  VL_TRY(radius(def, focal_mm, camera, error));
  VL_TRY(tilt(def, focal_mm, camera, error));
  VL_TRY(focus(def, camera, error));
  return exposure(def, camera, error);
}

/* ---- points of any lens that is not a plain disc ----------------------------------------- */

/* Sampled by the shape of the aperture, rotated, then scaled. Not in a hot file: blades and
 * images need table lookups. */
void vl_lens_points(const vlCameraCompiled *c, uint32_t n, const float *u, const float *v,
                    float *x, float *y) {
  if (c->aperture)
    vl_aperture_points(c->aperture, n, u, v, x, y);
  else if (c->blades.count)
    vl_blades_points(&c->blades, n, u, v, x, y);
  else
    for (uint32_t i = 0; i < n; i++) {
      vlLensPoint p = vl_lens_disk(u[i], v[i]);
      x[i] = p.x;
      y[i] = p.y;
    }
  double cosine = c->aperture ? c->lens_turn[0] : 1.0,
         sine = c->aperture ? c->lens_turn[1] : 0.0;
  for (uint32_t i = 0; i < n; i++) {
    double px = (double)x[i], py = (double)y[i];
    x[i] = (float)(c->inv_ratio * (cosine * px - sine * py));
    y[i] = (float)(sine * px + cosine * py);
  }
}
