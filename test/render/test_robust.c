/* test/render/test_robust.c: degenerate scenes: no crash, no hang, no NaN pixel. Best run under
 * the sanitizers. */
#include <time.h>

#include "render/shots.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"
#include "velo/tracer.h"

static double seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void assert_clean(const char *what, Image *p) {
  for (size_t i = 0; i < (size_t)p->width * p->height * 4; i++)
    if (!isfinite(p->rgba[i]))
      fail_msg("%s: a pixel is not finite", what);
}

static void done(const char *what, Stage *s, bool all_finite) {
  Image p = stage_finish(s);
  assert_clean(what, &p);
  if (all_finite && p.stats.not_finite)
    fail_msg("%s: %g samples not finite", what, (double)p.stats.not_finite);
  image_free(&p);
}

static void nothing_at_all(void **state) {
  (void)state;
  for (int tracer = 0; tracer < 3; tracer++)
    for (int sky = 0; sky < 2; sky++) {
      Stage s = stage_open(5, 3);
      s.render.tracer = (vlTracer)tracer;
      if (sky)
        add_sky(&s, 1);
      Image p = stage_finish(&s);
      assert_near("empty scene", image_mean(&p, 1),
                  sky && tracer != VL_TRACER_AMBIENT_OCCLUSION, 0.1);
      image_free(&p);
    }
  Stage s = stage_open(1, 1); /* one pixel, an empty group, a group nobody places */
  double identity[16];
  set_matrix(identity, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0);
  vl_scene_add_instance(s.scene, vl_scene_add_group(s.scene, "empty"), identity, (vlSource){0});
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  ball.group = vl_scene_add_group(s.scene, "unused");
  vl_scene_add_shape(s.scene, &ball);
  add_point(&s, 0, 0, 0, 1);
  done("next to nothing", &s, true);
}

static void degenerate_triangles(void **state) {
  (void)state;
  Stage s = stage_open(32, 24);
  add_sky(&s, 1);
  /* a point, a line, a needle, twins, and one real triangle; uv all the same; zero normals */
  static const float p[30] = {0,  0, -2, 1, 0, -2, 2,  0, -2, 0,      1e-20f, -2, 0, 1, -2,
                              -1, 0, -2, 0, 1, -2, -1, 0, -2, 1e-38f, 1e-38f, -1, 0, 0, -1};
  static const float n[30] = {0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1e-30f};
  static const float uv[20] = {0};
  static const uint32_t f[24] = {0, 0, 0, 0, 1, 2, 0, 1, 3, 0, 4, 5,
                                 0, 6, 7, 8, 9, 8, 1, 1, 4, 0, 1, 4};
  for (int k = 0; k < 8; k++) {
    vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
    def.vertices = 10;
    def.faces = 8;
    def.positions = p;
    def.indices = f;
    if (k & 1) {
      def.normals = n;
      def.tangents = n;
    }
    if (k & 2)
      def.uvs = uv;
    if (k & 4)
      def.emission = add_emission(&s, 1, true);
    vlTextureDef h = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, false);
    vlMaterialDef m =
        vl_default_material_def(k & 1 ? VL_MATERIAL_CONDUCTOR : VL_MATERIAL_COATED_DIFFUSE);
    m.displacement.texture = vl_scene_add_texture(s.scene, &h);
    def.material = vl_scene_add_material(s.scene, &m);
    set_matrix(def.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0.2 * k - 0.8, 0, 0, 1, 0.01 * k);
    vl_scene_add_shape(s.scene, &def);
  }
  vlShapeDef patch = vl_default_shape_def(VL_SHAPE_BILINEAR);
  static const uint32_t index[12] = {0, 0, 0, 0, 0, 1, 0, 1, 0, 1, 4, 4};
  patch.vertices = 10;
  patch.faces = 3;
  patch.positions = p;
  patch.indices = index;
  patch.emission = add_emission(&s, 1, false);
  vl_scene_add_shape(s.scene, &patch);
  vlShapeDef thin = vl_default_shape_def(VL_SHAPE_CYLINDER);
  thin.z_min = 0;
  thin.z_max = 1e-30f;
  thin.emission = patch.emission;
  vl_scene_add_shape(s.scene, &thin);
  thin = vl_default_shape_def(VL_SHAPE_DISK);
  thin.inner_radius = 0.99999994f;
  thin.emission = patch.emission;
  vl_scene_add_shape(s.scene, &thin);
  thin = vl_default_shape_def(VL_SHAPE_SPHERE);
  thin.z_min = 0.9999999f;
  thin.z_max = 1;
  thin.phi_max = 1e-6f;
  thin.emission = patch.emission;
  vl_scene_add_shape(s.scene, &thin);
  done("degenerate shapes", &s, true);
}

/* The same image at any size of the world. */
static void scales(void **state) {
  (void)state;
  double mean[5];
  const double scale[5] = {1, 1e6, 1e-6, 1e12, 1e-12};
  for (int k = 0; k < 5; k++) {
    Stage s = stage_open(32, 24);
    add_sky(&s, 0.5f);
    add_point(&s, (float)(2 * scale[k]), (float)(2 * scale[k]), 0,
              (float)(5 * scale[k] * scale[k]));
    Quad floor = quad_at(0, (float)-scale[k], (float)(-3 * scale[k]), (float)(3 * scale[k]), 0,
                         0, 0, 0, (float)(-3 * scale[k]));
    add_quad(&s, &floor);
    Quad light = quad_at(0, (float)scale[k], (float)(-3 * scale[k]), (float)(0.3 * scale[k]), 0,
                         0, 0, 0, (float)(0.3 * scale[k]));
    light.emission = add_emission(&s, 3, false);
    add_quad(&s, &light);
    vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
    set_matrix(ball.group_from_shape, scale[k], 0, 0, -scale[k], 0, scale[k], 0, 0, 0, 0,
               scale[k], -4 * scale[k]);
    vl_scene_add_shape(s.scene, &ball);
    float *block = NULL;
    vlShapeDef mesh = mesh_sphere(12, 1, true, &block);
    vlMaterialDef glass = vl_default_material_def(VL_MATERIAL_DIELECTRIC);
    mesh.material = vl_scene_add_material(s.scene, &glass);
    set_matrix(mesh.group_from_shape, scale[k], 0, 0, scale[k], 0, scale[k], 0, 0, 0, 0,
               scale[k], -4 * scale[k]);
    vl_scene_add_shape(s.scene, &mesh);
    free(block);
    s.render.spp = 64;
    Image p = stage_finish(&s);
    assert_clean("scale", &p);
    assert_int_equal(p.stats.not_finite, 0);
    mean[k] = image_mean(&p, 1);
    image_free(&p);
  }
  assert_ratio("a million times larger", mean[1], mean[0], 5e-3);
  assert_ratio("a million times smaller", mean[2], mean[0], 5e-3);
}

static void eye_inside_and_on_things(void **state) {
  (void)state;
  for (int k = 0; k < 6; k++) {
    Stage s = stage_open(24, 24);
    add_sky(&s, 1);
    vlMaterialDef def =
        vl_default_material_def(k < 3 ? VL_MATERIAL_DIELECTRIC : VL_MATERIAL_DIFFUSE);
    float *block = NULL;
    vlShapeDef ball =
        k & 1 ? mesh_sphere(8, 1, false, &block) : vl_default_shape_def(VL_SHAPE_SPHERE);
    ball.material = vl_scene_add_material(s.scene, &def);
    vl_scene_add_shape(s.scene, &ball);
    vl_scene_add_shape(s.scene, &ball); /* twice the same surface */
    free(block);
    s.camera.eye[2] = k % 3 == 0   ? 0
                      : k % 3 == 1 ? 1
                                   : 1 + 1e-7; /* in the middle, on the surface, just off it */
    s.camera.lookat[2] = s.camera.eye[2] - 1;
    add_point(&s, 0, 0, (float)s.camera.eye[2], 1); /* a light in the very eye */
    /* on the surface the light is nearer than what a film can hold */
    done("eye inside", &s, k % 3 == 0);
  }
}

/* Two walls in one place: no speckles of black, light is that of one. */
static void coincident_surfaces(void **state) {
  (void)state;
  double mean[2];
  for (int copies = 1; copies <= 2; copies++) {
    Stage s = stage_open(32, 32);
    add_point(&s, 0.3f, 0.4f, 1, 5);
    for (int k = 0; k < copies; k++) {
      Quad q = quad_at(0, 0, -1.2345f, 3, 0.1f, 0.2f, 0, 3, 0.3f);
      add_quad(&s, &q);
    }
    Image p = stage_finish(&s);
    mean[copies - 1] = image_mean(&p, 1);
    image_free(&p);
  }
  assert_ratio("coincident walls", mean[1], mean[0], 1e-3);
}

static void dark_and_wild_lights(void **state) {
  (void)state;
  for (int sampler = 0; sampler < 3; sampler++)
    for (int k = 0; k < 6; k++) {
      Stage s = stage_open(16, 16);
      s.build.light_sampler = (vlLightSampler)sampler;
      Quad q = quad_at(0, 0, -2, 1, 0, 0, 0, 1, 0);
      add_quad(&s, &q);
      q = quad_at(0, 1.5f, -1, 1, 0, 0, 0, 0, 1);
      vlLightDef light = vl_default_light_def((vlLightKind)(k % 4));
      light.scale = k < 4 ? 0 : k == 4 ? 1e30f : -1;
      vl_scene_add_light(s.scene, &light);
      if (k == 2) {
        light.color = vl_spectrum_constant(0);
        light.scale = 1;
        vl_scene_add_light(s.scene, &light);
      }
      vlEmissionDef emission = vl_default_emission_def();
      emission.scale = k == 5 ? 1e30f : 0;
      emission.power = k == 1 ? 0 : VL_UNSET;
      q.emission = vl_scene_add_emission(s.scene, &emission);
      add_quad(&s, &q);
      Image p = stage_finish(&s);
      assert_clean("dark and wild lights", &p);
      if (k < 4)
        assert_int_equal(p.stats.not_finite, 0);
      if (k == 5)
        /* brighter than a film can hold: dropped, and counted */
        assert_true(p.stats.not_finite > 0);
      image_free(&p);
    }
}

/* Values that no surface has: clamped, or dropped and counted. */
static void wild_materials(void **state) {
  (void)state;
  const float wild[8] = {-1, 2, 1e30f, 1e-30f, 0, -1e-3f, 1e-5f, 50};
  for (int kind = 0; kind <= VL_MATERIAL_THIN_DIELECTRIC; kind++)
    for (int k = 0; k < 8; k++) {
      Stage s = stage_open(12, 12);
      add_sky(&s, 1);
      add_point(&s, 1, 1, 1, 5);
      vlMaterialDef def = vl_default_material_def((vlMaterialKind)kind);
      def.reflectance = vl_spectrum_input(vl_spectrum_constant(wild[k]));
      def.u_roughness = vl_float_input(wild[k]);
      def.v_roughness = vl_float_input(wild[(k + 3) % 8]);
      if (kind == VL_MATERIAL_CONDUCTOR && k & 1)
        def.eta = def.k = vl_spectrum_input(vl_spectrum_constant(wild[k]));
      if (kind == VL_MATERIAL_COATED_DIFFUSE)
        def.thickness = vl_float_input(wild[k] > 0 ? wild[k] : 0);
      vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
      set_matrix(ball.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -2);
      ball.material = vl_scene_add_material(s.scene, &def);
      vl_scene_add_shape(s.scene, &ball);
      vlWorld *world = NULL;
      vlError error;
      vlResult r = vl_world_build(s.scene, &s.build, &world, &error);
      vl_world_destroy(world);
      if (r == VL_OK) {
        done("wild material", &s, false);
      } else {
        assert_true(error.message[0] != 0);
        stage_close(&s);
      }
    }
}

static void wild_images(void **state) {
  (void)state;
  const float bad[4] = {INFINITY, NAN, -1e30f, 1e38f};
  for (int k = 0; k < 4; k++)
    for (int use = 0; use < 5; use++) { /* reflectance, roughness, sky, displacement, alpha */
      float rgb[4 * 4 * 3];
      for (int i = 0; i < 48; i++)
        rgb[i] = i / 3 % 5 == 2 ? bad[k] : 0.5f;
      Stage s = stage_open(16, 16);
      add_point(&s, 1, 1, 1, 5);
      vlImage *image = make_image(&s, 4, 4, rgb);
      if (use == 2) {
        vlLightDef sky = vl_default_light_def(VL_LIGHT_INFINITE);
        sky.image = image;
        vl_scene_add_light(s.scene, &sky);
      }
      vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, use == 0);
      def.image = image;
      def.filter = (vlTextureFilter)(k % 4);
      vlTextureId id = vl_scene_add_texture(s.scene, &def);
      vlMaterialDef m =
          vl_default_material_def(use == 1 ? VL_MATERIAL_CONDUCTOR : VL_MATERIAL_DIFFUSE);
      if (use == 0)
        m.reflectance.texture = id;
      if (use == 1)
        m.u_roughness.texture = m.v_roughness.texture = id;
      if (use == 3)
        m.displacement.texture = id;
      Quad q = quad_at(0, 0, -2, 1, 0, 0, 0, 1, 0);
      q.material = vl_scene_add_material(s.scene, &m);
      if (use == 4)
        q.alpha.texture = id;
      add_quad(&s, &q);
      vl_image_destroy(image);
      vlWorld *world = NULL;
      vlError error;
      vlResult r = vl_world_build(s.scene, &s.build, &world, &error);
      vl_world_destroy(world);
      if (r == VL_OK) {
        done("wild image", &s, false);
      } else {
        assert_int_equal(r, VL_ERROR_SCENE);
        stage_close(&s);
      }
    }
}

static void thousands_of_materials(void **state) {
  (void)state;
  Image p[2];
  for (int many = 0; many < 2; many++) {
    Stage s = stage_open(64, 48);
    add_point(&s, 0, 0, 1, 5);
    add_sky(&s, 0.3f);
    double start = seconds();
    vlMaterialId grey = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
    for (int k = 0; k < 5000; k++) {
      Quad q = quad_at(-1 + 0.02f * (float)(k % 100), -1 + 0.04f * (float)(k / 100), -1.5f,
                       0.01f, 0, 0, 0, 0.02f, 0);
      q.material = many ? add_diffuse(&s, 0.5f, 0.5f, 0.5f) : grey;
      add_quad(&s, &q);
    }
    p[many] = stage_finish(&s);
    if (seconds() - start > 20)
      fail_msg("5000 materials took %.1f s", seconds() - start);
  }
  assert_true(image_differing(&p[0], &p[1], 1e-6) == 0);
  image_free(&p[0]);
  image_free(&p[1]);
}

/* A cloud of 100 000 tiny lights lights a floor as one large light of the same power does from
 * afar. */
static void a_hundred_thousand_lights(void **state) {
  (void)state;
  enum { N = 50000 };
  float *p = malloc(N * 12 * sizeof *p);
  uint32_t *f = malloc(N * 6 * sizeof *f), seed = 1;
  for (uint32_t k = 0; k < N; k++) {
    float c[2];
    for (int i = 0; i < 2; i++) {
      seed = seed * 1664525u + 1013904223u;
      c[i] = (float)(seed >> 8) * 0x1p-23f - 1;
    }
    const float at[12] = {c[0], 1, c[1],         c[0] + 1e-3f, 1, c[1],
                          c[0], 1, c[1] + 1e-3f, c[0] + 1e-3f, 1, c[1] + 1e-3f};
    memcpy(p + 12 * (size_t)k, at, sizeof at);
    const uint32_t index[6] = {4 * k, 4 * k + 1, 4 * k + 3, 4 * k, 4 * k + 3, 4 * k + 2};
    memcpy(f + 6 * (size_t)k, index, sizeof index);
  }
  double mean[2];
  for (int many = 0; many < 2; many++) {
    Stage s = stage_open(32, 24);
    s.camera.lookat[1] = -0.5;
    s.render.max_depth = 1;
    s.render.spp = 32;
    Quad floor = quad_at(0, -1, -1, 2, 0, 0, 0, 0, -2);
    add_quad(&s, &floor);
    double start = seconds();
    if (many) {
      vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
      def.vertices = 4 * N;
      def.faces = 2 * N;
      def.positions = p;
      def.indices = f;
      def.emission = add_emission(&s, 4.0f / (N * 1e-6f), false);
      vl_scene_add_shape(s.scene, &def);
    } else {
      Quad q = quad_at(0, 1, 0, 1, 0, 0, 0, 0, 1);
      q.emission = add_emission(&s, 1, false);
      add_quad(&s, &q);
    }
    vlWorld *world = NULL;
    assert_int_equal(vl_world_build(s.scene, &s.build, &world, NULL), VL_OK);
    double build = seconds() - start;
    vl_world_destroy(world);
    Image q = stage_finish(&s);
    mean[many] = image_mean(&q, 1);
    if (many)
      printf("[  INFO    ] 100000 lights: built in %.2f s, %.2f s for %g paths\n", build,
             q.stats.seconds, (double)q.stats.paths);
    if (build > 30 || q.stats.seconds > 60)
      fail_msg("100000 lights: build %.1f s, render %.1f s", build, q.stats.seconds);
    image_free(&q);
  }
  free(p);
  free(f);
  assert_ratio("a hundred thousand lights", mean[1], mean[0], 0.02);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nothing_at_all),
      cmocka_unit_test(degenerate_triangles),
      cmocka_unit_test(scales),
      cmocka_unit_test(eye_inside_and_on_things),
      cmocka_unit_test(coincident_surfaces),
      cmocka_unit_test(dark_and_wild_lights),
      cmocka_unit_test(wild_materials),
      cmocka_unit_test(wild_images),
      cmocka_unit_test(thousands_of_materials),
      cmocka_unit_test(a_hundred_thousand_lights),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
