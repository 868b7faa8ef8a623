/* view/engine_messages.c: the engine's side of the server: greets pages and applies their
 * messages. All of it runs on the server's thread; nothing here renders. */
#include <stdlib.h>
#include <string.h>

#include "velo/channels.h"
#include "view/engine_status.h"
#include "view/lecture.h"

/* The lecture has no room for the mode "camera", and velo in the page no memory. */
static bool has_camera_mode(const Engine *e) {
  return !e->def.lecture && !e->def.stepwise;
}

static char *engine_state(const Engine *e) {
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
  return state_text(&state);
}

void engine_post_state(Engine *e, uint32_t client) {
  char *text = engine_state(e);
  if (text)
    server_post(e->server, client, text);
  free(text);
}

void engine_greet(void *user, uint32_t client) {
  Engine *e = user;
  char *lists = state_lists(has_camera_mode(e) ? &e->sensors : NULL);
  if (lists)
    server_post(e->server, client, lists);
  free(lists);
  engine_lock(e);
  engine_post_state(e, client);
  if (e->last_status)
    server_post(e->server, client, e->last_status);
  if (e->last_exposure)
    server_post(e->server, client, e->last_exposure);
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

static void post_refusal(Engine *e, uint32_t client, const ViewMessage *m, const char *why) {
  engine_post(e, client, "refused", "change %u, id %u, field %s, message %s", m->change, m->id,
              m->field_count ? m->fields[0].name : "", why);
}

static void show_camera(Engine *e, const ViewCamera *camera) {
  e->wanted.camera = *camera;
  e->wanted.generation++;
  engine_interrupt(e);
  engine_drop_traces(e, 0, "the camera moved");
}

void engine_remember(Engine *e, const ViewCamera *camera, uint32_t gesture) {
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

/* The camera that a message makes. */
static void take_camera(Engine *e, const ViewMessage *m, const ViewCamera *next) {
  e->wanted.change = m->change;
  engine_remember(e, next, m->gesture);
  show_camera(e, next);
  engine_post_state(e, 0);
}

static void edit_camera(Engine *e, uint32_t client, const ViewMessage *m) {
  ViewCamera next;
  vlError error = {0};
  const char *warning = NULL;
  if (camera_edit(&e->wanted.camera, m, &next, &warning, &error) != VL_OK) {
    engine_post_state(e, client); /* its inputs show the camera as it is */
    post_refusal(e, client, m, error.message[0] ? error.message : "refused");
    return;
  }
  take_camera(e, m, &next);
  if (warning)
    engine_post(e, client, "warning", "message %s", warning);
}

/* Each is answered with the state, also where there is nothing to step to. */
static void step_history(Engine *e, const ViewMessage *m) {
  History *h = &e->history;
  const uint32_t before = h->at;
  if (m->kind == MESSAGE_RESET)
    engine_remember(e, &e->scene_camera, 0);
  else if (m->kind == MESSAGE_UNDO && h->at > 0)
    h->at--;
  else if (m->kind == MESSAGE_REDO && h->at + 1 < h->count)
    h->at++;
  e->wanted.change = m->change;
  if (m->kind == MESSAGE_RESET || h->at != before) {
    h->gesture = 0;
    show_camera(e, &h->cameras[h->at]);
  }
  engine_post_state(e, 0);
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
  const uint32_t whole[4] = {0, 0, c->width, c->height};
  if (!crop[2]) {
    memcpy(e->wanted.crop, whole, sizeof whole);
    return true;
  }
  if (crop[0] >= crop[2] || crop[1] >= crop[3] || crop[2] > c->width || crop[3] > c->height)
    return false;
  memcpy(e->wanted.crop, crop, sizeof whole);
  return true;
}

static void change_settings(Engine *e, uint32_t client, const ViewMessage *m) {
  const char *refusal = m->has_channel ? channel_refusal(e, m->channel) : NULL;
  if (refusal)
    post_refusal(e, client, m, refusal);
  else if (m->has_channel && !set_channel(e, m->channel))
    post_refusal(e, client, m, "there is no such channel");
  if (m->has_crop) {
    if (set_crop(e, m->crop))
      e->wanted.generation++;
    else
      post_refusal(e, client, m, "the rectangle is not inside the image");
  }
  if (m->mark) {
    e->wanted.mark = e->wanted.camera.made;
    e->wanted.generation += e->wanted.channel == CHANNEL_FLOW;
  }
  if (m->has_denoise && m->denoise && (e->def.lecture || e->def.stepwise))
    post_refusal(e, client, m, "this page has no denoised preview");
  else if (m->has_denoise)
    e->wanted.denoise = m->denoise;
  if (m->has_spp)
    e->wanted.spp = m->spp;
  if (m->has_paused)
    e->wanted.paused = m->paused;
  if (m->has_crop || m->has_channel || m->has_denoise || m->mark || e->wanted.paused)
    engine_interrupt(e);
  e->wanted.change = m->change ? m->change : e->wanted.change;
  engine_post_state(e, 0);
}

/* The camera's back: light that is there already is exposed anew. */
static void edit_sensor(Engine *e, uint32_t client, const ViewMessage *m) {
  vlError error = {0};
  if (!has_camera_mode(e)) {
    post_refusal(e, client, m, "this page has no sensor");
  } else if (sensor_edit(&e->wanted.sensor, &e->sensors, m, &e->wanted.sensor, &error) !=
             VL_OK) {
    engine_post_state(e, client); /* its inputs show the sensor as it is */
    post_refusal(e, client, m, error.message);
  } else {
    e->wanted.sensor_edits++;
    e->wanted.change = m->change ? m->change : e->wanted.change;
    if (e->wanted.channel == CHANNEL_CAMERA)
      engine_interrupt(e);
    engine_post_state(e, 0);
  }
}

static void choose_scene(Engine *e, uint32_t client, const ViewMessage *m) {
  const char *scene = e->def.lecture ? lecture_scene(m->name) : NULL;
  if (!scene) {
    post_refusal(
        e, client, m,
        e->def.lecture ? "the lecture has no such scene" : "this page has one scene only");
    return;
  }
  e->chosen = scene;
  e->chosen_change = m->change;
}

/* Another time: of an animation that is loaded for it, or of the camera's shutter. */
static void set_time(Engine *e, uint32_t client, const ViewMessage *m) {
  vlError error = {0};
  ViewCamera next;
  if (e->model.seconds > 0 && e->watching) {
    e->at = m->at;
    e->shutter = m->shutter;
    e->time_change = m->change;
    e->has_time = e->time_due = true;
  } else if (!(engine_time(e).duration > 0)) {
    post_refusal(e, client, m, "nothing moves in this scene");
  } else if (camera_set_shutter(&e->wanted.camera, m->at, m->at + m->shutter, &next, &error) !=
             VL_OK) {
    post_refusal(e, client, m, error.message);
  } else {
    take_camera(e, m, &next);
  }
}

/* Adds a message to a list of tasks. */
static void add_task(Engine *e, uint32_t client, const ViewMessage *m, Task *tasks,
                     uint32_t *count) {
  if (*count == MAX_TASKS) {
    post_refusal(e, client, m, "too much at once");
    return;
  }
  tasks[(*count)++] = (Task){.client = client, .message = *m};
}

/* Has the command run that was copied last, or ends that run. */
static void verify_command(Engine *e, uint32_t client, const ViewMessage *m) {
  if (m->end) {
    e->verify_end = true;
  } else if (!e->verifies) {
    post_refusal(e, client, m, "this page runs no commands");
  } else if (e->def.arguments->folder_count) {
    post_refusal(e, client, m, "--sandbox allows no other programs");
  } else if (e->verifying) {
    post_refusal(e, client, m, "a command is being verified");
  } else if (!e->copied) {
    post_refusal(e, client, m, "no command was copied");
  } else {
    e->verification = (Task){.client = client, .message = *m};
    e->verify_end = false;
    e->verifying = true;
  }
}

/* Messages that change nothing that others see. */
static bool is_harmless(MessageKind kind) {
  return kind == MESSAGE_PICK || kind == MESSAGE_OVERLAY || kind == MESSAGE_OUTLINE ||
         kind == MESSAGE_OUTSIDE || kind == MESSAGE_PATHS || kind == MESSAGE_CAMERAS;
}

void engine_message(void *user, uint32_t client, bool steers, const ViewMessage *m) {
  Engine *e = user;
  engine_lock(e);
  if (!steers && !is_harmless(m->kind)) {
    post_refusal(e, client, m, "another page steers");
  } else {
    switch (m->kind) {
      case MESSAGE_CAMERA:
        edit_camera(e, client, m);
        break;
      case MESSAGE_UNDO:
      case MESSAGE_REDO:
      case MESSAGE_RESET:
        step_history(e, m);
        break;
      case MESSAGE_SETTINGS:
        change_settings(e, client, m);
        break;
      case MESSAGE_SENSOR:
        edit_sensor(e, client, m);
        break;
      case MESSAGE_SAVE:
      case MESSAGE_COMMAND:
        if (e->def.lecture || e->def.stepwise)
          post_refusal(e, client, m, "this page saves nothing");
        else
          add_task(e, client, m, e->tasks, &e->task_count);
        break;
      case MESSAGE_VERIFY:
        verify_command(e, client, m);
        break;
      case MESSAGE_SCENE:
        choose_scene(e, client, m);
        break;
      case MESSAGE_TIME:
        set_time(e, client, m);
        break;
      case MESSAGE_PATHS:
        engine_add_trace(e, client, m);
        break;
      case MESSAGE_PICK:
      case MESSAGE_FOCUS:
      case MESSAGE_OUTLINE:
      case MESSAGE_OUTSIDE:
      case MESSAGE_CAMERAS:
      case MESSAGE_OVERLAY:
        add_task(e, client, m, e->questions, &e->question_count);
        break;
      case MESSAGE_SEEN:
      case MESSAGE_STEER:
        break; /* the server's own */
    }
  }
  pthread_cond_broadcast(&e->wake);
  engine_unlock(e);
}
