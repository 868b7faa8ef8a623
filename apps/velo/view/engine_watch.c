/* view/engine_watch.c: watches the scene's files. When one changed, the scene is loaded in the
 * background, and the render thread goes on with the new world; when it cannot be loaded, the
 * old image stays and the error is shown. */
#include <stdlib.h>

#include "cli/report.h"
#include "view/engine_status.h"
#include "view/watch.h"

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
  report_listen(engine_report, e);
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
