/* view/camera_spellings.c: all equivalent spellings of a camera, as JSON for the page. */
#include <math.h>

#include "camera/camera.h"
#include "velo/distortion.h"
#include "velo/projection.h"
#include "view/camera_edit.h"

static const double degrees = 180.0 / M_PI;

static void put_pose(Json *json, const ViewCamera *camera) {
  const CameraPose pose = camera_pose(camera);
  json_numbers(json, "eye", pose.eye, 3);
  json_numbers(json, "lookat", pose.lookat, 3);
  json_numbers(json, "up", pose.up, 3);
  json_number(json, "roll", pose.roll * degrees);
  json_numbers(json, "world_from_camera", camera->made.world_from_camera, 16);
  json_numbers(json, "camera_from_world", camera->made.camera_from_world, 16);
}

/* Degrees between two opposite edges of the image, by way of the principal point. */
static double field(const vlCamera *c, double x0, double y0, double x1, double y1) {
  return degrees * camera_angle(c, x0, y0, c->cx, c->cy) +
         degrees * camera_angle(c, c->cx, c->cy, x1, y1);
}

/* The name of the spelling that the camera was given in. */
static const char *spelling_of(const vlCameraDef *def, bool orthographic) {
  if (!isnan(def->fx) || !isnan(def->fy))
    return "matrix";
  if (!isnan(def->view_distance) || (orthographic && !isnan(def->pixel_size)))
    return "lecture";
  return isnan(def->focal_mm) ? "fov" : "focal";
}

/* Numbers that an orthographic camera has not are NAN. Numbers that were given are put as they
 * were, so that rounding does not change them. */
static void put_focal(Json *json, const ViewCamera *camera) {
  static const char *const axes[] = {"vertical", "horizontal", "diagonal", "smaller", "larger"};
  const vlCameraDef *def = &camera->def;
  const vlCamera *c = &camera->made;
  const CameraUnits u = camera->units;
  const bool orthographic = c->projection == VL_PROJECTION_ORTHOGRAPHIC;
  double w = c->width, h = c->height;
  double horizontal = NAN, vertical = NAN, diagonal = NAN, fov = NAN;
  double view_distance = NAN, focal_mm = NAN, pixel_size = u.pixel_size;
  if (!orthographic) {
    horizontal = field(c, 0, c->cy, w, c->cy);
    vertical = field(c, c->cx, 0, c->cx, h);
    diagonal = field(c, 0, 0, w, h);
    const double fields[] = {vertical, horizontal, diagonal, w < h ? horizontal : vertical,
                             w < h ? vertical : horizontal};
    fov = isnan(def->fov) ? fields[def->fov_axis] : def->fov * degrees;
    view_distance =
        isnan(def->view_distance) ? c->fx * u.pixel_size / u.zoom : def->view_distance;
    focal_mm = isnan(def->focal_mm) ? c->fx * u.sensor_mm / w : def->focal_mm;
  } else if (isnan(def->pixel_size)) {
    pixel_size = u.zoom / c->fx;
  }
  json_put(
      json,
      "spelled %s, fov_axis %s, fov %g, fov_horizontal %g, fov_vertical %g, fov_diagonal %g",
      spelling_of(def, orthographic), axes[def->fov_axis], fov, horizontal, vertical, diagonal);
  json_put(json, "d %g, zoom %g, s %g, sensor_width_mm %g, focal_mm %g, fx %g", view_distance,
           u.zoom, pixel_size, u.sensor_mm, focal_mm, c->fx);
  json_put(json, "fy %g, cx %g, cy %g, skew %g", c->fy, c->cx, c->cy, c->skew);
}

static void put_projection(Json *json, const ViewCamera *camera) {
  /* as settings have them; `projection` is for people to read */
#define NAME(kind, name, ...) #name,
  static const char *const distortions[] = {VL_DISTORTION_KINDS(NAME)};
  static const char *const kinds[] = {VL_PROJECTION_KINDS(NAME)};
#undef NAME
  const vlCameraDef *def = &camera->def;
  json_text(json, "projection", vl_projection_name(def->projection));
  if (def->projection != VL_PROJECTION_OWN)
    json_text(json, "kind", kinds[def->projection]);
  json_numbers(json, "shape", camera->made.shape, 2);
  json_put(json, "max_angle %g, distortion %s", def->max_angle * degrees,
           distortions[def->distortion]);
  json_numbers(json, "coefficients", def->distortion_coefficients, def->distortion_count);
  json_number(json, "outside", camera->made.outside);
}

double camera_f_number(const ViewCamera *camera) {
  const vlCamera *c = &camera->made;
  const vlLensDef *lens = &camera->def.lens;
  const double unit = isnan(lens->unit_mm) ? 1000 : lens->unit_mm;
  const double focal = c->fx * camera->units.sensor_mm / c->width;
  if (!isnan(lens->f_number))
    return lens->f_number;
  return c->lens_radius > 0 ? focal / (2 * unit * c->lens_radius) : NAN;
}

static void put_lens(Json *json, const ViewCamera *camera) {
  const vlCameraDef *def = &camera->def;
  const vlCamera *c = &camera->made;
  const vlLensDef *lens = &def->lens;
  json_put(json,
           "lens_radius %g, f_number %g, focus_distance %g, blades %u, rotation %g, ratio %g",
           c->lens_radius, camera_f_number(camera), c->focus_distance, lens->blades,
           lens->rotation * degrees, lens->ratio);
  json_put(json, "tilt_x %g, tilt_y %g, lens_tilt_x %g, lens_tilt_y %g, near %g, far %g",
           lens->tilt_x * degrees, lens->tilt_y * degrees, lens->lens_tilt_x * degrees,
           lens->lens_tilt_y * degrees, c->near_plane, c->far_plane);
  json_put(json, "shutter_open %g, shutter_close %g, exposure_time %g, optics %i",
           c->shutter_open, c->shutter_close, c->exposure_time, lens->optics != NULL);
}

void camera_spellings(Json *json, const ViewCamera *camera) {
  json_put(json, "width %u, height %u", camera->made.width, camera->made.height);
  put_pose(json, camera);
  put_focal(json, camera);
  put_projection(json, camera);
  put_lens(json, camera);
}
