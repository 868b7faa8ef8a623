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

static uint32_t least(uint32_t a, uint32_t b) {
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
  g->width = least(x + side, crop[2]) - g->x0;
  g->height = least(y + side, crop[3]) - g->y0;
  for (int k = 0; k < 2 && p->shares; k++)
    g->border[k] = p->reconstruction.border[k];
  g->stride = g->width + 2 * g->border[0];
  g->count = g->stride * (g->height + 2 * g->border[1]);
  return true;
}

/* Makes the camera rays of sample s of n pixels of the region, from number `done` on, in
 * w->rows and in the batch. */
static void make_rays(vlChannelWorker *w, const vlFilmRays *rays, const vlFeatureRegion *g,
                      uint32_t done, uint32_t n, uint32_t s) {
  vlFilmRayRows r = vl_film_ray_rows(w->rows);
  uint32_t x = done % g->stride, y = done / g->stride;
  for (uint32_t i = 0; i < n; i++) {
    r.px[i] = (int32_t)(g->x0 + x) - (int32_t)g->border[0];
    r.py[i] = (int32_t)(g->y0 + y) - (int32_t)g->border[1];
    r.index[i] = s;
    if (++x == g->stride) {
      x = 0;
      y++;
    }
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

/* Keeps the n hits of the batch at the grid points from `at` on, with their weights in the
 * pixels around. Negative weights count as 0. */
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
  return spp <= FEW ? spp : spp <= 2 * FEW ? FEW : least(spp / 2, VL_FEATURE_SAMPLES);
}

void vl_channel_features(const vlChannelPass *p, vlChannelWorker *w, uint32_t tile) {
  const vlFeatureKernels *kernels = vl_feature_kernels(vl_context_isa(p->world->context));
  vlFilmRays rays = p->image;
  vlFeatureRegion g;
  if (!make_region(p, tile, &g))
    return;
  float(*sums)[VL_FEATURE_PIXELS] = w->features->sums;
  memset(sums, 0, sizeof w->features->sums);
  uint32_t samples = samples_of(vl_channel_spp(p, tile));
  for (uint32_t s = 0; s < samples; s++) {
    rays.shared = instant(s);
    double seconds = p->open + (p->close - p->open) * (double)rays.shared;
    for (uint32_t i = 0; i < VL_BATCH; i++)
      w->batch->time[i] = vl_world_time(p->world, seconds);
    for (uint32_t done = 0, n; done < g.count; done += n) {
      n = least(g.count - done, VL_BATCH);
      make_rays(w, &rays, &g, done, n, s);
      p->ground_truth_kernels->trace(p->world, &p->features, w->scratch, w->batch);
      keep(p, w, n, done);
    }
    kernels->add(w->features, &g);
  }
  for (uint32_t y = 0; y < g.height; y++)
    for (uint32_t x = 0; x < g.width; x++) {
      uint32_t k = y * VL_FEATURE_SIDE + x;
      float *to = vl_channel_floats(p, vl_channel_at(p, g.x0 + x, g.y0 + y), VL_INDEX_FEATURES);
      for (int i = 0; i < COUNT; i++)
        to[i] = sums[COUNT][k] > 0.0f ? sums[i][k] / sums[COUNT][k] : 0.0f;
    }
}
