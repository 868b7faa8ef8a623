/* test/world/test_build_memory.c: the n-th allocation fails while a world is built or an image
 * rendered, for every n: the error is always VL_ERROR_MEMORY and nothing leaks. (Embree has its
 * own memory.) */
#include <stdlib.h>

#include "render/shots.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

typedef struct Purse {
  long left;    /* allocations that still succeed; negative: all */
  bool refused; /* one has failed since `left` was set by limit */
} Purse;

static void limit(Purse *p, long left) {
  p->left = left;
  p->refused = false;
}

static void *purse_allocate(void *user, size_t size) {
  Purse *p = user;
  if (p->left == 0) {
    p->refused = true;
    return NULL;
  }
  if (p->left > 0)
    p->left--;
  return malloc(size);
}
static void purse_release(void *user, void *block) {
  (void)user;
  free(block);
}

/* One of everything that a build has to allocate for. */
static void fill(Stage *s, const char *path) {
  const float rgb[4 * 4 * 3] = {1, 0.5f, 0.2f, 3, 0, 0, 0.5f};
  vlImage *image = make_image(s, 4, 4, rgb);
  assert_int_equal(vl_image_write(image, path, NULL, NULL), VL_OK);
  vlTextureDef map = vl_default_texture_def(VL_TEXTURE_IMAGE, true), file = map;
  map.image = image;
  file.path = path;
  vlTextureId a = vl_scene_add_texture(s->scene, &map),
              b = vl_scene_add_texture(s->scene, &file);
  vlTextureDef mix = vl_default_texture_def(VL_TEXTURE_MIX, true);
  mix.spectrum_a.texture = a;
  mix.spectrum_b.texture = b;
  vlTextureDef checks = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, false);
  vlTextureId height = vl_scene_add_texture(s->scene, &checks);
  vlMaterialDef defs[6];
  vlMaterialId ids[6];
  for (int k = 0; k < 6; k++) {
    defs[k] = vl_default_material_def((vlMaterialKind)k);
    if (k == VL_MATERIAL_DIFFUSE)
      defs[k].reflectance.texture = vl_scene_add_texture(s->scene, &mix);
    if (k == VL_MATERIAL_DIFFUSE) {
      defs[k].displacement.texture = height;
      defs[k].normal_map = path;
    }
    if (k == VL_MATERIAL_DIELECTRIC)
      defs[k].eta = vl_spectrum_input(vl_spectrum_named("glass-BK7"));
    if (k == VL_MATERIAL_MIX) {
      defs[k].materials[0] = ids[0];
      defs[k].materials[1] = ids[2];
    }
    ids[k] = vl_scene_add_material(s->scene, &defs[k]);
    Quad q = quad_at(0, 0, -1 - (float)k, 1, 0, 0, 0, 1, 0);
    q.material = ids[k];
    q.patch = k == 1;
    if (k == 2)
      q.alpha.texture = height;
    if (k == 3)
      q.emission = add_emission(s, 1, true);
    if (k == 4)
      q.group = vl_scene_add_group(s->scene, "group");
    add_quad(s, &q);
    double identity[16];
    set_matrix(identity, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0);
    if (k == 4)
      vl_scene_add_instance(s->scene, q.group, identity, (vlSource){0});
    double poses[32], times[2] = {0, 1};
    memcpy(poses, identity, sizeof identity);
    set_matrix(poses + 16, 0, -1, 0, 0, 1, 0, 0, 2, 0, 0, 1, 0);
    if (k == 4)
      vl_scene_add_moving_instance(s->scene, q.group, 2, times, poses, (vlSource){0});
  }
  float *block = NULL;
  vlShapeDef mesh = mesh_sphere(3, 1, true, &block);
  set_matrix(mesh.group_from_shape, 1, 0, 0, 2, 0, 1, 0, 0, 0, 0, 1, -4);
  vlEmissionDef emission = vl_default_emission_def();
  emission.image = path;
  mesh.emission = vl_scene_add_emission(s->scene, &emission);
  vl_scene_add_shape(s->scene, &mesh);
  mesh.emission.index = 0;
  mesh.positions_close = mesh.positions;
  mesh.normals_close = mesh.normals; /* on its way, if only to itself */
  vl_scene_add_shape(s->scene, &mesh);
  free(block);
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  const float cells[6] = {1, 2, 3, 4, 5, 6};
  for (int k = VL_MEDIUM_HOMOGENEOUS; k < VL_MEDIUM_NANOVDB; k++) {
    vlMediumDef medium = vl_default_medium_def((vlMediumKind)k);
    medium.sigma_a = vl_spectrum_rgb(1, 2, 3);
    medium.nx = 2;
    medium.density = medium.temperature = medium.emission_scales = cells;
    medium.rgb_a = medium.rgb_emission = cells;
    ball.inside = vl_scene_add_medium(s->scene, &medium);
    vl_scene_add_shape(s->scene, &ball);
  }
  add_point(s, 0, 0, 0, 1);
  vlLightDef sky = vl_default_light_def(VL_LIGHT_INFINITE);
  sky.image = image;
  vl_scene_add_light(s->scene, &sky);
  sky.image = NULL;
  sky.path = path;
  vl_scene_add_light(s->scene, &sky);
  vl_image_destroy(image);
}

static Stage purse_stage(Purse *purse) {
  Stage s = stage_open(8, 8);
  vl_scene_destroy(s.scene);
  vl_context_destroy(s.context);
  vlContextDef def = vl_default_context_def();
  def.threads = 2;
  def.allocator = (vlAllocator){purse, purse_allocate, purse_release};
  assert_int_equal(vl_context_create(&def, &s.context), VL_OK);
  assert_int_equal(vl_scene_create(s.context, &s.scene), VL_OK);
  return s;
}

/* A stage with everything, and the path of its image's file. */
static Stage full_stage(Purse *purse, char path[600]) {
  snprintf(path, 600, "%s/test_build_memory.pfm", VELO_BINARY_DIR);
  Stage s = purse_stage(purse);
  fill(&s, path);
  return s;
}

/* Builds with each `step`th allocation failing, from the first on, until a build has enough. */
static void build_at_each(Stage *s, Purse *purse, long step, long least) {
  const size_t before = vl_context_memory(s->context, NULL);
  long n = 0;
  for (;; n += step) {
    vlWorld *world = NULL;
    vlError error;
    limit(purse, n);
    vlResult r = vl_world_build(s->scene, &s->build, &world, &error);
    purse->left = -1;
    if (r == VL_OK) {
      if (purse->refused)
        fail_msg("allocation %ld failed, and the build succeeds", n);
      vl_world_destroy(world);
      break;
    }
    if (r != VL_ERROR_MEMORY || error.code != VL_ERROR_MEMORY)
      fail_msg("allocation %ld failed: result %d, \"%s\"", n, (int)r, error.message);
    assert_null(world);
    size_t held = vl_context_memory(s->context, NULL);
    if (held != before)
      fail_msg("allocation %ld failed: %g bytes left", n, (double)held - (double)before);
    assert_true(n < 5000);
  }
  assert_true(n > least);
  assert_int_equal(vl_context_memory(s->context, NULL), before);
}

static void build_without_memory(void **state) {
  (void)state;
  char path[600];
  Purse purse = {-1, false};
  Stage s = full_stage(&purse, path);
  for (int color = 0; color < 2; color++)
    for (int sampler = 0; sampler < 2; sampler++) {
      s.build.color = (vlColorMode)color;
      s.build.light_sampler = (vlLightSampler)sampler;
      /* Embree's memory is its own */
      s.build.accelerator = sampler ? VL_ACCELERATOR_AUTO : VL_ACCELERATOR_BVH;
      /* the first build at each allocation, the others at some */
      build_at_each(&s, &purse, color || sampler ? 7 : 1, 30);
    }
  remove(path);
  stage_close(&s);
}

/* What a world shares with the one before it is allocated for, too. */
static void build_again_without_memory(void **state) {
  (void)state;
  char path[600];
  Purse purse = {-1, false};
  Stage s = full_stage(&purse, path);
  s.build.accelerator = VL_ACCELERATOR_BVH;
  vlWorld *previous = NULL;
  assert_int_equal(vl_world_build(s.scene, &s.build, &previous, NULL), VL_OK);
  s.build.previous = previous;
  build_at_each(&s, &purse, 1, 30);
  vl_world_destroy(previous);
  remove(path);
  stage_close(&s);
}

static void render_without_memory(void **state) {
  (void)state;
  char path[600];
  Purse purse = {-1, false};
  Stage s = full_stage(&purse, path);
  remove(path);
  vlWorld *world = NULL;
  /* the file is gone */
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, NULL), VL_ERROR_MISSING);
  assert_null(world);
  stage_close(&s);
  s = full_stage(&purse, path);
  assert_int_equal(vl_world_build(s.scene, &s.build, &world, NULL), VL_OK);
  remove(path);
  vlCamera camera;
  assert_int_equal(vl_camera_make(&s.camera, &camera, NULL, NULL), VL_OK);
  s.render.spp = 2;
  size_t before = vl_context_memory(s.context, NULL);
  vlDevelopDef develop = vl_default_develop_def();
  long n = 0;
  for (;; n++) {
    vlFilm *film = NULL;
    vlImage *image = NULL;
    vlError error;
    limit(&purse, n);
    vlResult r = vl_film_create(s.context, &s.film, &film);
    if (r == VL_OK)
      r = vl_render(world, &camera, film, &s.render, NULL, &error);
    if (r == VL_OK)
      r = vl_film_develop(film, &develop, &image);
    purse.left = -1;
    vl_image_destroy(image);
    vl_film_destroy(film);
    size_t held = vl_context_memory(s.context, NULL);
    assert_int_equal(held, before);
    if (r == VL_OK && purse.refused)
      fail_msg("allocation %ld failed, and the render succeeds", n);
    if (r == VL_OK)
      break;
    assert_int_equal(r, VL_ERROR_MEMORY);
    assert_true(n < 1000);
  }
  assert_true(n > 3);
  vl_world_destroy(world);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(build_without_memory),
                                     cmocka_unit_test(build_again_without_memory),
                                     cmocka_unit_test(render_without_memory)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
