/* camera_files/meshroom.c: AliceVision's .sfm (Meshroom), JSON: views, intrinsics, poses;
 * numbers are written as text. x right, y down, z forward; a pose is center and rotation,
 * camera from world, written column by column. The principal point counts from the image's
 * middle (before version 1.2.1: from its corner); the focal length is in millimetres of a
 * sensor (before 1.2.2: in pixels). */
#include <math.h>
#include <stdlib.h>

#include "base/text.h"
#include "camera_files/fields.h"

/* Converts a JSON number, or a text that contains a number. */
static bool number_of(const json_t *value, double *number) {
  const char *text = json_string_value(value);
  char *end;
  *number = text ? strtod(text, &end) : json_number_value(value);
  return (text ? end != text && *end == 0 : json_is_number(value)) && isfinite(*number);
}

static vlResult numbers(const vlCameraFile *file, const json_t *object, const char *key,
                        double *values, uint32_t count) {
  const json_t *field;
  VL_TRY(vl_camera_field(file, object, key, &field));
  bool one = count == 1 && !json_is_array(field);
  bool good = one || json_array_size(field) == count;
  for (uint32_t i = 0; i < count && good; i++)
    good = number_of(one ? field : json_array_get(field, i), &values[i]);
  if (good)
    return VL_OK;
  return vl_camera_wrong_in(file, object, key, "meshroom: \"%s\" must hold %u finite number%s",
                            key, count, count == 1 ? "" : "s");
}

/* Whether the version is before 1.2.revision. */
static bool is_before(const double version[3], double revision) {
  if (version[0] != 1.0)
    return version[0] < 1.0;
  return version[1] != 2.0 ? version[1] < 2.0 : version[2] < revision;
}

static vlResult read_focal(const vlCameraFile *file, const json_t *intrinsic,
                           const double version[3], vlCameraDef *d) {
  double f[2], mm, sensor, ratio = 1.0;
  if (vl_camera_has(intrinsic, "pxFocalLength")) {
    bool pair = json_is_array(json_object_get(intrinsic, "pxFocalLength"));
    VL_TRY(numbers(file, intrinsic, "pxFocalLength", f, pair ? 2 : 1));
    d->fx = f[0];
    d->fy = pair ? f[1] : f[0];
    return VL_OK;
  }
  VL_TRY(numbers(file, intrinsic, "focalLength", &mm, 1));
  VL_TRY(numbers(file, intrinsic, "sensorWidth", &sensor, 1));
  if (vl_camera_has(intrinsic, "pixelRatio"))
    VL_TRY(numbers(file, intrinsic, "pixelRatio", &ratio, 1));
  if (!(sensor > 0.0 && ratio > 0.0))
    return vl_camera_wrong_in(file, intrinsic, "sensorWidth",
                              "meshroom: the sensor's sides must be above zero");
  /* before 1.2.5 pixelRatio is fx / fy, then the pixel's width / height */
  d->fx = mm / sensor * d->width;
  d->fy = is_before(version, 5) ? d->fx / ratio : d->fx * ratio;
  return VL_OK;
}

/* A distortion of AliceVision: its names, and what it is here. */
typedef struct {
  const char *names[2];
  vlLensFamily family;
  uint32_t count;  /* of coefficients */
  bool tangential; /* the coefficients are k1 k2 k3 p1 p2; else radial, k1 to k3 */
  bool normalised; /* the polynomial is divided by its value at radius 1 */
} Model;

static const Model *find_model(const char *name) {
  static const Model models[] = {
      {.names = {"none", "pinhole"}, .family = VL_LENS_PINHOLE},
      {.names = {"radialk1", "radial1"}, .family = VL_LENS_OPENCV, .count = 1},
      {.names = {"radialk3", "radial3"}, .family = VL_LENS_OPENCV, .count = 3},
      {.names = {"radialk3pt", "radial3pt"},
       .family = VL_LENS_OPENCV,
       .count = 3,
       .normalised = true},
      {.names = {"brown", "brownt2"}, .family = VL_LENS_OPENCV, .count = 5, .tangential = true},
      {.names = {"fisheye4", "fisheye"}, .family = VL_LENS_FISHEYE, .count = 4},
      {.names = {"fisheye1"}, .family = VL_LENS_FOV, .count = 1}};
  for (size_t i = 0; i < VL_LENGTH(models); i++)
    for (int j = 0; j < 2 && models[i].names[j]; j++)
      if (vl_text_is(name, models[i].names[j]))
        return &models[i];
  return NULL;
}

/* Coefficients that are missing are 0. */
static void set_lens(vlCameraDef *d, const Model *model, const double k[5], bool given) {
  const double radial[5] = {k[0], k[1], 0.0, 0.0, k[2]};
  const double tangential[5] = {k[0], k[1], k[3], k[4], k[2]};
  if (model->family == VL_LENS_FISHEYE)
    vl_camera_set_fisheye(d, k);
  else if (model->family == VL_LENS_FOV && k[0] != 0.0)
    vl_camera_set_lens(d, VL_LENS_FOV, k, 1);
  else if (model->family == VL_LENS_OPENCV && given)
    vl_camera_set_opencv(d, model->tangential ? tangential : radial, 5);
  if (given && model->normalised) {
    d->fx /= 1.0 + k[0] + k[1] + k[2];
    d->fy /= 1.0 + k[0] + k[1] + k[2];
  }
}

/* The distortion, by its name: of version 1.2.8 and later in distortionType, before as the
 * camera's type. */
static vlResult read_lens(const vlCameraFile *file, const json_t *intrinsic, vlCameraDef *d) {
  const char *key = vl_camera_text(intrinsic, "distortionType") ? "distortionType" : "type";
  const char *base = vl_camera_text(intrinsic, "type"), *name = vl_camera_text(intrinsic, key);
  const json_t *list = json_object_get(intrinsic, "distortionParams");
  const Model *model = find_model(name);
  double k[5] = {0.0};
  if (base && (strstr(base, "equidistant") || strstr(base, "equirectangular")))
    return vl_camera_wrong_in(file, intrinsic, "type",
                              "meshroom: type \"%s\" is no model of velo",
                              vl_short_text(base).text);
  if (!model)
    return vl_camera_unknown(
        file, intrinsic, key, name,
        "there are none, radialk1, radialk3, radialk3pt, brown, fisheye1, fisheye4");
  const bool given = json_array_size(list) > 0 && model->count > 0;
  if (given)
    VL_TRY(numbers(file, intrinsic, "distortionParams", k, model->count));
  set_lens(d, model, k, given);
  return VL_OK;
}

static vlResult read_intrinsic(const vlCameraFile *file, const json_t *tree,
                               const json_t *intrinsic, vlCameraRecord *record) {
  vlCameraDef *d = &record->camera;
  double version[3] = {1.0, 0.0, 0.0}, size[2] = {0.0, 0.0}, c[2] = {0.0, 0.0};
  if (vl_camera_has(tree, "version"))
    VL_TRY(numbers(file, tree, "version", version, 3));
  VL_TRY(numbers(file, intrinsic, "width", &size[0], 1));
  VL_TRY(numbers(file, intrinsic, "height", &size[1], 1));
  VL_TRY(numbers(file, intrinsic, "principalPoint", c, 2));
  if (!vl_camera_set_sides(d, size))
    return vl_camera_wrong_in(file, intrinsic, vl_camera_is_side(size[0]) ? "height" : "width",
                              "meshroom: the image is %g x %g; it must be whole pixels",
                              size[0], size[1]);
  double middle = is_before(version, 1) ? 0.0 : 0.5;
  d->cx = c[0] + middle * d->width;
  d->cy = c[1] + middle * d->height;
  VL_TRY(read_focal(file, intrinsic, version, d));
  return read_lens(file, intrinsic, d);
}

/* Returns the item of a list with this id. Ids are text or numbers. */
static const json_t *with_id(const json_t *list, const char *key, const json_t *id) {
  const json_t *item;
  VL_EACH(item, list) {
    if (id && json_equal(json_object_get(item, key), id))
      return item;
  }
  return NULL;
}

static vlResult read_view(const vlCameraFile *file, const json_t *tree, const json_t *view,
                          vlCameraRecord *record) {
  const json_t *intrinsic = with_id(json_object_get(tree, "intrinsics"), "intrinsicId",
                                    json_object_get(view, "intrinsicId"));
  const json_t *pose =
      with_id(json_object_get(tree, "poses"), "poseId", json_object_get(view, "poseId"));
  const json_t *transform;
  double r[9] = {0.0}, center[3] = {0.0};
  if (!intrinsic)
    return vl_camera_wrong_in(
        file, view, "intrinsicId",
        "meshroom: the view's \"intrinsicId\" is not among the intrinsics");
  VL_TRY(read_intrinsic(file, tree, intrinsic, record));
  vl_camera_set_origin(&record->camera);
  vl_camera_name(record, vl_camera_text(view, "path"));
  if (!pose)
    return VL_OK;
  VL_TRY(vl_camera_field(file, json_object_get(pose, "pose"), "transform", &transform));
  VL_TRY(numbers(file, transform, "rotation", r, 9));
  VL_TRY(numbers(file, transform, "center", center, 3));
  /* the column-major matrix camera from world equals the row-major matrix world from camera */
  vl_camera_set_rigid(&record->camera, r, center);
  return VL_OK;
}

/* Reads the views that have a pose, or all views if none has one. */
static vlResult read_meshroom(const vlCameraFile *file, const json_t *tree,
                              vlCameraRecord *record) {
  const json_t *poses = json_object_get(tree, "poses"), *view, *chosen = NULL;
  bool posed = json_array_size(poses) > 0;
  record->frames = 0;
  VL_EACH(view, json_object_get(tree, "views")) {
    const char *path = vl_camera_text(view, "path"), *slash = path ? strrchr(path, '/') : NULL;
    if (posed && !with_id(poses, "poseId", json_object_get(view, "poseId")))
      continue;
    bool wanted = vl_camera_is_frame(file, record->frames, path) ||
                  (slash && !file->ordinal && file->def->frame &&
                   vl_text_is(slash + 1, file->def->frame));
    if (!chosen && wanted)
      chosen = view;
    record->frames++;
  }
  if (chosen)
    return read_view(file, tree, chosen, record);
  return vl_camera_none_in(file, tree, "views", "view", record);
}

static bool is_meshroom(const json_t *tree) {
  return vl_camera_has(tree, "views") && vl_camera_has(tree, "intrinsics") &&
         !vl_camera_has(tree, "sfm_data_version");
}

static vlResult write_meshroom(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCamera *c = &fit->camera;
  static const char *const lens_words[] = {"none", "brown", "fisheye4", "fisheye1"};
  const double brown[5] = {fit->k[0], fit->k[1], fit->k[4], fit->k[2], fit->k[3]};
  vlCameraValue lens = VL_VALUES("own", fit->k, fit->count);
  if (fit->family == VL_LENS_FOV)
    lens = (vlCameraValue)VL_VALUES("own", c->shape, 1);
  else if (fit->family == VL_LENS_OPENCV)
    lens = (vlCameraValue)VL_VALUES("own", brown, 5);
  const double given = fit->record->camera.sensor_width_mm;
  const double width = given > 0.0 ? given : 36.0; /* mm; 36: a full-frame sensor */
  const double height = width * (c->fx / c->fy) * c->height / c->width;
  const double sensor[] = {width, height, c->fx * width / c->width};
  const double middle[2] = {c->cx - 0.5 * c->width, c->cy - 0.5 * c->height};
  return VL_PUT_FORM(
      text, fit,
      "{\n"
      "  \"version\": [\"1\", \"2\", \"8\"],\n"
      "  \"views\": [\n"
      "    {\"viewId\": \"1\", \"poseId\": \"1\", \"frameId\": \"0\", \"intrinsicId\": "
      "\"1\",\n"
      "     \"path\": $name, \"width\": $width:q, \"height\": $height:q}\n"
      "  ],\n"
      "  \"intrinsics\": [\n"
      "    {\"intrinsicId\": \"1\", \"width\": $width:q, \"height\": $height:q,\n"
      "     \"sensorWidth\": $sensor@0:q, \"sensorHeight\": $sensor@1:q, \"serialNumber\": "
      "\"\",\n"
      "     \"type\": \"pinhole\", \"initializationMode\": \"calibrated\", \"focalLength\": "
      "$sensor@2:q,\n"
      "     \"pixelRatio\": $aspect:q, \"principalPoint\": [$middle:q],\n"
      "     \"distortionType\": \"$lens\", \"distortionParams\": [$own:q], \"locked\": "
      "\"false\"}\n"
      "  ],\n"
      "  \"poses\": [\n"
      "    {\"poseId\": \"1\", \"pose\": {\"transform\": {\n"
      "      \"rotation\": [$axes:q],\n"
      "      \"center\": [$centre:q]}, \"locked\": \"0\"}}\n"
      "  ]\n"
      "}\n",
      VL_VALUES("sensor", sensor, 3), VL_VALUES("middle", middle, 2),
      VL_WORD("lens", lens_words[fit->family]), lens);
}

const vlCameraFormat vl_format_meshroom = {
    .name = "meshroom",
    .rotates = true,
    .known =
        "version featuresFolders! matchesFolders! views viewId poseId frameId intrinsicId "
        "resectionId path width height metadata! intrinsics initialFocalLength focalLength "
        "pxFocalLength pxInitialFocalLength sensorWidth sensorHeight serialNumber type "
        "initializationMode pixelRatio pixelRatioLocked principalPoint offsetLocked "
        "scaleLocked distortionLocked locked distortionType distortionParams "
        "distortionInitializationMode undistortionType! fisheyeCircle* poses pose transform "
        "rotation center structure! ancestors! landmarks! constraints* preTransform! "
        "providerId providers!",
    .geometry = "rigId subPoseId undistortionParams undistortionOffset rigs",
    .is_tree = is_meshroom,
    .read = read_meshroom,
    .holds = VL_HOLDS_POSE,
    .lenses = {VL_LENSES_COMMON | 1 << VL_LENS_FOV, 0, 5},
    .write = write_meshroom};
