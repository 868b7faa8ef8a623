/* api/header.c: the header attributes of a rendered image (velo/header.h). Names and meanings
 * are those of OpenEXR's standard attributes (openexr.com, "Standard Attributes") where one
 * exists; other names begin with "velo.". */
#include "velo/header.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/cookie.h"
#include "base/error.h"
#include "base/machine.h"
#include "image/image.h"
#include "math/transform.h"
#include "projection/projection.row.h"
#include "velo/distortion.h"
#include "velo/setting.h"

typedef struct Header {
  vlImage *image;
  vlResult result;  /* of the first failure */
  const char *view; /* prefix of each name; null: none */
} Header;

static void set(Header *header, const char *name, vlAttributeType type, const double *numbers,
                int count, const char *text) {
  char full[100];
  snprintf(full, sizeof full, "%s%s%s", header->view ? header->view : "",
           header->view ? "." : "", name);
  vlAttribute attribute = {.name = full, .type = type, .string = text};
  for (int i = 0; i < count; i++)
    attribute.numbers[i] = numbers[i] + 0.0; /* turns -0 into 0 */
  if (header->result == VL_OK)
    header->result = vl_image_set_attribute(header->image, &attribute);
}

static void set_int(Header *header, const char *name, uint32_t value) {
  double number = value;
  set(header, name, VL_ATTRIBUTE_INT, &number, 1, NULL);
}
static void set_float(Header *header, const char *name, double value) {
  set(header, name, VL_ATTRIBUTE_FLOAT, &value, 1, NULL);
}
static void set_double(Header *header, const char *name, double value) {
  set(header, name, VL_ATTRIBUTE_DOUBLE, &value, 1, NULL);
}
static void set_v2(Header *header, const char *name, double x, double y) {
  set(header, name, VL_ATTRIBUTE_V2F, (double[]){x, y}, 2, NULL);
}
static void set_text(Header *header, const char *name, const char *text) {
  set(header, name, VL_ATTRIBUTE_STRING, NULL, 0, text);
}
/* Corner pixels, both inclusive. */
static void set_window(Header *header, const char *name, uint32_t x0, uint32_t y0, uint32_t x1,
                       uint32_t y1) {
  set(header, name, VL_ATTRIBUTE_BOX2I, (double[]){x0, y0, x1 - 1.0, y1 - 1.0}, 4, NULL);
}

/* OpenEXR multiplies row vectors from the left, p' = p M, so matrices are transposed. */
static void set_matrix(Header *header, const char *name, vlAttributeType type,
                       const double m[16]) {
  double transposed[16];
  for (int row = 0; row < 4; row++)
    for (int column = 0; column < 4; column++)
      transposed[4 * column + row] = m[4 * row + column];
  set(header, name, type, transposed, 16, NULL);
}

/* Whether straight lines project to straight lines, so that matrices and a focal length
 * describe the camera completely. */
static bool is_linear(const vlCamera *c) {
  return c->projection == VL_PROJECTION_ORTHOGRAPHIC ||
         (c->projection == VL_PROJECTION_PERSPECTIVE && c->distortion.steps == 0);
}

static void multiply(const double a[16], const double b[16], double result[16]) {
  memcpy(result, vl_mat4_multiply(vl_mat4_load(a), vl_mat4_load(b)).m, 16 * sizeof *result);
}

/* worldToCamera: camera space with x right, y up, z forward. worldToNDC: after division by w,
 * (0, 0) is the display window's upper left corner and (1, 1) its lower right one. Its third
 * row is 1/z (perspective) or z, so that the matrix is invertible. Other projections have no
 * such matrix. */
static void set_camera_matrices(Header *header, const vlCamera *c) {
  static const double up_from_down[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  double m[16], w = c->width, h = c->height;
  multiply(up_from_down, c->camera_from_world, m);
  set_matrix(header, "worldToCamera", VL_ATTRIBUTE_M44F, m);
  if (!is_linear(c))
    return;
  const double perspective[16] = {
      c->fx / w, c->skew / w, c->cx / w, 0, 0, c->fy / h, c->cy / h, 0, 0, 0, 0, 1, 0, 0, 1, 0};
  const double orthographic[16] = {
      c->fx / w, c->skew / w, 0, c->cx / w, 0, c->fy / h, 0, c->cy / h, 0, 0, 1, 0, 0, 0, 0, 1};
  multiply(c->projection == VL_PROJECTION_PERSPECTIVE ? perspective : orthographic,
           c->camera_from_world, m);
  set_matrix(header, "worldToNDC", VL_ATTRIBUTE_M44F, m);
}

/* The projection's own parameters, and the lens distortion's coefficients in the order of its
 * calibration files. */
static void set_model(Header *header, const vlCamera *c, const vlCameraDef *def) {
  /* omits parameters that the projection does not have; Panini's has a default */
  if (!isnan(def->shape[0]) || c->shape[0] != 0)
    set_double(header, "velo.shape0", c->shape[0]);
  if (!isnan(def->shape[1]))
    set_double(header, "velo.shape1", c->shape[1]);
  if (def->distortion == VL_DISTORTION_NONE)
    return;
  char text[14 * 26] = "";
  for (uint32_t i = 0; i < def->distortion_count; i++) {
    size_t n = strlen(text);
    snprintf(text + n, sizeof text - n, "%s%.17g", i ? " " : "",
             def->distortion_coefficients[i]);
  }
  set_text(header, "velo.distortion", vl_distortion_name(def->distortion));
  set_text(header, "velo.distortionCoefficients", text);
}

/* Aperture shape, tilt, vignetting; a lens of many elements completely, except an image as
 * aperture stop. */
static void set_lens(Header *header, const vlCamera *c) {
  const vlLens *l = &c->lens;
  if (l->blades)
    set_int(header, "velo.blades", l->blades);
  if (l->rotation != 0)
    set_double(header, "velo.bladeRotation", l->rotation);
  if (l->ratio != 1)
    set_double(header, "velo.apertureRatio", l->ratio);
  if (l->tilt[0] != 0 || l->tilt[1] != 0)
    set_v2(header, "velo.tilt", l->tilt[0], l->tilt[1]);
  if (l->hinge[0] != 0 || l->hinge[1] != 0)
    set_v2(header, "velo.hinge", l->hinge[0], l->hinge[1]);
  if (l->vignetting)
    set_int(header, "velo.vignetting", 1);
  if (!l->optics)
    return;
  vlOpticsDef def;
  vlLensSurface surfaces[64];
  char text[64 * 4 * 26] = "";
  size_t n = 0;
  vl_optics_def(l->optics, &def, surfaces);
  for (uint32_t i = 0; i < def.count; i++) {
    const vlLensSurface *s = &surfaces[i];
    n += (size_t)snprintf(text + n, sizeof text - n, "%s%.17g %.17g %.17g %.17g", i ? " " : "",
                          s->radius, s->thickness, s->ior, s->aperture);
  }
  set_text(header, "velo.optics", text);
  if (!isnan(def.aperture_diameter))
    set_double(header, "velo.opticsAperture", def.aperture_diameter);
  if (isfinite(def.focus_distance))
    set_double(header, "velo.opticsFocus", def.focus_distance);
  set_double(header, "velo.opticsDiagonal", def.film_diagonal);
  set_double(header, "velo.opticsUnit", def.unit_mm);
}

/* The stereo parameters. The eye's own pose and principal point are in the other attributes,
 * except for omnidirectional stereo's eye circle. */
static void set_stereo(Header *header, const vlCamera *c, const vlStereo *stereo) {
  if (stereo->mode == VL_STEREO_NONE)
    return;
  set_text(header, "velo.stereo", vl_camera_stereo_modes[stereo->mode]);
  set_double(header, "velo.interocular", stereo->interocular);
  if (isfinite(stereo->convergence))
    set_double(header, "velo.convergence", stereo->convergence);
  if (c->eye_circle != 0)
    set_double(header, "velo.eyeCircle", c->eye_circle);
}

/* The times of a rolling shutter's rows, in double: that of the row (or column) that is read
 * first, and of the poses. rows: ground truth is seen when each row is exposed. */
static void set_rows(Header *header, const vlCamera *c, bool rows) {
  bool last_row = c->readout_direction == VL_READOUT_UP,
       last_column = c->readout_direction == VL_READOUT_LEFT;
  double x = last_column ? c->width - 0.5 : 0.5, y = last_row ? c->height - 0.5 : 0.5;
  set_text(header, "velo.channelsTime", rows ? "row" : "one");
  set_double(header, "velo.firstRowTime", vl_camera_time(c, x, y, 0.5));
  if (!c->moves)
    return;
  set_double(header, "velo.poseOpen", c->pose_times[0]);
  set_double(header, "velo.poseClose", c->pose_times[1]);
}

/* The motion, if any. The matrices above hold the camera in the middle of the shutter interval,
 * or at the time of the ground truth. */
static void set_motion(Header *header, const vlCamera *c, bool rows) {
  if (c->moves) {
    set_matrix(header, "velo.worldFromCameraOpen", VL_ATTRIBUTE_M44D, c->world_from_camera);
    set_matrix(header, "velo.worldFromCameraClose", VL_ATTRIBUTE_M44D,
               c->world_from_camera_close);
    set_v2(header, "velo.poseTimes", c->pose_times[0], c->pose_times[1]);
  }
  if (c->readout > 0) {
    set_double(header, "velo.readout", c->readout);
    set_text(header, "velo.readoutDirection",
             vl_camera_readout_directions[c->readout_direction]);
    set_rows(header, c, rows);
  }
  if (c->shutter_points == 0)
    return;
  char text[VL_SHUTTER_POINTS * 52] = "";
  for (uint32_t i = 0; i < c->shutter_points; i++) {
    size_t n = strlen(text);
    snprintf(text + n, sizeof text - n, "%s%.17g %.17g", i ? " " : "", c->shutter_at[i],
             c->shutter_value[i]);
  }
  set_text(header, "velo.shutterCurve", text);
}

/* The complete camera: OpenEXR's attributes in single precision, velo's own in double (camera x
 * right, y down, z forward). Lens and sensor are in millimetres. When the scene gives no sensor
 * width, full frame's 36 mm is written, which fixes the scale and nothing else. */
static void set_camera(Header *header, const vlHeaderDef *def, bool rows) {
  const vlCameraDef *given = &def->defs->camera;
  vlCamera held = *def->camera, *c = &held;
  vl_camera_at(def->camera, def->time, &held);
  set_camera_matrices(header, c);
  if (c->projection == VL_PROJECTION_PERSPECTIVE && is_linear(c)) {
    double sensor = given->sensor_width_mm;
    double mm = (sensor > 0 ? sensor : 36.0) / c->width;
    set_float(header, "pinholeFocalLength", c->fx * mm);
    set_v2(header, "sensorOverallDimensions", c->width * mm, c->height * mm);
    set_v2(header, "sensorCenterOffset", (0.5 * c->width - c->cx) * mm,
           (0.5 * c->height - c->cy) * mm);
  }
  set_double(header, "velo.fx", c->fx);
  set_double(header, "velo.fy", c->fy);
  set_double(header, "velo.skew", c->skew);
  set_double(header, "velo.cx", c->cx);
  set_double(header, "velo.cy", c->cy);
  set_matrix(header, "velo.worldFromCamera", VL_ATTRIBUTE_M44D, c->world_from_camera);
  set_text(header, "velo.projection", vl_projection_name(c->projection));
  if (isfinite(c->limit))
    set_double(header, "velo.limit", c->limit);
  set_model(header, c, given);
  set_stereo(header, c, &given->stereo);
  set_float(header, "velo.lensRadius", c->lens_radius);
  set_lens(header, c);
  if (isfinite(c->focus_distance))
    set_float(header, "focus", c->focus_distance);
  set_v2(header, "velo.shutter", def->camera->shutter_open, def->camera->shutter_close);
  set_motion(header, def->camera, rows);
  set_float(header, "velo.exposureTime", c->exposure_time);
}

static const char *kind_name(const char *family, int kind) {
  const vlKindFamily *found = vl_kind_family_find(family);
  bool known = found && kind >= 0 && (uint32_t)kind < found->kind_count;
  const char *name = known ? found->rows[kind]->name : NULL;
  return name ? name : "?";
}
/* The name of a setting's choice. */
static const char *choice(const char *setting, int value) {
  const vlParameter *row = vl_setting(VL_SETTING_RENDER, setting);
  return row && row->choices ? row->choices[value] : "?";
}

vlHeaderDef vl_default_header_def(void) {
  return (vlHeaderDef){.cookie = VL_COOKIE_HEADER, .time = VL_UNSET};
}

static vlResult set_plainly(vlImage *image, const vlHeaderDef *given) {
  vlHeaderDef held = *given, *def = &held;
  const vlCamera *c = def->camera;
  bool rows = isnan(def->time);
  if (rows)
    def->time = vl_camera_time(c, 0.5 * c->width, 0.5 * c->height, 0.5);
  Header header = {.image = image, .result = VL_OK, .view = def->view};
  if (def->view) {
    set_camera(&header, def, rows);
    return header.result;
  }
  const vlFilmDef *film = &def->defs->film;
  const vlBuildDef *build = &def->defs->build;
  const vlRenderDef *render = &def->defs->render;
  const uint32_t *crop = film->crop;
  char software[32];
  snprintf(software, sizeof software, "velo %s", vl_version()->text);
  set_text(&header, "software", software);
  set_window(&header, "displayWindow", 0, 0, c->width, c->height);
  set_window(&header, "dataWindow", crop[0], crop[1], crop[2], crop[3]);
  set_window(&header, "originalDataWindow", 0, 0, c->width, c->height);
  set_camera(&header, def, rows);

  const char *slash = def->scene ? strrchr(def->scene, '/') : NULL;
  if (def->scene)
    set_text(&header, "velo.scene", slash ? slash + 1 : def->scene);
  if (def->samples)
    set_int(&header, "samplesPerPixel", def->samples);
  if (render->noise > 0)
    set_double(&header, "velo.noise", render->noise);
  set_text(&header, "velo.sampler", kind_name("samplers", (int)render->sampler));
  set_double(&header, "velo.seed", render->seed); /* unsigned: does not fit EXR's int */
  set_text(&header, "velo.filter", kind_name("filters", (int)film->filter.kind));
  set_v2(&header, "velo.filterRadius", film->filter.radius_x, film->filter.radius_y);
  set_text(&header, "velo.tracer", kind_name("tracers", (int)render->tracer));
  set_int(&header, "velo.maxDepth", render->max_depth);
  set_text(&header, "velo.color", choice("color", (int)build->color));
  set_text(&header, "velo.bits", choice("bits", (int)build->bits));
  set_text(&header, "velo.filterSamples", render->share_samples ? "shared" : "own");
  if (build->regularize)
    set_int(&header, "velo.regularize", 1);
  if (render->merge_radius > 0)
    set_double(&header, "velo.mergeRadius", render->merge_radius);
  if (render->light_paths != VL_AS_MANY_AS_PIXELS)
    set_double(&header, "velo.lightPaths", render->light_paths);
  set_text(&header, "velo.lightSampler", choice("light_sampler", (int)build->light_sampler));
  return header.result;
}

vlResult vl_image_set_header(vlImage *image, const vlHeaderDef *given) {
  if (!image || !given || given->cookie != VL_COOKIE_HEADER || !given->camera || !given->defs)
    return VL_ERROR_ARGUMENT;
  void *locale = vl_machine_set_numerals();
  vlResult result = set_plainly(image, given);
  vl_machine_restore_numerals(locale);
  return result;
}

vlResult vl_image_show_ids(const vlImage *ids, vlImage **shown) {
  enum { MAX_CHANNELS = 16, MAX_EXACT = 1 << 24 };
  if (!ids || !shown || vl_image_type(ids) != VL_PIXEL_U32 ||
      vl_image_channels(ids) > MAX_CHANNELS)
    return VL_ERROR_ARGUMENT;
  char texts[MAX_CHANNELS][64];
  const char *names[MAX_CHANNELS];
  uint32_t count = vl_image_channels(ids);
  for (uint32_t i = 0; i < count; i++) {
    const char *name = vl_image_channel_name(ids, i);
    size_t n = strlen(name);
    bool lettered = n > 2 && name[n - 2] == '.';
    snprintf(texts[i], sizeof texts[i], "%s%s", name, lettered ? "" : ".Y");
    names[i] = texts[i];
  }
  vlImageDef def = vl_default_image_def(vl_image_width(ids), vl_image_height(ids), count);
  size_t values = (size_t)def.width * def.height * count;
  const uint32_t *from = vl_image_const_pixels(ids);
  bool exact = true;
  for (size_t i = 0; i < values; i++)
    exact = exact && from[i] < MAX_EXACT;
  def.names = names;
  def.type = exact ? VL_PIXEL_F32 : VL_PIXEL_U32;
  VL_TRY(vl_image_create(ids->context, &def, shown));
  if (exact) {
    float *to = vl_image_pixels(*shown);
    for (size_t i = 0; i < values; i++)
      to[i] = (float)from[i];
  } else {
    memcpy(vl_image_pixels(*shown), from, values * sizeof *from);
  }
  vlResult result = vl_image_add_attributes(*shown, ids);
  if (result != VL_OK) {
    vl_image_destroy(*shown);
    *shown = NULL;
  }
  return result;
}
