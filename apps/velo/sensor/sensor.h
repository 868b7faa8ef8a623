/* sensor/sensor.h: declarations shared by the sensor commands. */
#ifndef APP_SENSOR_SENSOR_H
#define APP_SENSOR_SENSOR_H

#include "cli/options.h"
#include "velo/sensor.h"

/* Whether the name is meant as a sensor file's. */
bool sensor_is_file(const char *name);
/* Makes the sensor of a name: a preset, or else a file. option: which gives the name
 * ("--sensor"). Returns -1, or the exit code after reporting the error. */
int sensor_open(vlContext *context, const char *option, const char *name, vlSensor **sensor);
/* Sets what the options give. Returns -1, or the exit code. */
int exposure_options(const Arguments *arguments, vlExposureDef *exposure);

#endif
