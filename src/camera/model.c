/* camera/model.c: checks the parameters of a projection and of a lens distortion, and converts
 * them to one form. */
#include <math.h>

#include "base/error.h"
#include "base/text.h"
#include "camera/parts.h"
#include "camera/points.h"
#include "math/elementary.h"
#include "math/transform.h"
#include "projection/properties.row.h"
#include "velo/projection.h"

static vlResult shape(const vlCameraDef *def, vlCamera *camera, vlError *error) {
  const vlProjectionRow *row = vl_projection_row(def->projection);
  const char *name = row->name;
  const vlShapeNumber *n = row->numbers;
  int count = (int)row->count;
  camera->shape[0] = camera->shape[1] = 0.0;
  for (int i = 0; i < 2; i++) {
    double value = def->shape[i];
    if (i >= count) {
      if (!vl_is_unset(value))
        return vl_fail(error, VL_ERROR_ARGUMENT,
                       "camera: the %s projection takes %d numbers; shape[%d] is %g", name,
                       count, i, value);
      continue;
    }
    if (vl_is_unset(value))
      value = n[i].standard;
    if (vl_is_unset(value))
      return vl_fail(error, VL_ERROR_ARGUMENT, "camera: the %s projection needs its %s", name,
                     n[i].name);
    if (!(value >= n[i].least && value <= n[i].most))
      return vl_fail(error, VL_ERROR_ARGUMENT,
                     "camera: %s of the %s projection is %g; it must be %g to %g", n[i].name,
                     name, value, n[i].least, n[i].most);
    if (def->projection == VL_PROJECTION_CUBE && value != 0.0 && value != 1.0)
      return vl_fail(error, VL_ERROR_ARGUMENT,
                     "camera: layout of the cube is %g; it must be 0 (a row) or 1 (a cross)",
                     value);
    camera->shape[i] = value;
  }
  return VL_OK;
}

/* OpenCV's tilted sensor: rotation about x by tau_x, then y by tau_y, then projection along the
 * axis onto the plane. */
static void tilt(vlDistortionMap *m, double tau_x, double tau_y) {
  vlSinCosDouble x = vl_sincos_double(tau_x), y = vl_sincos_double(tau_y);
  const double about_x[9] = {1, 0, 0, 0, x.cos, x.sin, 0, -x.sin, x.cos};
  const double about_y[9] = {y.cos, 0, -y.sin, 0, 1, 0, y.sin, 0, y.cos};
  double r[9];
  vl_mat3_multiply(about_y, about_x, r);
  const double back[9] = {r[8], 0, -r[2], 0, r[8], -r[5], 0, 0, 1};
  vl_mat3_multiply(back, r, m->tilt);
  vl_mat3_inverse(m->tilt, m->untilt);
}

static vlResult distortion(const vlCameraDef *def, vlDistortionMap *m, vlError *error) {
  static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double *k = def->distortion_coefficients;
  uint32_t n = def->distortion_count;
  memset(m, 0, sizeof *m);
  memcpy(m->tilt, identity, sizeof identity);
  memcpy(m->untilt, identity, sizeof identity);
  m->radius = INFINITY;
  if (def->distortion == VL_DISTORTION_NONE && n != 0)
    return vl_fail(error, VL_ERROR_ARGUMENT,
                   "camera: %u distortion coefficients are given without a distortion", n);
  if (def->distortion == VL_DISTORTION_NONE)
    return VL_OK;
  if (vl_projection_row(def->projection)->traits & VL_PROJECTION_NO_DISTORTION)
    return vl_fail(error, VL_ERROR_ARGUMENT,
                   "camera: a distortion has no meaning for the %s projection",
                   vl_projection_name(def->projection));
  for (uint32_t i = 0; i < n && i < 14; i++)
    if (!isfinite(k[i]) || fabs(k[i]) > 1e30)
      return vl_fail(error, VL_ERROR_ARGUMENT, "camera: distortion coefficient %u is %g", i + 1,
                     k[i]);
  if ((uint32_t)def->distortion > VL_DISTORTION_THIN_PRISM)
    return vl_fail(error, VL_ERROR_ARGUMENT, "camera: unknown distortion %d",
                   (int)def->distortion);
  switch (def->distortion) {
    case VL_DISTORTION_NONE:
      break;
    case VL_DISTORTION_OPENCV: {
      if (n != 4 && n != 5 && n != 8 && n != 12 && n != 14)
        return vl_fail(error, VL_ERROR_ARGUMENT,
                       "camera: %u OpenCV distortion coefficients; there are 4, 5, 8, 12 or 14",
                       n);
      double c[14] = {0};
      memcpy(c, k, n * sizeof *c);
      m->numerator[0] = c[0];
      m->numerator[1] = c[1];
      m->numerator[2] = c[4];
      for (int i = 0; i < 3; i++)
        m->denominator[i] = c[5 + i];
      m->tangential[0] = c[2];
      m->tangential[1] = c[3];
      for (int i = 0; i < 4; i++)
        m->prism[i] = c[8 + i];
      if (!(fabs(c[12]) < 1.5 && fabs(c[13]) < 1.5))
        return vl_fail(error, VL_ERROR_ARGUMENT,
                       "camera: the sensor's tilt %g, %g radians must be below 1.5", c[12],
                       c[13]);
      if (c[12] != 0.0 || c[13] != 0.0)
        tilt(m, c[12], c[13]);
      break;
    }
    case VL_DISTORTION_RADIAL:
      if (n < 1 || n > 4)
        return vl_fail(error, VL_ERROR_ARGUMENT,
                       "camera: %u radial distortion coefficients; there are 1 to 4", n);
      memcpy(m->numerator, k, n * sizeof *k);
      break;
    case VL_DISTORTION_THIN_PRISM:
      if (n != 8)
        return vl_fail(error, VL_ERROR_ARGUMENT,
                       "camera: %u thin-prism distortion coefficients; there are 8", n);
      m->numerator[0] = k[0];
      m->numerator[1] = k[1];
      m->numerator[2] = k[4];
      m->numerator[3] = k[5];
      m->tangential[0] = k[2];
      m->tangential[1] = k[3];
      m->prism[0] = k[6];
      m->prism[2] = k[7];
      break;
  }
  for (uint32_t i = 0; i < n; i++)
    if (k[i] != 0.0)
      m->steps = 1; /* if all are zero there is no distortion */
  return VL_OK;
}

vlResult vl_camera_model(const vlCameraDef *def, vlCamera *camera, vlError *error) {
  vlResult result = shape(def, camera, error);
  if (result == VL_OK)
    result = distortion(def, &camera->distortion, error);
  camera->limit = INFINITY;
  return result;
}

bool vl_camera_plane_radius(const vlCamera *camera, double angle, bool vertical,
                            double *radius) {
  vlCameraCompiled c;
  memset(&c, 0, sizeof c);
  c.shape[0] = camera->shape[0];
  c.shape[1] = camera->shape[1];
  if (camera->projection == VL_PROJECTION_FOV)
    c.shape[1] = 2.0 * vl_precise_tan(0.5 * camera->shape[0]);
  c.limit2 = INFINITY;
  double s = vl_precise_sin(angle), z = vl_precise_cos(angle);
  vlPlanePoint p =
      vl_plane_project(camera->projection, &c, vertical ? 0.0 : s, vertical ? s : 0.0, z);
  *radius = vertical ? p.y : p.x;
  return p.valid > 0.0 && isfinite(*radius) && *radius > 0.0;
}

bool vl_camera_sees_ahead(vlProjection kind) {
  return vl_projection_row(kind)->traits & VL_PROJECTION_AHEAD;
}

/* ---- COLMAP's models (sensor/models.h of COLMAP; parameters in its order) ---------------- */

typedef struct {
  const char *name;
  uint32_t count;
  vlProjection projection;
  vlDistortion distortion;
  bool one_focal; /* f cx cy instead of fx fy cx cy */
} Colmap;

static const Colmap colmap[] = {
    {"SIMPLE_PINHOLE", 3, VL_PROJECTION_PERSPECTIVE, VL_DISTORTION_NONE, true},
    {"PINHOLE", 4, VL_PROJECTION_PERSPECTIVE, VL_DISTORTION_NONE, false},
    {"SIMPLE_RADIAL", 4, VL_PROJECTION_PERSPECTIVE, VL_DISTORTION_RADIAL, true},
    {"RADIAL", 5, VL_PROJECTION_PERSPECTIVE, VL_DISTORTION_RADIAL, true},
    {"OPENCV", 8, VL_PROJECTION_PERSPECTIVE, VL_DISTORTION_OPENCV, false},
    {"OPENCV_FISHEYE", 8, VL_PROJECTION_EQUIDISTANT, VL_DISTORTION_RADIAL, false},
    {"FULL_OPENCV", 12, VL_PROJECTION_PERSPECTIVE, VL_DISTORTION_OPENCV, false},
    {"FOV", 5, VL_PROJECTION_FOV, VL_DISTORTION_NONE, false},
    {"SIMPLE_RADIAL_FISHEYE", 4, VL_PROJECTION_EQUIDISTANT, VL_DISTORTION_RADIAL, true},
    {"RADIAL_FISHEYE", 5, VL_PROJECTION_EQUIDISTANT, VL_DISTORTION_RADIAL, true},
    {"THIN_PRISM_FISHEYE", 12, VL_PROJECTION_EQUIDISTANT, VL_DISTORTION_THIN_PRISM, false},
};
enum { COLMAP_MODELS = VL_LENGTH(colmap) };

vlResult vl_camera_def_colmap(vlCameraDef *def, const char *model, const double *parameters,
                              uint32_t count, vlError *error) {
  vl_error_clear(error);
  if (!def || !model || (!parameters && count > 0))
    return vl_fail(error, VL_ERROR_ARGUMENT, "camera: def, model or parameters is null");
  const Colmap *found = NULL;
  const char *names[COLMAP_MODELS];
  for (int i = 0; i < COLMAP_MODELS; i++) {
    names[i] = colmap[i].name;
    if (vl_text_is(model, names[i]))
      found = &colmap[i];
  }
  if (!found) {
    char known[300];
    vl_tell_names(known, sizeof known, model, names, COLMAP_MODELS);
    return vl_fail(error, VL_ERROR_ARGUMENT, "camera: unknown COLMAP camera model \"%s\"%s",
                   vl_argument_text(model).text, known);
  }
  if (count != found->count)
    return vl_fail(error, VL_ERROR_ARGUMENT,
                   "camera: the COLMAP camera model %s has %u parameters, not %u", found->name,
                   found->count, count);
  uint32_t first = found->one_focal ? 3 : 4, rest = count - first;
  def->projection = found->projection;
  def->distortion = found->distortion;
  def->fx = parameters[0];
  def->fy = parameters[found->one_focal ? 0 : 1];
  def->cx = parameters[first - 2];
  def->cy = parameters[first - 1];
  def->distortion_count = 0;
  if (found->projection == VL_PROJECTION_FOV) {
    def->shape[0] = parameters[4];
  } else {
    def->distortion_count = rest;
    memcpy(def->distortion_coefficients, parameters + first, rest * sizeof(double));
  }
  return VL_OK;
}
