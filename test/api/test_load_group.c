/* test/api/test_load_group.c: vl_scene_load_group: a file's shapes, its instances too, become
 * one group, and nothing else of the file is taken. The reference is the same content in a
 * world of its own. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <velo/velo.h>

#include "math/transform.h"
#include "scene/scene.h"
#include "unit.h"

static const char model[] =
    "Camera \"perspective\"\n"
    "Film \"rgb\" \"integer xresolution\" 7 \"integer yresolution\" 5\n"
    "WorldBegin\n"
    "LightSource \"point\"\n"
    "AreaLightSource \"diffuse\"\n"
    "Shape \"sphere\" \"float radius\" 0.5\n"
    "ObjectBegin \"part\"\n"
    "Translate 0 1 0\n"
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]\n"
    "ReverseOrientation\n"
    "Shape \"sphere\" \"float radius\" 0.2\n"
    "ObjectEnd\n"
    "AttributeBegin\n"
    "Translate 2 0 0\n"
    "Scale -1 1 1\n"
    "ObjectInstance \"part\"\n"
    "AttributeEnd\n"
    "ObjectInstance \"part\"\n";

static vlScene *load_model(vlContext *context, const char *path, vlLoadedGroup *loaded) {
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  assert_true(fputs(model, file) >= 0);
  assert_int_equal(fclose(file), 0);
  vlScene *scene;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  vlError error = {0};
  vlResult result = vl_scene_load_group(scene, path, NULL, "thing", loaded, &error);
  if (result != VL_OK)
    print_error("%s\n", error.message);
  assert_int_equal(result, VL_OK);
  return scene;
}

/* Instances do not turn their shapes inside out: mirrored or not, the small balls look inwards,
 * as in the file. */
static void check_sides(const vlScene *scene) {
  int balls = 0;
  for (size_t i = 0; i < scene->shapes.count; i++) {
    const vlShapeDef *d = &scene->shapes.items[i];
    if (d->kind != VL_SHAPE_SPHERE || d->radius > 0.3f)
      continue;
    const bool mirrored = vl_determinant3(d->group_from_shape) < 0;
    assert_true(d->reverse_orientation != mirrored);
    balls++;
  }
  assert_int_equal(balls, 2);
}

static void test_contents(void **state) {
  (void)state;
  vlContext *context;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  char path[256];
  snprintf(path, sizeof path, "%s/model.pbrt", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  vlLoadedGroup loaded;
  vlScene *scene = load_model(context, path, &loaded);
  assert_int_equal(loaded.shapes, 5);
  assert_int_equal(loaded.lights, 1);
  assert_int_equal(loaded.emitters, 1);
  check_sides(scene);
  /* The sphere from -0.5 to 0.5; the triangle at (0, 1) and, mirrored, from x = 2 to 1, with a
   * ball of radius 0.2. */
  const double low[3] = {-0.5, -0.5, -0.5}, high[3] = {2.2, 2, 0.5};
  for (int i = 0; i < 3; i++) {
    assert_true(loaded.low[i] > low[i] - 1e-6 && loaded.low[i] < low[i] + 1e-6);
    assert_true(loaded.high[i] > high[i] - 1e-6 && loaded.high[i] < high[i] + 1e-6);
  }
  vlSceneInfo info;
  vl_scene_info(scene, &info);
  assert_int_equal(info.lights, 0);
  assert_int_equal(info.instances, 0);
  assert_int_equal(info.emissive_shapes, 0);
  assert_int_equal(vl_scene_defs(scene)->film.width, 1280);
  vl_scene_destroy(scene);
  remove(path);
  vl_context_destroy(context);
}

/* Depths and geometric normals of the group placed by an instance equal those of the file in a
 * world of its own. */
static void test_same_geometry(void **state) {
  (void)state;
  vlContext *context;
  assert_int_equal(vl_context_create(NULL, &context), VL_OK);
  char path[256];
  snprintf(path, sizeof path, "%s/model.pbrt", getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp");
  vlLoadedGroup loaded;
  vlScene *scenes[2] = {load_model(context, path, &loaded), NULL};
  const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  vl_scene_add_instance(scenes[0], loaded.group, identity, (vlSource){0});
  assert_int_equal(vl_scene_create(context, &scenes[1]), VL_OK);
  assert_int_equal(vl_scene_load(scenes[1], path, NULL, NULL), VL_OK);
  vlImage *images[2] = {NULL, NULL};
  vlCameraDef def = vl_default_camera_def(48, 36);
  def.fov = 0.8;
  def.eye[0] = 1;
  def.eye[1] = 0.8;
  def.eye[2] = 4;
  def.lookat[0] = 0.8;
  def.lookat[1] = 0.8;
  def.lookat[2] = 0;
  vlCamera camera;
  assert_int_equal(vl_camera_make(&def, &camera, NULL, NULL), VL_OK);
  for (int i = 0; i < 2; i++) {
    vlWorld *world;
    vlError error = {0};
    assert_int_equal(vl_world_build(scenes[i], NULL, &world, &error), VL_OK);
    vlChannelsDef channels = vl_default_channels_def(48, 36);
    channels.channels = VL_CHANNEL_Z | VL_CHANNEL_NG;
    assert_int_equal(vl_render_channels(world, &camera, &channels, &images[i], NULL, &error),
                     VL_OK);
    vl_world_destroy(world);
  }
  const float *a = vl_image_const_pixels(images[0]), *b = vl_image_const_pixels(images[1]);
  int hits = 0;
  for (int i = 0; i < 48 * 36 * 4; i++) {
    float difference = a[i] == b[i] ? 0 : a[i] - b[i];
    assert_true(difference > -1e-5f && difference < 1e-5f);
    hits += i % 4 == 0 && a[i] < 100;
  }
  assert_true(hits > 100);
  for (int i = 0; i < 2; i++) {
    vl_image_destroy(images[i]);
    vl_scene_destroy(scenes[i]);
  }
  remove(path);
  vl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_contents),
                                     cmocka_unit_test(test_same_geometry)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
