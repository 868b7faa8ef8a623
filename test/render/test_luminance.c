/* test_luminance.c: the luminance of pixels in cd/m^2 where it is known: skies of several
 * spectra, walls lit by lamps; in every colour space; films that have none. */
#include "render/shots.h"
#include "velo/channels.h"

#define PI 3.14159265358979323846

enum { SIZE = 8 };

/* The mean of the channel over the image, by the channel pass and by the film alone. */
static double luminance(Stage *s, float exposure) {
  vlWorld *world = NULL;
  vlCamera camera;
  vlFilm *film = NULL;
  vlImage *floats = NULL, *own = NULL;
  vlError error = {0};
  assert_int_equal(vl_world_build(s->scene, &s->build, &world, &error), VL_OK);
  assert_int_equal(vl_camera_make(&s->camera, &camera, NULL, NULL), VL_OK);
  assert_int_equal(vl_film_create(s->context, &s->film, &film), VL_OK);
  assert_int_equal(vl_render(world, &camera, film, &s->render, NULL, NULL), VL_OK);
  vlChannelsDef def = vl_default_channels_def(SIZE, SIZE);
  def.channels = VL_CHANNEL_LUMINANCE;
  def.film = film;
  def.exposure = exposure;
  if (vl_render_channels(world, &camera, &def, &floats, NULL, &error) != VL_OK)
    fail_msg("%s", error.message);
  assert_int_equal(vl_film_luminance(film, &own), VL_OK);
  assert_string_equal(vl_image_channel_name(own, 0), "luminance.Y");
  assert_string_equal(vl_image_channel_name(floats, 0), "luminance.Y");
  double sum = 0;
  for (uint32_t y = 0; y < SIZE; y++)
    for (uint32_t x = 0; x < SIZE; x++) {
      sum += vl_image_get(floats, x, y, 0);
      assert_true(vl_image_get(floats, x, y, 0) == vl_image_get(own, x, y, 0));
    }
  vl_image_destroy(floats);
  vl_image_destroy(own);
  vl_film_destroy(film);
  vl_world_destroy(world);
  stage_close(s);
  return sum / (SIZE * SIZE);
}

static Stage stage(void) {
  Stage s = stage_open(SIZE, SIZE);
  s.render.spp = 256;
  s.render.max_depth = 1;
  return s;
}

static Stage sky(vlSpectrum color, float scale) {
  Stage s = stage();
  vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
  def.color = color;
  def.scale = scale;
  assert_int_not_equal(vl_scene_add_light(s.scene, &def).index, 0);
  return s;
}

static void skies(void **state) {
  (void)state;
  Stage s = sky(vl_spectrum_blackbody(3000), 7);
  assert_ratio("blackbody", luminance(&s, 1), 7, 0.005);
  s = sky(vl_spectrum_constant(5), 7);
  assert_ratio("constant, exposed", luminance(&s, 3), 7, 0.005);
  s = sky(vl_spectrum_blackbody(3000), 7);
  s.build.color = VL_COLOR_RGB;
  assert_ratio("RGB", luminance(&s, 1), 7, 0.005);
  s = sky(vl_spectrum_blackbody(3000), 7);
  s.film.space = VL_SPACE_REC2020;
  assert_ratio("Rec. 2020", luminance(&s, 1), 7, 0.005);
  s = sky(vl_spectrum_rgb(1, 0.5f, 0.2f), 1);
  assert_ratio("colour", luminance(&s, 1), 0.2126 + 0.7152 * 0.5 + 0.0722 * 0.2, 0.005);
}

/* A wall of reflectance .5, seen and lit from straight ahead. */
static void walls(void **state) {
  (void)state;
  for (int which = 0; which < 2; which++) {
    Stage s = stage();
    s.camera.fov = 0.01;
    Quad wall = quad_at(0, 0, -2, 40, 0, 0, 0, 40, 0);
    wall.material = add_diffuse(&s, 0.5f, 0.5f, 0.5f);
    add_quad(&s, &wall);
    vlLightDef def = vl_default_light_def(which ? VL_LIGHT_DISTANT : VL_LIGHT_POINT);
    def.to[2] = -1;
    if (which)
      def.illuminance = 1000;
    else
      def.power = 4 * PI * 4000; /* 4000 cd at 2 m: 1000 lx */
    assert_int_not_equal(vl_scene_add_light(s.scene, &def).index, 0);
    assert_ratio(which ? "illuminance" : "power", luminance(&s, 1), 1000 * 0.5 / PI, 0.005);
  }
}

static void films_without(void **state) {
  (void)state;
  for (int which = 0; which < 3; which++) {
    Stage s = stage();
    if (which == 0)
      s.film.white_balance = 5000;
    if (which == 1)
      s.film.sensor = vl_sensor_name(1);
    vlFilm *film = NULL;
    vlImage *image = NULL;
    assert_int_equal(vl_film_create(s.context, &s.film, &film), VL_OK);
    assert_int_equal(vl_film_luminance(film, &image), which < 2 ? VL_ERROR_ARGUMENT : VL_OK);
    assert_true((image == NULL) == (which < 2));
    vl_image_destroy(image);
    assert_int_equal(vl_film_luminance(film, NULL), VL_ERROR_ARGUMENT);
    assert_int_equal(vl_film_luminance(NULL, &image), VL_ERROR_ARGUMENT);
    assert_null(image);
    vl_film_destroy(film);
    stage_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(skies), cmocka_unit_test(walls),
                                     cmocka_unit_test(films_without)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
