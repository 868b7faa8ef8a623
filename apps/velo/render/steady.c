/* render/steady.c: see steady.h. docs/denoising.md describes the method. */
#include "render/steady.h"

#include <math.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "image/image.h"

/* Features: albedo, normal, disparity. */
enum { TAPS = 4, NORMAL = 3, DISPARITY = 6, FEATURES = 7 };

/* Differences of features from which on two pixels show different things. */
static const float MAX_ALBEDO = 0.1f, MAX_NORMAL2 = 0.1f, MAX_DISPARITY = 0.05f;
/* Squared difference of two frames, over the variance of their noise, from which on an earlier
 * frame has no weight: of a single pixel, and in the mean of the patch around it, where the
 * differences of single pixels count up to MAX_DISTANCE. */
static const float FARTHEST = 9.0f, FARTHEST_PATCH = 3.0f, MAX_DISTANCE = 16.0f;
enum { PATCH = 2 }; /* a patch has (2 PATCH + 1)^2 pixels */

uint64_t steady_memory(uint64_t pixels) {
  enum { CLEAN = 7, IDS = 2, FLOW = 6, SUMS = 4, WARPED = 4 };
  const uint64_t kept = CLEAN + FEATURES + IDS;
  return pixels * sizeof(float) * ((STEADY_BEFORE + 1) * kept + FLOW + SUMS + WARPED);
}

/* Null: the frame is not kept. */
static const SteadyFrame *find_frame(const Steady *s, uint32_t number) {
  for (int i = 0; i <= STEADY_BEFORE; i++)
    if (s->frames[i].used && s->frames[i].number == number)
      return &s->frames[i];
  return NULL;
}

int steady_prepare(Steady *s, uint32_t number, SteadyRender *render, void *user) {
  int status = STATUS_OK;
  s->only_kept = true;
  for (uint32_t k = 0; k < s->count && status == STATUS_OK; k++) {
    s->number = s->before[k];
    if (!find_frame(s, s->number))
      status = render(user, k);
  }
  s->only_kept = false;
  s->number = number;
  return status;
}

static void forget(SteadyFrame *frame) {
  vl_image_destroy(frame->clean);
  vl_image_destroy(frame->features);
  vl_image_destroy(frame->ids);
  memset(frame, 0, sizeof *frame);
}

void steady_free(Steady *s) {
  for (int i = 0; i <= STEADY_BEFORE; i++)
    forget(&s->frames[i]);
}

static bool needed(const Steady *s, const SteadyFrame *frame) {
  for (uint32_t k = 0; k < s->count; k++)
    if (frame->number == s->before[k])
      return true;
  return false;
}

static vlResult copy_features(vlContext *context, const vlImage *from, vlImage **to) {
  static const char *const names[FEATURES] = {
      "feature.albedo.R", "feature.albedo.G", "feature.albedo.B",   "feature.N.X",
      "feature.N.Y",      "feature.N.Z",      "feature.disparity.Y"};
  TRY_RESULT(image_make_like(context, from, FEATURES, names, to));
  const size_t stride = vl_image_channels(from);
  for (int k = 0; k < FEATURES; k++) {
    const float *value =
        (const float *)vl_image_const_pixels(from) + vl_image_find_channel(from, names[k]);
    float *copy = (float *)vl_image_pixels(*to) + k;
    for (size_t i = 0; i < image_pixel_count(from); i++)
      copy[i * FEATURES] = value[i * stride];
  }
  return VL_OK;
}

vlResult steady_keep(Steady *s, const Job *job, const vlImage *image, vlImage *clean,
                     int *signals, vlError *error) {
  SteadyFrame *to = NULL; /* one is free: a frame uses STEADY_BEFORE others */
  for (int i = 0; i <= STEADY_BEFORE; i++)
    if (!s->frames[i].used || !needed(s, &s->frames[i]))
      to = &s->frames[i];
  forget(to);
  *to = (SteadyFrame){.used = true, .number = s->number, .camera = job->camera, .clean = clean};
  vlChannelsDef def = job_channels_def(job, NULL, signals);
  def.channels = VL_CHANNEL_ID_OBJECT | VL_CHANNEL_ID_INSTANCE;
  vlResult result = copy_features(job->context, image, &to->features);
  if (result == VL_OK)
    result = vl_render_channels(job->world, &job->camera, &def, NULL, &to->ids, error);
  if (result != VL_OK)
    forget(to);
  return result;
}

/* ---- one earlier frame ------------------------------------------------------------------- */

/* The values of a frame that are compared. */
typedef struct View {
  const float *clean, *features;
  const uint32_t *ids;
  size_t stride; /* of clean */
  int error;
} View;

static View view_of(const SteadyFrame *f) {
  return (View){.clean = vl_image_const_pixels(f->clean),
                .features = vl_image_const_pixels(f->features),
                .ids = vl_image_const_pixels(f->ids),
                .stride = vl_image_channels(f->clean),
                .error = vl_image_find_channel(f->clean, "error.R")};
}

/* Whether pixel i of one frame and pixel k of another show the same surface. disparity: of the
 * surface, seen from the other frame's camera; 0: nothing. */
static bool same_surface(const View *a, size_t i, const View *b, size_t k, float disparity) {
  const uint32_t *m = a->ids + 2 * i, *n = b->ids + 2 * k;
  const float *f = a->features + i * FEATURES, *g = b->features + k * FEATURES;
  if (m[0] != n[0] || m[1] != n[1])
    return false;
  float normal2 = 0;
  for (int c = 0; c < 3; c++) {
    const float d = f[c] - g[c], e = f[NORMAL + c] - g[NORMAL + c];
    if (!(fabsf(d) < MAX_ALBEDO))
      return false;
    normal2 += e * e;
  }
  return normal2 < MAX_NORMAL2 && fabsf(g[DISPARITY] - disparity) <= MAX_DISPARITY * disparity;
}

/* An earlier frame's light at the surface point of one of this frame's pixels. */
typedef struct Warped {
  float color[3];
  float distance; /* squared difference from the pixel's own colour over the variance of the
                     noise, mean of the channels, up to MAX_DISTANCE; -1: the point is not seen
                     there */
} Warped;
_Static_assert(sizeof(Warped) == 4 * sizeof(float), "an image of four channels holds them");

/* Squared difference of the pixel's own colour and another, over the variance of their noise.
 * own: its colour; error: its standard errors. */
static float distance_of(const float own[3], const float error[3], const float color[3],
                         const float variance[3]) {
  float sum = 0;
  for (int j = 0; j < 3; j++) {
    /* a pixel at an edge has much noise: it is no reason to take its light */
    const float noise = error[j] * error[j], max = 4 * noise;
    const float other = variance[j] < max ? variance[j] : max;
    const float scale = noise + other + 1e-6f * own[j] * own[j], d = color[j] - own[j];
    if (d != 0)
      sum += scale > 0 ? d * d / scale : INFINITY;
  }
  return sum < 3 * MAX_DISTANCE ? sum / 3 : MAX_DISTANCE;
}

/* The earlier frame's light at pixel i. u, v: where its point is in that frame, in pixels from
 * the centre of the first one. */
static Warped warp_pixel(const View *now, size_t i, const View *before, float u, float v,
                         const uint32_t size[2], float disparity) {
  Warped to = {.distance = -1};
  float variance[3] = {0}, weights = 0;
  const float left = floorf(u), top = floorf(v);
  for (int k = 0; k < TAPS; k++) {
    const float x = left + (float)(k & 1), y = top + (float)(k >> 1);
    const float w = (k & 1 ? u - left : left + 1 - u) * (k >> 1 ? v - top : top + 1 - v);
    if (!(w > 0) || !(x >= 0) || !(y >= 0) || !(x < (float)size[0]) || !(y < (float)size[1]))
      continue;
    const size_t at = (size_t)y * size[0] + (size_t)x;
    if (!same_surface(now, i, before, at, disparity))
      continue;
    const float *c = before->clean + at * before->stride;
    weights += w;
    for (int j = 0; j < 3; j++) {
      to.color[j] += w * c[j];
      variance[j] += w * c[before->error + j] * c[before->error + j];
    }
  }
  if (!(weights > 0.25f))
    return to;
  for (int j = 0; j < 3; j++) {
    to.color[j] /= weights;
    variance[j] /= weights;
  }
  const float *own = now->clean + i * now->stride;
  to.distance = distance_of(own, own + now->error, to.color, variance);
  return to;
}

/* Mean distance of the pixels around (x, y) that are seen in the earlier frame. */
static float patch_distance(const Warped *warped, const uint32_t size[2], uint32_t x,
                            uint32_t y) {
  const uint32_t x0 = x > PATCH ? x - PATCH : 0, y0 = y > PATCH ? y - PATCH : 0;
  float sum = 0, count = 0;
  for (uint32_t j = y0; j <= y + PATCH && j < size[1]; j++)
    for (uint32_t i = x0; i <= x + PATCH && i < size[0]; i++) {
      const float distance = warped[(size_t)j * size[0] + i].distance;
      if (distance < 0)
        continue;
      sum += distance;
      count++;
    }
  return sum / count;
}

/* Adds an earlier frame's colours to the pixels' sums[0..2], each times its weight, and the
 * weights to sums[3]. Light that changes by less than the noise of one pixel differs in the
 * whole patch. */
static void add_warped(const Warped *warped, const uint32_t size[2], float *sums) {
  for (uint32_t y = 0; y < size[1]; y++)
    for (uint32_t x = 0; x < size[0]; x++) {
      const size_t i = (size_t)y * size[0] + x;
      if (warped[i].distance < 0)
        continue;
      const float own = 1 - warped[i].distance / FARTHEST,
                  around = 1 - patch_distance(warped, size, x, y) / FARTHEST_PATCH,
                  t = own < around ? own : around;
      if (!(t > 0))
        continue;
      for (int c = 0; c < 3; c++)
        sums[4 * i + (size_t)c] += t * t * warped[i].color[c];
      sums[4 * i + 3] += t * t;
    }
}

/* A camera as it is in the middle of its exposure, at another time. */
static vlCamera camera_at(const vlCamera *camera, double time) {
  const double middle = vl_camera_time(camera, 0.5 * camera->width, 0.5 * camera->height, 0.5);
  vlCamera still = *camera;
  vl_camera_at(camera, middle, &still);
  still.shutter_open = still.shutter_close = time;
  return still;
}

/* Computes the flow to an earlier frame, with the points of this one. */
static vlResult find_flow(const Steady *s, const SteadyFrame *before, const Job *job,
                          int *signals, vlImage **floats, vlImage **ids, vlError *error) {
  vlChannelsDef def = job_channels_def(job, NULL, signals);
  def.channels = VL_CHANNEL_BACKWARD | VL_CHANNEL_P;
  def.backward = &before->camera;
  if (!s->between)
    return vl_render_channels(job->world, &job->camera, &def, floats, ids, error);
  vlWorld *between = NULL;
  TRY_RESULT(
      s->between(s->between_user, before->number, s->number, job, &between, &def.time, error));
  const vlCamera now = camera_at(&job->camera, def.time), then = camera_at(&before->camera, 0);
  def.backward = &then;
  vlResult result = vl_render_channels(between, &now, &def, floats, ids, error);
  vl_world_destroy(between);
  return result;
}

/* Warps all pixels of the earlier frame. floats: the flow and the points; ids: what hides. */
static void warp_frame(const SteadyFrame *now, const SteadyFrame *before, const vlImage *floats,
                       const vlImage *ids, Warped *warped) {
  const uint32_t size[2] = {vl_image_width(floats), vl_image_height(floats)};
  const float *values = vl_image_const_pixels(floats);
  const uint32_t *hidden = vl_image_const_pixels(ids);
  const size_t stride = vl_image_channels(floats), hidden_stride = vl_image_channels(ids);
  const int flow = vl_image_find_channel(floats, "backward.U"),
            position = vl_image_find_channel(floats, "P.X"),
            hides = vl_image_find_channel(ids, "backward.hidden");
  const View a = view_of(now), b = view_of(before);
  const double *pose = before->camera.world_from_camera;
  for (size_t i = 0; i < (size_t)size[0] * size[1]; i++) {
    const float *value = values + i * stride;
    warped[i] = (Warped){.distance = -1};
    if (hidden[i * hidden_stride + (size_t)hides] != VL_HIDDEN_NOT)
      continue;
    double square = 0;
    for (int k = 0; k < 3; k++) {
      const double d = (double)value[position + k] - pose[4 * k + 3];
      square += d * d;
    }
    const bool nothing = a.ids[2 * i] == 0;
    warped[i] = warp_pixel(&a, i, &b, (float)(i % size[0]) + value[flow],
                           (float)(i / size[0]) + value[flow + 1], size,
                           nothing || !(square > 0) ? 0 : (float)(1 / sqrt(square)));
  }
}

/* Adds an earlier frame to the pixels' sums of weighted colours and weights. */
static vlResult add_frame(const Steady *s, const SteadyFrame *now, const SteadyFrame *before,
                          const Job *job, int *signals, float *sums, vlError *error) {
  vlImage *floats = NULL, *ids = NULL, *warped = NULL;
  TRY_RESULT(find_flow(s, before, job, signals, &floats, &ids, error));
  const uint32_t size[2] = {vl_image_width(floats), vl_image_height(floats)};
  vlResult result = image_make_like(job->context, floats, 4, NULL, &warped);
  if (result == VL_OK) {
    warp_frame(now, before, floats, ids, vl_image_pixels(warped));
    add_warped(vl_image_const_pixels(warped), size, sums);
  }
  vl_image_destroy(floats);
  vl_image_destroy(ids);
  vl_image_destroy(warped);
  return result;
}

/* ---- the result -------------------------------------------------------------------------- */

vlResult steady_blend(const Steady *s, const Job *job, int *signals, vlImage **result,
                      vlError *error) {
  const SteadyFrame *now = find_frame(s, s->number);
  const size_t stride = vl_image_channels(now->clean);
  const float *own = vl_image_const_pixels(now->clean);
  const int alpha = vl_image_find_channel(now->clean, "A");
  const uint32_t channels = alpha >= 0 ? 4 : 3;
  vlImage *sums = NULL;
  *result = NULL;
  vlResult code = image_make_like(job->context, now->clean, 4, NULL, &sums);
  if (code == VL_OK)
    code = image_make_like(job->context, now->clean, channels, NULL, result);
  for (uint32_t k = 0; k < s->count && code == VL_OK; k++)
    code = add_frame(s, now, find_frame(s, s->before[k]), job, signals, vl_image_pixels(sums),
                     error);
  if (code == VL_OK)
    code = vl_image_add_attributes(*result, now->clean);
  const float *sum = code == VL_OK ? vl_image_const_pixels(sums) : NULL;
  float *to = code == VL_OK ? vl_image_pixels(*result) : NULL;
  for (size_t i = 0; to && i < image_pixel_count(now->clean); i++) {
    for (size_t c = 0; c < 3; c++)
      to[i * channels + c] = (own[i * stride + c] + sum[4 * i + c]) / (1 + sum[4 * i + 3]);
    if (alpha >= 0)
      to[i * 4 + 3] = own[i * stride + (size_t)alpha];
  }
  vl_image_destroy(sums);
  return code;
}
