/** @file
 * velo/sensor_raw.h: the raw image of an exposure: levels, noise and colour as the sensor has
 * them. */
#ifndef VELO_SENSOR_RAW_H
#define VELO_SENSOR_RAW_H

#include "velo/raw.h"
#include "velo/sensor.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Creates a raw image for an exposure of a sensor. Its numbers are 0: vl_sensor_expose and
 * vl_sensor_read_out write them, with vlSensorOutput.numbers = vl_raw_numbers(raw).
 *
 * black: the mean number without light, dark electrons included, rounded. white: the number of
 * a full well, or the converter's greatest. gain: numbers per electron. read_noise: what varies
 * from frame to frame without light, electrons: noise before and behind the amplifier, of rows
 * and columns, and the variance of the dark electrons. iso: the exposure's, times its gain.
 * neutral and matrices: vl_raw_match_color of the efficiencies times the wavelength, for the
 * scene's light (a value for each nm, null: D65); a sensor whose filters are linearly dependent
 * has none.
 *
 * exposure may be null: the default. Errors: ARGUMENT (null pointers, a size of 0, a filter
 * whose letter raw images do not have, a pattern of more than 8 rows or columns or 4 colours),
 * MEMORY. */
VL_API vlResult vl_sensor_raw(const vlSensor *sensor, const vlExposureDef *exposure,
                              const float *light, uint32_t width, uint32_t height, vlRaw **raw,
                              vlError *error);

#ifdef __cplusplus
}
#endif
#endif
