/* bench/loading.c: the time until a large scene is ready, compared with its lower bounds:
 * reading the files' bytes, and Embree's build of the same triangles. Usage: bench_loading
 * FOLDER (made by bench/loading/make_scene.py). Each of the three runs in its own process, so
 * that memory is measured separately. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#if VELO_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "base/context.h"
#include "base/file.h"
#include "velo/velo.h"
#include "world/world.h"

typedef struct Result {
  double read, load, build, embree;
  double geometry, accelerator, peak; /* bytes */
  uint64_t triangles;
} Result;

static double peak(void) {
  struct rusage u;
  getrusage(RUSAGE_SELF, &u);
  return (double)u.ru_maxrss * 1024;
}

/* Reads the bytes only, on one thread, into one block. */
static void run_read(const char *folder, Result *r) {
  char path[4096];
  static char block[1 << 20];
  snprintf(path, sizeof path, "%s/models", folder);
  DIR *d = opendir(path);
  double start = vl_seconds();
  for (struct dirent *e; d && (e = readdir(d));) {
    snprintf(path, sizeof path, "%s/models/%s", folder, e->d_name);
    FILE *f = fopen(path, "rb");
    while (f && fread(block, 1, sizeof block, f) == sizeof block)
      continue;
    if (f)
      fclose(f);
  }
  r->read = vl_seconds() - start;
  if (d)
    closedir(d);
}

static vlWorld *make(const char *folder, vlContext **context, Result *r) {
  char path[4096];
  vlError error = {0};
  vlScene *scene = NULL;
  vlWorld *world = NULL;
  snprintf(path, sizeof path, "%s/scene.pbrt", folder);
  double start = vl_seconds();
  vlResult result = vl_context_create(NULL, context);
  if (result == VL_OK)
    result = vl_scene_create(*context, &scene);
  if (result == VL_OK)
    result = vl_scene_load(scene, path, NULL, &error);
  r->load = vl_seconds() - start;
  start = vl_seconds();
  if (result == VL_OK)
    result = vl_world_build_last(scene, NULL, &world, &error);
  r->build = vl_seconds() - start;
  if (result != VL_OK)
    fprintf(stderr, "%s\n", error.message);
  vl_scene_destroy(scene);
  return world;
}

static void run_velo(const char *folder, Result *r) {
  vlContext *context = NULL;
  vlWorld *world = make(folder, &context, r);
  r->peak = peak();
  vl_world_destroy(world);
  vl_context_destroy(context);
}

static bool count_bytes(void *user, ssize_t bytes, bool post) {
  (void)post;
  __atomic_add_fetch((int64_t *)user, bytes, __ATOMIC_RELAXED);
  return true;
}

/* Builds one geometry per shape with the renderer's flags. */
static void run_embree(const char *folder, Result *r) {
  Result ignored = {0};
  vlContext *context = NULL;
  vlWorld *world = make(folder, &context, &ignored);
  if (!world)
    return;
  int64_t bytes = 0;
  char config[64];
  snprintf(config, sizeof config, "threads=%u", vl_context_threads(context));
  RTCDevice device = rtcNewDevice(config);
  rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
  double start = vl_seconds();
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  for (size_t i = 0; i < world->shapes.count; i++) {
    const vlWorldShape *s = &world->shapes.items[i];
    if (s->kind != VL_SHAPE_TRIANGLES)
      continue;
    RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, s->positions, 0,
                               12, s->vertices);
    rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, s->indices, 0, 12,
                               s->faces);
    rtcCommitGeometry(g);
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);
    r->triangles += s->faces;
    r->geometry +=
        12.0 * s->faces + s->vertices * (12.0 + (s->normals ? 12 : 0) + (s->uvs ? 8 : 0));
  }
  rtcCommitScene(scene);
  r->embree = vl_seconds() - start;
  r->accelerator = (double)bytes;
}

static Result in_child(void (*run)(const char *, Result *), const char *folder) {
  int ends[2];
  Result r = {0};
  if (pipe(ends) != 0)
    return r;
  pid_t child = fork();
  if (child == 0) {
    run(folder, &r);
    _exit(write(ends[1], &r, sizeof r) == (ssize_t)sizeof r ? 0 : 1);
  }
  close(ends[1]);
  if (read(ends[0], &r, sizeof r) != (ssize_t)sizeof r)
    fprintf(stderr, "a run failed\n");
  close(ends[0]);
  waitpid(child, NULL, 0);
  return r;
}

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

int main(int argc, char **argv) {
  enum { ROUNDS = 5 };
  if (argc != 2) {
    fprintf(stderr, "usage: bench_loading FOLDER\n");
    return 2;
  }
  double ratio[ROUNDS];
  Result velo = {0}, embree = {0}, bytes;
  /* interleaved, so that changes of the machine's speed affect all alike */
  for (int i = 0; i < ROUNDS; i++) {
    bytes = in_child(run_read, argv[1]);
    embree = in_child(run_embree, argv[1]);
    velo = in_child(run_velo, argv[1]);
    ratio[i] = (velo.load + velo.build) / (bytes.read + embree.embree);
    printf("read %.3f s + Embree %.3f s; velo: load %.3f s + build %.3f s; ratio %.2f\n",
           bytes.read, embree.embree, velo.load, velo.build, ratio[i]);
  }
  qsort(ratio, ROUNDS, sizeof *ratio, by_value);
  printf("triangles %llu: time ratio %.2f (median)\n", (unsigned long long)embree.triangles,
         ratio[ROUNDS / 2]);
  printf("geometry %.0f MB + accelerator %.0f MB; velo's peak %.0f MB: ratio %.2f\n",
         embree.geometry / 1e6, embree.accelerator / 1e6, velo.peak / 1e6,
         velo.peak / (embree.geometry + embree.accelerator));
  return 0;
}
