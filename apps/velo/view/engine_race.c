/* view/engine_race.c: --tracer auto in the viewer. The image begins with the scene's tracer.
 * When it has stood still for RACE_LEAST_SAMPLES samples, a race chooses the tracer, as for
 * `velo render` with this camera. If another one wins, its image is rendered beside the shown
 * one, and replaces it when it has less noise. The choice holds for all cameras until the scene
 * is loaded again; coarse images keep the scene's tracer, which is the quickest. */
#include <math.h>

#include "cli/report.h"
#include "render/race_rules.h"
#include "velo/tracer.h"
#include "view/engine_status.h"

/* The samples per pixel of the race's images are not more. */
enum { MAX_RACE_SAMPLES = 32, MAX_LIGHT_PATHS = 1 << 20 };

void engine_set_tracer(vlRenderDef *render, ViewTracer tracer) {
  render->tracer = tracer.tracer;
  render->light_paths = tracer.light_paths;
}

ViewTracer engine_shown(Engine *e) {
  engine_lock(e);
  ViewTracer shown = e->shown;
  engine_unlock(e);
  return shown;
}

/* The bidirectional tracer always has a number of light paths: without one, the command that
 * renders the image again would choose it. */
static ViewTracer tracer_of(const Engine *e, vlTracer tracer, uint32_t light_paths) {
  const vlFilmDef *film = &e->model.job.defs->film;
  uint64_t pixels = (uint64_t)film->width * film->height;
  if (tracer == VL_TRACER_BIDIRECTIONAL && light_paths == VL_AS_MANY_AS_PIXELS)
    light_paths = pixels < MAX_LIGHT_PATHS ? (uint32_t)pixels : MAX_LIGHT_PATHS;
  return (ViewTracer){tracer, light_paths};
}

void engine_race_forget(Engine *e) {
  const vlRenderDef *render = &e->model.job.defs->render;
  e->race.best = e->shown = tracer_of(e, render->tracer, render->light_paths);
  e->race.planned_for = 0;
  e->race.runs = e->race.decided = false;
}

void engine_drop_successor(Engine *e) {
  vl_film_destroy(e->race.successor);
  e->race.successor = NULL;
}

/* The settings by which `velo render` plans its race. */
static RaceKind plan(const Engine *e, uint32_t spp, vlSceneDefs *defs) {
  *defs = *e->model.job.defs;
  defs->render.spp = spp;
  defs->render.time_limit = 0;
  return e->def.lecture ? RACE_NONE : race_kind(defs, e->def.arguments);
}

bool engine_race_due(const Engine *e, uint32_t spp) {
  vlSceneDefs defs;
  uint32_t min = spp < RACE_LEAST_SAMPLES ? spp : RACE_LEAST_SAMPLES;
  if (e->race.planned_for == UINT32_MAX || !e->film || vl_film_spp(e->film) < min)
    return false;
  return plan(e, spp, &defs) != RACE_NONE && race_samples(&defs) > e->race.planned_for;
}

/* ---- the successor ----------------------------------------------------------------------- */

static const vlTracerTrial *find_trial(const Engine *e, const vlTracerChoice *choice,
                                       ViewTracer tracer) {
  for (uint32_t i = 0; i < choice->count; i++) {
    const vlTracerTrial *trial = &choice->trials[i];
    bool camera = trial->tracer == VL_TRACER_VOLPATH &&
                  (tracer.tracer == VL_TRACER_VOLPATH || !tracer.light_paths);
    ViewTracer own = tracer_of(e, trial->tracer, trial->light_paths);
    if (camera || (own.tracer == tracer.tracer && own.light_paths == tracer.light_paths))
      return trial;
  }
  return NULL;
}

/* The samples per pixel at which the successor has at most the error of the film, by the errors
 * of the race; at most as many as the film has. */
static uint32_t enough_samples(const Engine *e, const vlTracerChoice *choice) {
  const vlTracerTrial *now = find_trial(e, choice, e->shown),
                      *next = find_trial(e, choice, e->race.best);
  uint32_t done = vl_film_spp(e->film);
  if (!now || !next)
    return done;
  double error = MAX_RACE_SAMPLES * now->error / done + now->missing,
         n = MAX_RACE_SAMPLES * next->error / error;
  return n >= 1 && n < done ? (uint32_t)ceil(n) : n < 1 ? 1 : done;
}

static bool is_same(ViewTracer a, ViewTracer b) {
  return a.tracer == b.tracer &&
         (a.tracer == VL_TRACER_VOLPATH || a.light_paths == b.light_paths);
}

static void show(Engine *e, vlFilm *film) {
  vl_film_destroy(e->film);
  e->film = film;
  engine_lock(e);
  e->shown = e->race.best;
  engine_unlock(e);
  e->status.noise = NAN;
  e->status.estimated = 0;
}

static void take(Engine *e, RaceKind kind, const vlTracerChoice *choice) {
  vlRenderDef def = e->model.job.defs->render;
  race_take(&def, kind, choice);
  e->race.decided = choice->count > 0;
  e->race.best = tracer_of(e, def.tracer, def.light_paths);
  if (is_same(e->race.best, e->shown)) {
    e->race.best = e->shown;
    return;
  }
  e->race.enough = enough_samples(e, choice);
  e->samples.pixel_seconds = 0; /* of the other tracer */
  e->race.successor = engine_make_film(e);
  if (!e->race.successor)
    show(e, NULL); /* no memory for two: the image begins anew */
}

bool engine_succeed(Engine *e) {
  if (!e->race.successor || vl_film_spp(e->race.successor) < e->race.enough)
    return false;
  show(e, e->race.successor);
  e->race.successor = NULL;
  return true;
}

/* ---- the race ---------------------------------------------------------------------------- */

/* In the log; a page shows the tracer beside the samples, and the line if the image changes. */
static void tell(Engine *e, RaceKind kind, const vlTracerChoice *choice) {
  char line[600];
  if (!choice->count && !race_is_asked(e->def.arguments))
    return;
  race_line(kind, choice, line, sizeof line);
  report_note("%s", line);
  if (!is_same(e->race.best, e->shown))
    engine_post(e, 0, "note", "message %s", line);
}

bool engine_race(Engine *e) {
  vlSceneDefs defs;
  RaceKind kind = plan(e, e->now.spp, &defs);
  vlRenderDef def = defs.render;
  vlTracerChoice choice;
  vlError error = {0};
  def.spp = race_samples(&defs);
  def.cancel = e->interrupt.cancel;
  e->race.runs = true;
  status_tell(e, false);
  double start = monotonic_seconds();
  vlResult result = vl_choose_tracer(e->model.world, &e->now.camera.made, &defs.film, &def,
                                     kind == RACE_TRACERS, &choice, &error);
  e->samples.seconds += monotonic_seconds() - start;
  e->race.runs = false;
  if (result == VL_CANCELLED)
    return false;
  /* more samples may allow a race */
  e->race.planned_for = result != VL_OK || choice.count ? UINT32_MAX : def.spp;
  if (result != VL_OK) {
    report_warning("no race of the tracers: %s", error_text(&error, result));
    return true;
  }
  bool taken = choice.count || kind == RACE_TRACERS;
  if (taken)
    take(e, kind, &choice);
  tell(e, kind, &choice);
  status_tell(e, false);
  return true;
}
