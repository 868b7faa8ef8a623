/* render/animate.c: see animate.h. */
#include "render/animate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/report.h"
#include "cli/signals.h"
#include "render/job.h"
#include "render/pattern.h"

enum { PATH_SIZE = 4096, MOST_FRAMES = 1000000 };

typedef struct Animation {
  double from, fps;                  /* seconds, frames per second */
  uint32_t count, first, last, step; /* frames of the animation; those that are rendered */
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
  if (a->turns) return a->count = (uint32_t)v[RENDER_TURNTABLE].integer, -1;
  char *end, *last;
  a->from = strtod(span->text, &end);
  const double to = *end == ':' ? strtod(end + 1, &last) : NAN;
  if (end == span->text || *end != ':' || last == end + 1 || *last || !(fabs(a->from) <= 1e6) || !(to > a->from) ||
      !(to <= 1e6))
    return report_usage("--animate \"%s\": must be T0:T1 in seconds, such as 0:4", span->text);
  const double count = ceil((to - a->from) * a->fps - 1e-6);
  if (count > MOST_FRAMES) return report_usage("--animate \"%s\": %.0f frames are too many", span->text, count);
  a->count = count >= 1 ? (uint32_t)count : 1;
  return -1;
}

static int choose_frames(const Arguments *arguments, Animation *a) {
  const OptionValue *range = &arguments->values[RENDER_FRAMES];
  a->first = 0, a->last = a->count - 1, a->step = 1;
  if (!range->given) return -1;
  if (!pattern_range(range->text, &a->first, &a->last, &a->step))
    return report_usage("--frames \"%s\": must be A, A-B, A- or A-B:STEP, numbers from 0", range->text);
  if (a->first >= a->count || (a->last != UINT32_MAX && a->last >= a->count))
    return report_usage("--frames \"%s\": the animation has %u frames, numbered from 0", range->text, a->count);
  if (a->last >= a->count) a->last = a->count - 1;
  return -1;
}

static int check(const Arguments *arguments) {
  static const struct {
    int id;
    const char *name;
  } others[] = {{RENDER_TRAJECTORY, "--trajectory"}, {RENDER_AGAIN, "--again"}, {RENDER_FILM, "--film"},
                {RENDER_CONTINUE, "--continue"},     {RENDER_SHARD, "--shard"}, {RENDER_STEREO, "--stereo"},
                {RENDER_DENOISE, "--denoise"}};
  const OptionValue *v = arguments->values;
  const char *own = v[RENDER_ANIMATE].given ? "--animate" : "--turntable";
  if (v[RENDER_ANIMATE].given && v[RENDER_TURNTABLE].given)
    return report_usage("--animate and --turntable exclude each other");
  if (v[RENDER_ANIMATE].given && v[RENDER_AT].given) return report_usage("--animate and --at exclude each other");
  if (v[RENDER_TURNTABLE].given && v[RENDER_TURN].given)
    return report_usage("--turntable and --turn exclude each other");
  for (size_t i = 0; i < sizeof others / sizeof *others; i++)
    if (v[others[i].id].given) return report_usage("%s does not go with %s", own, others[i].name);
  if (!arguments->text_count) return report_usage("%s: give the files' name with -o, such as -o f%%04d.png", own);
  for (int i = 0; i < arguments->text_count; i++) {
    int status = pattern_check(arguments->texts[i]);
    if (status >= 0) return status;
    if (!pattern_has(arguments->texts[i], 'd'))
      return report_usage("output \"%s\": put %%04d, the frame's number, into the name", arguments->texts[i]);
  }
  return -1;
}

static bool all_exist(const Arguments *arguments) {
  for (int i = 0; i < arguments->text_count; i++)
    if (access(arguments->texts[i], F_OK) != 0) return false;
  return true;
}

/* The command line of one frame: the animation's options become --at or --turn. */
static int render_frame(const Command *command, const Arguments *arguments, const Animation *a, uint32_t frame,
                        AnimateRender *render, AnimateShared *shared) {
  char(*paths)[PATH_SIZE] = malloc(MAX_TEXTS * sizeof *paths), moment[40];
  Arguments one = *arguments;
  const PatternValues values = {.number = frame};
  int status = paths ? -1 : report_error(NULL, VL_ERROR_MEMORY, NULL);
  for (int i = 0; i < one.text_count && status < 0; i++) {
    if (!pattern_expand(arguments->texts[i], &values, paths[i], PATH_SIZE))
      status = report_failure(STATUS_IO, "frame %u: the file's name is too long", frame);
    one.texts[i] = paths[i];
  }
  const double angle = a->turns ? 360.0 * frame / a->count : 0, at = a->from + frame / a->fps;
  OptionValue *set = &one.values[a->turns ? RENDER_TURN : RENDER_AT];
  snprintf(moment, sizeof moment, "%.10g", a->turns ? angle : at);
  *set = (OptionValue){.given = true, .text = moment, .number = a->turns ? angle : at};
  one.values[RENDER_ANIMATE].given = one.values[RENDER_TURNTABLE].given = one.values[RENDER_FPS].given = false;
  one.values[RENDER_FRAMES].given = false;
  const bool skip = one.values[RENDER_SKIP_EXISTING].given;
  one.values[RENDER_SKIP_EXISTING].given = false;
  if (status < 0 && skip && all_exist(&one)) status = STATUS_OK;
  if (status < 0) status = render(command, &one, shared);
  free(paths);
  return status;
}

int animate_run(const Command *command, const Arguments *arguments, AnimateRender *render) {
  Animation a = {0};
  AnimateShared shared = {.exposure = NAN};
  int status = check(arguments);
  if (status < 0) status = read_animation(arguments, &a);
  if (status < 0) status = choose_frames(arguments, &a);
  if (status >= 0) return status;
  shared.still = a.turns;
  for (uint64_t i = a.first; i <= a.last; i += a.step) {
    status = render_frame(command, arguments, &a, (uint32_t)i, render, &shared);
    if (status != STATUS_OK || signals_pending() || arguments->values[RENDER_DRY_RUN].given) break;
  }
  if (status == STATUS_OK && arguments->values[RENDER_DRY_RUN].given)
    report_note("%u frames", (a.last - a.first) / a.step + 1);
  vl_world_destroy(shared.world);
  vl_scene_destroy(shared.scene);
  vl_context_destroy(shared.context);
  return status;
}

/* ---- the camera's turn ------------------------------------------------------------------------------------------- */

/* Sine and cosine of an angle in degrees by their series: the same bits on all machines. */
static void sine_cosine(double degrees, double *sine, double *cosine) {
  const double turn = fmod(degrees, 360), quarters = floor(turn / 90 + 0.5);
  const double x = (turn - 90 * quarters) * (3.14159265358979323846 / 180), xx = x * x;
  double s = 0, c = 0;
  for (int k = 9; k >= 0; k--) {
    s = 1 - s * xx / ((2 * k + 2) * (2 * k + 3));
    c = 1 - c * xx / ((2 * k + 1) * (2 * k + 2));
  }
  s *= x;
  switch (((int)quarters % 4 + 4) % 4) {
    case 0: *sine = s, *cosine = c; break;
    case 1: *sine = c, *cosine = -s; break;
    case 2: *sine = -s, *cosine = -c; break;
    default: *sine = -c, *cosine = s; break;
  }
}

/* p = middle + R (p - middle), R about the unit axis (Rodrigues); a direction has no middle. */
static void turn(const double axis[3], double degrees, const double *middle, double p[3]) {
  double v[3], along = 0, s, c;
  sine_cosine(degrees, &s, &c);
  for (int i = 0; i < 3; i++) v[i] = p[i] - (middle ? middle[i] : 0), along += axis[i] * v[i];
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    p[i] = (middle ? middle[i] : 0) + c * v[i] + s * (axis[j] * v[k] - axis[k] * v[j]) + (1 - c) * along * axis[i];
  }
}

/* Looks at the middle from a distance at which the sphere around the scene's box fits. */
static void stand_back(vlCameraDef *camera, const double low[3], const double high[3], const double middle[3]) {
  double radius = 0, length = 0, sine, cosine;
  sine_cosine(0.5 * camera->fov * (180 / 3.14159265358979323846), &sine, &cosine);
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

void turn_camera(vlCameraDef *camera, const double low[3], const double high[3], bool automatic, const double up[3],
                 double degrees) {
  const double length = sqrt(up[0] * up[0] + up[1] * up[1] + up[2] * up[2]);
  double middle[3], axis[3];
  for (int i = 0; i < 3; i++) {
    axis[i] = length > 0 ? up[i] / length : i == 1;
    middle[i] = low[0] <= high[0] ? 0.5 * (low[i] + high[i]) : 0;
  }
  if (automatic && low[0] <= high[0]) stand_back(camera, low, high, middle);
  if (camera->has_matrix) {
    for (int column = 0; column < 4; column++) {
      double *m = camera->world_from_camera, v[3] = {m[column], m[4 + column], m[8 + column]};
      turn(axis, degrees, column == 3 ? middle : NULL, v);
      m[column] = v[0], m[4 + column] = v[1], m[8 + column] = v[2];
    }
  } else {
    turn(axis, degrees, middle, camera->eye);
    turn(axis, degrees, middle, camera->lookat);
    turn(axis, degrees, NULL, camera->up);
  }
}
