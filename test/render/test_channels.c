/* test/render/test_channels.c: ground truth: the channels agree with each other and with the
 * camera, ids are those of a ray cast by the test, planes have the exact depth, and the bits do
 * not depend on threads, instruction set or crop. */
#include "render/ground_truths.h"
#include "velo/channels.h"
#include "velo/shape_kinds.h"
#include "velo/texture.h"

/* Builds the world of the stage and computes all channels. */
static GroundTruth ground_truth_take(Stage *s, const uint32_t crop[4], uint32_t channels) {
  GroundTruth t = ground_truth_begin(s);
  vlChannelsDef def = vl_default_channels_def(s->camera.width, s->camera.height);
  if (crop)
    memcpy(def.crop, crop, sizeof def.crop);
  def.channels = channels;
  def.samples = 7;
  ground_truth_channels(&t, &def);
  return t;
}

static void vector(const GroundTruth *t, uint32_t x, uint32_t y, const char *name,
                   double v[3]) {
  char part[16];
  for (int k = 0; k < 3; k++) {
    snprintf(part, sizeof part, "%s.%c", name, 'X' + k);
    v[k] = number(t, x, y, part);
  }
}

/* A floor, a sphere, a mirrored and rotated instance of a mesh and a patch, a cylinder. The
 * camera looks from the side and has an unusual principal point, skew, roll and a lens. */
static void fill(Stage *s) {
  Quad floor = quad_at(0, -1, -6, 2.5f, 0, 0, 0, 0, -2.5f);
  floor.material = add_diffuse(s, 0.5f, 0.5f, 0.5f);
  add_quad(s, &floor);
  vlShapeDef sphere = vl_default_shape_def(VL_SHAPE_SPHERE);
  set_matrix(sphere.group_from_shape, 1, 0, 0, -1.2, 0, 1, 0, 0.1, 0, 0, 1, -5);
  sphere.material = add_diffuse(s, 0.8f, 0.3f, 0.1f);
  vl_scene_add_shape(s->scene, &sphere);
  vlGroupId group = vl_scene_add_group(s->scene, "things");
  float *block;
  vlShapeDef mesh = mesh_sphere(6, 0.7f, true, &block);
  mesh.group = group;
  vl_scene_add_shape(s->scene, &mesh);
  free(block);
  Quad patch = quad_at(0, 0.9f, 0, 0.5f, 0, 0, 0, 0.1f, 0.5f);
  patch.patch = true;
  patch.group = group;
  add_quad(s, &patch);
  for (int i = 0; i < 2; i++) {
    double m[16];
    set_matrix(m, -0.8, 0.3, 0, 1.3 + i, -0.3, -0.8, 0.1, 0.2, 0, 0.1, 0.9, -5.5 - i);
    vl_scene_add_instance(s->scene, group, m, (vlSource){0});
  }
  vlShapeDef cylinder = vl_default_shape_def(VL_SHAPE_CYLINDER);
  set_matrix(cylinder.group_from_shape, 0.3, 0, 0, 0, 0, 0.1, 1, 0, 0, -1, 0, -4);
  vl_scene_add_shape(s->scene, &cylinder);
  s->camera.eye[0] = 1.1;
  s->camera.eye[1] = 1.7;
  s->camera.eye[2] = 0.3;
  s->camera.lookat[0] = 0.2;
  s->camera.lookat[1] = -0.3;
  s->camera.lookat[2] = -5;
  s->camera.roll = 0.1;
  s->camera.fx = 70;
  s->camera.fy = 66;
  s->camera.skew = 1.5;
  s->camera.cx = 37.25;
  s->camera.cy = 20.75;
  s->camera.lens_radius = 0.3;
  s->camera.focus_distance = 3;
}

static double length3(const double v[3]) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void consistent(GroundTruth *t) {
  uint32_t hits = 0, misses = 0;
  for (uint32_t y = 0; y < vl_image_height(t->floats); y++)
    for (uint32_t x = 0; x < vl_image_width(t->floats); x++) {
      double o[3], d[3], p[3], ray[3], n[3], pixel[2], z;
      assert_true(vl_camera_unproject(&t->camera, x + 0.5, y + 0.5, o, d));
      vector(t, x, y, "ray", ray);
      for (int k = 0; k < 3; k++)
        assert_near("ray", ray[k], d[k], 1e-7);
      vector(t, x, y, "P", p);
      vector(t, x, y, "N", n);
      assert_int_equal(id(t, x, y, "samples"), 7);
      if (!id(t, x, y, "id.object")) {
        misses++;
        assert_true(isinf(number(t, x, y, "Z")) && isinf(number(t, x, y, "distance.Y")));
        assert_true(length3(p) == 0 && length3(n) == 0);
        assert_int_equal(id(t, x, y, "id.material") + id(t, x, y, "id.primitive") +
                             id(t, x, y, "id.instance"),
                         0);
        continue;
      }
      hits++;
      double size = fmax(length3(p), length3(o));
      for (int k = 0; k < 3; k++)
        assert_near("P = o + t d", p[k], o[k] + (double)number(t, x, y, "distance.Y") * ray[k],
                    2e-7 * size);
      assert_true(vl_camera_project(&t->camera, p, pixel, &z));
      assert_near("Z", number(t, x, y, "Z"), z, 2e-7 * size);
      assert_near("pixel x", pixel[0], x + 0.5, 1e-6 * t->camera.width);
      assert_near("pixel y", pixel[1], y + 0.5, 1e-6 * t->camera.height);
      assert_near("|N|", length3(n), 1, 1e-6);
      vector(t, x, y, "Ng", n);
      assert_near("|Ng|", length3(n), 1, 1e-6);
    }
  if (hits < 500 || misses < 100)
    fail_msg("%u pixels with a surface, %u without", hits, misses);
}

static void test_consistent(void **state) {
  (void)state;
  for (int orthographic = 0; orthographic < 2; orthographic++) {
    Stage s = stage_open(75, 41);
    fill(&s);
    if (orthographic) {
      s.camera.projection = VL_PROJECTION_ORTHOGRAPHIC;
      s.camera.fx = s.camera.fy = 14;
    }
    GroundTruth t = ground_truth_take(&s, NULL, VL_CHANNEL_ALL);
    consistent(&t);
    ground_truth_free(&t);
    stage_close(&s);
  }
}

/* The distance is that to the exact surface of an analytic sphere and plane, to the last bit of
 * a float. */
static void test_exact_distance_and_ids(void **state) {
  (void)state;
  Stage s = stage_open(64, 64);
  Quad wall = quad_at(0, 0, -9, 20, 0, 0, 0, 20, 0);
  wall.material = add_diffuse(&s, 0.2f, 0.2f, 0.2f);
  add_quad(&s, &wall);
  vlShapeDef sphere = vl_default_shape_def(VL_SHAPE_SPHERE);
  sphere.radius = 1.5f;
  sphere.z_min = -1.5f;
  sphere.z_max = 1.5f;
  set_matrix(sphere.group_from_shape, 1, 0, 0, 0.25, 0, 1, 0, -0.5, 0, 0, 1, -5);
  vl_scene_add_shape(s.scene, &sphere);
  GroundTruth t = ground_truth_take(&s, NULL, VL_CHANNEL_ALL);
  uint32_t on_sphere = 0;
  for (uint32_t y = 0; y < 64; y++)
    for (uint32_t x = 0; x < 64; x++) {
      double o[3], d[3];
      vl_camera_unproject(&t.camera, x + 0.5, y + 0.5, o, d);
      double b = d[0] * 0.25 + d[1] * -0.5 + d[2] * -5, c = 0.0625 + 0.25 + 25 - 2.25,
             root = b * b - c;
      if (fabs(root) < 1e-3)
        continue; /* at grazing angles both results are correct */
      bool sphere_met = root > 0;
      on_sphere += sphere_met;
      assert_int_equal(id(&t, x, y, "id.object"), sphere_met ? 2 : 1);
      /* the sphere has the default material */
      assert_int_equal(id(&t, x, y, "id.material"), sphere_met ? 1 : 2);
      double expected = sphere_met ? b - sqrt(root) : -9 / d[2];
      assert_near("distance", number(&t, x, y, "distance.Y"), expected,
                  1e-7 * expected + (sphere_met ? 2e-6 : 0));
      if (sphere_met)
        continue;
      assert_true(number(&t, x, y, "Z") == 9.0f);
      assert_in_range(id(&t, x, y, "id.primitive"), 1, 2);
    }
  assert_true(on_sphere > 200);
  vlIdInfo info;
  assert_int_equal(vl_world_id_count(t.world, VL_ID_OBJECT), 2);
  assert_int_equal(vl_world_id_info(t.world, VL_ID_OBJECT, 2, &info), VL_OK);
  assert_string_equal(info.type, "sphere");
  assert_int_equal(info.material, 1);
  assert_int_equal(vl_world_id_info(t.world, VL_ID_OBJECT, 3, &info), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_world_id_info(t.world, VL_ID_OBJECT, 0, &info), VL_ERROR_ARGUMENT);
  ground_truth_free(&t);
  stage_close(&s);
}

/* So is the distance to the far side of a sphere whose near half is a hole: it is rounded once.
 */
static void test_exact_distance_through_hole(void **state) {
  (void)state;
  Stage s = stage_open(64, 64);
  vlImage *image = NULL;
  vlImageDef size = vl_default_image_def(1, 2, 1);
  assert_int_equal(vl_image_create(s.context, &size, &image), VL_OK);
  float *pixels = vl_image_pixels(image);
  pixels[0] = 0; /* the top: v above a half, towards +z */
  pixels[1] = 1;
  vlTextureDef halves = vl_default_texture_def(VL_TEXTURE_IMAGE, false);
  halves.image = image;
  halves.filter = VL_FILTER_POINT;
  vlShapeDef sphere = vl_default_shape_def(VL_SHAPE_SPHERE);
  sphere.radius = 1;
  sphere.z_min = -1;
  sphere.z_max = 1;
  sphere.alpha.texture = vl_scene_add_texture(s.scene, &halves);
  vl_image_destroy(image);
  set_matrix(sphere.group_from_shape, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -4);
  vl_scene_add_shape(s.scene, &sphere);
  GroundTruth t = ground_truth_take(&s, NULL, VL_CHANNEL_ALL);
  uint32_t compared = 0;
  for (uint32_t y = 0; y < 64; y++)
    for (uint32_t x = 0; x < 64; x++) {
      double o[3], d[3];
      vl_camera_unproject(&t.camera, x + 0.5, y + 0.5, o, d);
      double b = -4 * d[2], root = b * b - 15, far = b + sqrt(fmax(root, 0));
      if (root < 1e-3 || far * d[2] + 4 > -0.05)
        continue; /* it passes, or leaves through the hole */
      compared++;
      assert_near("distance", number(&t, x, y, "distance.Y"), far, 0x1.01p-24 * far);
    }
  assert_true(compared > 100);
  ground_truth_free(&t);
  stage_close(&s);
}

/* A plane parallel to the view plane has one depth for every position of the camera, even if
 * its triangles are instances. */
static void test_plane_has_one_depth(void **state) {
  (void)state;
  Stage s = stage_open(80, 60);
  vlGroupId group = vl_scene_add_group(s.scene, "wall");
  Quad wall = quad_at(0, 0, -7.3f, 50, 0, 0, 0, 50, 0);
  wall.group = group;
  add_quad(&s, &wall);
  double m[16];
  set_matrix(m, 1, 0, 0, 3.7, 0, 1, 0, -2.1, 0, 0, 1, 0.6);
  vl_scene_add_instance(s.scene, group, m, (vlSource){"wall.pbrt", 12, 3});
  s.camera.eye[0] = s.camera.lookat[0] = 1.234;
  s.camera.eye[1] = s.camera.lookat[1] = -0.77;
  GroundTruth t = ground_truth_take(&s, NULL, VL_CHANNEL_Z | VL_CHANNEL_ID_INSTANCE);
  assert_int_equal(vl_image_channels(t.floats), 1);
  assert_int_equal(vl_image_channels(t.ids), 1);
  float first = number(&t, 0, 0, "Z");
  assert_near("depth", first, 7.3 - 0.6, 1e-6);
  for (uint32_t y = 0; y < 60; y++)
    for (uint32_t x = 0; x < 80; x++) {
      assert_true(number(&t, x, y, "Z") == first);
      assert_int_equal(id(&t, x, y, "id.instance"), 1);
    }
  vlIdInfo info;
  assert_int_equal(vl_world_id_info(t.world, VL_ID_INSTANCE, 1, &info), VL_OK);
  assert_string_equal(info.source.file, "wall.pbrt");
  assert_int_equal(info.source.line, 12);
  ground_truth_free(&t);
  stage_close(&s);
}

static void test_planes_cut(void **state) {
  (void)state;
  Stage s = stage_open(16, 16);
  Quad near_wall = quad_at(0, 0, -2, 9, 0, 0, 0, 9, 0),
       far_wall = quad_at(0, 0, -4, 9, 0, 0, 0, 9, 0);
  add_quad(&s, &near_wall);
  add_quad(&s, &far_wall);
  s.camera.near_plane = 3;
  GroundTruth t = ground_truth_take(&s, NULL, VL_CHANNEL_ALL);
  assert_int_equal(id(&t, 3, 3, "id.object"), 2);
  assert_true(number(&t, 3, 3, "Z") == 4.0f);
  ground_truth_free(&t);
  s.camera.far_plane = 3.5;
  t = ground_truth_take(&s, NULL, VL_CHANNEL_ALL);
  assert_int_equal(id(&t, 3, 3, "id.object"), 0);
  ground_truth_free(&t);
  stage_close(&s);
}

static void test_albedo(void **state) {
  (void)state;
  static const float colours[4][3] = {
      {0.8f, 0.3f, 0.1f}, {0.5f, 0.5f, 0.5f}, {0.05f, 0.6f, 0.7f}, {0.9f, 0.85f, 0.2f}};
  for (int mode = 0; mode < 2; mode++) {
    Stage s = stage_open(64, 16);
    s.build.color = mode ? VL_COLOR_RGB : VL_COLOR_SPECTRAL;
    for (int i = 0; i < 4; i++) {
      Quad q = quad_at(-3.0f + 2.0f * (float)i, 0, -1, 1, 0, 0, 0, 5, 0);
      q.material = add_diffuse(&s, colours[i][0], colours[i][1], colours[i][2]);
      add_quad(&s, &q);
    }
    GroundTruth t = ground_truth_take(&s, NULL, VL_CHANNEL_ALL);
    for (uint32_t i = 0; i < 4; i++)
      for (int k = 0; k < 3; k++) {
        static const char *const names[3] = {"albedo.R", "albedo.G", "albedo.B"};
        assert_near(names[k], number(&t, 8 + 16 * i, 8, names[k]), colours[i][k],
                    mode ? 1e-6 : 3e-3);
      }
    ground_truth_free(&t);
    stage_close(&s);
  }
}

static void test_same_bits(void **state) {
  (void)state;
  Stage s = stage_open(75, 41);
  fill(&s);
  GroundTruth whole = ground_truth_take(&s, NULL, VL_CHANNEL_ALL);
  const uint32_t crop[4] = {13, 5, 66, 39};
  GroundTruth part = ground_truth_take(&s, crop, VL_CHANNEL_ALL);
  same_bits(whole.floats, part.floats, 13, 5);
  same_bits(whole.ids, part.ids, 13, 5);
  for (int isa = VL_ISA_BASE; isa <= VL_ISA_V4; isa++) {
    if (isa == VL_ISA_V2)
      continue; /* BASE is V2 on x86-64 */
    Stage other;
    if (!stage_like(&s, isa, &other))
      continue;
    fill(&other);
    GroundTruth t = ground_truth_take(&other, NULL, VL_CHANNEL_ALL);
    same_bits(whole.floats, t.floats, 0, 0);
    same_bits(whole.ids, t.ids, 0, 0);
    ground_truth_free(&t);
    stage_close(&other);
  }
  ground_truth_free(&part);
  ground_truth_free(&whole);
  stage_close(&s);
}

static void test_wrong_arguments(void **state) {
  (void)state;
  Stage s = stage_open(16, 8);
  GroundTruth t = ground_truth_take(&s, NULL, VL_CHANNEL_RAY);
  assert_null(t.ids);
  vlImage *floats = NULL, *ids = NULL;
  vlError error;
  vlChannelsDef def = vl_default_channels_def(16, 8);
  assert_int_equal(vl_render_channels(NULL, &t.camera, &def, &floats, &ids, &error),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, NULL, &error),
                   VL_ERROR_ARGUMENT);
  def.channels = 0;
  assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, &error),
                   VL_ERROR_ARGUMENT);
  def = vl_default_channels_def(17, 8);
  assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "17"));
  def.cookie = 0;
  assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, &error),
                   VL_ERROR_ARGUMENT);
  assert_null(vl_channel_name(VL_CHANNEL_COUNT));
  assert_string_equal(vl_channel_name(0), "Z");
  ground_truth_free(&t);
  stage_close(&s);
}

static void fill_wall(Stage *s) {
  Quad wall = quad_at(0, 0, -2, 9, 0, 0, 0, 9, 0);
  add_quad(s, &wall);
}

static vlResult take_standard(Stage *s, GroundTruth *t) {
  (void)s;
  vlChannelsDef def = vl_default_channels_def(16, 8);
  vlResult result = vl_render_channels(t->world, &t->camera, &def, &t->floats, &t->ids, NULL);
  if (result != VL_OK)
    assert_true(!t->floats && !t->ids);
  return result;
}

static void test_out_of_memory(void **state) {
  (void)state;
  ground_truth_out_of_memory(fill_wall, ground_truth_begin, take_standard);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_consistent),
      cmocka_unit_test(test_exact_distance_and_ids),
      cmocka_unit_test(test_exact_distance_through_hole),
      cmocka_unit_test(test_planes_cut),
      cmocka_unit_test(test_plane_has_one_depth),
      cmocka_unit_test(test_albedo),
      cmocka_unit_test(test_same_bits),
      cmocka_unit_test(test_wrong_arguments),
      cmocka_unit_test(test_out_of_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
