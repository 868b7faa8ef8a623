/* camera_files/rigs.c: JSON of rigs and datasets. Axes: x right, y down, z forward.
 *   calib.io      Calibration.cameras with OpenCV's lens by name; fy = f ar; pose: camera from
 *                 world, as rotation vector and translation
 *   nuScenes      a list of calibrated_sensor; pose: vehicle from camera, as quaternion w x y z
 *                 and translation; no image size
 *   CMU Panoptic  cameras with K, distCoef, R, t; pose: camera from world, in centimetres
 *   Nerfies       orientation, camera from world, and position, the camera's centre
 * The first pixel's centre is (0, 0); in Nerfies' files it is (0.5, 0.5). */

#include "base/text.h"
#include "camera_files/fields.h"

/* ---- calib.io ---------------------------------------------------------------------------- */

/* A parameter: a number, or an object that holds it as "val". */
static vlResult read_value(const vlCameraFile *file, const json_t *parameters, const char *key,
                           bool needed, double *value) {
  const json_t *field = json_object_get(parameters, key);
  if (!field && !needed)
    return VL_OK;
  if (!json_is_object(field))
    return vl_camera_number(file, parameters, key, value);
  return vl_camera_number(file, field, "val", value);
}

/* Camera from world: a rotation vector and a translation; the origin without a transform. */
static vlResult read_transform(const vlCameraFile *file, const json_t *transform,
                               vlCameraDef *d) {
  static const char *const angles[] = {"rx", "ry", "rz"};
  static const char *const lengths[] = {"x", "y", "z"};
  const json_t *rotation = json_object_get(transform, "rotation");
  const json_t *translation = json_object_get(transform, "translation");
  double v[3] = {0.0}, t[3] = {0.0}, r[9];
  for (int i = 0; i < 3 && transform; i++) {
    VL_TRY(vl_camera_number(file, rotation, angles[i], &v[i]));
    VL_TRY(vl_camera_number(file, translation, lengths[i], &t[i]));
  }
  vl_rotation_from_vector(v, r);
  vl_camera_set_pose(d, r, t);
  return VL_OK;
}

static vlResult read_calibio(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  static const char *const lens[] = {"k1", "k2", "p1", "p2", "k3", "k4",   "k5",
                                     "k6", "s1", "s2", "s3", "s4", "tauX", "tauY"};
  const json_t *list = json_object_get(json_object_get(tree, "Calibration"), "cameras");
  const json_t *camera = vl_camera_choose(file, list, NULL, record);
  vlCameraDef *d = &record->camera;
  double f[4] = {0.0}; /* fx, fy, cx, cy */
  double aspect = 1.0, k[14] = {0.0};
  if (!camera)
    return vl_camera_no_frame(file, "camera", record);
  const json_t *model, *parameters;
  VL_TRY(vl_camera_field(file, camera, "model", &model));
  const char *name = vl_camera_text(model, "polymorphic_name");
  if (name && !vl_text_is(name, "libCalib::CameraModelOpenCV"))
    return vl_camera_unknown(file, model, "polymorphic_name", name,
                             "there is libCalib::CameraModelOpenCV");
  const json_t *data = json_object_get(json_object_get(model, "ptr_wrapper"), "data");
  const json_t *base = json_object_get(data, "CameraModelCRT");
  if (!base)
    base = json_object_get(data, "CameraModelCRTP");
  const json_t *size = json_object_get(json_object_get(base, "CameraModelBase"), "imageSize");
  VL_TRY(vl_camera_sides(file, size, "width", "height", record));
  VL_TRY(vl_camera_field(file, data, "parameters", &parameters));
  VL_TRY(read_value(file, parameters, "f", true, &f[0]));
  VL_TRY(read_value(file, parameters, "ar", false, &aspect));
  VL_TRY(read_value(file, parameters, "cx", true, &f[2]));
  VL_TRY(read_value(file, parameters, "cy", true, &f[3]));
  for (int i = 0; i < 14; i++)
    VL_TRY(read_value(file, parameters, lens[i], false, &k[i]));
  VL_TRY(read_transform(file, json_object_get(camera, "transform"), d));
  f[1] = f[0] * aspect;
  vl_camera_set_centred(d, f);
  vl_camera_set_shortest(d, k, 14);
  return VL_OK;
}

static bool is_calibio(const json_t *tree) {
  return vl_camera_has_in(json_object_get(tree, "Calibration"), "cameras", "model");
}

const vlCameraFormat vl_format_calibio = {
    .name = "calibio",
    .rotates = true,
    .known =
        "Calibration cameras model polymorphic_id polymorphic_name ptr_wrapper id data "
        "parameters val state f ar cx cy k1 k2 k3 k4 k5 k6 p1 p2 s1 s2 s3 s4 tauX tauY "
        "CameraModelCRT CameraModelCRTP CameraModelBase valid imageSize width height transform "
        "rotation translation rx ry rz x y z name targets! poses! detections! stats! "
        "covariance! statistics! version cereal_class_version",
    .is_tree = is_calibio,
    .read = read_calibio,
    .not_written = "it is the result of a calibration, with its statistics"};

/* ---- nuScenes ---------------------------------------------------------------------------- */

static vlResult read_nuscenes(const vlCameraFile *file, const json_t *tree,
                              vlCameraRecord *record) {
  const json_t *list = json_object_get(tree, "[]"), *item, *chosen = NULL;
  vlCameraDef *d = &record->camera;
  double k[9], q[4], t[3], r[9];
  record->frames = 0;
  VL_EACH(item, list) {
    if (json_array_size(json_object_get(item, "camera_intrinsic")) == 0)
      continue; /* lidar and radar */
    vl_camera_offer(file, item, vl_camera_text(item, "token"), record, &chosen);
  }
  if (!chosen)
    return vl_camera_no_frame(file, "camera", record);
  VL_TRY(VL_READ_FIELDS(file, chosen, VL_FIELD_LIST("camera_intrinsic", k, 9),
                        VL_FIELD_LIST("rotation", q, 4), VL_FIELD_LIST("translation", t, 3)));
  VL_TRY(vl_camera_set_k(file, chosen, "camera_intrinsic", k, d));
  if (!vl_rotation_from_quaternion(q, r))
    return vl_camera_wrong_in(file, chosen, "rotation",
                              "nuscenes: the quaternion \"rotation\" is no rotation");
  vl_camera_set_rigid(d, r, t);
  return vl_camera_size_beside(file, NULL, record);
}

const vlCameraFormat vl_format_nuscenes = {
    .name = "nuscenes",
    .rotates = true,
    .known = "token sensor_token translation rotation camera_intrinsic",

    .marks = "camera_intrinsic rotation",
    .marks_in = "[]",
    .read = read_nuscenes,
    .not_written = "it is a table of a dataset, with keys of other tables"};

/* ---- CMU Panoptic ------------------------------------------------------------------------ */

static vlResult read_panoptic(const vlCameraFile *file, const json_t *tree,
                              vlCameraRecord *record) {
  const json_t *chosen =
      vl_camera_choose(file, json_object_get(tree, "cameras"), "name", record);
  vlCameraDef *d = &record->camera;
  double k[9], lens[5], r[9], t[3];
  if (!chosen)
    return vl_camera_no_frame(file, "camera", record);
  VL_TRY(vl_camera_side_pair(file, chosen, "resolution", record));
  VL_TRY(VL_READ_FIELDS(file, chosen, VL_FIELD_LIST("K", k, 9),
                        VL_FIELD_LIST("distCoef", lens, 5), VL_FIELD_LIST("R", r, 9),
                        VL_FIELD_LIST("t", t, 3)));
  VL_TRY(vl_camera_set_k(file, chosen, "K", k, d));
  vl_camera_set_shortest(d, lens, 5);
  vl_camera_set_pose(d, r, t);
  return VL_OK;
}

const vlCameraFormat vl_format_panoptic = {
    .name = "panoptic",
    .rotates = true,
    .known = "calibDataSource cameras name type resolution panel node K distCoef R t",

    .marks = "distCoef K",
    .marks_in = "cameras",
    .read = read_panoptic,
    .holds = VL_HOLDS_POSE | VL_HOLDS_SKEW,
    .lenses = {VL_LENSES_OPENCV, 5, 5},
    .unnamed = "00_00",
    .form =
        "{\"cameras\": [\n"
        "  {\"name\": $name, \"type\": \"hd\", \"resolution\": [$width, $height], \"panel\": "
        "0, \"node\": 0,\n"
        "   \"K\": [$K:3],\n"
        "   \"distCoef\": [$k],\n"
        "   \"R\": [$R:3],\n"
        "   \"t\": [$t:1]}\n"
        "]}\n"};

/* ---- Nerfies ----------------------------------------------------------------------------- */

static vlResult read_nerfies(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double r[9], p[3], f, c[2], aspect = 1.0, radial[3] = {0.0}, tangential[2] = {0.0};
  VL_TRY(vl_camera_side_pair(file, tree, "image_size", record));
  VL_TRY(VL_READ_FIELDS(
      file, tree, VL_FIELD_LIST("orientation", r, 9), VL_FIELD_LIST("position", p, 3),
      VL_FIELD("focal_length", &f), VL_FIELD_LIST("principal_point", c, 2),
      VL_FIELD_OPTIONAL("skew", &d->skew), VL_FIELD_OPTIONAL("pixel_aspect_ratio", &aspect),
      VL_FIELD_LIST_OPTIONAL("radial_distortion", radial, 3, NULL),
      VL_FIELD_LIST_OPTIONAL("tangential_distortion", tangential, 2, NULL)));
  d->fx = f;
  d->fy = f * aspect;
  d->cx = c[0];
  d->cy = c[1];
  vl_camera_set_shortest(
      d, (double[]){radial[0], radial[1], tangential[0], tangential[1], radial[2]}, 5);
  vl_camera_set_centre(d, r, p);
  return VL_OK;
}

const vlCameraFormat vl_format_nerfies = {
    .name = "nerfies",
    .rotates = true,
    .known =
        "orientation position focal_length principal_point skew pixel_aspect_ratio "
        "radial_distortion tangential_distortion image_size",
    .marks = "orientation focal_length principal_point",
    .read = read_nerfies,
    .holds = VL_HOLDS_POSE | VL_HOLDS_SKEW,
    .lenses = {VL_LENSES_OPENCV, 5, 5},
    .form =
        "{\n"
        "  \"orientation\": [$R:3],\n"
        "  \"position\": [$centre],\n"
        "  \"focal_length\": $fx,\n"
        "  \"principal_point\": [$cx, $cy],\n"
        "  \"skew\": $skew,\n"
        "  \"pixel_aspect_ratio\": $aspect,\n"
        "  \"radial_distortion\": [$k@0, $k@1, $k@4],\n"
        "  \"tangential_distortion\": [$k@2, $k@3],\n"
        "  \"image_size\": [$width, $height]\n"
        "}\n"};
