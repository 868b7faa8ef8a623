/* test/render/test_sensor.c: images by a measured camera (vlFilmDef.sensor): the colour of a
 * lit wall against sums over wavelengths; the exposure; the limit of a sample, which applies to
 * the sensor's values; RGB worlds. */
#include "color/sensor.h"
#include "math/transform.h"
#include "shots.h"

enum { COUNT = VL_LAMBDA_COUNT };

/* What a film should show of a spectrum whose luminance under the observer is 1. */
static void expected_of(const char *name, double kelvin, const double *spectrum, double rgb[3],
                        double values[3]) {
  static float observer[4 * COUNT];
  double m[9], xyz[3] = {0, 0, 0}, y = 0;
  float to[9];
  memset(values, 0, 3 * sizeof *values);
  vl_sensor_make(vl_sensor_find(name), kelvin, VL_SPACE_SRGB, observer, m);
  vl_rgb_from_xyz(VL_SPACE_SRGB, to);
  for (int i = 0; i < COUNT; i++)
    y += spectrum[i] * (double)vl_cie_y()[i];
  for (int i = 0; i < COUNT; i++)
    for (int k = 0; k < 3; k++)
      values[k] += spectrum[i] / y * (double)observer[4 * i + k];
  for (int k = 0; k < 3; k++)
    xyz[k] = m[3 * k] * values[0] + m[3 * k + 1] * values[1] + m[3 * k + 2] * values[2];
  for (int k = 0; k < 3; k++)
    rgb[k] = (double)to[3 * k] * xyz[0] + (double)to[3 * k + 1] * xyz[1] +
             (double)to[3 * k + 2] * xyz[2];
}

/* A black body's light, of luminance 1, all over. */
static Image see_light(const char *sensor, double white, float kelvin, vlColorMode color,
                       float max) {
  Stage s = stage_open(8, 8);
  s.build.color = color;
  s.render.spp = 1024;
  s.render.same_wavelengths = max < INFINITY;
  s.film.sensor = sensor;
  s.film.white_balance = white;
  s.film.max_component = max;
  vlLightDef def = vl_default_light_def(VL_LIGHT_INFINITE);
  def.color = vl_spectrum_blackbody(kelvin);
  assert_int_not_equal(vl_scene_add_light(s.scene, &def).index, 0);
  return stage_finish(&s);
}

static void body_of(float kelvin, double *spectrum) {
  vlSpectrum body = vl_spectrum_blackbody(kelvin);
  float dense[COUNT];
  assert_int_equal(vl_spectrum_dense(&body, VL_ROLE_ILLUMINANT, dense, NULL), VL_OK);
  for (int i = 0; i < COUNT; i++)
    spectrum[i] = (double)dense[i];
}

static void colour_of_light(void **state) {
  (void)state;
  const char *const sensors[3] = {"nikon_d850", "canon_eos_5d_mkii", "sony_ilce_9"};
  const double whites[3] = {0, 5000, 3200};
  double spectrum[COUNT], rgb[3], values[3];
  body_of(2200, spectrum);
  for (int n = 0; n < 3; n++) {
    Image p = see_light(sensors[n], whites[n], 2200, VL_COLOR_SPECTRAL, INFINITY);
    expected_of(sensors[n], whites[n] > 0 ? whites[n] : 6500, spectrum, rgb, values);
    for (int c = 0; c < 3; c++)
      assert_ratio(sensors[n], image_mean(&p, c), rgb[c], 5e-3);
    Image eye = see_light(NULL, whites[n], 2200, VL_COLOR_SPECTRAL, INFINITY);
    double max = 0; /* it is not the observer's colour */
    for (int c = 0; c < 3; c++)
      max = fmax(max, fabs(image_mean(&p, c) / image_mean(&eye, c) - 1));
    assert_true(max > 0.01);
    image_free(&p);
    image_free(&eye);
  }
}

/* Samples above the limit are made darker by one factor, until the largest of the sensor's red,
 * green and blue is there: of paths that all have the same wavelengths. */
static void limited(void **state) {
  (void)state;
  static float observer[4 * COUNT];
  double m[9], to[9], whole[9], back[9], max = 0;
  float rgb_from_xyz[9];
  vl_sensor_make(vl_sensor_find("nikon_d850"), 5000, VL_SPACE_SRGB, observer, m);
  vl_rgb_from_xyz(VL_SPACE_SRGB, rgb_from_xyz);
  for (int i = 0; i < 9; i++)
    to[i] = (double)rgb_from_xyz[i];
  vl_mat3_multiply(to, m, whole);
  vl_mat3_inverse(whole, back);
  Image p = see_light("nikon_d850", 5000, 2200, VL_COLOR_SPECTRAL, 0.125f);
  for (int k = 0; k < 3; k++)
    max = fmax(max, back[3 * k] * image_mean(&p, 0) + back[3 * k + 1] * image_mean(&p, 1) +
                        back[3 * k + 2] * image_mean(&p, 2));
  assert_ratio("largest value", max, 0.125, 1e-4);
  image_free(&p);
}

/* Worlds without spectra: as the standard observer with the same white. */
static void rgb_world(void **state) {
  (void)state;
  Image a = see_light("nikon_d850", 0, 2200, VL_COLOR_RGB, INFINITY);
  Image b = see_light("cie1931", 6500, 2200, VL_COLOR_RGB, INFINITY);
  assert_memory_equal(a.rgba, b.rgba, (size_t)a.width * a.height * 4 * sizeof(float));
  image_free(&a);
  image_free(&b);
}

static void unknown_name(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  vlContext *context;
  assert_int_equal(vl_context_create(&def, &context), VL_OK);
  vlFilmDef film_def = vl_default_film_def(4, 4);
  vlFilm *film = NULL;
  film_def.sensor = "nikon_d851";
  assert_int_equal(vl_film_create(context, &film_def, &film), VL_ERROR_ARGUMENT);
  assert_null(film);
  vl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(colour_of_light),
                                     cmocka_unit_test(limited), cmocka_unit_test(rgb_world),
                                     cmocka_unit_test(unknown_name)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
