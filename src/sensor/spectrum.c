/* sensor/spectrum.c: what an image says of itself: its spectrum (film/spectrum.c writes it),
 * what each bucket gives a filter, and which part of the whole it is. */
#include <stdlib.h>
#include <string.h>

#include "sensor/sensor.h"

#define PLANCK 6.62607015e-34    /* J s, exact (SI 2019) */
#define LIGHT_SPEED 2.99792458e8 /* m/s, exact */

/* The wavelength in the name of a channel, "S0.374,688nm". The decimal sign may be a point.
 * False: another channel. */
static bool wavelength_of(const char *name, double *wavelength) {
  double value = 0.0;
  double divisor = 0.0; /* 10 to the number of decimals; 0 before the decimal sign */
  if (strncmp(name, "S0.", 3) != 0)
    return false;
  const char *at = name + 3;
  for (; (*at >= '0' && *at <= '9') || ((*at == ',' || *at == '.') && divisor == 0.0); at++) {
    if (*at == ',' || *at == '.') {
      divisor = 1.0;
    } else {
      value = value * 10.0 + (*at - '0');
      divisor *= 10.0;
    }
  }
  *wavelength = divisor > 1.0 ? value / divisor : value;
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
      return vl_fail_argument(
          error,
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
    result = vl_fail_argument(
        error,
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

/* ---- windows ----------------------------------------------------------------------------- */

/* A window of OpenEXR: left, top, right, bottom, inclusive. */
static bool read_window(const vlImage *image, const char *name, double window[4]) {
  vlAttribute attribute;
  if (vl_image_find_attribute(image, name, &attribute) != VL_OK ||
      attribute.type != VL_ATTRIBUTE_BOX2I)
    return false;
  memcpy(window, attribute.numbers, 4 * sizeof *window);
  return true;
}

void vl_exposure_set_window(vlExposureDef *exposure, const vlImage *image) {
  double part[4];
  double whole[4];
  if (!exposure)
    return;
  memset(exposure->window, 0, sizeof exposure->window);
  if (!image || !read_window(image, "dataWindow", part) ||
      (!read_window(image, "originalDataWindow", whole) &&
       !read_window(image, "displayWindow", whole)))
    return;
  bool fits = part[2] - part[0] + 1.0 == vl_image_width(image) &&
              part[3] - part[1] + 1.0 == vl_image_height(image) && part[0] >= whole[0] &&
              part[1] >= whole[1] && part[2] <= whole[2] && part[3] <= whole[3];
  if (!fits)
    return;
  exposure->window[0] = (uint32_t)(part[0] - whole[0]);
  exposure->window[1] = (uint32_t)(part[1] - whole[1]);
  exposure->window[2] = (uint32_t)(whole[2] - whole[0] + 1.0);
  exposure->window[3] = (uint32_t)(whole[3] - whole[1] + 1.0);
}

static vlResult write_box(vlImage *image, const char *name, double left, double top,
                          uint32_t width, uint32_t height) {
  vlAttribute attribute = {.name = name,
                           .type = VL_ATTRIBUTE_BOX2I,
                           .numbers = {left, top, left + width - 1.0, top + height - 1.0}};
  return vl_image_set_attribute(image, &attribute);
}

vlResult vl_exposure_write_window(const vlExposureDef *exposure, vlImage *image) {
  if (!exposure || !image)
    return VL_ERROR_ARGUMENT;
  const uint32_t *window = exposure->window;
  if (!window[2])
    return VL_OK;
  VL_TRY(write_box(image, "dataWindow", window[0], window[1], vl_image_width(image),
                   vl_image_height(image)));
  return write_box(image, "displayWindow", 0, 0, window[2], window[3]);
}

vlResult vl_exposure_window(const vlExposureDef *exposure, uint32_t width, uint32_t height,
                            uint32_t window[4], vlError *error) {
  const uint32_t *given = exposure->window;
  const uint32_t all[4] = {0, 0, width, height};
  bool none = !given[0] && !given[1] && !given[2] && !given[3];
  memcpy(window, none ? all : given, sizeof all);
  if ((uint64_t)window[0] + width > window[2] || (uint64_t)window[1] + height > window[3])
    return vl_fail_argument(
        error, "window: an image of %u x %u pixels at (%u, %u) is not inside of %u x %u", width,
        height, window[0], window[1], window[2], window[3]);
  return VL_OK;
}
