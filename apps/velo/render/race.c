/* render/race.c: see race.h. From then on the render has a tracer like any other: receipts and film files name the
 * chosen one, so that --continue, --again and velo film merge need no race. */
#include "render/race.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/kinds.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/animate.h"
#include "render/shard.h"

/* By default there is a race from LEAST_SAMPLES on. It is planned for at most MOST_SAMPLES, so that all longer renders
 * of an image have the same race: a film of 64 samples that is continued to 256 is that of 256. With --time,
 * PATHS_PER_SECOND count as one second. */
enum { LEAST_SAMPLES = 32, MOST_SAMPLES = 64, PATHS_PER_SECOND = 200000 };

static bool is_asked(const Arguments *arguments) {
  const OptionValue *tracer = &arguments->values[RENDER_TRACER];
  return tracer->given && tracer->integer == TRACER_AUTO;
}

int race_check(const Render *render, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  if (!is_asked(arguments)) return -1;
  if (render->resumed.path) return report_usage("--tracer auto: a film is continued with its own tracer");
  if (v[RENDER_LIGHT_PATHS].given)
    return report_usage("--light-paths: --tracer auto chooses their number; give the name of a tracer");
  return -1;
}

/* The number of samples per pixel by which the work of the render is estimated, for the length of the race. */
static uint32_t expected_samples(const vlSceneDefs *defs) {
  const vlRenderDef *render = &defs->render;
  double pixels = (double)defs->film.width * defs->film.height, most = fmin(render->spp, MOST_SAMPLES);
  if (render->time_limit > 0) most = fmin(most, render->time_limit * PATHS_PER_SECOND / pixels);
  return (uint32_t)most;
}

static bool is_default(const Render *render, const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  const vlSceneDefs *whole = &render->film_plan.whole;
  if (render->resumed.path || render->again.receipt) return false;
  if (v[RENDER_LIGHT_PATHS].given || v[RENDER_MERGE_RADIUS].given || whole->build.imitate_pbrt) return false;
  if (expected_samples(whole) < LEAST_SAMPLES) return false;
  bool free_paths = whole->render.light_paths == VL_AS_MANY_AS_PIXELS;
  if (whole->render.tracer == VL_TRACER_BIDIRECTIONAL) return free_paths;
  return whole->tracer_missing && !v[RENDER_TRACER].given;
}

int race_plan(Render *render, const Arguments *arguments) {
  const vlRenderDef *def = &render->job.defs->render;
  bool asked = is_asked(arguments);
  if (asked || is_default(render, arguments))
    render->job.race = def->tracer == VL_TRACER_BIDIRECTIONAL ? RACE_LIGHT_PATHS : RACE_TRACERS;
  return -1;
}

/* ---- the race ---------------------------------------------------------------------------------------------------- */

static bool on_progress(void *user, const vlProgress *now) {
  (void)user, (void)now;
  return !signals_pending();
}

static void trial_name(const vlTracerTrial *trial, char *text, size_t size) {
  bool camera = trial->tracer == VL_TRACER_VOLPATH;
  snprintf(text, size, "%s%s", camera ? "path" : kind_name("tracers", (int)trial->tracer),
           trial->light_paths == VL_AS_MANY_AS_PIXELS || camera ? "" : " with a quarter of the light paths");
}

static void report_json(const vlTracerChoice *choice) {
  Json json = report_json_begin("tracer");
  json_text(&json, "tracer", kind_name("tracers", (int)choice->tracer));
  if (choice->light_paths != VL_AS_MANY_AS_PIXELS) json_integer(&json, "light_paths", choice->light_paths);
  json_begin(&json, "trials", '[');
  for (uint32_t i = 0; i < choice->count; i++) {
    const vlTracerTrial *trial = &choice->trials[i];
    json_begin(&json, NULL, '{');
    json_text(&json, "tracer", kind_name("tracers", (int)trial->tracer));
    if (trial->light_paths != VL_AS_MANY_AS_PIXELS) json_integer(&json, "light_paths", trial->light_paths);
    json_number(&json, "error", trial->error);
    json_number(&json, "missing", trial->missing);
    json_number(&json, "cost", trial->cost);
    json_number(&json, "work", trial->work);
    json_end(&json, '}');
  }
  json_end(&json, ']');
  report_json_end(&json);
}

/* One line: "auto: bidirectional (error x rays: path 1, bidirectional 0.31, ...)". */
static void report(const Job *job, const vlTracerChoice *choice) {
  const char *who = job->race == RACE_TRACERS ? "auto" : "bidirectional";
  char name[80], text[500], chosen[80] = "path";
  size_t n = 0;
  if (report_is_json()) {
    report_json(choice);
    return;
  }
  for (uint32_t i = 0; i < choice->count; i++) {
    const vlTracerTrial *trial = &choice->trials[i];
    trial_name(trial, name, sizeof name);
    if (trial->tracer == choice->tracer && trial->light_paths == choice->light_paths)
      snprintf(chosen, sizeof chosen, "%s", name);
    n += (size_t)snprintf(text + n, sizeof text - n, "%s%s %.2g", i ? ", " : "", name, trial->work);
  }
  if (job->race == RACE_LIGHT_PATHS && choice->tracer == VL_TRACER_VOLPATH)
    snprintf(chosen, sizeof chosen, "no light paths");
  report_note("%s: %s (error x rays: %s)", who, chosen, text);
}

/* The camera and the image of the race. Several images have the race of the first one of all, so that a part of them
 * has the tracer of the whole. */
static vlResult find_image(const Render *render, vlCamera *camera, const vlFilmDef **film, vlError *error) {
  *camera = render->job.camera;
  *film = &render->film_plan.whole.film;
  if (!render->many) return VL_OK;
  const Frame first = frames_first(&render->frames);
  *film = &first.camera->job.defs->film;
  return frames_middle(&render->frames, &first, camera, error);
}

static void take(vlRenderDef *def, RaceKind kind, const vlTracerChoice *choice) {
  def->light_paths = choice->light_paths;
  if (kind == RACE_TRACERS)
    def->tracer = choice->tracer;
  else if (choice->tracer == VL_TRACER_VOLPATH)
    def->light_paths = 0;
}

/* The cameras of several images have jobs of their own. */
static void take_all(Render *render, const vlTracerChoice *choice) {
  Job *job = &render->job;
  take(&job->defs->render, job->race, choice);
  take(&render->film_plan.whole.render, job->race, choice);
  for (uint32_t i = 0; render->many && i < render->frames.camera_count; i++) {
    Job *own = &render->frames.cameras[i].job;
    take(&own->defs->render, job->race, choice);
    own->race = job->race, own->raced = job->raced;
  }
}

/* The frames of an animation have the race of the first one of all. */
static int take_shared(Render *render, const AnimateShared *shared) {
  render->job.race = shared->race;
  render->job.raced = shared->race != RACE_NONE;
  if (shared->race != RACE_NONE) take_all(render, &shared->choice);
  return -1;
}

int race_run(Render *render, const Arguments *arguments) {
  Job *job = &render->job;
  AnimateShared *shared = render->shared;
  if (arguments->values[RENDER_DRY_RUN].given) return -1;
  if (shared && shared->raced) return take_shared(render, shared);
  if (shared) shared->raced = true;
  if (job->race == RACE_NONE) return -1;
  const vlSceneDefs *whole = &render->film_plan.whole;
  vlRenderDef def = whole->render;
  vlTracerChoice choice;
  vlCamera camera;
  const vlFilmDef *film;
  vlError error = {0};
  def.spp = expected_samples(whole);
  def.progress = on_progress, def.progress_user = NULL;
  signals_remember();
  vlResult result = find_image(render, &camera, &film, &error);
  if (result == VL_OK)
    result = vl_choose_tracer(render->world, &camera, film, &def, job->race == RACE_TRACERS, &choice, &error);
  if (result == VL_CANCELLED)
    return report_failure(128 + signals_pending(), "interrupted before the first pass was done; nothing is written");
  if (result != VL_OK) return report_error(&error, result, job->path);
  if (choice.count) report(job, &choice);
  if (!choice.count && is_asked(arguments)) report_note("auto: path (no race: docs/tracers.md says when)");
  if (!choice.count && job->race == RACE_LIGHT_PATHS) return -1;
  job->raced = choice.count > 0 || is_asked(arguments);
  take_all(render, &choice);
  if (shared && job->raced) shared->race = job->race, shared->choice = choice;
  shard_warn(arguments, job->defs->render.tracer);
  return -1;
}
