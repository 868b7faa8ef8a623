/* camera_files/lens.c: the lens models that calibration tools have in common, and poses given
 * as matrices. */
#include <math.h>
#include <string.h>

#include "camera_files/files.h"
#include "math/double3.h"
#include "math/transform.h"
#include "velo/distortion.h"
#include "velo/projection.h"

bool vl_camera_all_zero(const double *k, uint32_t count) {
  for (uint32_t i = 0; i < count; i++)
    if (k[i] != 0.0)
      return false;
  return true;
}

void vl_camera_set_centred(vlCameraDef *def, const double f[4]) {
  def->fx = f[0];
  def->fy = f[1];
  def->cx = f[2] + 0.5;
  def->cy = f[3] + 0.5;
}

bool vl_camera_set_intrinsics(vlCameraDef *d, const double k[9], bool skew) {
  if (k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0 || (!skew && k[1] != 0.0))
    return false;
  vl_camera_set_centred(d, (double[]){k[0], k[4], k[2], k[5]});
  d->skew = k[1];
  return true;
}

void vl_camera_set_opencv(vlCameraDef *def, const double *k, uint32_t count) {
  static const uint32_t counts[] = {4, 5, 8, 12, 14};
  def->distortion = count ? VL_DISTORTION_OPENCV : VL_DISTORTION_NONE;
  memset(def->distortion_coefficients, 0, sizeof def->distortion_coefficients);
  memcpy(def->distortion_coefficients, k, count * sizeof *k);
  def->distortion_count = 0;
  for (int i = 4; i >= 0 && count; i--)
    if (counts[i] >= count)
      def->distortion_count = counts[i];
}

void vl_camera_set_shortest(vlCameraDef *def, const double *k, uint32_t count) {
  while (count && k[count - 1] == 0.0)
    count--;
  vl_camera_set_opencv(def, k, count);
}

void vl_camera_set_fisheye(vlCameraDef *def, const double k[4]) {
  def->projection = VL_PROJECTION_EQUIDISTANT;
  def->distortion = VL_DISTORTION_RADIAL;
  def->distortion_count = 4;
  memcpy(def->distortion_coefficients, k, 4 * sizeof *k);
}

void vl_camera_set_lens(vlCameraDef *def, vlLensFamily family, const double *k,
                        uint32_t count) {
  static const vlProjection projections[VL_LENS_OTHER] = {
      [VL_LENS_FOV] = VL_PROJECTION_FOV,
      [VL_LENS_UNIFIED] = VL_PROJECTION_UNIFIED,
      [VL_LENS_EUCM] = VL_PROJECTION_EUCM,
      [VL_LENS_DOUBLE_SPHERE] = VL_PROJECTION_DOUBLE_SPHERE};
  if (family >= VL_LENS_FOV)
    def->projection = projections[family];
  if (family == VL_LENS_OPENCV || family == VL_LENS_UNIFIED)
    vl_camera_set_opencv(def, k, count);
  if (family == VL_LENS_FISHEYE)
    vl_camera_set_fisheye(def, k);
  if (family == VL_LENS_FOV)
    def->shape[0] = k[0];
}

vlLensFamily vl_camera_lens_family(const vlCameraDef *d, double k[14], uint32_t *count) {
  *count = 0;
  memset(k, 0, 14 * sizeof *k);
  bool plain = d->distortion == VL_DISTORTION_NONE;
  if (d->projection == VL_PROJECTION_PERSPECTIVE || d->projection == VL_PROJECTION_UNIFIED) {
    bool unified = d->projection == VL_PROJECTION_UNIFIED;
    if (!vl_camera_as_opencv(d, k, count))
      return VL_LENS_OTHER;
    return unified ? VL_LENS_UNIFIED : *count ? VL_LENS_OPENCV : VL_LENS_PINHOLE;
  }
  if (d->projection == VL_PROJECTION_EQUIDISTANT &&
      (plain || d->distortion == VL_DISTORTION_RADIAL)) {
    memcpy(k, d->distortion_coefficients, d->distortion_count * sizeof *k);
    *count = 4;
    return VL_LENS_FISHEYE;
  }
  if (!plain)
    return VL_LENS_OTHER;
  if (d->projection == VL_PROJECTION_FOV)
    return VL_LENS_FOV;
  if (d->projection == VL_PROJECTION_EUCM)
    return VL_LENS_EUCM;
  return d->projection == VL_PROJECTION_DOUBLE_SPHERE ? VL_LENS_DOUBLE_SPHERE : VL_LENS_OTHER;
}

bool vl_camera_set_matrix(vlCameraDef *def, const double m[16], bool from_world) {
  vlMat4 pose = vl_mat4_load(m); /* vl_camera_make refuses another last row than 0 0 0 1 */
  if (from_world && !vl_mat4_inverse(pose, &pose))
    return false;
  def->has_matrix = true;
  for (int i = 0; i < 16; i++)
    def->world_from_camera[i] = pose.m[i] + 0.0;
  return true;
}

vlResult vl_camera_check_rotation(const vlCameraFile *file, const vlCameraRecord *record) {
  const double *m = record->camera.world_from_camera, max = 0.05; /* of rounded numbers */
  double dot[3][3];
  bool unit = true, right = true;
  if (!record->camera.has_matrix || !vl_mat4_is_finite(vl_mat4_load(m)))
    return VL_OK; /* vl_camera_make refuses what is not finite */
  for (int i = 0; i < 3; i++)
    for (int j = i; j < 3; j++) {
      dot[i][j] = vl_dot_columns(m, i, j);
      unit = unit && (i != j || fabs(dot[i][i] - 1.0) <= max);
      right = right && (i == j || fabs(dot[i][j]) <= max);
    }
  if (!unit)
    return vl_camera_wrong(file,
                           "%s: the pose is no rotation and translation: its axes have the "
                           "lengths %.4g, %.4g, %.4g",
                           file->dialect, sqrt(dot[0][0]), sqrt(dot[1][1]), sqrt(dot[2][2]));
  if (!right)
    return vl_camera_wrong(
        file, "%s: the pose is no rotation and translation: its axes are not perpendicular",
        file->dialect);
  if (vl_determinant3(m) < 0.0)
    return vl_camera_wrong(file, "%s: the pose is no rotation and translation: it mirrors",
                           file->dialect);
  return VL_OK;
}

void vl_camera_set_origin(vlCameraDef *def) {
  const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, none[3] = {0, 0, 0};
  vl_camera_set_pose(def, identity, none);
}
