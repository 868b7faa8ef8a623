/* test/sensor/test_sensor.c: sensors: means, variances and fixed patterns against closed
 * formulas; mosaics, crosstalk, angles; the same numbers with any number of threads; bad values
 * by name, value and unit. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"
#include "velo/sensor.h"
#include "velo/sensor_raw.h"

enum { SIDE = 256, PIXELS = SIDE * SIDE };

static vlContext *context_;
static double means_[PIXELS];
static uint16_t numbers_[PIXELS], others_[PIXELS];
static float electrons_[PIXELS];

static int set_up(void **state) {
  (void)state;
  assert_int_equal(vl_context_create(NULL, &context_), VL_OK);
  return 0;
}
static int tear_down(void **state) {
  (void)state;
  assert_int_equal(vl_context_memory(context_, NULL), 0);
  vl_context_destroy(context_);
  return 0;
}

/* An image of that radiance at all wavelengths: two buckets, 400 to 500 and 500 to 600 nm. */
static vlImage *flat_image(uint32_t width, uint32_t height, float radiance) {
  static const char *const names[2] = {"S0.450,000nm", "S0.550,000nm"};
  vlImageDef def = vl_default_image_def(width, height, 2);
  vlImage *image;
  def.names = names;
  assert_int_equal(vl_image_create(context_, &def, &image), VL_OK);
  float *pixels = vl_image_pixels(image);
  for (size_t i = 0; i < (size_t)2 * width * height; i++)
    pixels[i] = radiance;
  return image;
}

static vlSensor *sensor_of(const vlSensorDef *def) {
  vlSensor *sensor;
  vlError error = {0};
  if (vl_sensor_create(context_, def, &sensor, &error) != VL_OK)
    fail_msg("%s", error.message);
  return sensor;
}

/* Mean and variance over the pixels. */
static void moments(const uint16_t *numbers, double *mean, double *variance) {
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < PIXELS; i++)
    sum += numbers[i];
  *mean = sum / PIXELS;
  for (int i = 0; i < PIXELS; i++)
    squares += (numbers[i] - *mean) * (numbers[i] - *mean);
  *variance = squares / (PIXELS - 1);
}

static void near(double value, double expected, double tolerance) {
  if (!(fabs(value - expected) <= tolerance))
    fail_msg("%.9g, not %.9g +- %.3g", value, expected, tolerance);
}

/* E = pi L tau / (4 N^2); electrons = E area time integral of efficiency lambda / (h c). */
static void radiometry(void **state) {
  (void)state;
  vlSensorDef def = vl_default_sensor_def();
  def.pixel = 3;
  def.fill_factor = 0.5;
  def.transmittance = 0.8;
  double wavelengths[3] = {400, 500, 600};
  double efficiency[3] = {0.2, 0.6, 0.2};
  assert_int_equal(vl_sensor_set_efficiency(&def, 'w', 3, wavelengths, efficiency, NULL),
                   VL_OK);
  vlSensor *sensor = sensor_of(&def);
  vlExposureDef exposure = vl_default_exposure_def();
  exposure.time = 0.02;
  exposure.f_number = 2.8;
  exposure.radiance = 1e-3;
  vlImage *image = flat_image(SIDE, SIDE, 2.0f);
  vlSensorOutput out = {0};
  assert_int_equal(vl_sensor_collect(sensor, image, &exposure, means_, &out, NULL), VL_OK);
  double integral = 0.0; /* of efficiency * lambda, m nm, by the midpoint rule */
  for (int i = 0; i < 200000; i++) {
    double l = 400.0 + (i + 0.5) * 1e-3;
    integral += (0.6 - 0.4 * fabs(l - 500.0) / 100.0) * l * 1e-9 * 1e-3;
  }
  double irradiance = 3.14159265358979 * 2e-3 * 0.8 / (4.0 * 2.8 * 2.8);
  double expected = irradiance * 9e-12 * 0.5 * 0.02 * integral / (6.62607015e-34 * 299792458.0);
  near(means_[0], expected, 2e-6 * expected);
  near(means_[PIXELS - 1], expected, 2e-6 * expected);
  assert_true(isnan(out.film_noise));
  exposure.stops = -1.5;
  assert_int_equal(vl_sensor_collect(sensor, image, &exposure, means_, &out, NULL), VL_OK);
  near(means_[0], expected * pow(2.0, -1.5), 2e-6 * expected);
  vl_image_destroy(image);
  vl_sensor_destroy(sensor);
}

static void fill(double mean) {
  for (int i = 0; i < PIXELS; i++)
    means_[i] = mean;
}

static void read_out(const vlSensorDef *def, const vlExposureDef *exposure,
                     vlSensorOutput *out) {
  vlSensor *sensor = sensor_of(def);
  assert_int_equal(vl_sensor_read_out(sensor, SIDE, SIDE, means_, exposure, out, NULL), VL_OK);
  vl_sensor_destroy(sensor);
}

/* Each kind of noise alone and all together: mean and variance to five standard errors. */
static void noise(void **state) {
  (void)state;
  vlExposureDef exposure = vl_default_exposure_def();
  exposure.time = 2.0;
  exposure.temperature = 36.0;
  for (int kind = 0; kind < 7; kind++) {
    vlSensorDef def = vl_default_sensor_def();
    double mean = kind == 6 ? 800.0 : 100.0;
    double electrons = mean;
    double variance = mean;
    def.gain = 0.1; /* 10 DN/e-: rounding adds 1/12 DN^2 */
    def.black_level = 500;
    if (kind == 1 || kind == 6) {
      def.read_noise = 7;
      variance += 49.0;
    }
    if (kind == 2 || kind == 6) {
      def.adc_noise = 30;
      variance += 9.0;
    }
    if (kind == 3 || kind == 6) {
      def.dark_current = 10; /* doubled twice: 16 K above 20 degC */
      electrons += 80.0;
      variance += 80.0;
    }
    if (kind == 4 || kind == 6) {
      def.dsnu = 5;
      variance += 25.0;
    }
    if (kind == 5 || kind == 6) {
      def.prnu = 0.05;
      variance += 0.0025 * mean * mean;
    }
    fill(mean);
    vlSensorOutput out = {.numbers = numbers_};
    read_out(&def, &exposure, &out);
    double seen, spread;
    moments(numbers_, &seen, &spread);
    near(seen, 10.0 * electrons + 500.0, 5.0 * 10.0 * sqrt(variance / PIXELS));
    near(spread, 100.0 * variance + 1.0 / 12.0, 100.0 * variance * 5.5 * sqrt(2.0 / PIXELS));
  }
}

static double deviation_of_rows(bool columns) {
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < SIDE; i++) {
    double mean = 0.0;
    for (int j = 0; j < SIDE; j++)
      mean += numbers_[columns ? j * SIDE + i : i * SIDE + j] / (double)SIDE;
    sum += mean;
    squares += mean * mean;
  }
  return sqrt((squares - sum * sum / SIDE) / (SIDE - 1));
}

static void rows_and_columns(void **state) {
  (void)state;
  for (int columns = 0; columns < 2; columns++) {
    vlSensorDef def = vl_default_sensor_def();
    def.black_level = 1000;
    def.row_noise = columns ? 0 : 40;
    def.column_noise = columns ? 40 : 0;
    fill(0.0);
    vlSensorOutput out = {.numbers = numbers_};
    read_out(&def, NULL, &out);
    near(deviation_of_rows(columns), 40.0, 5.0 * 40.0 / sqrt(2.0 * SIDE));
    near(deviation_of_rows(!columns), 0.0, 1e-9);
  }
}

/* Fixed patterns are the specimen's: the same in each frame; noise differs. */
static void patterns_stay(void **state) {
  (void)state;
  vlSensorDef def = vl_default_sensor_def();
  vlExposureDef exposure = vl_default_exposure_def();
  def.black_level = 1000;
  def.dsnu = 20;
  fill(0.0);
  vlSensorOutput out = {.numbers = numbers_};
  read_out(&def, &exposure, &out);
  exposure.frame = 1;
  exposure.seed = 77;
  out.numbers = others_;
  read_out(&def, &exposure, &out);
  assert_memory_equal(numbers_, others_, sizeof numbers_);
  def.seed = 1; /* another specimen */
  read_out(&def, &exposure, &out);
  assert_memory_not_equal(numbers_, others_, sizeof numbers_);
  def.dsnu = 0;
  def.read_noise = 5;
  out.numbers = numbers_;
  read_out(&def, &exposure, &out);
  exposure.frame = 2;
  out.numbers = others_;
  read_out(&def, &exposure, &out);
  assert_memory_not_equal(numbers_, others_, sizeof numbers_);
}

static void limits(void **state) {
  (void)state;
  vlSensorDef def = vl_default_sensor_def();
  def.bits = 10;
  def.full_well = 3000;
  def.gain = 2;
  fill(1e6);
  means_[1] = 0.0 / (means_[0] - 1e6); /* NaN counts as 0 */
  means_[2] = -5.0;
  vlSensorOutput out = {.numbers = numbers_, .electrons = electrons_};
  read_out(&def, NULL, &out);
  assert_int_equal(numbers_[0], 1023);
  assert_true(electrons_[0] == 3000.0f);
  assert_int_equal(numbers_[1], 0);
  assert_int_equal(numbers_[2], 0);
  assert_int_equal(out.full, PIXELS - 2);
  assert_int_equal(out.white, PIXELS - 2);
  vlExposureDef exposure = vl_default_exposure_def();
  exposure.iso = 25; /* a quarter of the gain: 8 e-/DN */
  read_out(&def, &exposure, &out);
  assert_int_equal(numbers_[0], 375);
}

static void threads(void **state) {
  (void)state;
  vlSensorDef def;
  assert_int_equal(vl_sensor_preset("generic_rggb", &def, NULL), VL_OK);
  for (int i = 0; i < PIXELS; i++)
    means_[i] = i * 0.01;
  vlSensorOutput out = {.numbers = numbers_};
  read_out(&def, NULL, &out);
  vlContextDef many = vl_default_context_def();
  many.threads = 5;
  vlContext *other;
  vlSensor *sensor;
  assert_int_equal(vl_context_create(&many, &other), VL_OK);
  assert_int_equal(vl_sensor_create(other, &def, &sensor, NULL), VL_OK);
  out.numbers = others_;
  assert_int_equal(vl_sensor_read_out(sensor, SIDE, SIDE, means_, NULL, &out, NULL), VL_OK);
  assert_memory_equal(numbers_, others_, sizeof numbers_);
  vl_sensor_destroy(sensor);
  vl_context_destroy(other);
}

static void mosaics(void **state) {
  (void)state;
  vlSensorDef def;
  char text[2 * VL_SENSOR_CELLS + 1];
  assert_int_equal(vl_sensor_preset("ideal_rggb", &def, NULL), VL_OK);
  static const char *const names[][2] = {
      {"bggr", "BG/GR"}, {"GBRG", "GB/RG"}, {"Quad", "RRGG/RRGG/GGBB/GGBB"}, {"r/G", "R/G"}};
  for (int i = 0; i < 4; i++) {
    assert_int_equal(vl_sensor_set_pattern(&def, names[i][0], NULL), VL_OK);
    assert_string_equal(vl_sensor_pattern(&def, text), names[i][1]);
  }
  static const char *const wrong[] = {"", "/", "RG/", "RG//GB", "RG/G", "R2", "RG/GBX", "R G"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    vlError error = {0};
    assert_int_equal(vl_sensor_set_pattern(&def, wrong[i], &error), VL_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "pattern must be"));
  }
  assert_int_equal(vl_sensor_set_pattern(&def, "RG/GB", NULL), VL_OK);
  double at[2] = {300, 900};
  static const double level[3] = {0.1, 0.2, 0.4};
  for (int i = 0; i < 3; i++) {
    double both[2] = {level[i], level[i]};
    assert_int_equal(vl_sensor_set_efficiency(&def, "RGB"[i], 2, at, both, NULL), VL_OK);
  }
  vlSensor *sensor = sensor_of(&def);
  vlImage *image = flat_image(5, 3, 1.0f);
  vlSensorOutput out = {0};
  assert_int_equal(vl_sensor_collect(sensor, image, NULL, means_, &out, NULL), VL_OK);
  static const double seen[15] = {1, 2, 1, 2, 1, 2, 4, 2, 4, 2, 1, 2, 1, 2, 1};
  for (int i = 0; i < 15; i++)
    near(means_[i] / means_[0], seen[i], 1e-6);
  vl_image_destroy(image);
  vl_sensor_destroy(sensor);
}

/* A point of light spreads by the kernel; the sum stays. */
static void crosstalk(void **state) {
  (void)state;
  vlSensorDef def = vl_default_sensor_def();
  static const double kernel[9] = {0.01, 0.02, 0.03, 0.04, 0.7, 0.05, 0.06, 0.04, 0.05};
  memcpy(def.crosstalk, kernel, sizeof kernel);
  vlSensor *sensor = sensor_of(&def);
  vlImage *image = flat_image(5, 5, 0.0f);
  float *pixels = vl_image_pixels(image);
  pixels[2 * 12] = pixels[2 * 12 + 1] = 1.0f;
  vlSensorOutput out = {0};
  assert_int_equal(vl_sensor_collect(sensor, image, NULL, means_, &out, NULL), VL_OK);
  double whole = means_[12] / 0.7;
  for (int j = 0; j < 9; j++)
    near(means_[(1 + j / 3) * 5 + 1 + j % 3] / whole, kernel[j], 1e-9);
  assert_true(means_[0] == 0.0);
  vl_image_destroy(image);
  vl_sensor_destroy(sensor);
}

static void angles(void **state) {
  (void)state;
  vlSensorDef def = vl_default_sensor_def();
  vlExposureDef exposure = vl_default_exposure_def();
  def.chief_ray = 30;
  def.angle_count = 2;
  def.angles[1] = 60;
  def.responses[0] = 1.0;
  def.responses[1] = 0.4;
  vlSensor *sensor = sensor_of(&def);
  vlImage *image = flat_image(101, 101, 1.0f);
  vlSensorOutput out = {0};
  assert_int_equal(vl_sensor_collect(sensor, image, &exposure, means_, &out, NULL), VL_OK);
  double angle = atan(tan(30.0 / 57.29577951308232) * 50.0 / 50.5) * 57.29577951308232;
  near(means_[0] / means_[50 * 101 + 50], 1.0 - 0.6 * angle / 60.0, 1e-9);
  vl_sensor_destroy(sensor);
  def.angle_count = 0;
  sensor = sensor_of(&def);
  exposure.focal_length = 0.25; /* 50 pixels of 5 um */
  assert_int_equal(vl_sensor_collect(sensor, image, &exposure, means_, &out, NULL), VL_OK);
  near(means_[50 * 101] / means_[50 * 101 + 50], 0.25, 1e-9); /* 45 degrees */
  vl_image_destroy(image);
  vl_sensor_destroy(sensor);
}

/* A part of an image has the numbers of the whole there: mosaic, falloff and noise. */
static void windows(void **state) {
  (void)state;
  enum { WIDE = 37, TALL = 29, LEFT = 11, TOP = 6, WIDTH = 14, HEIGHT = 17 };
  vlSensorDef def;
  assert_int_equal(vl_sensor_preset("generic_quad", &def, NULL), VL_OK);
  def.crosstalk[4] = 1.0;
  for (int i = 0; i < 9; i++)
    def.crosstalk[i] = i == 4;
  def.row_noise = def.column_noise = def.dsnu = 3;
  def.prnu = 0.02;
  def.chief_ray = 20;
  vlSensor *sensor = sensor_of(&def);
  vlExposureDef exposure = vl_default_exposure_def();
  exposure.focal_length = 0.2;
  vlImage *whole = flat_image(WIDE, TALL, 500.0f), *part = flat_image(WIDTH, HEIGHT, 500.0f);
  vlSensorOutput out = {.numbers = numbers_};
  assert_int_equal(vl_sensor_expose(sensor, whole, &exposure, &out, NULL), VL_OK);
  vlExposureDef own = exposure;
  const uint32_t window[4] = {LEFT, TOP, WIDE, TALL};
  memcpy(own.window, window, sizeof window);
  assert_int_equal(vl_exposure_write_window(&own, part), VL_OK);
  out.numbers = others_;
  assert_int_equal(vl_sensor_expose(sensor, part, &exposure, &out, NULL), VL_OK);
  for (int y = 0; y < HEIGHT; y++)
    assert_memory_equal(others_ + y * WIDTH, numbers_ + (TOP + y) * WIDE + LEFT,
                        WIDTH * sizeof *others_);
  vlExposureDef read = exposure;
  vl_exposure_set_window(&read, part);
  assert_memory_equal(read.window, window, sizeof window);
  vl_exposure_set_window(&read, whole);
  const uint32_t none[4] = {0};
  assert_memory_equal(read.window, none, sizeof none);
  vlRaw *raw = NULL;
  assert_int_equal(vl_sensor_raw(sensor, &own, NULL, WIDTH, HEIGHT, &raw, NULL), VL_OK);
  const vlRawDef *r = vl_raw_def(raw);
  static const char letters[] = "RGBCMYW";
  for (uint32_t i = 0; i < 16; i++)
    assert_int_equal(letters[r->pattern[i]],
                     def.pattern[(TOP + i / 4) % 4 * 4 + (LEFT + i % 4) % 4]);
  vl_raw_destroy(raw);
  own.window[0] = WIDE - WIDTH + 1;
  vlError error = {0};
  assert_int_equal(vl_sensor_collect(sensor, part, &own, means_, &out, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "is not inside of 37 x 29"));
  vl_image_destroy(part);
  vl_image_destroy(whole);
  vl_sensor_destroy(sensor);
}

static void images(void **state) {
  (void)state;
  vlSensorDef def = vl_default_sensor_def();
  vlSensor *sensor = sensor_of(&def);
  vlSensorOutput out = {0};
  vlError error = {0};
  vlImageDef plain = vl_default_image_def(4, 4, 3);
  vlImage *image;
  assert_int_equal(vl_image_create(context_, &plain, &image), VL_OK);
  assert_int_equal(vl_sensor_collect(sensor, image, NULL, means_, &out, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "the image has no spectrum"));
  vl_image_destroy(image);
  static const char *const uneven[3] = {"S0.400nm", "S0.500nm", "S0.650nm"};
  plain.names = uneven;
  assert_int_equal(vl_image_create(context_, &plain, &image), VL_OK);
  assert_int_equal(vl_sensor_collect(sensor, image, NULL, means_, &out, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "not in equal intervals"));
  vl_image_destroy(image);
  image = flat_image(4, 4, 1.0f);
  float *pixels = vl_image_pixels(image);
  pixels[0] = NAN;
  pixels[2] = INFINITY;
  pixels[5] = -9.0f;
  assert_int_equal(vl_sensor_collect(sensor, image, NULL, means_, &out, &error), VL_OK);
  assert_int_equal(out.not_finite, 2);
  assert_int_equal(out.negative, 1);
  assert_true(means_[0] == 0.0 && means_[1] == 0.0 && means_[2] == 0.0 && means_[3] > 0.0);
  vl_image_destroy(image);
  vl_sensor_destroy(sensor);
}

/* The image's own noise is compared with photon noise. */
static void film_noise(void **state) {
  (void)state;
  static const char *const names[8] = {
      "R", "G", "B", "S0.450,000nm", "S0.550,000nm", "error.R", "error.G", "error.B"};
  vlSensorDef def = vl_default_sensor_def();
  vlSensor *sensor = sensor_of(&def);
  vlImageDef plain = vl_default_image_def(10, 10, 8);
  plain.names = names;
  vlImage *image;
  assert_int_equal(vl_image_create(context_, &plain, &image), VL_OK);
  float *pixels = vl_image_pixels(image);
  for (int i = 0; i < 800; i++)
    pixels[i] = 1.0f;
  vlSensorOutput out = {0};
  vlExposureDef exposure = vl_default_exposure_def();
  assert_int_equal(vl_sensor_collect(sensor, image, &exposure, means_, &out, NULL), VL_OK);
  near(683.0 * 106.857 * exposure.radiance, 1.0, 1e-5); /* cd/m^2 */
  exposure.radiance *= 10000.0 / means_[0];             /* photon noise is 1 % of the mean */
  for (int i = 0; i < 100; i++)
    for (int c = 5; c < 8; c++)
      pixels[8 * i + c] = i < 30 ? 0.0011f : 0.0009f;
  assert_int_equal(vl_sensor_collect(sensor, image, &exposure, means_, &out, NULL), VL_OK);
  near(out.film_noise, 0.3, 1e-12);
  vl_image_destroy(image);
  vl_sensor_destroy(sensor);
}

static void refuse(const vlSensorDef *def, const char *text) {
  vlSensor *sensor;
  vlError error = {0};
  assert_int_equal(vl_sensor_create(context_, def, &sensor, &error), VL_ERROR_ARGUMENT);
  if (!strstr(error.message, text))
    fail_msg("\"%s\" lacks \"%s\"", error.message, text);
}

static void bad_values(void **state) {
  (void)state;
  vlSensorDef usual = vl_default_sensor_def();
  vlSensorDef def = usual;
  vlError error = {0};
  def.full_well = 0;
  refuse(&def, "full_well must be a number from 1 to 1000000000; it is 0 e-");
  def = usual;
  def.bits = 17;
  refuse(&def, "bits must be a whole number from 1 to 16; it is 17 bits");
  def = usual;
  def.read_noise = NAN;
  refuse(&def, "read_noise");
  def = usual;
  def.filters[0].efficiency[3] = 1.25f;
  refuse(&def,
         "efficiency of W must be from 0 to 1 electrons per photon; it is 1.25 at 363 nm");
  def = usual;
  def.crosstalk[0] = 0.5;
  refuse(&def, "crosstalk must have shares of sum 1; it is 1.5");
  def = usual;
  def.bits = 8;
  def.black_level = 255;
  refuse(&def, "black_level must be below");
  def = usual;
  def.pattern[0] = 'X';
  refuse(&def, "pattern has the filter X");
  def = usual;
  def.cookie = 0;
  refuse(&def, "cookie");
  double at[2] = {500, 400};
  double one[2] = {1, 1};
  assert_int_equal(vl_sensor_set_efficiency(&def, 'R', 2, at, one, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "wavelengths must ascend; 400 nm comes after 500 nm"));
  vlSensor *sensor = sensor_of(&usual);
  vlExposureDef exposure = vl_default_exposure_def();
  vlSensorOutput out = {0};
  exposure.time = -1;
  assert_int_equal(vl_sensor_read_out(sensor, 1, 1, means_, &exposure, &out, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "exposure_time must be"));
  vl_sensor_destroy(sensor);
}

/* The read noise that was measured at two gains, e-. */
static void measured_camera(void **state) {
  (void)state;
  vlSensorDef def;
  assert_int_equal(vl_sensor_preset("raspberry_pi_hq", &def, NULL), VL_OK);
  static const double gains[2] = {1, 16};
  static const double noise[2] = {3, 1.5};
  fill(0);
  for (int i = 0; i < 2; i++) {
    vlExposureDef exposure = vl_default_exposure_def();
    vlSensorOutput out = {.numbers = numbers_};
    double mean;
    double variance;
    exposure.gain = gains[i];
    read_out(&def, &exposure, &out);
    moments(numbers_, &mean, &variance);
    double rounding = 1.0 / 12.0; /* DN^2 */
    double electrons = (variance - rounding) / (0.47 * 0.47 * gains[i] * gains[i]);
    near(mean, 256, 0.3);
    near(electrons / (noise[i] * noise[i]), 1, 5 * sqrt(2.0 / PIXELS));
  }
}

static void presets(void **state) {
  (void)state;
  uint32_t count = 0;
  vlError error = {0};
  vlSensorDef def;
  for (const char *name; (name = vl_sensor_preset_name(count)); count++) {
    assert_int_equal(vl_sensor_preset(name, &def, &error), VL_OK);
    vl_sensor_destroy(sensor_of(&def));
  }
  assert_int_equal(count, 23);
  assert_int_equal(vl_sensor_preset("canon_eos_5c", &def, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "the nearest is \"canon_eos_5d\""));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(radiometry),       cmocka_unit_test(noise),
      cmocka_unit_test(rows_and_columns), cmocka_unit_test(patterns_stay),
      cmocka_unit_test(limits),           cmocka_unit_test(threads),
      cmocka_unit_test(mosaics),          cmocka_unit_test(crosstalk),
      cmocka_unit_test(angles),           cmocka_unit_test(images),
      cmocka_unit_test(windows),          cmocka_unit_test(film_noise),
      cmocka_unit_test(bad_values),       cmocka_unit_test(presets),
      cmocka_unit_test(measured_camera)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
