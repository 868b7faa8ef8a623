/* render/two_way.c: see two_way.h. */
#include "render/two_way.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/context.h"
#include "base/error.h"
#include "film/expose.h"
#include "film/sums.h"
#include "math/hash.h"
#include "render/eye_view.h"

enum {
  MOST_PATHS = 1 << 20,   /* of light in a pass, if their number is not given */
  MOST_PHOTONS = 1 << 23, /* 512 MB, and as much again sorted; a pass that would leave more has fewer paths */
  FIRST_PHOTONS = 1 << 16
};
static const uint32_t light_seed = 0x6c696768u;

/* 128 bits in two words, so that threads may add without a lock: a carry is what one addition makes. */
typedef struct Sum {
  atomic_uint_least64_t low, high;
} Sum;
typedef struct Splat {
  Sum color[3];
} Splat;

typedef struct Worker {
  struct vlTwoWayRows *rows;
  vlTraceScratch *scratch;
  int32_t px[VL_ROW_SIZE], py[VL_ROW_SIZE];
  uint32_t index[VL_ROW_SIZE];
  float color[3][VL_ROW_SIZE];
  uint64_t paths, bounce_rays, shadow_rays, not_finite;
  vlTwoWayRun *run;
} Worker;

struct vlTwoWayRun {
  vlContext *context;
  const vlWorld *world;
  const vlFilmDef *film_def;
  const vlFilm *film;
  vlTwoWay way;
  vlTraceDef trace;
  const vlTraceKernels *kernels;
  Worker *workers;
  char *memory; /* of the workers' rows */
  float *choice;
  uint32_t *medium; /* of lights */
  Splat *splats;    /* of the crop window */
  uint32_t x0, y0, width, height;
  double filter_scale[2];
  float exposure, first_radius;
  uint32_t most_paths, paths, index;
  uint32_t pixels, rounds; /* paths are samples of the film's pixels, by the light's sampler: so many of each */
  vlPhoton *photons, *sorted;
  uint32_t *start, capacity, buckets;
  atomic_uint_least64_t stored;
  bool starts; /* there is light that paths can start from */
};

bool vl_two_way_tracer(vlTracer tracer) {
  return tracer == VL_TRACER_BIDIRECTIONAL || tracer == VL_TRACER_MERGING || tracer == VL_TRACER_SPPM ||
         tracer == VL_TRACER_LIGHT_PATH;
}
const vlTwoWay *vl_two_way_of(const vlTwoWayRun *run) {
  return &run->way;
}
struct vlTwoWayRows *vl_two_way_rows(const vlTwoWayRun *run, uint32_t worker) {
  return run->workers[worker].rows;
}

void vl_two_way_use(vlTwoWayRun *run, uint32_t worker, vlTraceScratch *scratch) {
  run->workers[worker].scratch = scratch;
}

/* ---- splats ------------------------------------------------------------------------------------------------------ */

static void add(Sum *sum, float value) {
  vlInt128 units = vl_film_product(value, INT64_C(1) << VL_WEIGHT_BITS);
  uint64_t low = (uint64_t)units, high = (uint64_t)(units >> 64);
  uint64_t old = atomic_fetch_add_explicit(&sum->low, low, memory_order_relaxed);
  high += old + low < old;
  if (high) atomic_fetch_add_explicit(&sum->high, high, memory_order_relaxed);
}

/* What the pixels round a film point see of it: the pixel filter, of integral 1. */
static void splat_one(vlTwoWayRun *run, float x, float y, const float color[3]) {
  const vlPixelFilter *f = &run->film_def->filter;
  int32_t first_x = (int32_t)floor((double)x - 0.5 - (double)f->radius_x) + 1;
  int32_t first_y = (int32_t)floor((double)y - 0.5 - (double)f->radius_y) + 1;
  for (int32_t py = first_y; (double)py + 0.5 <= (double)y + (double)f->radius_y; py++) {
    if (py < (int32_t)run->y0 || py >= (int32_t)(run->y0 + run->height)) continue;
    double wy = vl_filter_value(f, 1, (double)y - (double)py - 0.5) * run->filter_scale[1];
    for (int32_t px = first_x; (double)px + 0.5 <= (double)x + (double)f->radius_x; px++) {
      if (px < (int32_t)run->x0 || px >= (int32_t)(run->x0 + run->width)) continue;
      double w = wy * vl_filter_value(f, 0, (double)x - (double)px - 0.5) * run->filter_scale[0];
      Splat *s = &run->splats[(size_t)(py - (int32_t)run->y0) * run->width + (size_t)(px - (int32_t)run->x0)];
      for (int c = 0; c < 3; c++) add(&s->color[c], (float)(w * (double)color[c]));
    }
  }
}

static void splat(void *user, uint32_t n, const float *x, const float *y, float *const value[4], float *const lambda[4],
                  float *const inv_pdf[4]) {
  Worker *w = user;
  vlTwoWayRun *run = w->run;
  bool rgb = run->world->def.color == VL_COLOR_RGB;
  vlExposure expose = {.n = n, .exposure = run->exposure};
  for (int c = 0; c < 4; c++) {
    for (uint32_t i = n; n && i < VL_PAD(n); i++) {
      value[c][i] = 0.0f;
      lambda[c][i] = lambda[c][n - 1], inv_pdf[c][i] = inv_pdf[c][n - 1];
    }
    expose.radiance[c] = value[c];
    expose.lambda[c] = rgb ? NULL : lambda[c];
    expose.inv_pdf[c] = rgb ? NULL : inv_pdf[c];
  }
  vl_film_expose(run->film, run->trace.isa, &expose, w->color[0], w->color[1], w->color[2]);
  for (uint32_t i = 0; i < n; i++) {
    const float color[3] = {w->color[0][i], w->color[1][i], w->color[2][i]};
    float most = fmaxf(fabsf(color[0]), fmaxf(fabsf(color[1]), fabsf(color[2])));
    float sum = color[0] + color[1] + color[2];
    if (most < 0x1p35f && sum == sum)
      splat_one(run, x[i], y[i], color);
    else
      w->not_finite++;
  }
}

void vl_two_way_take(vlTwoWayRun *run, uint32_t n, const int32_t *px, const int32_t *py, const float *weight, float *r,
                     float *g, float *b) {
  for (uint32_t i = 0; i < n; i++) {
    Splat *s = &run->splats[(size_t)((uint32_t)py[i] - run->y0) * run->width + ((uint32_t)px[i] - run->x0)];
    float *const to[3] = {r + i, g + i, b + i};
    for (int c = 0; c < 3; c++) {
      uint64_t low = atomic_load_explicit(&s->color[c].low, memory_order_relaxed);
      uint64_t high = atomic_load_explicit(&s->color[c].high, memory_order_relaxed);
      if (!(low | high)) continue;
      double sum = ((double)(int64_t)high * 0x1p64 + (double)low) * 0x1p-50;
      *to[c] += (float)(sum / (double)weight[i]);
      atomic_store_explicit(&s->color[c].low, 0, memory_order_relaxed);
      atomic_store_explicit(&s->color[c].high, 0, memory_order_relaxed);
    }
  }
}

/* ---- light's paths ----------------------------------------------------------------------------------------------- */

static void store(void *user, uint32_t n, const vlPhoton *photons) {
  Worker *w = user;
  vlTwoWayRun *run = w->run;
  uint64_t at = atomic_fetch_add_explicit(&run->stored, n, memory_order_relaxed);
  if (at + n <= run->capacity) memcpy(run->photons + at, photons, n * sizeof *photons);
}

static void light_block(void *user, uint32_t block, uint32_t worker) {
  vlTwoWayRun *run = user;
  Worker *w = &run->workers[worker];
  uint32_t first = block * VL_BATCH, left = run->paths - first, n = left < VL_BATCH ? left : VL_BATCH;
  uint32_t width = run->film_def->width;
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    uint32_t path = first + (i < n ? i : n - 1), pixel = path % run->pixels;
    w->px[i] = (int32_t)(pixel % width), w->py[i] = (int32_t)(pixel / width);
    w->index[i] = run->index * run->rounds + path / run->pixels;
  }
  vlLightBatch batch = {
      .n = n, .px = w->px, .py = w->py, .index = w->index, .first = first, .user = w, .splat = splat, .store = store};
  unsigned state = vl_accel_enter();
  run->kernels->light(run->world, &run->trace, w->scratch, w->rows, &batch);
  vl_accel_leave(state);
  w->paths += n;
  w->bounce_rays += batch.bounce_rays;
  w->shadow_rays += batch.shadow_rays;
}

static vlResult grow(vlTwoWayRun *run, uint64_t wanted, vlError *error) {
  if (wanted <= run->capacity) return VL_OK;
  uint64_t capacity = wanted + wanted / 4;
  if (capacity > MOST_PHOTONS) capacity = MOST_PHOTONS;
  uint32_t buckets = FIRST_PHOTONS;
  while (buckets < capacity) buckets *= 2;
  vl_free(run->context, run->photons);
  vl_free(run->context, run->sorted);
  vl_free(run->context, run->start);
  run->photons = vl_alloc_aligned(run->context, capacity, sizeof *run->photons);
  run->sorted = vl_alloc_aligned(run->context, capacity, sizeof *run->sorted);
  run->start = vl_alloc_array(run->context, (size_t)buckets + 1, sizeof *run->start);
  bool good = run->photons && run->sorted && run->start;
  run->capacity = good ? (uint32_t)capacity : 0;
  run->buckets = buckets;
  return good ? VL_OK : vl_fail_memory(error);
}

static void clear_splats(vlTwoWayRun *run) {
  memset((void *)run->splats, 0, (size_t)run->width * run->height * sizeof *run->splats);
}

/* Radii shrink so that both error and bias vanish: r_i^2 = r_1^2 i^(alpha - 1), alpha = 2/3 (Knaus and Zwicker 2011;
 * Georgiev et al. 2012). */
static void set_radius(vlTwoWayRun *run, uint32_t index) {
  vlTwoWay *way = &run->way;
  float radius = run->first_radius * vl_pow((float)(index + 1), -1.0f / 6.0f);
  way->paths = (float)run->paths;
  way->merged = way->merge ? way->paths * VL_PI * radius * radius : 0.0f;
  way->merged_volume = way->merged * radius * (4.0f / 3.0f);
  way->map.radius2 = radius * radius;
}

/* Van der Corput's sequence, turned by the seed: any number of passes has its wavelengths well spread. */
static float shared_number(uint32_t seed, uint32_t index) {
  uint32_t x = index;
  x = x << 16 | x >> 16;
  x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
  return vl_unit_float(x + vl_hash2(seed, light_seed));
}

vlResult vl_two_way_light(vlTwoWayRun *run, uint32_t index, vlError *error) {
  if (!run->starts) return VL_OK;
  vlTwoWay *way = &run->way;
  run->index = index;
  run->paths = run->most_paths;
  if (way->merge) way->shared = shared_number(run->trace.sampler->seed, index);
  for (;;) {
    set_radius(run, index);
    atomic_store(&run->stored, 0);
    vl_parallel_for(run->context, (run->paths + VL_BATCH - 1) / VL_BATCH, light_block, run);
    uint64_t stored = atomic_load(&run->stored);
    if (!way->merge) return VL_OK;
    if (stored <= run->capacity) {
      vl_photon_map_build(&way->map, run->photons, (uint32_t)stored, sqrtf(way->map.radius2), run->sorted, run->start,
                          run->buckets);
      return VL_OK;
    }
    clear_splats(run); /* the pass is done again, with more room or fewer paths */
    if (stored > MOST_PHOTONS) run->paths = run->paths / 2 > 1 ? run->paths / 2 : 1;
    vlResult result = grow(run, stored < MOST_PHOTONS ? stored : MOST_PHOTONS, error);
    if (result != VL_OK) return result;
  }
}

/* ---- making ------------------------------------------------------------------------------------------------------ */

static double filter_integral(const vlPixelFilter *f, int axis) {
  enum { STEPS = 4096 };
  double radius = (double)(axis ? f->radius_y : f->radius_x), sum = 0;
  for (int i = 0; i < STEPS; i++) sum += vl_filter_value(f, axis, (i + 0.5) / STEPS * radius);
  return 2 * radius * sum / STEPS;
}

static vlResult make_workers(vlTwoWayRun *run, vlError *error) {
  uint32_t threads = vl_context_threads(run->context);
  size_t size = (vl_two_way_rows_size() + 63) & ~(size_t)63;
  run->workers = vl_alloc_aligned(run->context, threads, sizeof *run->workers);
  run->memory = vl_alloc_aligned(run->context, threads, size);
  if (!run->workers || !run->memory) return vl_fail_memory(error);
  memset((void *)run->workers, 0, threads * sizeof *run->workers);
  memset(run->memory, 0, threads * size);
  for (uint32_t i = 0; i < threads; i++) {
    run->workers[i].run = run;
    run->workers[i].rows = (struct vlTwoWayRows *)(void *)(run->memory + i * size);
  }
  return VL_OK;
}

/* What lights stand in: light's paths must know it from the start. */
static vlResult find_media(vlTwoWayRun *run, const vlCamera *camera, vlError *error) {
  const vlWorld *world = run->world;
  if (!world->media.count) return VL_OK;
  run->way.medium = run->medium = vl_alloc_array(run->context, world->lights.count + 1, sizeof *run->medium);
  if (!run->medium) return vl_fail_memory(error);
  const double *m = camera->world_from_camera;
  const float eye[3] = {(float)m[3], (float)m[7], (float)m[11]};
  unsigned state = vl_accel_enter();
  run->kernels->light_media(world, eye, run->medium);
  vl_accel_leave(state);
  return VL_OK;
}

vlResult vl_two_way_create(const vlWorld *world, const vlCamera *camera, vlFilm *film, const vlRenderDef *def,
                           const vlTraceDef *trace, vlTwoWayRun **made, vlError *error) {
  vlContext *context = world->context;
  vlTwoWayRun *run = vl_alloc_zero(context, 1, sizeof *run);
  *made = run;
  if (!run) return vl_fail_memory(error);
  const vlFilmDef *f = vl_film_def(film);
  run->context = context, run->world = world, run->film = film, run->film_def = f;
  run->trace = *trace;
  run->trace.two_way = &run->way;
  run->kernels = vl_trace_kernels(trace->isa);
  run->exposure = (float)camera->exposure_time;
  run->x0 = f->crop[0], run->y0 = f->crop[1];
  run->width = f->crop[2] - f->crop[0], run->height = f->crop[3] - f->crop[1];
  for (int i = 0; i < 2; i++) run->filter_scale[i] = 1 / filter_integral(&f->filter, i);
  uint64_t pixels = (uint64_t)f->width * f->height;
  run->pixels = pixels < UINT32_MAX ? (uint32_t)pixels : UINT32_MAX;
  run->most_paths = def->light_paths;
  if (def->light_paths == VL_AS_MANY_AS_PIXELS) run->most_paths = pixels < MOST_PATHS ? (uint32_t)pixels : MOST_PATHS;
  run->paths = run->most_paths;
  run->rounds = run->most_paths > run->pixels ? (run->most_paths + run->pixels - 1) / run->pixels : 1;
  uint64_t samples = (uint64_t)def->spp * run->rounds;
  vlTwoWay *way = &run->way;
  vl_sampler_init(&way->sampler, def->sampler, vl_hash2(def->seed, light_seed), f->width, f->height,
                  samples < UINT32_MAX ? (uint32_t)samples : UINT32_MAX);
  way->light_only = def->tracer == VL_TRACER_LIGHT_PATH;
  way->apart = def->tracer == VL_TRACER_SPPM;
  way->merge = def->tracer == VL_TRACER_MERGING || way->apart;
  way->shared = -1.0f;
  run->choice = vl_alloc_zero(context, world->lights.count + 1, sizeof *run->choice);
  run->splats = vl_alloc_zero(context, (size_t)run->width * run->height, sizeof *run->splats);
  way->choice = run->choice;
  vlResult result = run->choice && run->splats ? make_workers(run, error) : vl_fail_memory(error);
  if (result == VL_OK) result = find_media(run, camera, error);
  if (result != VL_OK) return result;
  run->starts = vl_two_way_choice(world, run->choice) && run->most_paths > 0;
  if (run->most_paths == 0) memset(run->choice, 0, (world->lights.count + 1) * sizeof *run->choice);
  if (run->starts) vl_eye_view(camera, f, &way->eye);
  if (result == VL_OK && way->merge && def->merge_radius > 0)
    run->first_radius = (float)def->merge_radius;
  else if (result == VL_OK && way->merge)
    result = vl_first_radius(world, camera, trace, &run->first_radius, error);
  way->merge = way->merge && run->starts && run->first_radius > 0.0f;
  if (result == VL_OK && way->merge) result = grow(run, FIRST_PHOTONS, error);
  set_radius(run, 0);
  return result;
}

void vl_two_way_destroy(vlTwoWayRun *run) {
  if (!run) return;
  vlContext *context = run->context;
  vl_free(context, run->workers);
  vl_free(context, run->memory);
  vl_free(context, run->choice);
  vl_free(context, run->medium);
  vl_free(context, run->splats);
  vl_free(context, run->photons);
  vl_free(context, run->sorted);
  vl_free(context, run->start);
  vl_free(context, run);
}

vlTwoWayCounts vl_two_way_counts(const vlTwoWayRun *run) {
  vlTwoWayCounts sum = {0, 0, 0, 0};
  for (uint32_t i = 0; i < vl_context_threads(run->context); i++) {
    const Worker *w = &run->workers[i];
    sum.paths += w->paths;
    sum.bounce_rays += w->bounce_rays;
    sum.shadow_rays += w->shadow_rays;
    sum.not_finite += w->not_finite;
  }
  return sum;
}
