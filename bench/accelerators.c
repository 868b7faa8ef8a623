/* bench/accelerators.c: the BVH beside Embree (vlBuildDef.accelerator), with portable bits. A
 * scene is rendered and every ray is recorded; both accelerators then trace the same rays, one
 * after the other, several times. Prints the processor time of the builds, their memory, the
 * time per ray, Embree's over the BVH's, and the number of rays with different results. Usage:
 * bench_accelerators SCENE [SPP [SIZE]] */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/context.h"
#include "measure.h"
#include "velo/velo.h"
#include "world/world.h"

enum { ROUNDS = 5, KINDS = 3, ROWS = 9 /* o, d, t_min, t_max, time */ };

/* Rays of a batch. */
typedef struct Batch {
  int kind;
  uint32_t n;
  float *rows[ROWS];
  uint32_t *ids[2]; /* of each accelerator: shape, prim, instance of each ray; or whether it is
                       blocked */
} Batch;

typedef struct Record {
  Batch *batches;
  size_t count, capacity;
} Record;

static void record(void *user, int kind, uint32_t n, const vlRays *r) {
  Record *record = user;
  if (n == 0)
    return;
  if (record->count == record->capacity) {
    record->capacity = 2 * record->capacity + 1024;
    record->batches = realloc(record->batches, record->capacity * sizeof *record->batches);
    if (!record->batches)
      exit(1);
  }
  Batch *b = &record->batches[record->count++];
  *b = (Batch){.kind = kind, .n = n};
  const float *from[ROWS] = {r->ox, r->oy,    r->oz,    r->dx,  r->dy,
                             r->dz, r->t_min, r->t_max, r->time};
  for (int k = 0; k < ROWS; k++) {
    if (!from[k])
      continue;
    b->rows[k] = malloc(n * sizeof(float));
    if (!b->rows[k])
      exit(1);
    memcpy(b->rows[k], from[k], n * sizeof(float));
  }
  for (int k = 0; k < 2; k++)
    if (!(b->ids[k] = calloc(n, 3 * sizeof(uint32_t))))
      exit(1);
}

static void trace(const vlWorld *world, const Batch *b, int which) {
  float *const *r = b->rows;
  vlRays rays = {r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], NULL};
  uint32_t *ids = b->ids[which];
  static float t[1 << 20];
  if (b->n > sizeof t / sizeof *t)
    return;
  if (b->kind < 2)
    vl_accel_closest(world, b->n, &rays, b->kind == 0, ids, ids + b->n, ids + 2 * (size_t)b->n,
                     t);
  else
    vl_accel_occluded(world, b->n, &rays, NULL, (uint8_t *)ids);
}

/* Traces all rays of a kind. The threads' other work does not count. */
static double time_kind(const vlWorld *world, const Record *record, int kind, int which) {
  double begin = processor_seconds();
  for (size_t i = 0; i < record->count; i++)
    if (record->batches[i].kind == kind)
      trace(world, &record->batches[i], which);
  return processor_seconds() - begin;
}

/* The number of rays with different results. */
static uint64_t different(const Record *record, int kind) {
  uint64_t count = 0;
  for (size_t i = 0; i < record->count; i++) {
    const Batch *b = &record->batches[i];
    for (uint32_t k = 0; b->kind == kind && k < b->n; k++) {
      bool same = true;
      if (kind == 2)
        same = ((uint8_t *)b->ids[0])[k] == ((uint8_t *)b->ids[1])[k];
      for (uint32_t j = 0; kind < 2 && j < 3; j++)
        same = same && b->ids[0][j * b->n + k] == b->ids[1][j * b->n + k];
      count += !same;
    }
  }
  return count;
}

/* Embree's first. Those of a small world are brute force, without which both answer. */
static bool build(vlContext *context, vlScene *scene, vlWorld *worlds[2], vlError *error) {
  static const char *const names[2] = {"embree", "bvh"};
  double seconds[2];
  size_t bytes[2];
  vlBuildDef def = vl_scene_defs(scene)->build;
  for (int k = 0; k < 2; k++) {
    def.accelerator = k ? VL_ACCELERATOR_BVH : VL_ACCELERATOR_EMBREE;
    size_t before = vl_context_memory(context, NULL);
    double begin = processor_seconds();
    if (vl_world_build(scene, &def, &worlds[k], error) != VL_OK)
      return false;
    seconds[k] = processor_seconds() - begin;
    bytes[k] = vl_context_memory(context, NULL) - before;
    vl_free(context, worlds[k]->accel.brute_force);
    worlds[k]->accel.brute_force = NULL;
    printf("world with %-6s %8.3f s %8.1f MB\n", names[k], seconds[k], 1e-6 * (double)bytes[k]);
  }
  return true;
}

static bool render(vlContext *context, const vlWorld *world, const vlSceneDefs *defs) {
  vlCamera camera;
  vlFilm *film = NULL;
  vlRenderStats stats;
  if (vl_camera_make(&defs->camera, &camera, NULL, NULL) != VL_OK)
    return false;
  if (vl_film_create(context, &defs->film, &film) != VL_OK)
    return false;
  bool rendered = vl_render(world, &camera, film, &defs->render, &stats, NULL) == VL_OK;
  vl_film_destroy(film);
  return rendered;
}

int main(int argc, char **argv) {
  static const char *const names[KINDS] = {"camera", "bounce", "shadow"};
  vlContext *context = NULL;
  vlScene *scene = NULL;
  vlWorld *worlds[2];
  vlError error;
  vlContextDef context_def = vl_default_context_def();
  context_def.threads = 1;
  if (argc < 2 || vl_context_create(&context_def, &context) != VL_OK ||
      vl_scene_create(context, &scene) != VL_OK)
    return 2;
  vlLoadDef load = vl_default_load_def();
  load.permissive = true;
  if (vl_scene_load(scene, argv[1], &load, &error) != VL_OK ||
      !build(context, scene, worlds, &error)) {
    fprintf(stderr, "accelerators: %s\n", error.message);
    return 1;
  }
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->render.spp = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 1;
  uint32_t width = argc > 3 ? (uint32_t)strtoul(argv[3], NULL, 10) : 256;
  uint32_t height = (uint32_t)((double)width * defs->film.height / defs->film.width);
  defs->camera.width = width;
  defs->camera.height = height;
  defs->film = vl_default_film_def(width, height);
  Record rays = {0};
  worlds[0]->accel.log = record;
  worlds[0]->accel.log_user = &rays;
  if (!render(context, worlds[0], defs))
    return 1;
  worlds[0]->accel.log = NULL;
  unsigned state = vl_accel_enter();
  for (int kind = 0; kind < KINDS; kind++) {
    double seconds[2][ROUNDS];
    uint64_t n = 0;
    for (size_t i = 0; i < rays.count; i++)
      n += rays.batches[i].kind == kind ? rays.batches[i].n : 0;
    for (int round = 0; n && round < ROUNDS; round++)
      for (int k = 0; k < 2; k++)
        seconds[k][round] = time_kind(worlds[k], &rays, kind, k);
    if (!n)
      continue;
    double embree = 1e9 * median(seconds[0], ROUNDS) / (double)n,
           bvh = 1e9 * median(seconds[1], ROUNDS) / (double)n;
    printf("%s %10llu rays: embree %6.0f ns, bvh %6.0f ns, ratio %.3f; %llu different\n",
           names[kind], (unsigned long long)n, embree, bvh, embree / bvh,
           (unsigned long long)different(&rays, kind));
  }
  vl_accel_leave(state);
  return 0;
}
