/* camera_files/opensfm.c: OpenSfM's reconstruction.json (a list of reconstructions with cameras
 * and shots) and camera_models.json (cameras by name), which OpenDroneMap also writes. Camera
 * axes: x right, y down, z forward. A shot's rotation (axis and angle) and translation are
 * camera from world. Lengths in the image are fractions of its larger side, measured from its
 * middle: velo's cx is width / 2 + c_x max(width, height). */

#include "base/text.h"
#include "camera_files/fields.h"
#include "velo/projection.h"

static const char *const brown[] = {"k1", "k2", "p1", "p2", "k3"};
static const char *const fisheye[] = {"k1", "k2", "k3", "k4"};

static vlResult read_lens(const vlCameraFile *file, const json_t *camera, const char *type,
                          vlCameraDef *d) {
  double k[5] = {0.0};
  if (vl_text_is(type, "brown")) {
    VL_TRY(vl_camera_read_named(file, camera, brown, 5, true, k));
    vl_camera_set_opencv(d, k, 5);
  } else if (vl_has_word("perspective radial simple_radial", type)) {
    VL_TRY(vl_camera_read_named(file, camera, brown, 2, true, k));
    vl_camera_set_opencv(d, k, 4);
  } else if (vl_has_word("fisheye fisheye_opencv", type)) {
    VL_TRY(vl_camera_read_named(file, camera, fisheye, 4, true, k));
    if (vl_text_is(type, "fisheye")) { /* has k1 and k2 only */
      k[2] = 0.0;
      k[3] = 0.0;
    }
    vl_camera_set_fisheye(d, k);
  } else if (vl_has_word("spherical equirectangular", type)) {
    d->projection = VL_PROJECTION_EQUIRECTANGULAR;
  } else {
    return vl_camera_wrong_in(
        file, camera, "projection_type",
        "opensfm: projection_type \"%s\" is no model of velo; there are perspective, brown, "
        "radial, simple_radial, fisheye, fisheye_opencv, spherical",
        vl_short_text(type).text);
  }
  return VL_OK;
}

static vlResult read_camera(const vlCameraFile *file, const json_t *camera,
                            vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  const char *type = vl_camera_text(camera, "projection_type");
  double f[2], c[2] = {0.0, 0.0};
  if (!type)
    type = "perspective";
  VL_TRY(VL_READ_FIELDS(file, camera, VL_FIELD_SIDE("width", &d->width),
                        VL_FIELD_SIDE("height", &d->height)));
  VL_TRY(read_lens(file, camera, type, d));
  if (d->projection == VL_PROJECTION_EQUIRECTANGULAR)
    return VL_OK;
  bool one = vl_camera_has(camera, "focal");
  VL_TRY(VL_READ_FIELDS(file, camera, VL_FIELD(one ? "focal" : "focal_x", &f[0]),
                        VL_FIELD(one ? "focal" : "focal_y", &f[1]),
                        VL_FIELD_OPTIONAL("c_x", &c[0]), VL_FIELD_OPTIONAL("c_y", &c[1])));
  double side = d->width > d->height ? d->width : d->height;
  d->fx = f[0] * side;
  d->fy = f[1] * side;
  d->cx = 0.5 * d->width + c[0] * side;
  d->cy = 0.5 * d->height + c[1] * side;
  return VL_OK;
}

static vlResult read_shot(const vlCameraFile *file, const json_t *shot, const json_t *cameras,
                          const char *name, vlCameraRecord *record) {
  double v[3], t[3], r[9];
  const char *camera = vl_camera_text(shot, "camera");
  VL_TRY(VL_READ_FIELDS(file, shot, VL_FIELD_LIST("rotation", v, 3),
                        VL_FIELD_LIST("translation", t, 3)));
  if (!camera || !vl_camera_has(cameras, camera))
    return vl_camera_wrong_in(file, shot, "camera",
                              "opensfm: the shot's camera \"%.60s\" is not there",
                              camera ? camera : "");
  VL_TRY(read_camera(file, json_object_get(cameras, camera), record));
  vl_rotation_from_vector(v, r);
  vl_camera_set_pose(&record->camera, r, t);
  vl_camera_name(record, name);
  return VL_OK;
}

/* Reads camera_models.json, which holds cameras without shots. */
static vlResult read_models(const vlCameraFile *file, const json_t *cameras,
                            vlCameraRecord *record) {
  const char *name;
  const json_t *chosen = NULL;
  json_t *camera;
  record->frames = 0;
  json_object_foreach((json_t *)cameras, name, camera)
      vl_camera_offer(file, camera, name, record, &chosen);
  if (!chosen)
    return vl_camera_none_in(file, cameras, NULL, "camera", record);
  vl_camera_set_origin(&record->camera);
  return read_camera(file, chosen, record);
}

/* Reads the shots of all reconstructions in the file, one reconstruction after the other. */
static vlResult read_opensfm(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  const json_t *list = json_object_get(tree, "[]");
  const json_t *chosen = NULL, *cameras = NULL; /* the shot, and its reconstruction's cameras */
  const char *name, *chosen_name = NULL;
  json_t *shot;
  size_t count = list ? json_array_size(list) : 1;
  if (!list && !vl_camera_has(tree, "shots"))
    return read_models(
        file, vl_camera_has(tree, "cameras") ? json_object_get(tree, "cameras") : tree, record);
  record->frames = 0;
  for (size_t i = 0; i < count; i++) {
    const json_t *one = list ? json_array_get(list, i) : tree;
    json_object_foreach(json_object_get(one, "shots"), name, shot) {
      if (vl_camera_count(file, chosen, name, record)) {
        chosen = shot;
        chosen_name = name;
        cameras = json_object_get(one, "cameras");
      }
    }
  }
  if (!chosen)
    return vl_camera_no_frame(file, "shot", record);
  return read_shot(file, chosen, cameras, chosen_name, record);
}

static bool is_opensfm(const json_t *tree) {
  void *first = json_object_iter((json_t *)tree);
  bool shots = vl_camera_has_in(tree, "[]", "shots") ||
               (vl_camera_has(tree, "shots") && vl_camera_has(tree, "cameras"));
  return shots || (first && vl_camera_has(json_object_iter_value(first), "projection_type"));
}

static vlResult write_opensfm(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  const bool bent = fit->family == VL_LENS_FISHEYE;
  const bool opencv = fit->family == VL_LENS_PINHOLE || fit->family == VL_LENS_OPENCV;
  const bool whole = fit->record->camera.projection == VL_PROJECTION_EQUIRECTANGULAR;
  if (whole && !fit->sphere)
    return vl_fail_at(fit->file->error, VL_ERROR_UNSUPPORTED, fit->file->path, 0, 0,
                      "opensfm holds the equirectangular image of the whole sphere only");
  if (!whole && (!(opencv || bent) || fit->count > 5))
    return vl_camera_no_model(fit->file, &fit->record->camera);
  const char *type = bent ? "fisheye_opencv" : "brown";
  uint32_t coefficients = bent ? 4 : 5;
  if (whole) {
    type = "spherical";
    coefficients = 0;
  }
  const double side = c->width > c->height ? c->width : c->height;
  const double f[4] = {c->fx / side, c->fy / side, (c->cx - 0.5 * c->width) / side,
                       (c->cy - 0.5 * c->height) / side};
  return VL_PUT_FORM(
      text, fit,
      "[\n"
      "  {\n"
      "    \"cameras\": {\n"
      "      \"camera\": {\"projection_type\": \"$type\", \"width\": $width, \"height\": "
      "$height$plane$lens}\n"
      "    },\n"
      "    \"shots\": {\n"
      "      $name: {\"camera\": \"camera\",\n"
      "        \"rotation\": [$V],\n"
      "        \"translation\": [$t]}\n"
      "    },\n"
      "    \"points\": {}\n"
      "  }\n"
      "]\n",
      VL_WORD("type", type),
      VL_PART("plane", !whole,
              ",\n        \"focal_x\": $f@0, \"focal_y\": $f@1, \"c_x\": $f@2, \"c_y\": $f@3"),
      VL_VALUES("f", f, 4),
      VL_NAMED("lens", bent ? fisheye : brown, fit->k, coefficients, ", \"$item\": $value"));
}

const vlCameraFormat vl_format_opensfm = {
    .name = "opensfm",
    .rotates = true,
    .known =
        "/ cameras/ shots/ projection_type width height focal focal_x focal_y c_x c_y k1 k2 "
        "k3 k4 p1 p2 focal_prior k1_prior k2_prior camera rotation translation orientation "
        "capture_time gps_dop gps_position compass! vertices! faces! scale covariance! "
        "merge_cc skey points! rig_cameras! rig_instances! biases! reference_lla! id "
        "accuracy! exposure! bundle_structure_only is_panorama metadata!",
    .is_tree = is_opensfm,
    .read = read_opensfm,
    .holds = VL_HOLDS_POSE,
    .write = write_opensfm};
