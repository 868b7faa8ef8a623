/* test/render/test_own_ends.c: how renders with code of one's own (velo/own.h) end early:
 * without memory, and cancelled by that code itself. */
#include "render/shots.h"

#include <stdatomic.h>

#include "api/small_world.h"
#include "failing_allocator.h"
#include "velo/film.h"
#include "velo/trace.h"
#include "velo/tracer.h"

enum { WIDTH = 8, HEIGHT = 6, WIDER = 30 * WIDTH }; /* wider: several batches in a pass */

/* What the functions do: they count their calls, and in call `at` (from 1; 0: never) they
 * request the end. */
typedef struct Calls {
  atomic_uint count[VL_OWN_KINDS];
  vlOwnKind kind;
  uint32_t at;
  vlCancel *cancel;
} Calls;

static void called(Calls *calls, vlOwnKind kind) {
  uint32_t number = atomic_fetch_add(&calls->count[kind], 1) + 1;
  if (calls->cancel && kind == calls->kind && number == calls->at)
    vl_cancel_request(calls->cancel);
}

static void rays(void *user, const vlOwnFilmPoints *points, const vlOwnRays *out) {
  called(user, VL_OWN_CAMERA);
  for (uint32_t i = 0; i < points->count; i++) {
    out->dx[i] = points->x[i] - 0.5 * points->width;
    out->dy[i] = points->y[i] - 0.5 * points->height;
    out->dz[i] = points->width;
  }
}

static void pixels(void *user, const vlOwnSpacePoints *points) {
  (void)user;
  for (uint32_t i = 0; i < points->count; i++) {
    if (!(points->z[i] > 0))
      continue;
    points->film_x[i] = points->width * points->x[i] / points->z[i] + 0.5 * points->width;
    points->film_y[i] = points->width * points->y[i] / points->z[i] + 0.5 * points->height;
  }
}

static void numbers(void *user, const vlOwnSamples *s) {
  called(user, VL_OWN_SAMPLER);
  for (uint32_t i = 0; i < s->count; i++) {
    uint32_t h = (s->index[i] * 0x9e3779b9u ^ s->dimension * 0x85ebca6bu) +
                 (uint32_t)s->x[i] * 0x27d4eb2fu;
    s->u[i] = (float)(h >> 8) * 0x1p-24f;
    if (s->v)
      s->v[i] = (float)((h * 0x846ca68bu) >> 8) * 0x1p-24f;
  }
}

static void radiance(void *user, vlTrace *trace, const vlOwnPaths *paths) {
  vlTraceHits hits;
  called(user, VL_OWN_TRACER);
  vl_world_trace(trace, paths->rays, &hits);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = 0; i < paths->count; i++)
      paths->radiance[c][i] = hits.emission[c][i] + hits.reflectance[c][i];
}

/* A small scene, its world, camera and film; own code of each kind that a bit of `kinds`
 * names. */
typedef struct Work {
  vlScene *scene;
  vlWorld *world;
  vlFilm *film;
  vlCamera camera;
  vlRenderDef render;
  Calls calls;
  vlOwnCamera own_camera;
  vlOwnSampler own_sampler;
  vlOwnTracer own_tracer;
} Work;

static vlResult prepare(vlContext *context, uint32_t kinds, vlTracer tracer, uint32_t width,
                        Work *w) {
  vlError error = {0};
  memset(w, 0, sizeof *w);
  w->own_camera =
      (vlOwnCamera){.name = "camera", .rays = rays, .pixels = pixels, .user = &w->calls};
  w->own_sampler = (vlOwnSampler){.name = "sampler", .numbers = numbers, .user = &w->calls};
  w->own_tracer = (vlOwnTracer){.name = "tracer", .radiance = radiance, .user = &w->calls};
  vlCameraDef camera = vl_default_camera_def(width, HEIGHT);
  const double eye[3] = {0, 1.6, 5}, lookat[3] = {0, 0.5, 0};
  memcpy(camera.eye, eye, sizeof eye);
  memcpy(camera.lookat, lookat, sizeof lookat);
  if (kinds & 1u << VL_OWN_CAMERA)
    camera.own = &w->own_camera;
  w->render = vl_default_render_def();
  w->render.spp = 2;
  w->render.tracer = tracer;
  if (kinds & 1u << VL_OWN_SAMPLER)
    w->render.own_sampler = &w->own_sampler;
  if (kinds & 1u << VL_OWN_TRACER)
    w->render.own_tracer = &w->own_tracer;
  vlFilmDef film = vl_default_film_def(width, HEIGHT);
  vlResult r = vl_scene_create(context, &w->scene);
  if (r == VL_OK) {
    small_scene(w->scene);
    r = vl_scene_result(w->scene, &error);
  }
  if (r == VL_OK)
    r = vl_world_build(w->scene, NULL, &w->world, &error);
  if (r == VL_OK)
    r = vl_camera_make(&camera, &w->camera, NULL, &error);
  if (r == VL_OK)
    r = vl_film_create(context, &film, &w->film);
  return r;
}

static void end(Work *w) {
  vl_film_destroy(w->film);
  vl_world_destroy(w->world);
  vl_scene_destroy(w->scene);
}

typedef struct Case {
  uint32_t kinds;
  vlTracer tracer;
} Case;

static vlResult render(vlContext *context, void *user) {
  const Case *c = user;
  Work w;
  vlResult r = prepare(context, c->kinds, c->tracer, WIDTH, &w);
  if (r == VL_OK)
    r = vl_render(w.world, &w.camera, w.film, &w.render, NULL, NULL);
  if (r == VL_OK && c->kinds & 1u << VL_OWN_CAMERA)
    assert_string_equal(vl_film_own(w.film, VL_OWN_CAMERA), "camera");
  end(&w);
  return r;
}

/* Each failing allocation gives an error and leaks nothing. */
static void out_of_memory(void **state) {
  (void)state;
  Case all = {7, VL_TRACER_PATH}, both_ways = {3, VL_TRACER_BIDIRECTIONAL};
  fail_everywhere(render, &all, 30);
  fail_everywhere(render, &both_ways, 30);
}

/* Each kind requests the end in its first call and in a call of the second pass. The film keeps
 * whole passes, and once the batch is done no function is called again. A later render goes on,
 * with the same image as one without an end. */
static void cancelled_by_its_code(void **state) {
  (void)state;
  for (int kind = 0; kind < VL_OWN_KINDS; kind++) {
    vlContextDef def = vl_default_context_def();
    def.threads = 1;
    vlContext *context;
    Work w;
    assert_int_equal(vl_context_create(&def, &context), VL_OK);
    assert_int_equal(prepare(context, 7, VL_TRACER_PATH, WIDER, &w), VL_OK);
    uint32_t before = atomic_load(&w.calls.count[kind]);
    assert_int_equal(vl_render(w.world, &w.camera, w.film, &w.render, NULL, NULL), VL_OK);
    uint32_t calls = atomic_load(&w.calls.count[kind]) - before;
    assert_true(calls >= 2 && calls % 2 == 0);
    vlImage *whole, *image;
    assert_int_equal(vl_film_develop(w.film, NULL, &whole), VL_OK);
    assert_int_equal(vl_cancel_create(context, &w.calls.cancel), VL_OK);
    w.render.cancel = w.calls.cancel;
    for (uint32_t passes = 0; passes < 2; passes++) {
      vl_film_clear(w.film);
      vl_cancel_clear(w.calls.cancel);
      uint32_t start = atomic_load(&w.calls.count[kind]);
      w.calls.kind = (vlOwnKind)kind;
      w.calls.at = start + 1 + passes * calls / 2;
      vlError error = {0};
      vlRenderStats stats;
      assert_int_equal(vl_render(w.world, &w.camera, w.film, &w.render, &stats, &error),
                       VL_CANCELLED);
      assert_int_equal(vl_film_spp(w.film), passes);
      uint32_t after = atomic_load(&w.calls.count[kind]) - start;
      assert_true(after < calls && after >= 1 + passes * calls / 2);
      w.calls.at = 0;
      vl_cancel_clear(w.calls.cancel);
      assert_int_equal(vl_render(w.world, &w.camera, w.film, &w.render, NULL, NULL), VL_OK);
      assert_int_equal(vl_film_develop(w.film, NULL, &image), VL_OK);
      assert_memory_equal(vl_image_const_pixels(whole), vl_image_const_pixels(image),
                          (size_t)WIDER * HEIGHT * 4 * sizeof(float));
      vl_image_destroy(image);
    }
    vl_cancel_destroy(w.calls.cancel);
    vl_image_destroy(whole);
    end(&w);
    assert_int_equal(vl_context_memory(context, NULL), 0);
    vl_context_destroy(context);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(out_of_memory),
                                     cmocka_unit_test(cancelled_by_its_code)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
