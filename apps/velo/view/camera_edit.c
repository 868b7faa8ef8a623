/* view/camera_edit.c: see camera_edit.h. Each field has a row. It names the setting whose
 * member gets the field's number, or has a function that puts its value into the def, and says
 * which spellings the value replaces. */
#include "view/camera_edit.h"
#include "cli/macros.h"
#include "cli/vector.h"
#include "velo/distortion.h"
#include "velo/projection.h"

#include <math.h>
#include <string.h>

static const double degree = M_PI / 180.0;

/* Takes the units that the def names. */
static void note_units(const vlCameraDef *def, CameraUnits *units) {
  if (!isnan(def->zoom))
    units->zoom = def->zoom;
  if (!isnan(def->pixel_size))
    units->pixel_size = def->pixel_size;
  if (!isnan(def->sensor_width_mm))
    units->sensor_mm = def->sensor_width_mm;
}

/* ---- the focal length -------------------------------------------------------------------- */

/* Replaces a window in scene units by the principal point. */
static void drop_window(const ViewCamera *now, vlCameraDef *def) {
  if (isnan(def->screen_min_x))
    return;
  def->screen_min_x = def->screen_max_x = def->screen_min_y = def->screen_max_y = VL_UNSET;
  def->cx = now->made.cx;
  def->cy = now->made.cy;
}

/* Removes every spelling of the focal length but the width of the sensor. */
static void drop_focal(vlCameraDef *def) {
  def->fov = def->view_distance = def->zoom = def->pixel_size = def->focal_mm = def->fx =
      def->fy = VL_UNSET;
}

static void spell_matrix(const ViewCamera *now, vlCameraDef *def) {
  if (isnan(def->fx)) {
    drop_window(now, def);
    drop_focal(def);
    def->fx = now->made.fx;
    def->fy = now->made.fy;
  }
}

static void spell_lecture(const ViewCamera *now, vlCameraDef *def) {
  if (!isnan(def->view_distance))
    return;
  const CameraUnits u = now->units;
  drop_window(now, def);
  drop_focal(def);
  if (def->projection == VL_PROJECTION_ORTHOGRAPHIC) {
    def->zoom = u.zoom;
    def->pixel_size = u.zoom / now->made.fx;
    return;
  }
  def->view_distance = now->made.fx * u.pixel_size / u.zoom;
  def->zoom = u.zoom;
  def->pixel_size = u.pixel_size;
}

static void spell_lens_mm(const ViewCamera *now, vlCameraDef *def) {
  const CameraUnits u = now->units;
  if (isnan(def->focal_mm)) {
    drop_window(now, def);
    drop_focal(def);
    def->focal_mm = now->made.fx * u.sensor_mm / now->made.width;
  }
  def->sensor_width_mm = u.sensor_mm;
}

typedef struct PoseEdit {
  bool given; /* a part of the pose is edited */
  CameraPose pose;
} PoseEdit;

typedef struct Edit {
  const ViewCamera *now;
  vlCameraDef *def;
  const ViewMessage *message;
  PoseEdit pose;
} Edit;

/* Each of these functions takes a field; false: its value is not of the right form. */
typedef bool Setter(Edit *edit, const MessageField *field);
/* Each of these removes or computes the spellings that a field replaces or needs. */
typedef void Before(const ViewCamera *now, vlCameraDef *def);

static void before_fov(UNUSED const ViewCamera *now, vlCameraDef *def) {
  drop_focal(def);
}
static void before_sensor(const ViewCamera *now, vlCameraDef *def) {
  if (!isnan(def->focal_mm))
    spell_lens_mm(now, def);
}
/* A field of view describes a window centred on the axis, so the matrix replaces it. */
static void before_point(const ViewCamera *now, vlCameraDef *def) {
  if (!isnan(def->fov) || !isnan(def->screen_min_x))
    spell_matrix(now, def);
}

/* ---- projection and distortion ----------------------------------------------------------- */

/* Parameters with which a projection starts, where its own defaults do not do: a field of view
 * over the image's smaller side (0: none), and the numbers of its shape. */
static const struct {
  vlProjection projection;
  double fov_degrees, shape[2];
} starts[] = {{VL_PROJECTION_EQUIDISTANT, 180, {VL_UNSET, VL_UNSET}},
              {VL_PROJECTION_EQUISOLID, 180, {VL_UNSET, VL_UNSET}},
              {VL_PROJECTION_STEREOGRAPHIC, 180, {VL_UNSET, VL_UNSET}},
              {VL_PROJECTION_SINE, 180, {VL_UNSET, VL_UNSET}},
              {VL_PROJECTION_FOV, 0, {0.9, VL_UNSET}},
              {VL_PROJECTION_DIVISION, 0, {-0.2, VL_UNSET}},
              {VL_PROJECTION_UNIFIED, 0, {0.8, VL_UNSET}},
              {VL_PROJECTION_EUCM, 0, {0.6, 1.1}},
              {VL_PROJECTION_DOUBLE_SPHERE, 0, {-0.2, 0.6}}};

static void start_projection(const ViewCamera *now, vlCameraDef *def) {
  const double field = 2.0 * atan(0.5 * now->made.height / now->made.fy);
  const CameraPose pose = camera_pose(now);
  const double distance = camera_arm(&pose);
  drop_focal(def);
  def->screen_min_x = def->screen_max_x = def->screen_min_y = def->screen_max_y = VL_UNSET;
  def->cx = def->cy = def->skew = def->shape[0] = def->shape[1] = def->max_angle = VL_UNSET;
  def->distortion = VL_DISTORTION_NONE;
  def->distortion_count = 0;
  if (def->projection == VL_PROJECTION_PERSPECTIVE)
    def->fov = field < 120 * degree ? field : 60 * degree;
  if (def->projection == VL_PROJECTION_ORTHOGRAPHIC)
    def->fx = now->made.fx / (distance > 0 ? distance : 1);
  for (size_t i = 0; i < LENGTH(starts); i++) {
    if (starts[i].projection != def->projection)
      continue;
    if (starts[i].fov_degrees > 0) {
      def->fov = starts[i].fov_degrees * degree;
      def->fov_axis = VL_FOV_SMALLER;
    }
    for (int j = 0; j < 2; j++)
      def->shape[j] = starts[i].shape[j];
    if (!isnan(def->shape[0]))
      def->fx = def->fy =
          0.4 * (now->made.width < now->made.height ? now->made.width : now->made.height);
  }
}

static bool set_projection(Edit *e, const MessageField *f) {
  if (e->def->projection == (vlProjection)f->choice)
    return true;
  e->def->projection = (vlProjection)f->choice;
  start_projection(e->now, e->def);
  return true;
}
static bool set_fov_axis(Edit *e, const MessageField *f) {
  e->def->fov_axis = (vlFovAxis)f->choice;
  return true;
}
static bool set_shape(Edit *e, const MessageField *f) {
  if (f->count > 2)
    return false;
  for (uint32_t i = 0; i < 2; i++)
    e->def->shape[i] = i < f->count ? f->numbers[i] : VL_UNSET;
  return true;
}
static bool set_distortion(Edit *e, const MessageField *f) {
  /* coefficients with which a distortion starts */
  static const uint32_t counts[] = {[VL_DISTORTION_NONE] = 0,
                                    [VL_DISTORTION_OPENCV] = 5,
                                    [VL_DISTORTION_RADIAL] = 2,
                                    [VL_DISTORTION_THIN_PRISM] = 8,
                                    [VL_DISTORTION_RAD_TAN_THIN_PRISM] = 12};
  _Static_assert(LENGTH(counts) == VL_DISTORTION_KIND_COUNT, "a number for each kind");
  if (e->def->distortion != (vlDistortion)f->choice) {
    e->def->distortion_count = counts[f->choice];
    memset(e->def->distortion_coefficients, 0, sizeof e->def->distortion_coefficients);
  }
  e->def->distortion = (vlDistortion)f->choice;
  return true;
}
static bool set_coefficients(Edit *e, const MessageField *f) {
  if (f->count > 14)
    return false;
  e->def->distortion_count = f->count;
  memcpy(e->def->distortion_coefficients, f->numbers, f->count * sizeof *f->numbers);
  return true;
}

/* ---- pose -------------------------------------------------------------------------------- */

static bool three(const MessageField *f, double value[3], bool *given) {
  if (f->count != 3)
    return false;
  memcpy(value, f->numbers, 3 * sizeof *value);
  *given = true;
  return true;
}
static bool set_eye(Edit *e, const MessageField *f) {
  return three(f, e->pose.pose.eye, &e->pose.given);
}
static bool set_lookat(Edit *e, const MessageField *f) {
  return three(f, e->pose.pose.lookat, &e->pose.given);
}
static bool set_up(Edit *e, const MessageField *f) {
  return three(f, e->pose.pose.up, &e->pose.given);
}
static bool set_roll(Edit *e, const MessageField *f) {
  if (f->count != 1)
    return false;
  e->pose.pose.roll = f->numbers[0] * degree;
  return e->pose.given = true;
}

/* ---- lens -------------------------------------------------------------------------------- */

static void before_radius(UNUSED const ViewCamera *now, vlCameraDef *def) {
  def->lens.f_number = VL_UNSET;
}
static void before_f_number(UNUSED const ViewCamera *now, vlCameraDef *def) {
  def->lens_radius = 0;
  if (isnan(def->focal_mm) && isnan(def->sensor_width_mm))
    def->sensor_width_mm = 36;
}
static void before_focus(UNUSED const ViewCamera *now, vlCameraDef *def) {
  for (int i = 0; i < 3; i++)
    def->lens.focus_point[i] = VL_UNSET;
  for (int i = 0; i < 2; i++)
    def->lens.focus_pixel[i] = VL_UNSET;
}
/* With another shutter, the poses of a moving camera keep their times, and the image its
 * brightness. */
static void keep_motion(const ViewCamera *now, vlCameraDef *def) {
  const vlCameraDef *before = &now->def;
  for (int i = 0; i < 2 && now->made.moves; i++)
    def->pose_times[i] = now->made.pose_times[i];
  if (!isnan(before->lens.iso) && isnan(before->lens.seconds))
    def->lens.seconds = before->shutter_close - before->shutter_open;
}

/* ---- all fields -------------------------------------------------------------------------- */

/* In the order in which the fields of one message are applied. */
static const struct {
  const char *name;
  const char *setting; /* whose values the numbers are, in the row's unit; null: of none */
  Setter *set;         /* null: one number, into the setting's member */
  Before *before;      /* null: nothing is to be done before */
  bool needed;         /* the number may not be null */
} setters[] = {{"projection", "projection", .set = set_projection},
               {"fov_axis", "fov_axis", .set = set_fov_axis},
               {"fov", "fov", .before = before_fov},
               {"d", "view_distance", .before = spell_lecture},
               {"zoom", "zoom", .before = spell_lecture},
               {"s", "pixel_size", .before = spell_lecture},
               {"sensor_width_mm", "sensor_width_mm", .before = before_sensor},
               {"focal_mm", "focal_mm", .before = spell_lens_mm},
               {"fx", "fx", .before = spell_matrix},
               {"fy", "fy", .before = spell_matrix},
               {"cx", "cx", .before = before_point},
               {"cy", "cy", .before = before_point},
               {"skew", .setting = "skew"},
               {"shape", "shape[0]", .set = set_shape},
               {"max_angle", .setting = "max_angle"},
               {"distortion", "distortion", .set = set_distortion},
               {"coefficients", .set = set_coefficients},
               {"eye", "eye", .set = set_eye},
               {"lookat", "lookat", .set = set_lookat},
               {"up", "up", .set = set_up},
               {"roll", "roll", .set = set_roll},
               {"lens_radius", "lens_radius", .before = before_radius, .needed = true},
               {"f_number", "f_number", .before = before_f_number},
               {"focus_distance", "focus_distance", .before = before_focus},
               {"blades", "blades", .needed = true},
               {"rotation", "rotation", .needed = true},
               {"ratio", "ratio", .needed = true},
               {"tilt_x", "tilt_x", .needed = true},
               {"tilt_y", "tilt_y", .needed = true},
               {"lens_tilt_x", "lens_tilt_x", .needed = true},
               {"lens_tilt_y", "lens_tilt_y", .needed = true},
               {"near", .setting = "near_plane"},
               {"far", .setting = "far_plane"},
               {"shutter_open", "shutter_open", .before = keep_motion, .needed = true},
               {"shutter_close", "shutter_close", .before = keep_motion, .needed = true},
               {"exposure_time", "exposure_time", .needed = true}};
enum { SETTERS = LENGTH(setters) };

enum { PROJECTIONS = VL_PROJECTION_OPTICS + 1 };

/* The row of a field's values; projections have the names of the page, which `names` gets. */
static vlParameter row_of(const char *setting, const char *names[PROJECTIONS + 1]) {
  vlParameter row = *vl_setting(VL_SETTING_CAMERA, setting);
  if (strcmp(setting, "projection") != 0)
    return row;
  for (int i = 0; i < PROJECTIONS; i++)
    names[i] = vl_projection_name((vlProjection)i);
  names[PROJECTIONS] = NULL;
  row.choices = names;
  return row;
}

/* Checks the values of a field by its row, and finds its choice. */
static vlResult check_field(MessageField *field, const char *setting, vlError *error) {
  char name[80];
  char message[VL_GIVEN_MESSAGE];
  if (!setting || field->null)
    return VL_OK;
  const char *names[PROJECTIONS + 1];
  const vlParameter row = row_of(setting, names);
  text_set(name, "camera: %s", field->name);
  vlGiven given = {.kind = VL_GIVEN_TEXT, .text = field->text, .factor = row.factor};
  uint32_t count = field->count ? field->count : 1;
  for (uint32_t i = 0; i < count; i++) {
    double number;
    if (field->count)
      given =
          (vlGiven){.kind = VL_GIVEN_NUMBER, .number = field->numbers[i], .factor = row.factor};
    if (!vl_given_check(&row, name, &given, &number, message))
      return message_refuse(error, "%s", message);
    field->choice = row.type == VL_PARAMETER_CHOICE ? (int)number : 0;
  }
  return VL_OK;
}

static vlResult refuse_name(vlError *error, const char *name) {
  const char *names[SETTERS];
  char message[VL_GIVEN_MESSAGE];
  for (int i = 0; i < SETTERS; i++)
    names[i] = setters[i].name;
  vl_unknown_name("field of the camera", "", name, names, SETTERS, message);
  return message_refuse(error, "%s", message);
}

/* Applies a field by its setter. False: its value is not of the right form. */
static bool set_field(Edit *edit, const MessageField *field, int s) {
  if (setters[s].before)
    setters[s].before(edit->now, edit->def);
  if (setters[s].set)
    return setters[s].set(edit, field);
  const vlParameter *row = vl_setting(VL_SETTING_CAMERA, setters[s].setting);
  const vlCameraDef standard = vl_default_camera_def(1, 1);
  if (field->null && !setters[s].needed) {
    memcpy((char *)edit->def + row->offset, (const char *)&standard + row->offset,
           sizeof(double));
    return true;
  }
  vl_given_put(row, field->numbers[0] * (row->factor != 0 ? row->factor : 1), edit->def);
  return field->count == 1;
}

static vlResult apply_fields(Edit *edit, vlError *error) {
  const ViewMessage *message = edit->message;
  for (int s = 0; s < SETTERS; s++)
    for (uint32_t i = 0; i < message->field_count; i++) {
      MessageField field = message->fields[i];
      if (strcmp(field.name, setters[s].name) != 0)
        continue;
      TRY_RESULT(check_field(&field, setters[s].setting, error));
      if (!set_field(edit, &field, s))
        return message_refuse(error, "camera: %s has %u numbers, which is not their number",
                              field.name, field.count);
    }
  for (uint32_t i = 0; i < message->field_count; i++) {
    int s = 0;
    while (s < SETTERS && strcmp(setters[s].name, message->fields[i].name) != 0)
      s++;
    if (s == SETTERS)
      return refuse_name(error, message->fields[i].name);
  }
  return VL_OK;
}

/* Gives the width of the sensor only where it has a meaning. */
static void tidy_sensor(const CameraUnits *units, vlCameraDef *def) {
  const vlLensDef *lens = &def->lens;
  bool needed = !isnan(def->focal_mm) || !isnan(lens->f_number) || lens->lens_tilt_x != 0 ||
                lens->lens_tilt_y != 0;
  def->sensor_width_mm = needed ? units->sensor_mm : VL_UNSET;
}

/* Whether two compiled cameras are the same but for rounding. */
static bool same_camera(const vlCamera *a, const vlCamera *b) {
  return is_near(a->fx, b->fx) && is_near(a->fy, b->fy) && is_near(a->cx, b->cx) &&
         is_near(a->cy, b->cy) && is_near(a->skew, b->skew) &&
         is_near(a->lens_radius, b->lens_radius);
}

/* Scales the spelling of the focal length to the image's size. */
static void spell_at_size(ViewCamera *camera) {
  vlCameraDef *def = &camera->def;
  const vlCamera *made = &camera->made;
  if (!isnan(def->view_distance))
    def->view_distance = made->fx * camera->units.pixel_size / camera->units.zoom;
  if (!isnan(def->focal_mm))
    def->focal_mm = made->fx * def->sensor_width_mm / made->width;
  if (!isnan(def->fx))
    def->fx = made->fx;
  if (!isnan(def->fy))
    def->fy = made->fy;
  if (!isnan(def->cx))
    def->cx = made->cx;
  if (!isnan(def->cy))
    def->cy = made->cy;
  if (!isnan(def->skew))
    def->skew = made->skew;
  def->width = made->width;
  def->height = made->height;
}

/* Spells the camera by numbers that need no others: the matrix, the radius of the lens. */
static void spell_plainly(ViewCamera *camera) {
  vlCameraDef *def = &camera->def;
  const vlCamera *made = &camera->made;
  drop_window(camera, def);
  drop_focal(def);
  def->sensor_width_mm = VL_UNSET;
  def->fx = made->fx;
  def->fy = made->fy;
  def->cx = made->cx;
  def->cy = made->cy;
  def->skew = made->skew;
  def->lens_radius = made->lens_radius;
  def->lens.f_number = VL_UNSET;
  def->exposure_time = made->exposure_time;
  def->lens.iso = def->lens.seconds = VL_UNSET;
}

vlResult camera_take(const vlCameraDef *def, const vlCamera *made, double lookat,
                     ViewCamera *camera, vlError *error) {
  *camera = (ViewCamera){.def = *def, .made = *made, .units = {1, 1, 36, lookat}};
  vlLensDef *lens = &camera->def.lens;
  note_units(def, &camera->units);
  camera->def.stereo_eye = VL_EYE_BOTH;
  if (!isnan(lens->focus_pixel[0]) && !lens->optics) { /* the focus is found already */
    lens->focus_pixel[0] = lens->focus_pixel[1] = VL_UNSET;
    camera->def.focus_distance = made->focus_distance;
  }
  if (def->width != made->width || def->height != made->height) {
    vlCamera again;
    spell_at_size(camera);
    if (vl_camera_make(&camera->def, &again, NULL, error) != VL_OK ||
        !same_camera(&again, made))
      spell_plainly(camera);
  }
  return vl_camera_make(&camera->def, &camera->made, NULL, error);
}

vlResult camera_edit(const ViewCamera *now, const ViewMessage *message, ViewCamera *result,
                     const char **warning, vlError *error) {
  ViewCamera next = *now;
  Edit edit = {
      .now = now, .def = &next.def, .message = message, .pose = {.pose = camera_pose(now)}};
  TRY_RESULT(apply_fields(&edit, error));
  if (edit.pose.given)
    camera_place(now, &edit.pose.pose, &next.def);
  note_units(&next.def, &next.units);
  const double arm = camera_arm(&edit.pose.pose);
  if (arm > 0)
    next.units.lookat = arm;
  tidy_sensor(&next.units, &next.def);
  TRY_RESULT(vl_camera_make(&next.def, &next.made, warning, error));
  *result = next;
  return VL_OK;
}

static MessageField number_field(const char *name, double value) {
  MessageField field = {.count = 1, .numbers = {value}};
  text_set(field.name, "%s", name);
  return field;
}

vlResult camera_set_focus(const ViewCamera *now, double distance, ViewCamera *result,
                          vlError *error) {
  const ViewMessage message = {.field_count = 1,
                               .fields = {number_field("focus_distance", distance)}};
  const char *warning;
  return camera_edit(now, &message, result, &warning, error);
}

vlResult camera_set_shutter(const ViewCamera *now, double open, double close,
                            ViewCamera *result, vlError *error) {
  const ViewMessage message = {
      .field_count = 2,
      .fields = {number_field("shutter_open", open), number_field("shutter_close", close)}};
  const char *warning;
  return camera_edit(now, &message, result, &warning, error);
}
