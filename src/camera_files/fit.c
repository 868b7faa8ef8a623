/* camera_files/fit.c: refuses by name what a dialect cannot express. */
#include <assert.h>
#include <math.h>

#include "base/text.h"
#include "camera_files/files.h"
#include "distortion/distortion.row.h"
#include "math/double3.h"
#include "math/transform.h"
#include "velo/distortion.h"
#include "velo/projection.h"

/* What a dialect may be unable to hold, by the names of the messages. */
static const char *const refusable[] = {
    "aperture",      "aperture_ratio", "blades",         "cx",           "cy",   "distortion",
    "exposure_time", "far_plane",      "focus_distance", "focus_pixel",  "fy",   "lens_radius",
    "max_angle",     "mirror",         "motion",         "near_plane",   "pose", "projection",
    "readout",       "shutter_close",  "shutter_curve",  "shutter_open", "skew", "stereo",
    "tilt",          "vignetting"};

/* The word for all of them in a list of fields to drop. */
static const char all_fields[] = "all";

static bool is_refusable(const char *field) {
  return VL_IS_AMONG(field, refusable);
}

vlResult vl_camera_check_drop(const vlCameraFileDef *def, vlError *error) {
  for (uint32_t i = 0; i < def->drop_count; i++) {
    const char *name = def->drop ? def->drop[i] : NULL;
    if (!name)
      return vl_fail_argument(error, "camera file: drop[%u] is null", i);
    if (is_refusable(name) || vl_text_is(name, all_fields))
      continue;
    char known[600];
    vl_tell_names(known, sizeof known, name, refusable, VL_LENGTH(refusable));
    return vl_fail_argument(error, "camera file: drop: no camera has a field \"%s\"%s",
                            vl_argument_text(name).text, known);
  }
  return VL_OK;
}

bool vl_camera_drops(const vlCameraFile *file, const char *field) {
  assert(is_refusable(field));
  for (uint32_t i = 0; i < file->def->drop_count; i++)
    if (vl_text_is(file->def->drop[i], field) || vl_text_is(file->def->drop[i], all_fields))
      return true;
  return false;
}

vlResult vl_camera_refuse(const vlCameraFile *file, const char *field, bool present) {
  assert(is_refusable(field));
  if (!present || vl_camera_drops(file, field))
    return VL_OK;
  return vl_camera_cannot_hold(
      file, "this camera's \"%s\"; to leave it out, drop it by that name", field);
}

/* The same view with the image mirrored horizontally: negates the x axis. For left-handed
 * worlds such as pbrt's. */
static void unmirror(vlCamera *c) {
  for (int i = 0; i < 4; i++) {
    c->world_from_camera[4 * i] = 0.0 - c->world_from_camera[4 * i];
    c->camera_from_world[i] = 0.0 - c->camera_from_world[i];
  }
  c->cx = c->width - c->cx;
  c->skew = 0.0 - c->skew;
}

/* For dialects whose poses are rotations and translations: a mirrored camera becomes one that
 * is not, with the same view in the mirror, if "mirror" is dropped. Other poses are errors. */
static vlResult make_rigid(const vlCameraFile *file, vlCamera *camera) {
  const double *m = camera->world_from_camera;
  if (vl_determinant3(m) < 0.0 && camera->distortion.steps == 0) {
    VL_TRY(vl_camera_refuse(file, "mirror", true));
    unmirror(camera);
  }
  /* 1e-9: numbers of ten digits */
  if (vl_rotation_error(m) < 1e-9 && vl_determinant3(m) > 0.0)
    return VL_OK;
  return vl_camera_cannot_hold(file, "a pose that scales or mirrors");
}

/* Makes the camera. Refuses any property that `holds` does not include. */
static vlResult hold(const vlCameraFile *file, const vlCameraDef *d, uint32_t holds,
                     vlCamera *camera) {
  VL_TRY(vl_camera_make(d, camera, NULL, file->error));
  if (holds & VL_HOLDS_ALL)
    return VL_OK;
  bool posed = holds & VL_HOLDS_POSE;
  const vlLens *lens = &camera->lens;
  const struct {
    const char *field;
    bool present;
  } fields[] = {
      {"pose", !posed && !vl_mat4_is_identity(camera->world_from_camera)},
      {"skew", !(holds & VL_HOLDS_SKEW) && camera->skew != 0.0},
      {"lens_radius", !(holds & VL_HOLDS_LENS) && camera->lens_radius != 0.0},
      {"focus_distance", !(holds & VL_HOLDS_LENS) && !isinf(camera->focus_distance)},
      {"near_plane", !(holds & VL_HOLDS_PLANES) && camera->near_plane != 0.0},
      {"far_plane", !(holds & VL_HOLDS_PLANES) && !isinf(camera->far_plane)},
      {"shutter_open", !(holds & VL_HOLDS_TIME) && camera->shutter_open != 0.0},
      {"shutter_close", !(holds & VL_HOLDS_TIME) && camera->shutter_close != 1.0},
      {"exposure_time", !(holds & VL_HOLDS_EXPOSURE) && camera->exposure_time != 1.0},
      {"max_angle", !vl_is_unset(d->max_angle)},
      {"blades", lens->blades != 0},
      {"aperture", lens->aperture != NULL},
      {"aperture_ratio", lens->ratio != 1.0},
      {"focus_pixel", !vl_is_unset(lens->focus_pixel[0])},
      {"tilt", lens->tilt[0] != 0.0 || lens->tilt[1] != 0.0 || lens->hinge[0] != 0.0 ||
                   lens->hinge[1] != 0.0},
      {"vignetting", lens->vignetting},
      {"shutter_curve", camera->shutter_points != 0},
      {"readout", camera->readout != 0.0},
      {"motion", !(holds & VL_HOLDS_MOTION) && camera->moves},
      {"stereo", d->stereo.mode != VL_STEREO_NONE && d->stereo_eye == VL_EYE_BOTH},
  };
  for (size_t i = 0; i < VL_LENGTH(fields); i++)
    VL_TRY(vl_camera_refuse(file, fields[i].field, fields[i].present));
  if (posed && !(holds & VL_HOLDS_SCALE))
    VL_TRY(make_rigid(file, camera));
  if (vl_camera_drops(file, "skew"))
    camera->skew = 0.0;
  return VL_OK;
}

vlResult vl_camera_no_model(const vlCameraFile *file, const vlCameraDef *def) {
  const char *projection = vl_projection_name(def->projection);
  if (def->distortion == VL_DISTORTION_NONE)
    return vl_camera_cannot_hold(file, "the %s projection with these parameters", projection);
  return vl_camera_cannot_hold(file,
                               "the %s projection with %s distortion and these coefficients",
                               projection, vl_distortion_row(def->distortion)->title);
}

bool vl_camera_as_opencv(const vlCameraDef *def, double k[14], uint32_t *count) {
  static const uint32_t counts[] = {0, 4, 5, 8, 12, 14};
  const double *c = def->distortion_coefficients;
  memset(k, 0, 14 * sizeof *k);
  if (def->distortion == VL_DISTORTION_OPENCV) {
    memcpy(k, c, def->distortion_count * sizeof *k);
  } else if (def->distortion == VL_DISTORTION_RADIAL) {
    k[0] = c[0];
    k[1] = def->distortion_count > 1 ? c[1] : 0.0;
    k[4] = def->distortion_count > 2 ? c[2] : 0.0;
    if (def->distortion_count > 3 && c[3] != 0.0)
      return false;
  } else if (def->distortion != VL_DISTORTION_NONE) {
    return false;
  }
  /* the given number of coefficients, or the smallest that includes all nonzero ones */
  uint32_t last = def->distortion == VL_DISTORTION_OPENCV ? def->distortion_count : 0;
  for (uint32_t i = 0; i < 14; i++)
    if (k[i] != 0.0 && i + 1 > last)
      last = i + 1;
  for (int i = 5; i >= 0 && counts[i] >= last; i--)
    *count = counts[i];
  return true;
}

vlResult vl_camera_refuse_off_centre(const vlCameraFile *file, const vlCamera *camera) {
  VL_TRY(vl_camera_refuse(file, "cx", camera->cx != 0.5 * camera->width));
  return vl_camera_refuse(file, "cy", camera->cy != 0.5 * camera->height);
}

static bool is_whole_sphere(const vlCamera *camera) {
  if (camera->projection != VL_PROJECTION_EQUIRECTANGULAR &&
      camera->projection != VL_PROJECTION_EQUAL_AREA)
    return false;
  vlCameraDef def = vl_default_camera_def(camera->width, camera->height);
  def.projection = camera->projection;
  vlCamera whole;
  if (vl_camera_make(&def, &whole, NULL, NULL) != VL_OK)
    return false;
  const double off[] = {camera->fx - whole.fx, camera->fy - whole.fy, camera->cx - whole.cx,
                        camera->cy - whole.cy, camera->skew};
  bool same = true;
  for (size_t i = 0; i < VL_LENGTH(off); i++)
    same = same && fabs(off[i]) < 1e-9 * camera->width;
  return same;
}

vlResult vl_camera_fit(const vlCameraFile *file, const vlCameraRecord *record,
                       const vlCameraFormat *format, vlFittedCamera *fit) {
  const vlCameraDef *d = &record->camera;
  vlCamera *c = &fit->camera;
  VL_TRY(hold(file, d, format->holds, c));
  fit->file = file;
  fit->format = format;
  fit->record = record;
  fit->family = vl_camera_lens_family(d, fit->k, &fit->count);
  if (fit->family == VL_LENS_FOV) {
    fit->k[0] = c->shape[0];
    fit->count = 1;
  }
  const vlLensSet *lenses = &format->lenses;
  const bool known = lenses->families >> fit->family & 1 && fit->count <= lenses->max;
  const bool fits = fit->family == VL_LENS_FISHEYE || !lenses->terms ||
                    vl_camera_all_zero(fit->k + lenses->terms, 14 - lenses->terms);
  if (!format->plain && lenses->families && !(known && fits))
    return vl_camera_no_model(file, d);
  fit->sphere = is_whole_sphere(c);
  if (format->plain && !(format->spheres && fit->sphere))
    VL_TRY(vl_camera_refuse(file, "projection", d->projection > VL_PROJECTION_ORTHOGRAPHIC));
  if (format->plain)
    VL_TRY(vl_camera_refuse(file, "distortion", c->distortion.steps != 0));
  if (format->centred)
    VL_TRY(vl_camera_refuse_off_centre(file, c));
  if (format->square)
    VL_TRY(vl_camera_refuse(file, "fy", c->fx != c->fy));
  return VL_OK;
}
