/* view/engine_reload.c: watches the scene's files. When one changed, the scene is loaded in the
 * background, and the render thread goes on with the new world; when it cannot be loaded, the
 * old image stays and the error is shown. In the same way the lecture's scenes are loaded when
 * a page chooses one. */
#include <stdlib.h>
#include <string.h>

#include "cli/report.h"
#include "view/engine_status.h"

/* Sends errors and warnings of the load to the pages. */
static void on_report(void *user, const char *kind, const vlError *what) {
  Engine *e = user;
  JsonText text;
  if (kind && strcmp(kind, "warning") != 0)
    return;
  if (!json_text_begin(&text, kind ? "warning" : "error"))
    return;
  if (what->file[0])
    json_text(&text.json, "file", what->file);
  if (what->line)
    json_integer(&text.json, "line", what->line);
  if (what->column)
    json_integer(&text.json, "column", what->column);
  json_text(&text.json, "message", what->message);
  json_text_post(&text, e->server, 0);
}

static void post(Engine *e, const char *type) {
  JsonText text;
  if (json_text_begin(&text, type))
    json_text_post(&text, e->server, 0);
}

/* Loads the scene again. Returns whether it could be loaded. */
static bool load_again(Engine *e, Watch *watch) {
  Model *model = calloc(1, sizeof *model);
  if (!model)
    return false;
  post(e, "loading");
  pthread_mutex_lock(&e->lock);
  uint32_t load = ++e->loads;
  pthread_mutex_unlock(&e->lock);
  report_listen(on_report, e);
  pthread_rwlock_rdlock(&e->model_lock); /* the previous world stays */
  int status = model_load(e->def.context, e->def.path, e->def.arguments, e->model.world, e->end,
                          model, &e->files);
  pthread_rwlock_unlock(&e->model_lock);
  report_listen(NULL, NULL);
  watch_files(watch, &e->files);
  if (status >= 0) {
    free(model);
    return false;
  }
  model->load = load;
  post(e, "loaded");
  pthread_mutex_lock(&e->lock);
  Model *unused = e->next;
  e->next = model;
  engine_interrupt(e);
  engine_drop_traces(e, 0, "the scene changed");
  pthread_cond_broadcast(&e->wake);
  pthread_mutex_unlock(&e->lock);
  if (unused)
    model_free(unused);
  free(unused);
  return true;
}

static bool ends(Engine *e) {
  pthread_mutex_lock(&e->lock);
  bool quit = e->quit;
  pthread_mutex_unlock(&e->lock);
  return quit;
}

void *engine_watch(void *user) {
  Engine *e = user;
  Watch *watch = watch_create();
  bool good = true;
  if (!watch) {
    report_warning("changes of the scene's files are not noticed: the system gives no inotify");
    return NULL;
  }
  watch_files(watch, &e->files);
  while (!ends(e))
    if (watch_wait(watch, 0.1, !good) && !ends(e))
      good = load_again(e, watch);
  watch_destroy(watch);
  return NULL;
}

/* ---- the lecture's scenes
 * ---------------------------------------------------------------------------------------- */

/* Waits for a choice. Null: the end. */
static const char *wait_for_choice(Engine *e, uint32_t *change) {
  pthread_mutex_lock(&e->lock);
  while (!e->quit && !e->chosen)
    pthread_cond_wait(&e->wake, &e->lock);
  const char *path = e->quit ? NULL : e->chosen;
  *change = e->chosen_change;
  e->chosen = NULL;
  pthread_mutex_unlock(&e->lock);
  return path;
}

void *engine_load_chosen(void *user) {
  Engine *e = user;
  uint32_t change;
  report_listen(on_report, e);
  for (const char *path; (path = wait_for_choice(e, &change));) {
    Model *model = calloc(1, sizeof *model);
    FileList files = {.count = 0};
    int status =
        model ? model_load(e->def.context, path, e->def.arguments, NULL, e->end, model, &files)
              : STATUS_OTHER;
    file_list_free(&files);
    if (status >= 0) {
      free(model);
      continue;
    }
    pthread_mutex_lock(&e->lock);
    Model *unused = e->next;
    e->next = model;
    e->next_path = path;
    e->next_change = change;
    engine_interrupt(e);
    pthread_cond_broadcast(&e->wake);
    pthread_mutex_unlock(&e->lock);
    if (unused)
      model_free(unused);
    free(unused);
  }
  report_listen(NULL, NULL);
  return NULL;
}

/* ---- the render thread
 * -------------------------------------------------------------------------------------------
 */

/* Whether two cameras are described by the same numbers. */
static bool same_place(const ViewCamera *a, const ViewCamera *b) {
  const vlCamera *c = &a->made, *d = &b->made;
  return c->projection == d->projection && c->width == d->width && c->height == d->height &&
         c->fx == d->fx && c->fy == d->fy && c->cx == d->cx && c->cy == d->cy &&
         c->lens_radius == d->lens_radius && c->focus_distance == d->focus_distance &&
         memcmp(c->world_from_camera, d->world_from_camera, sizeof c->world_from_camera) == 0 &&
         memcmp(&c->distortion, &d->distortion, sizeof c->distortion) == 0;
}

bool engine_swap_model(Engine *e) {
  pthread_mutex_lock(&e->lock);
  Model *next = e->next;
  pthread_mutex_unlock(&e->lock);
  if (!next)
    return false;
  pthread_rwlock_wrlock(&e->model_lock);
  pthread_mutex_lock(&e->lock);
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
  bool taken = engine_take_model(e) < 0,
       sized = shown.made.width == e->scene_camera.made.width &&
               shown.made.height == e->scene_camera.made.height;
  /* the page's camera stays unless the file's camera changed, or it has parts of the old scene
   */
  bool keep = !other && sized && same_place(&before, &e->scene_camera) &&
              !shown.def.lens.optics && !shown.def.lens.aperture;
  if (taken && keep) {
    e->wanted.camera = e->history.cameras[0] = shown;
    memcpy(e->wanted.crop, crop, sizeof crop);
  }
  if (spp != old_spp && !other)
    e->wanted.spp = spp;
  engine_post_state(e, 0);
  pthread_mutex_unlock(&e->lock);
  pthread_rwlock_unlock(&e->model_lock);
  vl_film_destroy(e->film);
  e->film = NULL;
  engine_drop_successor(e);
  e->pixel_seconds = e->coarse_seconds = 0;
  model_free(&old);
  free(next);
  return true;
}
