/* view/engine_reload.c: the render goes on with a world that was loaded anew: after a change of
 * the scene's files (engine_watch.c), or because a page chose another of the lecture's scenes,
 * which are loaded here. */
#include <stdlib.h>
#include <string.h>

#include "cli/report.h"
#include "view/camera_keep.h"
#include "view/engine_status.h"

void engine_report(void *user, const char *kind, const vlError *what) {
  Engine *e = user;
  if (kind && strcmp(kind, "warning") != 0)
    return;
  Json *json = json_text_begin(kind ? "warning" : "error");
  if (!json)
    return;
  if (what->file[0])
    json_text(json, "file", what->file);
  if (what->line)
    json_integer(json, "line", what->line);
  if (what->column)
    json_integer(json, "column", what->column);
  json_text(json, "message", what->message);
  json_text_post(json, e->server, 0);
}

void engine_offer(Engine *e, Model *model, const char *path, uint32_t change) {
  engine_lock(e);
  Model *unused = e->next;
  e->next = model;
  if (path)
    e->next_path = path;
  e->next_change = change;
  engine_interrupt(e);
  if (!path)
    engine_drop_traces(e, 0, "the scene changed");
  pthread_cond_broadcast(&e->wake);
  engine_unlock(e);
  if (unused)
    model_free(unused);
  free(unused);
}

/* ---- the lecture's scenes ---------------------------------------------------------------- */

bool engine_load_choice(Engine *e) {
  engine_lock(e);
  const char *path = e->quit ? NULL : e->chosen;
  uint32_t change = e->chosen_change;
  e->chosen = NULL;
  engine_unlock(e);
  if (!path)
    return false;
  Model *model = calloc(1, sizeof *model);
  FileList files = {.count = 0};
  report_listen(engine_report, e);
  int status = model ? model_load(e->def.context, path, e->def.arguments, NULL, NULL, e->end,
                                  model, &files)
                     : STATUS_OTHER;
  report_listen(NULL, NULL);
  file_list_free(&files);
  if (status >= 0) {
    free(model);
    return true;
  }
  engine_offer(e, model, path, change);
  return true;
}

/* ---- the render thread ------------------------------------------------------------------- */

/* Goes on with the page's camera and those of its history, if the scene's camera changed in
 * nothing but the size of the image; else all begin with the scene's. before: the scene's
 * camera before; crop, history: of the page. The caller holds the lock. */
static void keep_cameras(Engine *e, const ViewCamera *before, const ViewCamera *shown,
                         const uint32_t crop[4], const History *history) {
  const ViewCamera *now = &e->scene_camera;
  Wanted *w = &e->wanted;
  if (!camera_keep(before, now, shown, &w->camera)) {
    w->camera = *now;
    return;
  }
  if (before->made.width == now->made.width && before->made.height == now->made.height)
    memcpy(w->crop, crop, sizeof w->crop);
  e->history = *history;
  for (uint32_t i = 0; i < e->history.count; i++) {
    ViewCamera *camera = &e->history.cameras[i];
    if (camera_keep(before, now, camera, camera))
      continue;
    e->history.cameras[0] = w->camera; /* one has parts of the old scene */
    e->history.count = 1;
    e->history.at = 0;
  }
}

/* Another time of the animation: the page's camera stays, or follows the file's if the page has
 * not moved it; the settings stay. The caller holds the lock. */
static void follow_cameras(Engine *e, const ViewCamera *before, const ViewCamera *shown,
                           const uint32_t crop[4], const History *history) {
  const bool added = e->model.opening.camera_added;
  const ViewCamera now = e->scene_camera;
  if (!camera_follow(before, &now, shown, added, &e->wanted.camera))
    return;
  memcpy(e->wanted.crop, crop, sizeof e->wanted.crop);
  e->history = *history;
  for (uint32_t i = 0; i < e->history.count; i++)
    camera_follow(before, &now, &e->history.cameras[i], added, &e->history.cameras[i]);
}

bool engine_swap_model(Engine *e) {
  static History history; /* the render thread alone uses it */
  engine_lock(e);
  Model *next = e->next;
  engine_unlock(e);
  if (!next)
    return false;
  pthread_rwlock_wrlock(&e->model_lock);
  engine_lock(e);
  next = e->next; /* another load may have replaced it */
  e->next = NULL;
  Model old = e->model;
  const ViewCamera before = e->scene_camera, shown = e->wanted.camera;
  uint32_t crop[4], spp = e->wanted.spp, old_spp = old.job.defs->render.spp;
  memcpy(crop, e->wanted.crop, sizeof crop);
  e->model = *next;
  bool other = e->next_path != NULL;
  if (other) {
    e->def.path = e->next_path;
    e->next_path = NULL;
    e->wanted.change = e->next_change;
    e->wanted.channel = 0;
    e->wanted.paused = false;
  }
  history = e->history;
  const bool timed = e->model.timed;
  if (timed)
    e->wanted.change = e->next_change;
  const bool taken = engine_take_model(e) < 0;
  if (taken && timed)
    follow_cameras(e, &before, &shown, crop, &history);
  else if (taken && !other)
    keep_cameras(e, &before, &shown, crop, &history);
  if ((spp != old_spp || timed) && !other)
    e->wanted.spp = spp;
  engine_post_state(e, 0);
  engine_unlock(e);
  pthread_rwlock_unlock(&e->model_lock);
  vl_film_destroy(e->film);
  e->film = NULL;
  engine_drop_successor(e);
  engine_warp_forget(e);
  if (!timed)
    e->pixel_seconds = e->coarse_seconds = e->channel_seconds = 0;
  model_free(&old);
  free(next);
  return true;
}
