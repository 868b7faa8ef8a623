/* test/render/test_switches.c: switches for comparisons (pbrt's disablepixeljitter,
 * disablewavelengthjitter, disabletexturefiltering): samples at the pixel's centre, the same
 * wavelengths for all samples, textures without a footprint. */
#include "render/shots.h"
#include "velo/sampler.h"
#include "velo/texture.h"
#include "velo/tracer.h"

enum { SIZE = 16 };

static Stage stage(bool rgb) {
  Stage s = stage_open(SIZE, SIZE);
  if (rgb)
    s.build.color = VL_COLOR_RGB;
  s.render.sampler = VL_SAMPLER_INDEPENDENT;
  s.render.spp = 32;
  return s;
}

/* A slanting edge, out of focus, seen by an open lens: no pixel is half lit. */
static void centred(void **state) {
  (void)state;
  uint32_t between[2] = {0, 0};
  for (int on = 0; on < 2; on++) {
    Stage s = stage(true);
    s.render.centred = on;
    s.camera.lens_radius = 0.05;
    s.camera.focus_distance = 1;
    Quad q = quad_at(0.3f, 0.2f, -3, 1.5f, 0.7f, 0, -0.7f, 1.5f, 0);
    q.emission = add_emission(&s, 2, true);
    add_quad(&s, &q);
    Image p = stage_finish(&s);
    for (int i = 0; i < SIZE * SIZE; i++) {
      float v = p.rgba[4 * i + 1];
      between[on] += v > 1e-4f && v < 1.999f;
    }
    image_free(&p);
  }
  assert_true(between[0] > 10);
  assert_int_equal(between[1], 0);
}

static void same_wavelengths(void **state) {
  (void)state;
  bool alike[2];
  for (int on = 0; on < 2; on++) {
    Stage s = stage(false);
    s.render.same_wavelengths = on;
    add_sky(&s, 1);
    Image p = stage_finish(&s);
    alike[on] = true;
    for (int i = 0; i < 4 * SIZE * SIZE; i++)
      alike[on] = alike[on] && p.rgba[i] == p.rgba[i % 4];
    image_free(&p);
  }
  assert_false(alike[0]);
  assert_true(alike[1]);
}

/* A fine image far away: grey when it is filtered, black and white where it is not. */
static void sharp_textures(void **state) {
  (void)state;
  enum { FINE = 256 };
  uint32_t grey[2] = {0, 0};
  for (int on = 0; on < 2; on++) {
    Stage s = stage(true);
    s.render.sampler = VL_SAMPLER_REGULAR;
    s.render.spp = 1;
    s.render.sharp_textures = on;
    s.render.tracer = VL_TRACER_RAYCAST;
    float *rgb = malloc(FINE * FINE * 3 * sizeof *rgb);
    for (int i = 0; i < FINE * FINE; i++)
      for (int c = 0; c < 3; c++)
        rgb[3 * i + c] = (i * 7919 / 13) % 2 ? 1.0f : 0.0f;
    vlTextureDef texture = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
    vlImage *image = make_image(&s, FINE, FINE, rgb);
    texture.image = image;
    texture.filter = VL_FILTER_POINT;
    Quad q = quad_at(0, 0, -1, 1, 0, 0, 0, 1, 0);
    q.material = add_textured(&s, vl_scene_add_texture(s.scene, &texture));
    add_quad(&s, &q);
    vl_image_destroy(image);
    free(rgb);
    Image p = stage_finish(&s);
    for (int y = 2; y < SIZE - 2; y++)
      for (int x = 2; x < SIZE - 2; x++) {
        float v = image_at(&p, (uint32_t)x, (uint32_t)y, 1);
        grey[on] += v > 0.2f && v < 0.6f;
      }
    image_free(&p);
  }
  assert_true(grey[0] > 100);
  assert_int_equal(grey[1], 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(centred),
                                     cmocka_unit_test(same_wavelengths),
                                     cmocka_unit_test(sharp_textures)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
