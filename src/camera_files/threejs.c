/* camera_files/threejs.c: three.js' JSON of a camera (Object3D.toJSON): object with type
 * PerspectiveCamera (fov: vertical, degrees; aspect; zoom) or OrthographicCamera (left, right,
 * top, bottom), and matrix, world from camera, 16 numbers by columns. Camera axes: x right, y
 * up, z back. There are no pixels. */

#include "base/text.h"
#include "camera_files/fields.h"
#include "math/elementary.h"

static bool is_camera(const json_t *object) {
  const char *type = vl_camera_text(object, "type");
  return type && vl_has_word("PerspectiveCamera OrthographicCamera", type);
}

static vlResult read_lens(const vlCameraFile *file, const json_t *object,
                          vlCameraRecord *record) {
  static const char *const sides[4] = {"left", "right", "top", "bottom"};
  vlCameraDef *d = &record->camera;
  double fov = 0.0, aspect = 1.0, zoom = 1.0, shift = 0.0, s[4];
  bool flat = vl_text_is(vl_camera_text(object, "type"), "OrthographicCamera");
  if (json_is_true(json_object_get(json_object_get(object, "view"), "enabled")))
    return vl_camera_wrong_in(file, object, "view",
                              "threejs: \"view\", a part of the image, is not taken");
  VL_TRY(VL_READ_FIELDS(file, object, VL_FIELD_OPTIONAL("zoom", &zoom),
                        VL_FIELD_OPTIONAL("filmOffset", &shift)));
  if (shift != 0.0)
    return vl_camera_wrong_in(file, object, "filmOffset",
                              "threejs: a \"filmOffset\" other than 0 is not taken");
  VL_TRY(
      flat ? vl_camera_read_named(file, object, sides, 4, false, s)
           : VL_READ_FIELDS(file, object, VL_FIELD("fov", &fov), VL_FIELD("aspect", &aspect)));
  VL_TRY(VL_READ_FIELDS(file, object, VL_FIELD_OPTIONAL("near", &d->near_plane),
                        VL_FIELD_OPTIONAL("far", &d->far_plane)));
  if (flat)
    aspect = (s[1] - s[0]) / (s[2] - s[3]);
  if (!(zoom > 0.0 && aspect > 0.0) || (!flat && !(fov > 0.0 && fov < 180.0)))
    return vl_camera_wrong_in(file, object, flat ? "left" : "fov",
                              "threejs: these sides, fov or zoom give no image");
  VL_TRY(vl_camera_size(file, aspect, record));
  if (flat) {
    d->projection = VL_PROJECTION_ORTHOGRAPHIC;
    d->fx = zoom * d->width / (s[1] - s[0]);
    d->fy = zoom * d->height / (s[2] - s[3]);
    d->cx = 0.5 * d->width - 0.5 * d->fx * (s[0] + s[1]);
    d->cy = 0.5 * d->height + 0.5 * d->fy * (s[2] + s[3]);
  } else {
    d->fy = 0.5 * d->height * zoom / vl_precise_tan(0.5 * VL_DEGREE * fov);
    d->fx = d->fy * d->width / (aspect * d->height);
  }
  return VL_OK;
}

static vlResult read_threejs(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  const json_t *object = json_object_get(tree, "object");
  double c[16], m[16];
  VL_TRY(vl_camera_list(file, object, "matrix", c, 16));
  VL_TRY(read_lens(file, object, record));
  vl_camera_transpose(c, m);
  vl_camera_set_flipped(&record->camera, m);
  vl_camera_name(record, vl_camera_text(object, "name"));
  return VL_OK;
}

static bool is_threejs(const json_t *tree) {
  return vl_camera_has(tree, "metadata") && is_camera(json_object_get(tree, "object"));
}

static vlResult write_threejs(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  const double aspect = c->width / c->fx * c->fy / c->height;
  const double planes[2] = {c->near_plane > 0.0 ? c->near_plane : 0.01,
                            c->far_plane < 1e30 ? c->far_plane : 10000.0};
  return VL_PUT_FORM(
      text, fit,
      "{\n"
      "  \"metadata\": {\"version\": 4.6, \"type\": \"Object\", \"generator\": \"velo\"},\n"
      "  \"object\": {\"type\": \"PerspectiveCamera\", \"fov\": $yfov, \"zoom\": 1, "
      "\"aspect\": $own,\n"
      "    \"near\": $planes@0, \"far\": $planes@1,\n"
      "    \"matrix\": [$flippedcolumns]}\n"
      "}\n",
      VL_VALUES("own", &aspect, 1), VL_VALUES("planes", planes, 2));
}

const vlCameraFormat vl_format_threejs = {
    .name = "threejs",
    .known =
        "metadata! object uuid type name layers up userData! matrix matrixAutoUpdate fov zoom "
        "near far focus aspect filmGauge filmOffset view enabled fullWidth fullHeight offsetX "
        "offsetY left right top bottom children! castShadow receiveShadow frustumCulled "
        "renderOrder visible geometries! materials! textures! images! position! rotation! "
        "quaternion! scale!",
    .is_tree = is_threejs,
    .read = read_threejs,
    .holds = VL_HOLDS_POSE | VL_HOLDS_SCALE | VL_HOLDS_PLANES,
    .lenses = {VL_LENSES_PINHOLE},
    .centred = true,
    .write = write_threejs};
