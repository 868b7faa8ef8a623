/* render/channel_features.c: features for denoisers: albedo, normal and disparity (1 / distance). Each is the mean over
 * camera samples of the image, so that features are antialiased and blurred as the image is: at edges, out of focus, in
 * motion. */
#include <string.h>

#include "render/channel_pass.h"
#include "world/shape/moving.h"

enum { ALBEDO = 0, NORMAL = 3, DISPARITY = 6, COUNT = 7 };

/* The time of sample s as a fraction of the exposure: 1/2, 1/4, 3/4, 1/8, ... All pixels of the tile share it. */
static float instant(uint32_t s) {
  float u = 0.0f, digit = 0.5f;
  for (uint32_t k = s + 1; k; k >>= 1, digit *= 0.5f) u += (float)(k & 1) * digit;
  return u;
}

/* Makes the camera rays of sample s of the tile's pixels, in w->rows and in the batch. Returns their number. */
static uint32_t make_rays(const vlChannelPass *p, vlChannelWorker *w, const vlFilmRays *rays, uint32_t tile,
                          uint32_t s) {
  vlFilmRayRows r = vl_film_ray_rows(w->rows);
  uint32_t n = 0, x, y;
  for (uint32_t k = 0; k < VL_TILE_PIXELS; k++) {
    if (!vl_channel_pixel(p, tile, k, &x, &y)) continue;
    r.px[n] = (int32_t)x, r.py[n] = (int32_t)y, r.index[n] = s;
    n++;
  }
  if (n == 0) return 0;
  for (uint32_t i = n; i < VL_PAD(n); i++) r.px[i] = r.px[n - 1], r.py[i] = r.py[n - 1], r.index[i] = s;
  if (!rays->lens)
    for (uint32_t i = 0; i < VL_PAD(n); i++) r.lens_u[i] = r.lens_v[i] = 0.5f;
  vl_film_rays_make(rays, n, &r);
  vlGroundTruthBatch *b = w->batch;
  for (uint32_t i = 0; i < n; i++) {
    b->o[0][i] = r.rays.ox[i], b->o[1][i] = r.rays.oy[i], b->o[2][i] = r.rays.oz[i];
    b->d[0][i] = r.rays.dx[i], b->d[1][i] = r.rays.dy[i], b->d[2][i] = r.rays.dz[i];
  }
  memcpy(b->t_min, r.rays.t_min, n * sizeof(float));
  memcpy(b->t_max, r.rays.t_max, n * sizeof(float));
  return b->n = n;
}

/* Adds the hits of one sample of each pixel, weighted by the pixel filter; negative weights count as 0. total: sum of
 * the weights of each pixel. */
static void add(const vlChannelPass *p, vlChannelWorker *w, float *total) {
  vlFilmRayRows r = vl_film_ray_rows(w->rows);
  const vlGroundTruthBatch *b = w->batch;
  for (uint32_t i = 0; i < b->n; i++) {
    float weight = r.weight[i] > 0.0f ? r.weight[i] : 0.0f;
    float *to = vl_channel_floats(p, vl_channel_at(p, (uint32_t)r.px[i], (uint32_t)r.py[i]), VL_INDEX_FEATURES);
    total[i] += weight;
    if (b->object[i] == 0) continue;
    for (int k = 0; k < 3; k++) {
      to[ALBEDO + k] += weight * b->albedo[k][i];
      to[NORMAL + k] += weight * b->n_shading[k][i];
    }
    if (b->distance[i] > 0) to[DISPARITY] += weight * (float)(1.0 / b->distance[i]);
  }
}

void vl_channel_features(const vlChannelPass *p, vlChannelWorker *w, uint32_t tile) {
  float total[VL_TILE_PIXELS] = {0};
  vlFilmRays rays = p->image;
  rays.uniform = false; /* few samples: each is of its own pixel, drawn from the filter */
  uint32_t spp = vl_channel_spp(p, tile), samples = spp < VL_FEATURE_SAMPLES ? spp : VL_FEATURE_SAMPLES, n = 0;
  for (uint32_t s = 0; s < samples; s++) {
    rays.shared = instant(s);
    n = make_rays(p, w, &rays, tile, s);
    if (n == 0) return;
    w->batch->time = vl_world_time(p->world, p->open + (p->close - p->open) * (double)rays.shared);
    p->ground_truth_kernels->trace(p->world, &p->features, w->scratch, w->batch);
    add(p, w, total);
  }
  vlFilmRayRows r = vl_film_ray_rows(w->rows);
  for (uint32_t i = 0; i < n; i++) {
    float *to = vl_channel_floats(p, vl_channel_at(p, (uint32_t)r.px[i], (uint32_t)r.py[i]), VL_INDEX_FEATURES);
    for (int k = 0; k < COUNT && total[i] > 0.0f; k++) to[k] /= total[i];
  }
}
