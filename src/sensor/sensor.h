/* sensor/sensor.h: what the files of the sensor share. */
#ifndef SENSOR_SENSOR_H
#define SENSOR_SENSOR_H

#include "base/context.h"
#include "base/error.h"
#include "velo/sensor.h"
#include "velo/setting.h"

struct vlSensor {
  vlContext *context;
  vlSensorDef def;
  uint8_t cell[VL_SENSOR_CELLS]; /* filter of each cell of the pattern */
};

/* Checks a default exposure's cookie and an exposure's numbers. */
vlResult vl_exposure_check(const vlExposureDef *exposure, vlError *error);
/* The index of the filter with that letter; filter_count: there is none. */
uint32_t vl_sensor_filter_index(const vlSensorDef *def, char name);
/* The exposure time with the stops of a bracket, s. */
double vl_exposure_seconds(const vlExposureDef *exposure);
/* The amplifier's factor: of the ISO speed and the further gain. */
double vl_exposure_gain(const vlSensorDef *def, const vlExposureDef *exposure);

/* The window of an image of this size; ARGUMENT: it lies partly outside of the whole. */
vlResult vl_exposure_window(const vlExposureDef *exposure, uint32_t width, uint32_t height,
                            uint32_t window[4], vlError *error);

/* The mean of the dark electrons of a pixel. */
double vl_exposure_dark(const vlSensorDef *def, const vlExposureDef *exposure);

/* The buckets of an image's spectrum: `count` channels from `first` on, ascending by
 * wavelength. */
typedef struct vlSensorSpectrum {
  uint32_t count;
  double start, width; /* nm: of the first bucket, of each bucket */
  uint32_t *channels;  /* index of each bucket's channel; a block of the context */
} vlSensorSpectrum;
/* Finds the spectrum of an image. ARGUMENT: it has none, or not of equal intervals. */
vlResult vl_sensor_find_spectrum(vlContext *context, const vlImage *image,
                                 vlSensorSpectrum *spectrum, vlError *error);
/* Electrons per (W/(m^2 sr nm)) of each bucket for one filter, for a collected energy of one
 * joule per watt of radiance: the integral over the bucket of efficiency * lambda / (h c). */
void vl_sensor_weights(const vlSensorFilter *filter, const vlSensorSpectrum *spectrum,
                       double *weights);

#endif
