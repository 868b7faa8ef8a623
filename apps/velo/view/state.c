/* view/state.c: see state.h. */
#include "view/state.h"

#include <math.h>
#include <stdlib.h>

#include "velo/camera_file.h"
#include "velo/channels.h"
#include "velo/projection.h"

/* A further channel is a bit here and a row of web/display.js. */
static const uint32_t shown_channels =
    2u * VL_CHANNEL_FORWARD - 1u + VL_CHANNEL_LUMINANCE + VL_CHANNEL_ILLUMINANCE;

bool state_shows_channel(uint32_t index) {
  return index < VL_CHANNEL_COUNT && (shown_channels >> index & 1);
}

/* The object and its text, as long as it is written. */
typedef struct JsonText {
  Json json;
  char *text;
  size_t size;
} JsonText;

Json *json_text_begin(const char *type) {
  JsonText *text = calloc(1, sizeof *text);
  if (!text)
    return NULL;
  Json *json = &text->json;
  json->out = open_memstream(&text->text, &text->size);
  if (!json->out) {
    free(text);
    return NULL;
  }
  json_begin(json, NULL, '{');
  json_text(json, "type", type);
  return json;
}

char *json_text_end(Json *json) {
  JsonText *text = (JsonText *)json;
  json_end(json, '}');
  char *written = fclose(json->out) == 0 ? text->text : NULL;
  free(text);
  return written;
}

void json_text_post(Json *json, Server *server, uint32_t client) {
  char *text = json ? json_text_end(json) : NULL;
  if (text)
    server_post(server, client, text);
  free(text);
}

static void put_sensor(Json *json, const ViewSensor *sensor) {
  const vlExposureDef *exposure = &sensor->exposure;
  json_put(json, "preset %s, white %s, exposure_time %g, f_number %g, iso %g", sensor->preset,
           sensor_white_name(sensor->white), sensor->metered ? (double)NAN : exposure->time,
           exposure->f_number, exposure->iso);
  json_put(json, "gain %g, temperature %g, seed %u, frame %u", exposure->gain,
           exposure->temperature, exposure->seed, exposure->frame);
}

static void put_sensor_lists(Json *json, const ViewSensors *sensors) {
  const char *name;
  json_begin(json, "sensors", '[');
  if (sensors->own[0])
    json_text(json, NULL, sensors->own);
  for (uint32_t i = 0; (name = vl_sensor_preset_name(i)); i++)
    json_text(json, NULL, name);
  json_end(json, ']');
  json_begin(json, "whites", '[');
  for (uint32_t i = 0; (name = sensor_white_name(i)); i++)
    json_text(json, NULL, name);
  json_end(json, ']');
}

Json *state_begin(const ViewState *s) {
  Json *json = json_text_begin("state");
  if (!json)
    return NULL;
  json_put(json, "scene %s, change %u, spp %u, paused %i", s->scene, s->change, s->spp,
           s->paused);
  json_put(json, "denoise %i, channel %u, can_undo %i, can_redo %i", s->denoise, s->channel,
           s->can_undo, s->can_redo);
  json_integers(json, "crop", s->crop, 4);
  json_put(json, "exposure %g, view %d", s->exposure, s->view);
  json_begin(json, "bounds", '[');
  for (int i = 0; i < 6; i++)
    json_number(json, NULL,
                (double)(i < 3 ? s->info->bounds_min[i] : s->info->bounds_max[i - 3]));
  json_end(json, ']');
  json_begin(json, "time", '{');
  json_put(json, "from %g, seconds %g, at %g, shutter %g", s->time.from, s->time.duration,
           s->time.at, s->time.shutter);
  json_end(json, '}');
  json_integer(json, "poses", s->poses);
  json_begin(json, "camera", '{');
  camera_spellings(json, s->camera);
  json_end(json, '}');
  if (s->sensor) {
    json_begin(json, "sensor", '{');
    put_sensor(json, s->sensor);
    json_end(json, '}');
  }
  return json;
}

Json *state_begin_lists(const ViewSensors *sensors) {
  Json *json = json_text_begin("lists");
  if (!json)
    return NULL;
  json_begin(json, "dialects", '[');
  for (int i = VL_CAMERA_DIALECT_AUTO + 1; i < VL_CAMERA_DIALECT_COUNT; i++)
    if (i != VL_CAMERA_DIALECT_EXR)
      json_text(json, NULL, vl_camera_dialect_name((vlCameraDialect)i));
  json_end(json, ']');
  json_begin(json, "projections", '[');
  for (int i = 0; i <= VL_PROJECTION_OPTICS; i++)
    json_text(json, NULL, vl_projection_name((vlProjection)i));
  json_end(json, ']');
  json_begin(json, "channels", '[');
  for (uint32_t i = 0; i < VL_CHANNEL_COUNT; i++)
    json_text(json, NULL, state_shows_channel(i) ? vl_channel_name(i) : "");
  json_end(json, ']');
  if (sensors)
    put_sensor_lists(json, sensors);
  return json;
}
