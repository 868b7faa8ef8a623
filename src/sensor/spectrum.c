/* sensor/spectrum.c: the spectrum of an image (film/spectrum.c writes it), and what each of its
 * buckets gives a filter. */
#include <stdlib.h>
#include <string.h>

#include "sensor/sensor.h"

#define PLANCK 6.62607015e-34    /* J s, exact (SI 2019) */
#define LIGHT_SPEED 2.99792458e8 /* m/s, exact */

/* The wavelength in the name of a channel, "S0.374,688nm". The decimal sign may be a point.
 * False: another channel. */
static bool wavelength_of(const char *name, double *wavelength) {
  double value = 0.0;
  double place = 0.0;
  if (strncmp(name, "S0.", 3) != 0)
    return false;
  const char *at = name + 3;
  for (; (*at >= '0' && *at <= '9') || ((*at == ',' || *at == '.') && place == 0.0); at++) {
    if (*at == ',' || *at == '.') {
      place = 1.0;
    } else {
      value = value * 10.0 + (*at - '0');
      place *= 10.0;
    }
  }
  *wavelength = place > 1.0 ? value / place : value;
  return strcmp(at, "nm") == 0 && *wavelength > 0.0 && *wavelength < 1e5;
}

typedef struct Bucket {
  double wavelength;
  uint32_t channel;
} Bucket;

static int by_wavelength(const void *a, const void *b) {
  const Bucket *first = a;
  const Bucket *second = b;
  if (first->wavelength < second->wavelength)
    return -1;
  return first->wavelength > second->wavelength;
}

/* Whether the buckets follow each other at equal distances; names have 0.001 nm. */
static vlResult check_buckets(const Bucket *buckets, const vlSensorSpectrum *s,
                              vlError *error) {
  for (uint32_t i = 0; i < s->count; i++) {
    double middle = s->start + (i + 0.5) * s->width;
    double off = buckets[i].wavelength - middle;
    if (!(s->width > 0.0) || !(off > -0.01 && off < 0.01))
      return vl_fail(error, VL_ERROR_ARGUMENT,
                     "the image's spectrum is not in equal intervals: %.3f nm should be "
                     "%.3f nm",
                     buckets[i].wavelength, middle);
  }
  return VL_OK;
}

vlResult vl_sensor_find_spectrum(vlContext *context, const vlImage *image, vlSensorSpectrum *s,
                                 vlError *error) {
  uint32_t channels = vl_image_channels(image);
  Bucket *buckets = vl_alloc_array(context, channels, sizeof *buckets);
  *s = (vlSensorSpectrum){.channels = vl_alloc_array(context, channels, sizeof *s->channels)};
  vlResult result = buckets && s->channels ? VL_OK : vl_fail_memory(error);
  for (uint32_t c = 0; c < channels && result == VL_OK; c++) {
    double wavelength;
    if (wavelength_of(vl_image_channel_name(image, c), &wavelength))
      buckets[s->count++] = (Bucket){wavelength, c};
  }
  if (result == VL_OK && s->count < 2)
    result = vl_fail(error, VL_ERROR_ARGUMENT,
                     "the image has no spectrum: render it with --spectrum N (two buckets or "
                     "more); it has %u channels \"S0.NNNnm\"",
                     s->count);
  if (result == VL_OK) {
    qsort(buckets, s->count, sizeof *buckets, by_wavelength);
    double first = buckets[0].wavelength;
    s->width = (buckets[s->count - 1].wavelength - first) / (s->count - 1);
    s->start = first - 0.5 * s->width;
    for (uint32_t i = 0; i < s->count; i++)
      s->channels[i] = buckets[i].channel;
    result = check_buckets(buckets, s, error);
  }
  vl_free(context, buckets);
  if (result != VL_OK) {
    vl_free(context, s->channels);
    s->channels = NULL;
  }
  return result;
}

static double efficiency_at(const vlSensorFilter *filter, double wavelength) {
  double position = wavelength - VL_SENSOR_FIRST_WAVELENGTH;
  if (!(position >= 0.0 && position <= VL_SENSOR_WAVELENGTHS - 1))
    return 0.0;
  int i = (int)position;
  i = i < VL_SENSOR_WAVELENGTHS - 1 ? i : VL_SENSOR_WAVELENGTHS - 2;
  double low = (double)filter->efficiency[i];
  return low + ((double)filter->efficiency[i + 1] - low) * (position - i);
}

void vl_sensor_weights(const vlSensorFilter *filter, const vlSensorSpectrum *s,
                       double *weights) {
  int steps = 4 * (int)(s->width + 1.0); /* at most a quarter of a nm each */
  double step = s->width / steps;
  for (uint32_t i = 0; i < s->count; i++) {
    double sum = 0.0;
    for (int j = 0; j < steps; j++) {
      double wavelength = s->start + i * s->width + (j + 0.5) * step;
      sum += efficiency_at(filter, wavelength) * wavelength * 1e-9;
    }
    weights[i] = sum * step / (PLANCK * LIGHT_SPEED);
  }
}
