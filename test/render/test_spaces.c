/* test/render/test_spaces.c: colour spaces of images: an EXR file's chromaticities define its
 * values in textures, skies, area lights and projection lights; without them the def's space
 * counts. A film of the same space gives back the values. */
#include "render/shots.h"
#include "velo/texture.h"

static const double rec2020[8] = {0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290};
static const float color[3] = {0.2f, 0.5f, 0.1f};
enum { TEXTURE, SKY, LAMP, KINDS };

static vlImage *gradient_image(Stage *s, bool tells) {
  float rgb[4 * 4 * 3];
  for (int i = 0; i < 48; i++)
    rgb[i] = color[i % 3];
  vlImage *image = make_image(s, 4, 4, rgb);
  vlAttribute a = {.name = "chromaticities", .type = VL_ATTRIBUTE_CHROMATICITIES};
  memcpy(a.numbers, rec2020, sizeof rec2020);
  if (tells)
    assert_int_equal(vl_image_set_attribute(image, &a), VL_OK);
  return image;
}

/* What a film of that space sees of it. */
static void look(int kind, bool tells, vlColorSpace said, vlColorSpace film, double seen[3]) {
  char path[600];
  snprintf(path, sizeof path, "%s/test_spaces.exr", VELO_BINARY_DIR);
  Stage s = stage_open(8, 8);
  s.film.space = film;
  s.render.spp = 1024;
  s.render.max_depth = 1;
  s.camera.fov = 0.5;
  vlImage *image = gradient_image(&s, tells);
  Quad q = quad_at(0, 0, -1, 3, 0, 0, 0, 3, 0);
  if (kind == TEXTURE) {
    vlTextureDef def = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
    def.image = image;
    def.space = said;
    q.material = add_textured(&s, vl_scene_add_texture(s.scene, &def));
    add_quad(&s, &q);
    /* white: comes back as it goes in */
    vlLightDef light = vl_default_light_def(VL_LIGHT_DISTANT);
    light.from[2] = 1;
    light.to[2] = 0;
    light.scale = (float)M_PI;
    vl_scene_add_light(s.scene, &light);
  } else if (kind == SKY) {
    vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
    def.image = image;
    def.space = said;
    vl_scene_add_light(s.scene, &def);
  } else {
    assert_int_equal(vl_image_write(image, path, NULL, NULL), VL_OK);
    vlEmissionDef def = vl_default_emission_def();
    def.image = path;
    q.emission = vl_scene_add_emission(s.scene, &def);
    add_quad(&s, &q);
  }
  vl_image_destroy(image);
  Image p = stage_finish(&s);
  for (int c = 0; c < 3; c++)
    seen[c] = image_mean(&p, c);
  image_free(&p);
  remove(path);
}

static void spaces(void **state) {
  (void)state;
  for (int kind = 0; kind < KINDS; kind++) {
    double a[3], b[3], c[3];
    char what[64];
    snprintf(what, sizeof what, "kind %d", kind);
    look(kind, true, VL_SPACE_SRGB, VL_SPACE_REC2020, a); /* the file's word counts */
    look(kind, false, VL_SPACE_SRGB, VL_SPACE_SRGB, b);   /* none: sRGB */
    look(kind, true, VL_SPACE_SRGB, VL_SPACE_SRGB, c);
    for (int i = 0; i < 3; i++) {
      assert_near(what, a[i], color[i], 0.01);
      assert_near(what, b[i], color[i], 0.01);
    }
    assert_true(c[0] < color[0] - 0.05); /* a green that sRGB has not: its red is below */
    if (kind == LAMP)
      continue;
    look(kind, false, VL_SPACE_REC2020, VL_SPACE_REC2020, a); /* the def's */
    for (int i = 0; i < 3; i++)
      assert_near(what, a[i], color[i], 0.01);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(spaces)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
