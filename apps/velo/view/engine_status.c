/* view/engine_status.c: see engine_status.h. */
#include "view/engine_status.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>

#include "cli/kinds.h"
#include "cli/report.h"
#include "view/engine_parts.h"

void engine_post(Engine *e, uint32_t client, const char *type, const char *members, ...) {
  va_list values;
  Json *json = json_text_begin(type);
  if (!json)
    return;
  va_start(values, members);
  json_put_list(json, members, values);
  va_end(values);
  json_text_post(json, e->server, client);
}

void json_text_keep(Json *json, Engine *e, char **last) {
  char *text = json_text_end(json);
  if (!text)
    return;
  engine_lock(e); /* a page that comes gets the text now, or by engine_greet */
  server_post(e->server, 0, text);
  char *before = *last;
  *last = text;
  engine_unlock(e);
  free(before);
}

/* ---- the error of the image -------------------------------------------------------------- */

static double display_value(double linear) {
  double x = linear > 0 ? linear < 1 ? linear : 1 : 0;
  return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

/* The root mean square of the standard errors of the display values, at every fourth pixel of
 * every fourth row. */
static double display_noise(const vlImage *image, const vlImage *errors, double scale) {
  double sum = 0, count = 0;
  uint32_t width = vl_image_width(image), height = vl_image_height(image);
  for (uint32_t y = 0; y < height; y += 4)
    for (uint32_t x = 0; x < width; x += 4)
      for (uint32_t c = 0; c < 3; c++) {
        double value = scale * (double)vl_image_get(image, x, y, c);
        double error = scale * (double)vl_image_get(errors, x, y, c);
        double spread = 0.5 * (display_value(value + error) - display_value(value - error));
        if (isfinite(spread)) {
          sum += spread * spread;
          count++;
        }
      }
  return count > 0 ? sqrt(sum / count) : NAN;
}

static void estimate_noise(Engine *e) {
  vlImage *image = NULL, *errors = NULL;
  const vlDevelopDef *develop = &e->model.job.defs->develop;
  if (engine_spp(e) < 2)
    return;
  if (vl_film_develop(e->film, develop, &image) == VL_OK &&
      vl_film_errors(e->film, develop, &errors) == VL_OK)
    e->status.noise = display_noise(image, errors, exp2((double)e->model.exposure));
  vl_image_destroy(image);
  vl_image_destroy(errors);
}

void status_tell(Engine *e, bool estimate) {
  double now = monotonic_seconds(), cost = now - e->status.estimated;
  uint32_t spp = engine_spp(e);
  const bool stale = isnan(e->status.noise) || e->status.noise_spp != spp;
  if (stale && (estimate || cost > 2 + 0.25 * e->samples.seconds)) {
    estimate_noise(e);
    e->status.noise_spp = spp;
    e->status.estimated = monotonic_seconds();
  }
  Json *json = json_text_begin("status");
  if (!json)
    return;
  engine_lock(e);
  bool paused = e->wanted.paused;
  double stop = e->interrupt.longest;
  e->interrupt.longest = 0;
  engine_unlock(e);
  json_put(json, "change %u, spp %u, target %u, paths_per_second %g, seconds %g", e->now.change,
           spp, e->now.spp,
           e->samples.seconds > 0 ? (double)e->samples.paths / e->samples.seconds : NAN,
           e->samples.seconds);
  json_put(json, "error %g, program_seconds %g, frame_seconds %g, denoise_seconds %g",
           e->status.noise, engine_program_seconds(),
           e->frames.seconds + server_seconds(e->server), e->preview.seconds);
  if (stop > 0)
    json_number(json, "stop_seconds", stop);
  json_put(json, "paused %i, tracer %s, racing %i, raced %i", paused,
           kind_name("tracers", (int)engine_shown(e).tracer),
           e->race.runs || engine_race_due(e, e->now.spp), e->race.decided);
  if (e->race.successor)
    json_text(json, "next_tracer", kind_name("tracers", (int)e->race.best.tracer));
  json_text_keep(json, e, &e->last.status);
}

void status_problem(Engine *e, const char *type, const vlError *what, const char *message) {
  Json *json = json_text_begin(type);
  if (!json)
    return;
  json_location(json, what->file[0] ? what->file : NULL, what->line, what->column);
  json_text(json, "message", message);
  json_text_post(json, e->server, 0);
}

void status_error(Engine *e, const vlError *error, vlResult result) {
  status_problem(e, "error", error, error_text(error, result));
}

/* ---- the timeline of the page ------------------------------------------------------------ */

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
        .duration = e->threads[THREAD_WATCH].runs ? e->model.seconds : 0,
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
