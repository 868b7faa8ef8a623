/* render/scene_options.c: see scene_options.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/context.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "cli/vector.h"
#include "render/exposure.h"
#include "render/job.h"
#include "render/near.h"
#include "render/scene_options.h"
#include "velo/camera.h"
#include "velo/check.h"
#include "velo/world.h"

/* Sine and cosine of an angle in degrees by their series: the same bits on all machines. */
static void sine_cosine(double degrees, double *sine, double *cosine) {
  const double turn = fmod(degrees, 360), quarters = floor(turn / 90 + 0.5);
  const double x = (turn - 90 * quarters) * (M_PI / 180), xx = x * x;
  double s = 0, c = 0;
  for (int k = 9; k >= 0; k--) {
    s = 1 - s * xx / ((2 * k + 2) * (2 * k + 3));
    c = 1 - c * xx / ((2 * k + 1) * (2 * k + 2));
  }
  s *= x;
  switch (((int)quarters % 4 + 4) % 4) {
    case 0:
      *sine = s;
      *cosine = c;
      break;
    case 1:
      *sine = c;
      *cosine = -s;
      break;
    case 2:
      *sine = -s;
      *cosine = -c;
      break;
    default:
      *sine = -c;
      *cosine = s;
      break;
  }
}

/* p = middle + R (p - middle), R about the unit axis (Rodrigues); a direction has no middle. */
static void turn(const double axis[3], double degrees, const double *middle, double p[3]) {
  double v[3], along = 0, s, c;
  sine_cosine(degrees, &s, &c);
  for (int i = 0; i < 3; i++) {
    v[i] = p[i] - (middle ? middle[i] : 0);
    along += axis[i] * v[i];
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    p[i] = (middle ? middle[i] : 0) + c * v[i] + s * (axis[j] * v[k] - axis[k] * v[j]) +
           (1 - c) * along * axis[i];
  }
}

/* Looks at the middle from a distance at which the sphere around the scene's box fits. */
static void stand_back(vlCameraDef *camera, const double low[3], const double high[3],
                       const double middle[3]) {
  double radius = 0, length = 0, sine, cosine;
  sine_cosine(0.5 * camera->fov * (180 / M_PI), &sine, &cosine);
  for (int i = 0; i < 3; i++) {
    radius += 0.25 * (high[i] - low[i]) * (high[i] - low[i]);
    length += (camera->eye[i] - camera->lookat[i]) * (camera->eye[i] - camera->lookat[i]);
  }
  const double far = 1.05 * sqrt(radius) / sine;
  for (int i = 0; i < 3 && length > 0; i++) {
    const double ahead = (camera->lookat[i] - camera->eye[i]) / sqrt(length);
    camera->lookat[i] = middle[i];
    camera->eye[i] = middle[i] - far * ahead;
  }
}

/* Turns a camera about the axis `up` through the middle of the scene's bounds. automatic: the
 * camera was made for the scene; then it keeps a distance at which every angle shows all of the
 * scene. */
static void turn_camera(vlCameraDef *camera, const double low[3], const double high[3],
                        bool automatic, const double up[3], double degrees) {
  const double length = vector_length(up);
  double middle[3], axis[3];
  for (int i = 0; i < 3; i++) {
    axis[i] = length > 0 ? up[i] / length : i == 1;
    middle[i] = low[0] <= high[0] ? 0.5 * (low[i] + high[i]) : 0;
  }
  if (automatic && low[0] <= high[0])
    stand_back(camera, low, high, middle);
  if (camera->has_matrix) {
    for (int column = 0; column < 4; column++) {
      double *m = camera->world_from_camera, v[3] = {m[column], m[4 + column], m[8 + column]};
      turn(axis, degrees, column == 3 ? middle : NULL, v);
      m[column] = v[0];
      m[4 + column] = v[1];
      m[8 + column] = v[2];
    }
  } else {
    turn(axis, degrees, middle, camera->eye);
    turn(axis, degrees, middle, camera->lookat);
    turn(axis, degrees, NULL, camera->up);
  }
}

/* Whether the file holds a model: a format other than pbrt. */
static bool is_model(const char *path) {
  return !text_ends_with(path, ".pbrt") && !text_ends_with(path, ".pbrt.gz");
}

vlContextDef scene_context_def(const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  vlContextDef def = context_def(arguments);
  if (v[RENDER_ISA].given)
    def.isa = (vlIsa)v[RENDER_ISA].integer;
  if (v[RENDER_MAX_MEMORY].given)
    def.max_memory = (size_t)v[RENDER_MAX_MEMORY].integer;
  if (v[RENDER_MAX_TEXTURE].given)
    def.max_texture_pixels = (uint64_t)v[RENDER_MAX_TEXTURE].integer;
  return def;
}

bool scene_is_gltf(const char *path) {
  return text_ends_with(path, ".gltf") || text_ends_with(path, ".glb");
}

bool scene_camera_is_own(const char *path, const Arguments *arguments) {
  const OptionValue *camera = &arguments->values[RENDER_CAMERA];
  struct stat info;
  return camera->given && scene_is_gltf(path) && stat(camera->text, &info) != 0;
}

/* Parses the name of an environment, or a file's. */
static void choose_environment(const char *text, vlCompleteDef *def) {
  const char *const *names = vl_setting(VL_SETTING_COMPLETE, "environment")->choices;
  def->environment = VL_ENVIRONMENT_FILE;
  for (int i = 0; names[i]; i++)
    if (strcmp(text, names[i]) == 0)
      def->environment = (vlEnvironmentKind)i;
  if (def->environment == VL_ENVIRONMENT_FILE)
    def->path = text;
}

const Choice framing_choices[] = {
    {"auto", VL_FRAMING_AUTO}, {"corner", VL_FRAMING_CORNER}, {"front", VL_FRAMING_FRONT}, {0}};
const Choice walls_choices[] = {
    {"hide", WALLS_HIDE}, {"keep", WALLS_KEEP}, {"both-sides", WALLS_BOTH_SIDES}, {0}};
const Choice up_choices[] = {{"x", 0}, {"y", 1}, {"z", 2}, {0}};

/* The front is +z, for z upwards -y, as modellers have it. */
void scene_choose_up(int axis, vlCompleteDef *def) {
  for (int i = 0; i < 3; i++) {
    def->up[i] = i == axis;
    def->front[i] = axis == 2 ? -(i == 1) : i == 2;
  }
}

/* Reports the lecture's parameters of the added camera, where the file has its model. d:
 * distance of the view plane in pixels. */
static void tell_camera(const vlSceneDefs *s, const double moved[3]) {
  const vlCameraDef *c = &s->camera;
  double d = 0.5 * (s->film.width < s->film.height ? s->film.width : s->film.height) /
             tan(0.5 * c->fov);
  report_note(
      "no camera in the file: eye (%.5g, %.5g, %.5g), lookat (%.5g, %.5g, %.5g), up (%.3g, "
      "%.3g, %.3g), d %.5g pixels",
      c->eye[0] + moved[0], c->eye[1] + moved[1], c->eye[2] + moved[2], c->lookat[0] + moved[0],
      c->lookat[1] + moved[1], c->lookat[2] + moved[2], c->up[0], c->up[1], c->up[2], d);
}

static bool read_seconds(const char *text, char **end, double *seconds) {
  *seconds = strtod(text, end);
  return *end != text && fabs(*seconds) <= 1e6;
}

int scene_read_times(const OptionValue *at, vlLoadDef *load) {
  if (!at->given)
    return -1;
  char *end;
  bool ok = read_seconds(at->text, &end, &load->time);
  if (ok && *end == ':')
    ok = read_seconds(end + 1, &end, &load->time_close);
  if (!ok || *end)
    return report_usage("--at \"%s\": must be SECONDS or T0:T1, within a million", at->text);
  if (load->time_close < load->time)
    return report_usage("--at \"%s\": the shutter cannot close before it opens", at->text);
  return -1;
}

/* Reads --at and --shutter S. */
static int choose_times(const OptionValue *v, vlLoadDef *load) {
  const OptionValue *at = &v[RENDER_AT], *shutter = &v[RENDER_SHUTTER];
  if (shutter->given && !at->given)
    return report_usage("--shutter goes with --at SECONDS");
  TRY(scene_read_times(at, load));
  if (!shutter->given)
    return -1;
  if (!isnan(load->time_close))
    return report_usage("--at \"%s\" says already when the shutter closes", at->text);
  load->time_close = load->time + shutter->number;
  return -1;
}

/* The ground. Ground truth is of the file alone. A film that is continued keeps the ground that
 * it has. */
static void choose_ground(const Arguments *arguments, bool model, vlCompleteDef *complete) {
  const OptionValue *v = arguments->values;
  const bool channels = v[RENDER_CHANNELS].given && !arguments->channels_later;
  const bool placed = v[RENDER_GROUND_MIDDLE].given || v[RENDER_GROUND_RADIUS].given;
  complete->backdrop = placed || (model && !v[RENDER_NO_GROUND].given && !channels);
  for (int i = 0; i < 3 && v[RENDER_GROUND_MIDDLE].given; i++)
    complete->ground_middle[i] = v[RENDER_GROUND_MIDDLE].numbers[i];
}

static void choose_walls(const OptionValue *walls, vlCompleteDef *complete) {
  const bool named = walls->given && walls->integer != OPTION_LIST_GIVEN;
  complete->open_walls = !named || walls->integer == WALLS_HIDE;
  complete->both_sides = named && walls->integer == WALLS_BOTH_SIDES;
  for (int i = 0; i < 3 && walls->given && walls->integer == OPTION_LIST_GIVEN; i++)
    complete->walls_from[i] = walls->numbers[i];
}

static int check_completion(const OptionValue *v) {
  const double max = vl_setting(VL_SETTING_COMPLETE, "elevation")->high;
  if (v[RENDER_NO_GROUND].given &&
      (v[RENDER_GROUND_MIDDLE].given || v[RENDER_GROUND_RADIUS].given))
    return report_usage("--no-ground does not go with --ground-middle and --ground-radius");
  if (v[RENDER_FRAMING].given && v[RENDER_FRAMING].integer == OPTION_LIST_GIVEN &&
      fabs(v[RENDER_FRAMING].numbers[1]) > max)
    return report_usage("--framing A,E: E must be from -89 to 89 degrees; it is \"%s\"",
                        v[RENDER_FRAMING].text);
  return -1;
}

/* What is added to the scene. */
static void choose_completion(const char *path, const Arguments *arguments, bool model,
                              vlCompleteDef *complete) {
  const OptionValue *v = arguments->values;
  option_size(&v[RENDER_RESOLUTION], &complete->width, &complete->height);
  if (v[RENDER_ENVIRONMENT].given)
    choose_environment(v[RENDER_ENVIRONMENT].text, complete);
  options_put(render_options, v, VL_SETTING_COMPLETE, complete);
  choose_ground(arguments, model, complete);
  choose_walls(&v[RENDER_WALLS], complete);
  const OptionValue *framing = &v[RENDER_FRAMING];
  if (framing->given && framing->integer == OPTION_LIST_GIVEN) {
    complete->azimuth = framing->numbers[0];
    complete->elevation = framing->numbers[1];
  }
  if (v[RENDER_UP].given)
    scene_choose_up((int)v[RENDER_UP].integer, complete);
  else if (text_ends_with(path, ".stl") || text_ends_with(path, ".stl.gz"))
    scene_choose_up(2, complete);
  complete->find_up = model && !v[RENDER_UP].given && !scene_is_gltf(path);
}

/* The file's own camera is not the one that renders: neither studio nor ground follow it. */
static void leave_camera(const OptionValue *v, vlCompleteDef *complete) {
  if (!v[RENDER_ENVIRONMENT_ROTATION].given)
    complete->rotation = 0;
  complete->backdrop &= v[RENDER_GROUND_MIDDLE].given || v[RENDER_GROUND_RADIUS].given;
}

/* The length of a unit in metres: by its name, or as a number. */
static int choose_unit(const OptionValue *value, double *metres) {
  static const struct {
    const char *name;
    double metres;
  } units[] = {{"m", 1},     {"cm", 0.01},   {"mm", 0.001},
               {"km", 1000}, {"in", 0.0254}, {"ft", 0.3048}};
  for (size_t i = 0; i < LENGTH(units); i++)
    if (strcmp(value->text, units[i].name) == 0) {
      *metres = units[i].metres;
      return -1;
    }
  return option_number("--scene-unit (or m, cm, mm, km, in, ft)", value->text,
                       vl_setting(VL_SETTING_LOAD, "unit"), metres);
}

static int choose_load(const char *path, const Arguments *arguments,
                       const SceneOpening *opening, vlLoadDef *load) {
  const OptionValue *v = arguments->values;
  load->cancel = opening->cancel;
  options_put(render_options, v, VL_SETTING_LOAD, load);
  load->camera = scene_camera_is_own(path, arguments) ? v[RENDER_CAMERA].text : NULL;
  TRY(choose_times(v, load));
  TRY(check_completion(v));
  if (v[RENDER_SCENE_UNIT].given)
    TRY(choose_unit(&v[RENDER_SCENE_UNIT], &load->unit));
  return -1;
}

vlResult scene_read(vlContext *context, const char *path, const vlLoadDef *load,
                    vlScene **scene, vlError *error) {
  TRY_RESULT(vl_scene_create(context, scene));
  return vl_scene_load(*scene, path, load, error);
}

/* The same of a text. */
static vlResult read_text(vlContext *context, const char *path, const SceneOpening *opening,
                          vlScene **scene, vlError *error) {
  TRY_RESULT(vl_scene_create(context, scene));
  return vl_scene_load_memory(*scene, path, opening->text, strlen(opening->text),
                              &opening->load, error);
}

/* Loads the scene and adds what it lacks. lit_inside: with lamps. */
static int load_and_complete(vlContext *context, const char *path, const Arguments *arguments,
                             bool lit_inside, vlScene **scene, SceneOpening *opening) {
  const OptionValue *v = arguments->values;
  const vlLoadDef *load = &opening->load;
  vlError error = {0};
  TRY(report_error(&error,
                   opening->text ? read_text(context, path, opening, scene, &error)
                                 : scene_read(context, path, load, scene, &error),
                   path));
  vlCompleteDef complete = vl_default_complete_def();
  vlSceneDefs *defs = vl_scene_defs(*scene);
  const bool camera = defs->camera_missing && (!v[RENDER_CAMERA].given || load->camera);
  defs->camera_missing = camera; /* another file gives the camera */
  vlSceneInfo info;
  vl_scene_info(*scene, &info);
  opening->model = is_model(path);
  choose_completion(path, arguments, opening->model, &complete);
  if (lit_inside)
    complete.environment = VL_ENVIRONMENT_LAMPS;
  if (opening->model || v[RENDER_TURN].given)
    vl_scene_bounds(*scene, opening->low, opening->high);
  if (v[RENDER_CAMERA].given && !load->camera)
    leave_camera(v, &complete);
  TRY(report_error(&error, vl_scene_complete(*scene, &complete, &error), path));
  opening->complete = vl_scene_completed(*scene);
  vl_scene_framed(*scene, opening->low, opening->high);
  opening->environment = opening->complete.environment;
  opening->lamps =
      opening->model && (info.lights > 0 || opening->environment == VL_ENVIRONMENT_NONE ||
                         opening->environment == VL_ENVIRONMENT_LAMPS);
  opening->self_lit = opening->model && info.lights == 0 &&
                      complete.environment == VL_ENVIRONMENT_AUTO &&
                      opening->environment == VL_ENVIRONMENT_NONE;
  opening->camera_added = camera;
  const int status = camera && opening->model ? near_move(*scene, path, opening) : -1;
  opening->camera = defs->camera;
  return status;
}

/* Whether the model's own camera may be inside it, where the studio's light does not come: a
 * room, a city under a dome. Surfaces that emit light may be elsewhere in it. */
static bool may_be_inside(const Arguments *arguments, const SceneOpening *opening,
                          const vlCamera *camera) {
  const OptionValue *v = arguments->values;
  const bool studio =
      opening->model && !opening->lamps && opening->environment == VL_ENVIRONMENT_STUDIO;
  bool inside = (studio || opening->self_lit) && !opening->camera_added &&
                !v[RENDER_ENVIRONMENT].given &&
                (!v[RENDER_CAMERA].given || opening->load.camera);
  for (int i = 0; i < 3 && inside; i++) {
    const double at = camera->world_from_camera[4 * i + 3];
    inside = at > opening->low[i] && at < opening->high[i];
  }
  return inside;
}

/* Renders a tiny image: whether the model, seen by its own camera, is dark. Keeps the world
 * that it builds for this. */
static int find_unlit(vlContext *context, const char *path, vlScene *scene,
                      const Arguments *arguments, SceneOpening *opening, bool *unlit) {
  const vlSceneDefs *defs = vl_scene_defs(scene);
  vlCamera camera;
  vlError error = {0};
  *unlit = false;
  if (vl_camera_make(&defs->camera, &camera, NULL, NULL) != VL_OK ||
      !may_be_inside(arguments, opening, &camera))
    return -1; /* a camera that cannot be is reported later */
  vlBuildDef build = defs->build;
  build.cancel = opening->cancel;
  TRY(report_error(&error, vl_world_build(scene, &build, &opening->metered, &error), path));
  uint32_t size[2] = {camera.width, camera.height};
  option_size(&arguments->values[RENDER_RESOLUTION], &size[0], &size[1]);
  return exposure_find_unlit(context, scene, opening->metered, &camera, defs, size, unlit);
}

void scene_opening_close(SceneOpening *opening) {
  vl_world_destroy(opening->metered);
  opening->metered = NULL;
}

int scene_open(vlContext *context, const char *path, const Arguments *arguments,
               vlScene **scene, SceneOpening *opening) {
  const OptionValue *v = arguments->values;
  bool unlit = false;
  opening->load = vl_default_load_def();
  TRY(choose_load(path, arguments, opening, &opening->load));
  TRY(load_and_complete(context, path, arguments, false, scene, opening));
  TRY(find_unlit(context, path, *scene, arguments, opening, &unlit));
  if (unlit) {
    vl_scene_destroy(*scene);
    *scene = NULL;
    const int status = load_and_complete(context, path, arguments, true, scene, opening);
    report_note(
        "the model is dark inside: lamps are added around its camera "
        "(--environment lamps; --environment studio leaves them out)");
    TRY(status);
  }
  if (v[RENDER_TURN].given && v[RENDER_CAMERA].given && !opening->load.camera)
    return report_usage(
        "--turn turns the scene's own camera: it does not go with --camera FILE");
  scene_turn(opening, arguments, vl_scene_defs(*scene));
  return -1;
}

void scene_turn(const SceneOpening *opening, const Arguments *arguments, vlSceneDefs *defs) {
  const OptionValue *turned = &arguments->values[RENDER_TURN];
  defs->camera = opening->camera;
  if (turned->given)
    turn_camera(&defs->camera, opening->low, opening->high, opening->camera_added,
                opening->complete.up, turned->number);
  if (opening->camera_added && !opening->silent)
    tell_camera(defs, opening->moved);
}
