/* camera_files/orbslam.c: settings of ORB-SLAM 2 and 3: keys like Camera.fx, or Camera1.fx and
 * Camera2.fx. x right, y down, z forward; the first pixel's centre is (0, 0). The world's space
 * is the first camera's; the second one's pose in it is Stereo.T_c1_c2 (older: Tlr). */
#include <stdio.h>

#include "base/text.h"
#include "camera_files/fields.h"

static const char *key_of(char key[64], const char *prefix, const char *name) {
  snprintf(key, 64, "%s.%s", prefix, name);
  return key;
}

static const char *const pinhole[] = {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"};
static const char *const radial[] = {"k1", "k2", "k3", "k4"};

/* Reads k1 k2 p1 p2 k3 ... by name. *count includes the last one that exists. */
static vlResult read_lens(const vlCameraFile *file, const json_t *tree, const char *prefix,
                          bool fisheye, vlCameraDef *d) {
  double k[8] = {0};
  char key[64];
  uint32_t count = 0;
  for (uint32_t i = 0; i < (fisheye ? 4u : 8u); i++) {
    key_of(key, prefix, fisheye ? radial[i] : pinhole[i]);
    if (!vl_camera_has(tree, key) && !fisheye)
      continue;
    VL_TRY(vl_camera_number(file, tree, key, &k[i]));
    count = i + 1;
  }
  vl_camera_set_lens(d, fisheye ? VL_LENS_FISHEYE : VL_LENS_OPENCV, k, count);
  return VL_OK;
}

static vlResult read_one(const vlCameraFile *file, const json_t *tree, const char *prefix,
                         vlCameraRecord *record) {
  const char *type = vl_camera_text(tree, "Camera.type");
  char key[64];
  double f[4];
  bool fisheye = vl_text_is(type, "KannalaBrandt8");
  if (type && !vl_has_word("PinHole Rectified KannalaBrandt8", type))
    return vl_camera_unknown(file, tree, "Camera.type", type,
                             "there are PinHole, Rectified, KannalaBrandt8");
  for (int i = 0; i < 4; i++)
    VL_TRY(vl_camera_number(file, tree, key_of(key, prefix, vl_camera_matrix_names[i]), &f[i]));
  VL_TRY(read_lens(file, tree, prefix, fisheye, &record->camera));
  VL_TRY(vl_camera_sides(file, tree, "Camera.width", "Camera.height", record));
  vl_camera_set_centred(&record->camera, f);
  return VL_OK;
}

static vlResult read_orbslam(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  char prefix[16] = "Camera", key[64];
  bool numbered = vl_camera_has(tree, "Camera1.fx"), pair = vl_camera_has(tree, "Camera2.fx");
  record->frames = pair ? 2 : 1;
  uint32_t index = vl_camera_is_frame(file, 0, "Camera1") ? 0 : 1;
  if (index == 1 && !(pair && vl_camera_is_frame(file, 1, "Camera2")))
    return vl_camera_no_frame(file, "camera", record);
  if (numbered || index == 1)
    snprintf(prefix, sizeof prefix, "Camera%u", index + 1);
  VL_TRY(read_one(file, tree, prefix, record));
  vl_camera_set_origin(&record->camera);
  if (index == 1) {
    double m[16] = {[15] = 1.0};
    const char *pose = vl_camera_has(tree, "Tlr") ? "Tlr" : "Stereo.T_c1_c2";
    VL_TRY(vl_camera_numbers(file, tree, pose, m, 12, 16, NULL));
    vl_camera_set_matrix(&record->camera, m, false);
  }
  vl_camera_name(record, vl_camera_text(tree, key_of(key, "Camera", "name")));
  return VL_OK;
}

static vlResult write_orbslam(const vlFittedCamera *fit, vlCameraText *text) {
  const bool fisheye = fit->family == VL_LENS_FISHEYE;
  return VL_PUT_FORM(text, fit,
                     "%YAML:1.0\n"
                     "\n"
                     "File.version: \"1.0\"\n"
                     "\n"
                     "Camera.type: \"$type\"\n"
                     "\n"
                     "Camera1.fx: $fx\n"
                     "Camera1.fy: $fy\n"
                     "Camera1.cx: $cx0\n"
                     "Camera1.cy: $cy0\n"
                     "\n"
                     "$lens\n"
                     "Camera.width: $width\n"
                     "Camera.height: $height\n",
                     VL_WORD("type", fisheye ? "KannalaBrandt8" : "PinHole"),
                     VL_NAMED("lens", fisheye ? radial : pinhole, fit->k, fit->count,
                              "Camera1.$item: $value\n"));
}

const vlCameraFormat vl_format_orbslam = {
    .name = "orbslam",
    .rotates = true,
    .marks = "Camera.fx Camera1.fx Camera.type",
    .one_mark = true,
    .known =
        "Camera.* Camera1.* Camera2.* Tlr data rows cols dt Stereo.* LEFT.* RIGHT.* File.version "
        /* of the estimator */
        "IMU.* ORBextractor.* Viewer.* System.* ThDepth DepthMapFactor RGBD.* Tbc loopClosing "
        "IMU",
    .read = read_orbslam,
    .lenses = {VL_LENSES_COMMON, 0, 5},
    .write = write_orbslam};
