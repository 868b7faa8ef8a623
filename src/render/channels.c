/* render/channels.c: ground truth: one exact ray through the centre of each pixel, tile by tile, into pictures of
 * 32-bit channels. A pass of its own beside vl_render: no pixel of the picture depends on it.
 *
 * All numbers of a pixel come from one double-precision ray: P = o + t d, z is P's depth, and so project(P) is the
 * pixel. They are rounded to float once, each for itself. */
#include "velo/channels.h"

#include <math.h>
#include <string.h>

#include "base/cookie.h"
#include "base/error.h"
#include "camera/rays.h"
#include "trace/truth.h"

enum { TILE = 32 };
_Static_assert(TILE *TILE <= VL_BATCH, "a tile is a batch");

/* ---- which channels there are ------------------------------------------------------------------------------------ */

static const struct Channel {
  const char *name;
  uint32_t parts;
  bool id;
  const char *names[3];
} channels[VL_CHANNEL_COUNT] = {
    {"Z", 1, false, {"Z"}},
    {"distance", 1, false, {"distance.Y"}},
    {"P", 3, false, {"P.X", "P.Y", "P.Z"}},
    {"N", 3, false, {"N.X", "N.Y", "N.Z"}},
    {"Ng", 3, false, {"Ng.X", "Ng.Y", "Ng.Z"}},
    {"uv", 2, false, {"uv.U", "uv.V"}},
    {"albedo", 3, false, {"albedo.R", "albedo.G", "albedo.B"}},
    {"ray", 3, false, {"ray.X", "ray.Y", "ray.Z"}},
    {"id.object", 1, true, {"id.object"}},
    {"id.material", 1, true, {"id.material"}},
    {"id.instance", 1, true, {"id.instance"}},
    {"id.primitive", 1, true, {"id.primitive"}},
    {"samples", 1, true, {"samples"}},
};

const char *vl_channel_name(uint32_t index) {
  return index < VL_CHANNEL_COUNT ? channels[index].name : NULL;
}

vlChannelsDef vl_default_channels_def(uint32_t width, uint32_t height) {
  return (vlChannelsDef){
      .cookie = VL_COOKIE_CHANNELS, .channels = VL_CHANNEL_ALL, .crop = {0, 0, width, height}, .space = VL_SPACE_SRGB};
}

/* ---- the pass ---------------------------------------------------------------------------------------------------- */

typedef struct Worker {
  vlTruthScratch *scratch;
  vlTruthBatch *batch;
  float *rows; /* of the camera's rays, ROWS arrays of VL_ROW_SIZE */
  uint32_t x[VL_BATCH], y[VL_BATCH];
} Worker;
enum { ROW_HALF, ROW_X, ROW_Y, ROW_OX, ROW_OY, ROW_OZ, ROW_DX, ROW_DY, ROW_DZ, ROW_T_MIN, ROW_T_MAX, ROW_TIME, ROWS };

typedef struct Pass {
  const vlWorld *world;
  const vlChannelsDef *def;
  vlCamera camera; /* a pinhole in the middle of the shutter's time */
  vlCameraCompiled compiled;
  const vlCameraKernels *camera_kernels;
  const vlTruthKernels *truth_kernels;
  vlTruthDef truth;
  uint32_t tiles_x, tile_x0, tile_y0, tiles;
  uint32_t place[VL_CHANNEL_COUNT]; /* of the first part in its picture */
  vlImage *images[2];               /* floats, ids */
  uint32_t step[2];                 /* values of a pixel */
  Worker *workers;
} Pass;

static bool wants(const Pass *p, uint32_t bits) {
  return (p->def->channels & bits) != 0;
}

/* The part of the rays that near and far plane leave, from the very kernel the picture's rays come from. */
static void find_ends(const Pass *p, Worker *w, uint32_t n) {
  float *rows[ROWS];
  for (int i = 0; i < ROWS; i++) rows[i] = w->rows + (size_t)i * VL_ROW_SIZE;
  int32_t *px = (int32_t *)(void *)rows[ROW_X], *py = (int32_t *)(void *)rows[ROW_Y];
  for (uint32_t i = 0; i < VL_PAD(n); i++) {
    rows[ROW_HALF][i] = 0.5f;
    px[i] = (int32_t)w->x[i < n ? i : n - 1], py[i] = (int32_t)w->y[i < n ? i : n - 1];
  }
  vlCameraSamples samples = {.film_x = rows[ROW_HALF],
                             .film_y = rows[ROW_HALF],
                             .pixel_x = px,
                             .pixel_y = py,
                             .lens_u = rows[ROW_HALF],
                             .lens_v = rows[ROW_HALF],
                             .time = rows[ROW_HALF]};
  vlCameraRays rays = {.ox = rows[ROW_OX],
                       .oy = rows[ROW_OY],
                       .oz = rows[ROW_OZ],
                       .dx = rows[ROW_DX],
                       .dy = rows[ROW_DY],
                       .dz = rows[ROW_DZ],
                       .t_min = rows[ROW_T_MIN],
                       .t_max = rows[ROW_T_MAX],
                       .time = rows[ROW_TIME]};
  p->camera_kernels->rays(&p->compiled, n, &samples, &rays);
  memcpy(w->batch->t_min, rays.t_min, n * sizeof(float));
  memcpy(w->batch->t_max, rays.t_max, n * sizeof(float));
}

/* Pixels of the tile inside the crop window that the camera has a ray for. */
static uint32_t list_pixels(const Pass *p, Worker *w, uint32_t tile) {
  uint32_t x0 = (p->tile_x0 + tile % p->tiles_x) * TILE, y0 = (p->tile_y0 + tile / p->tiles_x) * TILE, n = 0;
  const uint32_t *crop = p->def->crop;
  vlTruthBatch *b = w->batch;
  for (uint32_t k = 0; k < TILE * TILE; k++) {
    uint32_t x = x0 + k % TILE, y = y0 + k / TILE;
    if (x < crop[0] || y < crop[1] || x >= crop[2] || y >= crop[3]) continue;
    double o[3], d[3];
    if (!vl_camera_unproject(&p->camera, x + 0.5, y + 0.5, o, d)) continue;
    for (int i = 0; i < 3; i++) b->o[i][n] = o[i], b->d[i][n] = d[i];
    w->x[n] = x, w->y[n] = y;
    n++;
  }
  return b->n = n;
}

static void put3(float *to, const float rows[3][VL_ROW_SIZE], uint32_t i) {
  to[0] = rows[0][i], to[1] = rows[1][i], to[2] = rows[2][i];
}

static void put_floats(const Pass *p, const vlTruthBatch *b, uint32_t i, float *pixel) {
  float *at[8];
  for (int k = 0; k < 8; k++) at[k] = pixel + p->place[k];
  bool hit = b->object[i] != 0;
  double t = b->distance[i], point[3] = {0, 0, 0};
  for (int k = 0; k < 3 && hit; k++) point[k] = b->o[k][i] + t * b->d[k][i];
  const double *m = p->camera.camera_from_world;
  double z = hit ? m[8] * point[0] + m[9] * point[1] + m[10] * point[2] + m[11] : (double)INFINITY;
  if (wants(p, VL_CHANNEL_Z)) at[0][0] = (float)z;
  if (wants(p, VL_CHANNEL_DISTANCE)) at[1][0] = (float)t;
  for (int k = 0; k < 3; k++) {
    if (wants(p, VL_CHANNEL_P)) at[2][k] = (float)point[k];
    if (wants(p, VL_CHANNEL_RAY)) at[7][k] = (float)b->d[k][i];
  }
  if (wants(p, VL_CHANNEL_N)) put3(at[3], b->n_shading, i);
  if (wants(p, VL_CHANNEL_NG)) put3(at[4], b->n_geometric, i);
  if (wants(p, VL_CHANNEL_UV)) at[5][0] = b->uv[0][i], at[5][1] = b->uv[1][i];
  if (wants(p, VL_CHANNEL_ALBEDO)) put3(at[6], b->albedo, i);
}

static void put_ids(const Pass *p, const vlTruthBatch *b, uint32_t i, uint32_t *pixel) {
  const uint32_t values[4] = {b->object[i], b->material[i], b->instance[i], b->primitive[i]};
  for (uint32_t k = 0; k < 4; k++)
    if (wants(p, VL_CHANNEL_ID_OBJECT << k)) pixel[p->place[8 + k]] = values[k];
}

/* Pixels without a ray hold nothing too. */
static void clear_tile(const Pass *p, uint32_t tile) {
  uint32_t x0 = (p->tile_x0 + tile % p->tiles_x) * TILE, y0 = (p->tile_y0 + tile / p->tiles_x) * TILE;
  const uint32_t *crop = p->def->crop;
  for (uint32_t k = 0; k < TILE * TILE; k++) {
    uint32_t x = x0 + k % TILE, y = y0 + k / TILE;
    if (x < crop[0] || y < crop[1] || x >= crop[2] || y >= crop[3]) continue;
    size_t at = (size_t)(y - crop[1]) * (crop[2] - crop[0]) + (x - crop[0]);
    if (p->images[0]) {
      float *pixel = (float *)vl_image_pixels(p->images[0]) + at * p->step[0];
      if (wants(p, VL_CHANNEL_Z)) pixel[p->place[0]] = INFINITY;
      if (wants(p, VL_CHANNEL_DISTANCE)) pixel[p->place[1]] = INFINITY;
    }
    if (p->images[1] && wants(p, VL_CHANNEL_SAMPLES))
      ((uint32_t *)vl_image_pixels(p->images[1]))[at * p->step[1] + p->place[12]] = p->def->samples;
  }
}

static void trace_tile(void *user, uint32_t tile, uint32_t worker) {
  const Pass *p = user;
  Worker *w = &p->workers[worker];
  clear_tile(p, tile);
  uint32_t n = list_pixels(p, w, tile);
  if (n == 0) return;
  unsigned state = vl_accel_enter();
  find_ends(p, w, n);
  p->truth_kernels->trace(p->world, &p->truth, w->scratch, w->batch);
  vl_accel_leave(state);
  const uint32_t *crop = p->def->crop;
  for (uint32_t i = 0; i < n; i++) {
    size_t at = (size_t)(w->y[i] - crop[1]) * (crop[2] - crop[0]) + (w->x[i] - crop[0]);
    if (p->images[0]) put_floats(p, w->batch, i, (float *)vl_image_pixels(p->images[0]) + at * p->step[0]);
    if (p->images[1]) put_ids(p, w->batch, i, (uint32_t *)vl_image_pixels(p->images[1]) + at * p->step[1]);
  }
}

/* ---- the call ---------------------------------------------------------------------------------------------------- */

static vlResult check(const vlWorld *world, const vlCamera *camera, const vlChannelsDef *def, vlImage **floats,
                      vlImage **ids, vlError *error) {
  if (!world || !camera || !def) return vl_fail(error, VL_ERROR_ARGUMENT, "vl_render_channels: null argument");
  if (def->cookie != VL_COOKIE_CHANNELS)
    return vl_fail(error, VL_ERROR_ARGUMENT, "vl_render_channels: the def was not made by vl_default_channels_def");
  if (def->channels == 0 || def->channels > VL_CHANNEL_ALL)
    return vl_fail(error, VL_ERROR_ARGUMENT, "vl_render_channels: no such channels: %#x", def->channels);
  const uint32_t *c = def->crop;
  if (c[0] >= c[2] || c[1] >= c[3] || c[2] > camera->width || c[3] > camera->height)
    return vl_fail(error, VL_ERROR_ARGUMENT,
                   "vl_render_channels: crop %u,%u,%u,%u does not suit a camera of %u x %u pixels", c[0], c[1], c[2],
                   c[3], camera->width, camera->height);
  uint32_t id_bits = 0;
  for (uint32_t i = 0; i < VL_CHANNEL_COUNT; i++) id_bits |= channels[i].id ? 1u << i : 0;
  if ((!floats && (def->channels & ~id_bits)) || (!ids && (def->channels & id_bits)))
    return vl_fail(error, VL_ERROR_ARGUMENT, "vl_render_channels: no place for the picture that is wanted");
  return VL_OK;
}

static vlResult make_images(Pass *p, vlError *error) {
  for (int id = 0; id < 2; id++) {
    const char *names[32];
    uint32_t count = 0;
    for (uint32_t i = 0; i < VL_CHANNEL_COUNT; i++) {
      if (channels[i].id != (id == 1) || !wants(p, 1u << i)) continue;
      p->place[i] = count;
      for (uint32_t k = 0; k < channels[i].parts; k++) names[count++] = channels[i].names[k];
    }
    p->step[id] = count;
    if (count == 0) continue;
    vlImageDef def = vl_default_image_def(p->def->crop[2] - p->def->crop[0], p->def->crop[3] - p->def->crop[1], count);
    def.names = names;
    def.type = id ? VL_PIXEL_U32 : VL_PIXEL_F32;
    vlResult r = vl_image_create(p->world->context, &def, &p->images[id]);
    if (r == VL_ERROR_MEMORY) return vl_fail_memory(error);
    if (r != VL_OK) return vl_fail(error, r, "vl_render_channels: the picture cannot be made");
  }
  return VL_OK;
}

static vlResult make_workers(Pass *p, vlError *error) {
  vlContext *context = p->world->context;
  uint32_t threads = vl_context_threads(context);
  p->workers = vl_alloc_zero(context, threads, sizeof *p->workers);
  for (uint32_t i = 0; p->workers && i < threads; i++) {
    Worker *w = &p->workers[i];
    w->scratch = vl_alloc_zero(context, 1, vl_truth_scratch_size());
    w->batch = vl_alloc_zero(context, 1, sizeof *w->batch);
    w->rows = vl_alloc_zero(context, (size_t)ROWS * VL_ROW_SIZE, sizeof(float));
    if (!w->scratch || !w->batch || !w->rows) return vl_fail_memory(error);
  }
  return p->workers ? VL_OK : vl_fail_memory(error);
}

static void free_workers(Pass *p) {
  vlContext *context = p->world->context;
  for (uint32_t i = 0; p->workers && i < vl_context_threads(context); i++) {
    vl_free(context, p->workers[i].scratch);
    vl_free(context, p->workers[i].batch);
    vl_free(context, p->workers[i].rows);
  }
  vl_free(context, p->workers);
}

static void prepare(Pass *p, const vlCamera *camera) {
  vlIsa isa = vl_context_isa(p->world->context);
  p->camera = *camera;
  p->camera.lens_radius = 0;
  vl_camera_compile(&p->camera, &p->compiled);
  p->camera_kernels = vl_camera_kernels(isa);
  p->truth_kernels = vl_truth_kernels(isa);
  const float footprint = 0.25f; /* as the picture's samples have */
  p->truth = (vlTruthDef){.pixel_spread = footprint * p->compiled.pixel_spread,
                          .pixel_width = footprint * p->compiled.pixel_width,
                          .isa = isa,
                          .shading = wants(p, VL_CHANNEL_N),
                          .albedo = wants(p, VL_CHANNEL_ALBEDO)};
  vl_truth_plan_albedo(p->world, p->def->space, &p->truth);
  const uint32_t *crop = p->def->crop;
  p->tile_x0 = crop[0] / TILE, p->tile_y0 = crop[1] / TILE;
  p->tiles_x = (crop[2] + TILE - 1) / TILE - p->tile_x0;
  p->tiles = p->tiles_x * ((crop[3] + TILE - 1) / TILE - p->tile_y0);
}

vlResult vl_render_channels(const vlWorld *world, const vlCamera *camera, const vlChannelsDef *def, vlImage **floats,
                            vlImage **ids, vlError *error) {
  vl_error_clear(error);
  if (floats) *floats = NULL;
  if (ids) *ids = NULL;
  vlResult result = check(world, camera, def, floats, ids, error);
  if (result != VL_OK) return result;
  Pass pass, *p = &pass;
  memset(p, 0, sizeof *p);
  p->world = world;
  p->def = def;
  prepare(p, camera);
  result = make_images(p, error);
  if (result == VL_OK) result = make_workers(p, error);
  if (result == VL_OK) vl_parallel_for(world->context, p->tiles, trace_tile, p);
  free_workers(p);
  if (result != VL_OK) {
    vl_image_destroy(p->images[0]);
    vl_image_destroy(p->images[1]);
    return result;
  }
  if (floats) *floats = p->images[0];
  if (ids) *ids = p->images[1];
  return VL_OK;
}
