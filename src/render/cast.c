/* render/cast.c: rays of the caller (velo/rays.h): reads them from the caller's arrays batch by
 * batch, has them traced on the workers, and writes what is wanted to the caller's arrays. */
#include "base/text.h"
#include "velo/rays.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/cancel.h"
#include "base/cookie.h"
#include "base/error.h"
#include "base/free.h"
#include "trace/cast/cast.h"
#include "world/moving.h"

/* A worker's memory. */
typedef struct CastWorker {
  vlTraceScratch *scratch;
  vlCastBatch *batch;
} CastWorker;

typedef struct Cast {
  const vlWorld *world;
  const vlCastRays *rays;
  const vlCastDef *def;
  const vlCastHits *hits; /* null: occlusion */
  uint8_t *occluded;
  uint32_t wanted; /* bits VL_CAST_* */
  const vlCastKernels *kernels;
  CastWorker *workers;
  atomic_uint_fast64_t met, not_finite, zero_directions, too_far;
} Cast;

vlCastDef vl_default_cast_def(void) {
  return (vlCastDef){.cookie = VL_COOKIE_CAST, .hits = 1};
}

/* ---- reading ----------------------------------------------------------------------------- */

/* What becomes of a ray. */
typedef enum Fate { TRACED, EMPTY, NOT_FINITE, ZERO_DIRECTION, TOO_FAR } Fate;

static inline double largest(const double rows[3][VL_ROW_SIZE], uint32_t i) {
  double x = fabs(rows[0][i]), y = fabs(rows[1][i]), z = fabs(rows[2][i]);
  x = x > y ? x : y;
  return x > z ? x : z;
}

/* The sum of differences that are 0 for finite numbers, else NaN. */
static inline double unsound(const double rows[3][VL_ROW_SIZE], uint32_t i) {
  return (rows[0][i] - rows[0][i]) + (rows[1][i] - rows[1][i]) + (rows[2][i] - rows[2][i]);
}

static Fate fate_of(const vlCastBatch *b, const double *time, uint32_t i) {
  double sum =
      unsound(b->o, i) + unsound(b->d, i) + (b->start[i] - b->start[i]) + (time[i] - time[i]);
  double length = largest(b->d, i);
  if (sum != 0 || b->end[i] != b->end[i] || length > VL_MAX_CAST_LENGTH)
    return NOT_FINITE;
  if (length == 0)
    return ZERO_DIRECTION;
  if (largest(b->o, i) >= VL_CAST_FAR)
    return TOO_FAR;
  return b->end[i] > b->start[i] ? TRACED : EMPTY;
}

static void move_ray(vlCastBatch *b, double *time, uint32_t from, uint32_t to) {
  for (int j = 0; j < 3; j++) {
    b->o[j][to] = b->o[j][from];
    b->d[j][to] = b->d[j][from];
  }
  b->start[to] = b->start[from];
  b->end[to] = b->end[from];
  time[to] = time[from];
}

/* Reads the rays [first, first + count) and keeps those that are traced; lane[k]: the number of
 * ray k in the call. */
static void read_rays(Cast *c, uint64_t first, uint32_t count, vlCastBatch *b,
                      uint64_t lane[VL_BATCH]) {
  const vlCastRays *r = c->rays;
  double time[VL_BATCH];
  uint64_t fates[TOO_FAR + 1] = {0};
  uint32_t n = 0;
  c->kernels->read_vectors(&r->origins, first, count, b->o);
  c->kernels->read_vectors(&r->directions, first, count, b->d);
  c->kernels->read_numbers(&r->t_min, first, count, 0, b->start);
  c->kernels->read_numbers(&r->t_max, first, count, (double)INFINITY, b->end);
  c->kernels->read_numbers(&r->times, first, count, 0, time);
  b->n = count;
  bool plain = c->kernels->check(b) && !r->times.data;
  for (uint32_t i = 0; plain && i < count; i++)
    lane[i] = first + i;
  for (uint32_t i = 0; !plain && i < count; i++) {
    Fate fate = fate_of(b, time, i);
    fates[fate]++;
    if (fate != TRACED)
      continue;
    if (i != n)
      move_ray(b, time, i, n);
    lane[n++] = first + i;
  }
  n = plain ? count : n;
  for (uint32_t k = 0; k < n; k++)
    b->time[k] = c->world->moves ? vl_world_time(c->world, time[k]) : 0.0f;
  b->n = n;
  if (n == count)
    return;
  atomic_fetch_add(&c->not_finite, fates[NOT_FINITE]);
  atomic_fetch_add(&c->zero_directions, fates[ZERO_DIRECTION]);
  atomic_fetch_add(&c->too_far, fates[TOO_FAR]);
}

/* ---- writing ----------------------------------------------------------------------------- */

/* What rows without a hit have. */
static void clear_rows(const vlCastHits *h, uint64_t first, uint64_t count) {
  const struct {
    void *rows;
    size_t size;
  } all[] = {{h->valid, 1},
             {h->position, 3 * sizeof(double)},
             {h->object, sizeof(uint32_t)},
             {h->instance, sizeof(uint32_t)},
             {h->primitive, sizeof(uint32_t)},
             {h->material, sizeof(uint32_t)},
             {h->normal, 3 * sizeof(float)},
             {h->shading_normal, 3 * sizeof(float)},
             {h->uv, 2 * sizeof(float)},
             {h->velocity, 3 * sizeof(double)}};
  for (size_t k = 0; k < VL_LENGTH(all); k++)
    if (all[k].rows)
      memset((char *)all[k].rows + first * all[k].size, 0, count * all[k].size);
  for (uint64_t i = first; h->t && i < first + count; i++)
    h->t[i] = (double)INFINITY;
  for (uint64_t i = first; h->distance && i < first + count; i++)
    h->distance[i] = (double)INFINITY;
}

/* The hits of a batch: ray[k] of the batch goes to row[k]. */
typedef struct Rows {
  uint32_t count;
  uint16_t ray[VL_BATCH + 1];
  uint64_t row[VL_BATCH + 1];
} Rows;

static void put_ids(const Cast *c, const vlCastBatch *b, const Rows *r) {
  const vlCastHits *h = c->hits;
  const vlWorldShape *shapes = c->world->shapes.items;
  for (uint32_t i = 0; h->valid && i < r->count; i++)
    h->valid[r->row[i]] = 1;
  for (uint32_t i = 0; h->object && i < r->count; i++)
    h->object[r->row[i]] = b->shape[r->ray[i]] + 1;
  for (uint32_t i = 0; h->instance && i < r->count; i++)
    h->instance[r->row[i]] = b->instance[r->ray[i]] + 1; /* VL_NONE + 1 is 0 */
  for (uint32_t i = 0; h->primitive && i < r->count; i++)
    h->primitive[r->row[i]] = b->prim[r->ray[i]] + 1;
  for (uint32_t i = 0; h->material && i < r->count; i++)
    h->material[r->row[i]] = shapes[b->shape[r->ray[i]]].material + 1;
}

/* Rows of `columns` floats; to: null: they are not wanted. */
static void put_floats(const float (*from)[VL_ROW_SIZE], int columns, const Rows *r,
                       float *to) {
  for (uint32_t i = 0; to && i < r->count; i++)
    for (int j = 0; j < columns; j++)
      to[(uint64_t)columns * r->row[i] + (uint64_t)j] = from[j][r->ray[i]];
}

static void put_hits(const Cast *c, const vlCastBatch *b, const Rows *r) {
  const vlCastHits *h = c->hits;
  put_ids(c, b, r);
  for (uint32_t i = 0; h->t && i < r->count; i++)
    h->t[r->row[i]] = b->t[r->ray[i]];
  for (uint32_t i = 0; h->distance && i < r->count; i++)
    h->distance[r->row[i]] = b->distance[r->ray[i]];
  for (uint32_t i = 0; h->position && i < r->count; i++)
    for (uint64_t j = 0; j < 3; j++)
      h->position[3 * r->row[i] + j] =
          b->o[j][r->ray[i]] + b->distance[r->ray[i]] * b->d[j][r->ray[i]];
  put_floats(b->normal, 3, r, h->normal);
  put_floats(b->shading, 3, r, h->shading_normal);
  put_floats(b->uv, 2, r, h->uv);
  for (uint32_t i = 0; h->velocity && i < r->count; i++)
    for (uint64_t j = 0; j < 3; j++)
      h->velocity[3 * r->row[i] + j] = b->velocity[j][r->ray[i]];
}

/* ---- a batch ----------------------------------------------------------------------------- */

static void find_hits(Cast *c, CastWorker *w, uint64_t lane[VL_BATCH]) {
  vlCastBatch *b = w->batch;
  uint32_t hits = c->def->hits, from[VL_ROW_SIZE];
  for (uint32_t step = 0; step < hits && b->n; step++) {
    uint32_t last = step + 1 == hits ? 0 : VL_CAST_ON;
    Rows rows;
    rows.count = 0;
    c->kernels->next(c->world, w->scratch, c->wanted | last, b);
    for (uint32_t k = 0; k < b->n; k++) {
      rows.ray[rows.count] = (uint16_t)k;
      rows.row[rows.count] = lane[k] * hits + step;
      rows.count += b->shape[k] != VL_NONE;
    }
    put_hits(c, b, &rows);
    if (step == 0)
      atomic_fetch_add(&c->met, rows.count);
    if (!last)
      return;
    c->kernels->keep(w->scratch, b, from);
    for (uint32_t k = 0; k < b->n; k++)
      lane[k] = lane[from[k]];
  }
}

static void find_occluded(Cast *c, CastWorker *w, const uint64_t lane[VL_BATCH]) {
  vlCastBatch *b = w->batch;
  uint64_t met = 0;
  c->kernels->occluded(c->world, w->scratch, b);
  for (uint32_t k = 0; k < b->n; k++) {
    c->occluded[lane[k]] = b->occluded[k];
    met += b->occluded[k];
  }
  atomic_fetch_add(&c->met, met);
}

/* Brings the rays of the batch behind the one that begins at `first` into the cache, while that
 * one is traced. */
static void prefetch_next(const Cast *c, uint64_t first) {
  uint64_t next = first + VL_BATCH;
  if (next >= c->rays->count)
    return;
  uint64_t left = c->rays->count - next;
  uint32_t count = left < VL_BATCH ? (uint32_t)left : VL_BATCH;
  c->kernels->prefetch(&c->rays->origins, next, count);
  c->kernels->prefetch(&c->rays->directions, next, count);
}

static void run_batch(void *user, uint32_t index, uint32_t worker) {
  Cast *c = user;
  CastWorker *w = &c->workers[worker];
  uint64_t first = (uint64_t)index * VL_BATCH, left = c->rays->count - first;
  uint32_t count = left < VL_BATCH ? (uint32_t)left : VL_BATCH;
  if (vl_is_cancelled(c->def->cancel))
    return;
  uint64_t lane[VL_ROW_SIZE];
  unsigned state = vl_accel_enter();
  if (c->hits)
    clear_rows(c->hits, first * c->def->hits, (uint64_t)count * c->def->hits);
  else
    memset(c->occluded + first, 0, count);
  read_rays(c, first, count, w->batch, lane);
  prefetch_next(c, first);
  if (w->batch->n) {
    c->kernels->prepare(c->world, w->scratch, w->batch);
    if (c->hits)
      find_hits(c, w, lane);
    else
      find_occluded(c, w, lane);
  }
  vl_accel_leave(state);
}

/* ---- the call ---------------------------------------------------------------------------- */

static vlResult check(const vlWorld *world, const vlCastRays *rays, const vlCastDef *def,
                      bool output, vlError *error) {
  if (!world || !rays || !def || !output)
    return vl_fail_argument(error, "rays: a pointer is null");
  if (def->cookie != VL_COOKIE_CAST)
    return vl_fail_argument(error, "rays: " VL_BAD_COOKIE);
  if (def->hits < 1 || def->hits > VL_MAX_CAST_HITS)
    return vl_fail_argument(error, "rays: hits is %u; it must be 1 to %d", def->hits,
                            VL_MAX_CAST_HITS);
  if (rays->count && (!rays->origins.data || !rays->directions.data))
    return vl_fail_argument(error, "rays: they need origins and directions");
  if (rays->count > (uint64_t)UINT32_MAX * VL_BATCH)
    return vl_fail_argument(error, "rays: %llu are too many", (unsigned long long)rays->count);
  return VL_OK;
}

/* What the kernel must compute. */
static uint32_t wanted_by(const vlCastHits *h) {
  uint32_t wanted = 0;
  if (h->t || h->distance || h->position)
    wanted |= VL_CAST_DISTANCE;
  if (h->normal || h->uv)
    wanted |= VL_CAST_SURFACE;
  if (h->shading_normal)
    wanted |= VL_CAST_SHADING;
  if (h->velocity)
    wanted |= VL_CAST_VELOCITY;
  return wanted;
}

/* Memory is cleared only where it must be: most calls have few rays. */
static bool open_workers(Cast *c, uint32_t count) {
  vlContext *context = c->world->context;
  size_t size = vl_trace_scratch_size(c->world);
  c->workers = vl_alloc_zero(context, count, sizeof *c->workers);
  for (uint32_t i = 0; c->workers && i < count; i++) {
    CastWorker *w = &c->workers[i];
    w->scratch = c->wanted & VL_CAST_SHADING ? vl_alloc_zero(context, 1, size)
                                             : vl_alloc_array(context, 1, size);
    w->batch = vl_alloc_array(context, 1, sizeof *w->batch);
    if (!w->scratch || !w->batch)
      return false;
    vl_trace_scratch_begin(w->scratch, c->world);
  }
  return c->workers != NULL;
}

static void close_workers(Cast *c, uint32_t count) {
  vlContext *context = c->world->context;
  for (uint32_t i = 0; c->workers && i < count; i++)
    VL_FREE(context, c->workers[i].scratch, c->workers[i].batch);
  vl_free(context, c->workers);
}

static vlResult run(Cast *c, vlCastStats *stats, vlError *error) {
  vlContext *context = c->world->context;
  uint32_t batches = (uint32_t)((c->rays->count + VL_BATCH - 1) / VL_BATCH);
  uint32_t workers = batches > 1 ? vl_context_threads(context) : 1;
  c->kernels = vl_cast_kernels(vl_context_isa(context));
  bool opened = open_workers(c, workers);
  vlLoopDef loop = vl_loop_def(c->def->priority, c->def->cancel);
  if (opened && batches > 1)
    vl_parallel_for_at(context, &loop, batches, run_batch, c);
  else if (opened && batches)
    run_batch(c, 0, 0);
  close_workers(c, workers);
  if (!opened)
    return vl_fail_memory(error);
  if (vl_is_cancelled(c->def->cancel))
    return vl_fail(error, VL_CANCELLED, "rays: cancelled");
  if (stats)
    *stats = (vlCastStats){.rays = c->rays->count,
                           .met = atomic_load(&c->met),
                           .not_finite = atomic_load(&c->not_finite),
                           .zero_directions = atomic_load(&c->zero_directions),
                           .too_far = atomic_load(&c->too_far)};
  return VL_OK;
}

vlResult vl_world_cast(const vlWorld *world, const vlCastRays *rays, const vlCastDef *def,
                       const vlCastHits *hits, vlCastStats *stats, vlError *error) {
  VL_TRY(check(world, rays, def, hits != NULL, error));
  Cast c = {.world = world, .rays = rays, .def = def, .hits = hits, .wanted = wanted_by(hits)};
  return run(&c, stats, error);
}

vlResult vl_world_cast_occluded(const vlWorld *world, const vlCastRays *rays,
                                const vlCastDef *def, uint8_t *occluded, vlCastStats *stats,
                                vlError *error) {
  bool output = occluded || (rays && rays->count == 0);
  VL_TRY(check(world, rays, def, output, error));
  Cast c = {.world = world, .rays = rays, .def = def, .occluded = occluded};
  return run(&c, stats, error);
}
