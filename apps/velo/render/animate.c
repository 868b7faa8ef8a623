/* render/animate.c: see animate.h. */
#include "render/animate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/context.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/job.h"
#include "render/near.h"
#include "render/pattern.h"

enum { PATH_SIZE = 4096, MAX_FRAMES = 1000000 };

typedef struct Animation {
  double from, fps; /* seconds, frames per second */
  uint32_t count;   /* frames of the animation */
  FrameRange range; /* those that are rendered */
  bool turns;
} Animation;

bool animate_wanted(const Arguments *arguments) {
  return arguments->values[RENDER_ANIMATE].given || arguments->values[RENDER_TURNTABLE].given;
}

/* The frames from T0 on, before T1: 0:4 with 24 per second has 96 frames. */
static int read_animation(const Arguments *arguments, Animation *a) {
  const OptionValue *v = arguments->values, *span = &v[RENDER_ANIMATE];
  a->turns = v[RENDER_TURNTABLE].given;
  a->fps = v[RENDER_FPS].given ? v[RENDER_FPS].number : 24;
  if (a->turns) {
    a->count = (uint32_t)v[RENDER_TURNTABLE].integer;
    return -1;
  }
  char *end, *last;
  a->from = strtod(span->text, &end);
  const double to = *end == ':' ? strtod(end + 1, &last) : NAN;
  if (end == span->text || *end != ':' || last == end + 1 || *last || !(fabs(a->from) <= 1e6) ||
      !(to > a->from) || !(to <= 1e6))
    return report_usage("--animate \"%s\": must be T0:T1 in seconds, such as 0:4", span->text);
  const double count = ceil((to - a->from) * a->fps - 1e-6);
  if (count > MAX_FRAMES)
    return report_usage("--animate \"%s\": %.0f frames are too many", span->text, count);
  a->count = count >= 1 ? (uint32_t)count : 1;
  return -1;
}

static int check(const Arguments *arguments) {
  static const struct {
    int id;
    const char *name;
  } others[] = {{RENDER_TRAJECTORY, "--trajectory"},
                {RENDER_AGAIN, "--again"},
                {RENDER_FILM, "--film"},
                {RENDER_CONTINUE, "--continue"},
                {RENDER_SHARD, "--shard"},
                {RENDER_STEREO, "--stereo"}};
  const OptionValue *v = arguments->values;
  const char *own = v[RENDER_ANIMATE].given ? "--animate" : "--turntable";
  TRY(options_exclude(arguments, RENDER_ANIMATE, RENDER_TURNTABLE));
  TRY(options_exclude(arguments, RENDER_ANIMATE, RENDER_AT));
  TRY(options_exclude(arguments, RENDER_TURNTABLE, RENDER_TURN));
  for (size_t i = 0; i < LENGTH(others); i++)
    if (v[others[i].id].given)
      return report_usage("%s does not go with %s", own, others[i].name);
  const OptionValue *denoise = &v[RENDER_DENOISE];
  if (denoise->given && v[RENDER_DENOISER].given &&
      v[RENDER_DENOISER].integer != VL_DENOISER_VELO)
    return report_usage("%s goes with velo's own denoiser: leave out --denoiser", own);
  if (!arguments->text_count)
    return report_usage("%s: give the files' name with -o, such as -o f%%04d.png", own);
  for (int i = 0; i < arguments->text_count; i++) {
    TRY(pattern_check(arguments->texts[i]));
    if (!pattern_has(arguments->texts[i], 'd'))
      return report_usage("output \"%s\": put %%04d, the frame's number, into the name",
                          arguments->texts[i]);
  }
  const int status = denoise->given ? pattern_check(denoise->text) : -1;
  if (status < 0 && denoise->given && !pattern_has(denoise->text, 'd'))
    return report_usage("--denoise \"%s\": put %%04d, the frame's number, into the name",
                        denoise->text);
  return status;
}

static bool all_exist(const Arguments *arguments) {
  const OptionValue *denoise = &arguments->values[RENDER_DENOISE];
  if (denoise->given && access(denoise->text, F_OK) != 0)
    return false;
  for (int i = 0; i < arguments->text_count; i++)
    if (access(arguments->texts[i], F_OK) != 0)
      return false;
  return true;
}

/* What all frames of a run have in common. */
typedef struct Animator {
  const Arguments *arguments; /* the command line */
  Animation animation;
  Videos *videos;
  AnimateRender *render;
  AnimateShared shared;
} Animator;

static int render_before(Animator *x, uint32_t frame);

/* The command line of one frame: the animation's options become --at or --turn. */
static int render_frame(Animator *x, uint32_t frame) {
  const Animation *a = &x->animation;
  AnimateShared *shared = &x->shared;
  char(*paths)[PATH_SIZE] = malloc((MAX_TEXTS + 1) * sizeof *paths), moment[40];
  Arguments one = *x->arguments;
  const PatternValues values = {.number = frame};
  int status = paths ? -1 : report_no_memory();
  for (int i = 0; i <= one.text_count && status < 0; i++) {
    const char **name = i < one.text_count ? &one.texts[i] : &one.values[RENDER_DENOISE].text;
    if (i == one.text_count && !one.values[RENDER_DENOISE].given)
      break;
    if (!pattern_expand(*name, &values, paths[i], PATH_SIZE))
      status = report_failure(STATUS_IO, "frame %u: the file's name is too long", frame);
    *name = paths[i];
  }
  const double angle = a->turns ? 360.0 * frame / a->count : 0, at = a->from + frame / a->fps;
  OptionValue *set = &one.values[a->turns ? RENDER_TURN : RENDER_AT];
  text_set(moment, "%.10g", a->turns ? angle : at);
  *set = (OptionValue){.given = true, .text = moment, .number = a->turns ? angle : at};
  one.values[RENDER_ANIMATE].given = one.values[RENDER_TURNTABLE].given =
      one.values[RENDER_FPS].given = one.values[RENDER_FRAMES].given = false;
  const bool skip = one.values[RENDER_SKIP_EXISTING].given;
  one.values[RENDER_SKIP_EXISTING].given = false;
  if (status < 0 && skip && !shared->preparing && !shared->steady.only_kept && all_exist(&one))
    status = STATUS_OK;
  const bool denoises = one.values[RENDER_DENOISE].given && !one.values[RENDER_DRY_RUN].given;
  if (status < 0 && denoises && !shared->preparing && !shared->steady.only_kept)
    status = render_before(x, frame);
  if (status < 0)
    status = x->render(&one, shared, x->videos);
  free(paths);
  return status;
}

/* A SteadyBetween: loads the model for the moments of both frames, in the middle of their
 * exposures. */
static vlResult between(void *user, uint32_t before, uint32_t now, const Job *job,
                        vlWorld **result, double *span, vlError *error) {
  const Animator *x = user;
  const Animation *a = &x->animation;
  Arguments both = *x->arguments;
  OptionValue *v = both.values;
  char text[80];
  const double middle = v[RENDER_SHUTTER].given ? 0.5 * v[RENDER_SHUTTER].number : 0;
  const double from = a->from + before / a->fps + middle, to = a->from + now / a->fps + middle;
  text_set(text, "%.17g:%.17g", from, to);
  v[RENDER_AT] = (OptionValue){.given = true, .text = text, .number = from};
  v[RENDER_SHUTTER].given = false;
  v[RENDER_ANIMATE].given = false;
  v[RENDER_ENVIRONMENT] = (OptionValue){.given = true, .text = "none"}; /* light has no flow */
  SceneOpening opening = {.silent = true, .images_only = near_is_allowed(x->arguments)};
  vlScene *scene = NULL;
  *result = NULL;
  *span = to - from;
  vlResult code = VL_ERROR_SCENE;
  if (scene_open(job->context, both.operands[0], &both, &scene, &opening) < 0) {
    vlBuildDef build = job->defs->build;
    build.previous = job->world;
    code = vl_world_build_last(scene, &build, result, error);
  } else {
    text_set(error->message,
             "no flow from frame %u to frame %u: the model cannot be loaded for both", now,
             before);
  }
  vl_scene_destroy(scene);
  return code;
}

/* A SteadyRender. */
static int render_kept(void *user, uint32_t k) {
  Animator *x = user;
  return render_frame(x, x->shared.steady.before[k]);
}

/* A denoised frame uses the ones before it, of a turntable around the turn. */
static int render_before(Animator *x, uint32_t frame) {
  Steady *s = &x->shared.steady;
  const Animation *a = &x->animation;
  const uint32_t max = a->turns ? a->count - 1 : frame;
  s->count = max < STEADY_BEFORE ? max : STEADY_BEFORE;
  for (uint32_t k = 0; k < s->count; k++)
    s->before[k] = (frame + a->count - 1 - k) % a->count;
  const int status = steady_prepare(s, frame, render_kept, x);
  return status == STATUS_OK ? -1 : status;
}

/* The first frame of all sets the exposure and the tracer of each part. Whether it does is not
 * known before the scene is loaded, unless both are given. */
static bool needs_first(const Arguments *arguments, const Animation *a) {
  const OptionValue *v = arguments->values;
  bool tracer = v[RENDER_TRACER].given && v[RENDER_TRACER].integer != TRACER_AUTO;
  bool exposure = v[RENDER_EXPOSURE].given && strcmp(v[RENDER_EXPOSURE].text, "auto") != 0;
  return (a->range.first > 0 || v[RENDER_SKIP_EXISTING].given || v[RENDER_DENOISE].given) &&
         !(tracer && exposure) && !v[RENDER_DRY_RUN].given;
}

static int prepare(Animator *x) {
  x->shared.preparing = true;
  int status = render_frame(x, 0);
  x->shared.preparing = false;
  return status;
}

int animate_run(const Arguments *arguments, Videos *videos, AnimateRender *render) {
  Animator x = {.arguments = arguments,
                .videos = videos,
                .render = render,
                .shared = {.exposure = NAN, .whole = arguments}};
  Animation *a = &x.animation;
  AnimateShared *shared = &x.shared;
  TRY(check(arguments));
  TRY(read_animation(arguments, a));
  TRY(pattern_choose(arguments->values[RENDER_FRAMES].text, a->count, "animation", &a->range));
  shared->still = a->turns;
  if (!a->turns) {
    shared->steady.between = between;
    shared->steady.between_user = &x;
  }
  if (videos)
    videos_range(videos, &a->range);
  int status = needs_first(arguments, a) ? prepare(&x) : STATUS_OK;
  for (uint64_t i = a->range.first; i <= a->range.last && status == STATUS_OK;
       i += a->range.step) {
    if (videos)
      videos->number = (uint32_t)i;
    status = render_frame(&x, (uint32_t)i);
    if (videos)
      videos->shown.done++;
    if (status != STATUS_OK || signals_pending() || arguments->values[RENDER_DRY_RUN].given)
      break;
  }
  if (status == STATUS_OK && arguments->values[RENDER_DRY_RUN].given)
    report_note("%u frames", pattern_count(&a->range));
  steady_free(&shared->steady);
  vl_world_destroy(shared->world);
  vl_scene_destroy(shared->scene);
  context_close(shared->context);
  return status;
}
