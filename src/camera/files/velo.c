/* camera/files/velo.c: velo's own JSON: every field of a camera def by its name, exactly; what is not given is not
 * written. Unknown fields are errors. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/text.h"
#include "camera/files/files.h"

static const char *const projections[] = {
    "perspective",     "orthographic", "equidistant", "equisolid",    "stereographic", "sine",
    "equirectangular", "equal-area",   "cylindrical", "cube",         "panini",        "fov",
    "division",        "unified",      "eucm",        "double-sphere"};
static const char *const distortions[] = {"none", "opencv", "radial", "thin-prism"};
static const char *const axes[] = {"vertical", "horizontal", "diagonal", "smaller", "larger"};

typedef struct {
  const char *name;
  size_t offset;
} Field;
#define FIELD(name) \
  { #name, offsetof(vlCameraDef, name) }
static const Field numbers[] = {FIELD(fov),
                                FIELD(view_distance),
                                FIELD(zoom),
                                FIELD(pixel_size),
                                FIELD(focal_mm),
                                FIELD(sensor_width_mm),
                                FIELD(fx),
                                FIELD(fy),
                                FIELD(skew),
                                FIELD(cx),
                                FIELD(cy),
                                FIELD(screen_min_x),
                                FIELD(screen_max_x),
                                FIELD(screen_min_y),
                                FIELD(screen_max_y),
                                FIELD(roll),
                                FIELD(lens_radius),
                                FIELD(focus_distance),
                                FIELD(shutter_open),
                                FIELD(shutter_close),
                                FIELD(exposure_time),
                                FIELD(near_plane),
                                FIELD(far_plane),
                                FIELD(max_angle)};
static const Field vectors[] = {FIELD(eye), FIELD(lookat), FIELD(up)};
enum { NUMBERS = sizeof numbers / sizeof *numbers, VECTORS = sizeof vectors / sizeof *vectors };

static double *at(vlCameraDef *def, const Field *field) {
  return (double *)((char *)def + field->offset);
}

static vlResult check_names(const vlCameraFile *file, const json_t *tree) {
  static const char *const others[] = {"velo_camera", "name",       "pixel_origin",     "axes",
                                       "projection",  "width",      "height",           "shape",
                                       "fov_axis",    "distortion", "world_from_camera"};
  const char *known[NUMBERS + VECTORS + 16], *key;
  size_t count = 0;
  json_t *unused;
  for (size_t i = 0; i < NUMBERS; i++) known[count++] = numbers[i].name;
  for (size_t i = 0; i < VECTORS; i++) known[count++] = vectors[i].name;
  for (size_t i = 0; i < sizeof others / sizeof *others; i++) known[count++] = others[i];
  json_object_foreach((json_t *)tree, key, unused) {
    bool found = false;
    for (size_t i = 0; i < count; i++) found |= strcmp(key, known[i]) == 0;
    if (found) continue;
    const char *near = vl_nearest_name(key, known, count);
    return vl_camera_wrong(file, "velo: unknown field \"%.60s\"%s%s%s", key, near ? "; did you mean \"" : "",
                           near ? near : "", near ? "\"?" : "");
  }
  return VL_OK;
}

/* The place of a word in a list; *index stays when the field is not there. */
static vlResult word(const vlCameraFile *file, const json_t *object, const char *key, const char *const *names,
                     uint32_t count, uint32_t *index) {
  if (!json_object_get(object, key)) return VL_OK;
  const char *text = vl_camera_text(object, key);
  if (!text) return vl_camera_wrong(file, "velo: \"%s\" must be a word", key);
  for (uint32_t i = 0; i < count; i++)
    if (strcmp(text, names[i]) == 0) {
      *index = i;
      return VL_OK;
    }
  const char *near = vl_nearest_name(text, names, count);
  return vl_camera_wrong(file, "velo: unknown %s \"%.60s\"; the nearest is \"%s\"", key, text, near ? near : names[0]);
}

static vlResult read_distortion(const vlCameraFile *file, const json_t *tree, vlCameraDef *d) {
  const json_t *lens = json_object_get(tree, "distortion");
  uint32_t kind = 0;
  if (!lens) return VL_OK;
  if (!json_is_object(lens)) return vl_camera_wrong(file, "velo: \"distortion\" must have a model and coefficients");
  vlResult result = word(file, lens, "model", distortions, 4, &kind);
  d->distortion = (vlDistortion)kind;
  if (result == VL_OK && kind)
    result = vl_camera_numbers(file, lens, "coefficients", d->distortion_coefficients, 1, 14, &d->distortion_count);
  return result;
}

vlResult vl_camera_read_velo(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  static const char *const origins[] = {"corner", "center"};
  vlCameraDef *d = &record->camera;
  uint32_t projection = 0, axis = VL_FOV_SMALLER, origin = 0, count = 0;
  vlResult result = check_names(file, tree);
  if (result == VL_OK) result = vl_camera_side(file, tree, "width", &d->width);
  if (result == VL_OK) result = vl_camera_side(file, tree, "height", &d->height);
  if (result == VL_OK) result = word(file, tree, "projection", projections, 16, &projection);
  if (result == VL_OK) result = word(file, tree, "fov_axis", axes, 5, &axis);
  if (result == VL_OK) result = word(file, tree, "pixel_origin", origins, 2, &origin);
  for (size_t i = 0; i < NUMBERS && result == VL_OK; i++)
    result = vl_camera_optional(file, tree, numbers[i].name, at(d, &numbers[i]));
  for (size_t i = 0; i < VECTORS && result == VL_OK; i++)
    if (json_object_get(tree, vectors[i].name))
      result = vl_camera_numbers(file, tree, vectors[i].name, at(d, &vectors[i]), 3, 3, NULL);
  if (result == VL_OK && json_object_get(tree, "shape"))
    result = vl_camera_numbers(file, tree, "shape", d->shape, 1, 2, &count);
  if (result == VL_OK && json_object_get(tree, "world_from_camera")) {
    d->has_matrix = true;
    result = vl_camera_numbers(file, tree, "world_from_camera", d->world_from_camera, 16, 16, NULL);
  }
  if (result == VL_OK) result = read_distortion(file, tree, d);
  d->projection = (vlProjection)projection;
  d->fov_axis = (vlFovAxis)axis;
  if (origin) d->cx += 0.5, d->cy += 0.5; /* unset stays unset */
  vl_camera_name(record, vl_camera_text(tree, "name"));
  return result;
}

vlResult vl_camera_write_velo(const vlCameraFile *file, const vlCameraRecord *record, vlCameraText *text) {
  vlCameraDef d = record->camera, standard = vl_default_camera_def(1, 1);
  vlCamera camera;
  vlResult result = vl_camera_make(&d, &camera, NULL, file->error);
  if (result != VL_OK) return result;
  vl_camera_put(text, "{\n  \"velo_camera\": 1,\n");
  if (record->name[0]) {
    vl_camera_put(text, "  \"name\": ");
    vl_camera_put_string(text, record->name);
    vl_camera_put(text, ",\n");
  }
  vl_camera_put(text, "  \"pixel_origin\": \"corner\",\n  \"axes\": \"x right, y down, z forward\",\n");
  vl_camera_put(text, "  \"projection\": \"%s\",\n  \"width\": %u,\n  \"height\": %u", projections[d.projection],
                d.width, d.height);
  for (size_t i = 0; i < NUMBERS; i++) {
    double value = *at(&d, &numbers[i]);
    if (isfinite(value) && value != *at(&standard, &numbers[i]))
      vl_camera_put(text, ",\n  \"%s\": %.17g", numbers[i].name, value);
  }
  if (!vl_is_unset(d.fov)) vl_camera_put(text, ",\n  \"fov_axis\": \"%s\"", axes[d.fov_axis]);
  int shapes = vl_is_unset(d.shape[0]) ? 0 : vl_is_unset(d.shape[1]) ? 1 : 2;
  if (shapes) {
    vl_camera_put(text, ",\n  \"shape\": [");
    for (int i = 0; i < shapes; i++) vl_camera_put(text, "%s%.17g", i ? ", " : "", d.shape[i]);
    vl_camera_put(text, "]");
  }
  if (d.distortion != VL_DISTORTION_NONE) {
    vl_camera_put(text, ",\n  \"distortion\": {\"model\": \"%s\", \"coefficients\": [", distortions[d.distortion]);
    for (uint32_t i = 0; i < d.distortion_count; i++)
      vl_camera_put(text, "%s%.17g", i ? ", " : "", d.distortion_coefficients[i]);
    vl_camera_put(text, "]}");
  }
  for (size_t i = 0; i < VECTORS && !d.has_matrix; i++) {
    const double *v = at(&d, &vectors[i]);
    vl_camera_put(text, ",\n  \"%s\": [%.17g, %.17g, %.17g]", vectors[i].name, v[0], v[1], v[2]);
  }
  if (d.has_matrix) {
    vl_camera_put(text, ",\n  \"world_from_camera\": [");
    for (int i = 0; i < 16; i++)
      vl_camera_put(text, "%s%.17g%s", i % 4 ? ", " : "\n    [", d.world_from_camera[i],
                    i % 4 < 3 ? ""
                    : i < 15  ? "],"
                              : "]");
    vl_camera_put(text, "\n  ]");
  }
  vl_camera_put(text, "\n}\n");
  return VL_OK;
}
