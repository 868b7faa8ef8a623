/* render/needs.c: see needs.h. One table says what an option needs, another when that is there.
 * Where the answer is not certain, the option counts as having an effect: a film keeps options
 * for --continue and velo film develop. */
#include "render/needs.h"

#include "camera/camera.h"
#include "cli/kinds.h"
#include "cli/report.h"
#include "render/animate.h"
#include "render/lens_options.h"
#include "render/shard.h"
#include "velo/check.h"
#include "velo/tracer.h"

typedef enum Need {
  NEED_NOTHING,
  NEED_GLTF,
  NEED_LAMPS,
  NEED_ANIMATIONS,
  NEED_PLAYED_TIME,
  NEED_ANIMATE,
  NEED_ADDED,
  NEED_ADDED_CAMERA,
  NEED_ADDED_CAMERA_OR_POINT,
  NEED_ADDED_GROUND,
  NEED_ADDED_LIGHT,
  NEED_CAMERA_FILE,
  NEED_CAMERA_OR_POSES,
  NEED_LENS,
  NEED_FILM,
  NEED_DISPLAY,
  NEED_EXR,
  NEED_LAYERS,
  NEED_ALPHA,
  NEED_CHANNELS,
  NEED_CRYPTO,
  NEED_OTHER_DENOISER,
  NEED_OF_TRACER, /* those below are known when the tracer is */
  NEED_MERGING,
  NEED_LIGHT_PATHS,
  NEED_BOUNCES,
  NEED_LIGHT_SAMPLES,
  NEED_COUNT
} Need;

/* Options that are not here always have an effect, or their command line is refused without
 * what they need. */
static const Need needs_of[MAX_OPTIONS] = {
    [RENDER_SCENE] = NEED_GLTF,
    [RENDER_AT] = NEED_ANIMATIONS,
    [RENDER_SHUTTER] = NEED_ANIMATIONS,
    [RENDER_ANIMATE] = NEED_ANIMATIONS,
    [RENDER_VARIANT] = NEED_GLTF,
    [RENDER_SCENE_UNIT] = NEED_LAMPS,
    [RENDER_ANIMATION] = NEED_PLAYED_TIME,
    [RENDER_FPS] = NEED_ANIMATE,
    [RENDER_UP] = NEED_ADDED,
    [RENDER_FRAMING] = NEED_ADDED_CAMERA,
    [RENDER_WALLS] = NEED_ADDED_CAMERA_OR_POINT,
    [RENDER_NO_GROUND] = NEED_ADDED_GROUND,
    [RENDER_ENVIRONMENT_ROTATION] = NEED_ADDED_LIGHT,
    [RENDER_ENVIRONMENT_STRENGTH] = NEED_ADDED_LIGHT,
    [RENDER_FRAME] = NEED_CAMERA_FILE,
    [RENDER_SIZE] = NEED_CAMERA_OR_POSES,
    [RENDER_FOCUS_PIXEL] = NEED_LENS,
    [RENDER_FOCUS_DISTANCE] = NEED_LENS,
    [RENDER_CHECKPOINT] = NEED_FILM,
    [RENDER_VIEW] = NEED_DISPLAY,
    [RENDER_EXPOSURE] = NEED_DISPLAY,
    [RENDER_HALF] = NEED_EXR,
    [RENDER_NO_RECEIPT] = NEED_EXR,
    [RENDER_BOXES] = NEED_EXR,
    [RENDER_FLOW_CAMERA] = NEED_EXR,
    [RENDER_FLOW_CAMERA_BEFORE] = NEED_EXR,
    [RENDER_CHANNELS] = NEED_LAYERS,
    [RENDER_SPECTRUM] = NEED_LAYERS,
    [RENDER_TRANSPARENT] = NEED_ALPHA,
    [RENDER_CHANNELS_MODE] = NEED_CHANNELS,
    [RENDER_CHANNELS_TIME] = NEED_CHANNELS,
    [RENDER_CRYPTO_RANKS] = NEED_CRYPTO,
    [RENDER_DENOISER_LIBRARY] = NEED_OTHER_DENOISER,
    [RENDER_MERGE_RADIUS] = NEED_MERGING,
    [RENDER_LIGHT_PATHS] = NEED_LIGHT_PATHS,
    [RENDER_MAX_DEPTH] = NEED_BOUNCES,
    [RENDER_LIGHT_SAMPLER] = NEED_LIGHT_SAMPLES,
    [RENDER_REGULARIZE] = NEED_LIGHT_SAMPLES,
};

/* ---- when it is there -------------------------------------------------------------------- */

/* has: what is there, by needs. */

static void look_at_scene(const Needs *n, bool has[NEED_COUNT]) {
  const OptionValue *v = n->values;
  const OptionValue *file = &v[RENDER_CAMERA];
  const SceneOpening *opening = n->opening;
  const vlCamera *camera = &n->job->camera;
  const bool light = opening->environment != VL_ENVIRONMENT_NONE;
  const bool turned = v[RENDER_TURN].given || v[RENDER_TURNTABLE].given;
  const bool ground =
      v[RENDER_GROUND].given || v[RENDER_GROUND_MIDDLE].given || v[RENDER_GROUND_RADIUS].given;
  const int64_t walls = v[RENDER_WALLS].integer;
  vlSceneInfo info;
  vl_scene_info(n->scene, &info);
  has[NEED_GLTF] = scene_is_gltf(n->job->path);
  has[NEED_LAMPS] = info.lamps > 0; /* light depends on the length of the scene's unit */
  has[NEED_ANIMATIONS] = vl_scene_choice_count(n->scene, VL_CHOICE_ANIMATION) > 0;
  has[NEED_PLAYED_TIME] = v[RENDER_AT].given || v[RENDER_ANIMATE].given;
  has[NEED_ANIMATE] = v[RENDER_ANIMATE].given || (n->render && n->render->videos);
  has[NEED_ADDED_CAMERA] = opening->camera_added;
  has[NEED_ADDED_CAMERA_OR_POINT] =
      opening->camera_added || walls == OPTION_LIST_GIVEN || walls == WALLS_BOTH_SIDES;
  has[NEED_ADDED_LIGHT] = light;
  has[NEED_ADDED_GROUND] = opening->model && vl_environment_is_studio(opening->environment);
  has[NEED_ADDED] = opening->camera_added || light || ground || turned;
  has[NEED_CAMERA_FILE] = file->given && !camera_is_scene(file->text) &&
                          !scene_camera_is_own(n->job->path, n->arguments);
  has[NEED_CAMERA_OR_POSES] = has[NEED_CAMERA_FILE] || v[RENDER_TRAJECTORY].given;
  has[NEED_LENS] = n->edited || (n->render && n->render->many) || camera->lens_radius > 0 ||
                   camera->lens.optics;
}

/* Whether a film, or an image for which the test is true, is written. */
static bool has_output(const Render *render, bool (*test)(const char *path)) {
  return !render || render->film_plan.path || outputs_any(&render->outputs, test) ||
         outputs_any(&render->denoised.outputs, test);
}

/* A command without outputs of its own shows or needs all. */
static void look_at_outputs(const Needs *n, bool has[NEED_COUNT]) {
  const OptionValue *v = n->values;
  const Render *r = n->render;
  const Channels *channels = r ? &r->channels : NULL;
  const bool exr = has_output(r, output_holds_layers);
  has[NEED_FILM] = !r || r->film_plan.path;
  has[NEED_DISPLAY] =
      has_output(r, output_is_display) || v[RENDER_NOISE].given || v[RENDER_SERVE].given;
  has[NEED_EXR] = exr;
  has[NEED_LAYERS] = exr;
  has[NEED_ALPHA] = has_output(r, output_holds_alpha);
  has[NEED_CHANNELS] = exr && (!channels || channels->bits || channels->gbuffer);
  has[NEED_CRYPTO] = exr && (!channels || channels->bits & CHANNELS_CRYPTO);
  has[NEED_OTHER_DENOISER] = !r || r->denoised.def.denoiser != VL_DENOISER_VELO;
}

static void look_at_tracer(vlTracer tracer, bool has[NEED_COUNT]) {
  has[NEED_MERGING] = tracer == VL_TRACER_MERGING || tracer == VL_TRACER_SPPM;
  has[NEED_LIGHT_PATHS] = tracer_has_light_paths(tracer);
  has[NEED_BOUNCES] = tracer != VL_TRACER_RAYCAST && tracer != VL_TRACER_AMBIENT_OCCLUSION;
  has[NEED_LIGHT_SAMPLES] = has[NEED_BOUNCES] && tracer != VL_TRACER_RANDOM_WALK;
}

static const struct {
  const char *why;   /* after "--option has no effect: " */
  bool names_scene;  /* the path of the scene goes before */
  bool is_warned_of; /* each output has its warning already (render.c) */
  Need before;       /* is needed for it, too, and looked at first */
} rows[NEED_COUNT] = {
    [NEED_GLTF] = {" is not a glTF file", .names_scene = true},
    [NEED_LAMPS] = {" has no light given in candela or lumens", .names_scene = true},
    [NEED_ANIMATIONS] = {" has no animations", .names_scene = true, .before = NEED_GLTF},
    [NEED_PLAYED_TIME] = {"no animation is played (--at, --animate)",
                          .before = NEED_ANIMATIONS},
    [NEED_ANIMATE] = {"it goes with --animate, or with a video"},
    [NEED_ADDED] = {" has a camera and light of its own", .names_scene = true},
    [NEED_ADDED_CAMERA] = {"no camera is added, the camera is given"},
    [NEED_ADDED_CAMERA_OR_POINT] = {"no camera is added, the camera is given"},
    [NEED_ADDED_GROUND] = {"no ground would be added"},
    [NEED_ADDED_LIGHT] = {"no environment map is added (--environment)"},
    [NEED_CAMERA_FILE] =
        {"the file of --camera is a scene, or the scene's own camera is taken"},
    [NEED_CAMERA_OR_POSES] = {"there is no camera file (--camera, --trajectory)"},
    [NEED_LENS] = {"the camera is a pinhole (--lens-radius, --f-number)"},
    [NEED_FILM] = {"there is no film (--film)"},
    [NEED_DISPLAY] = {"no output is a .png, .jpg or .tga"},
    [NEED_EXR] = {"no output is an .exr"},
    [NEED_LAYERS] = {"no output is an .exr", .is_warned_of = true},
    [NEED_ALPHA] = {"no output is a .png or .exr", .is_warned_of = true},
    [NEED_CHANNELS] = {"no ground truth is written (--channels, into an .exr)"},
    [NEED_CRYPTO] = {"no Cryptomatte is written (--channels crypto, into an .exr)"},
    [NEED_OTHER_DENOISER] = {"the denoiser is velo's own (--denoiser oidn)"},
    [NEED_MERGING] = {"only merging and sppm merge"},
    [NEED_LIGHT_PATHS] = {"only bidirectional, merging, sppm and lightpath follow light paths"},
    [NEED_BOUNCES] = {"this tracer follows no path"},
    [NEED_LIGHT_SAMPLES] = {"this tracer samples no lights"},
};

/* ---- the check --------------------------------------------------------------------------- */

/* tracer: the one that lacks something; null: it is not the tracer. */
static int report_option(const Needs *n, const Option *option, Need need, const char *tracer) {
  const char *scene = rows[need].names_scene ? n->job->path : "";
  const char *by = tracer ? tracer : "";
  const char *gap = tracer ? ": " : "";
  const char *why = rows[need].why;
  if (n->values[RENDER_STRICT_OPTIONS].given)
    return report_usage("--%s has no effect: %s%s%s%s", option->name, by, gap, scene, why);
  if (!rows[need].is_warned_of)
    report_note("--%s has no effect: %s%s%s%s", option->name, by, gap, scene, why);
  return -1;
}

/* What is missing of a need: itself, or one before it. NEED_NOTHING: it is there. */
static Need missing(const bool has[NEED_COUNT], Need need) {
  if (need == NEED_NOTHING)
    return need;
  const Need before = missing(has, rows[need].before);
  if (before != NEED_NOTHING)
    return before;
  return has[need] ? NEED_NOTHING : need;
}

static int check(const Needs *n, const bool has[NEED_COUNT], const char *tracer) {
  int status = -1;
  for (const Option *option = n->options; option->name; option++) {
    if (option->id >= RENDER_OPTIONS || !n->values[option->id].given)
      continue; /* an option of another command */
    const Need need = needs_of[option->id];
    if ((need > NEED_OF_TRACER) != (tracer != NULL))
      continue;
    const Need lacking = missing(has, need);
    const int code = lacking == NEED_NOTHING ? -1 : report_option(n, option, lacking, tracer);
    if (code >= 0)
      status = code;
  }
  return status;
}

int needs_check_scene(const Needs *needs) {
  bool has[NEED_COUNT] = {false};
  look_at_scene(needs, has);
  look_at_outputs(needs, has);
  return check(needs, has, NULL);
}

int needs_check_tracer(const Needs *needs, const vlWorld *world) {
  bool has[NEED_COUNT] = {false};
  const Job *job = needs->job;
  vlTracer tracer = job->defs->render.tracer;
  if (vl_tracer_lacks(world, &job->camera, &job->defs->film, tracer))
    tracer = VL_TRACER_VOLPATH; /* it replaces that */
  look_at_tracer(tracer, has);
  return check(needs, has, kind_name("tracers", (int)tracer));
}

/* A frame of an animation has other options than the command: --at in place of --animate. */
static Needs needs_of_render(const Render *render, const Arguments *arguments) {
  const Arguments *whole = render->shared ? render->shared->whole : arguments;
  return (Needs){.options = render_options,
                 .values = whole->values,
                 .arguments = arguments,
                 .scene = render->scene,
                 .opening = &render->opening,
                 .job = &render->job,
                 .render = render};
}

/* Whether another frame of the animation has been checked. checked: null: there are none. */
static bool is_checked(bool *checked) {
  const bool before = checked && *checked;
  if (checked)
    *checked = true;
  return before;
}

int needs_check_render_scene(Render *render, const Arguments *arguments) {
  if (is_checked(render->shared ? &render->shared->job_checked : NULL))
    return -1;
  const Needs needs = needs_of_render(render, arguments);
  return needs_check_scene(&needs);
}

int needs_check_render_tracer(Render *render, const Arguments *arguments) {
  if (is_checked(render->shared ? &render->shared->tracer_checked : NULL))
    return -1;
  if (render->job.race == RACE_TRACERS && arguments->values[RENDER_DRY_RUN].given)
    return -1; /* there was no race */
  const Needs needs = needs_of_render(render, arguments);
  return needs_check_tracer(&needs, render->world);
}
