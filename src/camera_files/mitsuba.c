/* camera_files/mitsuba.c: a sensor of Mitsuba 3's XML: perspective, thinlens, orthographic
 * (Mitsuba's documentation, "Sensors"). Camera axes x left, y up, z forward; to_world: world
 * from camera; operations in a transform apply in their order. Pixels count from the film's
 * corner. principal_point_offset is added to a film position, in film sides: the axis meets the
 * film at 0.5 minus the offset. Names are accepted in both spellings, to_world and toWorld. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>

#include "base/text.h"
#include "camera_files/fields.h"
#include "math/double3.h"
#include "math/elementary.h"
#include "math/transform.h"

/* ---- reading ----------------------------------------------------------------------------- */

typedef struct {
  const vlCameraFile *file;
  const json_t *root; /* its <default> elements define the $names */
} Scene;

static const char *tag_of(const json_t *element) {
  return json_string_value(json_object_get(element, "<"));
}

static uint32_t line_of(const json_t *element) {
  return (uint32_t)json_number_value(json_object_get(element, "#"));
}

/* Returns whether two names are equal except for case and underscores. */
static bool same(const char *a, const char *b) {
  for (;; a++, b++) {
    while (*a == '_')
      a++;
    while (*b == '_')
      b++;
    if (tolower((unsigned char)*a) != tolower((unsigned char)*b))
      return false;
    if (!*a)
      return true;
  }
}

/* Gets an attribute's text, with $name replaced by its default. The text is null if the
 * attribute is missing. */
static vlResult attribute(const Scene *scene, const json_t *element, const char *key,
                          const char **text) {
  const json_t *item;
  *text = vl_camera_text(element, key);
  if (!*text || **text != '$')
    return VL_OK;
  VL_EACH_CHILD(item, scene->root) {
    const char *name = vl_camera_text(item, "name");
    if (!vl_camera_has_tag(item, "default") || !vl_text_is(name, *text + 1))
      continue;
    *text = vl_camera_text(item, "value");
    if (*text)
      return VL_OK;
    break;
  }
  return vl_camera_wrong_element(scene->file, element, "\"%s\" has no <default>",
                                 vl_short_text(vl_camera_text(element, key)).text);
}

/* `count` numbers, or one that is used for all. *found: whether the attribute exists (null: it
 * is required). */
static vlResult numbers(const Scene *scene, const json_t *element, const char *key,
                        uint32_t count, double *values, bool *found) {
  const char *text;
  VL_TRY(attribute(scene, element, key, &text));
  if (found)
    *found = text != NULL;
  if (!text && found)
    return VL_OK;
  uint32_t n = text ? vl_camera_parse_all(text, values, count) : 0;
  if (n == 1)
    for (; n < count; n++)
      values[n] = values[0];
  if (n == count)
    return VL_OK;
  return vl_camera_wrong_element(
      scene->file, element, "\"%s\" of <%s> must hold %u finite number%s", key,
      vl_short_text(tag_of(element)).text, count, count > 1 ? "s" : "");
}

/* Returns the parameter of a sensor or film with this name, or null. */
static const json_t *parameter(const json_t *parent, const char *name) {
  const json_t *item;
  VL_EACH_CHILD(item, parent) {
    const char *own = vl_camera_text(item, "name");
    if (own && same(own, name))
      return item;
  }
  return NULL;
}

/* Reads a <float> or <integer>; *value is unchanged if there is none. */
static vlResult number(const Scene *scene, const json_t *parent, const char *name,
                       double *value) {
  const json_t *item = parameter(parent, name);
  return item ? numbers(scene, item, "value", 1, value, NULL) : VL_OK;
}

static vlResult word(const Scene *scene, const json_t *parent, const char *name,
                     const char **text) {
  const json_t *item = parameter(parent, name);
  if (!item)
    return VL_OK;
  VL_TRY(attribute(scene, item, "value", text));
  if (!*text)
    return vl_camera_wrong_element(scene->file, item, "\"%s\" has no value", name);
  return VL_OK;
}

/* Reads attributes x, y, z, or one `value` of three numbers (or one for all). */
static vlResult triple(const Scene *scene, const json_t *op, double standard, double v[3]) {
  static const char *const keys[3] = {"x", "y", "z"};
  bool found = false;
  v[0] = v[1] = v[2] = standard;
  VL_TRY(numbers(scene, op, "value", 3, v, &found));
  for (int i = 0; i < 3; i++)
    VL_TRY(numbers(scene, op, keys[i], 1, &v[i], &found));
  return VL_OK;
}

static vlResult look_at(const Scene *scene, const json_t *op, vlMat4 *m) {
  double o[3], t[3], up[3] = {0, 1, 0}, z[3], x[3], y[3];
  bool found;
  VL_TRY(numbers(scene, op, "origin", 3, o, NULL));
  VL_TRY(numbers(scene, op, "target", 3, t, NULL));
  VL_TRY(numbers(scene, op, "up", 3, up, &found));
  vl_sub3(t, o, z);
  double length = vl_normalize3(z);
  vl_cross3(up, z, x); /* left */
  double across = vl_normalize3(x);
  if (!(length > 0.0 && across > 1e-9 * vl_norm3(up)))
    return vl_camera_wrong_element(scene->file, op,
                                   "origin, target and up of <%s> give no direction",
                                   vl_short_text(tag_of(op)).text);
  vl_cross3(z, x, y);
  *m = vl_mat4_axes(x, y, z, o);
  return VL_OK;
}

static vlResult operation(const Scene *scene, const json_t *op, vlMat4 *m) {
  const char *tag = tag_of(op);
  double v[16];
  *m = vl_mat4_identity();
  if (same(tag, "lookat"))
    return look_at(scene, op, m);
  if (vl_text_is(tag, "translate")) {
    VL_TRY(triple(scene, op, 0.0, v));
    *m = vl_mat4_translate(v[0], v[1], v[2]);
  } else if (vl_text_is(tag, "scale")) {
    VL_TRY(triple(scene, op, 1.0, v));
    *m = vl_mat4_scale(v[0], v[1], v[2]);
  } else if (vl_text_is(tag, "rotate")) {
    VL_TRY(triple(scene, op, 0.0, v));
    VL_TRY(numbers(scene, op, "angle", 1, &v[3], NULL));
    if (v[0] == 0.0 && v[1] == 0.0 && v[2] == 0.0)
      return vl_camera_wrong_element(scene->file, op, "<rotate> has no axis");
    *m = vl_mat4_rotate(v[3] * VL_DEGREE, v[0], v[1], v[2]);
  } else if (vl_text_is(tag, "matrix")) {
    VL_TRY(numbers(scene, op, "value", 16, v, NULL));
    *m = vl_mat4_load(v);
  } else {
    return vl_camera_wrong_element(
        scene->file, op,
        "unknown transform <%s>; there are translate, rotate, scale, lookat, matrix",
        vl_short_text(tag).text);
  }
  return VL_OK;
}

static vlResult to_world(const Scene *scene, const json_t *sensor, vlMat4 *matrix) {
  const json_t *transform = parameter(sensor, "to_world"), *op;
  *matrix = vl_mat4_identity();
  VL_EACH_CHILD(op, transform) {
    vlMat4 m;
    VL_TRY(operation(scene, op, &m));
    *matrix = vl_mat4_multiply(m, *matrix);
  }
  return VL_OK;
}

/* Reads width and height of the full film, and the crop that is the image. */
static vlResult read_film(const Scene *scene, const json_t *sensor, double size[2],
                          double crop[4]) {
  static const char *const names[] = {"crop_offset_x", "crop_offset_y", "crop_width",
                                      "crop_height"};
  const json_t *film = NULL, *item;
  size[0] = 768.0;
  size[1] = 576.0; /* Mitsuba's default */
  VL_EACH_CHILD(item, sensor)
    if (vl_camera_has_tag(item, "film"))
      film = item;
  VL_TRY(number(scene, film, "width", &size[0]));
  VL_TRY(number(scene, film, "height", &size[1]));
  crop[0] = crop[1] = 0.0;
  crop[2] = size[0];
  crop[3] = size[1];
  for (int k = 0; k < 4; k++)
    VL_TRY(number(scene, film, names[k], &crop[k]));
  for (int k = 0; k < 2; k++)
    if (!(size[k] >= 1.0 && size[k] <= 1 << 24 && crop[k] >= 0.0 && crop[2 + k] >= 1.0 &&
          crop[k] + crop[2 + k] <= size[k]) ||
        size[k] != floor(size[k]) || crop[k] != floor(crop[k]) ||
        crop[2 + k] != floor(crop[2 + k]))
      return vl_camera_wrong_element(
          scene->file, film ? film : sensor,
          "the film's sides and crop must be whole pixels, sides 1 to 16777216");
  return VL_OK;
}

/* Computes the focal length in pixels. */
static vlResult read_fov(const Scene *scene, const json_t *sensor, const double size[2],
                         double *f) {
  static const char *const names[] = {"x", "y", "diagonal", "smaller", "larger"};
  double fov = VL_UNSET, w = size[0], h = size[1], diagonal = sqrt(w * w + h * h);
  const double sides[5] = {w, h, diagonal, fmin(w, h), fmax(w, h)};
  const char *axis = "x", *focal = NULL;
  VL_TRY(number(scene, sensor, "fov", &fov));
  VL_TRY(word(scene, sensor, "fov_axis", &axis));
  VL_TRY(word(scene, sensor, "focal_length", &focal));
  if (!vl_is_unset(fov) && focal)
    return vl_camera_wrong_element(scene->file, sensor,
                                   "fov and focal_length are given; there is room for one");
  if (vl_is_unset(fov)) { /* 35 mm equivalent, by the film's diagonal */
    char *end = NULL;
    double mm = focal ? vl_camera_parse(focal, &end) : 50.0;
    if (!(mm > 0.0) || isinf(mm) ||
        (focal && (end == focal || (*end && !vl_text_is(end, "mm")))))
      return vl_camera_wrong_element(scene->file, sensor,
                                     "focal_length \"%s\" must be like \"50mm\"",
                                     vl_short_text(focal).text);
    *f = mm * diagonal / sqrt(36.0 * 36.0 + 24.0 * 24.0);
    return VL_OK;
  }
  if (!(fov > 0.0 && fov < 180.0))
    return vl_camera_wrong_element(scene->file, sensor,
                                   "fov is %g degrees; it must lie between 0 and 180", fov);
  const size_t side = vl_name_index(axis, names, 5);
  if (side == 5)
    return vl_camera_wrong_element(
        scene->file, sensor,
        "unknown fov_axis \"%s\"; there are x, y, diagonal, smaller, larger",
        vl_short_text(axis).text);
  *f = 0.5 * sides[side] / vl_precise_tan(0.5 * fov * VL_DEGREE);
  return VL_OK;
}

/* The numbers of a sensor, each optional. */
static vlResult read_numbers(const Scene *scene, const json_t *sensor,
                             const vlCameraField *rows) {
  for (; rows->key; rows++)
    VL_TRY(number(scene, sensor, rows->key, rows->values));
  return VL_OK;
}

/* The image is 2 units wide in camera space, scaled by the matrix, which loses its scale. */
static void set_orthographic(double width, vlMat4 *m, vlCameraDef *d) {
  double length[3];
  for (int k = 0; k < 3; k++) {
    length[k] = sqrt(vl_dot_columns(m->m, k, k));
    for (int i = 0; i < 12; i += 4)
      m->m[i + k] /= length[k];
  }
  d->projection = VL_PROJECTION_ORTHOGRAPHIC;
  d->fx = 0.5 * width / length[0];
  d->fy = 0.5 * width / length[1];
}

/* Counts the parameters of an element whose names are not in the list. */
static vlResult check_parameters(const Scene *scene, const json_t *element, const char *known,
                                 vlCameraRecord *record) {
  const json_t *item;
  VL_EACH_CHILD(item, element) {
    const char *name = vl_camera_text(item, "name"), *value = NULL;
    if (!name)
      continue;
    VL_TRY(attribute(scene, item, "value", &value));
    const vlCameraName given = {name, value ? value : "set", line_of(item)};
    VL_TRY(vl_camera_check_name(scene->file, known, &given, record));
  }
  return VL_OK;
}

/* The parameters of the sensor and of its film that velo does not know: those that Mitsuba
 * has for this type, in both spellings, are read or have no effect on the camera. */
static vlResult check_sensor(const Scene *scene, const json_t *sensor, size_t kind,
                             vlCameraRecord *record) {
  static const char common[] =
      "to_world toWorld near_clip nearClip far_clip farClip focus_distance focusDistance "
      "shutter_open shutterOpen shutter_close shutterClose medium film sampler srf";
  static const char fov[] = "fov fov_axis fovAxis focal_length focalLength";
  static const char *const more[] = {
      "principal_point_offset_x principalPointOffsetX principal_point_offset_y "
      "principalPointOffsetY",
      "aperture_radius apertureRadius", ""};
  static const char film[] =
      "width height crop_offset_x cropOffsetX crop_offset_y cropOffsetY crop_width cropWidth "
      "crop_height cropHeight file_format fileFormat pixel_format pixelFormat "
      "component_format componentFormat sample_border sampleBorder high_quality_edges "
      "highQualityEdges rfilter filter banner gamma attach_log attachLog";
  const json_t *item;
  char known[512];
  snprintf(known, sizeof known, "%s %s %s", common, kind < 2 ? fov : "", more[kind]);
  vlResult result = check_parameters(scene, sensor, known, record);
  VL_EACH_CHILD(item, sensor) {
    if (result == VL_OK && vl_camera_has_tag(item, "film"))
      result = check_parameters(scene, item, film, record);
    if (vl_camera_has_tag(item, "ref") && vl_text_is(vl_camera_text(item, "name"), "film"))
      result = vl_camera_wrong_element(scene->file, item,
                                       "the film is a reference; write it into the sensor");
  }
  return result;
}

static vlResult read_sensor(const Scene *scene, const json_t *sensor, vlCameraRecord *record) {
  static const char *const types[] = {"perspective", "thinlens", "orthographic"};
  vlCameraDef *d = &record->camera;
  const char *type = NULL;
  VL_TRY(attribute(scene, sensor, "type", &type));
  const size_t kind = vl_name_index(type, types, 3);
  if (kind == 3) {
    char known[300];
    vl_tell_names(known, sizeof known, type ? type : "", types, 3);
    return vl_camera_wrong_element(scene->file, sensor, "unknown sensor \"%s\"%s",
                                   vl_short_text(type).text, known);
  }
  double size[2], crop[4], offset[2] = {0, 0}, f = 1.0;
  vlMat4 m;
  VL_TRY(read_film(scene, sensor, size, crop));
  if (kind < 2)
    VL_TRY(read_fov(scene, sensor, size, &f));
  VL_TRY(to_world(scene, sensor, &m));
  const vlCameraField fields[] = {VL_FIELD("near_clip", &d->near_plane),
                                  VL_FIELD("far_clip", &d->far_plane),
                                  VL_FIELD("focus_distance", &d->focus_distance),
                                  VL_FIELD("shutter_open", &d->shutter_open),
                                  VL_FIELD("shutter_close", &d->shutter_close),
                                  {.key = NULL}};
  VL_TRY(read_numbers(scene, sensor, fields));
  if (kind == 0)
    VL_TRY(number(scene, sensor, "principal_point_offset_x", &offset[0]));
  if (kind == 0)
    VL_TRY(number(scene, sensor, "principal_point_offset_y", &offset[1]));
  if (kind == 1)
    VL_TRY(number(scene, sensor, "aperture_radius", &d->lens_radius));
  if (kind == 1 && !parameter(sensor, "aperture_radius"))
    return vl_camera_wrong_element(scene->file, sensor, "a thinlens needs its aperture_radius");
  if (kind == 1 && vl_is_unset(d->focus_distance))
    d->focus_distance = isinf(d->far_plane) ? 1e4 : d->far_plane;
  d->fx = d->fy = f;
  if (kind == 2)
    set_orthographic(size[0], &m, d);
  d->cx = size[0] * (0.5 - offset[0]) - crop[0];
  d->cy = size[1] * (0.5 - offset[1]) - crop[1];
  d->width = (uint32_t)crop[2];
  d->height = (uint32_t)crop[3];
  d->has_matrix = true;
  vl_camera_flip_columns(m.m, -1.0, -1.0, 1.0, d->world_from_camera);
  return check_sensor(scene, sensor, kind, record);
}

static vlResult read_mitsuba(const vlCameraFile *file, const char *text, size_t size,
                             vlCameraRecord *record) {
  static const char *const wanted[] = {"sensor", "default", "include", NULL};
  json_t *tree;
  vlResult result = vl_camera_xml(file, text, size, wanted, &tree);
  if (result != VL_OK)
    return result;
  Scene scene = {file, tree};
  const json_t *item, *chosen = NULL;
  bool root = vl_camera_has_tag(tree, "sensor"), includes = false;
  record->frames = root;
  if (root) {
    chosen = tree;
    vl_camera_name(record, vl_camera_text(tree, "id"));
  }
  VL_EACH_CHILD(item, tree) {
    includes = includes || vl_camera_has_tag(item, "include");
    if (!root && vl_camera_has_tag(item, "sensor"))
      vl_camera_offer(file, item, vl_camera_text(item, "id"), record, &chosen);
  }
  if (chosen) {
    result = read_sensor(&scene, chosen, record);
  } else if (record->frames) {
    result = vl_camera_no_frame(file, "sensor", record);
  } else {
    result = vl_camera_wrong(file, "mitsuba: <%s> holds no <sensor>%s",
                             vl_short_text(tag_of(tree)).text,
                             includes ? "; included files are not followed" : "");
  }
  json_decref(tree);
  return result;
}

/* ---- writing ----------------------------------------------------------------------------- */

static void put_name(vlCameraText *text, const char *name) {
  for (; *name; name++) {
    if (strchr("<>&\"", *name) || (unsigned char)*name < 0x20)
      vl_camera_put(text, "&#%d;", (unsigned char)*name < 0x20 ? '?' : *name);
    else
      vl_camera_put(text, "%c", *name);
  }
}

/* centred: the sensor has no principal point. */
static vlResult refuse(const vlFittedCamera *fit, bool flat, bool lens, bool centred) {
  const vlCamera *c = &fit->camera;
  VL_TRY(vl_camera_refuse(fit->file, "fy", !flat && fabs(c->fy - c->fx) > 1e-12 * c->fx));
  VL_TRY(vl_camera_refuse(fit->file, "cx", centred && c->cx != 0.5 * c->width));
  VL_TRY(vl_camera_refuse(fit->file, "cy", centred && c->cy != 0.5 * c->height));
  VL_TRY(vl_camera_refuse(fit->file, "lens_radius", flat && c->lens_radius > 0.0));
  return vl_camera_refuse(fit->file, "focus_distance", lens && isinf(c->focus_distance));
}

static vlResult write_mitsuba(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCameraDef *d = &fit->record->camera;
  const vlCamera *c = &fit->camera;
  bool flat = d->projection == VL_PROJECTION_ORTHOGRAPHIC, lens = c->lens_radius > 0.0 && !flat;
  bool centred = flat || lens;
  VL_TRY(refuse(fit, flat, lens, centred));
  double m[16];
  vl_camera_flip_columns(c->world_from_camera, -1.0, -1.0, 1.0, m);
  for (int i = 0; i < 12 && flat; i += 4) {
    m[i] *= 0.5 * c->width / c->fx;
    m[i + 1] *= 0.5 * c->width / c->fy;
  }
  const double fov = 2.0 * vl_precise_atan(0.5 * c->width / c->fx) / VL_DEGREE;
  const double offset[2] = {0.5 - c->cx / c->width, 0.5 - c->cy / c->height};
  const bool focused =
      !isinf(c->focus_distance) && !vl_camera_drops(fit->file, "focus_distance");
  const bool timed = c->shutter_open != 0.0 || c->shutter_close != 1.0;
  const struct {
    const char *name;
    double value;
    bool present;
  } numbers[] = {{"fov", fov, !flat},
                 {"principal_point_offset_x", offset[0], !centred && c->cx != 0.5 * c->width},
                 {"principal_point_offset_y", offset[1], !centred && c->cy != 0.5 * c->height},
                 {"aperture_radius", c->lens_radius, lens},
                 {"focus_distance", c->focus_distance, focused},
                 {"near_clip", c->near_plane, c->near_plane > 0.0},
                 {"far_clip", c->far_plane, !isinf(c->far_plane)},
                 {"shutter_open", c->shutter_open, timed},
                 {"shutter_close", c->shutter_close, timed}};
  vl_camera_put(
      text,
      "<!-- pixels count from the film's upper left corner; camera axes x left, y up, z "
      "forward -->\n"
      "<scene version=\"3.0.0\">\n"
      "  <sensor type=\"%s\"",
      flat   ? "orthographic"
      : lens ? "thinlens"
             : "perspective");
  if (fit->record->name[0]) {
    vl_camera_put(text, " id=\"");
    put_name(text, fit->record->name);
    vl_camera_put(text, "\"");
  }
  VL_PUT_FORM(text, fit,
              ">\n"
              "    <transform name=\"to_world\">\n"
              "      <matrix value=\"$matrix:s\"/>\n"
              "    </transform>\n"
              "$axis",
              VL_VALUES("matrix", m, 16),
              VL_PART("axis", !flat, "    <string name=\"fov_axis\" value=\"x\"/>\n"));
  for (size_t i = 0; i < VL_LENGTH(numbers); i++)
    if (numbers[i].present)
      vl_camera_put(text, "    <float name=\"%s\" value=\"%.17g\"/>\n", numbers[i].name,
                    numbers[i].value + 0.0);
  return vl_camera_put_form(text, fit, NULL,
                            "    <film type=\"hdrfilm\">\n"
                            "      <integer name=\"width\" value=\"$width\"/>\n"
                            "      <integer name=\"height\" value=\"$height\"/>\n"
                            "    </film>\n"
                            "  </sensor>\n"
                            "</scene>\n");
}

static bool is_mitsuba(const char *text, VL_UNUSED size_t size) {
  char tag[64];
  return vl_camera_xml_root(text, tag) &&
         (vl_text_is(tag, "scene") || vl_text_is(tag, "sensor"));
}

const vlCameraFormat vl_format_mitsuba = {
    .name = "mitsuba",
    .is_text = is_mitsuba,
    .read_text = read_mitsuba,
    .holds = VL_HOLDS_POSE | VL_HOLDS_LENS | VL_HOLDS_PLANES | VL_HOLDS_TIME,
    .plain = true,
    .write = write_mitsuba};
