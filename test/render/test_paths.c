/* test/render/test_paths.c: the recorded paths of a pixel: their contributions sum to the
 * samples that a film adds, for surfaces, media, subsurface materials, lenses, and in RGB;
 * densities and weights of a known lamp; chains of vertices; names of images; wrong calls;
 * cancelling. */
#include <pthread.h>

#include "loaded.h"
#include "render/shots.h"
#include "velo/edit.h"
#include "velo/paths.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"
#include "velo/tracer.h"

enum { SIDE = 24, COUNT = 8 };

static vlPixelPaths *trace(const vlWorld *world, const vlCamera *camera, const vlFilmDef *film,
                           const vlRenderDef *def, uint32_t x, uint32_t y, uint32_t count) {
  vlPixelPaths *paths = NULL;
  vlError error = {0};
  if (vl_trace_paths(world, camera, film, def, x, y, 0, count, &paths, &error) != VL_OK)
    fail_msg("paths: %s", error.message);
  assert_int_equal(paths->samples, count);
  if (!def->share_samples)
    assert_int_equal(paths->count, count);
  return paths;
}

/* The pixel of a film with the samples from `first` to end - 1. */
static void rendered(vlContext *context, const vlWorld *world, const vlCamera *camera,
                     const vlFilmDef *film, const vlRenderDef *def, const vlPixelPaths *of,
                     uint32_t first, uint32_t end, float rgb[3]) {
  vlFilmDef pixel = *film;
  const uint32_t crop[4] = {of->x, of->y, of->x + 1, of->y + 1};
  memcpy(pixel.crop, crop, sizeof crop);
  vlRenderDef own = *def;
  own.first_sample = first;
  own.spp = end;
  vlFilm *made = NULL;
  vlImage *image = NULL;
  assert_int_equal(vl_film_create(context, &pixel, &made), VL_OK);
  assert_int_equal(vl_render(world, camera, made, &own, NULL, NULL), VL_OK);
  assert_int_equal(vl_film_develop(made, NULL, &image), VL_OK);
  for (uint32_t c = 0; c < 3; c++)
    rgb[c] = vl_image_get(image, 0, 0, c);
  vl_image_destroy(image);
  vl_film_destroy(made);
}

/* What a path carries after a vertex: what it brought, times the step's factor, more where
 * Russian roulette could have ended it. Glass with dispersion leaves one wavelength, which then
 * stands for all four. */
static void check_throughput(const vlPathVertex *v, const vlPathVertex *next) {
  const bool one_left = v->throughput[1] > 0 && next->throughput[1] == 0;
  for (int k = 0; k < 4 && !one_left; k++) {
    const double carried =
        (double)v->throughput[k] * (double)v->factor[k] / (double)v->survival;
    if (!(fabs((double)next->throughput[k] - carried) <= 1e-5 * carried))
      fail_msg("bounce %u, %s: %g is carried on, not %g", v->bounce, v->bsdf ? v->bsdf : "none",
               (double)next->throughput[k], carried);
  }
}

/* The distance of a vertex is that from the one before it. */
static void check_distance(const vlPath *p, uint32_t i) {
  const vlPathVertex *v = &p->vertices[i];
  const float *from = i ? v[-1].position : p->origin;
  double way[3];
  for (int k = 0; k < 3; k++)
    way[k] = (double)v->position[k] - (double)from[k];
  const double length = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
  if (!(fabs((double)v->distance - length) <= 1e-3 * length + 1e-3))
    fail_msg("bounce %u: distance %g of a point that is %g away", v->bounce,
             (double)v->distance, length);
}

/* What a path must fulfil whatever the scene. clear: nothing weakens light between surfaces. */
static void check_path(const vlPath *p, bool clear) {
  float sum[4] = {0, 0, 0, 0};
  double rgb[3] = {0, 0, 0}, size = 0;
  for (uint32_t i = 0; i < p->contribution_count; i++) {
    const vlPathContribution *c = &p->contributions[i];
    assert_true(c->vertex < p->vertex_count);
    assert_true(c->weight >= 0 && c->weight <= 1.00001f);
    assert_non_null(c->type);
    if (c->occluded)
      assert_true(c->radiance[0] == 0 && c->radiance[1] == 0);
    for (int k = 0; k < 4; k++)
      sum[k] += c->radiance[k];
    for (int k = 0; k < 3; k++) {
      rgb[k] += c->rgb[k];
      size += fabs(c->rgb[k]);
    }
  }
  for (int k = 0; k < 4; k++) {
    float expected = p->camera_weight > 0 ? sum[k] * p->camera_weight : 0;
    assert_memory_equal(&p->radiance[k], &expected, sizeof expected); /* the same bits */
  }
  for (int k = 0; k < 3; k++)
    assert_true(fabs(rgb[k] - p->rgb[k]) <= 2e-6 * size);
  for (uint32_t i = 0; i < p->vertex_count; i++) {
    const vlPathVertex *v = &p->vertices[i], *next = v + 1;
    assert_int_equal(v->fate == VL_PATH_ON, i + 1 < p->vertex_count);
    assert_int_equal(v->event == VL_PATH_NOTHING, v->fate == VL_PATH_LEFT);
    if (v->event == VL_PATH_SURFACE)
      assert_true(v->object && v->material && v->primitive);
    if (v->event != VL_PATH_NOTHING)
      check_distance(p, i);
    if (v->fate != VL_PATH_ON || next->event == VL_PATH_EXIT)
      continue;
    assert_memory_equal(v->direction, next->arrival, sizeof v->direction);
    assert_int_equal(next->bounce, v->bounce + 1);
    assert_true(v->pdf > 0);
    if (clear)
      check_throughput(v, next);
  }
}

/* What must occur in a scene, as bits: events of vertices, and from bit 8 on those of
 * contributions. */
enum {
  SURFACE = 1 << VL_PATH_SURFACE,
  MEDIUM = 1 << VL_PATH_MEDIUM,
  EXIT = 1 << VL_PATH_EXIT,
  NOTHING = 1 << VL_PATH_NOTHING,
  SAMPLED = 256 << VL_PATH_LIGHT_SAMPLED,
  HIT = 256 << VL_PATH_LIGHT_HIT,
  SKY = 256 << VL_PATH_LIGHT_SKY,
  GLOW = 256 << VL_PATH_LIGHT_MEDIUM
};

typedef struct Case {
  const char *scene;
  vlTracer tracer;
  uint32_t depth, occurs;
} Case;

static uint32_t occurring(const vlPath *p) {
  uint32_t bits = 0;
  for (uint32_t i = 0; i < p->vertex_count; i++)
    bits |= 1u << p->vertices[i].event;
  for (uint32_t i = 0; i < p->contribution_count; i++)
    bits |= 256u << p->contributions[i].event;
  return bits;
}

/* The mean of the paths with sample index `sample`, weighted by the filter. */
static void mean_of(const vlPixelPaths *paths, uint32_t sample, double rgb[3]) {
  double weight = 0;
  rgb[0] = rgb[1] = rgb[2] = 0;
  for (uint32_t i = 0; i < paths->count; i++) {
    const vlPath *p = &paths->paths[i];
    if (p->sample != sample)
      continue;
    weight += p->filter_weight;
    for (int c = 0; c < 3; c++)
      rgb[c] += (double)p->filter_weight * p->rgb[c];
  }
  for (int c = 0; c < 3; c++)
    rgb[c] /= weight;
}

static void check_sums(bool shared) {
  static const Case cases[] = {
      {"features/two_way.pbrt", VL_TRACER_PATH, 5, SURFACE | SAMPLED},
      {"features/media.pbrt", VL_TRACER_VOLPATH, 20, SURFACE | MEDIUM | SAMPLED | GLOW},
      {"features/subsurface.pbrt", VL_TRACER_VOLPATH, 8, SURFACE | EXIT | SAMPLED},
      {"features/lights.pbrt", VL_TRACER_PATH, 3, SURFACE | SAMPLED},
      {"features/sky.pbrt", VL_TRACER_VOLPATH, 5, SURFACE | NOTHING | SAMPLED | SKY},
      {"features/materials.pbrt", VL_TRACER_PATH, 6, SURFACE | SAMPLED},
      {"features/motion.pbrt", VL_TRACER_PATH, 5, SURFACE | SAMPLED},
      {"cameras/vignetting.pbrt", VL_TRACER_PATH, 5, SURFACE | SAMPLED},
      {"cameras/equidistant.pbrt", VL_TRACER_PATH, 0, SURFACE}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    Loaded l;
    assert_true(load_world(&l, cases[k].scene, SIDE, SIDE));
    vlFilmDef film = vl_default_film_def(SIDE, SIDE);
    vlRenderDef def = vl_default_render_def();
    def.tracer = cases[k].tracer;
    def.max_depth = cases[k].depth;
    def.spp = COUNT;
    def.share_samples = shared;
    uint32_t occurs = 0;
    for (uint32_t y = 1; y < SIDE; y += 5)
      for (uint32_t x = 1; x < SIDE; x += 5) {
        vlPixelPaths *paths = trace(l.world, &l.camera, &film, &def, x, y, COUNT);
        float rgb[3];
        uint32_t next = 0;
        for (uint32_t i = 0; i < paths->count; i++) {
          const vlPath *p = &paths->paths[i];
          bool own = p->x == (int32_t)x && p->y == (int32_t)y;
          if (own)
            assert_int_equal(p->sample, next++);
          assert_true((own || shared) && p->sample + 1 == next && p->filter_weight > 0);
          check_path(p, cases[k].tracer == VL_TRACER_PATH);
          occurs |= occurring(p);
        }
        assert_int_equal(next, COUNT);
        assert_int_equal(paths->count > COUNT, shared);
        double expected[3];
        mean_of(paths, 3, expected);
        rendered(l.context, l.world, &l.camera, &film, &def, paths, 3, 4, rgb);
        /* the film holds multiples of 2^-24 of the weight, and 2^-64 of the sample */
        for (int c = 0; c < 3; c++)
          if (fabs((double)rgb[c] - expected[c]) > 1e-6 * fabs(expected[c]) + 1e-12)
            fail_msg("%s (%u, %u): %g, rendered %g", cases[k].scene, x, y, expected[c],
                     (double)rgb[c]);
        rendered(l.context, l.world, &l.camera, &film, &def, paths, 0, COUNT, rgb);
        for (int c = 0; c < 3; c++)
          assert_true(fabs((double)rgb[c] - paths->mean[c]) <=
                      1e-6 * fabs(paths->mean[c]) + 1e-12);
        vl_pixel_paths_destroy(paths);
      }
    if ((occurs & cases[k].occurs) != cases[k].occurs)
      fail_msg("%s: only %x occurs", cases[k].scene, occurs);
    unload_world(&l);
  }
}

static void sums_of_own_samples(void **state) {
  (void)state;
  check_sums(false);
}

static void sums_of_shared_samples(void **state) {
  (void)state;
  check_sums(true);
}

/* The lamp at height 2, or the direction of a sun. */
typedef enum Lamp { LAMP_BALL, LAMP_POINT, LAMP_SUN } Lamp;
static const double sun[3] = {0.6, 0, 0.8};

/* A floor of reflectance 1/2 seen from straight above in RGB, with a lamp; the ball has the
 * radius 1/4. */
static Stage floor_stage(Lamp lamp) {
  Stage s = stage_open(SIDE, SIDE);
  s.camera.projection = VL_PROJECTION_ORTHOGRAPHIC;
  s.camera.eye[2] = 0.01;
  s.build.color = VL_COLOR_RGB;
  Quad q = quad_at(0, 0, 0, 40, 0, 0, 0, 40, 0);
  q.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
  add_quad(&s, &q);
  if (lamp != LAMP_BALL) {
    vlLightDef light =
        vl_default_light_def(lamp == LAMP_SUN ? VL_LIGHT_DISTANT : VL_LIGHT_POINT);
    light.from[2] = 2;
    light.scale = 3;
    for (int k = 0; lamp == LAMP_SUN && k < 3; k++) {
      light.from[k] = sun[k];
      light.to[k] = 0;
    }
    vl_scene_add_light(s.scene, &light);
  } else {
    vlEmissionDef emission = vl_default_emission_def();
    emission.scale = 3;
    vlShapeDef def = vl_default_shape_def(VL_SHAPE_SPHERE);
    def.radius = 0.25f;
    def.z_min = -0.25f;
    def.z_max = 0.25f;
    set_matrix(def.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 2);
    def.emission = vl_scene_add_emission(s.scene, &emission);
    assert_int_not_equal(vl_scene_add_shape(s.scene, &def).index, 0);
  }
  return s;
}

static void near(const char *what, double a, double b) {
  if (fabs(a - b) > 1e-4 * fabs(b))
    fail_msg("%s: %.9g, not %.9g", what, a, b);
}

/* One vertex on the floor, with what light sampling found there. Densities are those of the
 * formulas. */
static void check_floor(const vlPath *p, Lamp lamp, int *sampled, int *hit) {
  const vlPathVertex *v = &p->vertices[0];
  double at[3] = {v->position[0], v->position[1], v->position[2]},
         d2 = at[0] * at[0] + at[1] * at[1] + 4;
  assert_true(v->event == VL_PATH_SURFACE && v->bounce == 0 && fabs(at[2]) < 1e-5);
  assert_string_equal(v->bsdf, "diffuse");
  near("reflectance", v->reflectance[0], 0.5);
  /* 1 / the solid angle of the lamp */
  double sphere = 1 / (2 * M_PI * (1 - sqrt(1 - 0.0625 / d2)));
  for (uint32_t i = 0; i < p->contribution_count; i++) {
    const vlPathContribution *c = &p->contributions[i];
    if (c->event == VL_PATH_LIGHT_HIT) {
      assert_int_equal(c->vertex, 1);
      near("hit: light", c->light_pdf, sphere);
      near("hit: bsdf", c->bsdf_pdf, v->direction[2] / M_PI);
      near("hit: weight", c->weight,
           c->bsdf_pdf * c->bsdf_pdf / (c->bsdf_pdf * c->bsdf_pdf + sphere * sphere));
      near("hit: radiance", c->radiance[1], 0.5 * 3 * c->weight / v->survival);
      ++*hit;
      continue;
    }
    assert_int_equal(c->event, VL_PATH_LIGHT_SAMPLED);
    assert_int_equal(c->light, 1);
    if (c->vertex != 0)
      continue; /* the back of the lamp */
    double w[3] = {c->target[0] - at[0], c->target[1] - at[1], c->target[2] - at[2]};
    double l2 = w[0] * w[0] + w[1] * w[1] + w[2] * w[2], cosine = w[2] / sqrt(l2);
    static const char *const types[] = {"area", "point", "distant"};
    assert_string_equal(c->type, types[lamp]);
    assert_false(c->occluded);
    assert_int_equal(c->distant, lamp == LAMP_SUN);
    if (lamp == LAMP_SUN) {
      for (int k = 0; k < 3; k++)
        assert_near("sun: direction", c->target[k], sun[k], 1e-6);
      near("sun: radiance", c->radiance[1], 0.5 / M_PI * sun[2] * 3);
    } else if (lamp == LAMP_POINT) {
      near("point: pdf", c->light_pdf, 1);
      near("point: weight", c->weight, 1);
      near("point: radiance", c->radiance[1], 0.5 / M_PI * cosine * 3 / l2);
    } else {
      near("light", c->light_pdf, sphere);
      near("bsdf", c->bsdf_pdf, cosine / M_PI);
      double weight = sphere * sphere / (sphere * sphere + cosine / M_PI * (cosine / M_PI));
      near("weight", c->weight, weight);
      near("radiance", c->radiance[1], 0.5 / M_PI * cosine * 3 * weight / sphere);
      assert_int_equal(c->object, 2);
    }
    ++*sampled;
  }
}

static void densities(void **state) {
  (void)state;
  for (Lamp lamp = LAMP_BALL; lamp <= LAMP_SUN; lamp++) {
    Stage s = floor_stage(lamp);
    vlWorld *world = NULL;
    vlCamera camera;
    vlError error;
    if (vl_world_build(s.scene, &s.build, &world, &error) != VL_OK)
      fail_msg("build: %s", error.message);
    assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, NULL), VL_OK);
    int sampled = 0, hit = 0;
    for (uint32_t x = 0; x < SIDE; x += 6) {
      s.render.share_samples = false;
      vlPixelPaths *paths = trace(world, &camera, &s.film, &s.render, x, 5, 256);
      for (uint32_t i = 0; i < paths->count; i++)
        check_floor(&paths->paths[i], lamp, &sampled, &hit);
      vl_pixel_paths_destroy(paths);
    }
    assert_int_equal(sampled, 4 * 256);
    if (lamp == LAMP_BALL)
      assert_true(hit > 4);
    vl_world_destroy(world);
    stage_close(&s);
  }
}

/* A floor of one image, or of its tint, tells the image. */
static void names_of_images(void **state) {
  (void)state;
  for (int tinted = 0; tinted < 2; tinted++) {
    Stage s = floor_stage(LAMP_POINT);
    const vlMaterialId floor = {1};
    vlMaterialDef material = *vl_scene_material(s.scene, floor);
    vlTextureDef leaf = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
    leaf.path = VELO_SOURCE_DIR "/scenes/features/textures/leaf.png";
    material.reflectance.texture = vl_scene_add_texture(s.scene, &leaf);
    if (tinted) {
      vlTextureDef tint = vl_default_texture_def(VL_TEXTURE_SCALE, true);
      tint.spectrum_a.texture = material.reflectance.texture;
      material.reflectance.texture = vl_scene_add_texture(s.scene, &tint);
    }
    assert_int_equal(vl_scene_set_material(s.scene, floor, &material, NULL), VL_OK);
    vlWorld *world = NULL;
    vlCamera camera;
    assert_int_equal(vl_world_build(s.scene, &s.build, &world, NULL), VL_OK);
    assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, NULL), VL_OK);
    s.render.share_samples = false;
    vlPixelPaths *paths = trace(world, &camera, &s.film, &s.render, 5, 5, 1);
    const vlPathVertex *v = &paths->paths[0].vertices[0];
    assert_string_equal(v->texture, tinted ? "scale" : "image");
    assert_non_null(v->image);
    assert_string_equal(v->image, leaf.path);
    vl_pixel_paths_destroy(paths);
    vl_world_destroy(world);
    stage_close(&s);
  }
}

static void wrong_calls(void **state) {
  (void)state;
  Loaded l;
  assert_true(load_world(&l, "features/two_way.pbrt", SIDE, SIDE));
  vlFilmDef film = vl_default_film_def(SIDE, SIDE);
  vlRenderDef def = vl_default_render_def();
  vlPixelPaths *paths = NULL;
  vlError error;
  assert_int_equal(
      vl_trace_paths(l.world, &l.camera, &film, &def, SIDE, 0, 0, 1, &paths, &error),
      VL_ERROR_ARGUMENT);
  assert_int_equal(vl_trace_paths(l.world, &l.camera, &film, &def, 0, 0, 0, 0, &paths, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_trace_paths(NULL, &l.camera, &film, &def, 0, 0, 0, 1, &paths, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_trace_paths(l.world, &l.camera, &film, &def, 0, 0, 0, 1, NULL, &error),
                   VL_ERROR_ARGUMENT);
  def.tracer = VL_TRACER_BIDIRECTIONAL;
  assert_int_equal(vl_trace_paths(l.world, &l.camera, &film, &def, 0, 0, 0, 1, &paths, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "path and volpath"));
  film = vl_default_film_def(SIDE + 1, SIDE);
  def.tracer = VL_TRACER_PATH;
  assert_int_equal(vl_trace_paths(l.world, &l.camera, &film, &def, 0, 0, 0, 1, &paths, &error),
                   VL_ERROR_ARGUMENT);
  assert_null(paths);
  vl_pixel_paths_destroy(NULL);
  unload_world(&l);
}

static void *request(void *cancel) {
  vl_cancel_request(cancel);
  return NULL;
}

/* A request before the call, and one from another thread during it. */
static void cancelled(void **state) {
  (void)state;
  Loaded l;
  assert_true(load_world(&l, "features/two_way.pbrt", SIDE, SIDE));
  vlFilmDef film = vl_default_film_def(SIDE, SIDE);
  vlRenderDef def = vl_default_render_def();
  vlPixelPaths *paths = NULL;
  vlError error;
  vlCancel *cancel;
  assert_int_equal(vl_cancel_create(l.context, &cancel), VL_OK);
  def.cancel = cancel;
  vl_cancel_request(cancel);
  assert_int_equal(vl_trace_paths(l.world, &l.camera, &film, &def, 9, 9, 0, 4, &paths, &error),
                   VL_CANCELLED);
  assert_null(paths);
  vl_cancel_clear(cancel);
  pthread_t thread;
  assert_int_equal(pthread_create(&thread, NULL, request, cancel), 0);
  assert_int_equal(
      vl_trace_paths(l.world, &l.camera, &film, &def, 9, 9, 0, 1 << 20, &paths, &error),
      VL_CANCELLED);
  pthread_join(thread, NULL);
  assert_null(paths);
  vl_cancel_destroy(cancel);
  unload_world(&l);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sums_of_own_samples), cmocka_unit_test(sums_of_shared_samples),
      cmocka_unit_test(densities),           cmocka_unit_test(names_of_images),
      cmocka_unit_test(wrong_calls),         cmocka_unit_test(cancelled)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
