/* view/engine_sensor.h: the mode "camera" inside the engine: what the sensor makes of the film,
 * and what the pages are told of it. Only engine*.c include it. */
#ifndef APP_VIEW_ENGINE_SENSOR_H
#define APP_VIEW_ENGINE_SENSOR_H

#include "view/engine_status.h"

/* Gives a film's def what the sensor needs: a spectrum, and the filter of a pixel's own area.
 */
void engine_sensor_film(vlFilmDef *def);
/* Begins with the mode "camera" if --expose is given. Returns -1, or the exit code after
 * reporting the error. */
int engine_sensor_begin(Engine *engine);
/* Notes whether the sensor, and nothing else, is another one than before: then it is exposed to
 * the light that is there. Returns whether that is to be shown. */
bool engine_sensor_changed(Engine *engine, bool alone);
/* Exposes the sensor to the film, or to a coarse one, and sends the developed image and the
 * numbers about it; on the render thread. Sends an error where that cannot be. */
void engine_publish_camera(Engine *engine, const vlFilm *film, uint32_t scale);
/* The time, in seconds, at which the mean number of the last exposure were middle grey, with
 * the ISO speed and the gain of `exposure`; not finite: there is no light. */
double engine_metered_time(const Shot *shot, const vlExposureDef *exposure);
/* Posts the histogram of the numbers, levels, clipping and metering of the last exposure, which
 * took so many seconds. */
void engine_tell_exposure(Engine *engine, double seconds);
/* Frees what the last exposure has. */
void engine_sensor_forget(Engine *engine);

#endif
