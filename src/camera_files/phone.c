/* camera_files/phone.c: the JSON of phone scanners, whose poses are ARKit's: world from camera,
 * camera axes x right, y up, z back; the first pixel's centre is (0.5, 0.5). Record3D: metadata
 * of a recording, with K by columns and poses (qx qy qz qw x y z). Polycam:
 * keyframes/cameras/N.json, with t_00 to t_23 by rows. 3D Scanner App: frame_N.json, with
 * cameraPoseARFrame and intrinsics by rows; the size is that of the image beside it. */

#include "camera_files/fields.h"

/* ---- Record3D ---------------------------------------------------------------------------- */

static vlResult read_record3d(const vlCameraFile *file, const json_t *tree,
                              vlCameraRecord *record) {
  const json_t *poses = json_object_get(tree, "poses"),
               *own = json_object_get(tree, "perFrameIntrinsicCoeffs");
  vlCameraDef *d = &record->camera;
  const json_t *pose = NULL, *coefficients = NULL;
  double v[7], k[9], r[9], f[4];
  record->frames = (uint32_t)json_array_size(poses);
  for (uint32_t i = 0; i < record->frames && !pose; i++)
    if (vl_camera_is_frame(file, i, NULL)) {
      pose = json_array_get(poses, i);
      coefficients = json_array_get(own, i);
    }
  if (!pose)
    return vl_camera_no_frame(file, "camera", record);
  VL_TRY(vl_camera_numbers_of(file, tree, "poses", pose, v, 7, 7, NULL));
  if (coefficients)
    VL_TRY(vl_camera_numbers_of(file, tree, "perFrameIntrinsicCoeffs", coefficients, f, 4, 4,
                                NULL));
  VL_TRY(vl_camera_list(file, tree, "K", k, 9));
  VL_TRY(vl_camera_sides(file, tree, "w", "h", record));
  const double q[4] = {v[3], v[0], v[1], v[2]};
  if (!vl_rotation_from_quaternion(q, r))
    return vl_camera_wrong_in(file, pose, NULL,
                              "record3d: the quaternion of \"poses\" is no rotation");
  vl_camera_set_rigid(d, r, v + 4);
  vl_camera_set_flipped(d, d->world_from_camera);
  d->fx = coefficients ? f[0] : k[0];
  d->fy = coefficients ? f[1] : k[4];
  d->cx = coefficients ? f[2] : k[6];
  d->cy = coefficients ? f[3] : k[7];
  return VL_OK;
}

static bool is_record3d(const json_t *tree) {
  return vl_camera_has(tree, "poses") && vl_camera_has(tree, "K") &&
         json_is_array(json_object_get(tree, "poses"));
}

const vlCameraFormat vl_format_record3d = {
    .name = "record3d",
    .known =
        "poses K w h fps dw dh initPose! perFrameIntrinsicCoeffs frameTimestamps! cameraType "
        "rgbFormat",
    .is_tree = is_record3d,
    .read = read_record3d,
    .not_written = "it describes a recording of a phone"};

/* ---- Polycam ----------------------------------------------------------------------------- */

static vlResult read_polycam(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double m[16] = {[15] = 1.0};
  VL_TRY(VL_READ_FIELDS(file, tree, VL_FIELD_SIDE("width", &d->width),
                        VL_FIELD_SIDE("height", &d->height), VL_FIELD("fx", &d->fx),
                        VL_FIELD("fy", &d->fy), VL_FIELD("cx", &d->cx),
                        VL_FIELD("cy", &d->cy)));
  for (int i = 0; i < 12; i++) {
    const char key[] = {'t', '_', (char)('0' + i / 4), (char)('0' + i % 4), 0};
    VL_TRY(vl_camera_number(file, tree, key, &m[i]));
  }
  vl_camera_set_flipped(d, m);
  return VL_OK;
}

const vlCameraFormat vl_format_polycam = {
    .name = "polycam",
    .known =
        "t_* fx fy cx cy width height blur_score center_depth manual_keyframe neighbors! "
        "timestamp",
    .marks = "t_00 t_23 fx",
    .read = read_polycam,
    .holds = VL_HOLDS_POSE,
    .lenses = {VL_LENSES_PINHOLE},
    .form =
        "{\n"
        "  \"width\": $width, \"height\": $height,\n"
        "  \"fx\": $fx, \"fy\": $fy, \"cx\": $cx, \"cy\": $cy,\n"
        "  \"t_00\": $flipped@0, \"t_01\": $flipped@1, \"t_02\": $flipped@2, \"t_03\": "
        "$flipped@3,\n"
        "  \"t_10\": $flipped@4, \"t_11\": $flipped@5, \"t_12\": $flipped@6, \"t_13\": "
        "$flipped@7,\n"
        "  \"t_20\": $flipped@8, \"t_21\": $flipped@9, \"t_22\": $flipped@10, \"t_23\": "
        "$flipped@11\n"
        "}\n"};

/* ---- 3D Scanner App ---------------------------------------------------------------------- */

static vlResult read_scanner(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double m[16], k[9];
  VL_TRY(VL_READ_FIELDS(file, tree, VL_FIELD_LIST("cameraPoseARFrame", m, 16),
                        VL_FIELD_LIST("intrinsics", k, 9)));
  vl_camera_set_flipped(d, m);
  d->fx = k[0];
  d->fy = k[4];
  d->cx = k[2];
  d->cy = k[5];
  return vl_camera_size_of_image(file, record);
}

const vlCameraFormat vl_format_scanner3d = {
    .name = "scanner3d",
    .known =
        "cameraPoseARFrame intrinsics projectionMatrix! frame_index motionQuality "
        "averageAngularVelocity averageVelocity exposureDuration time cameraGrain",
    .marks = "cameraPoseARFrame intrinsics",
    .read = read_scanner,
    .not_written = "it describes a recording of a phone"};
