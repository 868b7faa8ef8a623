/* render/choose.c: vl_choose_tracer: a short race of tracers. Each renders two coarse images
 * with different seeds. The difference of the two is its error, and the rays are its cost:
 * their product is the error for the same time.
 *
 * The pixels of the coarse images are far apart, but each has the size of a pixel of the image
 * (vlPilot.spread). Texture and edges inside of a coarse pixel would be the same noise for all
 * tracers, and the cheapest would win. */
#include "render/choose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/context.h"
#include "base/error.h"
#include "base/free.h"
#include "base/unset.h"
#include "math/double3.h"
#include "render/block.h"
#include "render/support.h"
#include "velo/camera.h"
#include "velo/schema.h"
#include "velo/tracer.h"

enum {
  MIN_SAMPLES = 8, /* per pixel of a coarse image */
  MAX_SAMPLES = 32,
  MIN_PIXELS = 192,  /* of a coarse image; with fewer there is no race */
  MANY_PIXELS = 700, /* with more, samples are added instead of pixels */
  BLOCK = 4,         /* side of the blocks that are compared with merging, pixels */
  AROUND = 2,        /* neighbours that say how bright a pixel is: pixels on each side */
  QUARTER = 4,       /* pixels per light path */
  MAX_LIGHT_PATHS = 1 << 20,
  FEW_FACES = 4096,
  TAIL_PATHS = 4 /* light paths per pixel and sample for the tail: few of those from the sun
                    enter a room */
};
/* The paths of all trials: at most this share of the render's, and at most MAX_PATHS. */
static const double SHARE = 0.03, MAX_PATHS = 1 << 19;
/* The work of another tracer must be below that of VL_TRACER_VOLPATH times SURE, that of a
 * biased one below that of the best unbiased one times BIASED. */
static const double SURE = 0.85, BIASED = 2.0 / 3.0;
/* The squared relative difference that what merging blurs may make, by its wide radius in the
 * coarse images. Seen: up to 0.001, where a thin object stands on a ground (docs/tracers.md);
 * light that is missing makes more. */
static const double BLUR = 0.002;
static const uint32_t seeds[2] = {0x72616365u, 0x61676169u}, tail_seed = 0x7461696cu;
/* A sample is rare if it alone makes a coarse pixel RARE times as bright as it should be
 * (tails.h). DOUBT: standard errors that are taken from the tail. */
static const double RARE = 4, DOUBT = 2;

/* Rays are cheap in small worlds, and the rest of the work counts more. */
typedef enum WorldSize {
  MANY,
  FEW,         /* fewer than FEW_FACES */
  BRUTE_FORCE, /* few enough for world/accel/brute_force.h */
  WORLD_SIZES
} WorldSize;

/* A tracer of the race. */
typedef struct Row {
  vlTracer tracer;
  uint32_t divisor; /* pixels per light path; 0: no light paths */
  /* Mean time of a ray, relative to a ray of VL_TRACER_VOLPATH, by the size of the world:
   * geometric means over 13 scenes (docs/performance.md). */
  double ray[WORLD_SIZES];
  double path; /* expected cost of a sample, relative to a sample of VL_TRACER_VOLPATH; for the
                  length of the race */
} Row;
static const Row rows[VL_MAX_TRIALS] = {
    {VL_TRACER_VOLPATH, 0, {1.0, 1.0, 1.0}, 1.0},
    {VL_TRACER_BIDIRECTIONAL, 1, {1.2, 1.4, 1.7}, 3.0},
    {VL_TRACER_BIDIRECTIONAL, QUARTER, {1.2, 1.4, 1.7}, 2.0},
    {VL_TRACER_MERGING, 1, {1.2, 1.4, 1.7}, 4.0},
};
/* Time of one unit of vlTraceBatch.merge_work, relative to a ray. */
static const double photon[WORLD_SIZES] = {0.015, 0.015, 0.022};

typedef struct Race {
  const vlWorld *world;
  vlFilmDef film;
  vlCamera camera;
  vlRenderDef def;
  uint32_t factor; /* side of a coarse image's pixel, pixels */
  uint32_t count;  /* of trials */
  WorldSize size;
  vlImage *images[VL_MAX_TRIALS][2];
  size_t pixels;
  double *base;   /* by pixel and channel: what a relative error is relative to */
  double *sorted; /* room for 3 numbers per pixel, to be sorted */
  double min;     /* added to base^2, so that black pixels do not count too much */
} Race;

/* ---- the size of the race ---------------------------------------------------------------- */

/* Whether paths that merge can find light that others do not: through or by smooth surfaces. */
static bool has_smooth(const vlWorld *world) {
  for (size_t i = 0; i < world->materials.count; i++)
    if (world->materials.items[i].smooth != VL_SMOOTH_NEVER ||
        world->materials.items[i].principled)
      return true;
  return false;
}

static WorldSize size_of(const vlWorld *world) {
  if (world->accel.brute_force)
    return BRUTE_FORCE;
  uint64_t faces = 0;
  for (size_t i = 0; i < world->shapes.count; i++)
    faces += world->shapes.items[i].faces;
  return faces < FEW_FACES ? FEW : MANY;
}

/* Chooses the number of samples and the size of the coarse images. False: the race would be too
 * short. */
static bool choose_size(Race *race, const vlFilmDef *film) {
  const double pixels = (double)film->width * film->height;
  double each = 0; /* cost of a sample in both images of all trials */
  for (uint32_t i = 0; i < race->count; i++)
    each += 2 * rows[i].path;
  const double samples = fmin(SHARE * pixels * race->def.spp, MAX_PATHS) / each;
  double wanted = samples / MIN_SAMPLES; /* pixels of a coarse image */
  race->def.spp = MIN_SAMPLES;
  for (; wanted > MANY_PIXELS && race->def.spp < MAX_SAMPLES; wanted /= 2)
    race->def.spp *= 2;
  if (wanted < MIN_PIXELS)
    return false;
  race->factor = 1;
  while (race->factor < VL_MAX_COARSE &&
         pixels / ((double)race->factor * race->factor) > wanted)
    race->factor++;
  return true;
}

/* Whether all tracers of the race render this world and film (support.c). Without lights there
 * is nothing to race for. */
static vlResult can_race(const vlWorld *world, const vlCamera *camera, const vlFilmDef *film,
                         bool *can) {
  uint32_t tracers = 0;
  const char *lack;
  for (uint32_t i = 0; i < VL_MAX_TRIALS; i++)
    tracers |= VL_TRACER_BIT(rows[i].tracer);
  vlResult result = vl_tracers_lack(world, camera, film, tracers, &lack);
  *can = result == VL_OK && world->lights.count > 0 && !lack;
  return result;
}

/* Whether there is something in the world that a tracer looks past: what the scene shows by
 * this tracer, none of the race's tracers would show. */
static bool looks_past(const vlWorld *world, vlTracer tracer) {
  const vlKindFamily *tracers = vl_kind_family_find("tracers");
  return (world->media.count > 0 || world->has_subsurface) &&
         (uint32_t)tracer < tracers->kind_count &&
         tracers->rows[tracer]->traits & VL_TRACER_TRAIT_NO_MEDIA;
}

/* ---- running ----------------------------------------------------------------------------- */

/* Renders a coarse image. film_def: that of the race, but for its max_component. */
static vlResult render_coarse(const Race *race, const vlFilmDef *film_def, vlRenderDef *def,
                              vlPilot *pilot, vlRenderStats *stats, vlImage **image,
                              vlError *error) {
  vlFilm *film = NULL;
  pilot->spread = 1.0f / (float)race->factor;
  def->own_tracer = NULL;
  vlResult result = vl_film_create(race->world->context, film_def, &film);
  if (result != VL_OK)
    return vl_fail(error, result, "the race of the tracers has no film");
  result = vl_render_pilot(race->world, &race->camera, film, def, pilot, stats, error);
  if (result == VL_OK && vl_film_develop(film, NULL, image) != VL_OK)
    result = vl_fail_memory(error);
  vl_film_destroy(film);
  return result;
}

/* Renders one of a trial's two images, and adds up its cost. */
static vlResult run_once(Race *race, uint32_t i, uint32_t half, vlTracerTrial *trial,
                         vlError *error) {
  const Row *row = &rows[i];
  vlRenderStats stats;
  vlPilot pilot = {.pass_seed = seeds[0]};
  vlRenderDef def = race->def;
  def.seed = seeds[half];
  def.tracer = row->tracer;
  def.light_paths =
      row->divisor > 1 ? (uint32_t)(race->pixels / row->divisor) : VL_AS_MANY_AS_PIXELS;
  VL_TRY(render_coarse(race, &race->film, &def, &pilot, &stats, &race->images[i][half], error));
  const double rays = (double)(stats.paths + stats.bounce_rays + stats.shadow_rays);
  trial->cost += row->ray[race->size] * rays;
  trial->cost += photon[race->size] * (double)pilot.merge_work;
  return VL_OK;
}

/* ---- errors ------------------------------------------------------------------------------ */

static double value_at(const Race *race, const vlImage *image, size_t pixel, uint32_t channel) {
  uint32_t width = race->film.width;
  return (double)vl_image_get(image, (uint32_t)(pixel % width), (uint32_t)(pixel / width),
                              channel);
}

/* Mean of n values without the `low` smallest and the `high` largest. */
static double trimmed_mean(double *values, size_t n, size_t low, size_t high) {
  double sum = 0;
  if (low + high >= n)
    return 0;
  qsort(values, n, sizeof *values, vl_by_value);
  for (size_t i = low; i < n - high; i++)
    sum += values[i];
  return sum / (double)(n - low - high);
}

/* The mean of trial t's two images in the square of `around` pixels on each side of pixel (x,
 * y). */
static double mean_around(const Race *race, uint32_t t, uint32_t x, uint32_t y, uint32_t c,
                          uint32_t around) {
  const uint32_t x0 = x > around ? x - around : 0;
  const uint32_t y0 = y > around ? y - around : 0;
  uint32_t n = 0;
  double sum = 0;
  for (uint32_t j = y0; j <= y + around && j < race->film.height; j++)
    for (uint32_t i = x0; i <= x + around && i < race->film.width; i++) {
      size_t pixel = (size_t)j * race->film.width + i;
      n++;
      sum += 0.5 * (value_at(race, race->images[t][0], pixel, c) +
                    value_at(race, race->images[t][1], pixel, c));
    }
  return sum / n;
}

/* The median of mean_around over the tracers. i: 3 times the pixel plus the channel. */
static double median_around(const Race *race, uint32_t count, size_t i, uint32_t around) {
  double means[VL_MAX_TRIALS];
  uint32_t x = (uint32_t)(i / 3 % race->film.width), y = (uint32_t)(i / 3 / race->film.width);
  for (uint32_t t = 0; t < count; t++)
    means[t] = mean_around(race, t, x, y, (uint32_t)(i % 3), around);
  qsort(means, count, sizeof *means, vl_by_value);
  return 0.5 * (means[(count - 1) / 2] + means[count / 2]);
}

/* All tracers have the same base, so that none has a small error because it found no light. The
 * mean of a pixel would be large where one tracer has a firefly, and would make the firefly's
 * error small: the median does not follow it. Where all are noisy most pixels are too dark: the
 * neighbours say how bright they are. */
static void find_base(Race *race, uint32_t count) {
  size_t n = 3 * race->pixels;
  for (size_t i = 0; i < n; i++) {
    race->base[i] =
        fmax(median_around(race, count, i, 0), median_around(race, count, i, AROUND));
    race->sorted[i] = race->base[i];
  }
  double mean = trimmed_mean(race->sorted, n, 0, n / 50); /* without lamps and fireflies */
  race->min = 0.1 * mean * mean;
}

/* The squared relative differences of trial t by pixel, in race->sorted. */
static void find_errors(Race *race, uint32_t t) {
  for (size_t i = 0; i < race->pixels; i++) {
    double sum = 0;
    for (uint32_t c = 0; c < 3; c++) {
      double base = race->base[3 * i + c];
      double apart =
          value_at(race, race->images[t][0], i, c) - value_at(race, race->images[t][1], i, c);
      sum += apart * apart / (6 * (base * base + race->min));
    }
    race->sorted[i] = sum;
  }
}

/* As the trimmed relMSE of a pair of seeds in bench/error.c; no pixel counts more than `max`.
 */
static double error_of(Race *race, uint32_t t, double max) {
  find_errors(race, t);
  for (size_t i = 0; i < race->pixels; i++)
    race->sorted[i] = fmin(race->sorted[i], max);
  return trimmed_mean(race->sorted, race->pixels, 0, (race->pixels + 999) / 1000);
}

/* The error that rare samples give an image of camera paths with the samples of the race, less
 * DOUBT standard errors: few light paths find some of them. */
static vlResult find_tail(Race *race, double *tail, vlError *error) {
  vlTails tails = {race->film.width,
                   race->film.height,
                   race->base,
                   race->min,
                   RARE * (double)race->def.spp,
                   (double)race->film.max_component};
  vlPilot pilot = {.pass_seed = tail_seed, .tails = &tails};
  vlFilmDef film_def = race->film;
  vlRenderDef def = race->def;
  vlImage *image = NULL;
  film_def.max_component = INFINITY;
  def.seed = tail_seed;
  def.tracer = VL_TRACER_LIGHT_PATH;
  def.light_paths = (uint32_t)(TAIL_PATHS * race->pixels);
  VL_TRY(render_coarse(race, &film_def, &def, &pilot, NULL, &image, error));
  double sum = 0, squares = 0, samples = (double)race->pixels * race->def.spp;
  for (size_t i = 0; i < race->pixels; i++) {
    sum += value_at(race, image, i, 0) * race->def.spp;
    squares += value_at(race, image, i, 1) * race->def.spp / VL_TAIL_SQUARES;
  }
  *tail = fmax(sum - DOUBT * sqrt(fmax(squares, 0)), 0) / (samples * race->def.spp);
  vl_image_destroy(image);
  return VL_OK;
}

/* The squared relative difference of block (x0, y0) between trial t and merging, trial m. It is
 * a product of the differences of two independent pairs, so its mean has no contribution of
 * noise. */
static double block_missing(const Race *race, uint32_t t, uint32_t m, uint32_t x0,
                            uint32_t y0) {
  double sum = 0;
  for (uint32_t c = 0; c < 3; c++) {
    double mean[2][2] = {{0, 0}, {0, 0}}; /* by trial (t, m) and image */
    for (uint32_t k = 0; k < BLOCK * BLOCK; k++) {
      size_t pixel = (size_t)(y0 + k / BLOCK) * race->film.width + x0 + k % BLOCK;
      for (int half = 0; half < 2; half++) {
        mean[0][half] += value_at(race, race->images[t][half], pixel, c) / (BLOCK * BLOCK);
        mean[1][half] += value_at(race, race->images[m][half], pixel, c) / (BLOCK * BLOCK);
      }
    }
    const double both = 0.5 * (mean[1][0] + mean[1][1]);
    sum +=
        (mean[1][0] - mean[0][0]) * (mean[1][1] - mean[0][1]) / (3 * (both * both + race->min));
  }
  return sum;
}

/* The light that merging finds and trial t does not, without what may be blur; 0 unless it is
 * above three standard errors. */
static double missing_of(Race *race, uint32_t t, uint32_t m) {
  size_t n = 0;
  double squares = 0;
  for (uint32_t y = 0; y + BLOCK <= race->film.height; y += BLOCK)
    for (uint32_t x = 0; x + BLOCK <= race->film.width; x += BLOCK)
      race->sorted[n++] = block_missing(race, t, m, x, y);
  const size_t out = (n + 49) / 50; /* outliers at each end */
  double mean = trimmed_mean(race->sorted, n, out, out);
  for (size_t i = out; i + out < n; i++)
    squares += (race->sorted[i] - mean) * (race->sorted[i] - mean);
  double significant = n > 2 * out ? 3 * sqrt(squares) / (double)(n - 2 * out) : INFINITY;
  return mean > significant && mean > BLUR ? mean - BLUR : 0;
}

static vlResult measure(Race *race, vlTracerChoice *choice, vlError *error) {
  find_base(race, choice->count);
  uint32_t last = choice->count - 1;
  bool merging = choice->trials[last].tracer == VL_TRACER_MERGING;
  for (uint32_t i = 0; i < choice->count; i++) {
    choice->trials[i].error = error_of(race, i, INFINITY);
    choice->trials[i].missing = merging && i != last ? missing_of(race, i, last) : 0;
  }
  vlTracerTrial *camera = &choice->trials[0];
  vlResult result = find_tail(race, &camera->tail, error);
  /* What rare samples the two images have is part of the tail. */
  camera->error = fmax(camera->error, error_of(race, 0, 0.5 * RARE * RARE) + camera->tail);
  return result;
}

/* ---- the choice -------------------------------------------------------------------------- */

void vl_choose_by_work(vlTracerChoice *choice, double samples) {
  vlTracerTrial *trials = choice->trials;
  uint32_t best = 0;
  for (uint32_t i = 0; i < choice->count; i++)
    trials[i].work =
        (trials[i].error * trials[i].cost / trials[0].cost / samples + trials[i].missing) /
        (trials[0].error / samples + trials[0].missing);
  for (uint32_t i = 1; i < choice->count; i++) {
    double max = isfinite(trials[best].work) ? trials[best].work : INFINITY;
    if (trials[i].tracer == VL_TRACER_MERGING)
      max *= BIASED;
    else if (best == 0)
      max *= SURE;
    if (trials[i].work < max)
      best = i;
  }
  choice->tracer = trials[best].tracer;
  choice->light_paths = trials[best].light_paths;
}

/* The light paths of a row for the whole film. */
static uint32_t light_paths_of(const Row *row, const vlFilmDef *film) {
  uint64_t pixels = (uint64_t)film->width * film->height;
  if (row->divisor < 2)
    return VL_AS_MANY_AS_PIXELS;
  return (uint32_t)((pixels < MAX_LIGHT_PATHS ? pixels : MAX_LIGHT_PATHS) / row->divisor);
}

static vlResult run_all(Race *race, const vlFilmDef *film, vlTracerChoice *choice,
                        vlError *error) {
  for (uint32_t i = 0; i < race->count; i++) {
    vlTracerTrial *trial = &choice->trials[i];
    *trial = (vlTracerTrial){.tracer = rows[i].tracer,
                             .light_paths = light_paths_of(&rows[i], film)};
    for (uint32_t half = 0; half < 2; half++) {
      VL_TRY(run_once(race, i, half, trial, error));
    }
  }
  choice->count = race->count;
  return VL_OK;
}

static vlResult run_race(Race *race, const vlFilmDef *film, vlTracerChoice *choice,
                         vlError *error) {
  vlContext *context = race->world->context;
  race->base = vl_alloc_array(context, 3 * race->pixels, sizeof *race->base);
  race->sorted = vl_alloc_array(context, 3 * race->pixels, sizeof *race->sorted);
  vlResult result =
      race->base && race->sorted ? run_all(race, film, choice, error) : vl_fail_memory(error);
  if (result == VL_OK)
    result = measure(race, choice, error);
  for (uint32_t i = 0; i < VL_MAX_TRIALS; i++)
    for (int half = 0; half < 2; half++)
      vl_image_destroy(race->images[i][half]);
  VL_FREE(context, race->base, race->sorted);
  return result;
}

vlResult vl_choose_tracer(const vlWorld *world, const vlCamera *camera, const vlFilmDef *film,
                          const vlRenderDef *def, bool merging, vlTracerChoice *choice,
                          vlError *error) {
  vl_error_clear(error);
  if (!world || !camera || !film || !def || !choice)
    return vl_fail_argument(error, "choose: an argument is null");
  VL_TRY(vl_render_def_check(def, "choose", error));
  memset(choice, 0, sizeof *choice);
  choice->tracer = VL_TRACER_VOLPATH;
  choice->light_paths = def->light_paths;
  Race race = {.world = world,
               .def = *def,
               .size = size_of(world),
               .count = merging && has_smooth(world) ? VL_MAX_TRIALS : VL_MAX_TRIALS - 1};
  uint32_t spp = def->spp;
  if (looks_past(world, def->tracer)) {
    choice->tracer = VL_TRACER_PATH;
    return VL_OK;
  }
  bool can;
  if (can_race(world, camera, film, &can) != VL_OK)
    return vl_fail_memory(error);
  if (!can || !choose_size(&race, film))
    return VL_OK;
  vlFilmDef whole = *film;
  whole.crop[0] = whole.crop[1] = 0;
  whole.crop[2] = film->width;
  whole.crop[3] = film->height;
  race.film = vl_coarse_film_def(&whole, race.factor);
  race.pixels = (size_t)race.film.width * race.film.height;
  race.def.first_sample = race.def.sequence = 0;
  race.def.noise = race.def.time_limit = 0;
  if (!vl_is_unset(race.def.merge_radius))
    race.def.merge_radius *= race.factor; /* as many photons within it */
  if (vl_camera_coarse(camera, race.factor, &race.camera) != VL_OK)
    return vl_fail_argument(error, "choose: the camera has no coarse image");
  vlResult result = run_race(&race, film, choice, error);
  if (result == VL_OK)
    vl_choose_by_work(choice, (double)spp / race.def.spp);
  return result;
}
