/* render/two_way.c: see two_way.h. */
#include "render/two_way.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/context.h"
#include "base/error.h"
#include "base/free.h"
#include "film/expose.h"
#include "math/hash.h"
#include "render/camera_view.h"
#include "render/splats.h"
#include "velo/tracer.h"

enum {
  MAX_PATHS = 1 << 20,   /* light paths in a pass, where the scene gives no number */
  MAX_PHOTONS = 1 << 23, /* 512 MB, and the same again sorted; a pass that would store more
                             gets fewer paths */
  FIRST_PHOTONS = 1 << 16,
  MAX_INNER = 1 << 18,    /* light paths in a pass whose vertices camera paths connect to */
  MAX_VERTICES = 1 << 23, /* of them in worlds with media, as MAX_PHOTONS */
  GROUP_PATHS = 8         /* least number of light paths of a group with the same wavelengths */
};
/* vlTwoWay.connect. One connection of a few candidates finds more than one light path would;
 * measured on rooms lit by lamps in shades and on the Cornell box, 3 to 10 have the same error,
 * and 1 has a quarter more. */
static const float CONNECTIONS = 4.0f;
static const uint32_t light_seed = 0x6c696768u, time_seed = 0x74696d65u;

typedef struct Worker {
  struct vlTwoWayRows *rows;
  vlTraceScratch *scratch;
  int32_t px[VL_ROW_SIZE], py[VL_ROW_SIZE];
  uint32_t index[VL_ROW_SIZE];
  float u[VL_ROW_SIZE], time[VL_ROW_SIZE];
  vlCameraView *eyes; /* VL_ROW_SIZE views, of a camera that moves */
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
  char *memory; /* holds the workers' rows */
  vlCameraView *eyes;
  const vlFilmRays *rays;
  float *choice, *extent; /* by light: vlTwoWay.choice, extent */
  uint32_t *medium;       /* by light: vlTwoWay.medium */
  vlSplats splats;
  float exposure, first_radius;
  uint32_t max_paths, paths, index;
  const vlTails *tails;    /* null: a render */
  uint32_t pass_seed;      /* of what all paths of a pass share */
  uint32_t pixels, rounds; /* the light paths are `rounds` samples of each of `pixels` pixels of
                              their own sampler */
  vlPhoton *photons, *sorted;
  uint32_t *start, capacity, buckets;
  vlLightVertex *vertices, *sorted_vertices; /* the pass's vertices, in any order and sorted */
  uint32_t *passed, *sorted_passed;          /* the same of vlLightVertices.passed; null without
                                                attenuation by channel */
  uint32_t *counts, vertex_capacity, inner_paths;
  atomic_uint_least64_t left;
  atomic_uint_least64_t stored;
  vlStop *stop;
  vlLoopDef loop;
  bool starts; /* some light can start paths */
};

bool vl_two_way_tracer(uint32_t tracer) {
  return tracer == VL_TRACER_BIDIRECTIONAL || tracer == VL_TRACER_MERGING ||
         tracer == VL_TRACER_SPPM || tracer == VL_TRACER_LIGHT_PATH;
}
const vlTwoWay *vl_two_way_of(const vlTwoWayRun *run) {
  return &run->way;
}
struct vlTwoWayRows *vl_two_way_rows(const vlTwoWayRun *run, uint32_t worker) {
  return run->workers[worker].rows;
}

void vl_two_way_share(vlTwoWayRun *run, uint32_t seed) {
  run->pass_seed = seed;
}

void vl_two_way_measure(vlTwoWayRun *run, const vlTails *tails, float pixel) {
  run->tails = tails;
  if (tails)
    run->way.light_only = false;
  run->way.alone = tails != NULL;
  if (tails)
    run->way.pixel = pixel;
}

void vl_two_way_use(vlTwoWayRun *run, uint32_t worker, vlTraceScratch *scratch) {
  run->workers[worker].scratch = scratch;
}

/* ---- splats ------------------------------------------------------------------------------ */

static void splat(void *user, uint32_t n, const float *x, const float *y, const float *odds,
                  float *const value[4], float *const lambda[4], float *const inv_pdf[4]) {
  Worker *w = user;
  vlTwoWayRun *run = w->run;
  bool rgb = run->world->def.color == VL_COLOR_RGB;
  vlExposure expose = {.n = n, .exposure = run->exposure};
  for (int c = 0; c < 4; c++) {
    for (uint32_t i = n; n && i < VL_PAD(n); i++) {
      value[c][i] = 0.0f;
      lambda[c][i] = lambda[c][n - 1];
      inv_pdf[c][i] = inv_pdf[c][n - 1];
    }
    expose.radiance[c] = value[c];
    expose.lambda[c] = rgb ? NULL : lambda[c];
    expose.inv_pdf[c] = rgb ? NULL : inv_pdf[c];
  }
  vl_film_expose(run->film, run->trace.isa, &expose, w->color[0], w->color[1], w->color[2]);
  if (run->tails)
    vl_tails_measure(run->tails, n, x, y, odds,
                     (float *const[3]){w->color[0], w->color[1], w->color[2]});
  w->not_finite += vl_splats_add(&run->splats, n, x, y,
                                 (float *const[3]){w->color[0], w->color[1], w->color[2]});
}

void vl_two_way_drop_splats(vlTwoWayRun *run) {
  vl_splats_clear(&run->splats);
}

void vl_two_way_take(vlTwoWayRun *run, uint32_t n, const int32_t *px, const int32_t *py,
                     const float *weight, float *r, float *g, float *b) {
  vl_splats_take(&run->splats, n, px, py, weight, r, g, b);
}

/* ---- light paths ------------------------------------------------------------------------- */

static void store(void *user, uint32_t n, const vlPhoton *photons) {
  Worker *w = user;
  vlTwoWayRun *run = w->run;
  uint64_t at = atomic_fetch_add_explicit(&run->stored, n, memory_order_relaxed);
  if (at + n <= run->capacity)
    memcpy(run->photons + at, photons, n * sizeof *photons);
}

static void leave(void *user, uint32_t n, const vlLightVertex *vertices,
                  const uint32_t *passed) {
  Worker *w = user;
  vlTwoWayRun *run = w->run;
  uint64_t at = atomic_fetch_add_explicit(&run->left, n, memory_order_relaxed);
  if (at + n > run->vertex_capacity)
    return;
  memcpy(run->vertices + at, vertices, n * sizeof *vertices);
  if (run->passed)
    memcpy(run->passed + at, passed, n * sizeof *passed);
}

/* Sorts the pass's vertices by group, path and bounce. A counting sort by path; the few
 * vertices of a path are then sorted by bounce. */
static void sort_vertices(vlTwoWayRun *run, uint32_t count) {
  vlLightVertices *inner = &run->way.inner;
  vlLightVertex *sorted = run->sorted_vertices;
  uint32_t *start = run->counts, paths = inner->paths, groups = inner->groups,
           each = paths / groups;
  memset(start, 0, ((size_t)paths + 1) * sizeof *start);
#define SLOT(X) ((X)->path % groups * each + (X)->path / groups)
  for (uint32_t i = 0; i < count; i++)
    start[SLOT(&run->vertices[i]) + 1]++;
  for (uint32_t i = 0; i < paths; i++)
    start[i + 1] += start[i];
  for (uint32_t g = 0; g <= groups; g++)
    inner->start[g] = start[g * each];
  uint32_t *passed = run->passed ? run->sorted_passed : NULL;
  for (uint32_t i = 0; i < count; i++) {
    uint32_t at = start[SLOT(&run->vertices[i])]++;
    sorted[at] = run->vertices[i];
    if (passed)
      passed[at] = run->passed[i];
  }
#undef SLOT
  for (uint32_t k = 1; k < count; k++) {
    vlLightVertex moving = sorted[k];
    uint32_t at = k, with = passed ? passed[k] : 0;
    for (;
         at > 0 && sorted[at - 1].path == moving.path && sorted[at - 1].bounce > moving.bounce;
         at--) {
      sorted[at] = sorted[at - 1];
      if (passed)
        passed[at] = passed[at - 1];
    }
    if (at == k)
      continue;
    sorted[at] = moving;
    if (passed)
      passed[at] = with;
  }
  inner->vertices = sorted;
  inner->passed = passed;
}

/* Keeps fewer paths' vertices in this pass. Returns false if that is not possible. */
static bool fewer_inner(vlLightVertices *inner, uint64_t left) {
  uint32_t paths = (uint32_t)(inner->paths * (uint64_t)(MAX_VERTICES / 8 * 7) / left) /
                   inner->groups * inner->groups;
  if (paths == 0)
    paths = inner->groups;
  bool fewer = paths < inner->paths;
  inner->paths = paths;
  return fewer;
}

static vlResult grow_vertices(vlTwoWayRun *run, uint64_t wanted, vlError *error) {
  uint64_t capacity = wanted + wanted / 4;
  VL_FREE(run->context, run->vertices, run->sorted_vertices);
  run->vertices = vl_alloc_array(run->context, capacity, sizeof *run->vertices);
  run->sorted_vertices = vl_alloc_array(run->context, capacity, sizeof *run->sorted_vertices);
  bool good = run->vertices && run->sorted_vertices;
  if (run->world->by_channel) {
    VL_FREE(run->context, run->passed, run->sorted_passed);
    run->passed = vl_alloc_array(run->context, capacity, sizeof *run->passed);
    run->sorted_passed = vl_alloc_array(run->context, capacity, sizeof *run->sorted_passed);
    good = good && run->passed && run->sorted_passed;
  }
  run->vertex_capacity = good ? (uint32_t)capacity : 0;
  return good ? VL_OK : vl_fail_memory(error);
}

/* Van der Corput's sequence, rotated by the seed: the wavelengths of any number of passes are
 * evenly distributed. */
static float shared_number(uint32_t seed, uint32_t index) {
  uint32_t x = index;
  x = x << 16 | x >> 16;
  x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
  x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
  x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
  x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
  return vl_unit_float(x + vl_hash2(seed, light_seed));
}

/* The same in base 3: with base 2, wavelength and time would be correlated. */
static float shared_time(const vlTwoWayRun *run, uint32_t index) {
  double turn = vl_hash2(run->pass_seed, time_seed) * 0x1p-32, digit = 1;
  for (uint32_t x = index; x > 0; x /= 3)
    turn += (x % 3) * (digit /= 3);
  return fminf((float)(turn - floor(turn)), VL_ONE_MINUS_EPSILON);
}

void vl_two_way_times(const vlTwoWayRun *run, uint32_t index, vlFilmRays *rays) {
  const vlTwoWay *way = &run->way;
  rays->shared = way->merge ? shared_time(run, index) : -1.0f;
  rays->groups = way->connect > 0.0f && run->world->moves ? way->inner.groups : 0;
  rays->turn = rays->groups ? shared_time(run, index) : 0.0f;
}

const vlCameraView *vl_two_way_cameras(const vlTwoWayRun *run, uint32_t worker, uint32_t n,
                                       const float *u, float *time) {
  const vlCameraCompiled *c = &run->rays->camera;
  const vlCameraTime *t = &c->when;
  vlCameraView *eyes = run->workers[worker].eyes;
  if (!eyes && !time)
    return NULL;
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    double when = c->shutter_open + c->shutter_time * vl_shutter_share(t, (double)u[i]);
    if (time) /* the world is at rest outside [0, 1] */
      time[i] = when > 0 ? (when < 1 ? (float)when : 1.0f) : 0.0f;
    if (!eyes)
      continue;
    double f = (when - t->pose_open) * t->pose_rate;
    eyes[i] = run->way.eye;
    vl_camera_view_move(&eyes[i], vl_motion_between(&t->motion, f > 0 ? (f < 1 ? f : 1) : 0));
  }
  return eyes;
}

/* Samples the numbers (w->u) from which the times of the n light paths from `first` on
 * follow. */
static void draw_times(const vlTwoWayRun *run, uint32_t first, uint32_t n, Worker *w) {
  const vlFilmRays *rays = run->rays;
  if (!rays->centred && rays->groups) {
    for (uint32_t i = 0; i < VL_PAD(n); i++)
      w->u[i] = vl_film_rays_group_time(rays, (first + i) % rays->groups);
    return;
  }
  if (!rays->centred && rays->shared < 0.0f) {
    rays->sampler_kernels->get_1d(&run->way.sampler, n, w->px, w->py, w->index,
                                  VL_DIM_BOUNCE + VL_DIM_LIGHT, w->u);
    return;
  }
  for (uint32_t i = 0; i < VL_PAD(n); i++)
    w->u[i] = rays->centred ? 0.5f : rays->shared;
}

static void light_block(void *user, uint32_t block, uint32_t worker) {
  vlTwoWayRun *run = user;
  Worker *w = &run->workers[worker];
  uint32_t first = block * VL_BATCH, left = run->paths - first,
           n = left < VL_BATCH ? left : VL_BATCH;
  uint32_t width = run->film_def->width;
  if (vl_stop_check(run->stop))
    return;
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    uint32_t path = first + (i < n ? i : n - 1), pixel = path % run->pixels;
    w->px[i] = (int32_t)(pixel % width);
    w->py[i] = (int32_t)(pixel / width);
    w->index[i] = run->index * run->rounds + path / run->pixels;
  }
  vlLightBatch batch = {.n = n,
                        .px = w->px,
                        .py = w->py,
                        .index = w->index,
                        .first = first,
                        .user = w,
                        .splat = splat,
                        .store = store,
                        .leave = leave};
  if (run->rays->moves || run->eyes) {
    draw_times(run, first, n, w);
    batch.eyes = vl_two_way_cameras(run, worker, n, w->u, w->time);
    batch.time = run->rays->moves ? w->time : NULL;
  }
  unsigned state = vl_accel_enter();
  run->kernels->light(run->world, &run->trace, w->scratch, w->rows, &batch);
  vl_accel_leave(state);
  w->paths += n;
  w->bounce_rays += batch.bounce_rays;
  w->shadow_rays += batch.shadow_rays;
}

static vlResult grow(vlTwoWayRun *run, uint64_t wanted, vlError *error) {
  if (wanted <= run->capacity)
    return VL_OK;
  uint64_t capacity = wanted + wanted / 4;
  if (capacity > MAX_PHOTONS)
    capacity = MAX_PHOTONS;
  uint32_t buckets = FIRST_PHOTONS;
  while (buckets < capacity)
    buckets *= 2;
  VL_FREE(run->context, run->photons, run->sorted, run->start);
  run->photons = vl_alloc_array(run->context, capacity, sizeof *run->photons);
  run->sorted = vl_alloc_array(run->context, capacity, sizeof *run->sorted);
  run->start = vl_alloc_array(run->context, (size_t)buckets + 1, sizeof *run->start);
  bool good = run->photons && run->sorted && run->start;
  run->capacity = good ? (uint32_t)capacity : 0;
  run->buckets = buckets;
  return good ? VL_OK : vl_fail_memory(error);
}

/* The radius of a pass. Radii shrink so that both error and bias vanish: r_i^2 = r_1^2 i^(alpha
 * - 1), alpha = 2/3 (Knaus and Zwicker 2011; Georgiev et al. 2012). */
static void set_radius(vlTwoWayRun *run, uint32_t index) {
  vlTwoWay *way = &run->way;
  float radius = run->first_radius * vl_pow((float)(index + 1), -1.0f / 6.0f);
  way->paths = (float)run->paths;
  way->merged = way->merge ? way->paths * VL_PI * radius * radius : 0.0f;
  way->merged_volume = way->merged * radius * (4.0f / 3.0f);
  way->map.radius2 = radius * radius;
}

vlResult vl_two_way_light(vlTwoWayRun *run, uint32_t index, vlStop *stop, vlError *error) {
  if (!run->starts)
    return VL_OK;
  vlTwoWay *way = &run->way;
  run->index = index;
  run->stop = stop;
  run->paths = run->max_paths;
  if (way->merge)
    way->shared = shared_number(run->pass_seed, index);
  if (way->connect > 0.0f)
    way->turn = shared_number(run->pass_seed, index);
  way->inner.paths = run->inner_paths;
  for (;;) {
    set_radius(run, index);
    atomic_store(&run->stored, 0);
    atomic_store(&run->left, 0);
    vl_parallel_for_at(run->context, &run->loop, (run->paths + VL_BATCH - 1) / VL_BATCH,
                       light_block, run);
    if (vl_stop_check(stop))
      return vl_fail(error, VL_CANCELLED, "stopped");
    uint64_t stored = atomic_load(&run->stored);
    uint64_t left = atomic_load(&run->left);
    if (run->world->media.count && left > MAX_VERTICES && fewer_inner(&way->inner, left)) {
      vl_splats_clear(&run->splats);
      continue;
    }
    if (left > run->vertex_capacity) {
      vl_splats_clear(&run->splats); /* the pass is repeated with more memory */
      VL_TRY(grow_vertices(run, left, error));
      continue;
    }
    if (way->inner.paths)
      sort_vertices(run, (uint32_t)left);
    if (!way->merge)
      return VL_OK;
    if (stored <= run->capacity) {
      vl_photon_map_build(&way->map, run->photons, (uint32_t)stored, sqrtf(way->map.radius2),
                          run->sorted, run->start, run->buckets);
      return VL_OK;
    }
    vl_splats_clear(&run->splats); /* the pass is repeated with more memory or fewer paths */
    if (stored > MAX_PHOTONS)
      run->paths = run->paths / 2 > 1 ? run->paths / 2 : 1;
    VL_TRY(grow(run, stored < MAX_PHOTONS ? stored : MAX_PHOTONS, error));
  }
}

/* ---- creation ---------------------------------------------------------------------------- */

static vlResult make_workers(vlTwoWayRun *run, vlError *error) {
  uint32_t threads = vl_context_threads(run->context);
  size_t size = (vl_two_way_rows_size() + 63) & ~(size_t)63;
  run->workers = vl_alloc_array(run->context, threads, sizeof *run->workers);
  run->memory = vl_alloc_array(run->context, threads, size);
  if (!run->workers || !run->memory)
    return vl_fail_memory(error);
  memset((void *)run->workers, 0, threads * sizeof *run->workers);
  memset(run->memory, 0, threads * size);
  for (uint32_t i = 0; i < threads; i++) {
    run->workers[i].run = run;
    run->workers[i].rows = (struct vlTwoWayRows *)(void *)(run->memory + i * size);
  }
  return VL_OK;
}

static vlResult make_eyes(vlTwoWayRun *run, vlError *error) {
  uint32_t threads = vl_context_threads(run->context);
  run->eyes = vl_alloc_array(run->context, (size_t)threads * VL_ROW_SIZE, sizeof *run->eyes);
  if (!run->eyes)
    return vl_fail_memory(error);
  for (uint32_t i = 0; i < threads; i++)
    run->workers[i].eyes = run->eyes + (size_t)i * VL_ROW_SIZE;
  return VL_OK;
}

/* Prepares connections of inner vertices. Groups differ by their wavelengths and, if the world
 * moves, by their times. */
static vlResult make_inner(vlTwoWayRun *run, vlError *error) {
  const vlWorld *world = run->world;
  vlLightVertices *inner = &run->way.inner;
  if ((world->moves && run->trace.same_wavelengths) || run->trace.max_depth < 2)
    return VL_OK;
  uint32_t paths = run->max_paths < MAX_INNER ? run->max_paths : MAX_INNER,
           groups = paths / GROUP_PATHS;
  bool alike = world->def.color == VL_COLOR_RGB && !world->moves;
  groups = groups < 1 || alike ? 1 : groups < VL_MAX_GROUPS ? groups : VL_MAX_GROUPS;
  inner->groups = groups;
  inner->paths = run->inner_paths = paths / groups * groups;
  run->way.connect = CONNECTIONS;
  run->counts = vl_alloc_array(run->context, (size_t)inner->paths + 1, sizeof *run->counts);
  if (!run->counts)
    return vl_fail_memory(error);
  return grow_vertices(run, (uint64_t)inner->paths * 2, error);
}

/* Finds the medium that surrounds each light, in which its light paths start. */
static vlResult find_media(vlTwoWayRun *run, const vlCamera *camera, vlError *error) {
  const vlWorld *world = run->world;
  if (!world->media.count)
    return VL_OK;
  run->way.medium = run->medium =
      vl_alloc_array(run->context, world->lights.count + 1, sizeof *run->medium);
  if (!run->medium)
    return vl_fail_memory(error);
  const double *m = camera->world_from_camera;
  const float eye[3] = {(float)m[3], (float)m[7], (float)m[11]};
  unsigned state = vl_accel_enter();
  run->kernels->light_media(world, eye, run->medium);
  vl_accel_leave(state);
  return VL_OK;
}

/* Sums the areas of the lights of each shape. */
static bool find_extents(vlTwoWayRun *run) {
  const vlWorld *world = run->world;
  size_t n = world->lights.count;
  float *of_shape = vl_alloc_zero(run->context, world->shapes.count + 1, sizeof *of_shape);
  run->extent = vl_alloc_zero(run->context, n + 1, sizeof *run->extent);
  run->way.extent = run->extent;
  bool good = of_shape && run->extent;
  for (size_t i = 0; good && i < n; i++)
    if (world->lights.items[i].shape != VL_NONE)
      of_shape[world->lights.items[i].shape] += world->lights.items[i].area;
  for (size_t i = 0; good && i < n; i++)
    if (world->lights.items[i].shape != VL_NONE)
      run->extent[i] = of_shape[world->lights.items[i].shape];
  vl_free(run->context, of_shape);
  return good;
}

/* The numbers of light paths and their sampler. */
static void set_light_paths(vlTwoWayRun *run, const vlRenderDef *def,
                            const vlSampler *sampler) {
  const vlFilmDef *f = run->film_def;
  const uint64_t pixels = (uint64_t)f->width * f->height;
  run->pixels = pixels < UINT32_MAX ? (uint32_t)pixels : UINT32_MAX;
  run->max_paths = def->light_paths;
  if (def->light_paths == VL_AS_MANY_AS_PIXELS)
    run->max_paths = pixels < MAX_PATHS ? (uint32_t)pixels : MAX_PATHS;
  run->paths = run->max_paths;
  run->rounds =
      run->max_paths > run->pixels ? (run->max_paths + run->pixels - 1) / run->pixels : 1;
  const uint64_t samples = (uint64_t)sampler->spp * run->rounds;
  vl_sampler_init(&run->way.sampler, def->sampler, vl_hash2(def->seed, light_seed), f->width,
                  f->height, samples < UINT32_MAX ? (uint32_t)samples : UINT32_MAX);
}

static vlResult make_run(vlTwoWayRun *run, const vlWorld *world, const vlCamera *camera,
                         vlFilm *film, const vlRenderDef *def, const vlTraceDef *trace,
                         const vlFilmRays *rays, vlError *error) {
  vlContext *context = world->context;
  vlTwoWay *way = &run->way;
  run->context = context;
  run->world = world;
  run->film = film;
  run->film_def = vl_film_def(film);
  run->trace = *trace;
  run->trace.two_way = way;
  run->kernels = vl_trace_kernels(trace->isa);
  run->rays = rays;
  run->loop = vl_loop_def(def->priority, def->cancel);
  run->exposure = (float)camera->exposure_time;
  run->pass_seed = rays->sampler.seed;
  set_light_paths(run, def, &rays->sampler);
  way->light_only = def->tracer == VL_TRACER_LIGHT_PATH;
  way->apart = def->tracer == VL_TRACER_SPPM;
  way->merge = def->tracer == VL_TRACER_MERGING || way->apart;
  way->shared = -1.0f;
  way->pixel = 1.0f;
  run->choice = vl_alloc_zero(context, world->lights.count + 1, sizeof *run->choice);
  way->choice = run->choice;
  if (!run->choice || !find_extents(run) ||
      vl_splats_make(context, film, &run->splats) != VL_OK)
    return vl_fail_memory(error);
  VL_TRY(make_workers(run, error));
  VL_TRY(find_media(run, camera, error));
  run->starts = vl_two_way_choice(world, run->choice) && run->max_paths > 0;
  if (run->max_paths == 0)
    memset(run->choice, 0, (world->lights.count + 1) * sizeof *run->choice);
  if (run->starts)
    vl_camera_view(camera, run->film_def, &way->eye);
  way->eye.camera = &rays->camera;
  if (way->eye.sees && rays->camera.when.moves)
    VL_TRY(make_eyes(run, error));
  if (way->merge && def->merge_radius > 0) /* clamped, so that its cube is finite */
    run->first_radius = (float)fmin(fmax(def->merge_radius, 1e-12), 1e9);
  else if (way->merge)
    VL_TRY(vl_first_radius(world, camera, trace, &run->first_radius, error));
  way->merge = way->merge && run->starts && run->first_radius > 0.0f;
  if (way->merge)
    VL_TRY(grow(run, FIRST_PHOTONS, error));
  set_radius(run, 0);
  if (run->starts && def->tracer == VL_TRACER_BIDIRECTIONAL)
    VL_TRY(make_inner(run, error));
  return VL_OK;
}

vlResult vl_two_way_create(const vlWorld *world, const vlCamera *camera, vlFilm *film,
                           const vlRenderDef *def, const vlTraceDef *trace,
                           const vlFilmRays *rays, vlTwoWayRun **made, vlError *error) {
  *made = NULL;
  vlTwoWayRun *run = vl_alloc_zero(world->context, 1, sizeof *run);
  if (!run)
    return vl_fail_memory(error);
  const vlResult result = make_run(run, world, camera, film, def, trace, rays, error);
  if (result == VL_OK)
    *made = run;
  else
    vl_two_way_destroy(run);
  return result;
}

uint64_t vl_two_way_memory(const vlWorld *world, const vlFilmDef *film,
                           const vlRenderDef *def) {
  enum { VERTICES = 4 }; /* photons per light path, an estimate */
  uint64_t pixels = (uint64_t)film->width * film->height;
  uint64_t paths = def->light_paths == VL_AS_MANY_AS_PIXELS
                       ? (pixels < MAX_PATHS ? pixels : MAX_PATHS)
                       : def->light_paths;
  uint64_t photons = paths * VERTICES < MAX_PHOTONS ? paths * VERTICES : MAX_PHOTONS;
  uint64_t window = (uint64_t)(film->crop[2] - film->crop[0]) * (film->crop[3] - film->crop[1]);
  uint64_t bytes = window * sizeof(*((vlSplats *)0)->pixels);
  if (def->tracer == VL_TRACER_BIDIRECTIONAL)
    bytes +=
        (paths < MAX_INNER ? paths : MAX_INNER) *
        (VERTICES * (sizeof(vlLightVertex) + (world->by_channel ? 3 : 1) * sizeof(uint32_t)) +
         sizeof(uint32_t));
  if (def->tracer == VL_TRACER_MERGING || def->tracer == VL_TRACER_SPPM)
    bytes += photons * 2 * sizeof(vlPhoton);
  return bytes + vl_context_threads(world->context) * vl_two_way_rows_size();
}

void vl_two_way_destroy(vlTwoWayRun *run) {
  if (!run)
    return;
  vlContext *context = run->context;
  VL_FREE(context, run->workers, run->memory, run->eyes, run->choice, run->extent, run->medium);
  vl_splats_free(context, &run->splats);
  VL_FREE(context, run->photons, run->sorted, run->start, run->vertices, run->sorted_vertices,
          run->passed, run->sorted_passed, run->counts, run);
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
