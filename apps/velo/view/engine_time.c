/* view/engine_time.c: the timeline of the page. */
#include <math.h>

#include "view/engine_parts.h"

/* Extends the timeline. */
static void add_range(ViewTime *time, double from, double to) {
  if (!(to > from))
    return;
  const double end = time->duration > 0 ? fmax(time->from + time->duration, to) : to;
  time->from = time->duration > 0 ? fmin(time->from, from) : from;
  time->duration = end - time->from;
}

/* Without the rounding of the difference: 0.3 + 2 - 0.3 is to be shown as 2. */
static double seconds_between(double from, double to) {
  return round((to - from) * 1e12) / 1e12;
}

ViewTime engine_time(const Engine *e) {
  const vlLoadDef *load = &e->model.opening.load;
  const vlWorldInfo *info = &e->model.info;
  const vlCamera *camera = &e->wanted.camera.made;
  if (e->model.seconds > 0)
    return (ViewTime){
        .duration = e->watching ? e->model.seconds : 0,
        .at = load->time,
        .shutter = isnan(load->time_close) ? 0 : seconds_between(load->time, load->time_close)};
  ViewTime time = {.at = camera->shutter_open,
                   .shutter = seconds_between(camera->shutter_open, camera->shutter_close)};
  if (info->moves)
    add_range(&time, info->time_open, info->time_close);
  if (camera->moves)
    add_range(&time, camera->pose_times[0], camera->pose_times[1]);
  return time;
}
