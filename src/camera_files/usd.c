/* camera_files/usd.c: USD's camera (UsdGeomCamera, UsdGeomXformable) in its text form, .usda.
 * Camera axes x right, y up, z back; matrices act on row vectors, world from camera. Focal
 * length, apertures and their offsets are in tenths of a scene unit. The aperture's offset
 * moves the window, so the principal point moves the other way; y is up. The image's size is
 * the resolution of the file's RenderSettings or RenderProduct. */
#include <math.h>
#include <stdio.h>

#include "base/error.h"
#include "base/text.h"
#include "camera_files/fields.h"
#include "math/elementary.h"
#include "math/transform.h"

/* Transforms: matrices for column vectors; the first operation of an order is the
 * outermost. */

typedef struct {
  const vlCameraFile *file;
  const json_t *prim;
  const char *name; /* of the operation */
} Operation;

static vlResult op_numbers(const Operation *op, const char *key, double *values,
                           uint32_t count) {
  return vl_camera_list(op->file, op->prim, key, values, count);
}

static vlMat4 turn(int axis, double degrees) {
  return vl_mat4_rotate(degrees * VL_DEGREE, axis == 0, axis == 1, axis == 2);
}

/* Applies xformOp:kind[:suffix], optionally after !invert!. */
static vlResult operation(const Operation *op, vlMat4 *m) {
  bool inverted = strncmp(op->name, "!invert!", 8) == 0;
  const char *key = op->name + (inverted ? 8 : 0), *kind = key + 8;
  double v[16], r[9];
  *m = vl_mat4_identity();
  if (strncmp(key, "xformOp:", 8) != 0)
    return vl_camera_wrong(op->file, "usd: \"%s\" in xformOpOrder is no xformOp",
                           vl_short_text(op->name).text);
  size_t n = strcspn(kind, ":");
  if (vl_has_word_of("transform", kind, n)) {
    VL_TRY(op_numbers(op, key, v, 16));
    vl_camera_transpose(v, m->m);
  } else if (vl_has_word_of("translate", kind, n)) {
    VL_TRY(op_numbers(op, key, v, 3));
    *m = vl_mat4_translate(v[0], v[1], v[2]);
  } else if (vl_has_word_of("scale", kind, n)) {
    VL_TRY(op_numbers(op, key, v, 3));
    *m = vl_mat4_scale(v[0], v[1], v[2]);
  } else if (vl_has_word_of("orient", kind, n)) {
    VL_TRY(op_numbers(op, key, v, 4)); /* w x y z */
    if (!vl_rotation_from_quaternion(v, r))
      return vl_camera_wrong(op->file, "usd: \"%s\" is no rotation", vl_short_text(key).text);
    for (int i = 0; i < 9; i++)
      m->m[4 * (i / 3) + i % 3] = r[i];
  } else if (n == 7 && strncmp(kind, "rotate", 6) == 0 && kind[6] >= 'X' && kind[6] <= 'Z') {
    VL_TRY(vl_camera_number(op->file, op->prim, key, v));
    *m = turn(kind[6] - 'X', v[0]);
  } else if (n == 9 && strncmp(kind, "rotate", 6) == 0 && strspn(kind + 6, "XYZ") == 3) {
    VL_TRY(op_numbers(op, key, v, 3)); /* rotateXYZ: about x first, angles in the order x y z */
    for (int i = 0; i < 3; i++)
      *m = vl_mat4_multiply(turn(kind[6 + i] - 'X', v[kind[6 + i] - 'X']), *m);
  } else {
    return vl_camera_wrong(op->file, "usd: unknown xformOp \"%s\"", vl_short_text(key).text);
  }
  if (inverted && !vl_mat4_inverse(*m, m))
    VL_TRY(
        vl_camera_wrong(op->file, "usd: \"%s\" cannot be inverted", vl_short_text(key).text));
  return VL_OK;
}

/* Transform of one prim. *reset: the transforms of its parents do not apply. */
static vlResult local_matrix(const vlCameraFile *file, const json_t *prim, vlMat4 *m,
                             bool *reset) {
  const json_t *order = json_object_get(prim, "xformOpOrder"), *item;
  *reset = false;
  *m = vl_mat4_identity();
  VL_EACH(item, order) {
    const char *name = json_string_value(item);
    if (vl_text_is(name, "!resetXformStack!")) {
      *reset = true;
      *m = vl_mat4_identity();
      continue;
    }
    Operation op = {file, prim, name ? name : ""};
    vlMat4 one;
    VL_TRY(operation(&op, &one));
    *m = vl_mat4_multiply(*m, one);
  }
  return VL_OK;
}

/* ---- reading ----------------------------------------------------------------------------- */

/* Refuses values that change with time. */
static vlResult check_still(const vlCameraFile *file, const json_t *prim) {
  const char *key;
  json_t *unused;
  json_object_foreach((json_t *)prim, key, unused) {
    if (vl_ends_with(key, ".timeSamples"))
      return vl_camera_wrong_element(file, prim,
                                     "\"%s\": values that change with time are not taken",
                                     vl_short_text(key).text);
  }
  return VL_OK;
}

typedef struct {
  const vlCameraFile *file;
  const json_t *camera, *resolution; /* the chosen prim, and the first resolution of the file */
  vlMat4 pose;
  vlCameraRecord *record;
  const json_t *path[64]; /* the prims from the root to the current one */
  int depth;
} Search;

/* Computes the pose of the last prim of the path. Only the chosen camera and its parents must
 * have supported, constant transforms. */
static vlResult pose_of(Search *s) {
  s->pose = vl_mat4_identity();
  for (int i = 0; i < s->depth; i++) {
    vlMat4 own;
    bool reset;
    VL_TRY(check_still(s->file, s->path[i]));
    VL_TRY(local_matrix(s->file, s->path[i], &own, &reset));
    s->pose = reset ? own : vl_mat4_multiply(s->pose, own);
  }
  return VL_OK;
}

static vlResult walk(Search *s, const json_t *prim) {
  const char *type = vl_camera_text(prim, "<");
  const json_t *child;
  if (vl_text_is(type, "Camera")) {
    if (vl_camera_count(s->file, s->camera, vl_camera_text(prim, "@"), s->record)) {
      s->camera = prim;
      VL_TRY(pose_of(s));
    }
  } else if (type && strncmp(type, "Render", 6) == 0 && !s->resolution) {
    s->resolution = json_object_get(prim, "resolution") ? prim : NULL;
  }
  VL_EACH_CHILD(child, prim) {
    if (s->depth == 64)
      break; /* the parser's depth is smaller */
    s->path[s->depth++] = child;
    VL_TRY(walk(s, child));
    s->depth--;
  }
  return VL_OK;
}

/* Fits the aperture to an image of another aspect ratio (UsdRenderSettingsBase,
 * aspectRatioConformPolicy). image: width by height of the image, times the ratio of a pixel's
 * sides. */
static vlResult conform(const Search *s, double image, double *across, double *down) {
  static const char *const policies[] = {"expandAperture", "cropAperture",
                                         "adjustApertureWidth", "adjustApertureHeight",
                                         "adjustPixelAspectRatio"};
  enum { EXPAND, CROP, WIDTH, HEIGHT, PIXELS, POLICIES };
  const char *word = vl_camera_text(s->resolution, "aspectRatioConformPolicy");
  const size_t policy = word ? vl_name_index(word, policies, POLICIES) : EXPAND;
  if (policy == POLICIES) {
    char known[300];
    vl_tell_names(known, sizeof known, word, policies, POLICIES);
    return vl_camera_wrong(s->file, "usd: unknown aspectRatioConformPolicy \"%s\"%s",
                           vl_short_text(word).text, known);
  }
  const double aperture = *across / *down;
  const bool wider = image > aperture;
  if (fabs(image - aperture) <= 1e-5 * aperture || policy == PIXELS)
    return VL_OK;
  if (policy == WIDTH || (policy == EXPAND && wider) || (policy == CROP && !wider))
    *across = *down * image;
  else
    *down = *across / image;
  return VL_OK;
}

/* What render settings say of the image besides its size. */
static vlResult read_settings(const Search *s, double *pixel) {
  double window[4] = {0.0, 0.0, 1.0, 1.0};
  *pixel = 1.0;
  if (!s->resolution)
    return VL_OK;
  VL_TRY(VL_READ_FIELDS(s->file, s->resolution, VL_FIELD_OPTIONAL("pixelAspectRatio", pixel),
                        VL_FIELD_LIST_IF_THERE("dataWindowNDC", window, 4)));
  if (window[0] != 0.0 || window[1] != 0.0 || window[2] != 1.0 || window[3] != 1.0)
    return vl_camera_wrong(s->file, "usd: a crop, \"dataWindowNDC\", is not taken");
  if (!(*pixel > 0.0))
    return vl_camera_wrong(s->file, "usd: \"pixelAspectRatio\" is %g; it must be above zero",
                           *pixel);
  return VL_OK;
}

/* The image's size; aspect: of the aperture, for a file without a resolution. */
static vlResult read_resolution(const Search *s, double aspect, vlCameraRecord *record) {
  double size[2];
  if (!s->resolution)
    return vl_camera_size(s->file, aspect, record);
  VL_TRY(vl_camera_list(s->file, s->resolution, "resolution", size, 2));
  if (vl_camera_set_sides(&record->camera, size))
    return VL_OK;
  return vl_camera_wrong(
      s->file, "usd: a resolution of %g; an image's side is 1 to 16777216 whole pixels",
      size[vl_camera_is_side(size[0])]);
}

/* Attributes of the camera that velo does not know. Those of Omniverse's fisheyes have no
 * effect on a pinhole. */
static vlResult check_attributes(const vlCameraFile *file, const json_t *prim,
                                 vlCameraRecord *record) {
  static const char known[] =
      "@ /! Camera focalLength focusDistance fStop horizontalAperture horizontalApertureOffset "
      "verticalAperture verticalApertureOffset clippingRange projection exposure "
      "shutter:open shutter:close stereoRole cameraProjectionType ftheta* fisheye* xformOp* "
      "visibility purpose kind userProperties:* primvars:* omni:kit:*";
  return vl_camera_check_part(file, known, prim, record);
}

/* flat: the projection is orthographic. */
static vlResult read_projection(const vlCameraFile *file, const json_t *prim, bool *flat) {
  const char *projection = vl_camera_text(prim, "projection");
  const char *lens = vl_camera_text(prim, "cameraProjectionType"); /* of Omniverse */
  if (lens && !vl_text_is(lens, "pinhole"))
    return vl_camera_wrong(file, "usd: \"cameraProjectionType\" \"%s\" is not taken",
                           vl_short_text(lens).text);
  *flat = vl_text_is(projection, "orthographic");
  if (projection && !*flat && !vl_text_is(projection, "perspective"))
    return vl_camera_wrong(
        file, "usd: unknown projection \"%s\"; there are perspective, orthographic",
        vl_short_text(projection).text);
  return VL_OK;
}

static vlResult read_camera(const Search *s, const json_t *root, vlCameraRecord *record) {
  const vlCameraFile *file = s->file;
  const json_t *prim = s->camera;
  vlCameraDef *d = &record->camera;
  double focal = 50.0, across = 20.955, down = 15.2908, offset_x = 0.0, offset_y = 0.0,
         stop = 0.0, focus = 0.0;
  double range[2] = {d->near_plane, d->far_plane}, exposure = 0.0, rate = 24.0;
  VL_TRY(VL_READ_FIELDS(
      file, prim, VL_FIELD_OPTIONAL("focalLength", &focal),
      VL_FIELD_OPTIONAL("horizontalAperture", &across),
      VL_FIELD_OPTIONAL("verticalAperture", &down),
      VL_FIELD_OPTIONAL("horizontalApertureOffset", &offset_x),
      VL_FIELD_OPTIONAL("verticalApertureOffset", &offset_y), VL_FIELD_OPTIONAL("fStop", &stop),
      VL_FIELD_OPTIONAL("focusDistance", &focus), VL_FIELD_OPTIONAL("exposure", &exposure),
      VL_FIELD_OPTIONAL("shutter:open", &d->shutter_open),
      VL_FIELD_OPTIONAL("shutter:close", &d->shutter_close)));
  VL_TRY(vl_camera_optional(file, root, "timeCodesPerSecond", &rate));
  VL_TRY(VL_READ_FIELDS(file, prim, VL_FIELD_LIST_IF_THERE("clippingRange", range, 2)));
  d->near_plane = range[0];
  d->far_plane = range[1] < 1e37 ? range[1] : INFINITY;
  bool flat = false;
  VL_TRY(read_projection(file, prim, &flat));
  if (!(focal > 0.0 && across > 0.0 && down > 0.0 && rate > 0.0))
    return vl_camera_wrong(
        file, "usd: focalLength, horizontalAperture and verticalAperture must be above zero");
  double pixel = 1.0;
  VL_TRY(read_settings(s, &pixel));
  VL_TRY(read_resolution(s, across / down / pixel, record));
  VL_TRY(conform(s, (double)d->width / d->height * pixel, &across, &down));
  double w = d->width, h = d->height;
  /* orthographic apertures are in tenths of a unit too */
  d->fx = flat ? 10.0 * (w / across) : focal * (w / across);
  d->fy = flat ? 10.0 * (h / down) : focal * (h / down);
  d->cx = 0.5 * w - offset_x * (w / across);
  d->cy = 0.5 * h + offset_y * (h / down);
  d->projection = flat ? VL_PROJECTION_ORTHOGRAPHIC : VL_PROJECTION_PERSPECTIVE;
  if (stop > 0.0 && !flat)
    d->lens_radius = 0.1 * focal / (2.0 * stop);
  if (focus > 0.0)
    d->focus_distance = focus;
  if (exposure != 0.0)
    d->exposure_time = vl_precise_exp2(exposure);
  if (json_object_get(prim, "shutter:open"))
    d->shutter_open /= rate;
  if (json_object_get(prim, "shutter:close"))
    d->shutter_close /= rate;
  vl_camera_set_flipped(d, s->pose.m);
  vl_camera_name(record, vl_camera_text(prim, "@"));
  return check_attributes(file, prim, record);
}

static vlResult read_usd(const vlCameraFile *file, const char *text, size_t size,
                         vlCameraRecord *record) {
  json_t *tree;
  VL_TRY(vl_camera_usda(file, text, size, &tree));
  Search search = {.file = file, .pose = vl_mat4_identity(), .record = record};
  record->frames = 0;
  vlResult result = walk(&search, tree);
  if (result == VL_OK && !record->frames)
    result = vl_camera_wrong(
        file, "usd: the file holds no Camera (references and payloads are not followed)");
  else if (result == VL_OK && !search.camera)
    result = vl_camera_no_frame(file, "Camera", record);
  else if (result == VL_OK)
    result = read_camera(&search, tree, record);
  /* an error without a line gets the line of the chosen camera, or 1 */
  if (result == VL_ERROR_SCENE && file->error && file->error->line == 0) {
    const json_t *line = json_object_get(search.camera, "#");
    const json_t *column = json_object_get(search.camera, "|");
    file->error->line = line ? (uint32_t)json_number_value(line) : 1;
    file->error->column = column ? (uint32_t)json_number_value(column) : 1;
  }
  json_decref(tree);
  return result;
}

/* ---- writing ----------------------------------------------------------------------------- */

/* Names in USD consist of letters, digits and _. */
static void set_name(const char *name, char *result, size_t size) {
  const char *before = !*name ? "Camera" : *name >= '0' && *name <= '9' ? "Camera_" : "";
  snprintf(result, size, "%s%s", before, name);
  for (; *result; result++) {
    bool good = (*result >= 'a' && *result <= 'z') || (*result >= 'A' && *result <= 'Z') ||
                (*result >= '0' && *result <= '9');
    if (!good)
      *result = '_';
  }
}

static const char usd_form[] =
    "#usda 1.0\n"
    "(\n"
    "    defaultPrim = \"$own\"\n"
    "    doc = \"pixels count from the image's upper left corner; camera axes x right, y "
    "up, z back; matrices act on row vectors\"\n"
    "    metersPerUnit = 1\n"
    "$rate"
    "    upAxis = \"Y\"\n"
    ")\n"
    "\n"
    "def Camera \"$own\"\n"
    "{\n"
    "    token projection = \"$kind\"\n"
    "    float focalLength = $film@0\n"
    "    float horizontalAperture = $film@1\n"
    "    float verticalAperture = $film@2\n"
    "    float horizontalApertureOffset = $film@3\n"
    "    float verticalApertureOffset = $film@4\n"
    "$range$stop$focus$exposure$shutter"
    "    matrix4d xformOp:transform = ( $flippedcolumns:p )\n"
    "    uniform token[] xformOpOrder = [\"xformOp:transform\"]\n"
    "}\n"
    "\n"
    "def Scope \"Render\"\n"
    "{\n"
    "    def RenderSettings \"Settings\"\n"
    "    {\n"
    "        rel camera = </$own>\n"
    "        uniform int2 resolution = ($width, $height)\n"
    "        uniform float pixelAspectRatio = $pixel\n"
    "    }\n"
    "}\n";

static vlResult write_usd(const vlFittedCamera *fit, vlCameraText *text) {
  const vlCameraDef *d = &fit->record->camera;
  const vlCamera *c = &fit->camera;
  bool flat = d->projection == VL_PROJECTION_ORTHOGRAPHIC;
  VL_TRY(vl_camera_refuse(fit->file, "lens_radius", flat && c->lens_radius > 0.0));
  double w = c->width, h = c->height;
  /* the scene unit is a metre: 36 mm are 0.36 tenths of it */
  double across = 0.01 * (d->sensor_width_mm > 0.0 ? d->sensor_width_mm : 36.0),
         focal = c->fx * (across / w);
  if (flat) {
    across = 10.0 * w / c->fx;
    focal = 0.5;
  }
  double down = flat ? 10.0 * h / c->fy : across * (h / w) * (c->fx / c->fy);
  bool timed = c->shutter_open != 0.0 || c->shutter_close != 1.0;
  const double planes[2] = {c->near_plane, isinf(c->far_plane) ? 1e38 : c->far_plane};
  const double lens[3] = {0.1 * focal / (2.0 * c->lens_radius), c->focus_distance,
                          vl_precise_log2(c->exposure_time)};
  const double shutter[2] = {c->shutter_open, c->shutter_close};
  const double film[] = {focal, across, down, (0.5 * w - c->cx) * (across / w),
                         (c->cy - 0.5 * h) * (down / h)};
  const double pixel = c->fy / c->fx;
  char name[sizeof fit->record->name + 8];
  set_name(fit->record->name, name, sizeof name);
  return VL_PUT_FORM(
      text, fit, usd_form, VL_WORD("own", name),
      VL_WORD("kind", flat ? "orthographic" : "perspective"), VL_VALUES("film", film, 5),
      VL_VALUES("pixel", &pixel, 1), VL_VALUES("planes", planes, 2), VL_VALUES("lens", lens, 3),
      VL_VALUES("open", shutter, 2), VL_PART("rate", timed, "    timeCodesPerSecond = 1\n"),
      VL_PART("range", c->near_plane > 0.0 || !isinf(c->far_plane),
              "    float2 clippingRange = ($planes)\n"),
      VL_PART("stop", c->lens_radius > 0.0 && !flat, "    float fStop = $lens@0\n"),
      VL_PART("focus", !isinf(c->focus_distance), "    float focusDistance = $lens@1\n"),
      VL_PART("exposure", c->exposure_time != 1.0, "    float exposure = $lens@2\n"),
      VL_PART("shutter", timed,
              "    double shutter:open = $open@0\n    double shutter:close = $open@1\n"));
}

static bool is_usd(const char *text, size_t size) {
  return size >= 5 && memcmp(text, "#usda", 5) == 0;
}

const vlCameraFormat vl_format_usd = {.name = "usd",
                                      .is_text = is_usd,
                                      .read_text = read_usd,
                                      .holds = VL_HOLDS_POSE | VL_HOLDS_SCALE | VL_HOLDS_LENS |
                                               VL_HOLDS_PLANES | VL_HOLDS_TIME |
                                               VL_HOLDS_EXPOSURE,
                                      .plain = true,
                                      .write = write_usd};
