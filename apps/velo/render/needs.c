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

/* What the tests look at. */
typedef struct Facts {
  const Needs *needs;
  const Render *render; /* may be null */
  const OptionValue *v; /* of the whole command */
  vlTracer tracer;
} Facts;

static bool has_gltf(const Facts *f) {
  return scene_is_gltf(f->needs->job->path);
}

static bool has_animations(const Facts *f) {
  return vl_scene_choice_count(f->needs->scene, VL_CHOICE_ANIMATION) > 0;
}

static bool has_played_time(const Facts *f) {
  return f->v[RENDER_AT].given || f->v[RENDER_ANIMATE].given;
}

static bool has_animate(const Facts *f) {
  return f->v[RENDER_ANIMATE].given || (f->render && f->render->videos);
}

static bool has_added_camera(const Facts *f) {
  return f->needs->opening->camera_added;
}

static bool has_added_camera_or_point(const Facts *f) {
  const int64_t walls = f->v[RENDER_WALLS].integer;
  return has_added_camera(f) || walls == OPTION_LIST_GIVEN || walls == WALLS_BOTH_SIDES;
}

static bool has_added_light(const Facts *f) {
  return f->needs->opening->environment != VL_ENVIRONMENT_NONE;
}

static bool has_added_ground(const Facts *f) {
  return f->needs->opening->model && vl_environment_is_studio(f->needs->opening->environment);
}

static bool has_added(const Facts *f) {
  return has_added_camera(f) || has_added_light(f) || f->v[RENDER_GROUND].given ||
         f->v[RENDER_GROUND_MIDDLE].given || f->v[RENDER_GROUND_RADIUS].given ||
         f->v[RENDER_TURN].given || f->v[RENDER_TURNTABLE].given;
}

static bool has_camera_file(const Facts *f) {
  const OptionValue *camera = &f->v[RENDER_CAMERA];
  return camera->given && !camera_is_scene(camera->text) &&
         !scene_camera_is_own(f->needs->job->path, f->needs->arguments);
}

/* Whether light depends on the length of the scene's unit. */
static bool has_lamps(const Facts *f) {
  vlSceneInfo info;
  vl_scene_info(f->needs->scene, &info);
  return info.lamps > 0;
}

static bool has_camera_or_poses(const Facts *f) {
  return has_camera_file(f) || f->v[RENDER_TRAJECTORY].given;
}

static bool has_lens(const Facts *f) {
  const vlCamera *camera = &f->needs->job->camera;
  const bool others = f->needs->edited || (f->render && f->render->many);
  return others || camera->lens_radius > 0 || camera->lens.optics;
}

static bool has_film(const Facts *f) {
  return !f->render || f->render->film_plan.path != NULL;
}

/* Whether a film, or an image for which the test is true, is written. */
static bool has_output(const Facts *f, bool (*test)(const char *path)) {
  if (!f->render)
    return true;
  return outputs_any(&f->render->outputs, test) ||
         outputs_any(&f->render->denoised.outputs, test) || has_film(f);
}

static bool has_display(const Facts *f) {
  return has_output(f, output_is_display) || f->v[RENDER_NOISE].given ||
         f->v[RENDER_SERVE].given;
}

static bool has_exr(const Facts *f) {
  return has_output(f, output_holds_layers);
}

static bool has_alpha(const Facts *f) {
  return has_output(f, output_holds_alpha);
}

static bool has_channels(const Facts *f) {
  return !f->render ||
         (has_exr(f) && (f->render->channels.bits || f->render->channels.gbuffer));
}

static bool has_crypto(const Facts *f) {
  const uint32_t crypto =
      VL_CHANNEL_CRYPTO_OBJECT | VL_CHANNEL_CRYPTO_MATERIAL | VL_CHANNEL_CRYPTO_INSTANCE;
  return !f->render || (has_exr(f) && f->render->channels.bits & crypto);
}

static bool has_other_denoiser(const Facts *f) {
  return !f->render || f->render->denoised.def.denoiser != VL_DENOISER_VELO;
}

static bool has_merging(const Facts *f) {
  return f->tracer == VL_TRACER_MERGING || f->tracer == VL_TRACER_SPPM;
}

static bool has_light_paths(const Facts *f) {
  return tracer_has_light_paths(f->tracer);
}

static bool has_bounces(const Facts *f) {
  return f->tracer != VL_TRACER_RAYCAST && f->tracer != VL_TRACER_AMBIENT_OCCLUSION;
}

static bool has_light_samples(const Facts *f) {
  return has_bounces(f) && f->tracer != VL_TRACER_RANDOM_WALK;
}

static const struct {
  bool (*has)(const Facts *facts);
  const char *why;   /* after "--option has no effect: " */
  bool names_scene;  /* the path of the scene goes before */
  bool is_warned_of; /* each output has its warning already (render.c) */
  Need before;       /* is needed for it, too, and looked at first */
} rows[NEED_COUNT] = {
    [NEED_GLTF] = {has_gltf, " is not a glTF file", .names_scene = true},
    [NEED_LAMPS] = {has_lamps, " has no light given in candela or lumens", .names_scene = true},
    [NEED_ANIMATIONS] = {has_animations, " has no animations", .names_scene = true,
                         .before = NEED_GLTF},
    [NEED_PLAYED_TIME] = {has_played_time, "no animation is played (--at, --animate)",
                          .before = NEED_ANIMATIONS},
    [NEED_ANIMATE] = {has_animate, "it goes with --animate, or with a video"},
    [NEED_ADDED] = {has_added, " has a camera and light of its own", .names_scene = true},
    [NEED_ADDED_CAMERA] = {has_added_camera, "no camera is added, the camera is given"},
    [NEED_ADDED_CAMERA_OR_POINT] = {has_added_camera_or_point,
                                    "no camera is added, the camera is given"},
    [NEED_ADDED_GROUND] = {has_added_ground, "no ground would be added"},
    [NEED_ADDED_LIGHT] = {has_added_light, "no environment map is added (--environment)"},
    [NEED_CAMERA_FILE] =
        {has_camera_file,
         "the file of --camera is a scene, or the scene's own camera is taken"},
    [NEED_CAMERA_OR_POSES] = {has_camera_or_poses,
                              "there is no camera file (--camera, --trajectory)"},
    [NEED_LENS] = {has_lens, "the camera is a pinhole (--lens-radius, --f-number)"},
    [NEED_FILM] = {has_film, "there is no film (--film)"},
    [NEED_DISPLAY] = {has_display, "no output is a .png, .jpg or .tga"},
    [NEED_EXR] = {has_exr, "no output is an .exr"},
    [NEED_LAYERS] = {has_exr, "no output is an .exr", .is_warned_of = true},
    [NEED_ALPHA] = {has_alpha, "no output is a .png or .exr", .is_warned_of = true},
    [NEED_CHANNELS] = {has_channels, "no ground truth is written (--channels, into an .exr)"},
    [NEED_CRYPTO] = {has_crypto, "no Cryptomatte is written (--channels crypto, into an .exr)"},
    [NEED_OTHER_DENOISER] = {has_other_denoiser,
                             "the denoiser is velo's own (--denoiser oidn)"},
    [NEED_MERGING] = {has_merging, "only merging and sppm merge"},
    [NEED_LIGHT_PATHS] = {has_light_paths,
                          "only bidirectional, merging, sppm and lightpath follow light paths"},
    [NEED_BOUNCES] = {has_bounces, "this tracer follows no path"},
    [NEED_LIGHT_SAMPLES] = {has_light_samples, "this tracer samples no lights"},
};

/* ---- the check --------------------------------------------------------------------------- */

static int report_option(const Facts *f, const Option *option, Need need) {
  const bool strict = f->v[RENDER_STRICT_OPTIONS].given;
  const char *scene = rows[need].names_scene ? f->needs->job->path : "", *why = rows[need].why;
  const bool of_tracer = need > NEED_OF_TRACER;
  const char *tracer = of_tracer ? kind_name("tracers", (int)f->tracer) : "",
             *gap = of_tracer ? ": " : "";
  if (strict)
    return report_usage("--%s has no effect: %s%s%s%s", option->name, tracer, gap, scene, why);
  if (!rows[need].is_warned_of)
    report_note("--%s has no effect: %s%s%s%s", option->name, tracer, gap, scene, why);
  return -1;
}

/* What is missing of a need: itself, or one before it. NEED_NOTHING: it is there. */
static Need missing(const Facts *f, Need need) {
  if (need == NEED_NOTHING)
    return need;
  const Need before = missing(f, rows[need].before);
  if (before != NEED_NOTHING)
    return before;
  return rows[need].has(f) ? NEED_NOTHING : need;
}

static int check(const Facts *f, bool of_tracer) {
  int status = -1;
  for (const Option *option = f->needs->options; option->name; option++) {
    if (option->id >= RENDER_OPTIONS || !f->v[option->id].given)
      continue; /* an option of another command */
    const Need need = needs_of[option->id];
    if ((need > NEED_OF_TRACER) != of_tracer)
      continue;
    const Need lacking = missing(f, need);
    const int code = lacking == NEED_NOTHING ? -1 : report_option(f, option, lacking);
    if (code >= 0)
      status = code;
  }
  return status;
}

int needs_check_scene(const Needs *needs) {
  const Facts facts = {.needs = needs, .render = needs->render, .v = needs->values};
  return check(&facts, false);
}

int needs_check_tracer(const Needs *needs, const vlWorld *world) {
  const Job *job = needs->job;
  const vlTracer tracer = job->defs->render.tracer;
  const bool replaced = vl_tracer_lacks(world, &job->camera, &job->defs->film, tracer) != 0;
  const Facts facts = {.needs = needs,
                       .render = needs->render,
                       .v = needs->values,
                       .tracer = replaced ? VL_TRACER_VOLPATH : tracer};
  return check(&facts, true);
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

int needs_check_render_scene(Render *render, const Arguments *arguments) {
  AnimateShared *shared = render->shared;
  if (shared && shared->job_checked)
    return -1;
  if (shared)
    shared->job_checked = true;
  const Needs needs = needs_of_render(render, arguments);
  return needs_check_scene(&needs);
}

int needs_check_render_tracer(Render *render, const Arguments *arguments) {
  AnimateShared *shared = render->shared;
  if (shared && shared->tracer_checked)
    return -1;
  if (shared)
    shared->tracer_checked = true;
  if (render->job.race == RACE_TRACERS && arguments->values[RENDER_DRY_RUN].given)
    return -1; /* there was no race */
  const Needs needs = needs_of_render(render, arguments);
  return needs_check_tracer(&needs, render->world);
}
