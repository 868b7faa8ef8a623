/* view/engine_watch.c: watches the scene's files. When one changed, the scene is loaded in the
 * background, and the render thread goes on with the new world; when it cannot be loaded, the
 * old image stays and the error is shown. */
#include <stdlib.h>

#include "cli/report.h"
#include "view/engine_status.h"
#include "view/watch.h"

static void post(Engine *e, const char *type) {
  Json *json = json_text_begin(type);
  if (json)
    json_text_post(json, e->server, 0);
}

/* Loads the scene again, because a file changed or, `timed`, because a page asks for another
 * time of the animation. Returns whether it could be loaded. */
static bool load_again(Engine *e, Watch *watch, bool timed) {
  Model *model = calloc(1, sizeof *model);
  if (!model)
    return false;
  if (!timed)
    post(e, "loading");
  engine_lock(e);
  uint32_t load = ++e->loads;
  ModelTime time = {e->at, e->shutter, e->model.exposure};
  const bool at = e->has_time;
  const uint32_t change = e->time_change;
  e->time_due = false;
  engine_unlock(e);
  report_listen(engine_report, e);
  pthread_rwlock_rdlock(&e->model_lock); /* the previous world stays */
  int status = model_load(e->def.context, e->def.path, e->def.arguments, at ? &time : NULL,
                          e->model.world, e->end, model, &e->files);
  pthread_rwlock_unlock(&e->model_lock);
  report_listen(NULL, NULL);
  watch_files(watch, &e->files);
  if (status >= 0) {
    free(model);
    return false;
  }
  model->load = load;
  model->timed = timed;
  if (!timed)
    post(e, "loaded");
  engine_offer(e, model, NULL, change);
  return true;
}

static bool ends(Engine *e) {
  engine_lock(e);
  bool quit = e->quit;
  engine_unlock(e);
  return quit;
}

static double model_seconds(Engine *e) {
  engine_lock(e);
  double seconds = e->model.seconds;
  engine_unlock(e);
  return seconds;
}

static bool time_is_due(Engine *e) {
  engine_lock(e);
  bool due = e->time_due;
  engine_unlock(e);
  return due;
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
  while (!ends(e)) {
    if (time_is_due(e))
      good = load_again(e, watch, true);
    else if (watch_wait(watch, model_seconds(e) > 0 ? 0.01 : 0.1, !good) && !ends(e))
      good = load_again(e, watch, false);
  }
  watch_destroy(watch);
  return NULL;
}
