/* test/render/test_mattes.c: Cryptomatte, the modes that choose among a pixel's samples,
 * standard errors: they agree with the image, with each other and with simple scenes of known
 * result, and their bits depend on nothing else. */
#include "render/ground_truths.h"
#include "velo/boxes.h"
#include "velo/filter_kinds.h"
#include "velo/sampler.h"
#include "velo/shape_kinds.h"

static const uint32_t MATTES =
    VL_CHANNEL_CRYPTO_OBJECT | VL_CHANNEL_CRYPTO_MATERIAL | VL_CHANNEL_CRYPTO_INSTANCE;

static GroundTruth ground_truth_take(Stage *s, uint32_t channels, vlChannelMode mode) {
  GroundTruth t = ground_truth_begin(s);
  vlError error = {0};
  s->film.errors = (channels & VL_CHANNEL_ERROR) != 0;
  assert_int_equal(vl_film_create(s->context, &s->film, &t.film), VL_OK);
  if (vl_render(t.world, &t.camera, t.film, &s->render, NULL, &error) != VL_OK)
    fail_msg("render: %s", error.message);
  assert_int_equal(vl_film_develop(t.film, NULL, &t.image), VL_OK);
  vlChannelsDef def = vl_default_channels_def(s->camera.width, s->camera.height);
  memcpy(def.crop, s->film.crop, sizeof def.crop);
  def.channels = channels;
  def.mode = mode;
  def.film = t.film;
  def.render = &s->render;
  ground_truth_channels(&t, &def);
  return t;
}

/* Two half planes at different depths whose border leans across the pixels, an instanced ball,
 * a lens. */
static void fill(Stage *s) {
  Quad left = quad_at(-5, 0, -6, 5, 0.4f, 0, -0.3f, 8, 0),
       right = quad_at(5, 1, -8, 5, 0, 0, 0, 3, 0);
  left.material = add_diffuse(s, 0.8f, 0.2f, 0.2f);
  right.material = add_diffuse(s, 0.2f, 0.8f, 0.2f);
  add_quad(s, &left);
  add_quad(s, &right);
  vlGroupId group = vl_scene_add_group(s->scene, "ball");
  vlShapeDef ball = vl_default_shape_def(VL_SHAPE_SPHERE);
  ball.radius = 0.7f;
  ball.z_min = -0.7f;
  ball.z_max = 0.7f;
  ball.group = group;
  vl_scene_add_shape(s->scene, &ball);
  for (int i = 0; i < 2; i++) {
    double m[16];
    set_matrix(m, 1, 0, 0, -1 + 2 * i, 0, 1, 0, -0.5, 0, 0, 1, -4);
    vl_scene_add_instance(s->scene, group, m, (vlSource){0});
  }
  vlLightDef light = vl_default_light_def(VL_LIGHT_INFINITE);
  vl_scene_add_light(s->scene, &light);
  s->camera.lens_radius = 0.1;
  s->camera.focus_distance = 5;
  s->render.spp = 13;
  s->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_GAUSSIAN);
}

static void test_hash(void **state) {
  (void)state;
  /* published values of MurmurHash3_x86_32, seed 0 */
  assert_int_equal(vl_cryptomatte_hash("hello"), 0x248bfa47);
  assert_int_equal(vl_cryptomatte_hash("hello, world"), 0x149bbb7f);
  assert_int_equal(vl_cryptomatte_hash("The quick brown fox jumps over the lazy dog"),
                   0x2e4ff723);
  assert_int_equal(vl_cryptomatte_hash(""), 0x00800000); /* hash 0 is reserved for no object */
  for (int i = 0; i < 5000; i++) {
    char name[20];
    snprintf(name, sizeof name, "name %d", i);
    uint32_t bits = vl_cryptomatte_hash(name);
    float f;
    memcpy(&f, &bits, sizeof f);
    assert_true(isnormal(f));
  }
}

/* Coverages add up to the image's alpha within rounding; ids are those of the manifest. */
static void test_agrees_with_the_image(void **state) {
  (void)state;
  Stage s = stage_open(49, 37);
  fill(&s);
  GroundTruth t = ground_truth_take(&s, MATTES, VL_CHANNEL_MODE_CENTRE);
  uint32_t shared = 0;
  for (uint32_t y = 0; y < 37; y++)
    for (uint32_t x = 0; x < 49; x++) {
      double object = 0, material = 0, instance = 0, alpha = vl_image_get(t.image, x, y, 3);
      for (int rank = 0; rank < 6; rank++) {
        char name[32];
        const char part = rank % 2 ? 'A' : 'G';
        snprintf(name, sizeof name, "CryptoObject%02d.%c", rank / 2, part);
        object += *place(&t, x, y, name);
        shared += rank == 1 && *place(&t, x, y, name) > 0;
        snprintf(name, sizeof name, "CryptoMaterial%02d.%c", rank / 2, part);
        material += *place(&t, x, y, name);
        snprintf(name, sizeof name, "CryptoInstance%02d.%c", rank / 2, part);
        instance += *place(&t, x, y, name);
      }
      assert_near("objects", object, alpha, 2e-7);
      assert_near("materials", material, alpha, 2e-7);
      assert_true(instance <= object + 2e-7);
    }
  assert_true(shared > 30);
  vlAttribute a;
  char key[64];
  snprintf(key, sizeof key, "cryptomatte/%07x/manifest",
           vl_cryptomatte_hash("CryptoInstance") >> 4);
  assert_int_equal(vl_image_find_attribute(t.floats, key, &a), VL_OK);
  char expected[100];
  snprintf(expected, sizeof expected, "{\"ball.1\":\"%08x\",\"ball.2\":\"%08x\"}",
           vl_cryptomatte_hash("ball.1"), vl_cryptomatte_hash("ball.2"));
  assert_string_equal(a.string, expected);
  ground_truth_free(&t);
  stage_close(&s);
}

/* A filter with negative lobes: coverages still add up to 1. */
static void test_negative_lobes(void **state) {
  (void)state;
  Stage s = stage_open(33, 25);
  fill(&s);
  s.film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_MITCHELL);
  GroundTruth t = ground_truth_take(&s, MATTES | VL_CHANNEL_ERROR, VL_CHANNEL_MODE_CENTRE);
  for (uint32_t y = 0; y < 25; y++)
    for (uint32_t x = 0; x < 33; x++) {
      double sum = 0;
      for (int rank = 0; rank < 6; rank++) {
        char name[32];
        snprintf(name, sizeof name, "CryptoObject%02d.%c", rank / 2, rank % 2 ? 'A' : 'G');
        assert_true(*place(&t, x, y, name) >= 0);
        sum += *place(&t, x, y, name);
      }
      assert_true(sum <= 1 + 1e-6);
    }
  ground_truth_free(&t);
  stage_close(&s);
}

/* The chosen samples: mode nearest is never farther than the neighbours of the centre; the
 * covering one is Cryptomatte's first rank where no lens and no instance is in play. */
static void test_modes(void **state) {
  (void)state;
  Stage s = stage_open(41, 31);
  fill(&s);
  s.camera.lens_radius = 0;
  uint32_t channels = VL_CHANNEL_ALL | VL_CHANNEL_CRYPTO_OBJECT;
  GroundTruth max = ground_truth_take(&s, channels, VL_CHANNEL_MODE_COVERAGE);
  GroundTruth near = ground_truth_take(&s, channels, VL_CHANNEL_MODE_NEAREST);
  uint32_t moved = 0, differ = 0;
  for (uint32_t y = 0; y < 31; y++)
    for (uint32_t x = 0; x < 41; x++) {
      const GroundTruth *both[2] = {&max, &near};
      for (int k = 0; k < 2; k++) { /* all channels are of one ray through one film point */
        const float *film = place(both[k], x, y, "film.X"), *p = place(both[k], x, y, "P.X");
        double o[3], d[3], pixel[2], z, point[3] = {p[0], p[1], p[2]};
        assert_true(fabsf(film[0] - 0.5f) <= 1.5f && fabsf(film[1] - 0.5f) <= 1.5f);
        moved += film[0] != 0.5f;
        assert_true(vl_camera_unproject(&both[k]->camera, x + (double)film[0],
                                        y + (double)film[1], o, d));
        for (int i = 0; i < 3; i++)
          assert_near("ray", place(both[k], x, y, "ray.X")[i], d[i], 1e-7);
        if (!id(both[k], x, y, "id.object"))
          continue;
        assert_true(vl_camera_project(&both[k]->camera, point, pixel, &z));
        assert_near("x", pixel[0], x + (double)film[0], 1e-4);
        assert_near("y", pixel[1], y + (double)film[1], 1e-4);
      }
      assert_true(*place(&near, x, y, "Z") <= *place(&max, x, y, "Z") * (1 + 1e-6f));
      differ += id(&near, x, y, "id.object") != id(&max, x, y, "id.object");
      uint32_t object = id(&max, x, y, "id.object"), first;
      memcpy(&first, place(&max, x, y, "CryptoObject00.R"), sizeof first);
      bool alone = *place(&max, x, y, "CryptoObject00.G") > 0.51f;
      char name[32];
      snprintf(name, sizeof name, "%s.%u", object == 3 ? "sphere" : "triangles", object);
      if (alone && object != 3)
        assert_int_equal(first, object ? vl_cryptomatte_hash(name) : 0);
    }
  assert_true(moved > 1000 && differ > 5);
  ground_truth_free(&max);
  ground_truth_free(&near);
  stage_close(&s);
}

/* Predicted standard errors match the measured ones for independent samples. Constant radiance
 * has none. */
static void test_standard_error(void **state) {
  (void)state;
  for (int filter = 0; filter < 2; filter++) {
    Stage s = stage_open(64, 64);
    Quad emission = quad_at(0, 0, -2, 3, 0, 0, 0, 3, 0),
         ceiling = quad_at(0, 2, -2, 1, 0, 0, 0, 0, 1);
    emission.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
    ceiling.emission = add_emission(&s, 3, true);
    add_quad(&s, &emission);
    add_quad(&s, &ceiling);
    s.camera.eye[2] = 1.5;
    s.camera.lookat[2] = 0;
    s.render.sampler = VL_SAMPLER_INDEPENDENT;
    s.film.filter =
        vl_default_pixel_filter(filter ? VL_PIXEL_FILTER_MITCHELL : VL_PIXEL_FILTER_BOX);
    s.render.spp = 32;
    GroundTruth few = ground_truth_take(&s, VL_CHANNEL_ERROR, VL_CHANNEL_MODE_CENTRE);
    s.render.spp = 512;
    s.render.seed = 5;
    GroundTruth many = ground_truth_take(&s, VL_CHANNEL_ERROR, VL_CHANNEL_MODE_CENTRE);
    double inside = 0, count = 0;
    for (uint32_t y = 0; y < 64; y++)
      for (uint32_t x = 0; x < 64; x++) {
        double e = *place(&few, x, y, "error.G"), f = *place(&many, x, y, "error.G");
        double off = vl_image_get(few.image, x, y, 1) - vl_image_get(many.image, x, y, 1);
        assert_true(e >= 0 && e < 1e6);
        if (e == 0)
          continue;
        inside += off * off < 0.6745 * 0.6745 * (e * e + f * f);
        count++; /* half of a normal distribution */
      }
    assert_true(count > 3000);
    assert_near("share inside the quartiles", inside / count, 0.5, 0.05);
    ground_truth_free(&few);
    ground_truth_free(&many);
    stage_close(&s);
  }
  Stage s = stage_open(8, 8);
  Quad wall = quad_at(0, 0, -1, 9, 0, 0, 0, 9, 0);
  wall.emission = add_emission(&s, 2, true);
  add_quad(&s, &wall);
  s.build.color = VL_COLOR_RGB;
  s.render.max_depth = 0;
  s.render.spp = 1;
  GroundTruth t = ground_truth_take(&s, VL_CHANNEL_ERROR, VL_CHANNEL_MODE_CENTRE);
  assert_true(isinf(*place(&t, 3, 3, "error.R")));
  ground_truth_free(&t);
  s.render.spp = 9;
  t = ground_truth_take(&s, VL_CHANNEL_ERROR, VL_CHANNEL_MODE_CENTRE);
  assert_true(*place(&t, 3, 3, "error.R") == 0.0f);
  ground_truth_free(&t);
  stage_close(&s);
}

/* Features are means over the samples that Cryptomatte counts. For a flat surface that is alone
 * in its pixel they are its values times its coverage. */
static void test_features(void **state) {
  (void)state;
  Stage s = stage_open(49, 37);
  fill(&s);
  s.render.spp = 8; /* features use all of them */
  GroundTruth t = ground_truth_take(&s, VL_CHANNEL_ALL | MATTES | VL_CHANNEL_FEATURES,
                                    VL_CHANNEL_MODE_CENTRE);
  uint32_t whole = 0, parts = 0, nothing = 0;
  for (uint32_t y = 0; y < 37; y++)
    for (uint32_t x = 0; x < 49; x++) {
      const float *albedo = place(&t, x, y, "feature.albedo.R"),
                  *n = place(&t, x, y, "feature.N.X");
      double coverage = *place(&t, x, y, "CryptoObject00.G"),
             disparity = *place(&t, x, y, "feature.disparity.Y");
      uint32_t object = id(&t, x, y, "id.object");
      if (coverage == 0) {
        nothing++;
        assert_true(albedo[0] == 0 && n[2] == 0 && disparity == 0);
      }
      if (object < 1 || object > 2 || *place(&t, x, y, "CryptoObject00.A") > 0)
        continue;
      whole += coverage > 0.9999;
      parts += coverage < 0.9;
      const float *own = place(&t, x, y, "N.X");
      for (int k = 0; k < 3; k++) {
        assert_near("N", n[k], coverage * (double)own[k], 1e-5);
        assert_near("albedo", albedo[k], coverage * (double)place(&t, x, y, "albedo.R")[k],
                    0.02);
      }
      if (coverage > 0.9999)
        assert_near("disparity", disparity * (double)number(&t, x, y, "distance.Y"), 1, 0.03);
    }
  if (whole < 300 || parts < 3 || nothing < 100)
    fail_msg("%u whole, %u in part, %u nothing", whole, parts, nothing);
  ground_truth_free(&t);
  stage_close(&s);
}

/* A crop has the channels of the whole image. */
static void crop_has_the_same_bits(uint32_t channels, vlChannelMode mode,
                                   const uint32_t crop[4]) {
  Stage s = stage_open(45, 35);
  fill(&s);
  GroundTruth whole = ground_truth_take(&s, channels, mode);
  memcpy(s.film.crop, crop, sizeof s.film.crop);
  GroundTruth part = ground_truth_take(&s, channels, mode);
  same_bits(whole.floats, part.floats, crop[0], crop[1]);
  same_bits(whole.ids, part.ids, crop[0], crop[1]);
  ground_truth_free(&part);
  ground_truth_free(&whole);
  stage_close(&s);
}

static void test_same_bits(void **state) {
  (void)state;
  /* errors are estimated in cells of 8 x 8 */
  const uint32_t any[4] = {7, 3, 41, 34}, cells[4] = {8, 8, 45, 32};
  uint32_t channels = VL_CHANNEL_ALL | MATTES | VL_CHANNEL_ERROR | VL_CHANNEL_FEATURES;
  for (int mode = VL_CHANNEL_MODE_NEAREST; mode <= VL_CHANNEL_MODE_COVERAGE; mode++) {
    Stage s = stage_open(45, 35);
    fill(&s);
    GroundTruth whole = ground_truth_take(&s, channels, (vlChannelMode)mode);
    crop_has_the_same_bits(channels & ~(uint32_t)VL_CHANNEL_ERROR, (vlChannelMode)mode, any);
    crop_has_the_same_bits(channels, (vlChannelMode)mode, cells);
    for (int isa = VL_ISA_BASE; isa <= VL_ISA_V4; isa++) {
      if (isa == VL_ISA_V2)
        continue; /* which BASE is on x86-64 */
      Stage other;
      if (!stage_like(&s, isa, &other))
        continue;
      fill(&other);
      GroundTruth t = ground_truth_take(&other, channels, (vlChannelMode)mode);
      same_bits(whole.floats, t.floats, 0, 0);
      same_bits(whole.ids, t.ids, 0, 0);
      ground_truth_free(&t);
      stage_close(&other);
    }
    ground_truth_free(&whole);
    stage_close(&s);
  }
}

static void test_wrong_arguments(void **state) {
  (void)state;
  Stage s = stage_open(16, 8);
  fill(&s);
  GroundTruth t = ground_truth_take(&s, MATTES, VL_CHANNEL_MODE_CENTRE);
  vlImage *floats = NULL, *ids = NULL;
  vlError error;
  vlChannelsDef def = vl_default_channels_def(16, 8);
  def.channels = VL_CHANNEL_CRYPTO_OBJECT;
  assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "film"));
  def.film = t.film;
  def.render = &s.render;
  def.ranks = 7;
  assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, &error),
                   VL_ERROR_ARGUMENT);
  def.ranks = 6;
  def.channels = VL_CHANNEL_ERROR; /* the film was not made for it */
  assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, &error),
                   VL_ERROR_ARGUMENT);
  vlImage *image;
  assert_int_equal(vl_film_errors(t.film, NULL, &image), VL_ERROR_ARGUMENT);
  def.channels = VL_CHANNEL_LUMINANCE; /* of another crop */
  def.crop[0] = 1;
  assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "luminance"));
  def.crop[0] = 0;
  def.channels = VL_CHANNEL_FORWARD;
  assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, &error),
                   VL_ERROR_ARGUMENT);
  def.channels = VL_CHANNEL_Z;
  def.mode = (vlChannelMode)3;
  assert_int_equal(vl_render_channels(t.world, &t.camera, &def, &floats, &ids, &error),
                   VL_ERROR_ARGUMENT);
  ground_truth_free(&t);
  stage_close(&s);
}

static GroundTruth take_errors(Stage *s) {
  return ground_truth_take(s, VL_CHANNEL_ERROR, VL_CHANNEL_MODE_CENTRE);
}

static vlResult take_all(Stage *s, GroundTruth *t) {
  vlChannelsDef def = vl_default_channels_def(16, 8);
  def.channels = VL_CHANNEL_ALL | MATTES | VL_CHANNEL_ERROR | VL_CHANNEL_FORWARD;
  def.mode = VL_CHANNEL_MODE_COVERAGE;
  def.film = t->film;
  def.render = &s->render;
  def.forward = &t->camera;
  vlImage *floats, *ids;
  vlIdBox objects[8], instances[8];
  vlBoxesDef boxes = vl_default_boxes_def(16, 8);
  vlResult result = vl_render_channels(t->world, &t->camera, &def, &floats, &ids, NULL);
  if (result == VL_OK)
    result = vl_world_boxes(t->world, &t->camera, &boxes, objects, instances, NULL);
  vl_image_destroy(floats);
  vl_image_destroy(ids);
  return result;
}

static void test_out_of_memory(void **state) {
  (void)state;
  ground_truth_out_of_memory(fill, take_errors, take_all);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_hash),           cmocka_unit_test(test_agrees_with_the_image),
      cmocka_unit_test(test_negative_lobes), cmocka_unit_test(test_modes),
      cmocka_unit_test(test_standard_error), cmocka_unit_test(test_features),
      cmocka_unit_test(test_same_bits),      cmocka_unit_test(test_wrong_arguments),
      cmocka_unit_test(test_out_of_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
