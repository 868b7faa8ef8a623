/* render/channel_samples.c: ground truth of a pixel's area. The image's own samples are traced
 * once more, up to their first hit. They give Cryptomatte's coverages. If a pixel's values are
 * not those at its centre, the samples also determine the film point of the values.
 *
 * All sums are sums of integers. */
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "render/channel_pass.h"

/* Rows after those of vlFilmRayRows. */
enum Row { OBJECT = VL_FILM_ROWS, MATERIAL, INSTANCE, DISTANCE, ROWS };
_Static_assert((int)ROWS <= (int)VL_CHANNEL_ROWS, "rows are shared");

/* ---- tallies ----------------------------------------------------------------------------- */

static void tally_clear(vlTally *t) {
  t->count = 0;
  if (++t->round)
    return;
  memset(t, 0, sizeof *t);
  t->round = 1;
}

static vlTallyEntry *tally_find(vlTally *t, uint64_t key) {
  vlTallyEntry *e = &t->slots[t->last];
  if (e->round == t->round && e->key == key)
    return e;
  uint32_t at = (uint32_t)((key * UINT64_C(0x9e3779b97f4a7c15)) >> 54); /* top 10 bits */
  for (;; at = (at + 1) % VL_TALLY_SLOTS) {
    e = &t->slots[at];
    if (e->round == t->round && e->key != key)
      continue;
    t->last = at;
    if (e->round == t->round)
      return e;
    if (t->count == VL_MAX_TALLY)
      return NULL;
    t->used[t->count++] = at;
    *e = (vlTallyEntry){.key = key, .round = t->round, .off = INFINITY};
    return e;
  }
}

/* The entry of the largest weight; of equal ones the one with the smallest key, so that the
 * order of insertion does not matter. */
static vlTallyEntry *tally_best(vlTally *t) {
  vlTallyEntry *best = NULL;
  for (uint32_t i = 0; i < t->count; i++) {
    vlTallyEntry *e = &t->slots[t->used[i]];
    if (!best || e->weight > best->weight || (e->weight == best->weight && e->key < best->key))
      best = e;
  }
  return best;
}

/* ---- samples ----------------------------------------------------------------------------- */

/* State of counting one pixel's samples, for the choice of a film point or for Cryptomatte. */
typedef struct Count {
  const vlFilmRays *rays;
  bool matte;
  uint32_t spp;             /* samples per pixel in this tile */
  int64_t total;            /* weight of the pixel's samples */
  float off, x, y, nearest; /* for the choice: squared distance from the centre and film point
                               of the chosen sample; depth of the nearest surface */
} Count;

static void add_choice(const vlChannelPass *p, vlChannelWorker *w, Count *c,
                       const vlSampleHit *hit, int64_t weight) {
  float off = (hit->x - 0.5f) * (hit->x - 0.5f) + (hit->y - 0.5f) * (hit->y - 0.5f);
  if (p->def->mode == VL_CHANNEL_MODE_NEAREST) {
    if (!(hit->z < c->nearest) && !(hit->z == c->nearest && off < c->off))
      return;
    c->nearest = hit->z;
    c->off = off;
    c->x = hit->x;
    c->y = hit->y;
    return;
  }
  vlTallyEntry *e = tally_find(&w->tallies[0], (uint64_t)hit->ids[2] << 32 | hit->ids[0]);
  if (!e)
    return;
  e->weight += weight;
  if (off < e->off) {
    e->off = off;
    e->x = hit->x;
    e->y = hit->y;
  }
}

static void add_matte(const vlChannelPass *p, vlChannelWorker *w, const vlSampleHit *hit,
                      int64_t weight) {
  for (uint32_t k = 0; k < 3; k++) {
    if (!hit->ids[k] || !vl_channel_wanted(p, VL_CHANNEL_CRYPTO_OBJECT << k))
      continue;
    vlTallyEntry *e = tally_find(&w->tallies[k], hit->ids[k]);
    if (e)
      e->weight += weight;
  }
}

/* Adds a sample to the pixel; its film point is relative to the pixel's corner. Weights are
 * rounded as the film rounds them. Negative weights of a filter's lobes count for no id. */
static void add(const vlChannelPass *p, vlChannelWorker *w, Count *c, const vlSampleHit *hit,
                float filter_weight) {
  int64_t weight = filter_weight > 0.0f ? (int64_t)((double)filter_weight * 0x1p24 + 0.5) : 0;
  c->total += weight;
  if (c->matte)
    add_matte(p, w, hit, weight);
  else
    add_choice(p, w, c, hit, weight);
}

/* Writes the ranks by decreasing weight: the hash as the bits of a float, and its share of the
 * pixel. */
static void put_matte(const vlChannelPass *p, vlChannelWorker *w, size_t at, int64_t total) {
  for (uint32_t k = 0; k < 3; k++) {
    if (!vl_channel_wanted(p, VL_CHANNEL_CRYPTO_OBJECT << k))
      continue;
    float *to = vl_channel_floats(p, at, VL_INDEX_CRYPTO + k);
    for (uint32_t rank = 0; rank < p->def->ranks; rank++) {
      vlTallyEntry *e = tally_best(&w->tallies[k]);
      if (!e || e->weight <= 0)
        break;
      uint32_t id = (uint32_t)e->key;
      memcpy(to + 2 * rank, &p->crypto[k].hash[id - 1], sizeof(float));
      to[2 * rank + 1] = (float)((double)e->weight / (double)total);
      atomic_store_explicit(&p->crypto[k].seen[id - 1], 1, memory_order_relaxed);
      e->weight = 0;
    }
  }
}

static void begin_pixel(vlChannelWorker *w, Count *c) {
  for (int k = 0; k < 3; k++)
    tally_clear(&w->tallies[k]);
  c->total = 0;
  c->off = c->nearest = INFINITY;
  c->x = c->y = 0.5f;
}

static void end_pixel(const vlChannelPass *p, vlChannelWorker *w, const Count *c, uint32_t x,
                      uint32_t y) {
  if (c->matte) {
    put_matte(p, w, vl_channel_at(p, x, y), c->total);
    return;
  }
  uint32_t k = y % VL_CHANNEL_TILE * VL_CHANNEL_TILE + x % VL_CHANNEL_TILE;
  w->film_x[k] = c->x;
  w->film_y[k] = c->y;
  if (p->def->mode != VL_CHANNEL_MODE_COVERAGE)
    return;
  const vlTallyEntry *e = tally_best(&w->tallies[0]);
  if (e) {
    w->film_x[k] = e->x;
    w->film_y[k] = e->y;
  }
}

/* Traces the first n of the worker's rows. */
static void trace(const vlChannelPass *p, vlChannelWorker *w, const Count *c, uint32_t n) {
  vlFilmRayRows r = vl_film_ray_rows(w->rows);
  vl_film_rays_make(c->rays, n, &r);
  bool depths = !c->matte && p->def->mode == VL_CHANNEL_MODE_NEAREST;
  vlGroundTruthHits hits = {.n = n,
                            .rays = vl_film_world_rays(c->rays, &r.rays),
                            .object = (uint32_t *)(void *)vl_channel_row(w, OBJECT),
                            .material = (uint32_t *)(void *)vl_channel_row(w, MATERIAL),
                            .instance = (uint32_t *)(void *)vl_channel_row(w, INSTANCE),
                            .distance = depths ? vl_channel_row(w, DISTANCE) : NULL};
  p->ground_truth_kernels->hits(p->world, &p->ground_truth, w->scratch, &hits);
  for (uint32_t i = 0; i < n && !depths; i++)
    vl_channel_row(w, DISTANCE)[i] = INFINITY;
}

/* The hit of row i. */
static vlSampleHit hit_of(const vlChannelPass *p, vlChannelWorker *w, uint32_t i) {
  static const uint32_t rows[3] = {OBJECT, MATERIAL, INSTANCE};
  vlSampleHit hit = {.x = vl_channel_row(w, VL_FILM_X)[i],
                     .y = vl_channel_row(w, VL_FILM_Y)[i],
                     .z = INFINITY};
  for (int k = 0; k < 3; k++)
    hit.ids[k] = ((uint32_t *)(void *)vl_channel_row(w, rows[k]))[i];
  float t = vl_channel_row(w, DISTANCE)[i];
  if (!(t < INFINITY))
    return hit;
  const int32_t *px = (int32_t *)(void *)vl_channel_row(w, VL_FILM_PIXEL_X),
                *py = (int32_t *)(void *)vl_channel_row(w, VL_FILM_PIXEL_Y);
  double q[3], m[12], back[12];
  vl_camera_pose_at(&p->compiled, vl_channel_time(p, px[i], py[i]), back, m);
  for (uint32_t k = 0; k < 3; k++)
    q[k] = (double)vl_channel_row(w, VL_FILM_RAY + k)[i] +
           (double)t * (double)vl_channel_row(w, VL_FILM_RAY + 3 + k)[i];
  hit.z = (float)(m[8] * q[0] + m[9] * q[1] + m[10] * q[2] + m[11]);
  return hit;
}

/* ---- pixels with samples of their own ---------------------------------------------------- */

static void flush(const vlChannelPass *p, vlChannelWorker *w, Count *c, uint32_t n) {
  if (n == 0)
    return;
  vlFilmRayRows r = vl_film_ray_rows(w->rows);
  trace(p, w, c, n);
  for (uint32_t i = 0; i < n; i++) {
    vlSampleHit hit = hit_of(p, w, i);
    if (r.index[i] == p->first_sample)
      begin_pixel(w, c);
    add(p, w, c, &hit, r.weight[i]);
    if (r.index[i] == p->first_sample + c->spp - 1)
      end_pixel(p, w, c, (uint32_t)r.px[i], (uint32_t)r.py[i]);
  }
}

static void count_own(const vlChannelPass *p, vlChannelWorker *w, Count *c, uint32_t tile) {
  vlFilmRayRows rows = vl_film_ray_rows(w->rows);
  uint32_t n = 0, x, y;
  for (uint32_t k = 0; k < VL_TILE_PIXELS; k++) {
    if (!vl_channel_pixel(p, tile, k, &x, &y))
      continue;
    for (uint32_t s = 0; s < c->spp; s++) {
      rows.px[n] = (int32_t)x;
      rows.py[n] = (int32_t)y;
      rows.index[n] = p->first_sample + s;
      if (++n < VL_BATCH)
        continue;
      flush(p, w, c, n);
      n = 0;
    }
  }
  flush(p, w, c, n);
}

/* ---- pixels that share samples (reconstruct.h) ------------------------------------------- */

/* A square of pixels, from x0, y0 on, and its samples [first, first + count). With its border
 * it has `width` x `height` pixels. w->hits holds them sample by sample, row by row. */
typedef struct Square {
  int32_t x0, y0;
  uint32_t side, width, height, first, count;
} Square;

static void trace_square(const vlChannelPass *p, vlChannelWorker *w, const Count *c,
                         const Square *q) {
  const uint32_t *border = p->reconstruction.border;
  vlFilmRayRows rows = vl_film_ray_rows(w->rows);
  uint32_t pixels = q->width * q->height, total = pixels * q->count;
  for (uint32_t done = 0, n; done < total; done += n) {
    n = total - done < VL_BATCH ? total - done : VL_BATCH;
    for (uint32_t i = 0; i < n; i++) {
      uint32_t k = (done + i) % pixels;
      rows.px[i] = q->x0 - (int32_t)border[0] + (int32_t)(k % q->width);
      rows.py[i] = q->y0 - (int32_t)border[1] + (int32_t)(k / q->width);
      rows.index[i] = p->first_sample + q->first + (done + i) / pixels;
    }
    trace(p, w, c, n);
    for (uint32_t i = 0; i < n; i++)
      w->hits[done + i] = hit_of(p, w, i);
  }
}

/* Adds the square's samples that count in its pixel (x, y). */
static void add_shared(const vlChannelPass *p, vlChannelWorker *w, Count *c, const Square *q,
                       uint32_t x, uint32_t y) {
  int32_t bx = (int32_t)p->reconstruction.border[0], by = (int32_t)p->reconstruction.border[1];
  const vlSampleHit *hits = w->hits;
  for (uint32_t s = 0; s < q->count; s++, hits += q->width * q->height)
    for (int32_t v = -by; v <= by; v++)
      for (int32_t u = -bx; u <= bx; u++) {
        vlSampleHit hit = hits[(y + (uint32_t)(v + by)) * q->width + x + (uint32_t)(u + bx)];
        float weight = vl_shared_weight(&p->reconstruction, hit.x, hit.y, -u, -v);
        hit.x += (float)u;
        hit.y += (float)v;
        if (weight > 0.0f)
          add(p, w, c, &hit, weight);
      }
}

/* Counts the pixels of a square. All samples of its pixels are held at once, except if it is a
 * single pixel. */
static void count_square(const vlChannelPass *p, vlChannelWorker *w, Count *c, Square *q) {
  const uint32_t *crop = p->def->crop;
  uint32_t max = VL_SHARED_HITS / (q->width * q->height);
  for (q->first = 0; q->first < c->spp; q->first += q->count) {
    q->count = c->spp - q->first < max ? c->spp - q->first : max;
    trace_square(p, w, c, q);
    for (uint32_t k = 0; k < q->side * q->side; k++) {
      uint32_t x = (uint32_t)q->x0 + k % q->side, y = (uint32_t)q->y0 + k / q->side;
      if (x < crop[0] || y < crop[1] || x >= crop[2] || y >= crop[3])
        continue;
      if (q->first == 0)
        begin_pixel(w, c);
      add_shared(p, w, c, q, k % q->side, k / q->side);
      if (q->first + q->count == c->spp)
        end_pixel(p, w, c, x, y);
    }
  }
}

static void count_shared(const vlChannelPass *p, vlChannelWorker *w, Count *c, uint32_t tile) {
  const uint32_t *border = p->reconstruction.border, *crop = p->def->crop;
  uint32_t x0, y0;
  vl_channel_corner(p, tile, &x0, &y0);
  Square q = {.side = VL_CHANNEL_TILE};
  for (;; q.side /= 2) {
    q.width = q.side + 2 * border[0];
    q.height = q.side + 2 * border[1];
    if (q.side == 1 || (uint64_t)q.width * q.height * c->spp <= VL_SHARED_HITS)
      break;
  }
  for (uint32_t y = y0; y < y0 + VL_CHANNEL_TILE; y += q.side)
    for (uint32_t x = x0; x < x0 + VL_CHANNEL_TILE; x += q.side) {
      if (x + q.side <= crop[0] || y + q.side <= crop[1] || x >= crop[2] || y >= crop[3])
        continue;
      q.x0 = (int32_t)x;
      q.y0 = (int32_t)y;
      count_square(p, w, c, &q);
    }
}

static void count(const vlChannelPass *p, vlChannelWorker *w, const vlFilmRays *rays,
                  bool matte, uint32_t tile) {
  Count c = {.rays = rays, .matte = matte, .spp = vl_channel_spp(p, tile)};
  if (p->shares)
    count_shared(p, w, &c, tile);
  else
    count_own(p, w, &c, tile);
}

void vl_channel_count(const vlChannelPass *p, vlChannelWorker *w, uint32_t tile) {
  if (p->def->mode != VL_CHANNEL_MODE_CENTRE)
    count(p, w, &p->choice, false, tile);
  if (vl_channel_wanted(p, VL_CHANNEL_CRYPTO_OBJECT | VL_CHANNEL_CRYPTO_MATERIAL |
                               VL_CHANNEL_CRYPTO_INSTANCE))
    count(p, w, &p->image, true, tile);
}
