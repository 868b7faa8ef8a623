/* test/sensor/test_sensor_file.c: sensor files: a file with every field; errors with line,
 * column, field, value and unit; the nearest name. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "unit.h"
#include "velo/sensor.h"

static vlContext *context_;
static char path_[64] = "/tmp/velo_sensor_XXXXXX";

static int set_up(void **state) {
  (void)state;
  int file = mkstemp(path_);
  assert_true(file >= 0);
  close(file);
  assert_int_equal(vl_context_create(NULL, &context_), VL_OK);
  return 0;
}
static int tear_down(void **state) {
  (void)state;
  unlink(path_);
  assert_int_equal(vl_context_memory(context_, NULL), 0);
  vl_context_destroy(context_);
  return 0;
}

static vlResult read_text(const char *text, vlSensorDef *def, vlError *error) {
  FILE *file = fopen(path_, "wb");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
  return vl_sensor_read(context_, path_, def, error);
}

static void near(double a, double b) {
  if (!(a > b - 1e-9 && a < b + 1e-9))
    fail_msg("%.12g, not %.12g", a, b);
}

static void whole_file(void **state) {
  (void)state;
  vlSensorDef def;
  vlError error = {0};
  vlResult result = read_text(
      "name: a camera\n"
      "source: its data sheet\n"
      "pixel: 3450 nm\n"
      "fill_factor: 90 %\n"
      "transmittance: 0.8\n"
      "base_iso: 200\n"
      "gain: 0.5 e-/DN\n"
      "full_well: 10.5 ke-\n"
      "black_level: 64 DN\n"
      "bits: 12 bits\n"
      "read_noise: 2.3 e-\n"
      "adc_noise: 0.5 DN\n"
      "row_noise: 0.1 e-\n"
      "column_noise: 0.2 e-\n"
      "dark_current: 180 e-/min\n"
      "dark_temperature: 298.15 K\n"
      "doubling: 7 K\n"
      "dsnu: 0.8 e-\n"
      "dark_nonuniformity: 10 %\n"
      "prnu: 0.6 %\n"
      "seed: 7\n"
      "chief_ray: 12 deg\n"
      "microlens: [[0, 1], [20, 0.9]]\n"
      "crosstalk: [[0, 0.01, 0], [0.01, 0.96, 0.01], [0, 0.01, 0]]\n"
      "pattern: RG/GB\n"
      "efficiency:\n"
      "  R: [[400, 0], [600, 0.5], [700, 0]]\n"
      "  G: 0.25\n"
      "  B: [[400, 0.1], [500, 0.4]]\n",
      &def, &error);
  if (result != VL_OK)
    fail_msg("%u: %s", error.line, error.message);
  near(def.pixel, 3.45);
  near(def.fill_factor, 0.9);
  near(def.full_well, 10500);
  near(def.dark_current, 3);
  near(def.dark_temperature, 25);
  near(def.prnu, 0.006);
  near(def.crosstalk[4], 0.96);
  near(def.angles[1], 20);
  assert_int_equal(def.bits, 12);
  assert_int_equal(def.seed, 7);
  assert_int_equal(def.filter_count, 3);
  assert_int_equal(def.pattern_width, 2);
  assert_true(def.filters[0].efficiency[500 - 360] == 0.25f);
  assert_true(def.filters[1].efficiency[0] == 0.25f);
  assert_true(def.filters[2].efficiency[450 - 360] == 0.25f);
  assert_true(def.filters[2].efficiency[501 - 360] == 0.0f);
}

static void parts_of_a_preset(void **state) {
  (void)state;
  vlSensorDef def;
  vlError error = {0};
  assert_int_equal(read_text("bits: 10 bits\npreset: generic_rggb\n"
                             "curves: nikon_d850\npeak: 60 %\n",
                             &def, &error),
                   VL_OK);
  assert_int_equal(def.bits, 10);
  near(def.full_well, 60000);
  double largest = 0.0;
  for (int f = 0; f < 4; f++)
    for (int i = 0; i < VL_SENSOR_WAVELENGTHS && def.filters[f].name != 'W'; i++)
      if ((double)def.filters[f].efficiency[i] > largest)
        largest = (double)def.filters[f].efficiency[i];
  assert_true(largest > 0.5999 && largest < 0.6001);
}

static const struct {
  const char *text;
  unsigned line, column;
  const char *message;
} wrong[] = {
    {"gain: 1 e-/DN\nfull_well: 0 e-\n", 2, 12,
     "full_well must be a number from 1 to 1000000000; it is 0 e-"},
    {"bits: 18 bits\n", 1, 7, "bits must be a whole number from 1 to 16; it is 18 bits"},
    {"pixel: 3.45\n", 1, 8, "pixel needs its unit: pixel: 3.45 um"},
    {"pixel: 3.45 e-\n", 1, 8, "pixel must be a number with the unit um; it is \"3.45 e-\""},
    {"pixel: [3]\n", 1, 8, "pixel must be a number with the unit um; it is no number"},
    {"read_noise: nan e-\n", 1, 13, "read_noise must be a number with the unit e-"},
    {"prnu: 150 %\n", 1, 7, "prnu must be a number from 0 to 1; it is 1.5"},
    {"read_nose: 2 e-\n", 1, 12, "unknown field \"read_nose\"; did you mean \"read_noise\"?"},
    {"efficiency:\n  W: [[400, 0.5], [500, 1.5]]\n", 2, 6,
     "efficiency of W must be from 0 to 1 electrons per photon; it is 1.5 at 500 nm"},
    {"efficiency:\n  W: [[500, 0.5], [400, 0.5]]\n", 2, 6,
     "wavelengths must ascend; 400 nm comes after 500 nm"},
    {"efficiency:\n  W: [[500, 0.5], [400]]\n", 2, 6, "must be a list of pairs"},
    {"efficiency:\n  Red: 0.5\n", 2, 8, "must be one letter; it is \"Red\""},
    {"efficiency: 0.5\n", 1, 13, "efficiency must be a map"},
    {"pattern: R2\n", 1, 10, "pattern must be mono, RGGB"},
    {"pattern: RGGB\n", 1, 10, "pattern has the filter R, of which there is no efficiency"},
    {"crosstalk: [[1, 0, 0], [0, 1, 0], [0, 0, 0]]\n", 1, 12, "shares of sum 1; it is 2"},
    {"crosstalk: [1, 0]\n", 1, 12, "holds 2 numbers; it must hold 9"},
    {"microlens: [[0, 1], [0, 1]]\n", 1, 12, "ascending angles"},
    {"curves: canon_eos_5c\n", 1, 9, "the nearest is \"canon_eos_5d\""},
    {"peak: 0.5\n", 1, 7, "peak goes with curves"},
    {"preset: generic_mon\n", 1, 9, "the nearest is \"generic_mono\""},
    {"preset: 3\n", 1, 9, "preset must be text"},
    {"bits: 8 bits\nblack_level: 300 DN\n", 2, 14, "black_level must be below"},
    {"gain: 1 e-/DN\ngain: 2 e-/DN\n", 2, 7, "a key stands twice in one map"},
    {"gain: [1\n", 2, 1, "not YAML"},
    {"- 1\n", 1, 1, "not a sensor file"},
    {"", 0, 0, "not a sensor file"},
};

static void errors(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    vlSensorDef def = vl_default_sensor_def();
    vlError error = {0};
    vlResult result = read_text(wrong[i].text, &def, &error);
    if (result != VL_ERROR_SCENE || !strstr(error.message, wrong[i].message) ||
        error.line != wrong[i].line || error.column != wrong[i].column)
      fail_msg("%s: %d, %u:%u: %s", wrong[i].text, result, error.line, error.column,
               error.message);
    assert_int_equal(def.filter_count, 1); /* unchanged */
  }
  vlSensorDef def;
  vlError error = {0};
  assert_int_equal(vl_sensor_read(context_, "/nowhere/at/all.yaml", &def, &error),
                   VL_ERROR_MISSING);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(whole_file),
                                     cmocka_unit_test(parts_of_a_preset),
                                     cmocka_unit_test(errors)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
