/* test_radiometric.c: lights in watts: the radiance of stored spectra, summed over wavelengths,
 * is that of the watts that were asked; what is refused. */
#include "render/shots.h"
#include "velo/edit.h"

#define PI 3.14159265358979323846

enum { SIZE = 4, BUCKETS = 47, SPECTRA = 5 };

/* The mean radiance of the image over all wavelengths, W/(m^2 sr). The stage is closed. */
static double radiance(Stage *s) {
  vlWorld *world = NULL;
  vlCamera camera;
  vlFilm *film = NULL;
  vlImage *image = NULL;
  vlError error = {0};
  if (vl_scene_result(s->scene, &error) != VL_OK ||
      vl_world_build(s->scene, &s->build, &world, &error) != VL_OK)
    fail_msg("%s", error.message);
  assert_int_equal(vl_camera_make(&s->camera, &camera, NULL, NULL), VL_OK);
  assert_int_equal(vl_film_create(s->context, &s->film, &film), VL_OK);
  assert_int_equal(vl_render(world, &camera, film, &s->render, NULL, NULL), VL_OK);
  assert_int_equal(vl_film_spectrum(film, &image), VL_OK);
  double sum = 0;
  for (uint32_t i = 0; i < SIZE * SIZE; i++)
    for (uint32_t k = 0; k < BUCKETS; k++)
      sum += vl_image_get(image, i % SIZE, i / SIZE, k);
  vl_image_destroy(image);
  vl_film_destroy(film);
  vl_world_destroy(world);
  stage_close(s);
  return sum / (SIZE * SIZE) * (470.0 / BUCKETS) / 72983;
}

static Stage stage(void) {
  Stage s = stage_open(SIZE, SIZE);
  s.camera.fov = 0.01;
  s.film.buckets = BUCKETS;
  s.render.spp = 1024;
  s.render.max_depth = 1;
  return s;
}

static vlSpectrum sampled(const float *nm, const float *values, uint32_t count) {
  vlSpectrum s = vl_spectrum_constant(1);
  s.kind = VL_SPECTRUM_SAMPLED;
  s.wavelengths = nm;
  s.values = values;
  s.count = count;
  return s;
}

/* White, warm, saturated, a band of the deep red, a line. */
static vlSpectrum spectrum(int which) {
  static const float nm[6] = {360, 690, 700, 760, 770, 830}, band[6] = {0, 0, 1, 1, 0, 0};
  static const float at[5] = {360, 450, 460, 470, 830}, line[5] = {0, 0, 9, 0, 0};
  switch (which) {
    case 0:
      return vl_spectrum_constant(5);
    case 1:
      return vl_spectrum_blackbody(2700);
    case 2:
      return vl_spectrum_rgb(0.1f, 2, 0.3f);
    case 3:
      return sampled(nm, band, 6);
  }
  return sampled(at, line, 5);
}

static void check(Stage *s, const char *what, int which, double expected) {
  char text[80];
  snprintf(text, sizeof text, "%s, spectrum %d", what, which);
  assert_ratio(text, radiance(s), expected, 0.015);
}

/* A wall of reflectance .5 at 2 m, seen and lit from straight ahead. */
static Stage wall(const vlLightDef *def) {
  Stage s = stage();
  Quad q = quad_at(0, 0, -2, 40, 0, 0, 0, 40, 0);
  q.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
  add_quad(&s, &q);
  assert_int_not_equal(vl_scene_add_light(s.scene, def).index, 0);
  return s;
}

static void points(void **state) {
  (void)state;
  for (int i = 0; i < SPECTRA; i++) {
    vlLightDef def = vl_default_light_def(VL_LIGHT_POINT);
    def.color = spectrum(i);
    def.radiant_power = 30;
    def.scale = 2;
    Stage s = wall(&def);
    check(&s, "point, W", i, 60 / (4 * PI * 4) * 0.5 / PI);
    def.radiant_power = VL_UNSET;
    def.radiant_intensity = 7;
    def.scale = 1;
    s = wall(&def);
    check(&s, "point, W/sr", i, 7.0 / 4 * 0.5 / PI);
  }
}

static void spots(void **state) {
  (void)state;
  for (int i = 0; i < 3; i++) {
    vlLightDef def = vl_default_light_def(VL_LIGHT_SPOT);
    def.color = spectrum(i);
    def.to[2] = -1;
    def.radiant_intensity = 7;
    Stage s = wall(&def);
    check(&s, "spot, W/sr", i, 7.0 / 4 * 0.5 / PI);
    def.radiant_intensity = VL_UNSET;
    def.radiant_power = 3;
    def.cone_angle = 0.6f;
    def.cone_delta = 0;
    s = wall(&def);
    check(&s, "spot, W", i, 3 / (2 * PI * (1 - cos(0.6))) / 4 * 0.5 / PI);
  }
}

/* An even lamp of 100 cd. */
static void lamps(void **state) {
  (void)state;
  static const char file[] =
      "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 25\n"
      "0 180\n0\n100 100\n";
  vlLightDef def = vl_default_light_def(VL_LIGHT_GONIOMETRIC);
  def.lamp_data = file;
  def.lamp_size = sizeof file - 1;
  def.color = spectrum(1);
  def.radiant_power = 30;
  Stage s = wall(&def);
  check(&s, "lamp, W", 1, 30 / (4 * PI * 4) * 0.5 / PI);
}

static void far(void **state) {
  (void)state;
  for (int i = 0; i < SPECTRA; i++) {
    vlLightDef def = vl_default_light_def(VL_LIGHT_DISTANT);
    def.color = spectrum(i);
    def.to[2] = -1;
    def.irradiance = 800;
    Stage s = wall(&def);
    check(&s, "distant, W/m^2", i, 800 * 0.5 / PI);
    def = vl_default_light_def(VL_LIGHT_INFINITE);
    def.color = spectrum(i);
    def.irradiance = 800;
    s = stage();
    assert_int_not_equal(vl_scene_add_light(s.scene, &def).index, 0);
    check(&s, "sky, W/m^2", i, 800 / PI);
  }
}

/* Of each triangle of a square of 2 x 2 m, on both sides. */
static void surfaces(void **state) {
  (void)state;
  for (int i = 0; i < SPECTRA; i++) {
    Stage s = stage();
    vlEmissionDef def = vl_default_emission_def();
    def.radiance = spectrum(i);
    def.radiant_power = 12;
    def.two_sided = true;
    Quad q = quad_at(0, 0, -2, 1, 0, 0, 0, 1, 0);
    q.emission = vl_scene_add_emission(s.scene, &def);
    assert_int_not_equal(q.emission.index, 0);
    add_quad(&s, &q);
    check(&s, "surface, W", i, 12 / (2 * PI * 2));
  }
}

/* Photometric numbers are what the scene keeps: a constant spectrum has 683 * 106.857 / 471
 * lumens per watt. */
static void kept(void **state) {
  (void)state;
  Stage s = stage();
  vlLightDef def = vl_default_light_def(VL_LIGHT_POINT);
  def.radiant_power = 2;
  def.color = vl_spectrum_constant(3);
  vlLightId id = vl_scene_add_light(s.scene, &def);
  const vlLightDef *in = vl_scene_light(s.scene, id);
  assert_ratio("lumens", in->power, 2 * 683 * 106.857 / 471, 1e-5);
  assert_true(in->radiant_power != in->radiant_power);
  stage_close(&s);
}

static void refused(Stage *s, const vlLightDef *def, const char *text) {
  vlError error = {0};
  assert_int_equal(vl_scene_add_light(s->scene, def).index, 0);
  assert_int_equal(vl_scene_result(s->scene, &error), VL_ERROR_SCENE);
  if (!strstr(error.message, text))
    fail_msg("%s", error.message);
  stage_close(s);
}

static void wrong(void **state) {
  (void)state;
  static const double numbers[] = {0, -1, INFINITY, 1e308};
  static const char *const texts[] = {"\"radiantpower\" must be", "\"radiantpower\" must be",
                                      "\"radiantpower\" must be", "\"radiantpower\" 1e+308"};
  for (int i = 0; i < 4; i++) {
    Stage s = stage();
    vlLightDef def = vl_default_light_def(VL_LIGHT_POINT);
    def.radiant_power = numbers[i];
    refused(&s, &def, texts[i]);
  }
  for (int i = 0; i < 4; i++) {
    Stage s = stage();
    vlLightDef def = vl_default_light_def(i == 2 ? VL_LIGHT_DISTANT : VL_LIGHT_POINT);
    def.to[2] = -1;
    def.radiant_power = i < 2 ? 1 : VL_UNSET;
    def.power = i == 0 ? 1 : VL_UNSET;
    def.radiant_intensity = i == 1 ? 1 : VL_UNSET;
    def.irradiance = def.illuminance = i == 2 ? 1 : VL_UNSET;
    if (i == 3) {
      def.color = vl_spectrum_constant(0);
      def.radiant_power = 1;
    }
    static const char *const why[] = {
        "give either \"radiantpower\" or \"power\", not both",
        "give either \"radiantintensity\" or \"radiantpower\", not both",
        "give either \"irradiance\" or \"illuminance\", not both", "makes 0 of it in lumens"};
    refused(&s, &def, why[i]);
  }
  Stage s = stage();
  const float sky[3] = {1, 2, 3};
  vlImage *image = make_image(&s, 1, 1, sky);
  vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
  def.image = image;
  def.irradiance = 1;
  assert_int_equal(vl_scene_add_light(s.scene, &def).index, 0);
  vl_image_destroy(image);
  vlError error = {0};
  vl_scene_result(s.scene, &error);
  assert_string_equal(error.message,
                      "infinite light: \"irradiance\" needs one spectrum; the "
                      "pixels of an image have many");
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(points),   cmocka_unit_test(spots),
                                     cmocka_unit_test(lamps),    cmocka_unit_test(far),
                                     cmocka_unit_test(surfaces), cmocka_unit_test(kept),
                                     cmocka_unit_test(wrong)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
