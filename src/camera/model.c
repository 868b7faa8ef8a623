/* camera/model.c: checks the coefficients of a lens distortion and converts them to one form;
 * the camera models of COLMAP. */
#include <math.h>

#include "base/error.h"
#include "base/text.h"
#include "camera/parts.h"
#include "camera/points.h"
#include "distortion/compile.h"
#include "distortion/distortion.row.h"
#include "distortion/kinds.row.h"
#include "math/elementary.h"
#include "projection/properties.row.h"
#include "velo/distortion.h"
#include "velo/projection.h"

#define DECLARE(kind, row, compile) vlDistortionCompile compile;
VL_DISTORTION_FUNCTIONS(DECLARE)

static vlResult compile_kind(const vlCameraDef *def, vlDistortionMap *m, vlError *error) {
  switch ((vlDistortionKind)def->distortion) {
#define COMPILE(kind, row, compile) \
  case kind:                        \
    return compile(def->distortion_coefficients, def->distortion_count, m, error);
    VL_DISTORTION_FUNCTIONS(COMPILE)
#undef COMPILE
    case VL_DISTORTION_KIND_COUNT:
      break;
  }
  return VL_ERROR_ARGUMENT;
}

vlResult vl_camera_distortion(const vlCameraDef *def, vlDistortionMap *m, vlError *error) {
  static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double *k = def->distortion_coefficients;
  uint32_t n = def->distortion_count;
  memset(m, 0, sizeof *m);
  memcpy(m->tilt, identity, sizeof identity);
  memcpy(m->untilt, identity, sizeof identity);
  m->radius = INFINITY;
  if (def->distortion == VL_DISTORTION_NONE && n != 0)
    return vl_fail_argument(
        error, "camera: %u distortion coefficients are given without a distortion", n);
  if (def->distortion == VL_DISTORTION_NONE)
    return VL_OK;
  if (vl_projection_row(def->projection)->traits & VL_PROJECTION_NO_DISTORTION)
    return vl_fail_argument(error, "camera: a distortion has no meaning for the %s projection",
                            vl_projection_name(def->projection));
  for (uint32_t i = 0; i < n && i < 14; i++)
    if (!isfinite(k[i]) || fabs(k[i]) > 1e30)
      return vl_fail_argument(error, "camera: distortion coefficient %u is %g", i + 1, k[i]);
  const vlDistortionRow *row = vl_distortion_row(def->distortion);
  if (!row)
    return vl_fail_argument(error, "camera: unknown distortion %d", (int)def->distortion);
  if (n > 14 || !(row->counts >> n & 1))
    return vl_fail_argument(error, "camera: %u %s distortion coefficients; there are %s", n,
                            row->title, row->how_many);
  VL_TRY(compile_kind(def, m, error));
  for (uint32_t i = 0; i < n; i++)
    if (k[i] != 0.0)
      m->steps = 1; /* if all are zero there is no distortion */
  return VL_OK;
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
    {"SIMPLE_DIVISION", 4, VL_PROJECTION_DIVISION, VL_DISTORTION_NONE, true},
    {"DIVISION", 5, VL_PROJECTION_DIVISION, VL_DISTORTION_NONE, false},
    {"SIMPLE_FISHEYE", 3, VL_PROJECTION_EQUIDISTANT, VL_DISTORTION_NONE, true},
    {"FISHEYE", 4, VL_PROJECTION_EQUIDISTANT, VL_DISTORTION_NONE, false},
    {"EUCM", 6, VL_PROJECTION_EUCM, VL_DISTORTION_NONE, false},
    {"RAD_TAN_THIN_PRISM_FISHEYE", 16, VL_PROJECTION_EQUIDISTANT,
     VL_DISTORTION_RAD_TAN_THIN_PRISM, false},
    {"EQUIRECTANGULAR", 2, VL_PROJECTION_EQUIRECTANGULAR, VL_DISTORTION_NONE, false},
};
enum { COLMAP_MODELS = VL_LENGTH(colmap) };

vlResult vl_camera_def_colmap(vlCameraDef *def, const char *model, const double *parameters,
                              uint32_t count, vlError *error) {
  vl_error_clear(error);
  if (!def || !model || (!parameters && count > 0))
    return vl_fail_argument(error, "camera: def, model or parameters is null");
  const Colmap *found = NULL;
  const char *names[COLMAP_MODELS];
  for (int i = 0; i < COLMAP_MODELS; i++) {
    names[i] = colmap[i].name;
    if (vl_text_is(model, names[i]))
      found = &colmap[i];
  }
  if (!found) {
    char known[400];
    vl_tell_names(known, sizeof known, model, names, COLMAP_MODELS);
    return vl_fail_argument(error, "camera: unknown COLMAP camera model \"%s\"%s",
                            vl_argument_text(model).text, known);
  }
  if (count != found->count)
    return vl_fail_argument(error,
                            "camera: the COLMAP camera model %s has %u parameters, not %u",
                            found->name, found->count, count);
  def->projection = found->projection;
  def->distortion = found->distortion;
  def->distortion_count = 0;
  if (found->projection == VL_PROJECTION_EQUIRECTANGULAR) {
    /* width, height: x = w (theta / 2 pi + 1/2), y = h (1/2 - phi / pi) */
    def->fx = parameters[0] / (2.0 * M_PI);
    def->fy = parameters[1] / M_PI;
    def->cx = 0.5 * parameters[0];
    def->cy = 0.5 * parameters[1];
    return VL_OK;
  }
  uint32_t first = found->one_focal ? 3 : 4, rest = count - first;
  def->fx = parameters[0];
  def->fy = parameters[found->one_focal ? 0 : 1];
  def->cx = parameters[first - 2];
  def->cy = parameters[first - 1];
  if (found->distortion == VL_DISTORTION_NONE) {
    memcpy(def->shape, parameters + first, rest * sizeof(double));
  } else {
    def->distortion_count = rest;
    memcpy(def->distortion_coefficients, parameters + first, rest * sizeof(double));
  }
  return VL_OK;
}
