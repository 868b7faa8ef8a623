/* render/channel_tile.c: one tile of ground truth: one exact ray per pixel, and its first hit
 * written to the images.
 *
 * All values of a pixel come from one double-precision ray: P = o + t d, z is P's depth, and
 * project(P) is the pixel's film point. Each value is rounded to float once. */
#include <math.h>
#include <string.h>

#include "render/channel_pass.h"
#include "world/moving.h"

void vl_channel_ends(const vlChannelPass *p, vlChannelWorker *w, uint32_t n,
                     const vlChannelEnds *ends, float *t_min, float *t_max) {
  enum { HALF, X, Y, FILM_X, FILM_Y, OX, OY, OZ, DX, DY, DZ, T_MIN, T_MAX, TIME, ROWS };
  _Static_assert((int)ROWS <= (int)VL_CHANNEL_ROWS, "rows are shared");
  float *rows[ROWS];
  for (uint32_t i = 0; i < ROWS; i++)
    rows[i] = vl_channel_row(w, i);
  int32_t *px = (int32_t *)(void *)rows[X], *py = (int32_t *)(void *)rows[Y];
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    uint32_t k = i < n ? i : n - 1;
    rows[HALF][i] = 0.5f;
    rows[FILM_X][i] = ends->film_x[k];
    rows[FILM_Y][i] = ends->film_y[k];
    px[i] = (int32_t)ends->x[k];
    py[i] = (int32_t)ends->y[k];
  }
  vlCameraSamples samples = {.film_x = rows[FILM_X],
                             .film_y = rows[FILM_Y],
                             .pixel_x = px,
                             .pixel_y = py,
                             .lens_u = rows[HALF],
                             .lens_v = rows[HALF],
                             .time = rows[HALF]};
  vlCameraRays rays = {.ox = rows[OX],
                       .oy = rows[OY],
                       .oz = rows[OZ],
                       .dx = rows[DX],
                       .dy = rows[DY],
                       .dz = rows[DZ],
                       .t_min = rows[T_MIN],
                       .t_max = rows[T_MAX],
                       .time = rows[TIME]};
  p->camera_kernels->rays(ends->camera, n, &samples, &rays);
  memcpy(t_min, rays.t_min, n * sizeof(float));
  memcpy(t_max, rays.t_max, n * sizeof(float));
}

/* The number of a pixel's row or column, of those that are exposed one after the other. */
static uint32_t line_of(const vlChannelPass *p, uint32_t x, uint32_t y) {
  return p->columns ? x : y;
}

/* The camera when it exposes a pixel. */
static const vlCamera *camera_of(const vlChannelPass *p, vlChannelWorker *w, uint32_t x,
                                 uint32_t y, vlCamera *held) {
  if (!p->rows)
    return &p->camera;
  *held = p->rolling;
  vl_camera_at(&p->rolling, vl_channel_time(p, (int32_t)x, (int32_t)y), held);
  memcpy(w->depth[line_of(p, x, y) % VL_CHANNEL_TILE], held->camera_from_world + 8,
         sizeof w->depth[0]);
  return held;
}

/* The lanes from `first` on that have the same camera end here. */
static uint32_t end_of_line(const vlChannelPass *p, const vlChannelWorker *w, uint32_t first,
                            uint32_t n) {
  if (!p->rows)
    return n;
  uint32_t last = first + 1, line = line_of(p, w->x[first], w->y[first]);
  while (last < n && line_of(p, w->x[last], w->y[last]) == line)
    last++;
  return last;
}

uint32_t vl_channel_rays(const vlChannelPass *p, vlChannelWorker *w, uint32_t n) {
  vlGroundTruthBatch *b = w->batch;
  double film[VL_TILE_PIXELS][2], o[VL_TILE_PIXELS][3], d[VL_TILE_PIXELS][3];
  uint8_t valid[VL_TILE_PIXELS];
  uint32_t kept = 0;
  vlCamera held;
  for (uint32_t k = 0; k < n; k++) {
    film[k][0] = (double)w->x[k] + (double)w->lane_x[k];
    film[k][1] = (double)w->y[k] + (double)w->lane_y[k];
  }
  for (uint32_t first = 0, last; first < n; first = last) {
    last = end_of_line(p, w, first, n);
    const vlCamera *camera = camera_of(p, w, w->x[first], w->y[first], &held);
    vl_camera_unproject_batch(camera, last - first, film[first], o[first], d[first],
                              valid + first);
  }
  for (uint32_t k = 0; k < n; k++) {
    if (!valid[k])
      continue;
    for (int i = 0; i < 3; i++) {
      b->o[i][kept] = o[k][i];
      b->d[i][kept] = d[k][i];
    }
    w->x[kept] = w->x[k];
    w->y[kept] = w->y[k];
    w->lane_x[kept] = w->lane_x[k];
    w->lane_y[kept] = w->lane_y[k];
    double seconds = vl_channel_time(p, (int32_t)w->x[k], (int32_t)w->y[k]);
    b->time[kept++] = vl_world_time(p->world, seconds);
  }
  b->n = kept;
  if (kept == 0)
    return 0;
  vlChannelEnds ends = {&p->compiled, w->x, w->y, w->lane_x, w->lane_y};
  vl_channel_ends(p, w, kept, &ends, b->t_min, b->t_max);
  return kept;
}

/* Lists the pixels of the tile inside the crop window and makes their rays. */
static uint32_t list_pixels(const vlChannelPass *p, vlChannelWorker *w, uint32_t tile) {
  uint32_t count = 0, x, y;
  for (uint32_t i = 0; i < VL_TILE_PIXELS; i++) {
    uint32_t k = vl_channel_order(p, i);
    if (!vl_channel_pixel(p, tile, k, &x, &y))
      continue;
    w->x[count] = x;
    w->y[count] = y;
    w->lane_x[count] = w->film_x[k];
    w->lane_y[count] = w->film_y[k];
    count++;
  }
  return vl_channel_rays(p, w, count);
}

static void put3(float *to, const float rows[3][VL_ROW_SIZE], uint32_t i) {
  to[0] = rows[0][i];
  to[1] = rows[1][i];
  to[2] = rows[2][i];
}

static void put_floats(const vlChannelPass *p, const vlChannelWorker *w, uint32_t i,
                       size_t at) {
  const vlGroundTruthBatch *b = w->batch;
  bool hit = b->object[i] != 0;
  double t = b->distance[i], point[3] = {0, 0, 0};
  for (int k = 0; k < 3 && hit; k++)
    point[k] = b->o[k][i] + t * b->d[k][i];
  const double *m = p->rows ? w->depth[line_of(p, w->x[i], w->y[i]) % VL_CHANNEL_TILE]
                            : p->camera.camera_from_world + 8;
  double z =
      hit ? m[0] * point[0] + m[1] * point[1] + m[2] * point[2] + m[3] : (double)INFINITY;
  if (vl_channel_wanted(p, VL_CHANNEL_Z))
    *vl_channel_floats(p, at, VL_INDEX_Z) = (float)z;
  if (vl_channel_wanted(p, VL_CHANNEL_DISTANCE))
    *vl_channel_floats(p, at, VL_INDEX_DISTANCE) = (float)t;
  for (int k = 0; k < 3; k++) {
    if (vl_channel_wanted(p, VL_CHANNEL_P))
      vl_channel_floats(p, at, VL_INDEX_P)[k] = (float)point[k];
    if (vl_channel_wanted(p, VL_CHANNEL_RAY))
      vl_channel_floats(p, at, VL_INDEX_RAY)[k] = (float)b->d[k][i];
  }
  if (vl_channel_wanted(p, VL_CHANNEL_N))
    put3(vl_channel_floats(p, at, VL_INDEX_N), b->n_shading, i);
  if (vl_channel_wanted(p, VL_CHANNEL_NG))
    put3(vl_channel_floats(p, at, VL_INDEX_NG), b->n_geometric, i);
  if (vl_channel_wanted(p, VL_CHANNEL_ALBEDO))
    put3(vl_channel_floats(p, at, VL_INDEX_ALBEDO), b->albedo, i);
  if (!vl_channel_wanted(p, VL_CHANNEL_UV))
    return;
  float *uv = vl_channel_floats(p, at, VL_INDEX_UV);
  uv[0] = b->uv[0][i];
  uv[1] = b->uv[1][i];
}

static void put_ids(const vlChannelPass *p, const vlGroundTruthBatch *b, uint32_t i,
                    size_t at) {
  const uint32_t values[4] = {b->object[i], b->material[i], b->instance[i], b->primitive[i]};
  for (uint32_t k = 0; k < 4; k++)
    if (vl_channel_wanted(p, VL_CHANNEL_ID_OBJECT << k))
      *vl_channel_ids(p, at, VL_INDEX_IDS + k) = values[k];
}

uint32_t vl_channel_spp(const vlChannelPass *p, uint32_t tile) {
  if (!p->adaptive)
    return p->spp ? p->spp : p->def->samples;
  const uint32_t *crop = vl_film_def(p->def->film)->crop;
  uint32_t x, y;
  vl_channel_corner(p, tile, &x, &y);
  return vl_film_block_spp(p->def->film, vl_film_block_at(crop, x > crop[0] ? x : crop[0],
                                                          y > crop[1] ? y : crop[1]));
}

/* The tile's pixels of the image inside of the crop: x0, y0, x1, y1. */
static void tile_window(const vlChannelPass *p, uint32_t tile, uint32_t window[4]) {
  const uint32_t *crop = p->def->crop;
  uint32_t x, y;
  vl_channel_corner(p, tile, &x, &y);
  uint32_t right = x + VL_CHANNEL_TILE, below = y + VL_CHANNEL_TILE;
  window[0] = x > crop[0] ? x : crop[0];
  window[1] = y > crop[1] ? y : crop[1];
  window[2] = right < crop[2] ? right : crop[2];
  window[3] = below < crop[3] ? below : crop[3];
}

/* Sets all values of the tile's pixels to 0 but the features: those of a region of several
 * tiles are written with its first one (channel_features.c), maybe before this tile. */
static void zero_tile(const vlChannelPass *p, uint32_t tile) {
  uint32_t window[4];
  tile_window(p, tile, window);
  for (int id = 0; id < 2; id++) {
    if (!p->images[id])
      continue;
    uint32_t *values = vl_image_pixels(p->images[id]); /* as large as floats */
    const bool features = id == 0 && vl_channel_wanted(p, VL_CHANNEL_FEATURES);
    const size_t step = p->step[id], first = features ? p->first[0][VL_INDEX_FEATURES] : 0,
                 behind = features ? first + VL_FEATURES : 0;
    for (uint32_t y = window[1]; y < window[3]; y++)
      for (uint32_t x = window[0]; x < window[2]; x++) {
        uint32_t *pixel = values + vl_channel_at(p, x, y) * step;
        memset(pixel, 0, first * sizeof *pixel);
        memset(pixel + behind, 0, (step - behind) * sizeof *pixel);
      }
  }
}

/* Pixels without a ray get the values of no hit, too. */
static void clear_tile(const vlChannelPass *p, vlChannelWorker *w, uint32_t tile) {
  uint32_t x, y, samples = vl_channel_spp(p, tile);
  for (uint32_t k = 0; k < VL_TILE_PIXELS; k++) {
    w->film_x[k] = w->film_y[k] = 0.5f;
    if (!vl_channel_pixel(p, tile, k, &x, &y))
      continue;
    size_t at = vl_channel_at(p, x, y);
    if (vl_channel_wanted(p, VL_CHANNEL_Z))
      *vl_channel_floats(p, at, VL_INDEX_Z) = INFINITY;
    if (vl_channel_wanted(p, VL_CHANNEL_DISTANCE))
      *vl_channel_floats(p, at, VL_INDEX_DISTANCE) = INFINITY;
    if (vl_channel_wanted(p, VL_CHANNEL_SAMPLES))
      *vl_channel_ids(p, at, VL_INDEX_SAMPLES) = samples;
    for (uint32_t i = 0; i < 2; i++)
      if (vl_channel_wanted(p, VL_CHANNEL_FORWARD << i))
        *vl_channel_ids(p, at, VL_INDEX_FORWARD + i) = VL_HIDDEN_NOWHERE;
  }
}

static void put_film(const vlChannelPass *p, const vlChannelWorker *w, uint32_t tile) {
  uint32_t x, y;
  for (uint32_t k = 0; k < VL_TILE_PIXELS; k++) {
    if (!vl_channel_pixel(p, tile, k, &x, &y))
      continue;
    float *to = vl_channel_floats(p, vl_channel_at(p, x, y), VL_INDEX_FILM);
    to[0] = w->film_x[k];
    to[1] = w->film_y[k];
  }
}

/* Whether a channel needs the ray through the film point of each pixel. */
static bool wants_points(const vlChannelPass *p) {
  const uint32_t others = VL_CHANNEL_SAMPLES | VL_CHANNEL_FILM | VL_CHANNEL_ERROR |
                          VL_CHANNEL_FEATURES | VL_CHANNEL_LUMINANCE | VL_CHANNEL_ILLUMINANCE |
                          VL_CHANNEL_CRYPTO_OBJECT | VL_CHANNEL_CRYPTO_MATERIAL |
                          VL_CHANNEL_CRYPTO_INSTANCE;
  return vl_channel_wanted(p, ~others);
}

/* The film's errors at the tile's pixels, to three floats of each, from number `first` of the
 * channel on. The film has the crop of the channels. */
static void put_errors_of(const vlChannelPass *p, const uint32_t window[4], bool independent,
                          uint32_t channel, uint32_t first) {
  vlDevelopDef def = vl_default_develop_def();
  def.independent = independent;
  def.exposure = p->def->exposure;
  float *to = vl_channel_floats(p, 0, channel) + first;
  vl_film_window_errors(p->def->film, window, &def, to, p->step[0]);
}

static void put_errors(const vlChannelPass *p, uint32_t tile) {
  uint32_t window[4];
  tile_window(p, tile, window);
  put_errors_of(p, window, false, VL_INDEX_ERROR, 0);
  if (vl_channel_wanted(p, VL_CHANNEL_FEATURES))
    put_errors_of(p, window, true, VL_INDEX_FEATURES, VL_FEATURES);
}

void vl_channel_tile(void *pass, uint32_t tile, uint32_t worker) {
  const vlChannelPass *p = pass;
  vlChannelWorker *w = &p->workers[worker];
  if (vl_stop_check(p->stop))
    return;
  zero_tile(p, tile);
  clear_tile(p, w, tile);
  unsigned state = vl_accel_enter();
  if (w->tallies)
    vl_channel_count(p, w, tile);
  if (vl_channel_wanted(p, VL_CHANNEL_FEATURES))
    vl_channel_features(p, w, tile);
  uint32_t n = wants_points(p) ? list_pixels(p, w, tile) : 0;
  vlGroundTruthBatch *b = w->batch;
  if (n)
    p->ground_truth_kernels->trace(p->world, &p->ground_truth, w->scratch, b);
  for (int i = 0; i < 2 && n; i++)
    if (vl_channel_wanted(p, VL_CHANNEL_FORWARD << i))
      vl_channel_flow(p, w, i);
  vl_accel_leave(state);
  if (vl_channel_wanted(p, VL_CHANNEL_ERROR))
    put_errors(p, tile);
  if (vl_channel_wanted(p, VL_CHANNEL_FILM))
    put_film(p, w, tile);
  for (uint32_t i = 0; i < n; i++) {
    size_t at = vl_channel_at(p, w->x[i], w->y[i]);
    put_floats(p, w, i, at);
    put_ids(p, b, i, at);
  }
}
