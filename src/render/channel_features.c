/* render/channel_features.c: features for denoisers: albedo, normal and disparity (1 /
 * distance). Each is the mean over camera samples of the image, so that features are
 * antialiased and blurred as the image is: at edges, out of focus, in motion. */
#include <string.h>

#include "render/channel_pass.h"
#include "world/moving.h"

enum { ALBEDO = 0, NORMAL = 3, DISPARITY = 6, COUNT = VL_FEATURES };

/* The time of sample s as a fraction of the exposure: 1/2, 1/4, 3/4, 1/8, ... All pixels of the
 * tile share it. */
static float instant(uint32_t s) {
  float u = 0.0f, digit = 0.5f;
  for (uint32_t k = s + 1; k; k >>= 1, digit *= 0.5f)
    u += (float)(k & 1) * digit;
  return u;
}

static uint32_t min(uint32_t a, uint32_t b) {
  return a < b ? a : b;
}

/* Large regions trace fewer samples in their borders. But a worker has at least four of them,
 * and with different numbers of samples a region is one tile. */
void vl_channel_plan_features(vlChannelPass *p) {
  enum { SIDE = VL_FEATURE_SIDE / VL_CHANNEL_TILE };
  const uint32_t threads = vl_context_threads(p->world->context);
  p->feature_tiles = !p->adaptive && p->tiles / (SIDE * SIDE * 4) >= threads ? SIDE : 1;
}

/* False: no region begins with the tile, or it is empty. */
static bool make_region(const vlChannelPass *p, uint32_t tile, vlFeatureRegion *g) {
  const uint32_t *crop = p->def->crop, side = p->feature_tiles * VL_CHANNEL_TILE;
  uint32_t x, y;
  vl_channel_corner(p, tile, &x, &y);
  *g = (vlFeatureRegion){.x0 = x > crop[0] ? x : crop[0], .y0 = y > crop[1] ? y : crop[1]};
  if (tile % p->tiles_x % p->feature_tiles || tile / p->tiles_x % p->feature_tiles ||
      g->x0 >= crop[2] || g->y0 >= crop[3])
    return false;
  g->width = min(x + side, crop[2]) - g->x0;
  g->height = min(y + side, crop[3]) - g->y0;
  for (int k = 0; k < 2 && p->shares; k++)
    g->border[k] = p->reconstruction.border[k];
  g->stride = g->width + 2 * g->border[0];
  g->count = g->stride * (g->height + 2 * g->border[1]);
  return true;
}

/* Makes the camera rays of sample s of n of the grid's points, from number `done` on, in
 * w->rows and in the batch. */
static void make_rays(vlChannelWorker *w, const vlFilmRays *rays, const vlFeatureRegion *g,
                      uint32_t done, uint32_t n, uint32_t s) {
  vlFilmRayRows r = vl_film_ray_rows(w->rows);
  const vlFeaturePoint *points = w->features->points + done;
  for (uint32_t i = 0; i < n; i++) {
    r.px[i] = (int32_t)(g->x0 + points[i].x) - (int32_t)g->border[0];
    r.py[i] = (int32_t)(g->y0 + points[i].y) - (int32_t)g->border[1];
    r.index[i] = s;
  }
  vl_film_rays_make(rays, n, &r);
  vlGroundTruthBatch *b = w->batch;
  b->n = n;
  for (uint32_t i = 0; i < n; i++) {
    b->o[0][i] = r.rays.ox[i];
    b->o[1][i] = r.rays.oy[i];
    b->o[2][i] = r.rays.oz[i];
    b->d[0][i] = r.rays.dx[i];
    b->d[1][i] = r.rays.dy[i];
    b->d[2][i] = r.rays.dz[i];
  }
  if (rays->moves && rays->camera.when.per_row + rays->camera.when.per_column != 0.0)
    memcpy(b->time, r.rays.time, n * sizeof(float));
  memcpy(b->t_min, r.rays.t_min, n * sizeof(float));
  memcpy(b->t_max, r.rays.t_max, n * sizeof(float));
}

/* Keeps the n hits of the batch in the grid's arrays from element `at` on, with their weights
 * in the pixels around. Negative weights count as 0. */
static void keep(const vlChannelPass *p, vlChannelWorker *w, uint32_t n, uint32_t at) {
  vlFilmRayRows r = vl_film_ray_rows(w->rows);
  const vlGroundTruthBatch *b = w->batch;
  vlFeatureGrid *g = w->features;
  if (p->shares) {
    vl_shared_taps(&p->reconstruction, p->image.filter_kernels, 0, n, r.film_x, g->x[0] + at,
                   VL_FEATURE_GRID);
    vl_shared_taps(&p->reconstruction, p->image.filter_kernels, 1, n, r.film_y, g->y[0] + at,
                   VL_FEATURE_GRID);
  }
  for (uint32_t i = 0; i < n && !p->shares; i++) {
    g->x[0][at + i] = r.weight[i] > 0.0f ? r.weight[i] : 0.0f;
    g->y[0][at + i] = 1.0f;
  }
  /* without a hit albedo and normal are 0, and the distance infinite */
  for (int k = 0; k < 3; k++) {
    memcpy(g->value[ALBEDO + k] + at, b->albedo[k], n * sizeof(float));
    memcpy(g->value[NORMAL + k] + at, b->n_shading[k], n * sizeof(float));
  }
  float *disparity = g->value[DISPARITY] + at;
  for (uint32_t i = 0; i < n; i++)
    disparity[i] = b->distance[i] > 0 ? (float)(1.0 / b->distance[i]) : 0.0f;
}

/* Half of the image's samples, since features cost about a half of what the shortest paths
 * cost; but at least FEW, and at most VL_FEATURE_SAMPLES. */
static uint32_t samples_of(uint32_t spp) {
  enum { FEW = 8 };
  return spp <= FEW ? spp : spp <= 2 * FEW ? FEW : min(spp / 2, VL_FEATURE_SAMPLES);
}

/* ---- points ------------------------------------------------------------------------------ */

/* Makes all pixels count samples, and lists all points. Returns their number. */
static uint32_t choose_all(vlFeatureGrid *f, const vlFeatureRegion *g) {
  for (uint32_t k = 0; k < VL_FEATURE_PIXELS; k++)
    f->counts[k] = 1.0f;
  memset(f->varies, 0, sizeof f->varies);
  for (uint32_t k = 0; k < g->count; k++)
    f->points[k] = (vlFeaturePoint){(uint8_t)(k % g->stride), (uint8_t)(k / g->stride)};
  return g->count;
}

/* Whether a sample that pixel (x, y) may count lies at a point that varies. */
static bool varies_around(const vlFeatureGrid *f, const vlFeatureRegion *g, uint32_t x,
                          uint32_t y) {
  for (uint32_t v = 0; v <= 2 * g->border[1]; v++)
    for (uint32_t u = 0; u <= 2 * g->border[0]; u++)
      if (f->varies[(y + v) * g->stride + x + u] != 0.0f)
        return true;
  return false;
}

/* Makes only the pixels around points that vary count samples, and lists the points that these
 * pixels need. Returns their number. */
static uint32_t choose_varying(vlFeatureGrid *f, const vlFeatureRegion *g) {
  bool needed[VL_FEATURE_GRID] = {false};
  for (uint32_t y = 0; y < g->height; y++)
    for (uint32_t x = 0; x < g->width; x++) {
      bool varies = varies_around(f, g, x, y);
      f->counts[y * VL_FEATURE_SIDE + x] = varies ? 1.0f : 0.0f;
      for (uint32_t v = 0; v <= 2 * g->border[1] && varies; v++)
        memset(needed + (y + v) * g->stride + x, true, 2 * g->border[0] + 1);
    }
  uint32_t n = 0;
  for (uint32_t k = 0; k < g->count; k++)
    if (needed[k])
      f->points[n++] = (vlFeaturePoint){(uint8_t)(k % g->stride), (uint8_t)(k / g->stride)};
  return n;
}

/* Moves the values of the n listed points from the beginning of a row of the grid to their
 * places. The other elements have no meaning then. */
static void place_row(const vlFeatureGrid *f, uint32_t stride, uint32_t n, float *row) {
  for (uint32_t i = n; i-- > 0;)
    row[f->points[i].y * stride + f->points[i].x] = row[i];
}

static void place(vlFeatureGrid *f, const vlFeatureRegion *g, uint32_t n) {
  if (n == g->count)
    return;
  for (int k = 0; k < COUNT; k++)
    place_row(f, g->stride, n, f->value[k]);
  for (uint32_t k = 0; k <= 2 * g->border[0]; k++)
    place_row(f, g->stride, n, f->x[k]);
  for (uint32_t k = 0; k <= 2 * g->border[1]; k++)
    place_row(f, g->stride, n, f->y[k]);
}

/* ---- a region ---------------------------------------------------------------------------- */

/* Traces sample s of the n listed points. */
static void trace_sample(const vlChannelPass *p, vlChannelWorker *w, const vlFeatureRegion *g,
                         uint32_t points, uint32_t s) {
  vlFilmRays rays = p->image;
  rays.shared = instant(s);
  double seconds = p->open + (p->close - p->open) * (double)rays.shared;
  for (uint32_t i = 0; i < VL_BATCH; i++)
    w->batch->time[i] = vl_world_time(p->world, seconds);
  for (uint32_t done = 0, n; done < points; done += n) {
    n = min(points - done, VL_BATCH);
    make_rays(w, &rays, g, done, n, s);
    p->ground_truth_kernels->trace(p->world, &p->features, w->scratch, w->batch);
    keep(p, w, n, done);
  }
  place(w->features, g, points);
}

/* Writes the means to the channels. */
static void write_means(const vlChannelPass *p, const vlFeatureGrid *f,
                        const vlFeatureRegion *g) {
  for (uint32_t y = 0; y < g->height; y++)
    for (uint32_t x = 0; x < g->width; x++) {
      uint32_t k = y * VL_FEATURE_SIDE + x;
      float weight = f->sums[COUNT][k],
            *to =
                vl_channel_floats(p, vl_channel_at(p, g->x0 + x, g->y0 + y), VL_INDEX_FEATURES);
      for (int i = 0; i < COUNT; i++)
        to[i] = weight > 0.0f ? f->sums[i][k] / weight : 0.0f;
    }
}

/* Where the first FIRST samples agree, the others would hardly change the mean. But what moves
 * may pass at the time of a later one. */
void vl_channel_features(const vlChannelPass *p, vlChannelWorker *w, uint32_t tile) {
  enum { FIRST = 4 };
  const vlFeatureKernels *kernels = vl_feature_kernels(vl_context_isa(p->world->context));
  vlFeatureGrid *f = w->features;
  vlFeatureRegion g;
  if (!make_region(p, tile, &g))
    return;
  memset(f->sums, 0, sizeof f->sums);
  const uint32_t samples = samples_of(vl_channel_spp(p, tile));
  const bool moves = p->world->moves || p->image.camera.when.moves;
  uint32_t points = choose_all(f, &g);
  for (uint32_t s = 0; s < samples && points > 0; s++) {
    trace_sample(p, w, &g, points, s);
    kernels->add(f, &g);
    if (s == 0)
      memcpy(f->first, f->value, sizeof f->first);
    if (s > 0 && s < FIRST)
      kernels->compare(f, g.count);
    if (s + 1 == FIRST && samples > FIRST && !moves)
      points = choose_varying(f, &g);
  }
  write_means(p, f, &g);
}
