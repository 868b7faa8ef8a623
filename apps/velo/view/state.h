/* view/state.h: what a page must know, as JSON: scene, settings, camera, and what can be
 * chosen. */
#ifndef APP_VIEW_STATE_H
#define APP_VIEW_STATE_H

#include "velo/world.h"
#include "view/camera_edit.h"
#include "view/sensor_edit.h"
#include "view/server.h"

/* The timeline, in seconds. */
typedef struct ViewTime {
  double from, duration; /* of what moves; duration 0: nothing does */
  double at, shutter;    /* when the shutter opens (unset: the model at rest), for how long */
} ViewTime;

typedef struct ViewState {
  const char *scene; /* path */
  uint32_t change, spp, channel;
  bool denoise; /* the preview is denoised */
  bool paused, can_undo, can_redo;
  const uint32_t *crop; /* x0, y0, x1, y1 */
  double exposure;      /* EV of the first view */
  int view;             /* vlView of the first view */
  const vlWorldInfo *info;
  const ViewCamera *camera;
  const ViewSensor *sensor; /* of the mode "camera"; null: the page has no such mode */
  ViewTime time;
  uint32_t poses; /* cameras of --trajectory */
} ViewState;

/* A JSON object in memory: begin (null: no memory), json_*(...), end, which frees it and
 * returns the text for the caller to free; null: no memory. */
Json *json_text_begin(const char *type);
char *json_text_end(Json *json);
/* Ends the object, posts it to a page or to all (0), and frees it. Null: posts nothing. */
void json_text_post(Json *json, Server *server, uint32_t client);

/* Whether pages show this channel of ground truth; index: its bit in vlChannel. */
bool state_shows_channel(uint32_t index);
/* The whole object, as json_text_begin. */
Json *state_begin(const ViewState *state);
/* The same of dialects, projections, sensors, channels by their bits: "" for those that pages
 * do not show. sensors: those of the mode "camera"; null: pages have no such mode. */
Json *state_begin_lists(const ViewSensors *sensors);

#endif
