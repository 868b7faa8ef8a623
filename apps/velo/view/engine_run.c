/* view/engine_run.c: what is rendered when; see engine.h. After a change come coarse images
 * (engine_coarse.c), then the film of the whole image, whose samples add up. */
#include "cli/crop.h"
#include "cli/macros.h"
#include "view/engine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "cli/report.h"
#include "render/needs.h"
#include "render/run.h"
#include "view/engine_answers.h"
#include "view/engine_copied.h"
#include "view/engine_sensor.h"
#include "view/view.h"

static const double pass_seconds = 0.2; /* of a pass at the beginning; */
static const double max_pass = 1.0;     /* later ones are longer */
static const double step_seconds = 0.1; /* of a pass where nothing can interrupt it */
/* of the time, for frames, when the image is nearly done */
static const double publish_share = 0.03;
static const double status_seconds = 0.25; /* between two states of the render */

static double read_clock(clockid_t clock) {
  struct timespec now = {0}; /* it stays so where there is no such clock */
  clock_gettime(clock, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double engine_thread_seconds(void) {
  return read_clock(CLOCK_THREAD_CPUTIME_ID);
}

double engine_program_seconds(void) {
  return read_clock(CLOCK_PROCESS_CPUTIME_ID);
}

void engine_lock(Engine *engine) {
  pthread_mutex_lock(&engine->lock);
}

void engine_unlock(Engine *engine) {
  pthread_mutex_unlock(&engine->lock);
}

uint32_t engine_spp(const Engine *e) {
  return e->film ? vl_film_spp(e->film) : 0;
}

static bool must_stop(const Engine *e) {
  return e->quit || e->reload.model || e->tasks.count ||
         e->wanted.generation != e->now.generation;
}

/* Whether the samples that are there are to be shown in another way. */
static bool shows_other(const Engine *e) {
  const Wanted *w = &e->wanted;
  const bool sensor = w->channel == CHANNEL_CAMERA && w->sensor_edits != e->now.sensor_edits;
  return w->channel != e->now.channel || w->denoise != e->now.denoise || sensor;
}

void engine_interrupt(Engine *engine) {
  if (engine->interrupt.first_runs && engine->clients && !engine->quit)
    return;
  if (engine->interrupt.since <= 0)
    engine->interrupt.since = monotonic_seconds();
  vl_cancel_request(engine->interrupt.cancel);
}

/* Whether the render thread must stop what it does. Takes the lock. */
static bool is_interrupted(Engine *engine) {
  engine_lock(engine);
  bool stop = must_stop(engine) || engine->wanted.paused || !engine->clients;
  engine_unlock(engine);
  return stop;
}

vlRenderDef engine_render_def(const Engine *e, uint32_t spp) {
  vlRenderDef def = e->model.job.defs->render;
  def.spp = spp;
  def.first_sample = 0;
  def.time_limit = 0;
  def.noise = 0;
  def.cancel = e->interrupt.cancel;
  return def;
}

/* ---- the whole image --------------------------------------------------------------------- */

vlFilm *engine_make_film(Engine *e) {
  vlFilmDef def = e->model.job.defs->film;
  vlFilm *film = NULL;
  def.errors = true;
  memcpy(def.crop, e->now.crop, sizeof def.crop);
  if (e->now.channel == CHANNEL_CAMERA)
    engine_sensor_film(&def);
  vlResult result = vl_film_create(e->def.context, &def, &film);
  if (result != VL_OK)
    report_reason(result, e->def.path, "no film for the image");
  return film;
}

static void begin_film(Engine *e) {
  e->film = engine_make_film(e);
  engine_lock(e);
  e->shown = e->race.best;
  engine_unlock(e);
}

/* The number of samples of the next pass of a film that shall have `max`. */
static uint32_t pass_samples(const Engine *e, const vlFilm *film, uint32_t max) {
  double pixels = engine_pixels(e),
         seconds = e->def.stepwise ? step_seconds
                                   : fmin(max_pass, pass_seconds + 0.25 * e->samples.seconds),
         n = seconds / (e->samples.pixel_seconds * pixels + 1e-9);
  uint32_t done = vl_film_spp(film), left = max - done;
  n = n < 1 ? 1 : n > 256 ? 256 : floor(n);
  if (done == 0)
    n = 1;
  return n < left ? (uint32_t)n : left;
}

static void publish_if_due(Engine *e) {
  if (engine_warp_stays(e) && e->now.channel == 0)
    return;
  double now = monotonic_seconds(), share = 0.25 / (1 + 2 * e->samples.seconds);
  bool last = vl_film_spp(e->film) >= e->now.spp;
  if (share < publish_share)
    share = publish_share;
  if (!last && vl_film_spp(e->film) > 1 &&
      now - e->frames.published < e->frames.publish_seconds / share)
    return;
  if (e->now.channel == CHANNEL_ERROR)
    engine_render_error(e);
  else
    engine_publish_film(e, e->film, 1, UINT32_MAX);
}

static PartOfFilm whole_film(Engine *e, const vlFilm *film) {
  PartOfFilm part = {.engine = e, .film = film, .camera = &e->now.camera.made, .scale = 1};
  memcpy(part.crop, e->now.crop, sizeof part.crop);
  return part;
}

static bool denoise_due(const Engine *e) {
  return !e->race.successor && engine_denoise_due(e, engine_spp(e));
}

/* Sends the film's image, if it is not about to be denoised. A denoised one stays until the
 * next. */
static void show_film(Engine *e) {
  bool stays = e->now.denoise && e->preview.spp && !e->now.channel;
  if (e->interrupt.first_runs || (!stays && !denoise_due(e)))
    publish_if_due(e);
}

/* False: interrupted. */
static bool denoise_film(Engine *e) {
  PartOfFilm part = whole_film(e, e->film);
  bool done = engine_denoise(&part, crop_height(part.crop));
  engine_free_part(&part);
  if (!done && e->preview.failed)
    publish_if_due(e);
  return done || e->preview.failed;
}

static void tell_if_due(Engine *e, bool always) {
  double now = monotonic_seconds();
  if (!always && now - e->status.sent < status_seconds)
    return;
  e->status.sent = now;
  status_tell(e, always);
}

/* After the work: a change does not wait for an estimate of the error. */
static void tell_end(Engine *e) {
  engine_lock(e);
  bool changed = must_stop(e) || shows_other(e);
  engine_unlock(e);
  tell_if_due(e, !changed);
}

/* Whether samples are missing, or the race, or the image of the tracer that won it. spp: the
 * samples per pixel that are wanted. */
static bool is_unfinished(const Engine *e, uint32_t spp) {
  return !e->samples.failed && (!e->film || vl_film_spp(e->film) < spp || e->race.successor ||
                                engine_race_due(e, spp));
}

/* Once for each image, in the log and on the pages, also on those that come later. */
static void report_left_out(Engine *e, const vlRenderStats *stats) {
  char text[160];
  if (!stats->not_finite || e->last.left_out)
    return;
  not_finite_text(stats, text, sizeof text);
  report_warning("%s", text);
  Json *json = json_text_begin("note");
  if (!json)
    return;
  json_text(json, "message", text);
  json_text_keep(json, e, &e->last.left_out);
}

/* Adds samples to the film, or to its successor. False: interrupted, or it failed. */
static bool render_pass(Engine *e) {
  vlFilm *film = e->race.successor ? e->race.successor : e->film;
  const uint32_t more = pass_samples(e, film, e->race.successor ? e->race.enough : e->now.spp);
  vlRenderDef render = engine_render_def(e, vl_film_spp(film) + more);
  vlError error = {0};
  vlRenderStats stats = {0};
  engine_set_tracer(&render, e->race.best);
  PartOfFilm part = whole_film(e, film);
  const bool first = vl_film_spp(film) == 0;
  part.denoise = first && !e->interrupt.first_runs && engine_denoise_due(e, 1);
  if (first && !e->race.successor && e->now.channel == 0)
    engine_render_in_parts(
        &part, &render,
        e->samples.pixel_seconds > 0 ? e->samples.pixel_seconds : e->coarse.pixel_seconds);
  double start = monotonic_seconds();
  vlResult result =
      vl_render(e->model.world, &e->now.camera.made, film, &render, &stats, &error);
  double seconds = monotonic_seconds() - start;
  if (part.clean && result == VL_OK) /* parts of it are shown */
    engine_denoise(&part, crop_height(part.crop));
  engine_free_part(&part);
  if (result == VL_CANCELLED) {
    if (first)
      vl_film_clear(film); /* some rows may have samples */
    return false;
  }
  if (result != VL_OK) {
    status_error(e, &error, result);
    e->samples.failed = true; /* until the next change */
    return false;
  }
  e->samples.seconds += seconds;
  e->samples.paths += stats.paths;
  report_left_out(e, &stats);
  engine_note_speed(&e->samples.pixel_seconds, stats.camera_rays, seconds);
  return true;
}

/* One pass, or the race. False: interrupted, or nothing is left to do. */
static bool render_film(Engine *e) {
  if (!e->film)
    begin_film(e);
  if (!e->film || (!e->interrupt.first_runs && is_interrupted(e)))
    return false;
  if (!e->interrupt.first_runs && denoise_due(e))
    return denoise_film(e);
  if (!is_unfinished(e, e->now.spp))
    return false;
  if (!e->race.successor && engine_race_due(e, e->now.spp))
    return engine_race(e);
  if (!render_pass(e))
    return false;
  if (engine_succeed(e)) {
    e->frames.published = e->status.sent = 0; /* both are due */
    e->preview.spp = 0;
  }
  if (!e->race.successor)
    show_film(e);
  tell_if_due(e, !is_unfinished(e, e->now.spp));
  return true;
}

/* ---- the work ---------------------------------------------------------------------------- */

/* Takes over what is wanted. Returns whether the image begins anew. */
static bool take_wanted(Engine *e) {
  engine_lock(e);
  bool anew = e->wanted.generation != e->now.generation;
  bool channel = e->wanted.channel != e->now.channel,
       denoise = e->wanted.denoise != e->now.denoise,
       sensor = e->wanted.sensor_edits != e->now.sensor_edits;
  e->now = e->wanted;
  if (!e->quit && !e->reload.model)
    vl_cancel_clear(e->interrupt.cancel);
  e->interrupt.since = 0;
  e->interrupt.first_runs = anew || channel;
  if (anew) {
    free(e->last.left_out);
    e->last.left_out = NULL;
  }
  engine_unlock(e);
  if (denoise)
    e->preview.spp = 0;
  if (!anew)
    return engine_sensor_changed(e, sensor && !channel) || channel || denoise;
  e->samples.failed = false;
  vl_film_destroy(e->film);
  e->film = NULL;
  engine_drop_successor(e);
  engine_forget_coarser(e);
  engine_forget_denoised(e);
  e->samples.paths = 0;
  e->samples.seconds = 0;
  e->status.noise = NAN;
  e->status.estimated = 0;
  return true;
}

/* Whether there is something to do; the caller holds the lock. */
static bool has_work(const Engine *e) {
  const Wanted *w = &e->wanted;
  bool samples = engine_is_of_film(w->channel), other_channel = shows_other(e);
  bool unfinished = samples && (is_unfinished(e, w->spp) || denoise_due(e)),
       changed = other_channel || w->spp != e->now.spp;
  return must_stop(e) ||
         (e->clients && ((!w->paused && (unfinished || changed)) || other_channel));
}

/* Waits until there is something to do. False: the end. */
static bool wait_for_work(Engine *e) {
  engine_lock(e);
  if (e->interrupt.since > 0)
    e->interrupt.longest = fmax(e->interrupt.longest, monotonic_seconds() - e->interrupt.since);
  e->interrupt.since = 0;
  while (!has_work(e))
    pthread_cond_wait(&e->wake, &e->lock);
  bool quit = e->quit;
  engine_unlock(e);
  return !quit;
}

static void answer_tasks(Engine *e) {
  static ViewMessage task; /* the render thread alone uses it */
  for (;;) {
    engine_lock(e);
    bool any = engine_take_task(e, &e->tasks, &task);
    engine_unlock(e);
    if (!any)
      return;
    task.type->answer(e, &task);
  }
}

/* After the first image: from now on, changes stop what is rendered. Returns whether there was
 * one meanwhile. */
static bool end_first(Engine *e) {
  engine_lock(e);
  e->interrupt.first_runs = false;
  bool changed = must_stop(e);
  engine_unlock(e);
  return changed;
}

/* Takes up what is asked for. */
static void begin_work(Engine *e) {
  engine_swap_model(e);
  answer_tasks(e);
  if (!take_wanted(e))
    return;
  e->coarse.next = 0;
  const bool error = e->now.channel == CHANNEL_ERROR,
             of_film = engine_is_of_film(e->now.channel);
  if (error)
    engine_render_error(e);
  else if (!of_film || !e->film)
    engine_coarse_begin(e);
  else if (vl_film_spp(e->film)) {
    e->frames.published = 0;
    show_film(e);
  }
  if (!e->coarse.next && (e->film || error || !of_film))
    end_first(e);
}

/* The next coarse image, or the next samples. False: interrupted, or nothing is left to do. */
static bool work(Engine *e) {
  bool samples = engine_is_of_film(e->now.channel),
       done = e->coarse.next ? engine_coarse_next(e)
                             : samples && !e->samples.failed && render_film(e);
  bool changed = e->interrupt.first_runs && end_first(e);
  if (done && !changed && !e->coarse.next)
    engine_warp_prepare(e);
  return done && !changed;
}

void *engine_render(void *user) {
  Engine *e = user;
  while (wait_for_work(e)) {
    begin_work(e);
    while (work(e)) {
    }
    tell_end(e);
  }
  return NULL;
}

bool engine_work(Engine *e) {
  if (engine_load_choice(e) || engine_answer_question(e) || engine_trace_next(e))
    return true;
  if (!has_work(e))
    return false;
  begin_work(e);
  if (!work(e))
    tell_end(e);
  return true;
}

int engine_take_model(Engine *e) {
  const vlSceneDefs *defs = e->model.job.defs;
  Wanted *w = &e->wanted;
  vlError error = {0};
  vlResult result =
      camera_take(&defs->camera, &e->model.job.camera, e->model.lookat, &w->camera, &error);
  TRY(report_error(&error, result, e->def.path));
  e->scene_camera = w->camera;
  w->mark = w->camera.made;
  memcpy(w->crop, defs->film.crop, sizeof w->crop);
  w->spp = defs->render.spp;
  w->generation++;
  engine_race_forget(e);
  e->history.cameras[0] = w->camera;
  e->history.count = 1;
  e->history.at = 0;
  return -1;
}

/* Reports options that have no effect. The page can open the lens; a race may take any
 * tracer. */
static int check_options(const Engine *e) {
  const Arguments *arguments = e->def.arguments;
  const Needs needs = {.options = view_options,
                       .values = arguments->values,
                       .arguments = arguments,
                       .scene = e->model.scene,
                       .opening = &e->model.opening,
                       .job = &e->model.job,
                       .edited = true};
  TRY(needs_check_scene(&needs));
  return needs.job->race == RACE_TRACERS ? -1 : needs_check_tracer(&needs, e->model.world);
}

int engine_create(const EngineDef *def, Engine **result) {
  Engine *engine = calloc(1, sizeof *engine);
  *result = engine;
  if (!engine)
    return report_no_memory();
  engine->def = *def;
  pthread_mutex_init(&engine->lock, NULL);
  pthread_cond_init(&engine->wake, NULL);
  pthread_rwlock_init(&engine->model_lock, NULL);
  bool made = vl_cancel_create(def->context, &engine->interrupt.cancel) == VL_OK &&
              vl_cancel_create(def->context, &engine->end) == VL_OK &&
              vl_cancel_create(def->context, &engine->traces.stop) == VL_OK;
  if (!made)
    return report_no_memory();
  TRY(model_load(def->context, def->path, def->arguments, NULL, NULL, NULL, &engine->model,
                 &engine->reload.files));
  TRY(check_options(engine));
  TRY(engine_take_model(engine));
  engine->wanted.sensor = sensor_default();
  engine->wanted.paused = def->lecture; /* until a page chooses a scene */
  engine->wanted.denoise = !def->lecture && !def->stepwise;
  return engine_sensor_begin(engine);
}

ServerCalls engine_calls(Engine *engine) {
  return (ServerCalls){.user = engine,
                       .greet = engine_greet,
                       .types = message_types,
                       .message = engine_message,
                       .clients = engine_clients};
}

void engine_attach(Engine *engine, Server *server) {
  engine->server = server;
}

void engine_destroy(Engine *engine) {
  if (!engine)
    return;
  vl_film_destroy(engine->film);
  vl_film_destroy(engine->race.successor);
  vl_image_destroy(engine->coarse.last);
  engine_warp_forget(engine);
  engine_sensor_forget(engine);
  vl_image_destroy(engine->preview.features);
  model_free(&engine->model);
  model_destroy(engine->reload.model);
  file_list_free(&engine->reload.files);
  free(engine->last.status);
  free(engine->last.exposure);
  free(engine->last.left_out);
  copied_free(engine->verify.copied);
  vl_cancel_destroy(engine->interrupt.cancel);
  vl_cancel_destroy(engine->end);
  vl_cancel_destroy(engine->traces.stop);
  pthread_rwlock_destroy(&engine->model_lock);
  pthread_cond_destroy(&engine->wake);
  pthread_mutex_destroy(&engine->lock);
  free(engine);
}
