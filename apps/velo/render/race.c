/* render/race.c: see race.h. After the race the render has a tracer like any other: receipts
 * and film files name the chosen one, so that --continue, --again and velo film merge need no
 * race. */
#include "render/race.h"

#include "cli/kinds.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/animate.h"
#include "render/progress.h"
#include "render/race_rules.h"
#include "render/shard.h"

int race_check(const Render *render, const Arguments *arguments) {
  if (race_is_asked(arguments) && render->resumed.path)
    return report_usage("--tracer auto: a film is continued with its own tracer");
  return race_check_options(arguments);
}

/* The film's file names the tracer that won the race of its first samples. */
static void take_film_tracer(Render *render, const FilmClaim *claim) {
  Job *job = &render->job;
  vlRenderDef *own = &job->defs->render, *whole = &render->film_plan.whole.render;
  job->race = RACE_NONE;
  job->raced = film_claim_take_tracer(claim, own);
  whole->tracer = own->tracer;
  whole->light_paths = own->light_paths;
  for (uint32_t i = 0; render->many && i < render->frames.camera_count; i++) {
    Job *camera = &render->frames.cameras[i].job;
    camera->defs->render.tracer = own->tracer;
    camera->defs->render.light_paths = own->light_paths;
    camera->raced = job->raced;
  }
}

void race_plan(Render *render, const Arguments *arguments) {
  const FilmClaim *claims = render->film_plan.claims;
  bool repeats = render->resumed.path || render->again.receipt;
  if (race_is_asked(arguments) || !repeats)
    render->job.race = race_kind(&render->film_plan.whole, arguments);
  for (int i = 0; i < 2 && render->job.race != RACE_NONE; i++)
    if (claims[i].earlier)
      take_film_tracer(render, &claims[i]);
}

/* ---- the race ---------------------------------------------------------------------------- */

static void put_tracer(Json *json, vlTracer tracer, uint32_t light_paths) {
  json_text(json, "tracer", kind_name("tracers", (int)tracer));
  if (light_paths != VL_AS_MANY_AS_PIXELS)
    json_integer(json, "light_paths", light_paths);
}

static void report_json(const vlTracerChoice *choice) {
  Json *json = report_json_begin("tracer");
  put_tracer(json, choice->tracer, choice->light_paths);
  json_begin(json, "trials", '[');
  for (uint32_t i = 0; i < choice->count; i++) {
    const vlTracerTrial *trial = &choice->trials[i];
    json_begin(json, NULL, '{');
    put_tracer(json, trial->tracer, trial->light_paths);
    json_put(json, "error %g, tail %g, missing %g, cost %g, work %g", trial->error, trial->tail,
             trial->missing, trial->cost, trial->work);
    json_end(json, '}');
  }
  json_end(json, ']');
  report_json_end(json);
}

static void report(const Job *job, const vlTracerChoice *choice) {
  char line[600];
  if (report_is_json()) {
    report_json(choice);
    return;
  }
  race_line(job->race, choice, line, sizeof line);
  report_note("%s", line);
}

/* The camera and the image of the race. Several images have the race of the first one of all,
 * so that a part of them has the tracer of the whole. */
static vlResult find_image(const Render *render, vlCamera *camera, const vlFilmDef **film,
                           vlError *error) {
  *camera = render->job.camera;
  *film = &render->film_plan.whole.film;
  if (!render->many)
    return VL_OK;
  const Frame first = frames_first(&render->frames);
  *film = &first.camera->job.defs->film;
  return frames_middle(&render->frames, &first, camera, error);
}

/* The cameras of several images have jobs of their own. */
static void take_all(Render *render, const vlTracerChoice *choice) {
  Job *job = &render->job;
  race_take(&job->defs->render, job->race, choice);
  race_take(&render->film_plan.whole.render, job->race, choice);
  for (uint32_t i = 0; render->many && i < render->frames.camera_count; i++) {
    Job *own = &render->frames.cameras[i].job;
    race_take(&own->defs->render, job->race, choice);
    own->race = job->race;
    own->raced = job->raced;
  }
}

/* The frames of an animation have the race of the first one of all. */
static void take_shared(Render *render, const AnimateShared *shared) {
  render->job.race = shared->race;
  render->job.raced = shared->race != RACE_NONE;
  if (shared->race != RACE_NONE)
    take_all(render, &shared->choice);
}

int race_run(Render *render, const Arguments *arguments) {
  Job *job = &render->job;
  AnimateShared *shared = render->shared;
  if (arguments->values[RENDER_DRY_RUN].given)
    return -1;
  if (shared && shared->raced) {
    take_shared(render, shared);
    return -1;
  }
  if (shared)
    shared->raced = true;
  if (job->race == RACE_NONE)
    return -1;
  const vlSceneDefs *whole = &render->film_plan.whole;
  vlRenderDef def = whole->render;
  vlTracerChoice choice;
  vlCamera camera;
  const vlFilmDef *film;
  vlError error = {0};
  def.spp = race_samples(whole);
  def.progress = progress_until_signal;
  signals_remember();
  vlResult result = find_image(render, &camera, &film, &error);
  if (result == VL_OK)
    result = vl_choose_tracer(render->world, &camera, film, &def, job->race == RACE_TRACERS,
                              &choice, &error);
  if (result == VL_CANCELLED)
    return report_failure(signals_status(),
                          "interrupted before the first pass was done; nothing is written");
  TRY(report_error(&error, result, job->path));
  if (choice.count || race_is_asked(arguments))
    report(job, &choice);
  if (!choice.count && job->race == RACE_LIGHT_PATHS)
    return -1;
  job->raced = choice.count > 0 || race_is_asked(arguments);
  take_all(render, &choice);
  if (shared && job->raced) {
    shared->race = job->race;
    shared->choice = choice;
  }
  shard_warn(arguments, job->defs->render.tracer);
  return -1;
}
