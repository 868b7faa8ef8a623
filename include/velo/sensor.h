/** @file
 * velo/sensor.h: a camera's sensor: from the spectral radiance of a stored image to photons,
 * electrons and the whole numbers of a raw file, with the noise of each step. One stored image
 * gives any number of exposures (docs/sensor.md has the model and its formulas). */
#ifndef VELO_SENSOR_H
#define VELO_SENSOR_H

#include "velo/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Sizes of a vlSensorDef. */
enum {
  VL_SENSOR_FILTERS = 8,            /**< most filters of a mosaic */
  VL_SENSOR_CELLS = 64,             /**< most cells of a mosaic's pattern */
  VL_SENSOR_ANGLES = 32,            /**< most rows of the table of angles */
  VL_SENSOR_FIRST_WAVELENGTH = 360, /**< nm */
  VL_SENSOR_WAVELENGTHS = 471       /**< 360 to 830 nm, one per nm */
};

/** A colour filter with the silicon below it. */
typedef struct vlSensorFilter {
  char name; /**< its letter in patterns: 'R', 'G', 'B', 'W', ... */
  float efficiency[VL_SENSOR_WAVELENGTHS]; /**< quantum efficiency: electrons per photon, 0 to
                                              1, at 360 nm + its index; linear between */
} vlSensorFilter;

/** A sensor with the optics in front of it. Units: e- are electrons, DN ("digital numbers") the
 * whole numbers of the file; deviations are standard deviations. Plain values: it may be
 * copied. */
typedef struct vlSensorDef {
  uint32_t cookie;
  double pixel;              /**< distance of pixels, um */
  double fill_factor;        /**< share of a pixel's area that collects light, 0 to 1 */
  double transmittance;      /**< of the optics, 0 to 1 */
  double base_iso;           /**< the ISO speed at which the gain is `gain` */
  double gain;               /**< conversion gain at base_iso: e-/DN */
  double full_well;          /**< most electrons of a pixel, e- */
  double black_level;        /**< number of a pixel without electrons, DN */
  uint32_t bits;             /**< of the converter, 1 to 16 */
  double read_noise;         /**< before the amplifier, e- */
  double adc_noise;          /**< behind the amplifier, DN */
  double row_noise;          /**< an offset of each row, new in each frame, e- */
  double column_noise;       /**< an offset of each column, new in each frame, e- */
  double dark_current;       /**< mean at dark_temperature, e-/s */
  double dark_temperature;   /**< deg C */
  double doubling;           /**< temperature difference that doubles the dark current, K */
  double dsnu;               /**< deviation of the pixels' fixed offsets, e- */
  double dark_nonuniformity; /**< relative deviation of the pixels' dark currents */
  double prnu;               /**< relative deviation of the pixels' responses */
  uint32_t seed;             /**< of the fixed patterns: one specimen of the sensor */
  double crosstalk[9];  /**< share of a pixel's light that reaches it and its neighbours: three
                           rows, from the upper left; sum 1 */
  double chief_ray;     /**< angle of the chief ray at the image's corners, degrees; its tangent
                           grows with the distance from the image's middle */
  uint32_t angle_count; /**< rows of the table of angles; 0: all angles count alike */
  double angles[VL_SENSOR_ANGLES];    /**< angles of the chief ray, degrees, ascending */
  double responses[VL_SENSOR_ANGLES]; /**< the microlenses' relative response, 0 to 1; linear
                                         between */
  uint32_t pattern_width, pattern_height;    /**< of the mosaic, pixels */
  char pattern[VL_SENSOR_CELLS];             /**< letters of filters, rows from the top */
  uint32_t filter_count;                     /**< number of filters */
  vlSensorFilter filters[VL_SENSOR_FILTERS]; /**< the filters */
} vlSensorDef;

/** A sensor without noise: monochrome, efficiency 1, 16 bits, 1 e-/DN. */
VL_API vlSensorDef vl_default_sensor_def(void);
/** Sets the mosaic: "mono", "RGGB" (also BGGR, GRBG, GBRG: two rows of two), "quad" (each pixel
 * of RGGB as 2 x 2), "rgbw" (4 x 4, half of it W), or rows of letters with slashes between:
 * "RG/GB". Capitals or not. ARGUMENT: another text; error, which may be null, says why. */
VL_API vlResult vl_sensor_set_pattern(vlSensorDef *def, const char *pattern, vlError *error);
/** Sets the quantum efficiency of the filter with that letter, which is added if it is missing.
 * `count` pairs of wavelength (nm, ascending) and efficiency (0 to 1); linear between, 0
 * outside. ARGUMENT: no such values, or too many filters. */
VL_API vlResult vl_sensor_set_efficiency(vlSensorDef *def, char filter, uint32_t count,
                                         const double *wavelengths, const double *efficiency,
                                         vlError *error);
/** Sets R, G and B to the curves of a measured sensor (vl_sensor_name), which are relative
 * responses to radiance: divided by the wavelength and scaled so that the largest efficiency is
 * `peak`, 0 to 1. ARGUMENT: no such sensor, or peak. */
VL_API vlResult vl_sensor_set_curves(vlSensorDef *def, const char *name, double peak,
                                     vlError *error);
/** Name `index`, from 0, of the presets; null past the end. Constant strings. */
VL_API const char *vl_sensor_preset_name(uint32_t index);
/** Sets *def to a preset. ARGUMENT: there is none of that name; error names the nearest. */
VL_API vlResult vl_sensor_preset(const char *name, vlSensorDef *def, vlError *error);
/** Reads a sensor file: YAML with units (docs/sensor.md). Errors: SCENE (with line and column),
 * MISSING, IO, MEMORY. */
VL_API vlResult vl_sensor_read(vlContext *context, const char *path, vlSensorDef *def,
                               vlError *error);

/** A sensor whose def was checked. Constant: any number of threads may use it. */
typedef struct vlSensor vlSensor;
/** Checks the def and copies it. Errors: ARGUMENT (error names field, value and unit),
 * MEMORY. */
VL_API vlResult vl_sensor_create(vlContext *context, const vlSensorDef *def, vlSensor **sensor,
                                 vlError *error);
/** Null is allowed. */
VL_API void vl_sensor_destroy(vlSensor *sensor);
/** The def of a sensor; lives as long as the sensor. */
VL_API const vlSensorDef *vl_sensor_def(const vlSensor *sensor);
/** The mosaic as the letters of its rows with slashes between: "RG/GB". Returns the text. */
VL_API const char *vl_sensor_pattern(const vlSensorDef *def,
                                     char text[2 * VL_SENSOR_CELLS + 1]);

/** One exposure. */
typedef struct vlExposureDef {
  uint32_t cookie;
  double time;         /**< exposure time, s */
  double stops;        /**< of a bracket: the exposure time times 2^stops */
  double f_number;     /**< focal length / diameter of the pupil */
  double iso;          /**< ISO speed; 0: the sensor's base_iso */
  double gain;         /**< a further factor of the amplifier */
  double temperature;  /**< of the sensor, deg C */
  double focal_length; /**< of the lens, mm: the light falls with cos^4 of the angle that it
                          gives; 0: it does not, or the camera has darkened the image */
  double radiance; /**< radiance of an image's value 1, W/(m^2 sr nm); default 1 / 72983: that
                      of velo's images, whose luminance is in cd/m^2 (docs/conventions.md) */
  uint32_t seed;   /**< of the noise */
  uint32_t frame;  /**< number of the frame: other noise with the same seed */
  uint32_t window[4]; /**< which part of the sensor the image is: its left column and upper row,
                         width and height of the whole, pixels. All 0: the image is the whole.
                         Mosaic, noise and falloff of a part are those of the whole; crosstalk
                         at its border is not */
} vlExposureDef;
/** The default def: 1/100 s, f/4, base ISO, 20 deg C. */
VL_API vlExposureDef vl_default_exposure_def(void);
/** Sets `window` to what the image says: the attributes "dataWindow" and "originalDataWindow"
 * (or "displayWindow"), as crops have. Without them, or where they do not fit, all 0. */
VL_API void vl_exposure_set_window(vlExposureDef *exposure, const vlImage *image);
/** Sets the attributes "dataWindow" and "displayWindow" of an image of the exposure's size, if
 * `window` is not all 0. MEMORY. */
VL_API vlResult vl_exposure_write_window(const vlExposureDef *exposure, vlImage *image);

/** The result of an exposure: arrays of the caller's and counts. Arrays of width * height, rows
 * from the top. */
typedef struct vlSensorOutput {
  uint16_t *numbers;   /**< DN; may be null */
  float *electrons;    /**< before the amplifier, with read noise: e-; may be null */
  uint64_t full;       /**< pixels with a full well */
  uint64_t black;      /**< pixels below the converter's range, which are 0 */
  uint64_t white;      /**< pixels above the converter's range */
  uint64_t not_finite; /**< pixels with a radiance that is not finite, read as 0 */
  uint64_t negative;   /**< pixels with a negative sum of radiance, read as 0 */
  double film_noise;   /**< share of pixels, 0 to 1, whose standard error in the image (channels
                          "error.*") is above a tenth of the photon noise; NaN: the image has
                          no standard errors */
} vlSensorOutput;

/** Mean photoelectrons of each pixel: means (width * height doubles) from the image's channels
 * of spectral radiance ("S0.550,000nm", at least two, as `velo render --spectrum` writes them).
 * No random numbers but the light's path: optics, mosaic, microlenses, crosstalk. Of `out` only
 * not_finite, negative and film_noise are set. exposure: null for the default. ARGUMENT (error
 * says why: no spectrum, a wrong exposure), MEMORY. */
VL_API vlResult vl_sensor_collect(const vlSensor *sensor, const vlImage *image,
                                  const vlExposureDef *exposure, double *means,
                                  vlSensorOutput *out, vlError *error);
/** Reads out: from mean photoelectrons to noisy numbers; fills the arrays and counts of `out`
 * but for not_finite, negative and film_noise. A mean that is negative or not finite counts as
 * 0. The same numbers on every machine and any number of threads. */
VL_API vlResult vl_sensor_read_out(const vlSensor *sensor, uint32_t width, uint32_t height,
                                   const double *means, const vlExposureDef *exposure,
                                   vlSensorOutput *out, vlError *error);
/** vl_sensor_collect, then vl_sensor_read_out. */
VL_API vlResult vl_sensor_expose(const vlSensor *sensor, const vlImage *image,
                                 const vlExposureDef *exposure, vlSensorOutput *out,
                                 vlError *error);

#ifdef __cplusplus
}
#endif
#endif
