/* schema/sensors.c: rows of sensors (vlSensorDef) and of exposures (vlExposureDef). The values
 * of sensor files are read and checked by them. */
#include "schema/schema.h"
#include "velo/sensor.h"

#define SENSOR(TYPE, path, line, ...) \
  VL_PARAMETER(TYPE, vlSensorDef, NULL, path, line, __VA_ARGS__)
#define ABOVE(min, max) VL_RANGE(min, max), .flags = VL_PARAMETER_ABOVE_LOW
/* A part of a sensor file that a function reads into several members; docs/sensor.md describes
 * it. */
#define RULE(name, kind, line)                                                             \
  {                                                                                        \
    .type = VL_PARAMETER_BLOCK, .member = name,                                            \
    .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND, .text = kind, .description = line \
  }
static const vlParameter sensor_parameters[] = {
    SENSOR(DOUBLE, pixel, "distance of pixels", VL_RANGE(0.01, 1000), VL_DEFAULT(5),
           .unit = "um"),
    SENSOR(DOUBLE, fill_factor, "share of a pixel's area that collects light", ABOVE(0, 1),
           VL_DEFAULT(1)),
    SENSOR(DOUBLE, transmittance, "transmittance of the optics", VL_RANGE(0, 1), VL_DEFAULT(1)),
    SENSOR(DOUBLE, base_iso, "ISO speed at which the gain is `gain`", VL_RANGE(1, 1e6),
           VL_DEFAULT(100)),
    SENSOR(DOUBLE, gain, "conversion gain at base_iso", VL_RANGE(1e-6, 1e6), VL_DEFAULT(1),
           .unit = "e-/DN"),
    SENSOR(DOUBLE, full_well, "most electrons of a pixel", VL_RANGE(1, 1e9), VL_DEFAULT(1e9),
           .unit = "e-"),
    SENSOR(DOUBLE, black_level, "number of a pixel without electrons", VL_RANGE(0, 65535),
           .unit = "DN"),
    SENSOR(COUNT, bits, "bits of the converter", VL_RANGE(1, 16), VL_DEFAULT(16),
           .unit = "bits"),
    SENSOR(DOUBLE, read_noise, "deviation of the noise before the amplifier", VL_RANGE(0, 1e6),
           .unit = "e-"),
    SENSOR(DOUBLE, adc_noise, "deviation of the noise behind the amplifier", VL_RANGE(0, 1e4),
           .unit = "DN"),
    SENSOR(DOUBLE, row_noise, "deviation of the rows' offsets, new in each frame",
           VL_RANGE(0, 1e6), .unit = "e-"),
    SENSOR(DOUBLE, column_noise, "deviation of the columns' offsets, new in each frame",
           VL_RANGE(0, 1e6), .unit = "e-"),
    SENSOR(DOUBLE, dark_current, "mean dark current at dark_temperature", VL_RANGE(0, 1e9),
           .unit = "e-/s"),
    SENSOR(DOUBLE, dark_temperature, "temperature of which dark_current is",
           VL_RANGE(-273.15, 200), VL_DEFAULT(20), .unit = "degC"),
    SENSOR(DOUBLE, doubling, "temperature difference that doubles the dark current",
           VL_RANGE(0.1, 1000), VL_DEFAULT(8), .unit = "K"),
    SENSOR(DOUBLE, dsnu, "deviation of the pixels' fixed offsets", VL_RANGE(0, 1e6),
           .unit = "e-"),
    SENSOR(DOUBLE, dark_nonuniformity, "relative deviation of the pixels' dark currents",
           VL_RANGE(0, 1)),
    SENSOR(DOUBLE, prnu, "relative deviation of the pixels' responses", VL_RANGE(0, 1)),
    SENSOR(COUNT, seed, "seed of the fixed patterns", .unit = NULL),
    SENSOR(DOUBLE, chief_ray, "angle of the chief ray at the image's corners", VL_RANGE(0, 89),
           .unit = "degrees"),
    RULE("pattern", "string", "mosaic: mono, RGGB, quad, rgbw, or rows of letters: RG/GB"),
    RULE("efficiency", "map", "quantum efficiency of each filter by wavelength"),
    RULE("curves", "string", "a measured sensor, whose curves R, G and B have"),
    RULE("peak", "number", "largest efficiency of these curves"),
    RULE("crosstalk", "list", "3 x 3: where the light of a pixel is collected"),
    RULE("microlens", "list", "pairs of angle and relative response"),
    RULE("preset", "string", "where values come from that the file does not have"),
    RULE("name", "string", "of the sensor, for readers"),
    RULE("source", "string", "of the numbers, for readers"),
};
const vlKindRow vl_sensor_settings_row = {.name = "sensor",
                                          .description = "a sensor, in sensor files",
                                          VL_ROW_PARAMETERS(sensor_parameters)};

/* The default radiance makes an image's values those of its scene, whose luminance is in cd/m^2
 * (docs/decisions/0031-units.md). */
#define EXPOSURE(TYPE, path, line, ...) \
  VL_PARAMETER(TYPE, vlExposureDef, NULL, path, line, __VA_ARGS__)
static const vlParameter exposure_parameters[] = {
    EXPOSURE(DOUBLE, time, "exposure time", VL_RANGE(0, 1e6), VL_DEFAULT(0.01), .unit = "s",
             .keyword = "exposure_time"),
    EXPOSURE(DOUBLE, stops, "of a bracket: the exposure time times 2^stops", VL_RANGE(-30, 30),
             .unit = "stops"),
    EXPOSURE(DOUBLE, f_number, "focal length divided by the pupil's diameter",
             VL_RANGE(0.5, 1000), VL_DEFAULT(4)),
    EXPOSURE(DOUBLE, iso, "ISO speed; 0: the sensor's base_iso", VL_RANGE(0, 1e7)),
    EXPOSURE(DOUBLE, gain, "a further factor of the amplifier", VL_RANGE(1e-6, 1e6),
             VL_DEFAULT(1)),
    EXPOSURE(DOUBLE, temperature, "temperature of the sensor", VL_RANGE(-273.15, 200),
             VL_DEFAULT(20), .unit = "degC"),
    EXPOSURE(DOUBLE, focal_length, "of the lens, for cos^4 vignetting; 0: none",
             VL_RANGE(0, 1e6), .unit = "mm"),
    EXPOSURE(DOUBLE, radiance, "radiance of an image's value 1", VL_RANGE(1e-30, 1e30),
             VL_DEFAULT(1 / 72983.0), .unit = "W/(m^2 sr nm)"),
    EXPOSURE(COUNT, seed, "seed of the noise", .unit = NULL),
    EXPOSURE(COUNT, frame, "number of the frame: other noise with the same seed", .unit = NULL),
};
const vlKindRow vl_exposure_settings_row = {.name = "exposure",
                                            .description = "an exposure of a sensor",
                                            VL_ROW_PARAMETERS(exposure_parameters)};
