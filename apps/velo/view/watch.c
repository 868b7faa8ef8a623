/* view/watch.c: see watch.h. The folders are watched, since an editor may replace a file by
 * another one. */
#include "view/watch.h"

#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <unistd.h>

enum { CALM_MILLISECONDS = 80 };

struct Watch {
  int fd;
  FileList files;
  uint32_t folder_count;
  int *folders; /* watch descriptors, one for each file; folders occur several times */
};

Watch *watch_create(void) {
  Watch *watch = calloc(1, sizeof *watch);
  if (!watch)
    return NULL;
  watch->fd = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (watch->fd >= 0)
    return watch;
  free(watch);
  return NULL;
}

void watch_destroy(Watch *watch) {
  if (!watch)
    return;
  close(watch->fd);
  file_list_free(&watch->files);
  free(watch->folders);
  free(watch);
}

static const char *file_name(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

static int watch_folder(int fd, const char *path) {
  const char *name = file_name(path);
  char *folder = name == path ? strdup(".")
                              : strndup(path, name - path > 1 ? (size_t)(name - path - 1) : 1);
  int descriptor = folder ? inotify_add_watch(fd, folder, IN_CLOSE_WRITE | IN_MOVED_TO) : -1;
  free(folder);
  return descriptor;
}

void watch_files(Watch *watch, const FileList *list) {
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
        (any || (event->len && strcmp(file_name(watch->files.paths[i]), event->name) == 0)))
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

bool watch_wait(Watch *watch, double seconds, bool any) {
  struct pollfd wait = {.fd = watch->fd, .events = POLLIN};
  if (poll(&wait, 1, (int)(1000 * seconds)) <= 0 || !read_events(watch, any))
    return false;
  while (poll(&wait, 1, CALM_MILLISECONDS) > 0)
    read_events(watch, any);
  return true;
}
