/* bench/limit.c: the renderer's ray throughput relative to Embree's. A diffuse scene of a
 * million triangles, or that of a file, is rendered and every ray is recorded. The same rays
 * are traced by bare Embree calls (packets for camera rays, single calls for others, as in the
 * renderer). Then the renderer is timed. B = traced rays per second / Embree's rays per second,
 * both on all threads, medians of several interleaved rounds. */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#if VELO_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "base/context.h"
#include "base/file.h"
#include "math/hash.h"
#include "measure.h"
#include "velo/velo.h"
#include "world/accel/embree.h"
#include "world/world.h"

enum {
  ROUNDS = 5,
  PACKET = 8 /* as in src/world/accel */,
  SPHERES = 64,
  RINGS = 88,
  SEGMENTS = 90,
  SIZE = 512
};

/* ---- the scene: lumpy spheres in a room with a lamp -------------------------------------- */

static vlMaterialId diffuse(vlScene *scene, float r, float g, float b) {
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  def.reflectance = vl_spectrum_input(vl_spectrum_rgb(r, g, b));
  return vl_scene_add_material(scene, &def);
}

static void add_sphere(vlScene *scene, int which, vlMaterialId material) {
  static float positions[(RINGS + 1) * (SEGMENTS + 1) * 3];
  static uint32_t indices[RINGS * SEGMENTS * 6];
  float cx = (float)(which % 4) * 2.2f - 3.3f, cy = (float)(which / 4 % 4) * 2.2f - 3.3f,
        cz = (float)(which / 16) * 2.2f - 3.3f;
  uint32_t v = 0, t = 0;
  for (int i = 0; i <= RINGS; i++)
    for (int j = 0; j <= SEGMENTS; j++) {
      float theta = (float)M_PI * (float)i / RINGS,
            phi = 2 * (float)M_PI * (float)(j % SEGMENTS) / SEGMENTS;
      float r = 0.8f + 0.1f * sinf(7 * theta + (float)which) * cosf(9 * phi) +
                0.02f * vl_unit_float(
                            vl_hash3((uint32_t)i, (uint32_t)(j % SEGMENTS), (uint32_t)which));
      positions[v++] = cx + r * sinf(theta) * cosf(phi);
      positions[v++] = cy + r * sinf(theta) * sinf(phi);
      positions[v++] = cz + r * cosf(theta);
    }
  for (uint32_t i = 0; i < RINGS; i++)
    for (uint32_t j = 0; j < SEGMENTS; j++) {
      uint32_t a = i * (SEGMENTS + 1) + j, b = a + SEGMENTS + 1;
      uint32_t f[6] = {a, b, a + 1, a + 1, b, b + 1};
      memcpy(indices + t, f, sizeof f);
      t += 6;
    }
  vlShapeDef shape = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  shape.material = material;
  shape.vertices = (RINGS + 1) * (SEGMENTS + 1);
  shape.faces = t / 3;
  shape.positions = positions;
  shape.indices = indices;
  vl_scene_add_shape(scene, &shape);
}

static void add_quad(vlScene *scene, const float p[12], vlMaterialId material,
                     vlEmissionId emission) {
  static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
  vlShapeDef shape = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  shape.material = material;
  shape.emission = emission;
  shape.vertices = 4;
  shape.faces = 2;
  shape.positions = p;
  shape.indices = indices;
  vl_scene_add_shape(scene, &shape);
}

static void build_scene(vlScene *scene) {
  vlMaterialId grey = diffuse(scene, 0.7f, 0.7f, 0.7f), red = diffuse(scene, 0.6f, 0.2f, 0.15f),
               blue = diffuse(scene, 0.2f, 0.3f, 0.6f);
  for (int i = 0; i < SPHERES; i++)
    add_sphere(scene, i, i % 3 == 0 ? grey : i % 3 == 1 ? red : blue);
  vlEmissionDef lamp = vl_default_emission_def();
  lamp.radiance = vl_spectrum_rgb(12, 12, 12);
  vlEmissionId emission = vl_scene_add_emission(scene, &lamp), none = {0};
  const float w = 5.5f;
  const float walls[5][12] = {{-w, -w, -w, w, -w, -w, w, -w, w, -w, -w, w},
                              {-w, w, -w, -w, w, w, w, w, w, w, w, -w},
                              {-w, -w, -w, -w, -w, w, -w, w, w, -w, w, -w},
                              {w, -w, -w, w, w, -w, w, w, w, w, -w, w},
                              {-w, -w, -w, -w, w, -w, w, w, -w, w, -w, -w}};
  for (int i = 0; i < 5; i++)
    add_quad(scene, walls[i], i == 2 ? red : i == 3 ? blue : grey, none);
  const float top[12] = {-2, 5.4f, -2, 2, 5.4f, -2, 2, 5.4f, 2, -2, 5.4f, 2};
  add_quad(scene, top, grey, emission);
}

/* ---- the record -------------------------------------------------------------------------- */

typedef struct Chunk {
  int kind;
  uint32_t n;
  float *ray[8]; /* o, d, t_min, t_max */
} Chunk;

typedef struct Record {
  pthread_mutex_t mutex;
  Chunk *chunks;
  size_t count, capacity;
  uint64_t rays[3];
} Record;

static void record(void *user, int kind, uint32_t n, const vlRays *rays) {
  Record *r = user;
  if (n == 0)
    return;
  Chunk c = {kind, n, {NULL}};
  const float *source[8] = {rays->ox, rays->oy, rays->oz,    rays->dx,
                            rays->dy, rays->dz, rays->t_min, rays->t_max};
  for (int k = 0; k < 8; k++) {
    c.ray[k] = malloc(n * sizeof(float));
    for (uint32_t i = 0; i < n; i++)
      c.ray[k][i] = source[k] ? source[k][i] : k == 6 ? 0.0f : INFINITY;
  }
  pthread_mutex_lock(&r->mutex);
  if (r->count == r->capacity)
    r->chunks = realloc(r->chunks, (r->capacity = 2 * r->capacity + 1024) * sizeof *r->chunks);
  r->chunks[r->count++] = c;
  r->rays[kind] += n;
  pthread_mutex_unlock(&r->mutex);
}

/* ---- bare Embree ------------------------------------------------------------------------- */

typedef struct Bare {
  const Record *record;
  const vlWorld *world;
  int only; /* kind of ray; -1: all */
  uint64_t sum[64];
} Bare;

/* What velo's callbacks (alpha, curved shapes, portable bits) expect behind Embree's context,
 * as in src/world/accel: without a record of the nearest hits, Embree's own counts; nothing is
 * learned about occluders. */
typedef struct Query {
#if VELO_EMBREE_MAJOR >= 4
  struct RTCRayQueryContext context;
#else
  struct RTCIntersectContext context;
#endif
  vlEmbreeQuery q;
} Query;

#if VELO_EMBREE_MAJOR >= 4
#define CONTEXT(c)                                      \
  vlRays rays = rays_of(c);                             \
  Query query = {.q = {.world = world, .rays = &rays}}; \
  struct RTCIntersectArguments closest;                 \
  struct RTCOccludedArguments any;                      \
  rtcInitRayQueryContext(&query.context);               \
  rtcInitIntersectArguments(&closest);                  \
  rtcInitOccludedArguments(&any);                       \
  closest.context = any.context = &query.context;
#define CLOSEST(ray) , (ray), &closest
#define ANY(ray) , (ray), &any
#else
#define CONTEXT(c)                                      \
  vlRays rays = rays_of(c);                             \
  Query query = {.q = {.world = world, .rays = &rays}}; \
  rtcInitIntersectContext(&query.context);
#define CLOSEST(ray) , &query.context, (ray)
#define ANY(ray) , &query.context, (ray)
#endif

static vlRays rays_of(const Chunk *c) {
  return (vlRays){.ox = c->ray[0],
                  .oy = c->ray[1],
                  .oz = c->ray[2],
                  .dx = c->ray[3],
                  .dy = c->ray[4],
                  .dz = c->ray[5],
                  .t_min = c->ray[6],
                  .t_max = c->ray[7]};
}

static uint64_t bare_packets(const vlWorld *world, const Chunk *c) {
  RTCScene scene = world->accel.scene;
  CONTEXT(c)
#if VELO_EMBREE_MAJOR < 4
  query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
  uint64_t sum = 0;
  for (uint32_t first = 0; first < c->n; first += PACKET) {
    struct RTCRayHit8 q;
    int valid[PACKET] __attribute__((aligned(32)));
    for (uint32_t k = 0; k < PACKET; k++) {
      uint32_t i = first + k < c->n ? first + k : c->n - 1;
      valid[k] = first + k < c->n ? -1 : 0;
      q.ray.org_x[k] = c->ray[0][i];
      q.ray.org_y[k] = c->ray[1][i];
      q.ray.org_z[k] = c->ray[2][i];
      q.ray.dir_x[k] = c->ray[3][i];
      q.ray.dir_y[k] = c->ray[4][i];
      q.ray.dir_z[k] = c->ray[5][i];
      q.ray.tnear[k] = c->ray[6][i];
      q.ray.tfar[k] = c->ray[7][i];
      q.ray.time[k] = 0;
      q.ray.mask[k] = (unsigned)-1;
      q.ray.flags[k] = 0;
      q.ray.id[k] = i;
      q.hit.geomID[k] = q.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, scene CLOSEST(&q));
    for (uint32_t k = 0; k < PACKET; k++)
      sum += q.hit.primID[k];
  }
  return sum;
}

static uint64_t bare_single(const vlWorld *world, const Chunk *c) {
  RTCScene scene = world->accel.scene;
  CONTEXT(c)
  uint64_t sum = 0;
  for (uint32_t i = 0; i < c->n; i++) {
    struct RTCRayHit q;
    q.ray.org_x = c->ray[0][i];
    q.ray.org_y = c->ray[1][i];
    q.ray.org_z = c->ray[2][i];
    q.ray.dir_x = c->ray[3][i];
    q.ray.dir_y = c->ray[4][i];
    q.ray.dir_z = c->ray[5][i];
    q.ray.tnear = c->ray[6][i];
    q.ray.tfar = c->ray[7][i];
    q.ray.time = 0;
    q.ray.mask = (unsigned)-1;
    q.ray.id = i;
    q.ray.flags = 0;
    q.hit.geomID = q.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (c->kind == 2) {
      rtcOccluded1(scene ANY(&q.ray));
      sum += q.ray.tfar < 0;
    } else {
      rtcIntersect1(scene CLOSEST(&q));
      sum += q.hit.primID;
    }
  }
  return sum;
}

static void bare_chunk(void *user, uint32_t index, uint32_t worker) {
  Bare *b = user;
  const Chunk *c = &b->record->chunks[index];
  if (b->only >= 0 && c->kind != b->only)
    return;
  unsigned state = vl_accel_enter();
  b->sum[worker & 63] += c->kind == 0 ? bare_packets(b->world, c) : bare_single(b->world, c);
  vl_accel_leave(state);
}

static double time_bare(vlContext *context, const Record *r, const vlWorld *world, int only) {
  Bare b = {r, world, only, {0}};
  double start = vl_seconds();
  vl_parallel_for(context, (uint32_t)r->count, bare_chunk, &b);
  return vl_seconds() - start;
}

/* ---- the renderer ------------------------------------------------------------------------ */

static vlRenderStats render_once(vlContext *context, const vlWorld *world,
                                 const vlSceneDefs *defs) {
  vlCamera camera;
  vlFilm *film = NULL;
  vlRenderStats stats;
  memset(&stats, 0, sizeof stats);
  if (vl_camera_make(&defs->camera, &camera, NULL, NULL) != VL_OK)
    exit(1);
  if (vl_film_create(context, &defs->film, &film) != VL_OK)
    exit(1);
  if (vl_render(world, &camera, film, &defs->render, &stats, NULL) != VL_OK)
    exit(1);
  vl_film_destroy(film);
  return stats;
}

/* The scene of a file, or the one above where file is null; and how its image is taken. */
static bool make_scene(vlScene *scene, const char *file, vlError *error) {
  vlSceneDefs *defs = vl_scene_defs(scene);
  if (file)
    return vl_scene_load(scene, file, NULL, error) == VL_OK;
  build_scene(scene);
  defs->camera = vl_default_camera_def(SIZE, SIZE);
  defs->camera.eye[0] = 0;
  defs->camera.eye[1] = 0.5;
  defs->camera.eye[2] = 16;
  memset(defs->camera.lookat, 0, sizeof defs->camera.lookat);
  defs->camera.fov = 0.7;
  defs->film = vl_default_film_def(SIZE, SIZE);
  defs->render.max_depth = 8;
  return true;
}

/* limit [SCENE] [SPP] */
int main(int argc, char **argv) {
  const char *file = argc > 1 && strtoul(argv[1], NULL, 10) == 0 ? argv[1] : NULL;
  const char *samples = argc > 1 + (file != NULL) ? argv[1 + (file != NULL)] : "4";
  vlContext *context = NULL;
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  vlError error;
  vlContextDef context_def = vl_default_context_def();
  if (getenv("THREADS"))
    context_def.threads = (uint32_t)strtoul(getenv("THREADS"), NULL, 10);
  if (vl_context_create(&context_def, &context) != VL_OK ||
      vl_scene_create(context, &scene) != VL_OK)
    return 1;
  if (!make_scene(scene, file, &error) ||
      vl_world_build(scene, &vl_scene_defs(scene)->build, &world, &error) != VL_OK) {
    fprintf(stderr, "limit: %s\n", error.message);
    return 1;
  }
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->render.spp = (uint32_t)strtoul(samples, NULL, 10);
  vlWorldInfo info;
  vl_world_info(world, &info);
  static const char *const names[3] = {"camera, in packets", "bounce", "shadow"};
  Record log = {.mutex = PTHREAD_MUTEX_INITIALIZER};
  world->accel.log = record;
  world->accel.log_user = &log;
  vlRenderStats first = render_once(context, world, defs);
  world->accel.log = NULL;
  uint64_t rays = log.rays[0] + log.rays[1] + log.rays[2];
  printf("%llu triangles, %u x %u pixels, %u spp, %u threads: %.2f M paths, %.2f rays a path\n",
         (unsigned long long)info.triangles, defs->film.width, defs->film.height,
         defs->render.spp, vl_context_threads(context), 1e-6 * (double)first.paths,
         (double)rays / (double)first.paths);
  double bare[ROUNDS], ours[ROUNDS], bare_work[ROUNDS], our_work[ROUNDS];
  for (int i = 0; i < ROUNDS; i++) {
    double begin = processor_seconds();
    bare[i] = time_bare(context, &log, world, -1);
    bare_work[i] = processor_seconds() - begin;
    begin = processor_seconds();
    ours[i] = render_once(context, world, defs).seconds;
    our_work[i] = processor_seconds() - begin;
  }
  double b = median(bare, ROUNDS), o = median(ours, ROUNDS);
  for (int kind = 0; kind < 3; kind++) {
    double t[3];
    for (int i = 0; i < 3; i++)
      t[i] = time_bare(context, &log, world, kind);
    double m = median(t, 3);
    printf("Embree %-20s %9.3f M rays %8.3f s %8.2f M rays/s %5.1f %% of the render's time\n",
           names[kind], 1e-6 * (double)log.rays[kind], m, 1e-6 * (double)log.rays[kind] / m,
           100 * m / o);
  }
  printf("Embree %-20s %9.3f M rays %8.3f s %8.2f M rays/s\n", "all", 1e-6 * (double)rays, b,
         1e-6 * (double)rays / b);
  printf(
      "velo   %-20s %9.3f M rays %8.3f s %8.2f M rays/s %8.2f M paths/s; shading and all "
      "else %.0f ns a ray and thread\n",
      "all", 1e-6 * (double)rays, o, 1e-6 * (double)rays / o, 1e-6 * (double)first.paths / o,
      1e9 * (o - b) * vl_context_threads(context) / (double)rays);
  printf("by processor time (all threads; where the machine has other work): %.2f\n",
         median(bare_work, ROUNDS) / median(our_work, ROUNDS));
  printf("B = %.2f\n", b / o);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  for (size_t i = 0; i < log.count; i++)
    for (int k = 0; k < 8; k++)
      free(log.chunks[i].ray[k]);
  free(log.chunks);
  vl_context_destroy(context);
  return 0;
}
