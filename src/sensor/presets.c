/* sensor/presets.c: sensors by name. The numbers of "generic_*" are round ones of their class,
 * no product's, so that a scene can be tried before a data sheet is at hand. The names of
 * measured sensitivities (vl_sensor_name) are "generic_rggb" with those curves. */
#include <stddef.h>

#include "base/text.h"
#include "color/sensor.h"
#include "math/elementary.h"
#include "sensor/sensor.h"

/* The numbers of a preset that differ from the defaults, which are those of a sensor without
 * noise. */
typedef void SetNumbers(vlSensorDef *def);

static void set_ideal(vlSensorDef *def) {
  def->full_well = 65535;
}

/* A global shutter of machine vision. */
static void set_generic_mono(vlSensorDef *def) {
  def->pixel = 3.45;
  def->fill_factor = 0.95;
  def->transmittance = 0.9;
  def->full_well = 10500;
  def->gain = 2.6;
  def->black_level = 60;
  def->bits = 12;
  def->read_noise = 2.2;
  def->adc_noise = 0.3;
  def->row_noise = 0.2;
  def->column_noise = 0.2;
  def->dark_current = 3;
  def->doubling = 7;
  def->dsnu = 0.8;
  def->prnu = 0.006;
  def->dark_nonuniformity = 0.1;
}

/* A large sensor of a camera. */
static void set_generic_rggb(vlSensorDef *def) {
  def->pixel = 6;
  def->fill_factor = 0.95;
  def->transmittance = 0.9;
  def->full_well = 60000;
  def->gain = 3.8;
  def->black_level = 512;
  def->bits = 14;
  def->read_noise = 2.5;
  def->adc_noise = 0.8;
  def->row_noise = 0.2;
  def->column_noise = 0.2;
  def->dark_current = 0.5;
  def->doubling = 7;
  def->dsnu = 0.5;
  def->prnu = 0.005;
  def->dark_nonuniformity = 0.1;
}

/* Small pixels of a telephone. */
static void set_generic_quad(vlSensorDef *def) {
  def->pixel = 0.8;
  def->fill_factor = 0.9;
  def->transmittance = 0.9;
  def->base_iso = 50;
  def->full_well = 6000;
  def->gain = 6;
  def->black_level = 64;
  def->bits = 10;
  def->read_noise = 1.5;
  def->adc_noise = 0.2;
  def->row_noise = 0.1;
  def->column_noise = 0.1;
  def->dark_current = 2;
  def->dsnu = 0.5;
  def->prnu = 0.01;
  def->dark_nonuniformity = 0.1;
}

/* The camera module "High Quality" of Raspberry Pi (Sony IMX477): pixel from its maker's
 * documentation; levels, well, gain and read noise as J. Hogan measured them
 * (strollswithmydog.com, "Pi HQ Cam Sensor Performance"): 0.47 DN/e- and 3 e- of read noise at
 * gain 1, 1.5 e- at gain 16. Of these two follow the noise before the amplifier, r, and behind
 * it, a: r^2 + (2.13 a)^2 = 3^2, r^2 + (2.13 a / 16)^2 = 1.5^2. What is not measured there,
 * dark current and fixed patterns, is 0. */
static void set_raspberry_pi_hq(vlSensorDef *def) {
  def->pixel = 1.55;
  def->full_well = 8180;
  def->gain = 1 / 0.47;
  def->black_level = 256;
  def->bits = 12;
  def->read_noise = 1.491;
  def->adc_noise = 1.223;
}

static const struct {
  const char *name, *pattern;
  double peak; /* largest efficiency; 0: 1 at all wavelengths */
  SetNumbers *set;
} presets[] = {
    {"ideal", "mono", 0, set_ideal},
    {"ideal_rggb", "rggb", 1, set_ideal},
    {"generic_mono", "mono", 0.65, set_generic_mono},
    {"generic_rggb", "rggb", 0.55, set_generic_rggb},
    {"generic_quad", "quad", 0.75, set_generic_quad},
    {"raspberry_pi_hq", "rggb", 0.55, set_raspberry_pi_hq},
};

const char *vl_sensor_preset_name(uint32_t index) {
  uint32_t count = VL_LENGTH(presets);
  if (index < count)
    return presets[index].name;
  index -= count;
  return index < vl_sensor_count ? vl_sensor_curves[index].name : NULL;
}

/* A filter of the presets: a bell over the wavelengths. */
static void set_bell(vlSensorDef *def, char name, double peak, double middle,
                     double deviation) {
  enum { COUNT = 48 }; /* every 10 nm */
  double wavelengths[COUNT];
  double efficiency[COUNT];
  for (int i = 0; i < COUNT; i++) {
    wavelengths[i] = 360.0 + 10.0 * i;
    double x = (wavelengths[i] - middle) / deviation;
    efficiency[i] = peak * vl_precise_exp(-0.5 * x * x);
  }
  vl_sensor_set_efficiency(def, name, COUNT, wavelengths, efficiency, NULL);
}

static void use(size_t index, vlSensorDef *def) {
  const double peak = presets[index].peak;
  *def = vl_default_sensor_def();
  presets[index].set(def);
  vl_sensor_set_pattern(def, presets[index].pattern, NULL);
  if (peak == 0.0)
    return;
  set_bell(def, 'W', peak, 540.0, 110.0);
  set_bell(def, 'R', peak, 610.0, 38.0);
  set_bell(def, 'G', peak, 535.0, 38.0);
  set_bell(def, 'B', peak, 460.0, 32.0);
}

vlResult vl_sensor_preset(const char *name, vlSensorDef *def, vlError *error) {
  if (!def || !name)
    return vl_fail_argument(error, "an argument is null");
  for (size_t i = 0; i < VL_LENGTH(presets); i++)
    if (vl_text_is(name, presets[i].name)) {
      use(i, def);
      return VL_OK;
    }
  if (vl_sensor_find(name)) {
    vl_sensor_preset("generic_rggb", def, NULL);
    return vl_sensor_set_curves(def, name, 0.55, error);
  }
  const char *names[64];
  char known[VL_GIVEN_MESSAGE];
  size_t count = 0;
  while (count < 64 && (names[count] = vl_sensor_preset_name((uint32_t)count)))
    count++;
  vl_tell_names(known, sizeof known, name, names, count);
  return vl_fail_argument(error, "there is no sensor \"%s\"%s", vl_short_text(name).text,
                          known);
}
