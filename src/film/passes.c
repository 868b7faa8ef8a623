/* film/passes.c: creation of films; passes; merging of films. */
#include "base/cookie.h"
#include "base/free.h"
#include "base/text.h"
#include "color/sensor.h"
#include "film/sums.h"
#include "film/white.h"
#include "schema/schema.h"
#include "velo/film.h"

enum { SIZE_MAX_PIXELS = 65536, MAX_BUCKETS = 1000 };

vlFilmDef vl_coarse_film_def(const vlFilmDef *def, uint32_t factor) {
  vlFilmDef coarse = *def;
  if (factor == 0)
    factor = 1;
  coarse.width = (def->width + factor - 1) / factor;
  coarse.height = (def->height + factor - 1) / factor;
  for (int i = 0; i < 4; i++)
    coarse.crop[i] = (def->crop[i] + (i < 2 ? 0 : factor - 1)) / factor;
  coarse.errors = false;
  coarse.buckets = 0;
  return coarse;
}

/* Sets the sensor's response curves and matrix, its name (a static string), and pbrt's default
 * white balance for it. */
static vlResult set_sensor(vlFilm *film) {
  vlFilmDef *def = &film->def;
  if (!def->sensor || vl_text_is(def->sensor, vl_sensor_name(0))) {
    def->sensor = NULL;
    return VL_OK;
  }
  const vlSensorCurves *curves = vl_sensor_find(def->sensor);
  if (!curves)
    return VL_ERROR_ARGUMENT;
  film->sensor = vl_alloc_array(film->context, 1, sizeof *film->sensor);
  if (!film->sensor)
    return VL_ERROR_MEMORY;
  def->sensor = curves->name;
  if (def->white_balance == 0.0)
    def->white_balance = 6500.0;
  double xyz[9];
  vl_sensor_make(curves, def->white_balance, def->space, film->sensor->curves, xyz);
  for (int i = 0; i < 9; i++)
    film->sensor->xyz[i] = (float)xyz[i];
  return VL_OK;
}

vlResult vl_film_create(vlContext *context, const vlFilmDef *def, vlFilm **film) {
  if (!film)
    return VL_ERROR_ARGUMENT;
  *film = NULL;
  if (!context || !def || def->cookie != VL_COOKIE_FILM)
    return VL_ERROR_ARGUMENT;
  char wrong[VL_GIVEN_MESSAGE];
  if (!vl_choices_check(VL_SETTING_RENDER, offsetof(vlSceneDefs, film), sizeof *def, def,
                        wrong))
    return VL_ERROR_ARGUMENT;
  const uint32_t *c = def->crop;
  if (def->white_balance != 0.0 && !(def->white_balance >= 1000.0 && def->white_balance <= 1e5))
    return VL_ERROR_ARGUMENT;
  if (!(def->max_component >= 0.0f))
    return VL_ERROR_ARGUMENT;
  if (def->buckets && (def->buckets > MAX_BUCKETS || !(def->lambda_min < def->lambda_max) ||
                       !(def->lambda_min >= VL_LAMBDA_MIN &&
                         def->lambda_max <= VL_LAMBDA_MIN + VL_LAMBDA_COUNT - 1)))
    return VL_ERROR_ARGUMENT;
  if (def->width == 0 || def->height == 0 || def->width > SIZE_MAX_PIXELS ||
      def->height > SIZE_MAX_PIXELS)
    return VL_ERROR_ARGUMENT;
  if (!vl_crop_fits(c, def->width, def->height))
    return VL_ERROR_ARGUMENT;
  vlFilm *made = vl_alloc_zero(context, 1, sizeof *made);
  if (!made)
    return VL_ERROR_MEMORY;
  made->context = context;
  made->def = *def;
  made->width = c[2] - c[0];
  made->height = c[3] - c[1];
  made->pass = 1;
  vlResult result = set_sensor(made);
  if (result != VL_OK) {
    vl_free(context, made);
    return result;
  }
  if (made->def.white_balance > 0.0)
    vl_white_balance(made->def.white_balance, def->space, made->balance);
  result = vl_filter_compile(context, &def->filter, &made->filter);
  if (result != VL_OK) {
    VL_FREE(context, made->sensor, made);
    return result;
  }
  *film = made;
  return VL_OK;
}

uint64_t vl_film_memory(const vlFilmDef *def) {
  uint64_t pixels = (uint64_t)(def->crop[2] - def->crop[0]) * (def->crop[3] - def->crop[1]);
  uint64_t each = 2 * sizeof(vlFilmPixel) + sizeof(uint32_t);
  if (def->errors)
    each += 2 * sizeof(vlFilmMoments);
  if (def->buckets)
    each +=
        2 * (uint64_t)def->buckets * (sizeof(vlInt128) + sizeof(int64_t)) + sizeof(uint32_t);
  return pixels * each;
}

void vl_film_destroy(vlFilm *film) {
  if (!film)
    return;
  vlContext *context = film->context;
  VL_FREE(context, film->front, film->back, film->stamp, film->block_spp, film->compared,
          film->scratch, film->sensor);
  for (int i = 0; i < 2; i++)
    vl_free(context, film->moments[i]);
  vl_film_spectrum_free(film);
  vl_filter_free(context, &film->filter);
  vl_free(context, film);
}

uint32_t vl_film_spp(const vlFilm *film) {
  return film->spp;
}
void vl_film_set_spp(vlFilm *film, uint32_t spp) {
  film->spp = spp;
  vl_free(film->context, film->block_spp);
  film->block_spp = NULL;
}
const char *const vl_own_words[VL_OWN_KINDS] = {"camera", "sampler", "tracer"};

vlOwnKind vl_film_own_differs(const vlFilmOwn *a, const vlFilmOwn *b) {
  int kind = 0;
  while (kind < VL_OWN_KINDS && vl_text_is(a->name[kind], b->name[kind]))
    kind++;
  return (vlOwnKind)kind;
}

const char *vl_film_own(const vlFilm *film, vlOwnKind kind) {
  if (!film || (unsigned)kind >= VL_OWN_KINDS || !film->spp)
    return NULL;
  const char *name = film->sequence.own.name[kind];
  return *name ? name : NULL;
}

vlFilmSequence vl_film_sequence(const vlFilm *film) {
  return film->spp || film->sequence.uneven ? film->sequence : (vlFilmSequence){0};
}
void vl_film_set_sequence(vlFilm *film, vlFilmSequence sequence) {
  film->sequence = sequence;
}
const vlFilmDef *vl_film_def(const vlFilm *film) {
  return &film->def;
}
const float *vl_film_balance(const vlFilm *film) {
  return film->def.white_balance > 0.0 ? film->balance : NULL;
}
const vlFilmSensor *vl_film_sensor(const vlFilm *film) {
  return film->sensor;
}
const vlFilterTable *vl_film_filter(const vlFilm *film) {
  return &film->filter;
}

vlResult vl_film_begin_pass(vlFilm *film) {
  if (film->in_pass)
    return VL_ERROR_ARGUMENT;
  size_t count = vl_film_pixels(film);
  if (!film->stamp)
    film->stamp = vl_alloc_zero(film->context, count, sizeof *film->stamp);
  if (!film->back)
    film->back = vl_alloc_array(film->context, count, sizeof *film->back);
  for (int i = 0; i < 2 && film->def.errors; i++)
    if (!film->moments[i] &&
        !(film->moments[i] = vl_alloc_array(film->context, count, sizeof(vlFilmMoments))))
      return VL_ERROR_MEMORY;
  if (!film->stamp || !film->back || !vl_film_spectrum_begin(film))
    return VL_ERROR_MEMORY;
  film->in_pass = true;
  film->part = vl_first_part(film->end);
  film->pass_end = film->end;
  film->part_moves = false;
  return VL_OK;
}

void vl_film_set_pass_samples(vlFilm *film, uint32_t first, uint32_t end) {
  film->part = vl_first_part(end);
  film->part_moves = film->part != vl_first_part(first);
  film->pass_end = end > film->end ? end : film->end;
}

/* Ends the running pass and advances the pass number. If the number wraps around, all stamps
 * are cleared; otherwise old stamps would count as current. */
static void next_pass(vlFilm *film) {
  film->in_pass = false;
  if (++film->pass == 0) {
    memset(film->stamp, 0, vl_film_pixels(film) * sizeof *film->stamp);
    if (film->spectrum.stamp)
      memset(film->spectrum.stamp, 0, vl_film_pixels(film) * sizeof *film->spectrum.stamp);
    film->pass = 1;
  }
}

void vl_film_commit_pass(vlFilm *film) {
  if (!film->in_pass)
    return;
  size_t count = vl_film_pixels(film);
  static const vlFilmPixel zero = {{0, 0, 0}, 0, 0};
  for (size_t i = 0; i < count; i++)
    if (film->stamp[i] != film->pass) {
      film->back[i] = film->front ? film->front[i] : zero;
      if (film->def.errors)
        film->moments[1][i] = vl_film_front_moments(film, i);
    }
  vlFilmMoments *moments = film->moments[0];
  film->moments[0] = film->moments[1];
  film->moments[1] = moments;
  vlFilmPixel *front = film->front;
  film->front = film->back;
  film->back = front;
  vl_film_spectrum_commit(film);
  film->end = film->pass_end;
  next_pass(film);
}

void vl_film_abandon_pass(vlFilm *film) {
  if (film->in_pass)
    next_pass(film);
}

/* Clears the film. If there are two sets of sums, one of them is freed. The next pass then
 * begins as in a new film. */
void vl_film_clear(vlFilm *film) {
  if (!film || film->in_pass)
    return;
  vl_film_set_spp(film, 0);
  vl_film_forget_compared(film);
  film->sequence = (vlFilmSequence){0};
  film->end = 0;
  if (film->front && film->back) {
    vl_free(film->context, film->front);
  } else if (film->front) {
    film->back = film->front;
  }
  film->front = NULL;
  vl_film_spectrum_clear(film);
}

void *vl_film_scratch(vlFilm *film, size_t size) {
  if (film->scratch_size != size) {
    vl_free(film->context, film->scratch);
    film->scratch = vl_alloc_zero(film->context, size, 1);
    film->scratch_size = film->scratch ? size : 0;
  }
  return film->scratch;
}
