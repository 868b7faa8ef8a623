/* test/fuzz/fuzz_trace.c: ray files of `velo trace`, .csv and .npy (which begin with its magic
 * byte). Rays that are read meet a small world: what they hit has finite numbers, and each ray
 * is counted once. */
#include "fuzz.h"

#include <math.h>
#include <stdarg.h>

#include "cli/options.h"
#include "cli/report.h"
#include "trace/rays_file.h"
#include "velo/rays.h"

/* In place of the program's: a failure has an exit code and a message. */
int report_failure(int status, const char *format, ...) {
  char text[2048];
  va_list arguments;
  va_start(arguments, format);
  int length = vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (status <= STATUS_OK || status > STATUS_IO || length <= 0)
    abort();
  return status;
}

const char *did_you_mean(const char *prefix, const char *wrong, const char *const *names,
                         int count) {
  (void)prefix;
  (void)names;
  if (!wrong || count <= 0)
    abort();
  return "";
}

/* A triangle in a context of its own, for all inputs. */
static const vlWorld *small_world(void) {
  static vlWorld *world;
  static const float positions[9] = {-1, 0, 0, 1, 0, 0, 0, 1, 0};
  static const uint32_t indices[3] = {0, 1, 2};
  vlScene *scene;
  vlError error;
  if (world)
    return world;
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.positions = positions;
  def.indices = indices;
  def.vertices = 3;
  def.faces = 1;
  if (vl_scene_create(fuzz_context(), &scene) != VL_OK)
    exit(1);
  vl_scene_add_shape(scene, &def);
  vlBuildDef build = vl_default_build_def();
  if (vl_world_build(scene, &build, &world, &error) != VL_OK)
    exit(1);
  vl_scene_destroy(scene);
  return world;
}

static void check_hits(const vlCastHits *h, const vlCastStats *stats, uint64_t count) {
  uint64_t met = 0, none = stats->not_finite + stats->zero_directions + stats->too_far;
  for (uint64_t i = 0; i < count; i++) {
    met += h->valid[i];
    const double *p = h->position + 3 * i;
    bool finite = isfinite(h->t[i]) && isfinite(h->distance[i]) && isfinite(p[0]) &&
                  isfinite(p[1]) && isfinite(p[2]);
    if (h->valid[i] ? !finite : h->object[i] != 0)
      abort();
  }
  if (stats->rays != count || stats->met != met || met + none > count)
    abort();
}

static void trace(const RaysFile *rays) {
  double *first = rays->rows[0];
  const int64_t step = sizeof *rays->rows;
  const vlCastRays all = {.count = rays->count,
                          .origins = {first + RAY_ORIGIN, step, true},
                          .directions = {first + RAY_DIRECTION, step, true},
                          .t_max = {first + RAY_T_MAX, step, true},
                          .times = {first + RAY_TIME, step, true},
                          .t_min = {first + RAY_T_MIN, step, true}};
  vlCastHits hits = {.valid = malloc(rays->count),
                     .t = calloc(rays->count, sizeof(double)),
                     .distance = calloc(rays->count, sizeof(double)),
                     .position = calloc(rays->count, 3 * sizeof(double)),
                     .object = calloc(rays->count, sizeof(uint32_t))};
  const vlCastDef def = vl_default_cast_def();
  vlCastStats stats;
  vlError error;
  if (!hits.valid || !hits.t || !hits.distance || !hits.position || !hits.object)
    exit(1);
  if (vl_world_cast(small_world(), &all, &def, &hits, &stats, &error) != VL_OK)
    abort();
  check_hits(&hits, &stats, rays->count);
  free(hits.valid);
  free(hits.t);
  free(hits.distance);
  free(hits.position);
  free(hits.object);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  RaysFile rays;
  bool array = size > 0 && data[0] == 0x93;
  const char *path = fuzz_file(array ? "rays.npy" : "rays.csv", data, size);
  int status = rays_file_read(path, &rays);
  if (rays.count > size / 11 + 1) /* six numbers and five commas; or 24 bytes */
    abort();
  if (status < 0 && rays.count)
    trace(&rays);
  rays_file_free(&rays);
  return 0;
}
