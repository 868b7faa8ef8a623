/* sensor/collect.c: the light's path to the electrons: from the spectral radiance of an image
 * to the mean number of photoelectrons of each pixel. Nothing is random here. */
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "base/free.h"
#include "math/approx_double.h"
#include "sensor/sensor.h"

#define RADIANS 0.017453292519943295

typedef struct Collect {
  const vlSensor *sensor;
  const vlImage *image;
  const float *floats; /* the image's values, if they are linear floats; else null */
  vlSensorSpectrum spectrum;
  const double *weights; /* of each filter: spectrum.count electrons per radiance */
  uint32_t width, height, channels;
  uint32_t window[4]; /* left, top, width and height of the whole */
  double scale;       /* energy per radiance, J / (W/(m^2 sr nm)) / nm */
  double chief;       /* tangent of the chief ray's angle / distance from the middle, pixels */
  double focal;       /* focal length in pixels; 0: no cos^4 */
  int value[3], error[3]; /* channels R G B and their standard errors; -1: there are none */
  double *means;
  atomic_uint_fast64_t not_finite, negative, noisy;
} Collect;

/* The microlenses' response at an angle, in degrees: linear between the rows of the table, and
 * beyond it that of its end. */
static double microlens(const vlSensorDef *def, double angle) {
  uint32_t i = 0;
  if (!def->angle_count)
    return 1.0;
  while (i < def->angle_count && def->angles[i] < angle)
    i++;
  if (i == 0 || i == def->angle_count)
    return def->responses[i ? i - 1 : 0];
  double t = (angle - def->angles[i - 1]) / (def->angles[i] - def->angles[i - 1]);
  return def->responses[i - 1] + t * (def->responses[i] - def->responses[i - 1]);
}

/* The share of light that is left at a pixel by angles: microlenses and cos^4. */
static double falloff(const Collect *c, uint32_t x, uint32_t y) {
  double dx = c->window[0] + x + 0.5 - 0.5 * c->window[2];
  double dy = c->window[1] + y + 0.5 - 0.5 * c->window[3];
  double square = dx * dx + dy * dy;
  double left = 1.0;
  if (c->chief > 0.0) {
    double tangent = c->chief * __builtin_sqrt(square);
    left = microlens(&c->sensor->def, vl_atan_positive(tangent) / RADIANS);
  }
  if (c->focal > 0.0) {
    double cosine_square = c->focal * c->focal / (c->focal * c->focal + square);
    left *= cosine_square * cosine_square;
  }
  return left;
}

/* Whether the standard error of the image's light is above a tenth of the photon noise. The
 * relative error of a pixel is that of the sum of R, G and B, taken as equally noisy at each
 * wavelength. */
static bool is_noisy(const Collect *c, uint32_t x, uint32_t y, double mean) {
  double value = 0.0;
  double error = 0.0;
  for (int i = 0; i < 3; i++) {
    value += fabs((double)vl_image_get(c->image, x, y, (uint32_t)c->value[i]));
    error += (double)vl_image_get(c->image, x, y, (uint32_t)c->error[i]);
  }
  double film = value > 0.0 ? mean * error / value : 0.0;
  return film > 0.1 * __builtin_sqrt(mean);
}

static double radiance(const Collect *c, uint32_t x, uint32_t y, uint32_t channel) {
  if (!c->floats)
    return (double)vl_image_get(c->image, x, y, channel);
  size_t pixel = (size_t)y * c->width + x;
  return (double)c->floats[pixel * c->channels + channel];
}

static void collect_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  Collect *c = user;
  const vlSensorDef *def = &c->sensor->def;
  uint32_t buckets = c->spectrum.count;
  uint32_t row = (c->window[1] + y) % def->pattern_height;
  uint64_t not_finite = 0;
  uint64_t negative = 0;
  uint64_t noisy = 0;
  for (uint32_t x = 0; x < c->width; x++) {
    uint32_t cell = row * def->pattern_width + (c->window[0] + x) % def->pattern_width;
    const double *weights = c->weights + (size_t)c->sensor->cell[cell] * buckets;
    double sum = 0.0;
    for (uint32_t i = 0; i < buckets; i++)
      sum += weights[i] * radiance(c, x, y, c->spectrum.channels[i]);
    if (!isfinite(sum))
      not_finite++;
    else if (sum < 0.0)
      negative++;
    double mean = isfinite(sum) && sum > 0.0 ? sum * c->scale * falloff(c, x, y) : 0.0;
    c->means[(size_t)y * c->width + x] = mean < 1e15 ? mean : 1e15;
    if (c->error[0] >= 0)
      noisy += is_noisy(c, x, y, mean);
  }
  atomic_fetch_add(&c->not_finite, not_finite);
  atomic_fetch_add(&c->negative, negative);
  atomic_fetch_add(&c->noisy, noisy);
}

/* ---- crosstalk --------------------------------------------------------------------------- */

typedef struct Spread {
  const double *crosstalk, *from;
  double *to;
  uint32_t width, height;
} Spread;

static uint32_t inside(int64_t at, uint32_t size) {
  return at < 0 ? 0 : at >= size ? size - 1 : (uint32_t)at;
}

/* A pixel gets the shares of its neighbours; at the border, the pixels of the border stand for
 * those beyond it. */
static void spread_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  const Spread *s = user;
  for (uint32_t x = 0; x < s->width; x++) {
    double sum = 0.0;
    for (int j = 0; j < 9; j++) {
      /* the share that goes to (dx, dy) comes from (-dx, -dy) */
      uint32_t column = inside((int64_t)x + 1 - j % 3, s->width);
      uint32_t row = inside((int64_t)y + 1 - j / 3, s->height);
      sum += s->crosstalk[j] * s->from[(size_t)row * s->width + column];
    }
    s->to[(size_t)y * s->width + x] = sum;
  }
}

static vlResult spread(const Collect *c, vlError *error) {
  const vlSensorDef *def = &c->sensor->def;
  if (def->crosstalk[4] == 1.0)
    return VL_OK;
  size_t count = (size_t)c->width * c->height;
  double *copy = vl_alloc_array(c->sensor->context, count, sizeof *copy);
  if (!copy)
    return vl_fail_memory(error);
  memcpy(copy, c->means, count * sizeof *copy);
  Spread s = {def->crosstalk, copy, c->means, c->width, c->height};
  vl_parallel_for(c->sensor->context, c->height, spread_row, &s);
  vl_free(c->sensor->context, copy);
  return VL_OK;
}

/* ---- the whole --------------------------------------------------------------------------- */

/* The channels of the image's colours and of their standard errors, if it has all. */
static void find_errors(Collect *c) {
  static const char *const names[3] = {"R", "G", "B"};
  for (int i = 0; i < 3; i++) {
    char name[16];
    snprintf(name, sizeof name, "error.%s", names[i]);
    c->value[i] = vl_image_find_channel(c->image, names[i]);
    c->error[i] = vl_image_find_channel(c->image, name);
    if (c->value[i] < 0 || c->error[i] < 0)
      c->error[0] = -1;
  }
}

/* Energy that a pixel collects: the irradiance of an aplanatic lens focused at infinity is pi
 * tau L / (4 N^2) on its axis. */
static void set_scales(Collect *c, const vlExposureDef *exposure) {
  const vlSensorDef *def = &c->sensor->def;
  double metres = def->pixel * 1e-6;
  double n = exposure->f_number;
  double irradiance = M_PI * def->transmittance / (4.0 * n * n);
  double area = metres * metres * def->fill_factor;
  c->scale = irradiance * area * vl_exposure_seconds(exposure) * exposure->radiance;
  double width = c->window[2];
  double height = c->window[3];
  double half = 0.5 * __builtin_sqrt(width * width + height * height);
  vlSinCosDouble chief = vl_sincos_double(def->chief_ray * RADIANS);
  c->chief = chief.sin / chief.cos / half;
  c->focal = exposure->focal_length * 1e-3 / metres;
}

vlResult vl_sensor_collect(const vlSensor *sensor, const vlImage *image,
                           const vlExposureDef *exposure, double *means, vlSensorOutput *out,
                           vlError *error) {
  vlExposureDef usual = vl_default_exposure_def();
  vl_error_clear(error);
  if (!sensor || !image || !means || !out)
    return vl_fail_argument(error, "an argument is null");
  exposure = exposure ? exposure : &usual;
  vlResult result = vl_exposure_check(exposure, error);
  Collect c = {.sensor = sensor,
               .image = image,
               .width = vl_image_width(image),
               .height = vl_image_height(image),
               .channels = vl_image_channels(image),
               .means = means};
  if (vl_image_type(image) == VL_PIXEL_F32 && vl_image_encoding(image) == VL_ENCODING_LINEAR)
    c.floats = vl_image_const_pixels(image);
  if (result == VL_OK)
    result = vl_exposure_window(exposure, c.width, c.height, c.window, error);
  if (result == VL_OK)
    result = vl_sensor_find_spectrum(sensor->context, image, &c.spectrum, error);
  if (result != VL_OK)
    return result;
  uint32_t filters = sensor->def.filter_count;
  double *weights =
      vl_alloc_array(sensor->context, (size_t)filters * c.spectrum.count, sizeof *weights);
  if (weights) {
    for (uint32_t f = 0; f < filters; f++)
      vl_sensor_weights(&sensor->def.filters[f], &c.spectrum,
                        weights + (size_t)f * c.spectrum.count);
    c.weights = weights;
    set_scales(&c, exposure);
    find_errors(&c);
    vl_parallel_for(sensor->context, c.height, collect_row, &c);
    result = spread(&c, error);
  } else {
    result = vl_fail_memory(error);
  }
  out->not_finite = atomic_load(&c.not_finite);
  out->negative = atomic_load(&c.negative);
  out->film_noise = c.error[0] >= 0
                        ? (double)atomic_load(&c.noisy) / ((double)c.width * c.height)
                        : (double)NAN;
  VL_FREE(sensor->context, weights, c.spectrum.channels);
  return result;
}
