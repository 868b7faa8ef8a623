/* sensor/presets.c: sensors by name. None is one product: the numbers of "generic_*" are round
 * ones of their class, so that a scene can be tried before a data sheet is at hand. The names
 * of measured sensitivities (vl_sensor_name) are "generic_rggb" with those curves. */
#include <stddef.h>

#include "base/text.h"
#include "color/sensor.h"
#include "math/elementary.h"
#include "sensor/sensor.h"

typedef struct Preset {
  const char *name, *pattern;
  double pixel, fill_factor, transmittance, base_iso, full_well, gain, black_level;
  uint32_t bits;
  double read_noise, adc_noise, row_noise, column_noise;
  double dark_current, doubling, dsnu, prnu, dark_nonuniformity;
  double peak; /* largest efficiency; 0: 1 at all wavelengths */
} Preset;

static const Preset presets[] = {
    {.name = "ideal",
     .pattern = "mono",
     .pixel = 5,
     .fill_factor = 1,
     .transmittance = 1,
     .base_iso = 100,
     .full_well = 65535,
     .gain = 1,
     .bits = 16,
     .doubling = 8},
    {.name = "ideal_rggb",
     .pattern = "rggb",
     .pixel = 5,
     .fill_factor = 1,
     .transmittance = 1,
     .base_iso = 100,
     .full_well = 65535,
     .gain = 1,
     .bits = 16,
     .doubling = 8,
     .peak = 1},
    {.name = "generic_mono", /* a global shutter of machine vision */
     .pattern = "mono",
     .pixel = 3.45,
     .fill_factor = 0.95,
     .transmittance = 0.9,
     .base_iso = 100,
     .full_well = 10500,
     .gain = 2.6,
     .black_level = 60,
     .bits = 12,
     .read_noise = 2.2,
     .adc_noise = 0.3,
     .row_noise = 0.2,
     .column_noise = 0.2,
     .dark_current = 3,
     .doubling = 7,
     .dsnu = 0.8,
     .prnu = 0.006,
     .dark_nonuniformity = 0.1,
     .peak = 0.65},
    {.name = "generic_rggb", /* a large sensor of a camera */
     .pattern = "rggb",
     .pixel = 6,
     .fill_factor = 0.95,
     .transmittance = 0.9,
     .base_iso = 100,
     .full_well = 60000,
     .gain = 3.8,
     .black_level = 512,
     .bits = 14,
     .read_noise = 2.5,
     .adc_noise = 0.8,
     .row_noise = 0.2,
     .column_noise = 0.2,
     .dark_current = 0.5,
     .doubling = 7,
     .dsnu = 0.5,
     .prnu = 0.005,
     .dark_nonuniformity = 0.1,
     .peak = 0.55},
    {.name = "generic_quad", /* small pixels of a telephone */
     .pattern = "quad",
     .pixel = 0.8,
     .fill_factor = 0.9,
     .transmittance = 0.9,
     .base_iso = 50,
     .full_well = 6000,
     .gain = 6,
     .black_level = 64,
     .bits = 10,
     .read_noise = 1.5,
     .adc_noise = 0.2,
     .row_noise = 0.1,
     .column_noise = 0.1,
     .dark_current = 2,
     .doubling = 8,
     .dsnu = 0.5,
     .prnu = 0.01,
     .dark_nonuniformity = 0.1,
     .peak = 0.75},
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

static void use(const Preset *p, vlSensorDef *def) {
  *def = vl_default_sensor_def();
  def->pixel = p->pixel;
  def->fill_factor = p->fill_factor;
  def->transmittance = p->transmittance;
  def->base_iso = p->base_iso;
  def->full_well = p->full_well;
  def->gain = p->gain;
  def->black_level = p->black_level;
  def->bits = p->bits;
  def->read_noise = p->read_noise;
  def->adc_noise = p->adc_noise;
  def->row_noise = p->row_noise;
  def->column_noise = p->column_noise;
  def->dark_current = p->dark_current;
  def->doubling = p->doubling;
  def->dsnu = p->dsnu;
  def->prnu = p->prnu;
  def->dark_nonuniformity = p->dark_nonuniformity;
  vl_sensor_set_pattern(def, p->pattern, NULL);
  if (p->peak == 0.0)
    return;
  set_bell(def, 'W', p->peak, 540.0, 110.0);
  set_bell(def, 'R', p->peak, 610.0, 38.0);
  set_bell(def, 'G', p->peak, 535.0, 38.0);
  set_bell(def, 'B', p->peak, 460.0, 32.0);
}

vlResult vl_sensor_preset(const char *name, vlSensorDef *def, vlError *error) {
  if (!def || !name)
    return vl_fail(error, VL_ERROR_ARGUMENT, "an argument is null");
  for (size_t i = 0; i < VL_LENGTH(presets); i++)
    if (vl_text_is(name, presets[i].name)) {
      use(&presets[i], def);
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
  return vl_fail(error, VL_ERROR_ARGUMENT, "there is no sensor \"%s\"%s",
                 vl_short_text(name).text, known);
}
