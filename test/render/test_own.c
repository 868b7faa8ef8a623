/* test/render/test_own.c: cameras, samplers and tracers of one's own (velo/own.h): the same
 * bits as velo's own where they compute the same, wrong values are counted, names are kept in
 * films and receipts. */
#include "render/shots.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#include "api/small_world.h"
#include "camera/rays.h"
#include "render/own_pinhole.h"
#include "velo/camera_file.h"
#include "velo/channels.h"
#include "velo/film.h"
#include "velo/filter_kinds.h"
#include "velo/paths.h"
#include "velo/projection.h"
#include "velo/sampler.h"
#include "velo/trace.h"
#include "velo/tracer.h"

/* ---- an own camera that is velo's perspective camera ------------------------------------- */

static vlCameraDef small_def(const vlOwnCamera *own) {
  vlCameraDef def = vl_default_camera_def(SMALL_WIDTH, SMALL_HEIGHT);
  const double eye[3] = {0, 1.6, 5}, lookat[3] = {0, 0.5, 0};
  memcpy(def.eye, eye, sizeof eye);
  memcpy(def.lookat, lookat, sizeof lookat);
  def.fx = def.fy = 40;
  def.own = own;
  return def;
}

static Stage small_stage(vlContext *context, const vlOwnCamera *own) {
  Stage s = stage_open_in(context, SMALL_WIDTH, SMALL_HEIGHT);
  small_scene(s.scene);
  s.camera = small_def(own);
  s.render.spp = 4;
  s.film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN);
  return s;
}

static void assert_same(const Image *a, const Image *b) {
  assert_memory_equal(a->rgba, b->rgba, (size_t)a->width * a->height * 4 * sizeof(float));
}

/* velo's camera and the own one give the same bits. */
static void same_as_velo(void **state) {
  (void)state;
  const vlTracer tracers[] = {VL_TRACER_PATH, VL_TRACER_RAYCAST, VL_TRACER_AMBIENT_OCCLUSION,
                              VL_TRACER_VOLPATH, VL_TRACER_RANDOM_WALK};
  for (size_t i = 0; i < sizeof tracers / sizeof *tracers; i++) {
    Image p[2];
    for (int k = 0; k < 2; k++) {
      Stage s = small_stage(NULL, k ? &pinhole : NULL);
      s.render.tracer = tracers[i];
      p[k] = stage_finish(&s);
    }
    assert_same(&p[0], &p[1]);
    image_free(&p[0]);
    image_free(&p[1]);
  }
}

static void same_in_motion(void **state) {
  (void)state;
  Image p[2];
  for (int k = 0; k < 2; k++) {
    Stage s = small_stage(NULL, k ? &pinhole : NULL);
    s.camera.eye_close[0] = 0.4;
    s.camera.eye_close[1] = 1.6;
    s.camera.eye_close[2] = 5;
    s.camera.readout = 0.5;
    s.camera.shutter_close = 0.5;
    p[k] = stage_finish(&s);
  }
  assert_same(&p[0], &p[1]);
  image_free(&p[0]);
  image_free(&p[1]);
}

static Image render_own(vlContext *context, const void *what) {
  Stage s = small_stage(context, what);
  s.render.spp = 2;
  return stage_finish(&s);
}

static void same_on_all_machines(void **state) {
  (void)state;
  Image p = assert_same_bits(render_own, &pinhole, 2);
  image_free(&p);
}

/* Resized and coarse cameras: the function still counts the pixels of the first size. */
static void other_sizes(void **state) {
  (void)state;
  vlCameraDef def = small_def(NULL), own_def = small_def(&pinhole);
  vlCamera theirs, own, a, b;
  vlError error = {0};
  assert_int_equal(vl_camera_make(&def, &theirs, NULL, &error), VL_OK);
  assert_int_equal(vl_camera_make(&own_def, &own, NULL, &error), VL_OK);
  assert_int_equal(own.projection, VL_PROJECTION_OWN);
  assert_true(fabs(own.own_pixel[0] - 1.0 / 40) < 1e-9 && own.own_pixel[1] == 0);
  for (int k = 0; k < 3; k++) {
    vlResult (*const size)(const vlCamera *, uint32_t, vlCamera *) = vl_camera_coarse;
    if (k < 2) {
      assert_int_equal(size(&theirs, k ? 8 : 1, &a), VL_OK);
      assert_int_equal(size(&own, k ? 8 : 1, &b), VL_OK);
    } else {
      assert_int_equal(vl_camera_resize(&theirs, 2 * SMALL_WIDTH, 2 * SMALL_HEIGHT, &a), VL_OK);
      assert_int_equal(vl_camera_resize(&own, 2 * SMALL_WIDTH, 2 * SMALL_HEIGHT, &b), VL_OK);
    }
    const double film[4] = {0.5, 0.5, 3.25, 2}, points[6] = {0.3, 0.2, 0, 0, 0, 9};
    double oa[6], ob[6], da[6], db[6], pa[4], pb[4], za[2], zb[2];
    uint8_t va[2], vb[2];
    vl_camera_unproject_batch(&a, 2, film, oa, da, va);
    vl_camera_unproject_batch(&b, 2, film, ob, db, vb);
    for (int i = 0; i < 6; i++)
      assert_true(fabs(oa[i] - ob[i]) < 1e-12 && fabs(da[i] - db[i]) < 1e-12);
    double o[3], d[3];
    assert_true(vl_camera_unproject(&b, film[2], film[3], o, d));
    assert_memory_equal(o, ob + 3, sizeof o);
    assert_memory_equal(d, db + 3, sizeof d);
    vl_camera_project_batch(&a, 2, points, pa, za, va);
    vl_camera_project_batch(&b, 2, points, pb, zb, vb);
    for (int i = 0; i < 2; i++) {
      assert_int_equal(va[i], i == 0);
      assert_int_equal(vb[i], va[i]);
      assert_true(fabs(za[i] - zb[i]) < 1e-12);
      assert_true(fabs(pa[2 * i] - pb[2 * i]) < 1e-9 &&
                  fabs(pa[2 * i + 1] - pb[2 * i + 1]) < 1e-9);
    }
    double pixel[2], z;
    assert_true(vl_camera_project(&b, points, pixel, &z));
    assert_memory_equal(pixel, pb, sizeof pixel);
    assert_true(fabs(vl_camera_solid_angle(&a, 3, 2) / vl_camera_solid_angle(&b, 3, 2) - 1) <
                1e-8);
  }
}

/* Ground truth is that of velo's camera. */
static void ground_truth(void **state) {
  (void)state;
  vlImage *floats[2], *ids[2];
  Stage s = small_stage(NULL, NULL);
  vlWorld *world;
  vlError error = {0};
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_OK);
  for (int k = 0; k < 2; k++) {
    vlCameraDef def = small_def(k ? &pinhole : NULL);
    vlCamera camera;
    assert_int_equal(vl_camera_make(&def, &camera, NULL, &error), VL_OK);
    vlChannelsDef channels = vl_default_channels_def(SMALL_WIDTH, SMALL_HEIGHT);
    channels.channels = VL_CHANNEL_Z | VL_CHANNEL_N | VL_CHANNEL_ID_OBJECT | VL_CHANNEL_RAY;
    assert_int_equal(vl_render_channels(world, &camera, &channels, &floats[k], &ids[k], &error),
                     VL_OK);
  }
  uint32_t count = vl_image_channels(floats[0]);
  for (uint32_t y = 0; y < SMALL_HEIGHT; y++)
    for (uint32_t x = 0; x < SMALL_WIDTH; x++) {
      assert_int_equal((int)vl_image_get(ids[0], x, y, 0), (int)vl_image_get(ids[1], x, y, 0));
      for (uint32_t c = 0; c < count; c++) {
        float a = vl_image_get(floats[0], x, y, c), b = vl_image_get(floats[1], x, y, c);
        assert_true(a == b || fabsf(a - b) < 1e-5f * fabsf(a) + 1e-6f);
      }
    }
  for (int k = 0; k < 2; k++) {
    vl_image_destroy(floats[k]);
    vl_image_destroy(ids[k]);
  }
  vl_world_destroy(world);
  stage_close(&s);
}

/* ---- rays that are none ------------------------------------------------------------------ */

/* The left quarter has no rays, the next one NaN, the third a weight of 1/2. */
static void quarters(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  pinhole_rays(user, points, rays);
  for (uint32_t i = 0; i < points->count; i++) {
    int quarter = (int)floor(points->x[i] / points->width * 4);
    if (quarter < 1)
      rays->dx[i] = rays->dy[i] = rays->dz[i] = 0;
    if (quarter == 1)
      rays->dy[i] = (double)NAN;
    if (quarter == 2)
      rays->weight[i] = 0.5;
  }
}

static void no_rays(void **state) {
  (void)state;
  const vlOwnCamera own = {.name = "quarters", .rays = quarters, .user = &of_small};
  for (int shares = 0; shares < 2; shares++) {
    Stage s = small_stage(NULL, NULL);
    s.film.filter =
        vl_default_pixel_filter(shares ? VL_PIXEL_FILTER_TRIANGLE : VL_PIXEL_FILTER_BOX);
    s.render.tracer = VL_TRACER_RAYCAST;
    Image whole = stage_finish(&s);
    s = small_stage(NULL, &own);
    s.film.filter =
        vl_default_pixel_filter(shares ? VL_PIXEL_FILTER_TRIANGLE : VL_PIXEL_FILTER_BOX);
    s.render.tracer = VL_TRACER_RAYCAST;
    Image p = stage_finish(&s);
    if (!shares)
      assert_int_equal(p.stats.not_finite, SMALL_WIDTH / 4 * SMALL_HEIGHT * 4);
    assert_true(p.stats.not_finite >= SMALL_WIDTH / 4 * SMALL_HEIGHT * 4);
    assert_in_range(p.stats.worst_x, SMALL_WIDTH / 4, SMALL_WIDTH / 2 - 1);
    for (uint32_t y = 0; y < SMALL_HEIGHT; y++)
      for (uint32_t x = 0; x < SMALL_WIDTH; x++) {
        const float *a = whole.rgba + 4 * (y * SMALL_WIDTH + x),
                    *b = p.rgba + 4 * (y * SMALL_WIDTH + x);
        uint32_t quarter = x * 4 / SMALL_WIDTH, in = x % (SMALL_WIDTH / 4);
        if (in < 2 || in > SMALL_WIDTH / 4 - 3)
          continue; /* the filter mixes */
        for (int c = 0; c < 4 && quarter < 2; c++)
          assert_true(b[c] == 0);
        for (int c = 0; c < 3 && quarter == 2; c++)
          assert_true(fabsf(b[c] - 0.5f * a[c]) <= 1e-6f);
        for (int c = 0; c < 4 && quarter == 3; c++)
          assert_true(b[c] == a[c]);
      }
    image_free(&whole);
    image_free(&p);
  }
}

typedef struct Seen {
  pthread_mutex_t mutex;
  uint32_t max;
  double u_low, u_high, time_low, time_high;
} Seen;
static void look(void *user, const vlOwnFilmPoints *points, const vlOwnRays *rays) {
  Seen *s = user;
  pinhole_rays(&of_small, points, rays);
  pthread_mutex_lock(&s->mutex);
  if (points->count > s->max)
    s->max = points->count;
  for (uint32_t i = 0; i < points->count; i++) {
    s->u_low = fmin(s->u_low, fmin(points->lens_u[i], points->lens_v[i]));
    s->u_high = fmax(s->u_high, fmax(points->lens_u[i], points->lens_v[i]));
    s->time_low = fmin(s->time_low, points->time[i]);
    s->time_high = fmax(s->time_high, points->time[i]);
  }
  pthread_mutex_unlock(&s->mutex);
}

/* Lens numbers are spread only where they are wanted; times are seconds. */
static void what_it_gets(void **state) {
  (void)state;
  for (int lens = 0; lens < 2; lens++) {
    Seen seen = {
        .mutex = PTHREAD_MUTEX_INITIALIZER, .u_low = 1, .time_low = 1e9, .time_high = -1e9};
    const vlOwnCamera own = {.name = "look", .rays = look, .lens = lens, .user = &seen};
    Stage s = small_stage(NULL, &own);
    s.camera.shutter_open = 3;
    s.camera.shutter_close = 5;
    if (lens)
      s.camera.readout = 1;
    Image p = stage_finish(&s);
    assert_in_range(seen.max, 100, VL_OWN_BATCH);
    if (!lens)
      assert_true(seen.u_low == 0.5 && seen.u_high == 0.5);
    if (lens)
      assert_true(seen.u_low < 0.01 && seen.u_high > 0.99 && seen.u_high < 1);
    assert_true(seen.time_low >= 3 - 0.2 && seen.time_low < 3.1);
    assert_true(seen.time_high > (lens ? 5.8 : 4.9) && seen.time_high < (lens ? 6.3 : 5));
    image_free(&p);
  }
}

/* Batches of any size: the function gets each point once, and no other rays are written. */
static void any_number_of_points(void **state) {
  (void)state;
  enum { MAX_POINTS = 3 * VL_OWN_BATCH };
  static float rows[16][MAX_POINTS];
  static int32_t pixels[2][MAX_POINTS];
  vlCameraDef def = small_def(&pinhole);
  vlCamera camera;
  vlCameraCompiled c;
  vlError error = {0};
  assert_int_equal(vl_camera_make(&def, &camera, NULL, &error), VL_OK);
  vl_camera_compile(&camera, &c);
  const vlCameraSamples samples = {rows[10], rows[11], pixels[0], pixels[1],
                                   rows[12], rows[13], rows[14]};
  const vlCameraRays rays = {rows[0], rows[1], rows[2], rows[3], rows[4], rows[5],
                             rows[6], rows[7], rows[8], rows[9], NULL};
  for (uint32_t n = 16; n <= 2 * VL_OWN_BATCH; n += 240) {
    for (uint32_t i = 0; i < MAX_POINTS; i++)
      rows[5][i] = 7; /* of no direction */
    vl_camera_kernels(VL_ISA_BASE)->rays(&c, n, &samples, &rays);
    for (uint32_t i = 0; i < MAX_POINTS; i++)
      if ((rows[5][i] == 7) != (i >= n))
        fail_msg("%u points: number %u", n, i);
  }
}

static void wrong_cameras(void **state) {
  (void)state;
  const char *const names[] = {
      NULL, "", "a\nb", "\xff",
      "0123456789012345678901234567890123456789012345678901234567890123"};
  vlCamera camera;
  vlError error;
  for (int i = 0; i < 6; i++) {
    vlOwnCamera own = pinhole;
    if (i < 5)
      own.name = names[i];
    else
      own.rays = NULL;
    vlCameraDef def = small_def(&own);
    error = (vlError){0};
    assert_int_equal(vl_camera_make(&def, &camera, NULL, &error), VL_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "own camera"));
  }
  vlCameraDef def = small_def(NULL);
  def.projection = VL_PROJECTION_OWN;
  assert_int_equal(vl_camera_make(&def, &camera, NULL, &error), VL_ERROR_ARGUMENT);
  assert_string_equal(vl_projection_name(VL_PROJECTION_OWN), "own");
}

/* ---- samplers ---------------------------------------------------------------------------- */

/* velo's independent sampler, by its own formula, would need its hash: any hash does here. */
static float hashed(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  uint32_t h = a * 0x9e3779b9u ^ (b + 0x7f4a7c15u) * 0x85ebca6bu ^
               (c + 0x165667b1u) * 0xc2b2ae35u ^ d * 0x27d4eb2fu;
  h = (h ^ h >> 16) * 0x7feb352du;
  h = (h ^ h >> 15) * 0x846ca68bu;
  return (float)((h ^ h >> 16) >> 8) * 0x1p-24f;
}

static void independent(void *user, const vlOwnSamples *s) {
  (void)user;
  for (uint32_t i = 0; i < s->count; i++) {
    uint32_t pixel = (uint32_t)s->x[i] * 4096u + (uint32_t)s->y[i];
    s->u[i] = hashed(pixel, s->index[i], s->dimension, s->seed);
    if (s->v)
      s->v[i] = hashed(pixel, s->index[i], s->dimension + 1, s->seed);
  }
}
static const vlOwnSampler own_sampler = {.name = "hash", .numbers = independent};

static Image render_sampled(vlContext *context, const void *what) {
  Stage s = small_stage(context, NULL);
  s.render.own_sampler = what;
  s.render.spp = 2;
  return stage_finish(&s);
}

/* The mean over the image is that of velo's sampler. */
static void sampler_mean(void **state) {
  (void)state;
  double mean[2], error[2];
  for (int k = 0; k < 2; k++) {
    double sum = 0, square = 0;
    for (uint32_t seed = 0; seed < 16; seed++) {
      Stage s = small_stage(NULL, NULL);
      s.render.own_sampler = k ? &own_sampler : NULL;
      s.render.sampler = VL_SAMPLER_INDEPENDENT;
      s.render.seed = seed;
      Image p = stage_finish(&s);
      assert_int_equal(p.stats.own_numbers, 0);
      double all = 0;
      for (uint32_t i = 0; i < p.width * p.height; i++)
        all += (double)p.rgba[4 * i + 1];
      sum += all;
      square += all * all;
      image_free(&p);
    }
    mean[k] = sum / 16;
    error[k] = sqrt((square / 16 - mean[k] * mean[k]) / 15);
  }
  double z = (mean[1] - mean[0]) / hypot(error[0], error[1]);
  print_message("own sampler: mean %.5g, velo's %.5g, z = %.2f\n", mean[1], mean[0], z);
  assert_true(fabs(z) < 4);
  /* a difference of 5 % would be seen */
  assert_true(hypot(error[0], error[1]) < 0.01 * mean[0]);
}

static void sampler_bits(void **state) {
  (void)state;
  Image p = assert_same_bits(render_sampled, &own_sampler, 2);
  image_free(&p);
}

/* Gives numbers that are none: the first ones of each sample, or the second ones. */
typedef struct Broken {
  float value;
  bool second;
} Broken;

static void broken(void *user, const vlOwnSamples *s) {
  const Broken *b = user;
  for (uint32_t i = 0; i < s->count; i++)
    s->u[i] = b->second ? 0.25f : b->value;
  for (uint32_t i = 0; s->v && i < s->count; i++)
    s->v[i] = b->second ? b->value : 0.25f;
}

static void wrong_samplers(void **state) {
  (void)state;
  static const float values[4] = {-1, 1, INFINITY, NAN};
  for (int i = 0; i < 8; i++) {
    Broken wrong = {values[i % 4], i >= 4};
    const vlOwnSampler own = {.name = "broken", .numbers = broken, .user = &wrong};
    Image p = image_in(render_sampled, &own, 2, VL_ISA_AUTO);
    assert_true(p.stats.own_numbers > 2 * SMALL_WIDTH * SMALL_HEIGHT);
    for (uint32_t k = 0; k < 4 * p.width * p.height; k++)
      assert_true(isfinite(p.rgba[k]));
    image_free(&p);
  }
  Stage s = small_stage(NULL, NULL);
  vlWorld *world;
  vlFilm *film;
  vlCamera camera;
  vlError error = {0};
  const vlOwnSampler nameless = {.name = "", .numbers = broken}, empty = {.name = "empty"};
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_OK);
  assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, &error), VL_OK);
  assert_int_equal(vl_film_create(s.context, &s.film, &film), VL_OK);
  s.render.own_sampler = &nameless;
  assert_int_equal(vl_render(world, &camera, film, &s.render, NULL, &error), VL_ERROR_ARGUMENT);
  s.render.own_sampler = &empty;
  assert_int_equal(vl_render(world, &camera, film, &s.render, NULL, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "\"empty\""));
  vl_film_destroy(film);
  vl_world_destroy(world);
  stage_close(&s);
}

/* ---- tracers ----------------------------------------------------------------------------- */

/* What a tracer of at most max_depth bounces gives, by light samples alone; lamps are seen at
 * first and in mirrors. */
static void by_lights(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  (void)user;
  vlTraceHits hits;
  vlTraceLights lights;
  vlTraceBounce next = {.rays = *paths->rays};
  uint8_t occluded[VL_OWN_BATCH];
  float bsdf[4][VL_OWN_BATCH], beta[4][VL_OWN_BATCH];
  memset(next.specular, 1, sizeof next.specular);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
      beta[c][i] = 1;
  for (uint32_t bounce = 0; bounce <= paths->max_depth; bounce++) {
    vl_world_trace(trace, &next.rays, &hits);
    for (int c = 0; c < 4; c++)
      for (uint32_t i = 0; i < paths->count; i++)
        if (next.specular[i])
          paths->radiance[c][i] += beta[c][i] * hits.emission[c][i];
    if (bounce == paths->max_depth)
      break;
    vl_trace_lights(trace, bounce, &lights);
    vl_world_occluded(trace, &lights.rays, occluded);
    vl_trace_bsdf(trace, lights.direction, bsdf, NULL);
    vl_trace_bounce(trace, bounce, &next);
    for (int c = 0; c < 4; c++)
      for (uint32_t i = 0; i < paths->count; i++) {
        if (!occluded[i])
          paths->radiance[c][i] += beta[c][i] * bsdf[c][i] * lights.radiance[c][i];
        beta[c][i] *= next.weight[c][i];
      }
  }
}
static const vlOwnTracer light_tracer = {.name = "by lights", .radiance = by_lights};

/* Ambient occlusion, cosine-weighted. */
static void occlusion(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  (void)user;
  vlTraceHits hits;
  vlTraceRays rays;
  float u[VL_OWN_BATCH], v[VL_OWN_BATCH], direction[3][VL_OWN_BATCH] = {{0}};
  uint8_t occluded[VL_OWN_BATCH];
  vl_world_trace(trace, paths->rays, &hits);
  vl_trace_numbers(trace, 0, u, v);
  for (uint32_t i = 0; i < paths->count; i++) {
    float z = 1 - 2 * u[i], r = sqrtf(fmaxf(0, 1 - z * z)), angle = 6.2831853f * v[i], sum = 0;
    const float sphere[3] = {r * cosf(angle), r * sinf(angle), z};
    for (int k = 0; k < 3; k++)
      direction[k][i] = hits.normal[k][i] + sphere[k];
    for (int k = 0; k < 3; k++)
      sum += direction[k][i] * direction[k][i];
    for (int k = 0; k < 3; k++)
      direction[k][i] /= sqrtf(fmaxf(sum, 1e-12f));
  }
  vl_trace_leave(trace, direction, &rays);
  vl_world_occluded(trace, &rays, occluded);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = 0; i < paths->count; i++)
      if (hits.t[i] < INFINITY && !occluded[i])
        paths->radiance[c][i] = paths->white[c][i];
}
static const vlOwnTracer occlusion_tracer = {.name = "occlusion", .radiance = occlusion};

static void mean_of(vlTracer tracer, const vlOwnTracer *own, vlColorMode color, uint32_t depth,
                    double *mean, double *error) {
  enum { SEEDS = 24 };
  double sum = 0, square = 0;
  for (uint32_t seed = 0; seed < SEEDS; seed++) {
    Stage s = small_stage(NULL, NULL);
    s.build.color = color;
    s.render.tracer = tracer;
    s.render.own_tracer = own;
    s.render.max_depth = depth;
    s.render.seed = seed;
    Image p = stage_finish(&s);
    assert_int_equal(p.stats.not_finite, 0);
    if (depth)
      assert_true(p.stats.shadow_rays > 0);
    double all = 0;
    for (uint32_t i = 0; i < p.width * p.height; i++)
      all += fmin((double)p.rgba[4 * i + 1], 20); /* no fireflies */
    sum += all;
    square += all * all;
    image_free(&p);
  }
  *mean = sum / SEEDS;
  *error = sqrt((square / SEEDS - *mean * *mean) / (SEEDS - 1));
}

/* The means are those of velo's tracers. */
static void tracer_means(void **state) {
  (void)state;
  const struct {
    vlTracer tracer;
    const vlOwnTracer *own;
    vlColorMode color;
    uint32_t depth;
  } cases[] = {{VL_TRACER_AMBIENT_OCCLUSION, &occlusion_tracer, VL_COLOR_SPECTRAL, 1},
               {VL_TRACER_AMBIENT_OCCLUSION, &occlusion_tracer, VL_COLOR_RGB, 1},
               {VL_TRACER_PATH, &light_tracer, VL_COLOR_SPECTRAL, 0},
               {VL_TRACER_PATH, &light_tracer, VL_COLOR_SPECTRAL, 1},
               {VL_TRACER_PATH, &light_tracer, VL_COLOR_RGB, 2}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    double a, b, ea, eb;
    mean_of(cases[i].tracer, NULL, cases[i].color, cases[i].depth, &a, &ea);
    mean_of(cases[i].tracer, cases[i].own, cases[i].color, cases[i].depth, &b, &eb);
    double z = (b - a) / hypot(ea, eb);
    print_message("own tracer, case %d: mean %.5g, velo's %.5g, z = %.2f\n", (int)i, b, a, z);
    assert_true(fabs(z) < 4);
    assert_true(hypot(ea, eb) < 0.01 * a); /* a difference of 5 % would be seen */
  }
}

static Image render_traced(vlContext *context, const void *what) {
  Stage s = small_stage(context, NULL);
  s.render.own_tracer = what;
  s.render.max_depth = 2;
  s.render.spp = 2;
  return stage_finish(&s);
}

static void tracer_bits(void **state) {
  (void)state;
  Image p = assert_same_bits(render_traced, &light_tracer, 2);
  image_free(&p);
}

/* What the world answers about a first hit, checked against ground truth's definition; about
 * lanes without rays. */
typedef struct Look {
  atomic_uint wrong, hits, misses;
} Look;
static void look_at(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  Look *look = user;
  vlTraceHits hits;
  vlTraceLights lights;
  vlTraceBounce next;
  float bsdf[4][VL_OWN_BATCH], pdf[VL_OWN_BATCH];
  vlTraceRays rays = *paths->rays;
  uint8_t occluded[VL_OWN_BATCH];
  for (uint32_t i = 0; i < paths->count; i += 2)
    rays.t_max[i] = -1; /* every second lane has no ray */
  vl_world_trace(trace, &rays, &hits);
  vl_world_occluded(trace, &rays, occluded);
  vl_trace_lights(trace, 0, &lights);
  vl_trace_bsdf(trace, lights.direction, bsdf, pdf);
  vl_trace_bounce(trace, 0, &next);
  for (uint32_t i = 0; i < paths->count; i++) {
    bool hit = hits.t[i] < INFINITY, wrong = hit != (occluded[i] == 1);
    float length = 0, towards = 0;
    for (int k = 0; k < 3; k++) {
      float at = rays.origin[k][i] + hits.t[i] * rays.direction[k][i];
      if (hit && fabsf(at - hits.position[k][i]) > 1e-3f)
        wrong = true;
      length += hits.normal[k][i] * hits.normal[k][i];
      towards += hits.normal[k][i] * rays.direction[k][i];
    }
    if (hit &&
        (fabsf(length - 1) > 1e-4f || towards > 0 || !hits.object[i] || !hits.material[i]))
      wrong = true;
    if (!hit && (length != 0 || hits.object[i] || lights.pdf[i] != 0 || next.pdf[i] != 0 ||
                 bsdf[0][i] != 0))
      wrong = true;
    if (i % 2 == 0 && (hit || hits.emission[0][i] != 0))
      wrong = true;
    atomic_fetch_add(hit ? &look->hits : &look->misses, 1);
    if (wrong)
      atomic_fetch_add(&look->wrong, 1);
    for (int c = 0; c < 4; c++)
      paths->radiance[c][i] = NAN;
  }
}

static void what_the_world_answers(void **state) {
  (void)state;
  Look look = {0};
  const vlOwnTracer own = {.name = "look", .radiance = look_at, .user = &look};
  Image p = image_in(render_traced, &own, 2, VL_ISA_AUTO);
  assert_int_equal(look.wrong, 0);
  assert_true(look.hits > 500 && look.misses > 500);
  /* NaN: all samples are left out */
  assert_true(p.stats.not_finite >= SMALL_WIDTH * SMALL_HEIGHT * 2);
  image_free(&p);
}

static void wrong_tracers(void **state) {
  (void)state;
  Stage s = small_stage(NULL, NULL);
  vlWorld *world;
  vlFilm *film;
  vlCamera camera;
  vlPixelPaths *paths;
  vlError error = {0};
  const vlOwnTracer nameless = {.radiance = occlusion}, empty = {.name = "empty"};
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_OK);
  assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, &error), VL_OK);
  assert_int_equal(vl_film_create(s.context, &s.film, &film), VL_OK);
  s.render.own_tracer = &nameless;
  assert_int_equal(vl_render(world, &camera, film, &s.render, NULL, &error), VL_ERROR_ARGUMENT);
  s.render.own_tracer = &empty;
  assert_int_equal(vl_render(world, &camera, film, &s.render, NULL, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "own tracer \"empty\""));
  s.render.own_tracer = &occlusion_tracer;
  assert_int_equal(
      vl_trace_paths(world, &camera, &s.film, &s.render, 3, 3, 0, 4, &paths, &error),
      VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "\"occlusion\""));
  assert_int_equal(vl_render(world, &camera, film, &s.render, NULL, &error), VL_OK);
  assert_string_equal(vl_film_own(film, VL_OWN_TRACER), "occlusion");
  s.render.own_tracer = NULL;
  s.render.spp = 8;
  assert_int_equal(vl_render(world, &camera, film, &s.render, NULL, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "own tracer"));
  vl_film_destroy(film);
  vl_world_destroy(world);
  stage_close(&s);
}

/* ---- names ------------------------------------------------------------------------------- */

static vlResult render_part(const Stage *s, const vlWorld *world, const vlOwnCamera *own,
                            const vlOwnSampler *sampler, uint32_t first, uint32_t spp,
                            vlFilm *film, vlError *error) {
  vlCameraDef def = small_def(own);
  vlCamera camera;
  vlRenderDef render = s->render;
  assert_int_equal(vl_camera_make(&def, &camera, NULL, error), VL_OK);
  render.own_sampler = sampler;
  render.first_sample = first;
  render.spp = spp;
  return vl_render(world, &camera, film, &render, NULL, error);
}

/* A film keeps the names, in its file too; films of other names are neither continued nor
 * merged. */
static void names_in_films(void **state) {
  (void)state;
  Stage s = small_stage(NULL, NULL);
  vlOwnCamera other = pinhole;
  other.name = "another";
  vlWorld *world;
  vlFilm *film, *read;
  vlError error = {0};
  char a[] = "/tmp/velo_own_aXXXXXX", b[] = "/tmp/velo_own_bXXXXXX",
       c[] = "/tmp/velo_own_cXXXXXX";
  char *const paths[3] = {a, b, c};
  for (int i = 0; i < 3; i++) {
    close(mkstemp(paths[i]));
    unlink(paths[i]);
  }
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, &error), VL_OK);
  assert_int_equal(vl_film_create(s.context, &s.film, &film), VL_OK);
  assert_null(vl_film_own(film, VL_OWN_CAMERA));
  assert_int_equal(render_part(&s, world, &pinhole, &own_sampler, 0, 2, film, &error), VL_OK);
  assert_string_equal(vl_film_own(film, VL_OWN_CAMERA), "pinhole");
  assert_string_equal(vl_film_own(film, VL_OWN_SAMPLER), "hash");
  assert_null(vl_film_own(film, VL_OWN_TRACER));
  assert_null(vl_film_own(film, VL_OWN_KINDS));
  assert_int_equal(vl_film_write(film, NULL, a, &error), VL_OK);

  assert_int_equal(vl_film_read(s.context, a, false, &read, &error), VL_OK);
  assert_string_equal(vl_film_own(read, VL_OWN_CAMERA), "pinhole");
  assert_int_equal(render_part(&s, world, &other, &own_sampler, 0, 4, read, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "own camera \"pinhole\", not of \"another\""));
  assert_int_equal(render_part(&s, world, NULL, &own_sampler, 0, 4, read, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(render_part(&s, world, &pinhole, NULL, 0, 4, read, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "own sampler"));
  assert_int_equal(render_part(&s, world, &pinhole, &own_sampler, 0, 4, read, &error), VL_OK);
  vl_film_destroy(read);

  const vlOwnCamera *const cameras[2] = {&other, &pinhole};
  for (int k = 0; k < 2; k++) {
    vl_film_clear(film);
    assert_null(vl_film_own(film, VL_OWN_CAMERA));
    assert_int_equal(render_part(&s, world, cameras[k], &own_sampler, 2, 4, film, &error),
                     VL_OK);
    assert_int_equal(vl_film_write(film, NULL, b, &error), VL_OK);
    const char *const both[2] = {a, b};
    assert_int_equal(vl_film_merge(s.context, both, 2, NULL, c, &error),
                     k ? VL_OK : VL_ERROR_SCENE);
    if (!k)
      assert_non_null(strstr(error.message, "own camera is \"another\", was \"pinhole\""));
  }
  assert_int_equal(vl_film_read(s.context, c, false, &read, &error), VL_OK);
  assert_string_equal(vl_film_own(read, VL_OWN_SAMPLER), "hash");
  vl_film_destroy(read);
  vl_film_destroy(film);
  vl_world_destroy(world);
  for (int i = 0; i < 3; i++)
    unlink(paths[i]);
  stage_close(&s);
}

static bool add_difference(void *user, const char *text) {
  strcat(strcat(user, text), ";");
  return true;
}

static void names_in_receipts(void **state) {
  (void)state;
  Stage s = small_stage(NULL, NULL);
  vlSceneDefs *defs = vl_scene_defs(s.scene);
  vlReceipt *receipt[2], *parsed;
  vlError error = {0};
  for (int k = 0; k < 2; k++) {
    defs->camera.own = k ? &pinhole : NULL;
    defs->render.own_sampler = k ? &own_sampler : NULL;
    defs->render.own_tracer = k ? &light_tracer : NULL;
    vlReceiptDef def = vl_default_receipt_def();
    def.defs = defs;
    assert_int_equal(vl_receipt_make(s.context, &def, &receipt[k], &error), VL_OK);
  }
  assert_null(vl_receipt_own(receipt[0], VL_OWN_CAMERA));
  const char *text = vl_receipt_text(receipt[1]);
  assert_int_equal(vl_receipt_parse(s.context, text, strlen(text), &parsed, &error), VL_OK);
  assert_string_equal(vl_receipt_own(parsed, VL_OWN_CAMERA), "pinhole");
  assert_string_equal(vl_receipt_own(parsed, VL_OWN_SAMPLER), "hash");
  assert_string_equal(vl_receipt_own(parsed, VL_OWN_TRACER), "by lights");
  vlCameraDef camera;
  assert_int_equal(vl_receipt_camera(parsed, &camera, NULL, NULL, &error),
                   VL_ERROR_UNSUPPORTED);
  assert_non_null(strstr(error.message, "\"pinhole\""));
  char named[2][400] = {"", ""};
  assert_true(
      vl_receipt_compare(receipt[0], parsed, VL_RECEIPT_CAMERA, add_difference, named[0]) > 0);
  assert_non_null(strstr(named[0], "projection is own, was perspective;"));
  assert_non_null(strstr(named[0], "own is pinhole, was not given;"));
  assert_true(
      vl_receipt_compare(parsed, receipt[0], VL_RECEIPT_CAMERA, add_difference, named[1]) > 0);
  assert_non_null(strstr(named[1], "projection is perspective, was own;"));
  assert_true(vl_receipt_compare(receipt[0], parsed, VL_RECEIPT_SETTINGS, NULL, NULL) > 0);
  assert_int_equal(vl_receipt_compare(receipt[1], parsed, VL_RECEIPT_ALL, NULL, NULL), 0);
  vl_receipt_destroy(parsed);
  vl_receipt_destroy(receipt[0]);
  vl_receipt_destroy(receipt[1]);
  vlCameraRecord record = {.camera = defs->camera};
  assert_int_equal(vl_camera_write(s.context, "/tmp/velo_own.json", NULL, &record, &error),
                   VL_ERROR_UNSUPPORTED);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(same_as_velo),           cmocka_unit_test(same_in_motion),
      cmocka_unit_test(same_on_all_machines),   cmocka_unit_test(other_sizes),
      cmocka_unit_test(ground_truth),           cmocka_unit_test(no_rays),
      cmocka_unit_test(what_it_gets),           cmocka_unit_test(any_number_of_points),
      cmocka_unit_test(wrong_cameras),          cmocka_unit_test(sampler_mean),
      cmocka_unit_test(sampler_bits),           cmocka_unit_test(wrong_samplers),
      cmocka_unit_test(tracer_means),           cmocka_unit_test(tracer_bits),
      cmocka_unit_test(what_the_world_answers), cmocka_unit_test(wrong_tracers),
      cmocka_unit_test(names_in_films),         cmocka_unit_test(names_in_receipts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
