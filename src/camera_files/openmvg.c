/* camera_files/openmvg.c: OpenMVG's sfm_data.json. Camera axes: x right, y down, z forward;
 * rotation is camera from world, center the camera's centre. The principal point counts from
 * the image's corner. */

#include "base/text.h"
#include "camera_files/fields.h"
#include "velo/projection.h"

/* The number at key, -1 where there is none. The tree's numbers are doubles. */
static double id_of(const json_t *object, const char *key) {
  const json_t *value = json_object_get(object, key);
  return json_is_number(value) ? json_number_value(value) : -1.0;
}

/* The item of a list of {key, value} with this key, or null. */
static const json_t *item_of(const json_t *list, double key) {
  json_t *item;
  VL_EACH(item, list)
    if (key >= 0.0 && id_of(item, "key") == key)
      return item;
  return NULL;
}

/* The object that has the field: that of the pointer or one of the base classes below it
 * ("value0"). */
static const json_t *data_of(const json_t *item, const char *field) {
  const json_t *value = json_object_get(item, "value"),
               *wrapper = json_object_get(value, "ptr_wrapper");
  const json_t *data = wrapper ? json_object_get(wrapper, "data") : value;
  for (int depth = 0; depth < 3 && data && !json_object_get(data, field); depth++)
    data = json_object_get(data, "value0");
  return data;
}

/* The number of an object's class; bit 31 marks the first object of the class. 0: there is
 * none. */
static uint32_t class_number(const json_t *value) {
  const double id = id_of(value, "polymorphic_id");
  return id >= 0.0 && id <= UINT32_MAX ? (uint32_t)id & 0x7fffffff : 0;
}

/* The class of an intrinsic: only the first object of a class has its name, later ones have its
 * number. */
static const char *class_of(const json_t *list, const json_t *item) {
  const uint32_t id = class_number(json_object_get(item, "value"));
  json_t *other;
  VL_EACH(other, list) {
    const json_t *value = json_object_get(other, "value");
    const char *name = vl_camera_text(value, "polymorphic_name");
    if (name && class_number(value) == id)
      return name;
  }
  return NULL;
}

static vlResult read_lens(const vlCameraFile *file, const json_t *item, const char *name,
                          vlCameraDef *d) {
  typedef struct {
    const char *name, *field;
    uint32_t count;
  } Model;
  static const Model models[] = {{"pinhole", NULL, 0},
                                 {"pinhole_radial_k1", "disto_k1", 1},
                                 {"pinhole_radial_k3", "disto_k3", 3},
                                 {"pinhole_brown_t2", "disto_t2", 5},
                                 {"fisheye", "fisheye", 4}};
  const Model *model = VL_CAMERA_ROW(models, name);
  double k[5] = {0};
  if (!model)
    return vl_camera_wrong_in(
        file, item, NULL,
        "openmvg: \"%s\" is no model of velo; there are pinhole, pinhole_radial_k1, "
        "pinhole_radial_k3, pinhole_brown_t2, fisheye, spherical",
        vl_short_text(name).text);
  if (!model->field)
    return VL_OK;
  VL_TRY(vl_camera_list(file, data_of(item, model->field), model->field, k, model->count));
  if (model->count == 4)
    vl_camera_set_fisheye(d, k);
  else
    vl_camera_set_opencv(d, (double[]){k[0], k[1], k[3], k[4], k[2]}, 5); /* k1 k2 k3 t1 t2 */
  return VL_OK;
}

static vlResult read_intrinsic(const vlCameraFile *file, const json_t *list, const json_t *item,
                               vlCameraRecord *record) {
  const char *name = class_of(list, item);
  vlCameraDef *d = &record->camera;
  double f, c[2];
  if (!name)
    return vl_camera_wrong_in(file, item, NULL,
                              "openmvg: an intrinsic without \"polymorphic_name\"");
  VL_TRY(vl_camera_sides(file, data_of(item, "width"), "width", "height", record));
  if (vl_text_is(name, "spherical")) {
    d->projection = VL_PROJECTION_EQUIRECTANGULAR;
    return VL_OK;
  }
  const json_t *data = data_of(item, "focal_length");
  VL_TRY(VL_READ_FIELDS(file, data, VL_FIELD("focal_length", &f),
                        VL_FIELD_LIST("principal_point", c, 2)));
  d->fx = d->fy = f;
  d->cx = c[0];
  d->cy = c[1];
  return read_lens(file, item, name, d);
}

/* A view with a pose is a camera. */
static vlResult read_view(const vlCameraFile *file, const json_t *tree, const json_t *view,
                          const json_t *pose, vlCameraRecord *record) {
  const json_t *intrinsics = json_object_get(tree, "intrinsics");
  const json_t *item = item_of(intrinsics, id_of(view, "id_intrinsic"));
  double r[9], center[3];
  if (!item)
    return vl_camera_wrong_in(file, view, "id_intrinsic",
                              "openmvg: the view's intrinsic is missing");
  VL_TRY(read_intrinsic(file, intrinsics, item, record));
  VL_TRY(VL_READ_FIELDS(file, pose, VL_FIELD_LIST("rotation", r, 9),
                        VL_FIELD_LIST("center", center, 3)));
  vl_camera_set_centre(&record->camera, r, center);
  const char *name = vl_camera_text(view, "filename");
  if (name)
    vl_camera_name(record, name);
  return VL_OK;
}

static vlResult read_openmvg(const vlCameraFile *file, const json_t *tree,
                             vlCameraRecord *record) {
  const json_t *extrinsics = json_object_get(tree, "extrinsics"), *chosen = NULL, *pose = NULL;
  json_t *item;
  record->frames = 0;
  VL_EACH(item, json_object_get(tree, "views")) {
    const json_t *view = data_of(item, "id_pose");
    const json_t *own = item_of(extrinsics, id_of(view, "id_pose"));
    if (!view || !own)
      continue; /* not reconstructed */
    if (vl_camera_count(file, chosen, vl_camera_text(view, "filename"), record)) {
      chosen = view;
      pose = json_object_get(own, "value");
    }
  }
  if (chosen)
    return read_view(file, tree, chosen, pose, record);
  if (record->frames || !json_array_size(json_object_get(tree, "intrinsics")))
    return vl_camera_no_frame(file, "camera", record);
  record->frames = 1; /* before the reconstruction: the first intrinsic, at the origin */
  vl_camera_set_origin(&record->camera);
  return read_intrinsic(file, json_object_get(tree, "intrinsics"),
                        json_array_get(json_object_get(tree, "intrinsics"), 0), record);
}

static vlResult write_openmvg(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  const double brown[5] = {fit->k[0], fit->k[1], fit->k[4], fit->k[2], fit->k[3]};
  double r[9], t[3], centre[3];
  vl_camera_get_pose(c, r, t);
  for (int i = 0; i < 3; i++)
    centre[i] = -(r[i] * t[0] + r[3 + i] * t[1] + r[6 + i] * t[2]);
  const bool fisheye = fit->family == VL_LENS_FISHEYE, bent = fit->family == VL_LENS_OPENCV;
  return VL_PUT_FORM(
      text, fit,
      "{\n"
      "  \"sfm_data_version\": \"0.3\",\n"
      "  \"root_path\": \"\",\n"
      "  \"views\": [{\"key\": 0, \"value\": {"
      "\"polymorphic_id\": 1073741824, \"ptr_wrapper\": {\"id\": 2147483649, \"data\": {"
      "\"local_path\": \"\", \"filename\": $name, \"width\": $width, \"height\": $height, "
      "\"id_view\": 0, \"id_intrinsic\": 0, \"id_pose\": 0}}}}],\n"
      "  \"intrinsics\": [{\"key\": 0, \"value\": {"
      "\"polymorphic_id\": 2147483649, \"polymorphic_name\": \"$model\", \"ptr_wrapper\": {"
      "\"id\": 2147483650, \"data\": {"
      "\"width\": $width, \"height\": $height, \"focal_length\": $fx, \"principal_point\": "
      "[$cx, $cy]$before$k$after}}}}],\n"
      "  \"extrinsics\": [{\"key\": 0, \"value\": {"
      "\"rotation\": [$R:3], \"center\": [$center]}}],\n"
      "  \"structure\": [],\n"
      "  \"control_points\": []\n"
      "}\n",
      VL_WORD("model", fisheye ? "fisheye"
                       : bent  ? "pinhole_brown_t2"
                               : "pinhole"),
      VL_WORD("before", fisheye ? ", \"fisheye\": ["
                        : bent  ? ", \"disto_t2\": ["
                                : ""),
      VL_VALUES("k", fisheye ? fit->k : brown,
                fisheye ? 4
                : bent  ? 5
                        : 0),
      VL_WORD("after", fisheye || bent ? "]" : ""), VL_VALUES("center", centre, 3));
}

const vlCameraFormat vl_format_openmvg = {
    .name = "openmvg",
    .rotates = true,
    .known =
        "sfm_data_version root_path views key value polymorphic_id polymorphic_name "
        "ptr_wrapper id data local_path filename width height id_view id_intrinsic id_pose "
        "intrinsics focal_length principal_point disto_k1 disto_k3 disto_t2 fisheye value0 "
        "extrinsics rotation center structure! control_points! use_pose_center_prior "
        "center_weight! center_prior! use_pose_rotation_prior rotation_weight! rotation!",
    .marks = "sfm_data_version",
    .read = read_openmvg,
    .holds = VL_HOLDS_POSE,
    .lenses = {VL_LENSES_COMMON, 0, 5},
    .square = true,
    .unnamed = "",
    .write = write_openmvg};
