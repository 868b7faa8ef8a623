/* render/film_keeper.c: see film_keeper.h. All workers write a checkpoint between two passes. A
 * thread then waits until the file is on the disk and renames it, while the render
 * continues. */
#include "render/film_keeper.h"

#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "render/attributes.h"
#include "render/progress.h"

enum { EVERY = 30 };
static const double SHARE = 0.005, SHARE_WITH_ERRORS = 0.015;

static void forget(FilmKeeper *k) {
  vl_receipt_destroy(k->receipt);
  vl_image_destroy(k->attributes);
  k->receipt = NULL;
  k->attributes = NULL;
}

int film_keeper_describe(FilmKeeper *k, const FilmPlan *plan, const Job *job, const char *eye) {
  if (!k->path[0])
    return -1;
  Job whole = *job;
  vlSceneDefs defs = plan->whole;
  whole.defs = &defs;
  const ReceiptImage which = {.eye = eye,
                              .samples = defs.render.spp,
                              .outputs = plan->outputs->paths,
                              .output_count = (uint32_t)plan->outputs->count};
  forget(k);
  vlResult result = receipt_make(plan->receipt, &whole, &which, &k->receipt);
  if (result == VL_OK)
    result = attributes_make(&whole, eye, &k->attributes);
  if (result == VL_OK && !plan->receipt->arguments->channels_later)
    result = channels_describe_mode(plan->channels, k->attributes);
  return report_reason(result, k->path, "the film's receipt cannot be made");
}

int film_keeper_start(FilmKeeper *k, const FilmPlan *plan, int view, const Job *job,
                      const char *eye) {
  const FilmClaim *claim = &plan->claims[view];
  memset(k, 0, sizeof *k);
  if (!claim->path[0])
    return -1;
  const OptionValue *every = &plan->receipt->arguments->values[RENDER_CHECKPOINT];
  const vlFilmDef *film = &plan->whole.film;
  text_set(k->path, "%s", claim->path);
  k->lock = claim->lock;
  k->stream = output_is_stream(claim->path);
  k->every = every->given ? every->number : EVERY;
  k->share = every->given ? 0 : film->errors || film->buckets ? SHARE_WITH_ERRORS : SHARE;
  memcpy(k->window, film->crop, sizeof k->window);
  k->last = monotonic_seconds();
  return film_keeper_describe(k, plan, job, eye);
}

static void *end_write(void *user) {
  FilmKeeper *k = user;
  k->result = vl_film_write_end(k->writer, &k->error);
  return NULL;
}

/* Waits until the last checkpoint is on the disk. */
static vlResult join(FilmKeeper *k) {
  if (!k->running)
    return VL_OK;
  pthread_join(k->thread, NULL);
  k->running = false;
  return k->result;
}

static vlResult begin_write(FilmKeeper *k, const vlFilm *film) {
  vlFilmWriteDef def = vl_default_film_write_def();
  def.receipt = k->receipt ? vl_receipt_text(k->receipt) : NULL;
  def.lock = k->lock;
  def.attributes = k->attributes;
  memcpy(def.window, k->window, sizeof def.window);
  k->written = vl_film_spp(film);
  return vl_film_write_begin(film, &def, k->path, &k->writer, &k->error);
}

static void report_checkpoint(FilmKeeper *k, vlResult result) {
  bool failing = result != VL_OK;
  if (failing && !k->failing)
    report_warning("checkpoint: %s; tried again later", error_text(&k->error, result));
  if (!failing && k->failing)
    report_note("the film %s is written again", k->path);
  k->failing = failing;
}

void film_keeper_checkpoint(FilmKeeper *k, const vlFilm *film) {
  double now = monotonic_seconds(), min = k->share > 0 ? k->cost / k->share : 0;
  if (!k->path[0] || k->stream || vl_film_spp(film) == k->written)
    return;
  if (now - k->last < (min > k->every ? min : k->every))
    return;
  bool waited = k->running;
  vlResult result = join(k);
  if (waited)
    report_checkpoint(k, result);
  result = begin_write(k, film);
  if (result == VL_OK) {
    k->running = pthread_create(&k->thread, NULL, end_write, k) == 0;
    if (!k->running) {
      end_write(k);
      result = k->result;
    }
  }
  if (result != VL_OK)
    report_checkpoint(k, result);
  k->last = monotonic_seconds();
  k->cost = k->last - now;
}

double film_keeper_seconds(const FilmKeeper *k, uint64_t bytes) {
  const double bytes_per_second = 3e8; /* assumed until a checkpoint has been measured */
  if (!k->path[0])
    return 0;
  return k->cost > 0 ? k->cost : (double)bytes / bytes_per_second;
}

int film_keeper_finish(FilmKeeper *k, const vlFilm *film) {
  join(k);
  if (!k->path[0])
    return STATUS_OK;
  vlResult result = begin_write(k, film);
  if (result == VL_OK)
    result = vl_film_write_end(k->writer, &k->error);
  return report_finish(&k->error, result, k->path);
}

void film_keeper_free(FilmKeeper *k) {
  join(k);
  forget(k);
}
