/* render/block.c: see block.h. */
#include "render/block.h"

#include <math.h>
#include <string.h>

#include "film/expose.h"

enum { TILE_PIXELS = VL_RENDER_TILE * VL_RENDER_TILE };

/* Rows after those of vlFilmRayRows. */
enum Row {
  LAMBDA = VL_ROW_LAMBDA,
  INV_PDF = VL_ROW_INV_PDF,
  RADIANCE = VL_ROW_RADIANCE,
  ALPHA = RADIANCE + 4,
  RED = VL_ROW_RED,
  GREEN,
  BLUE,
  ROWS
};
_Static_assert((int)ROWS == (int)VL_RENDER_ROWS, "a worker's memory");

static float *row(vlRenderWorker *w, int r) {
  return w->rows + (size_t)r * VL_ROW_SIZE;
}

/* Every second bit of a Morton index. */
static uint32_t morton_half(uint32_t m) {
  m &= 0x55555555u;
  m = (m | m >> 1) & 0x33333333u;
  m = (m | m >> 2) & 0x0f0f0f0fu;
  return (m | m >> 4) & 0x00ff00ffu;
}

static void block_corner(const vlRenderRun *r, uint32_t block, uint32_t *x, uint32_t *y) {
  uint32_t blocks_x = (r->tiles_x + r->span_x - 1) / r->span_x;
  *x = (r->tile_x0 + block % blocks_x * r->span_x) * VL_RENDER_TILE;
  *y = (r->tile_y0 + block / blocks_x * r->span_y) * VL_RENDER_TILE;
}

/* Lists the samples of this batch: the pixels of the block's tiles inside the crop window,
 * times the samples of the batch. Returns the number of lanes. */
static uint32_t list_samples(const vlRenderRun *r, vlRenderWorker *w, uint32_t block,
                             uint32_t first, uint32_t count) {
  vlFilmRayRows rows = vl_film_ray_rows(w->rows);
  int32_t *px = rows.px, *py = rows.py;
  uint32_t *index = rows.index, n = 0;
  bool some = r->adaptive.in_pass < r->adaptive.blocks;
  uint32_t pixels = r->span_x * r->span_y * TILE_PIXELS, x0, y0;
  block_corner(r, block, &x0, &y0);
  for (uint32_t s = first; s < first + count; s++)
    /* Morton order: two tiles lie side by side, four in a square */
    for (uint32_t m = 0; m < pixels; m++) {
      uint32_t x = x0 + morton_half(m), y = y0 + morton_half(m >> 1);
      if (x < r->crop[0] || y < r->crop[1] || x >= r->crop[2] || y >= r->crop[3])
        continue;
      if (some && !vl_adaptive_has(&r->adaptive, x, y))
        continue;
      px[n] = (int32_t)x;
      py[n] = (int32_t)y;
      index[n] = s;
      n++;
    }
  return n;
}

/* Each counter has one writing thread, so that load and store suffice; no atomic
 * read-modify-write. */
static void count_more(_Atomic uint64_t *total, uint64_t more) {
  atomic_store_explicit(total, atomic_load_explicit(total, memory_order_relaxed) + more,
                        memory_order_relaxed);
}

/* Where the camera has no ray (outside an image circle, beyond a fold) radiance and alpha are
 * 0, even if the scene has a sky. */
static void clear_invalid(uint32_t n, const float *valid, float *alpha,
                          float *const radiance[4]) {
  for (uint32_t i = 0; i < n; i++) {
    if (valid[i] > 0.0f)
      continue;
    alpha[i] = 0.0f;
    for (int c = 0; c < 4; c++)
      radiance[c][i] = 0.0f;
  }
}

/* Multiplies radiance by the camera ray's weight. Alpha stays 1 where the lens blocks a part of
 * the light: vignetting is black, not transparent. A weight of NaN makes the film leave the
 * sample out. */
static void weigh(uint32_t n, const float *weight, const float *valid, float *alpha,
                  float *const radiance[4]) {
  for (uint32_t i = 0; i < n; i++) {
    for (int c = 0; c < 4; c++)
      radiance[c][i] = weight[i] <= 0.0f ? 0.0f : radiance[c][i] * weight[i];
    alpha[i] = weight[i] > 0.0f || !(valid[i] > 0.0f) ? alpha[i] : 1.0f;
  }
}

/* Removes the background. */
static void clear_background(uint32_t n, const float *alpha, float *const radiance[4]) {
  for (int c = 0; c < 4; c++)
    for (uint32_t i = 0; i < n; i++)
      radiance[c][i] = alpha[i] > 0.0f ? radiance[c][i] : 0.0f;
}

/* Traces and exposes the n samples that the worker's rows list: alpha, red, green, blue. */
static void trace_batch(const vlRenderRun *r, vlRenderWorker *w, uint32_t n) {
  const vlCameraCompiled *camera = &r->film_rays.camera;
  vlFilmRayRows rows = vl_film_ray_rows(w->rows);
  const vlCameraRays rays = rows.rays;
  vl_film_rays_make(&r->film_rays, n, &rows);
  vlTraceBatch batch = {.n = n,
                        .rays = vl_film_world_rays(&r->film_rays, &rays),
                        .px = rows.px,
                        .py = rows.py,
                        .index = rows.index,
                        .alpha = row(w, ALPHA),
                        .recorder = w->recorder};
  bool irradiance = r->trace.irradiance;
  vlExposure expose = {.n = n, .exposure = irradiance ? 1.0f : r->exposure_time};
  for (int c = 0; c < 4; c++) {
    expose.radiance[c] = batch.radiance[c] = row(w, RADIANCE + c);
    expose.lambda[c] = batch.lambda[c] = r->rgb_mode ? NULL : row(w, LAMBDA + c);
    expose.inv_pdf[c] = batch.inv_pdf[c] = r->rgb_mode ? NULL : row(w, INV_PDF + c);
  }
  if (r->two_way) {
    batch.two_way = vl_two_way_rows(r->two_way, (uint32_t)(w - r->workers));
    batch.eyes = vl_two_way_cameras(r->two_way, (uint32_t)(w - r->workers), n, rows.time, NULL);
  }
  r->trace_kernels->trace(r->world, &r->trace, w->scratch, &batch);
  if (r->def->transparent)
    clear_background(n, batch.alpha, batch.radiance);
  if (vl_camera_weighted(camera) && !irradiance)
    weigh(n, rays.weight, rays.valid, batch.alpha, batch.radiance);
  if (!camera->plain)
    clear_invalid(n, rays.valid, batch.alpha, batch.radiance);
  if (vl_film_def(r->film)->buckets && !w->recorder) {
    vlFilmSpectra spectra = {.n = n, .px = rows.px, .py = rows.py, .weight = rows.weight};
    for (int c = 0; c < 4; c++) {
      spectra.radiance[c] = batch.radiance[c];
      spectra.lambda[c] = batch.lambda[c];
    }
    vl_film_add_spectra(r->film, &spectra);
  }
  vl_film_expose(r->film, r->trace.isa, &expose, row(w, RED), row(w, GREEN), row(w, BLUE));
  if (w->recorder)
    return;
  w->merge_work += batch.merge_work;
  count_more(&w->paths, n);
  count_more(&w->bounce_rays, batch.bounce_rays);
  count_more(&w->shadow_rays, batch.shadow_rays);
}

/* Adds the n samples in the worker's rows to the film. */
static void add_to_film(const vlRenderRun *r, vlRenderWorker *w, uint32_t n) {
  vlFilmRayRows rows = vl_film_ray_rows(w->rows);
  if (r->two_way)
    vl_two_way_take(r->two_way, n, rows.px, rows.py, rows.weight, row(w, RED), row(w, GREEN),
                    row(w, BLUE));
  if (w->recorder)
    return;
  vlFilmSamples add = {
      n,           rows.px,   rows.py, row(w, RED), row(w, GREEN), row(w, BLUE), row(w, ALPHA),
      rows.weight, rows.index};
  int32_t bad_x = 0, bad_y = 0;
  uint32_t bad = vl_film_add(r->film, &add, &bad_x, &bad_y);
  if (bad && !w->not_finite) {
    w->bad_x = bad_x;
    w->bad_y = bad_y;
  }
  w->not_finite += bad;
}

void vl_render_batch(const vlRenderRun *r, vlRenderWorker *w, uint32_t n) {
  trace_batch(r, w, n);
  add_to_film(r, w, n);
}

/* ---- blocks whose pixels share samples --------------------------------------------------- */

/* The block's pixels inside the crop window; false: there are none in this pass. */
static bool shared_block(const vlRenderRun *r, uint32_t block, vlSharedBlock *b) {
  uint32_t x0, y0;
  block_corner(r, block, &x0, &y0);
  uint32_t x1 = x0 + r->span_x * VL_RENDER_TILE, y1 = y0 + r->span_y * VL_RENDER_TILE;
  if (x0 < r->crop[0])
    x0 = r->crop[0];
  if (y0 < r->crop[1])
    y0 = r->crop[1];
  if (x1 > r->crop[2])
    x1 = r->crop[2];
  if (y1 > r->crop[3])
    y1 = r->crop[3];
  *b = (vlSharedBlock){(int32_t)x0, (int32_t)y0, x1 - x0, y1 - y0};
  if (r->adaptive.in_pass == r->adaptive.blocks)
    return true;
  for (uint32_t y = y0; y < y1; y++)
    for (uint32_t x = x0; x < x1; x++)
      if (vl_adaptive_has(&r->adaptive, x, y))
        return true;
  return false;
}

/* Moves the n traced samples of the batch to their cells of the worker's grids. */
static void store_batch(const vlRenderRun *r, vlRenderWorker *w, const vlSharedBlock *b,
                        uint32_t first, uint32_t n) {
  vlFilmRayRows rows = vl_film_ray_rows(w->rows);
  uint32_t bx = r->reconstruction.border[0], by = r->reconstruction.border[1],
           stride = b->width + 2 * bx;
  vlSharedTaps taps;
  for (uint32_t i = 0; i < n; i++) {
    uint32_t lane = i % VL_SHARED_LANES,
             left = n - i < VL_SHARED_LANES ? n - i : VL_SHARED_LANES;
    for (int axis = 0; axis < 2 && lane == 0; axis++)
      vl_shared_taps(&r->reconstruction, r->film_rays.filter_kernels, axis, left,
                     (axis ? rows.film_y : rows.film_x) + i, taps.along[axis][0],
                     VL_SHARED_LANES);
    float color[4] = {row(w, RED)[i], row(w, GREEN)[i], row(w, BLUE)[i], row(w, ALPHA)[i]};
    int32_t x = rows.px[i] - b->x0, y = rows.py[i] - b->y0;
    float max = fmaxf(fabsf(color[0]), fmaxf(fabsf(color[1]), fabsf(color[2]))),
          sum = color[0] + color[1] + color[2];
    bool good = max < 0x1p39f && sum == sum && color[3] - color[3] == 0.0f;
    bool own = x >= 0 && y >= 0 && (uint32_t)x < b->width && (uint32_t)y < b->height;
    if (!good && own && w->not_finite++ == 0) {
      w->bad_x = rows.px[i];
      w->bad_y = rows.py[i];
    }
    uint32_t at = (uint32_t)(y + (int32_t)by) * stride + (uint32_t)(x + (int32_t)bx);
    vl_shared_store(&r->reconstruction, &w->grids[rows.index[i] - first], at, color, &taps,
                    lane, good);
  }
}

/* Whether to stop. The user's callback runs with its own floating-point state. */
static bool ask_between(vlRenderRun *r, unsigned *state) {
  vl_accel_leave(*state);
  bool stop = vl_stop_check(&r->stop);
  *state = vl_accel_enter();
  return stop;
}

/* Marks those of the n listed samples that no pixel of the block counts. Returns their
 * number. */
static uint32_t skip_listed(const vlRenderRun *r, vlRenderWorker *w, const vlSharedBlock *b,
                            vlSharedGrid *grid, uint32_t n) {
  vlFilmRayRows rows = vl_film_ray_rows(w->rows);
  uint32_t bx = r->reconstruction.border[0], by = r->reconstruction.border[1], skipped = 0;
  if (n)
    vl_film_rays_points(&r->film_rays, n, &rows);
  for (uint32_t i = 0; i < n; i++) {
    uint32_t x = (uint32_t)(rows.px[i] - b->x0) + bx, y = (uint32_t)(rows.py[i] - b->y0) + by;
    if (vl_shared_counts(&r->reconstruction, b, x, y, rows.film_x[i], rows.film_y[i]))
      continue;
    vl_shared_skip(&r->reconstruction, grid, y * (b->width + 2 * bx) + x);
    skipped++;
  }
  return skipped;
}

/* Marks the samples of one index in the block's border that no pixel of the block counts, half
 * of them with a triangle of radius 1. Returns their number. */
static uint32_t skip_useless(const vlRenderRun *r, vlRenderWorker *w, const vlSharedBlock *b,
                             vlSharedGrid *grid, uint32_t sample) {
  vlFilmRayRows rows = vl_film_ray_rows(w->rows);
  uint32_t bx = r->reconstruction.border[0], by = r->reconstruction.border[1], n = 0,
           skipped = 0;
  uint32_t width = b->width + 2 * bx, height = b->height + 2 * by;
  memset(grid->skipped, 0, (size_t)width * height * sizeof *grid->skipped);
  if (!r->reconstruction.skips)
    return 0;
  for (uint32_t y = 0; y < height; y++)
    for (uint32_t x = 0; x < width; x++) {
      if (x == bx && y >= by && y < by + b->height)
        x += b->width; /* the block's own pixels */
      if (x == width)
        break;
      rows.px[n] = b->x0 + (int32_t)x - (int32_t)bx;
      rows.py[n] = b->y0 + (int32_t)y - (int32_t)by;
      rows.index[n++] = sample;
      if (n < VL_BATCH)
        continue;
      skipped += skip_listed(r, w, b, grid, n);
      n = 0;
    }
  return skipped + skip_listed(r, w, b, grid, n);
}

/* Traces the samples [first, first + count) of a block and its border. False: it was
 * stopped. */
static bool trace_shared(vlRenderRun *r, vlRenderWorker *w, const vlSharedBlock *b,
                         uint32_t first, uint32_t count, unsigned *state) {
  vlFilmRayRows rows = vl_film_ray_rows(w->rows);
  int32_t bx = (int32_t)r->reconstruction.border[0], by = (int32_t)r->reconstruction.border[1];
  uint32_t width = b->width + 2 * (uint32_t)bx, height = b->height + 2 * (uint32_t)by;
  uint32_t total = width * height * count, done = 0, n = 0, filled = 0;
  uint32_t across = (width + VL_RENDER_TILE - 1) / VL_RENDER_TILE,
           down = (height + VL_RENDER_TILE - 1) / VL_RENDER_TILE;
  uint32_t slots = across * down * TILE_PIXELS;
  for (uint32_t s = 0; s < count; s++)
    total -= skip_useless(r, w, b, &w->grids[s], first + s);
  uint32_t batches = (total + VL_BATCH - 1) / VL_BATCH;
  for (uint32_t s = first; s < first + count; s++)
    /* tile by tile; in a tile in Morton order, for coherent packets */
    for (uint32_t m = 0; m < slots; m++) {
      uint32_t tile = m / TILE_PIXELS, in = m % TILE_PIXELS;
      uint32_t x = tile % across * VL_RENDER_TILE + morton_half(in);
      uint32_t y = tile / across * VL_RENDER_TILE + morton_half(in >> 1);
      if (x >= width || y >= height || w->grids[s - first].skipped[y * width + x])
        continue;
      rows.px[n] = b->x0 - bx + (int32_t)x;
      rows.py[n] = b->y0 - by + (int32_t)y;
      rows.index[n] = s;
      n++;
      filled++;
      if (filled < (uint64_t)total * (done + 1) / batches)
        continue;
      trace_batch(r, w, n);
      store_batch(r, w, b, first, n);
      done++;
      n = 0;
      if (done < batches && ask_between(r, state))
        return false;
    }
  return true;
}

/* Adds sample `sample` of each pixel of the block's rows [first, last) to the film: the mean
 * over all samples of the grid that the filter covers. */
static void add_rows(const vlRenderRun *r, vlRenderWorker *w, const vlSharedBlock *b,
                     const vlSharedGrid *grid, uint32_t sample, uint32_t first, uint32_t last) {
  vlFilmRayRows rows = vl_film_ray_rows(w->rows);
  float *const color[4] = {row(w, RED), row(w, GREEN), row(w, BLUE), row(w, ALPHA)};
  bool some = r->adaptive.in_pass < r->adaptive.blocks;
  uint32_t n = 0, i = 0;
  vl_shared_gather(&r->reconstruction, grid, b, first, last, color, rows.weight);
  for (uint32_t y = first; y < last; y++)
    for (uint32_t x = 0; x < b->width; x++, i++) {
      uint32_t px = (uint32_t)b->x0 + x, py = (uint32_t)b->y0 + y;
      if (some && !vl_adaptive_has(&r->adaptive, px, py))
        continue;
      if (!(rows.weight[i] > 0.0f)) {
        if (!w->recorder)
          vl_film_miss(r->film, (int32_t)px, (int32_t)py);
        continue;
      }
      rows.px[n] = (int32_t)px;
      rows.py[n] = (int32_t)py;
      rows.index[n] = sample;
      rows.weight[n] = rows.weight[i];
      for (int c = 0; c < 4; c++)
        color[c][n] = color[c][i];
      n++;
    }
  add_to_film(r, w, n);
}

/* Adds `count` samples, from `first` on, of each pixel of the block. A few rows at a time get
 * all of them, while their sums are in the cache. */
static void add_shared(const vlRenderRun *r, vlRenderWorker *w, const vlSharedBlock *b,
                       uint32_t first, uint32_t count) {
  uint32_t rows = VL_BATCH / VL_SHARED_SIDE;
  for (uint32_t y = 0; y < b->height; y += rows)
    for (uint32_t k = 0; k < count; k++)
      add_rows(r, w, b, &w->grids[k], first + k, y,
               b->height - y < rows ? b->height : y + rows);
}

uint32_t vl_render_block_count(const vlRenderRun *r) {
  return ((r->tiles_x + r->span_x - 1) / r->span_x) *
         ((r->tiles_y + r->span_y - 1) / r->span_y);
}

/* Halves blocks until there are `min`, but no side below `side` tiles. */
static void divide_blocks(vlRenderRun *r, uint32_t min, uint32_t side) {
  while (vl_render_block_count(r) < min && (r->span_x > side || r->span_y > side)) {
    if (r->span_y > side && r->span_y >= r->span_x)
      r->span_y /= 2;
    else
      r->span_x /= 2;
  }
}

void vl_render_choose_blocks(vlRenderRun *r) {
  uint32_t threads = vl_context_threads(r->world->context);
  if (!r->shares) {
    r->span_x = r->pass_samples <= 2 ? 2 : 1;
    r->span_y = r->pass_samples <= 1 ? 2 : 1;
    divide_blocks(r, 2 * threads, 1);
    return;
  }
  /* The larger a block, the fewer samples its border has in comparison. Adaptive blocks are 32
   * x 32. Many threads need many blocks to be busy to the end, but those below 64 x 64 only as
   * many as keep them busy at all. */
  r->span_x = r->span_y =
      r->adaptive.in_pass < r->adaptive.blocks ? 2 : VL_SHARED_SIDE / VL_RENDER_TILE;
  if (threads > 1) {
    divide_blocks(r, 16 * threads, 4);
    divide_blocks(r, 4 * threads, 1);
  }
}

void vl_render_block(void *user, uint32_t block, uint32_t worker) {
  vlRenderRun *r = user;
  vlRenderWorker *w = &r->workers[worker];
  if (vl_stop_check(&r->stop))
    return;
  unsigned state = vl_accel_enter();
  uint32_t end = r->first_sample + r->pass_samples;
  vlSharedBlock b;
  bool some = r->shares && shared_block(r, block, &b);
  for (uint32_t s = r->first_sample; s < end && !atomic_load(&r->stop.stopped);) {
    uint32_t max =
        r->shares ? VL_SHARED_SAMPLES : VL_BATCH / TILE_PIXELS / (r->span_x * r->span_y);
    uint32_t count = end - s < max ? end - s : max;
    if (!r->shares) {
      uint32_t n = list_samples(r, w, block, s, count);
      if (n)
        vl_render_batch(r, w, n);
    } else if (some) {
      if (trace_shared(r, w, &b, s, count, &state))
        add_shared(r, w, &b, s, count);
    }
    s += count;
    ask_between(r, &state);
  }
  vl_accel_leave(state);
  atomic_fetch_add(&r->blocks_done, 1);
}
