/* test/api/test_edit.c: a scene that is changed, and worlds that share parts: the images have
 * the bytes of a world built from nothing; worlds may be destroyed in any order; parts that
 * have not changed are not built again. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "api/small_world.h"
#include "unit.h"
#include "velo/channels.h"
#include "velo/edit.h"
#include "velo/medium.h"
#include "velo/shape_kinds.h"
#include "velo/tracer.h"

enum { SIDE = 60, PIXELS = SMALL_WIDTH * SMALL_HEIGHT };

static vlContext *make_context(void) {
  vlContextDef def = vl_default_context_def();
  def.threads = 2;
  vlContext *context = NULL;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  return context;
}

static void end(vlContext *context) {
  assert_int_equal(vl_context_memory(context, NULL), 0);
  vl_context_destroy(context);
}

/* A wavy sheet of 2 SIDE^2 triangles at height y. */
static void add_sheet(vlScene *scene, vlGroupId group, double y, vlMaterialId material,
                      vlTextureId alpha) {
  static float p[3 * (SIDE + 1) * (SIDE + 1)], uv[2 * (SIDE + 1) * (SIDE + 1)];
  static uint32_t f[6 * SIDE * SIDE];
  uint32_t *to = f;
  for (uint32_t i = 0; i <= SIDE; i++)
    for (uint32_t j = 0; j <= SIDE; j++) {
      uint32_t v = i * (SIDE + 1) + j;
      double x = (double)j / SIDE - 0.5, z = (double)i / SIDE - 0.5;
      p[3 * v] = (float)x;
      p[3 * v + 1] = (float)(y + 0.05 * sin(20 * x) * cos(17 * z));
      p[3 * v + 2] = (float)z;
      uv[2 * v] = (float)j / SIDE;
      uv[2 * v + 1] = (float)i / SIDE;
      if (i == SIDE || j == SIDE)
        continue;
      const uint32_t quad[6] = {v, v + 1, v + SIDE + 1, v + 1, v + SIDE + 2, v + SIDE + 1};
      memcpy(to, quad, sizeof quad);
      to += 6;
    }
  vlShapeDef def = vl_default_shape_def(VL_SHAPE_TRIANGLES);
  def.vertices = (SIDE + 1) * (SIDE + 1);
  def.faces = 2 * SIDE * SIDE;
  def.positions = p;
  def.uvs = uv;
  def.indices = f;
  def.group = group;
  def.material = material;
  def.alpha.texture = alpha;
  assert_true(vl_scene_add_shape(scene, &def).index > 0);
}

typedef struct Things {
  vlScene *scene;
  vlMaterialId paint;
  vlTextureId image, mask;
  vlLightId sky;
  vlShapeId first;
  vlInstanceId instances[3];
} Things;

static vlImage *pattern(vlContext *context, int seed) {
  vlImageDef def = vl_default_image_def(16, 16, 3);
  vlImage *image = NULL;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  for (int i = 0; i < 16 * 16 * 3; i++)
    ((float *)vl_image_pixels(image))[i] = (float)((i * 37 + seed * 11) % 101) / 101;
  return image;
}

/* The small world, a sheet outside of groups, a sheet with holes and a sphere in a group with
 * three instances, a coated material, an image, an environment image. */
static Things make_scene(vlContext *context) {
  Things t = {0};
  assert_int_equal(vl_scene_create(context, &t.scene), VL_OK);
  small_scene(t.scene);
  vlImage *image = pattern(context, 0);
  vlTextureDef texture = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  texture.image = image;
  t.image = vl_scene_add_texture(t.scene, &texture);
  vlTextureDef mask = vl_default_texture_def(VL_TEXTURE_CHECKERBOARD, false);
  mask.su = mask.sv = 9;
  mask.float_a = vl_float_input(1);
  mask.float_b = vl_float_input(0.4f);
  t.mask = vl_scene_add_texture(t.scene, &mask);
  vlMaterialDef paint = vl_default_material_def(VL_MATERIAL_COATED_DIFFUSE);
  paint.reflectance.texture = t.image;
  t.paint = vl_scene_add_material(t.scene, &paint);
  add_sheet(t.scene, (vlGroupId){0}, 1.2, t.paint, (vlTextureId){0});
  vlGroupId group = vl_scene_add_group(t.scene, "kites");
  add_sheet(t.scene, group, 0, t.paint, t.mask);
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  ball.radius = 0.1f;
  ball.z_min = -0.1f;
  ball.z_max = 0.1f;
  ball.group = group;
  t.first = vl_scene_add_shape(t.scene, &ball);
  for (int i = 0; i < 3; i++) {
    double place[16];
    small_place(place, i - 1.0, 1.6 + 0.1 * i, 0.5);
    t.instances[i] = vl_scene_add_instance(t.scene, group, place, (vlSource){0});
    assert_true(t.instances[i].index > 0);
  }
  vlLightDef sky = vl_default_light_def(VL_LIGHT_INFINITE);
  sky.image = image;
  t.sky = vl_scene_add_light(t.scene, &sky);
  assert_true(t.sky.index > 0);
  assert_int_equal(vl_scene_result(t.scene, NULL), VL_OK);
  vl_image_destroy(image);
  return t;
}

static vlTracer tracer = VL_TRACER_PATH;

static void shoot(vlContext *context, const vlWorld *world, float *pixels) {
  vlCamera camera;
  vlFilm *film = NULL;
  vlImage *image = NULL, *ids = NULL;
  vlFilmDef film_def = vl_default_film_def(SMALL_WIDTH, SMALL_HEIGHT);
  vlRenderDef render = vl_default_render_def();
  render.spp = 2;
  render.tracer = tracer;
  assert_int_equal(small_camera(&camera), VL_OK);
  assert_int_equal(vl_film_create(context, &film_def, &film), VL_OK);
  assert_int_equal(vl_render(world, &camera, film, &render, NULL, NULL), VL_OK);
  assert_int_equal(vl_film_develop(film, NULL, &image), VL_OK);
  memcpy(pixels, vl_image_const_pixels(image), (size_t)PIXELS * 4 * sizeof(float));
  vl_image_destroy(image);
  vlChannelsDef channels = vl_default_channels_def(SMALL_WIDTH, SMALL_HEIGHT);
  channels.channels =
      VL_CHANNEL_Z | VL_CHANNEL_ID_OBJECT | VL_CHANNEL_ID_INSTANCE | VL_CHANNEL_ID_MATERIAL;
  assert_int_equal(vl_render_channels(world, &camera, &channels, &image, &ids, NULL), VL_OK);
  memcpy(pixels + 4 * PIXELS, vl_image_const_pixels(image), (size_t)PIXELS * sizeof(float));
  memcpy(pixels + 5 * PIXELS, vl_image_const_pixels(ids), (size_t)PIXELS * 3 * sizeof(float));
  vl_image_destroy(image);
  vl_image_destroy(ids);
  vl_film_destroy(film);
}

static vlBits bits; /* of the worlds */

/* Builds with and without the previous world, and compares the bytes. Returns the shared
 * world. */
static vlWorld *compare(vlContext *context, const vlScene *scene, const vlWorld *previous,
                        float *image) {
  static float fresh_image[8 * PIXELS];
  vlWorld *shared = NULL, *fresh = NULL;
  vlError error;
  vlBuildDef def = vl_default_build_def();
  def.bits = bits;
  assert_int_equal(vl_world_build(scene, &def, &fresh, &error), VL_OK);
  def.previous = previous;
  assert_int_equal(vl_world_build(scene, &def, &shared, &error), VL_OK);
  shoot(context, fresh, fresh_image);
  shoot(context, shared, image);
  assert_memory_equal(image, fresh_image, sizeof fresh_image);
  vlWorldInfo a, b;
  vl_world_info(fresh, &a);
  vl_world_info(shared, &b);
  assert_int_equal(a.triangles, b.triangles);
  assert_int_equal(a.lights, b.lights);
  assert_int_equal(a.instances, b.instances);
  assert_memory_equal(a.bounds_min, b.bounds_min, sizeof a.bounds_min);
  assert_memory_equal(a.bounds_max, b.bounds_max, sizeof a.bounds_max);
  vl_world_destroy(fresh);
  return shared;
}

enum { EDITS = 14 };

/* Makes change number k. */
static void edit(vlContext *context, Things *t, int k) {
  vlError error;
  vlScene *s = t->scene;
  double place[16];
  small_place(place, 0.3, 1.1, 1.0 + 0.01 * k);
  switch (k) {
    case 0:
    case 1:
      assert_int_equal(vl_scene_set_instance(s, t->instances[k], place, &error), VL_OK);
      break;
    case 2: {
      vlMaterialDef def = *vl_scene_material(s, t->paint);
      def.u_roughness = def.v_roughness = vl_float_input(0.3f);
      assert_int_equal(vl_scene_set_material(s, t->paint, &def, &error), VL_OK);
      break;
    }
    case 3:
    case 4: {
      vlImage *image = pattern(context, k);
      vlTextureDef def = *vl_scene_texture(s, t->image);
      def.image = image;
      assert_int_equal(vl_scene_set_texture(s, t->image, &def, &error), VL_OK);
      vl_image_destroy(image);
      break;
    }
    case 5:
      assert_int_equal(vl_scene_show_instance(s, t->instances[1], false, &error), VL_OK);
      break;
    case 6:
      assert_int_equal(vl_scene_show_shape(s, t->first, false, &error), VL_OK);
      break;
    case 7:
      assert_int_equal(vl_scene_show_instance(s, t->instances[1], true, &error), VL_OK);
      break;
    case 8:
      assert_int_equal(vl_scene_remove_instance(s, t->instances[0], &error), VL_OK);
      break;
    case 9: {
      vlLightDef def = *vl_scene_light(s, t->sky);
      def.scale = 3;
      assert_int_equal(vl_scene_set_light(s, t->sky, &def, &error), VL_OK);
      break;
    }
    case 10: {
      vlTextureDef def = *vl_scene_texture(s, t->mask);
      def.su = 4;
      assert_int_equal(vl_scene_set_texture(s, t->mask, &def, &error), VL_OK);
      break;
    }
    case 11:
      assert_int_equal(vl_scene_show_light(s, t->sky, false, &error), VL_OK);
      break;
    case 12: {
      /* shadow rays pass: other filters */
      vlMaterialDef def = vl_default_material_def(VL_MATERIAL_INTERFACE);
      assert_int_equal(vl_scene_set_material(s, t->paint, &def, &error), VL_OK);
      break;
    }
    default:
      add_sheet(s, (vlGroupId){0}, 0.4, (vlMaterialId){1}, (vlTextureId){0});
      break;
  }
}

static void edited_worlds_equal_fresh_ones(void **state) {
  (void)state;
  static float now[8 * PIXELS], before[8 * PIXELS], again[8 * PIXELS];
  vlContext *context = make_context();
  Things t = make_scene(context);
  vlWorld *world = compare(context, t.scene, NULL, before);
  for (int k = 0; k < EDITS; k++) {
    edit(context, &t, k);
    vlWorld *next = compare(context, t.scene, world, now);
    assert_memory_not_equal(now, before, sizeof now); /* the change can be seen */
    shoot(context, world, again);
    assert_memory_equal(again, before, sizeof again); /* the previous world has not changed */
    vl_world_destroy(world);
    shoot(context, next, again);
    assert_memory_equal(again, now, sizeof again);
    memcpy(before, now, sizeof now);
    world = next;
  }
  vl_scene_destroy(t.scene);
  vl_world_destroy(world);
  end(context);
}

static void the_same_with_fast_bits(void **state) {
  bits = VL_BITS_FAST;
  edited_worlds_equal_fresh_ones(state);
  bits = VL_BITS_PORTABLE;
}

/* The new world is destroyed first; then a chain whose middle goes first. */
static void any_order(void **state) {
  (void)state;
  static float a[8 * PIXELS], b[8 * PIXELS];
  vlContext *context = make_context();
  Things t = make_scene(context);
  vlWorld *one = compare(context, t.scene, NULL, a);
  edit(context, &t, 0);
  vlWorld *two = compare(context, t.scene, one, b);
  vl_world_destroy(two);
  shoot(context, one, b);
  assert_memory_equal(a, b, sizeof a);
  two = compare(context, t.scene, one, b);
  edit(context, &t, 2);
  vlWorld *three = compare(context, t.scene, two, a);
  vl_world_destroy(two);
  vl_world_destroy(one);
  shoot(context, three, b);
  assert_memory_equal(a, b, sizeof a);
  vl_world_destroy(three);
  vl_scene_destroy(t.scene);
  end(context);
}

/* A scene that was made again shares what is the same; one more shape shifts the numbers of the
 * others. */
static void a_scene_made_again(void **state) {
  (void)state;
  static float image[8 * PIXELS];
  vlContext *context = make_context();
  Things t = make_scene(context);
  vlWorld *one = compare(context, t.scene, NULL, image);
  vl_scene_destroy(t.scene);
  t = make_scene(context);
  size_t before = vl_context_memory(context, NULL);
  vlBuildDef def = vl_default_build_def();
  vlWorld *two = NULL, *alone = NULL;
  def.previous = one;
  assert_int_equal(vl_world_build(t.scene, &def, &two, NULL), VL_OK);
  size_t shared = vl_context_memory(context, NULL) - before;
  def.previous = NULL;
  assert_int_equal(vl_world_build(t.scene, &def, &alone, NULL), VL_OK);
  size_t whole = vl_context_memory(context, NULL) - before - shared;
  assert_true(shared < whole / 2); /* the sheets are not there twice */
  vl_world_destroy(alone);
  vl_world_destroy(two);
  vl_scene_destroy(t.scene);
  assert_int_equal(vl_scene_create(context, &t.scene), VL_OK);
  add_sheet(t.scene, (vlGroupId){0}, 0.7, (vlMaterialId){0}, (vlTextureId){0});
  small_scene(t.scene);
  add_sheet(t.scene, (vlGroupId){0}, 1.2, (vlMaterialId){1}, (vlTextureId){0});
  vl_world_destroy(compare(context, t.scene, one, image));
  vl_scene_destroy(t.scene);
  vl_world_destroy(one);
  end(context);
}

/* An image file that changes on disk is read again. */
static void an_image_file_changes(void **state) {
  (void)state;
  static float a[8 * PIXELS], b[8 * PIXELS];
  vlContext *context = make_context();
  Things t = make_scene(context);
  char path[512];
  snprintf(path, sizeof path, "%s/velo_edit_%ld.exr",
           getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp", (long)getpid());
  vlImage *image = pattern(context, 5);
  assert_int_equal(vl_image_write(image, path, NULL, NULL), VL_OK);
  vl_image_destroy(image);
  vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  def.path = path;
  assert_int_equal(vl_scene_set_texture(t.scene, t.image, &def, NULL), VL_OK);
  vlWorld *one = compare(context, t.scene, NULL, a), *two = compare(context, t.scene, one, b);
  assert_memory_equal(a, b, sizeof a);
  vl_world_destroy(two);
  image = pattern(context, 6);
  assert_int_equal(vl_image_write(image, path, NULL, NULL), VL_OK);
  vl_image_destroy(image);
  two = compare(context, t.scene, one, b);
  assert_memory_not_equal(a, b, sizeof a);
  vl_world_destroy(two);
  vl_world_destroy(one);
  vl_scene_destroy(t.scene);
  unlink(path);
  end(context);
}

/* A wrong change is refused and leaves the scene as it was. */
/* A ball of fog. Its medium changes its numbers, then its kind; then nothing changes, and it is
 * shared. */
static void media_change(void **state) {
  (void)state;
  static float a[8 * PIXELS], b[8 * PIXELS];
  vlContext *context = make_context();
  Things t = make_scene(context);
  vlError error;
  vlMediumDef fog = vl_default_medium_def(VL_MEDIUM_HOMOGENEOUS);
  fog.sigma_s = vl_spectrum_constant(2);
  fog.sigma_a = vl_spectrum_constant(0.5f);
  vlMediumId id = vl_scene_add_medium(t.scene, &fog);
  vlMaterialDef surface = vl_default_material_def(VL_MATERIAL_INTERFACE);
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  ball.radius = 1;
  ball.z_min = -1;
  ball.z_max = 1;
  ball.material = vl_scene_add_material(t.scene, &surface);
  ball.inside = id;
  assert_true(vl_scene_add_shape(t.scene, &ball).index > 0);
  tracer = VL_TRACER_VOLPATH;
  vlWorld *one = compare(context, t.scene, NULL, a);
  fog = *vl_scene_medium(t.scene, id);
  fog.sigma_s = vl_spectrum_constant(6);
  assert_int_equal(vl_scene_set_medium(t.scene, id, &fog, &error), VL_OK);
  vlWorld *two = compare(context, t.scene, one, b);
  assert_memory_not_equal(a, b, sizeof a);
  const float density[8] = {1, 4, 0, 2, 3, 1, 5, 0};
  fog = vl_default_medium_def(VL_MEDIUM_GRID);
  fog.nx = fog.ny = fog.nz = 2;
  fog.density = density;
  assert_int_equal(vl_scene_set_medium(t.scene, id, &fog, &error), VL_OK);
  vlWorld *three = compare(context, t.scene, two, a);
  assert_memory_not_equal(a, b, sizeof a);
  fog.density = NULL;
  assert_int_equal(vl_scene_set_medium(t.scene, id, &fog, &error), VL_ERROR_SCENE);
  assert_int_equal(vl_scene_set_medium(t.scene, (vlMediumId){9}, &fog, &error),
                   VL_ERROR_ARGUMENT);
  vlWorld *four = compare(context, t.scene, three, b);
  assert_memory_equal(a, b, sizeof a);
  tracer = VL_TRACER_PATH;
  vl_world_destroy(two);
  vl_world_destroy(one);
  vl_world_destroy(three);
  vl_world_destroy(four);
  vl_scene_destroy(t.scene);
  end(context);
}

static void wrong_edits(void **state) {
  (void)state;
  static float a[8 * PIXELS], b[8 * PIXELS];
  vlContext *context = make_context();
  Things t = make_scene(context);
  vlWorld *world = compare(context, t.scene, NULL, a);
  vlError error;
  vlMaterialDef material = *vl_scene_material(t.scene, t.paint);
  material.materials[0] = material.materials[1] = t.paint;
  material.kind = VL_MATERIAL_MIX;
  /* of itself */
  assert_int_equal(vl_scene_set_material(t.scene, t.paint, &material, &error), VL_ERROR_SCENE);
  material = *vl_scene_material(t.scene, t.paint);
  material.cookie = 0;
  assert_int_equal(vl_scene_set_material(t.scene, t.paint, &material, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_scene_set_material(t.scene, (vlMaterialId){99}, &material, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_scene_set_material(t.scene, (vlMaterialId){0}, &material, &error),
                   VL_ERROR_ARGUMENT);
  vlTextureDef texture = *vl_scene_texture(t.scene, t.mask);
  texture.spectrum = true;
  assert_int_equal(vl_scene_set_texture(t.scene, t.mask, &texture, &error), VL_ERROR_ARGUMENT);
  vlLightDef light = *vl_scene_light(t.scene, t.sky);
  light.scale = NAN;
  assert_int_not_equal(vl_scene_set_light(t.scene, t.sky, &light, &error), VL_OK);
  double place[16];
  small_place(place, NAN, 0, 0);
  assert_int_equal(vl_scene_set_instance(t.scene, t.instances[0], place, &error),
                   VL_ERROR_SCENE);
  assert_int_equal(vl_scene_show_instance(t.scene, (vlInstanceId){1000}, false, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_scene_set_shape_material(t.scene, t.first, (vlMaterialId){99}, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_scene_result(t.scene, NULL), VL_OK);
  vlWorld *same = compare(context, t.scene, world, b);
  assert_memory_equal(a, b, sizeof a);
  vlInstanceInfo info;
  assert_int_equal(vl_scene_remove_instance(t.scene, t.instances[0], &error), VL_OK);
  assert_int_equal(vl_scene_instance(t.scene, t.instances[0], &info), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_scene_remove_instance(t.scene, t.instances[0], &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_scene_instance(t.scene, t.instances[1], &info), VL_OK);
  assert_true(info.shown && !info.moves && info.keys == 0 && !info.times && !info.poses);
  double poses[32];
  small_place(poses, 1, 2, 3);
  small_place(poses + 16, 4, 5, 6);
  vlInstanceId moving = vl_scene_add_moving_instance(
      t.scene, info.group, 2, (const double[2]){0.25, 0.5}, poses, (vlSource){0});
  assert_int_equal(vl_scene_instance(t.scene, moving, &info), VL_OK);
  assert_true(info.moves && info.keys == 2 && info.times[0] == 0.25 && info.times[1] == 0.5);
  assert_memory_equal(info.poses, poses, sizeof poses);
  assert_memory_equal(info.world_from_group, poses, sizeof info.world_from_group);
  vl_world_destroy(world);
  vl_world_destroy(same);
  vl_scene_destroy(t.scene);
  end(context);
}

/* An object that is set again keeps its image in memory, also when another object has got
 * it. */
static void images_are_kept(void **state) {
  (void)state;
  static float image[8 * PIXELS];
  vlContext *context = make_context();
  Things t = make_scene(context);
  vlImage *other = pattern(context, 9);
  vlTextureDef texture = *vl_scene_texture(t.scene, t.image);
  texture.image = other;
  assert_int_equal(vl_scene_set_texture(t.scene, t.image, &texture, NULL), VL_OK);
  vlLightDef light = *vl_scene_light(t.scene, t.sky);
  light.image = vl_scene_texture(t.scene, t.image)->image;
  assert_int_equal(vl_scene_set_light(t.scene, t.sky, &light, NULL), VL_OK);
  assert_int_equal(vl_scene_set_texture(t.scene, t.image, &texture, NULL), VL_OK);
  size_t before = vl_context_memory(context, NULL);
  light = *vl_scene_light(t.scene, t.sky);
  light.scale = 2;
  assert_int_equal(vl_scene_set_light(t.scene, t.sky, &light, NULL), VL_OK);
  assert_int_equal(vl_context_memory(context, NULL), before); /* no copy of the image */
  vl_world_destroy(compare(context, t.scene, NULL, image));
  vl_image_destroy(other);
  vl_scene_destroy(t.scene);
  end(context);
}

/* Changing an object a thousand times keeps the memory of one change. */
static void edits_keep_no_memory(void **state) {
  (void)state;
  vlContext *context = make_context();
  Things t = make_scene(context);
  size_t after_first = 0;
  for (int k = 0; k < 1000; k++) {
    vlImage *image = pattern(context, k);
    vlTextureDef def = *vl_scene_texture(t.scene, t.image);
    def.image = image;
    assert_int_equal(vl_scene_set_texture(t.scene, t.image, &def, NULL), VL_OK);
    vl_image_destroy(image);
    if (k == 10)
      after_first = vl_context_memory(context, NULL);
  }
  assert_true(vl_context_memory(context, NULL) <= after_first + 4096);
  vl_scene_destroy(t.scene);
  end(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(edited_worlds_equal_fresh_ones),
      cmocka_unit_test(the_same_with_fast_bits),
      cmocka_unit_test(any_order),
      cmocka_unit_test(a_scene_made_again),
      cmocka_unit_test(an_image_file_changes),
      cmocka_unit_test(media_change),
      cmocka_unit_test(wrong_edits),
      cmocka_unit_test(images_are_kept),
      cmocka_unit_test(edits_keep_no_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
