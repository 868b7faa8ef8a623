/* color/sensor.h: measured camera sensors: sensitivity curves, and the matrix from sensor
 * response to XYZ (pbrt book 5.4.2). */
#ifndef COLOR_SENSOR_H
#define COLOR_SENSOR_H

#include "color/color.h"

enum { VL_SENSOR_SAMPLES = 35, VL_CHECKER_PATCHES = 24, VL_CHECKER_SAMPLES = 36 };

/* Sensitivities at 380 to 720 nm in steps of 10 nm; red, green and blue at each. They are
 * interpolated linearly and are 0 outside. */
typedef struct vlSensorCurves {
  char name[24];
  float rgb[VL_SENSOR_SAMPLES * 3];
} vlSensorCurves;
extern const vlSensorCurves vl_sensor_curves[]; /* ascending by name */
extern const uint32_t vl_sensor_count;
/* Reflectances, 380 to 730 nm in steps of 10 nm. */
extern const float vl_checker_patches[VL_CHECKER_PATCHES][VL_CHECKER_SAMPLES];

/* Finds a measured sensor by name; null when there is none. */
const vlSensorCurves *vl_sensor_find(const char *name);

/* Writes the sensor's curves at each nm, interleaved as in vl_cie_xyz0 (r, g, b, 0;
 * VL_LAMBDA_COUNT * 4 floats). Also writes the row-major matrix that maps the integrals of
 * radiance times these curves to XYZ. The matrix is a least-squares fit over the ColorChecker
 * patches. It maps their sensor values under daylight of `kelvin` to their XYZ under the
 * space's illuminant. It is scaled so that a white surface with luminance Y under that daylight
 * gets Y. */
void vl_sensor_make(const vlSensorCurves *curves, double kelvin, vlColorSpace space,
                    float *observer, double xyz_from_sensor[9]);

/* Spectrum of a colour temperature at each nm, in arbitrary units. It is CIE daylight from 4000
 * K on and a black body below. The temperature is corrected for the current value of Planck's
 * second constant. */
void vl_daylight(double kelvin, double light[VL_LAMBDA_COUNT]);
/* Chromaticity of CIE daylight. `kelvin` is the corrected temperature and at least 4000. */
void vl_daylight_xy(double kelvin, double xy[2]);

#endif
