/* view/engine_watch.c: watches the scene's files. When one changed, the scene is loaded in the
 * background, and the render thread goes on with the new world; when it cannot be loaded, the
 * old image stays and the error is shown. */
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "cli/report.h"
#include "cli/text.h"
#include "view/engine_status.h"
#include "view/model.h"

typedef struct Watch Watch;

enum { CALM_MILLISECONDS = 80 };

struct Watch {
  int fd;
  FileList files;
  uint32_t folder_count;
  int *folders; /* watch descriptors, one for each file; folders occur several times */
};

/* Null: the system gives no inotify. */
static Watch *watch_create(void) {
  Watch *watch = calloc(1, sizeof *watch);
  if (!watch)
    return NULL;
  watch->fd = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (watch->fd >= 0)
    return watch;
  free(watch);
  return NULL;
}

static void watch_destroy(Watch *watch) {
  if (!watch)
    return;
  close(watch->fd);
  file_list_free(&watch->files);
  free(watch->folders);
  free(watch);
}

static int watch_folder(int fd, const char *path) {
  const char *name = text_file_name(path);
  char *folder = name == path ? strdup(".")
                              : strndup(path, name - path > 1 ? (size_t)(name - path - 1) : 1);
  int descriptor = folder ? inotify_add_watch(fd, folder, IN_CLOSE_WRITE | IN_MOVED_TO) : -1;
  free(folder);
  return descriptor;
}

/* From now on watches these files. */
static void watch_files(Watch *watch, const FileList *list) {
  int *folders = calloc(list->count + 1, sizeof *folders);
  if (!folders)
    return;
  FileList files = {.count = 0};
  for (uint32_t i = 0; i < list->count; i++)
    file_list_add(&files, list->paths[i]);
  for (uint32_t i = 0; i < files.count; i++)
    folders[i] = watch_folder(watch->fd, files.paths[i]);
  for (uint32_t i = 0; i < watch->folder_count; i++) { /* folders that are watched no longer */
    bool kept = false;
    for (uint32_t k = 0; k < files.count; k++)
      kept |= folders[k] == watch->folders[i];
    if (!kept && watch->folders[i] >= 0)
      inotify_rm_watch(watch->fd, watch->folders[i]);
  }
  file_list_free(&watch->files);
  free(watch->folders);
  watch->files = files;
  watch->folders = folders;
  watch->folder_count = files.count;
}

static bool concerns(const Watch *watch, const struct inotify_event *event, bool any) {
  for (uint32_t i = 0; i < watch->files.count; i++)
    if (watch->folders[i] == event->wd &&
        (any ||
         (event->len && strcmp(text_file_name(watch->files.paths[i]), event->name) == 0)))
      return true;
  return false;
}

/* Reads the events that are there. Returns whether one concerns the files. */
static bool read_events(Watch *watch, bool any) {
  _Alignas(struct inotify_event) char buffer[8192];
  bool changed = false;
  ssize_t size;
  while ((size = read(watch->fd, buffer, sizeof buffer)) > 0)
    for (char *at = buffer; at < buffer + size;) {
      const struct inotify_event *event = (const struct inotify_event *)at;
      changed |= concerns(watch, event, any);
      at += sizeof *event + event->len;
    }
  return changed;
}

/* Waits until a file changed and nothing has changed for a moment, at most `seconds`. any:
 * whatever else changes in the same folders counts, too. Returns whether something changed. */
static bool watch_wait(Watch *watch, double seconds, bool any) {
  struct pollfd wait = {.fd = watch->fd, .events = POLLIN};
  if (poll(&wait, 1, (int)(1000 * seconds)) <= 0 || !read_events(watch, any))
    return false;
  while (poll(&wait, 1, CALM_MILLISECONDS) > 0)
    read_events(watch, any);
  return true;
}

static void post(Engine *e, const char *type) {
  json_text_post(json_text_begin(type), e->server, 0);
}

/* Loads the scene again, because a file changed or, `timed`, because a page asks for another
 * time of the animation. Returns whether it could be loaded. */
static bool load_again(Engine *e, Watch *watch, bool timed) {
  if (!timed)
    post(e, "loading");
  engine_lock(e);
  uint32_t load = ++e->reload.loads;
  ModelTime time = {e->time.at, e->time.shutter, e->model.exposure};
  const bool at = e->time.given;
  const uint32_t change = e->time.change;
  e->time.due = false;
  engine_unlock(e);
  pthread_rwlock_rdlock(&e->model_lock); /* the previous world stays */
  Model *model =
      engine_load(e, e->def.path, at ? &time : NULL, e->model.world, &e->reload.files);
  pthread_rwlock_unlock(&e->model_lock);
  watch_files(watch, &e->reload.files);
  if (!model)
    return false;
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

void *engine_watch(void *user) {
  Engine *e = user;
  Watch *watch = watch_create();
  bool good = true;
  if (!watch) {
    report_warning("changes of the scene's files are not noticed: the system gives no inotify");
    return NULL;
  }
  watch_files(watch, &e->reload.files);
  while (!ends(e)) {
    engine_lock(e);
    const bool due = e->time.due;
    const double max_wait = e->model.seconds > 0 ? 0.01 : 0.1;
    engine_unlock(e);
    if (due)
      good = load_again(e, watch, true);
    else if (watch_wait(watch, max_wait, !good) && !ends(e))
      good = load_again(e, watch, false);
  }
  watch_destroy(watch);
  return NULL;
}
