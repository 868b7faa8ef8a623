/* view/sensor_edit.h: what the camera's back of the page is set to: the sensor, its exposure,
 * and the white of the development. */
#ifndef APP_VIEW_SENSOR_EDIT_H
#define APP_VIEW_SENSOR_EDIT_H

#include "velo/sensor.h"
#include "view/message.h"

/* What is white in the developed image. */
typedef enum ViewWhite {
  VIEW_WHITE_D65, /* a surface in daylight */
  VIEW_WHITE_A,   /* a surface in incandescent light */
  VIEW_WHITE_AUTO /* the mean of the image */
} ViewWhite;

/* The sensors that can be chosen: the presets, and that of a sensor file. */
typedef struct ViewSensors {
  char own[40];     /* name of the file's; empty: there is none */
  vlSensorDef file; /* its def */
} ViewSensors;

/* The def of a sensor. ARGUMENT: there is none of that name; the error names the nearest. */
vlResult sensor_find(const ViewSensors *sensors, const char *name, vlSensorDef *def,
                     vlError *error);

typedef struct ViewSensor {
  char preset[48]; /* a name of vl_sensor_preset_name, or that of the file's */
  ViewWhite white;
  bool metered;           /* the exposure time is the one that a meter chooses */
  vlExposureDef exposure; /* f_number: of a camera whose lens has no opening */
} ViewSensor;

/* generic_rggb, f/4, its base ISO speed, the meter's time. */
ViewSensor sensor_default(void);
/* Applies the fields of a message: preset, white, and exposure_time, f_number, iso, gain,
 * temperature, seed, frame, which are rows of vlExposureDef. exposure_time null: the meter's.
 * ARGUMENT: a field or value is refused, and the error says which and why in one line; *result
 * is unchanged then. */
vlResult sensor_edit(const ViewSensor *now, const ViewSensors *sensors,
                     const ViewMessage *message, ViewSensor *result, vlError *error);
/* "D65", "A", "auto": the name of a ViewWhite; null past the end. */
const char *sensor_white_name(uint32_t index);

#endif
