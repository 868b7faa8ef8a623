/* camera_files/velo.c: velo's own JSON: every field of a camera def by its name, exactly. Fields that are not given
 * are not written. Unknown fields are errors. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/text.h"
#include "camera/kinds.h"
#include "camera_files/files.h"

/* By vlProjection; "" for those that the file cannot hold: a lens of many elements. */
#define COUNT_ONE(NAME, name) +1
enum { PROJECTIONS = 0 VL_PROJECTION_KINDS(COUNT_ONE) };
static const char *projection_key(vlProjection kind) {
  const char *key = vl_projection_row(kind)->key;
  return key ? key : "";
}
static const char *const distortions[] = {"none", "opencv", "radial", "thin-prism"};
static const char *const axes[] = {"vertical", "horizontal", "diagonal", "smaller", "larger"};
static const char *const readouts[] = {"down", "up", "right", "left"};
static const char *const stereos[] = {"none", "parallel", "off-axis", "toe-in", "omnidirectional"};
static const char *const eyes[] = {"both", "left", "right"};

/* A field of a def, with its name in the file. count: how many numbers; more than one is a list, in which null is
 * unset. */
typedef struct {
  const char *name;
  size_t offset;
  uint32_t count;
} Field;
#define FIELD(name) \
  { #name, offsetof(vlCameraDef, name), sizeof((vlCameraDef *)0)->name / sizeof(double) }
#define FIELD_AS(name, member) \
  { name, offsetof(vlCameraDef, member), sizeof((vlCameraDef *)0)->member / sizeof(double) }
static const Field numbers[] = {
    FIELD(fov), FIELD(view_distance), FIELD(zoom), FIELD(pixel_size), FIELD(focal_mm), FIELD(sensor_width_mm),
    FIELD(fx), FIELD(fy), FIELD(skew), FIELD(cx), FIELD(cy), FIELD(screen_min_x), FIELD(screen_max_x),
    FIELD(screen_min_y), FIELD(screen_max_y), FIELD(roll), FIELD(lens_radius), FIELD(focus_distance),
    FIELD(shutter_open), FIELD(shutter_close), FIELD(exposure_time), FIELD(near_plane), FIELD(far_plane),
    FIELD(max_angle),
    /* the lens */
    FIELD_AS("f_number", lens.f_number), FIELD_AS("unit_mm", lens.unit_mm), FIELD_AS("focus_point", lens.focus_point),
    FIELD_AS("focus_pixel", lens.focus_pixel), FIELD_AS("aperture_rotation", lens.rotation),
    FIELD_AS("aperture_ratio", lens.ratio), FIELD_AS("tilt_x", lens.tilt_x), FIELD_AS("tilt_y", lens.tilt_y),
    FIELD_AS("lens_tilt_x", lens.lens_tilt_x), FIELD_AS("lens_tilt_y", lens.lens_tilt_y), FIELD_AS("iso", lens.iso),
    FIELD_AS("exposure_seconds", lens.seconds),
    /* time */
    FIELD(readout), FIELD(eye_close), FIELD(lookat_close), FIELD(up_close), FIELD(roll_close), FIELD(pose_times),
    /* stereo */
    FIELD_AS("interocular", stereo.interocular), FIELD_AS("convergence", stereo.convergence)};
static const Field vectors[] = {FIELD(eye), FIELD(lookat), FIELD(up)};
enum { NUMBERS = sizeof numbers / sizeof *numbers, VECTORS = sizeof vectors / sizeof *vectors };

static double *at(vlCameraDef *def, const Field *field) {
  return (double *)((char *)def + field->offset);
}

static vlResult check_names(const vlCameraFile *file, const json_t *tree) {
  static const char *const others[] = {"velo_camera",
                                       "name",
                                       "pixel_origin",
                                       "axes",
                                       "projection",
                                       "width",
                                       "height",
                                       "shape",
                                       "fov_axis",
                                       "distortion",
                                       "world_from_camera",
                                       "world_from_camera_close",
                                       "blades",
                                       "vignetting",
                                       "shutter_curve",
                                       "readout_direction",
                                       "stereo",
                                       "stereo_eye"};
  enum { OTHERS = sizeof others / sizeof *others };
  const char *known[NUMBERS + VECTORS + OTHERS], *key;
  size_t count = 0;
  json_t *unused;
  for (size_t i = 0; i < NUMBERS; i++) known[count++] = numbers[i].name;
  for (size_t i = 0; i < VECTORS; i++) known[count++] = vectors[i].name;
  for (size_t i = 0; i < OTHERS; i++) known[count++] = others[i];
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

/* Index of a field's word in a list; *index is unchanged if the field is missing. */
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
  char known[300];
  vl_tell_names(known, sizeof known, text, names, count);
  return vl_camera_wrong(file, "velo: unknown %s \"%.60s\"%s", key, text, known);
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

/* Reads one number, or a list with null for unset; *values is unchanged if the field is missing. */
static vlResult read_field(const vlCameraFile *file, const json_t *tree, const Field *field, double *values) {
  const json_t *list = json_object_get(tree, field->name);
  if (!list) return VL_OK;
  if (field->count == 1) return vl_camera_number(file, tree, field->name, values);
  if (json_array_size(list) != field->count)
    return vl_camera_wrong(file, "velo: \"%s\" must be a list of %u numbers", field->name, field->count);
  for (uint32_t i = 0; i < field->count; i++) {
    const json_t *item = json_array_get(list, i);
    if (!json_is_number(item) && !json_is_null(item))
      return vl_camera_wrong(file, "velo: \"%s\" holds something that is no number", field->name);
    values[i] = json_is_null(item) ? VL_UNSET : json_number_value(item);
  }
  return VL_OK;
}

static vlResult read_matrix(const vlCameraFile *file, const json_t *tree, const char *key, bool *given, double *m) {
  *given = json_object_get(tree, key) != NULL;
  return *given ? vl_camera_numbers(file, tree, key, m, 16, 16, NULL) : VL_OK;
}

/* Reads blades, vignetting, the shutter's curve, stereo. */
static vlResult read_lens_and_time(const vlCameraFile *file, const json_t *tree, vlCameraDef *d) {
  uint32_t direction = 0, mode = 0, eye = 0, count = 0;
  double blades = 0.0, curve[2 * VL_SHUTTER_POINTS];
  const json_t *vignetting = json_object_get(tree, "vignetting");
  vlResult result = vl_camera_optional(file, tree, "blades", &blades);
  if (result == VL_OK && (!(blades >= 0.0 && blades < 1e6) || blades != floor(blades)))
    result = vl_camera_wrong(file, "velo: \"blades\" is %g; it must be a whole number", blades);
  if (result == VL_OK && vignetting && !json_is_boolean(vignetting))
    result = vl_camera_wrong(file, "velo: \"vignetting\" must be true or false");
  if (result == VL_OK) result = word(file, tree, "readout_direction", readouts, 4, &direction);
  if (result == VL_OK) result = word(file, tree, "stereo", stereos, 5, &mode);
  if (result == VL_OK) result = word(file, tree, "stereo_eye", eyes, 3, &eye);
  if (result == VL_OK && json_object_get(tree, "shutter_curve"))
    result = vl_camera_numbers(file, tree, "shutter_curve", curve, 2, 2 * VL_SHUTTER_POINTS, &count);
  if (result == VL_OK && count % 2)
    result = vl_camera_wrong(file, "velo: \"shutter_curve\" must be a list of pairs, time and value");
  if (result != VL_OK) return result;
  d->lens.blades = (uint32_t)blades;
  d->lens.vignetting = json_is_true(vignetting);
  d->readout_direction = (vlReadout)direction;
  d->stereo.mode = (vlStereoMode)mode;
  d->stereo_eye = (vlEye)eye;
  d->shutter_points = count / 2;
  for (uint32_t i = 0; i < d->shutter_points; i++)
    d->shutter_at[i] = curve[2 * i], d->shutter_value[i] = curve[2 * i + 1];
  return VL_OK;
}

vlResult vl_camera_read_velo(const vlCameraFile *file, const json_t *tree, vlCameraRecord *record) {
  static const char *const origins[] = {"corner", "center"};
  vlCameraDef *d = &record->camera;
  uint32_t projection = 0, axis = VL_FOV_SMALLER, origin = 0, count = 0;
  const char *projections[PROJECTIONS];
  for (int i = 0; i < PROJECTIONS; i++) projections[i] = projection_key((vlProjection)i);
  vlResult result = check_names(file, tree);
  if (result == VL_OK) result = vl_camera_side(file, tree, "width", &d->width);
  if (result == VL_OK) result = vl_camera_side(file, tree, "height", &d->height);
  if (result == VL_OK) result = word(file, tree, "projection", projections, PROJECTIONS, &projection);
  if (result == VL_OK) result = word(file, tree, "fov_axis", axes, 5, &axis);
  if (result == VL_OK) result = word(file, tree, "pixel_origin", origins, 2, &origin);
  for (size_t i = 0; i < NUMBERS && result == VL_OK; i++)
    result = read_field(file, tree, &numbers[i], at(d, &numbers[i]));
  for (size_t i = 0; i < VECTORS && result == VL_OK; i++)
    result = read_field(file, tree, &vectors[i], at(d, &vectors[i]));
  if (result == VL_OK && json_object_get(tree, "shape"))
    result = vl_camera_numbers(file, tree, "shape", d->shape, 1, 2, &count);
  if (result == VL_OK) result = read_matrix(file, tree, "world_from_camera", &d->has_matrix, d->world_from_camera);
  if (result == VL_OK)
    result = read_matrix(file, tree, "world_from_camera_close", &d->has_matrix_close, d->world_from_camera_close);
  if (result == VL_OK) result = read_distortion(file, tree, d);
  if (result == VL_OK) result = read_lens_and_time(file, tree, d);
  d->projection = (vlProjection)projection;
  d->fov_axis = (vlFovAxis)axis;
  if (origin) { /* unset values stay unset */
    d->cx += 0.5, d->cy += 0.5;
    d->lens.focus_pixel[0] += 0.5, d->lens.focus_pixel[1] += 0.5;
  }
  vl_camera_name(record, vl_camera_text(tree, "name"));
  return result;
}

/* Writes a field if it differs from the default. */
static void put_field(vlCameraText *text, const Field *field, const double *values, const double *standard) {
  bool differs = false;
  for (uint32_t i = 0; i < field->count; i++)
    differs = differs || (!vl_is_unset(values[i]) && !isinf(values[i]) && values[i] != standard[i]);
  if (!differs) return;
  vl_camera_put(text, ",\n  \"%s\": %s", field->name, field->count > 1 ? "[" : "");
  for (uint32_t i = 0; i < field->count; i++) {
    if (i) vl_camera_put(text, ", ");
    vl_camera_put(text, vl_is_unset(values[i]) ? "null" : "%.17g", values[i]);
  }
  if (field->count > 1) vl_camera_put(text, "]");
}

static void put_matrix(vlCameraText *text, const char *name, const double m[16]) {
  vl_camera_put(text, ",\n  \"%s\": [", name);
  for (int i = 0; i < 16; i++) {
    vl_camera_put(text, "%s%.17g", i % 4 ? ", " : "\n    [", m[i]);
    if (i % 4 == 3) vl_camera_put(text, i < 15 ? "]," : "]");
  }
  vl_camera_put(text, "\n  ]");
}

static void put_lens_and_time(vlCameraText *text, const vlCameraDef *d) {
  if (d->lens.blades) vl_camera_put(text, ",\n  \"blades\": %u", d->lens.blades);
  if (d->lens.vignetting) vl_camera_put(text, ",\n  \"vignetting\": true");
  if (d->readout_direction) vl_camera_put(text, ",\n  \"readout_direction\": \"%s\"", readouts[d->readout_direction]);
  for (uint32_t i = 0; i < d->shutter_points; i++)
    vl_camera_put(text, "%s[%.17g, %.17g]", i ? ", " : ",\n  \"shutter_curve\": [", d->shutter_at[i],
                  d->shutter_value[i]);
  if (d->shutter_points) vl_camera_put(text, "]");
  if (d->stereo.mode) vl_camera_put(text, ",\n  \"stereo\": \"%s\"", stereos[d->stereo.mode]);
  if (d->stereo_eye) vl_camera_put(text, ",\n  \"stereo_eye\": \"%s\"", eyes[d->stereo_eye]);
}

void vl_camera_put_velo(const vlCameraRecord *record, vlCameraText *text) {
  vlCameraDef d = record->camera, standard = vl_default_camera_def(1, 1);
  vl_camera_put(text, "{\n  \"velo_camera\": 1,\n");
  if (record->name[0]) {
    vl_camera_put(text, "  \"name\": ");
    vl_camera_put_string(text, record->name);
    vl_camera_put(text, ",\n");
  }
  vl_camera_put(text, "  \"pixel_origin\": \"corner\",\n  \"axes\": \"x right, y down, z forward\",\n");
  vl_camera_put(text, "  \"projection\": \"%s\",\n  \"width\": %u,\n  \"height\": %u", projection_key(d.projection),
                d.width, d.height);
  for (size_t i = 0; i < NUMBERS; i++) put_field(text, &numbers[i], at(&d, &numbers[i]), at(&standard, &numbers[i]));
  if (!vl_is_unset(d.fov)) vl_camera_put(text, ",\n  \"fov_axis\": \"%s\"", axes[d.fov_axis]);
  put_lens_and_time(text, &d);
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
  if (d.has_matrix) put_matrix(text, "world_from_camera", d.world_from_camera);
  if (d.has_matrix_close) put_matrix(text, "world_from_camera_close", d.world_from_camera_close);
  vl_camera_put(text, "\n}\n");
}

vlResult vl_camera_write_velo(const vlCameraFile *file, const vlCameraRecord *record, vlCameraText *text) {
  vlCamera camera;
  vlResult result = vl_camera_make(&record->camera, &camera, NULL, file->error);
  if (result == VL_OK) result = vl_camera_refuse(file, "aperture", record->camera.lens.aperture != NULL);
  if (result == VL_OK && record->camera.projection == VL_PROJECTION_OPTICS)
    return vl_fail_at(file->error, VL_ERROR_UNSUPPORTED, file->path, 0, 0, "velo cannot hold a lens of many elements");
  if (result == VL_OK) vl_camera_put_velo(record, text);
  return result;
}
