/* render/media_fit.c: whether the media of a scene fit together (trace/medium/fit.hot.c):
 * traces a batch of volpath's paths from all parts of the image. */

#include "base/context.h"
#include "base/free.h"
#include "camera/rays.h"
#include "render/camera_view.h"
#include "render/support.h"
#include "trace/trace.h"
#include "velo/sampler.h"
#include "velo/tracer.h"

enum { SIDE = 32, DEPTH = 8, ROWS = 22 };
/* Media differ if this share of the radiance arrives over such segments, or if this share of
 * the paths has some. A few paths may slip through edges by rounding, or see a place without
 * light, such as the ground from below. Media also differ if paths leave the world in another
 * medium than that around the sky: nothing arrives through it, but light paths start there. */
static const double LITTLE = 0.0002, MANY = 0.1;
enum { MIN_WRONG = 3 };
_Static_assert(SIDE *SIDE == VL_BATCH, "one batch");

/* Rays through the image's middle of the shutter's time. Returns their number. */
static uint32_t make_rays(const vlCamera *camera, float (*row)[VL_ROW_SIZE], int32_t *px,
                          int32_t *py, uint32_t *index) {
  vlCamera pinhole = vl_opening_pinhole(camera);
  uint32_t n = 0;
  for (int i = 0; i < SIDE * SIDE; i++) {
    double o[3], d[3];
    if (!vl_pinhole_ray(&pinhole, SIDE, i, o, d))
      continue;
    for (int k = 0; k < 3; k++) {
      row[k][n] = (float)o[k];
      row[3 + k][n] = (float)d[k];
    }
    row[6][n] = 0.0f;
    row[7][n] = VL_INFINITY;
    row[8][n] = 0.5f;
    px[n] = i % SIDE;
    py[n] = i / SIDE;
    index[n] = 0;
    n++;
  }
  for (uint32_t i = n; n > 0 && i < VL_PAD(n); i++) {
    for (int k = 0; k < 9; k++)
      row[k][i] = row[k][n - 1];
    px[i] = px[n - 1];
    py[i] = py[n - 1];
    index[i] = index[n - 1];
  }
  return n;
}

typedef struct Room {
  vlMediaFit fit;
  _Alignas(64) float rows[ROWS][VL_ROW_SIZE];
  int32_t px[VL_ROW_SIZE], py[VL_ROW_SIZE];
  uint32_t index[VL_ROW_SIZE];
} Room;

static bool ask(const vlWorld *world, const vlCamera *camera, Room *room,
                uint32_t *light_medium, vlTraceScratch *scratch) {
  vlIsa isa = vl_context_isa(world->context);
  const vlTraceKernels *kernels = vl_trace_kernels(isa);
  vlSampler sampler;
  vl_sampler_init(&sampler, VL_SAMPLER_INDEPENDENT, 1, SIDE, SIDE, 1);
  float(*row)[VL_ROW_SIZE] = room->rows;
  uint32_t n = make_rays(camera, row, room->px, room->py, room->index), wrong = 0;
  if (n == 0)
    return false;
  room->fit.light_medium = light_medium;
  vlTraceDef def = {.tracer = VL_TRACER_VOLPATH,
                    .sampler = &sampler,
                    .isa = isa,
                    .max_depth = DEPTH,
                    .fit = &room->fit};
  bool rgb = world->def.color == VL_COLOR_RGB;
  vlTraceBatch batch = {.n = n,
                        .rays = {row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7],
                                 world->moves ? row[8] : NULL, NULL},
                        .px = room->px,
                        .py = room->py,
                        .index = room->index,
                        .alpha = row[9]};
  for (int c = 0; c < 4; c++) {
    batch.radiance[c] = row[10 + c];
    batch.lambda[c] = rgb ? NULL : row[14 + c];
    batch.inv_pdf[c] = rgb ? NULL : row[18 + c];
  }
  const double *m = camera->world_from_camera;
  const float eye[3] = {(float)m[3], (float)m[7], (float)m[11]};
  unsigned state = vl_accel_enter();
  vl_trace_scratch_begin(scratch, world);
  kernels->light_media(world, eye, light_medium);
  for (size_t i = 0; i < world->lights.count && !room->fit.has_sky; i++) {
    room->fit.has_sky = world->lights.items[i].far;
    room->fit.sky_medium = light_medium[i];
  }
  kernels->trace(world, &def, scratch, &batch);
  vl_accel_leave(state);
  double after = 0, all = 0; /* radiance */
  for (uint32_t i = 0; i < n; i++) {
    wrong += room->fit.wrong[i];
    for (int c = 0; c < 4; c++) {
      double radiance = (double)batch.radiance[c][i];
      if (!(radiance < 1e30))
        continue;
      all += radiance;
      if (room->fit.wrong[i])
        after += radiance - (double)room->fit.before[c][i];
    }
  }
  if (room->fit.endless >= MIN_WRONG)
    return true;
  return wrong >= MIN_WRONG && (after > LITTLE * all || wrong > MANY * n);
}

vlResult vl_media_differ(const vlWorld *world, const vlCamera *camera, bool *differ) {
  *differ = false;
  if (!world->media.count)
    return VL_OK;
  vlContext *context = world->context;
  Room *room = vl_alloc_zero(context, 1, sizeof *room);
  vlTraceScratch *scratch = vl_alloc_zero(context, 1, vl_trace_scratch_size(world));
  uint32_t *light_medium =
      vl_alloc_zero(context, world->lights.count + 1, sizeof *light_medium);
  bool good = room && scratch && light_medium;
  if (good)
    *differ = ask(world, camera, room, light_medium, scratch);
  VL_FREE(context, room, scratch, light_medium);
  return good ? VL_OK : VL_ERROR_MEMORY;
}
