/* render/render.c: where world, camera and film meet: passes over tiles, samples into rays, radiance into the film.
 *
 *   tile x samples -> film positions (filter) -> camera rays -> trace -> RGB -> film sums
 *
 * A batch is a tile of 16 x 16 pixels times up to 4 samples, or up to 4 tiles; pixels in Morton order so that 16
 * neighbours make a packet. What a sample is depends on (seed, pixel, index) alone, and the film adds exactly: no
 * grouping shows in the picture. */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

#include "base/context.h"
#include "base/cookie.h"
#include "base/error.h"
#include "base/file.h"
#include "film/expose.h"
#include "render/film_rays.h"
#include "render/two_way.h"
#include "trace/trace.h"
#include "velo/focus.h"
#include "velo/render.h"

enum { TILE = 16, TILE_PIXELS = TILE * TILE, MAX_PASS = 16, PASS_SECONDS = 5 };

typedef struct Worker {
  vlTraceScratch *scratch;
  float *rows;                                      /* ROWS arrays of VL_ROW_SIZE */
  _Atomic uint64_t paths, bounce_rays, shadow_rays; /* written by the worker, read by the progress report meanwhile */
  uint64_t not_finite;
  int32_t bad_x, bad_y;
} Worker;

enum Row {
  FILM_U,
  FILM_V,
  FILM_X,
  FILM_Y,
  WEIGHT,
  TIME,
  LENS_U,
  LENS_V,
  OX,
  OY,
  OZ,
  DX,
  DY,
  DZ,
  T_MIN,
  T_MAX,
  RAY_TIME,
  VALID,
  RAY_WEIGHT,
  LAMBDA,
  INV_PDF = LAMBDA + 4,
  RADIANCE = INV_PDF + 4,
  ALPHA = RADIANCE + 4,
  RED,
  GREEN,
  BLUE,
  PIXEL_X,
  PIXEL_Y,
  INDEX,
  ROWS
};

typedef struct Render {
  const vlWorld *world;
  vlFilm *film;
  const vlRenderDef *def;
  vlFilmRays film_rays;
  float exposure_time;
  vlTraceDef trace;
  const vlTraceKernels *trace_kernels;
  vlTwoWayRun *two_way; /* null: the light is only asked for */
  bool rgb_mode;
  uint32_t crop[4];
  uint32_t tiles_x, tiles_y, tile_x0, tile_y0;
  uint32_t span_x, span_y; /* tiles of a block, what a worker takes at a time */
  uint32_t first_sample, pass_samples;
  Worker *workers;
  atomic_uint blocks_done;
  atomic_bool cancelled;
  pthread_t caller;
  double start, last_sign;
  uint32_t spp_before;
} Render;

static float *row(Worker *w, int r) {
  return w->rows + (size_t)r * VL_ROW_SIZE;
}

/* Every second bit of a Morton index. */
static uint32_t morton_half(uint32_t m) {
  m &= 0x55555555u;
  m = (m | m >> 1) & 0x33333333u;
  m = (m | m >> 2) & 0x0f0f0f0fu;
  return (m | m >> 4) & 0x00ff00ffu;
}

/* Pixels of the block's tiles inside the crop window, times the samples of this batch. Returns the number of lanes. */
static uint32_t list_samples(const Render *r, Worker *w, uint32_t block, uint32_t first, uint32_t count) {
  int32_t *px = (int32_t *)(void *)row(w, PIXEL_X), *py = (int32_t *)(void *)row(w, PIXEL_Y);
  uint32_t *index = (uint32_t *)(void *)row(w, INDEX), n = 0;
  uint32_t blocks_x = (r->tiles_x + r->span_x - 1) / r->span_x, pixels = r->span_x * r->span_y * TILE_PIXELS;
  uint32_t x0 = (r->tile_x0 + block % blocks_x * r->span_x) * TILE;
  uint32_t y0 = (r->tile_y0 + block / blocks_x * r->span_y) * TILE;
  for (uint32_t s = first; s < first + count; s++)
    for (uint32_t m = 0; m < pixels; m++) { /* two tiles lie side by side, four in a square */
      uint32_t x = x0 + morton_half(m), y = y0 + morton_half(m >> 1);
      if (x < r->crop[0] || y < r->crop[1] || x >= r->crop[2] || y >= r->crop[3]) continue;
      px[n] = (int32_t)x, py[n] = (int32_t)y, index[n] = s;
      n++;
    }
  for (uint32_t i = n; n > 0 && i < VL_PAD(n); i++) px[i] = px[n - 1], py[i] = py[n - 1], index[i] = index[n - 1];
  return n;
}

/* One writer: no exchange is needed. */
static void count_more(_Atomic uint64_t *total, uint64_t more) {
  atomic_store_explicit(total, atomic_load_explicit(total, memory_order_relaxed) + more, memory_order_relaxed);
}

/* Where the camera sees nothing (outside an image circle, beyond a fold), not even the sky is seen. */
static void clear_invalid(uint32_t n, const float *valid, float *alpha, float *const radiance[4]) {
  for (uint32_t i = 0; i < n; i++) {
    if (valid[i] > 0.0f) continue;
    alpha[i] = 0.0f;
    for (int c = 0; c < 4; c++) radiance[c][i] = 0.0f;
  }
}

/* What a ray's light counts. What a part of the lens stops is black, not transparent. */
static void weigh(uint32_t n, const float *weight, const float *valid, float *alpha, float *const radiance[4]) {
  for (uint32_t i = 0; i < n; i++) {
    for (int c = 0; c < 4; c++) radiance[c][i] = weight[i] > 0.0f ? radiance[c][i] * weight[i] : 0.0f;
    alpha[i] = weight[i] > 0.0f || !(valid[i] > 0.0f) ? alpha[i] : 1.0f;
  }
}

static void render_batch(const Render *r, Worker *w, uint32_t n) {
  const int32_t *px = (int32_t *)(void *)row(w, PIXEL_X), *py = (int32_t *)(void *)row(w, PIXEL_Y);
  const uint32_t *index = (uint32_t *)(void *)row(w, INDEX);
  const vlCameraCompiled *camera = &r->film_rays.camera;
  vlCameraRays rays = {.ox = row(w, OX),
                       .oy = row(w, OY),
                       .oz = row(w, OZ),
                       .dx = row(w, DX),
                       .dy = row(w, DY),
                       .dz = row(w, DZ),
                       .t_min = row(w, T_MIN),
                       .t_max = row(w, T_MAX),
                       .time = row(w, RAY_TIME),
                       .valid = row(w, VALID),
                       .weight = row(w, RAY_WEIGHT)};
  vlFilmRayRows rows = {px,
                        py,
                        index,
                        row(w, FILM_U),
                        row(w, FILM_V),
                        row(w, FILM_X),
                        row(w, FILM_Y),
                        row(w, WEIGHT),
                        row(w, TIME),
                        row(w, LENS_U),
                        row(w, LENS_V),
                        rays};
  vl_film_rays_make(&r->film_rays, n, &rows);
  vlTraceBatch batch = {.n = n,
                        .ox = rays.ox,
                        .oy = rays.oy,
                        .oz = rays.oz,
                        .dx = rays.dx,
                        .dy = rays.dy,
                        .dz = rays.dz,
                        .t_min = rays.t_min,
                        .t_max = rays.t_max,
                        .px = px,
                        .py = py,
                        .index = index,
                        .time = r->film_rays.moves ? rays.time : NULL,
                        .alpha = row(w, ALPHA)};
  vlExposure expose = {.n = n, .exposure = r->exposure_time};
  for (int c = 0; c < 4; c++) {
    expose.radiance[c] = batch.radiance[c] = row(w, RADIANCE + c);
    expose.lambda[c] = batch.lambda[c] = r->rgb_mode ? NULL : row(w, LAMBDA + c);
    expose.inv_pdf[c] = batch.inv_pdf[c] = r->rgb_mode ? NULL : row(w, INV_PDF + c);
  }
  if (r->two_way) batch.two_way = vl_two_way_rows(r->two_way, (uint32_t)(w - r->workers));
  r->trace_kernels->trace(r->world, &r->trace, w->scratch, &batch);
  if (vl_camera_weighted(camera)) weigh(n, rays.weight, rays.valid, batch.alpha, batch.radiance);
  if (!camera->plain) clear_invalid(n, row(w, VALID), batch.alpha, batch.radiance);
  vl_film_expose(r->film, r->trace.isa, &expose, row(w, RED), row(w, GREEN), row(w, BLUE));
  if (r->two_way) vl_two_way_take(r->two_way, n, px, py, row(w, WEIGHT), row(w, RED), row(w, GREEN), row(w, BLUE));
  vlFilmSamples add = {n, px, py, row(w, RED), row(w, GREEN), row(w, BLUE), batch.alpha, row(w, WEIGHT)};
  int32_t bad_x = 0, bad_y = 0;
  uint32_t bad = vl_film_add(r->film, &add, &bad_x, &bad_y);
  if (bad && !w->not_finite) w->bad_x = bad_x, w->bad_y = bad_y;
  w->not_finite += bad;
  count_more(&w->paths, n);
  count_more(&w->bounce_rays, batch.bounce_rays);
  count_more(&w->shadow_rays, batch.shadow_rays);
}

static void count_rays(const Render *r, uint64_t *paths, uint64_t *rays) {
  *paths = *rays = 0;
  for (uint32_t i = 0; i < vl_context_threads(r->world->context); i++) {
    const Worker *w = &r->workers[i];
    *paths += w->paths;
    *rays += w->paths + w->bounce_rays + w->shadow_rays;
  }
}

static bool report(Render *r, bool pass_done, double done_samples) {
  if (!r->def->progress) return true;
  vlProgress p;
  memset(&p, 0, sizeof p);
  double total = r->def->spp - r->spp_before;
  p.spp_done = vl_film_spp(r->film);
  p.spp_total = r->def->spp;
  p.elapsed = vl_seconds() - r->start;
  p.fraction = total > 0 ? (done_samples - r->spp_before) / total : 1;
  p.remaining = p.fraction > 0 ? p.elapsed * (1 - p.fraction) / p.fraction : 0;
  if (r->def->time_limit > 0 && p.elapsed + p.remaining > r->def->time_limit) {
    p.remaining = fmax(0, r->def->time_limit - p.elapsed);
    p.fraction = fmax(p.fraction, fmin(1, p.elapsed / r->def->time_limit));
  }
  p.pass_done = pass_done;
  count_rays(r, &p.paths, &p.rays);
  return r->def->progress(r->def->progress_user, &p);
}

static uint32_t block_count(const Render *r) {
  return ((r->tiles_x + r->span_x - 1) / r->span_x) * ((r->tiles_y + r->span_y - 1) / r->span_y);
}

/* Passes of few samples take several tiles at once, so that batches are full; but not so many that a worker is idle. */
static void choose_blocks(Render *r) {
  uint32_t threads = vl_context_threads(r->world->context);
  r->span_x = r->pass_samples <= 2 ? 2 : 1;
  r->span_y = r->pass_samples <= 1 ? 2 : 1;
  if (block_count(r) < 2 * threads) r->span_y = 1;
  if (block_count(r) < 2 * threads) r->span_x = 1;
}

static void render_block(void *user, uint32_t block, uint32_t worker) {
  Render *r = user;
  Worker *w = &r->workers[worker];
  if (atomic_load(&r->cancelled)) return;
  unsigned state = vl_accel_enter();
  uint32_t end = r->first_sample + r->pass_samples;
  for (uint32_t s = r->first_sample; s < end && !atomic_load(&r->cancelled);) {
    uint32_t most = VL_BATCH / TILE_PIXELS / (r->span_x * r->span_y), count = end - s < most ? end - s : most;
    uint32_t n = list_samples(r, w, block, s, count);
    if (n) render_batch(r, w, n);
    s += count;
    if (worker == 0 && pthread_equal(pthread_self(), r->caller) && vl_seconds() - r->last_sign > 0.1) {
      vl_accel_leave(state);
      r->last_sign = vl_seconds();
      double share = (double)atomic_load(&r->blocks_done) / block_count(r);
      if (!report(r, false, r->first_sample + share * r->pass_samples)) atomic_store(&r->cancelled, true);
      state = vl_accel_enter();
    }
  }
  vl_accel_leave(state);
  atomic_fetch_add(&r->blocks_done, 1);
}

static vlResult check_arguments(const vlWorld *world, const vlCamera *camera, vlFilm *film, const vlRenderDef *def,
                                vlError *error) {
  if (!world || !camera || !film) return vl_fail(error, VL_ERROR_ARGUMENT, "vl_render: null argument");
  if (def->cookie != VL_COOKIE_RENDER)
    return vl_fail(error, VL_ERROR_ARGUMENT, "vl_render: the def was not made by vl_default_render_def");
  const vlFilmDef *f = vl_film_def(film);
  if (camera->width != f->width || camera->height != f->height)
    return vl_fail(error, VL_ERROR_ARGUMENT, "vl_render: camera (%u x %u) and film (%u x %u) differ", camera->width,
                   camera->height, f->width, f->height);
  if (def->max_depth > 4096)
    return vl_fail(error, VL_ERROR_ARGUMENT, "vl_render: max_depth %u is above 4096", def->max_depth);
  return VL_OK;
}

static size_t round_up(size_t size) {
  return (size + 63) & ~(size_t)63;
}

/* In one block that stays with the film: many small pictures one after the other need no fresh memory. */
static vlResult make_workers(Render *r, vlContext *context, vlError *error) {
  uint32_t threads = vl_context_threads(context);
  size_t head = round_up(threads * sizeof *r->workers), scratch = round_up(vl_trace_scratch_size());
  size_t rows = round_up((size_t)ROWS * VL_ROW_SIZE * sizeof(float));
  char *block = vl_film_scratch(r->film, head + threads * (scratch + rows));
  if (!block) return vl_fail_memory(error);
  r->workers = (Worker *)(void *)block;
  memset(block, 0, head);
  for (uint32_t i = 0; i < threads; i++) {
    char *own = block + head + i * (scratch + rows);
    r->workers[i].scratch = (vlTraceScratch *)(void *)own;
    r->workers[i].rows = (float *)(void *)(own + scratch);
  }
  return VL_OK;
}

/* Light is followed both ways where nothing lies in a medium or moves; else by the tracer that can do that. */
static vlTracer tracer_of(const Render *r, const vlCamera *camera) {
  const vlWorld *world = r->world;
  if (!vl_two_way_tracer(r->def->tracer) || (world->media.count == 0 && !world->moves && !camera->moves))
    return r->def->tracer;
  vl_log(world->context, VL_LOG_INFO, NULL,
         "light is followed both ways only where nothing %s: paths from the eye alone are traced",
         world->media.count ? "lies in a medium" : "moves");
  return VL_TRACER_VOLPATH;
}

/* Their passes have one sample, and paths from the lights before it. */
static vlResult prepare_two_way(Render *r, const vlCamera *camera, vlError *error) {
  if (!vl_two_way_tracer(r->trace.tracer)) return VL_OK;
  vlResult result = vl_two_way_create(r->world, camera, r->film, r->def, &r->trace, &r->two_way, error);
  if (result != VL_OK) return result;
  r->trace.two_way = vl_two_way_of(r->two_way);
  for (uint32_t i = 0; i < vl_context_threads(r->world->context); i++)
    vl_two_way_use(r->two_way, i, r->workers[i].scratch);
  return VL_OK;
}

static void prepare(Render *r, const vlCamera *camera) {
  const vlWorld *world = r->world;
  const vlFilmDef *f = vl_film_def(r->film);
  vlIsa isa = vl_context_isa(world->context);
  vlSampler sampler;
  vl_sampler_init(&sampler, r->def->sampler, r->def->seed, f->width, f->height, r->def->spp);
  vl_film_rays_init(&r->film_rays, camera, vl_film_filter(r->film), &sampler, isa);
  vl_film_rays_clock(&r->film_rays, world);
  r->exposure_time = (float)camera->exposure_time;
  r->trace_kernels = vl_trace_kernels(isa);
  r->rgb_mode = world->def.color == VL_COLOR_RGB;
  /* Footprints shrink with the samples of a pixel (pbrt book 10.1.3 scales by 1/sqrt(spp), at least 1/8); a fixed
   * share, so that more samples continue the same picture. */
  const float footprint = 0.25f;
  r->trace = (vlTraceDef){.tracer = tracer_of(r, camera),
                          .sampler = &r->film_rays.sampler,
                          .isa = isa,
                          .max_depth = r->def->max_depth,
                          .ao_distance = r->def->ao_distance,
                          .ao_cosine = r->def->ao_cosine,
                          .pixel_spread = footprint * r->film_rays.camera.pixel_spread,
                          .pixel_width = footprint * r->film_rays.camera.pixel_width};
  memcpy(r->crop, f->crop, sizeof r->crop);
  r->tile_x0 = r->crop[0] / TILE, r->tile_y0 = r->crop[1] / TILE;
  r->tiles_x = (r->crop[2] + TILE - 1) / TILE - r->tile_x0;
  r->tiles_y = (r->crop[3] + TILE - 1) / TILE - r->tile_y0;
}

/* Passes of 1, 1, 2, 4, ... samples: a first picture at once, then fewer interruptions; but no longer than
 * PASS_SECONDS, for that much is lost when a pass is given up. How samples are split into passes does not show in the
 * picture. */
static uint32_t pass_size(uint32_t done, uint32_t total, double seconds_per_sample) {
  uint32_t size = done == 0 ? 1 : done < MAX_PASS ? done : MAX_PASS;
  double fit = seconds_per_sample > 0 ? PASS_SECONDS / seconds_per_sample : MAX_PASS;
  if (fit < size) size = fit > 1 ? (uint32_t)fit : 1;
  return size < total - done ? size : total - done;
}

static void fill_stats(const Render *r, vlRenderStats *stats) {
  memset(stats, 0, sizeof *stats);
  stats->spp = vl_film_spp(r->film);
  stats->seconds = vl_seconds() - r->start;
  for (uint32_t i = 0; i < vl_context_threads(r->world->context); i++) {
    const Worker *w = &r->workers[i];
    if (w->not_finite && !stats->not_finite) stats->worst_x = (uint32_t)w->bad_x, stats->worst_y = (uint32_t)w->bad_y;
    stats->not_finite += w->not_finite;
    stats->paths += w->paths;
    stats->bounce_rays += w->bounce_rays;
    stats->shadow_rays += w->shadow_rays;
  }
  stats->camera_rays = stats->paths;
  if (!r->two_way) return;
  vlTwoWayCounts more = vl_two_way_counts(r->two_way);
  stats->paths += more.paths;
  stats->bounce_rays += more.bounce_rays;
  stats->shadow_rays += more.shadow_rays;
  stats->not_finite += more.not_finite;
}

vlRenderDef vl_default_render_def(void) {
  return (vlRenderDef){.cookie = VL_COOKIE_RENDER,
                       .tracer = VL_TRACER_PATH,
                       .sampler = VL_SAMPLER_ZSOBOL,
                       .spp = 16,
                       .max_depth = 5,
                       .ao_distance = INFINITY,
                       .ao_cosine = true};
}

vlResult vl_render(const vlWorld *world, const vlCamera *camera, vlFilm *film, const vlRenderDef *def,
                   vlRenderStats *stats, vlError *error) {
  vl_error_clear(error);
  vlRenderDef standard = vl_default_render_def();
  if (!def) def = &standard;
  vlResult result = check_arguments(world, camera, film, def, error);
  if (result != VL_OK) return result;
  Render render, *r = &render;
  memset(r, 0, sizeof *r);
  r->world = world;
  r->film = film;
  r->def = def;
  r->caller = pthread_self();
  r->start = r->last_sign = vl_seconds();
  r->spp_before = vl_film_spp(film);
  vlCamera focused = *camera;
  if ((result = vl_camera_autofocus(world, &focused, error)) != VL_OK) return result;
  prepare(r, &focused);
  result = make_workers(r, world->context, error);
  if (result == VL_OK) result = prepare_two_way(r, &focused, error);
  double seconds_per_sample = 0;
  while (result == VL_OK && vl_film_spp(film) < def->spp) {
    if ((result = vl_film_begin_pass(film)) != VL_OK) {
      vl_fail_memory(error);
      break;
    }
    r->first_sample = vl_film_spp(film);
    r->pass_samples = r->two_way ? 1 : pass_size(r->first_sample, def->spp, seconds_per_sample);
    choose_blocks(r);
    if (r->two_way && (result = vl_two_way_light(r->two_way, r->first_sample, error)) != VL_OK) {
      vl_film_abandon_pass(film);
      break;
    }
    double pass_start = vl_seconds();
    atomic_store(&r->blocks_done, 0);
    vl_parallel_for(world->context, block_count(r), render_block, r);
    if (atomic_load(&r->cancelled)) {
      vl_film_abandon_pass(film);
      result = vl_fail(error, VL_CANCELLED, "stopped");
      break;
    }
    vl_film_commit_pass(film);
    seconds_per_sample = (vl_seconds() - pass_start) / r->pass_samples;
    vl_film_set_spp(film, r->first_sample + r->pass_samples);
    if (!report(r, true, vl_film_spp(film)) && vl_film_spp(film) < def->spp)
      result = vl_fail(error, VL_CANCELLED, "stopped");
    if (def->time_limit > 0 && vl_seconds() - r->start >= def->time_limit) break;
  }
  if (stats && r->workers) fill_stats(r, stats);
  vl_two_way_destroy(r->two_way);
  return result;
}
