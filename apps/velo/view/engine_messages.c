/* view/engine_messages.c: the engine's side of the server: greets pages and applies their
 * messages. All of it runs on the server's thread; nothing here renders. */
#include <string.h>

#include "cli/crop.h"
#include "cli/macros.h"
#include "velo/channels.h"
#include "view/engine_status.h"
#include "view/lecture.h"

/* The lecture has no room for the mode "camera", and velo in the page no memory. */
static bool has_camera_mode(const Engine *e) {
  return !e->def.lecture && !e->def.stepwise;
}

void engine_post_state(Engine *e, uint32_t client) {
  const Wanted *w = &e->wanted;
  const ViewState state = {.scene = e->def.path,
                           .change = w->change,
                           .spp = w->spp,
                           .channel = w->channel,
                           .denoise = w->denoise,
                           .paused = w->paused,
                           .can_undo = e->history.at > 0,
                           .can_redo = e->history.at + 1 < e->history.count,
                           .crop = w->crop,
                           .exposure = (double)e->model.exposure,
                           .view = (int)e->def.arguments->values[RENDER_VIEW].integer,
                           .info = &e->model.info,
                           .time = engine_time(e),
                           .poses = e->model.camera_count,
                           .camera = &w->camera,
                           .sensor = has_camera_mode(e) ? &w->sensor : NULL};
  json_text_post(state_begin(&state), e->server, client);
}

void engine_greet(void *user, uint32_t client) {
  Engine *e = user;
  json_text_post(state_begin_lists(has_camera_mode(e) ? &e->sensors : NULL), e->server, client);
  engine_lock(e);
  engine_post_state(e, client);
  if (e->last.left_out)
    server_post(e->server, client, e->last.left_out);
  if (e->last.status)
    server_post(e->server, client, e->last.status);
  if (e->last.exposure)
    server_post(e->server, client, e->last.exposure);
  engine_unlock(e);
}

void engine_clients(void *user, uint32_t count) {
  Engine *e = user;
  engine_lock(e);
  e->clients = count;
  if (!count) {
    engine_interrupt(e);
    engine_drop_traces(e, 0, "the page is closed");
  }
  pthread_cond_broadcast(&e->wake);
  engine_unlock(e);
}

/* ---- the camera -------------------------------------------------------------------------- */

static void show_camera(Engine *e, const ViewCamera *camera) {
  e->wanted.camera = *camera;
  e->wanted.generation++;
  engine_interrupt(e);
  engine_drop_traces(e, 0, "the camera moved");
}

static void remember(Engine *e, const ViewCamera *camera, uint32_t gesture) {
  History *h = &e->history;
  bool same = gesture && gesture == h->gesture && h->at > 0;
  h->gesture = gesture;
  if (!same && h->at + 1 == HISTORY) {
    memmove(h->cameras, h->cameras + 1, (HISTORY - 1) * sizeof *h->cameras);
    h->at--;
  }
  if (!same)
    h->at++;
  h->cameras[h->at] = *camera;
  h->count = h->at + 1;
}

void engine_take_camera(Engine *e, const ViewCamera *next, uint32_t change, uint32_t gesture) {
  e->wanted.change = change;
  remember(e, next, gesture);
  show_camera(e, next);
  engine_post_state(e, 0);
}

static void edit_camera(Engine *e, const ViewMessage *m) {
  ViewCamera next;
  vlError error = {0};
  const char *warning = NULL;
  if (camera_edit(&e->wanted.camera, m, &next, &warning, &error) != VL_OK) {
    engine_post_state(e, m->client); /* its inputs show the camera as it is */
    engine_refuse(e, m, error.message[0] ? error.message : "refused");
    return;
  }
  engine_take_camera(e, &next, m->change, m->gesture);
  if (warning)
    engine_post(e, m->client, "warning", "message %s", warning);
}

/* Each step is answered with the state, also where there is nothing to step to. */
static void step_to(Engine *e, const ViewMessage *m, uint32_t at) {
  History *h = &e->history;
  e->wanted.change = m->change;
  if (at != h->at) {
    h->at = at;
    h->gesture = 0;
    show_camera(e, &h->cameras[at]);
  }
  engine_post_state(e, 0);
}

static void undo(Engine *e, const ViewMessage *m) {
  const uint32_t at = e->history.at;
  step_to(e, m, at > 0 ? at - 1 : at);
}

static void redo(Engine *e, const ViewMessage *m) {
  const History *h = &e->history;
  step_to(e, m, h->at + 1 < h->count ? h->at + 1 : h->at);
}

static void reset(Engine *e, const ViewMessage *m) {
  engine_take_camera(e, &e->scene_camera, m->change, 0);
}

/* ---- settings ---------------------------------------------------------------------------- */

/* The film of the mode "camera" is of another kind: it begins anew. */
static void take_channel(Engine *e, uint32_t channel) {
  e->wanted.generation += (e->wanted.channel == CHANNEL_CAMERA) != (channel == CHANNEL_CAMERA);
  e->wanted.channel = channel;
}

static bool set_channel(Engine *e, const char *name) {
  if (strcmp(name, "image") == 0 || strcmp(name, "camera") == 0) {
    take_channel(e, name[0] == 'c' ? CHANNEL_CAMERA : 0);
    return true;
  }
  for (uint32_t i = 0; i < VL_CHANNEL_COUNT; i++)
    if (state_shows_channel(i) && strcmp(name, vl_channel_name(i)) == 0) {
      take_channel(e, i + 1);
      return true;
    }
  return false;
}

/* Why a channel is refused. */
static const char *channel_refusal(const Engine *e, const char *name) {
  const vlFilmDef *film = &e->model.job.defs->film;
  const bool own_sensor = film->sensor && strcmp(film->sensor, "cie1931") != 0;
  if (strcmp(name, "luminance") == 0 && (own_sensor || film->white_balance != 0))
    return "the luminance cannot be shown: " LUMINANCE_NEEDS;
  const bool camera = strcmp(name, "camera") == 0;
  if (camera && !has_camera_mode(e))
    return "this page has no sensor";
  if (camera && e->model.job.defs->build.color == VL_COLOR_RGB)
    return "a sensor counts photons of each wavelength, but the scene is rendered in RGB, which "
           "has no spectrum: start velo view with --color spectral";
  return NULL;
}

static bool set_crop(Engine *e, const uint32_t crop[4]) {
  const vlCamera *c = &e->wanted.camera.made;
  if (!crop[2]) {
    crop_set(e->wanted.crop, 0, 0, c->width, c->height);
    return true;
  }
  if (crop[0] >= crop[2] || crop[1] >= crop[3] || crop[2] > c->width || crop[3] > c->height)
    return false;
  memcpy(e->wanted.crop, crop, sizeof e->wanted.crop);
  return true;
}

static void change_settings(Engine *e, const ViewMessage *m) {
  const bool has_channel = m->given & MEMBER_CHANNEL;
  const bool has_crop = m->given & MEMBER_CROP;
  const bool has_denoise = m->given & MEMBER_DENOISE;
  const char *refusal = has_channel ? channel_refusal(e, m->channel) : NULL;
  if (refusal)
    engine_refuse(e, m, refusal);
  else if (has_channel && !set_channel(e, m->channel))
    engine_refuse(e, m, "there is no such channel");
  if (has_crop) {
    if (set_crop(e, m->crop))
      e->wanted.generation++;
    else
      engine_refuse(e, m, "the rectangle is not inside the image");
  }
  if (m->mark) {
    e->wanted.mark = e->wanted.camera.made;
    e->wanted.generation += e->wanted.channel == CHANNEL_FLOW;
  }
  if (has_denoise && m->denoise && (e->def.lecture || e->def.stepwise))
    engine_refuse(e, m, "this page has no denoised preview");
  else if (has_denoise)
    e->wanted.denoise = m->denoise;
  if (m->given & MEMBER_SPP)
    e->wanted.spp = m->spp;
  if (m->given & MEMBER_PAUSED)
    e->wanted.paused = m->paused;
  if (has_crop || has_channel || has_denoise || m->mark || e->wanted.paused)
    engine_interrupt(e);
  e->wanted.change = m->change ? m->change : e->wanted.change;
  engine_post_state(e, 0);
}

/* The camera's back: light that is there already is exposed anew. */
static void edit_sensor(Engine *e, const ViewMessage *m) {
  vlError error = {0};
  if (!has_camera_mode(e)) {
    engine_refuse(e, m, "this page has no sensor");
  } else if (sensor_edit(&e->wanted.sensor, &e->sensors, m, &e->wanted.sensor, &error) !=
             VL_OK) {
    engine_post_state(e, m->client); /* its inputs show the sensor as it is */
    engine_refuse(e, m, error.message);
  } else {
    e->wanted.sensor_edits++;
    e->wanted.change = m->change ? m->change : e->wanted.change;
    if (e->wanted.channel == CHANNEL_CAMERA)
      engine_interrupt(e);
    engine_post_state(e, 0);
  }
}

static void choose_scene(Engine *e, const ViewMessage *m) {
  const char *scene = e->def.lecture ? lecture_scene(m->name) : NULL;
  if (!scene) {
    engine_refuse(
        e, m,
        e->def.lecture ? "the lecture has no such scene" : "this page has one scene only");
    return;
  }
  e->choice.scene = scene;
  e->choice.change = m->change;
}

/* Another time: of an animation that is loaded for it, or of the camera's shutter. */
static void set_time(Engine *e, const ViewMessage *m) {
  vlError error = {0};
  ViewCamera next;
  if (e->model.seconds > 0 && e->threads[THREAD_WATCH].runs) {
    e->time.at = m->at;
    e->time.shutter = m->shutter;
    e->time.change = m->change;
    e->time.given = e->time.due = true;
  } else if (!(engine_time(e).duration > 0)) {
    engine_refuse(e, m, "nothing moves in this scene");
  } else if (camera_set_shutter(&e->wanted.camera, m->at, m->at + m->shutter, &next, &error) !=
             VL_OK) {
    engine_refuse(e, m, error.message);
  } else {
    engine_take_camera(e, &next, m->change, m->gesture);
  }
}

/* Has the command run that was copied last, or ends that run. */
static void verify_command(Engine *e, const ViewMessage *m) {
  if (m->end) {
    e->verify.end = true;
  } else if (!e->threads[THREAD_VERIFY].runs) {
    engine_refuse(e, m, "this page runs no commands");
  } else if (e->def.arguments->folder_count) {
    engine_refuse(e, m, "--sandbox allows no other programs");
  } else if (e->verify.runs) {
    engine_refuse(e, m, "a command is being verified");
  } else if (!e->verify.copied) {
    engine_refuse(e, m, "no command was copied");
  } else {
    e->verify.asked = *m;
    e->verify.next = e->verify.copied; /* another one may be copied before the thread wakes */
    e->verify.copied = NULL;
    e->verify.end = false;
    e->verify.runs = true;
  }
}

/* ---- all messages ------------------------------------------------------------------------ */

enum {
  PIXEL = MEMBER_X | MEMBER_Y,
  LOOK = MEMBER_EXPOSURE | MEMBER_VIEW,
  SETTINGS =
      MEMBER_SPP | MEMBER_PAUSED | MEMBER_CROP | MEMBER_CHANNEL | MEMBER_DENOISE | MEMBER_MARK,
  FILE_TO_SAVE = MEMBER_WHAT | MEMBER_NAME | MEMBER_DIALECT | LOOK,
  PATHS = PIXEL | MEMBER_SAMPLES | MEMBER_SHOW | MEMBER_BY_SAMPLE,
  OVERLAY = MEMBER_BOXES | MEMBER_CURVES | MEMBER_FIELD
};

const MessageType message_types[] = {
    {"seen", MEMBER_SERIAL, MESSAGE_SEEN},
    {"steer", 0, MESSAGE_STEER},
    {"camera", MEMBER_SET | MEMBER_GESTURE, MESSAGE_AT_ONCE, edit_camera},
    {"undo", 0, MESSAGE_AT_ONCE, undo},
    {"redo", 0, MESSAGE_AT_ONCE, redo},
    {"reset", 0, MESSAGE_AT_ONCE, reset},
    {"settings", SETTINGS, MESSAGE_AT_ONCE, change_settings},
    {"sensor", MEMBER_SET, MESSAGE_AT_ONCE, edit_sensor},
    {"time", MEMBER_AT | MEMBER_SHUTTER | MEMBER_GESTURE, MESSAGE_AT_ONCE, set_time},
    {"scene", MEMBER_NAME, MESSAGE_AT_ONCE, choose_scene},
    {"verify", MEMBER_END, MESSAGE_AT_ONCE, verify_command},
    {"paths", PATHS, MESSAGE_AT_ONCE, engine_add_trace, .harmless = true},
    {"save", FILE_TO_SAVE, MESSAGE_SAVES, engine_save},
    {"command", LOOK, MESSAGE_SAVES, engine_command},
    {"focus", PIXEL, MESSAGE_ASKS, engine_focus},
    {"pick", PIXEL, MESSAGE_ASKS, engine_pick, .harmless = true},
    {"overlay", OVERLAY, MESSAGE_ASKS, engine_overlay, .harmless = true},
    {"outline", MEMBER_SET, MESSAGE_ASKS, engine_outline, .harmless = true},
    {"cameras", 0, MESSAGE_ASKS, engine_cameras, .harmless = true},
    {"outside", MEMBER_SIZE | MEMBER_EXPOSURE | MEMBER_SET, MESSAGE_ASKS, engine_outside,
     .harmless = true},
    {.name = NULL}};
_Static_assert(LENGTH(message_types) <= MESSAGE_TYPES, "too many types");

void engine_message(void *user, bool steers, const ViewMessage *m) {
  Engine *e = user;
  engine_lock(e);
  if (!steers && !m->type->harmless)
    engine_refuse(e, m, "another page steers");
  else if (m->type->place == MESSAGE_AT_ONCE)
    m->type->answer(e, m);
  else if (m->type->place == MESSAGE_ASKS)
    engine_add_task(e, m, &e->questions);
  else if (e->def.lecture || e->def.stepwise)
    engine_refuse(e, m, "this page saves nothing");
  else
    engine_add_task(e, m, &e->tasks);
  pthread_cond_broadcast(&e->wake);
  engine_unlock(e);
}
