/* view/engine_exposure.c: what the pages are told of an exposure of the mode "camera": the
 * histogram of the numbers behind each filter, levels, what is clipped, and what a meter would
 * say. */
#include <math.h>
#include <stdlib.h>

#include "view/engine_sensor.h"

enum { BINS = 128 };
/* The share of the numbers' range at which a meter puts the mean. */
static const double middle_grey = 0.18;
/* Of meters for reflected light: cd/m^2 times s times ISO (ISO 2720). */
static const double meter_constant = 12.5;

/* The numbers behind one filter. */
typedef struct Behind {
  uint64_t count, clipped;
  double sum;
  uint32_t bins[BINS];
} Behind;

static void count(const Shot *s, Behind behind[VL_SENSOR_FILTERS]) {
  const vlSensorDef *sensor = vl_sensor_def(s->sensor);
  const vlRawDef *raw = vl_raw_def(s->raw);
  const uint16_t *numbers = vl_raw_const_numbers(s->raw);
  const uint32_t left = s->exposure.window[0], top = s->exposure.window[1];
  uint32_t filters[VL_SENSOR_CELLS];
  for (uint32_t i = 0; i < sensor->pattern_width * sensor->pattern_height; i++) {
    filters[i] = 0;
    while (sensor->filters[filters[i]].name != sensor->pattern[i])
      filters[i]++;
  }
  for (uint32_t y = 0; y < raw->height; y++)
    for (uint32_t x = 0; x < raw->width; x++) {
      const uint32_t cell = (top + y) % sensor->pattern_height * sensor->pattern_width +
                            (left + x) % sensor->pattern_width;
      Behind *b = &behind[filters[cell]];
      const uint32_t number = numbers[(size_t)y * raw->width + x];
      b->count++;
      b->clipped += number >= raw->white;
      b->sum += number;
      b->bins[(uint32_t)((uint64_t)number * BINS >> raw->bits)]++;
    }
}

static void put_filters(Json *json, const Shot *s, const Behind behind[VL_SENSOR_FILTERS]) {
  const vlSensorDef *sensor = vl_sensor_def(s->sensor);
  json_begin(json, "filters", '[');
  for (uint32_t i = 0; i < sensor->filter_count; i++) {
    const Behind *b = &behind[i];
    const char name[2] = {sensor->filters[i].name, 0};
    if (!b->count) /* the pattern has none of it */
      continue;
    json_begin(json, NULL, '{');
    json_put(json, "name %s, mean %g, clipped %g", name, b->sum / (double)b->count,
             (double)b->clipped / (double)b->count);
    json_integers(json, "bins", b->bins, BINS);
    json_end(json, '}');
  }
  json_end(json, ']');
}

static double iso_speed(const Shot *s, const vlExposureDef *exposure) {
  return exposure->iso > 0 ? exposure->iso : vl_sensor_def(s->sensor)->base_iso;
}

double engine_metered_time(const Shot *s, const vlExposureDef *exposure) {
  const vlSensorDef *sensor = vl_sensor_def(s->sensor);
  const double range = ldexp(1, (int)sensor->bits) - 1 - sensor->black_level;
  const double gain = exposure->gain * iso_speed(s, exposure) / sensor->base_iso / sensor->gain;
  return s->exposure.time * middle_grey * range / (s->electrons * gain);
}

/* The exposure that is set and the one a meter finds, as EV at ISO 100; the ISO speed, or else
 * the time, at which the mean number is middle grey. */
static void put_metering(Json *json, const Shot *s) {
  const vlExposureDef *exposure = &s->exposure;
  const double n = exposure->f_number;
  const double iso = iso_speed(s, exposure);
  const double time = engine_metered_time(s, exposure);
  json_put(json,
           "iso %g, ev %g, luminance %g, metered_ev %g, suggested_iso %g, suggested_time %g",
           iso, log2(n * n / exposure->time) - log2(iso / 100), s->luminance,
           s->luminance > 0 ? log2(s->luminance * 100 / meter_constant) : (double)NAN,
           iso * time / exposure->time, time);
}

static void put_exposure(Json *json, const Engine *e, const Behind *behind, double seconds) {
  const Shot *s = &e->shot;
  const vlRawDef *raw = vl_raw_def(s->raw);
  const double pixels = (double)raw->width * raw->height;
  json_put(json, "change %u, preset %s, metered %i, spp %u, bits %u", e->now.change, s->preset,
           e->now.sensor.metered, s->scale > 1 ? 0 : s->spp, raw->bits);
  json_put(json, "black %u, white %u, exposure_time %g, f_number %g, lens_f_number %g",
           raw->black[0], raw->white, s->exposure.time, s->exposure.f_number,
           camera_f_number(&e->now.camera));
  json_put(json, "full %g, film_noise %g, buckets %u, seconds %g", (double)s->out.full / pixels,
           s->out.film_noise, s->buckets, seconds);
  put_metering(json, s);
  put_filters(json, s, behind);
}

void engine_tell_exposure(Engine *e, double seconds) {
  Behind *behind = calloc(VL_SENSOR_FILTERS, sizeof *behind);
  Json *json = behind ? json_text_begin("exposed") : NULL;
  if (!json) {
    free(behind);
    return;
  }
  count(&e->shot, behind);
  put_exposure(json, e, behind, seconds);
  free(behind);
  json_text_keep(json, e, &e->last.exposure);
}
