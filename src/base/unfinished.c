/* base/unfinished.c: see unfinished.h. */
#include "base/unfinished.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

/* Only who changes FILLED to another state may touch the file after that: its writer, or the
 * signal handler. */
enum { FREE, TAKEN, FILLED, REMOVED };

static bool change(vlUnfinished *file, int from, int to) {
  return atomic_compare_exchange_strong(&file->state, &from, to);
}

/* A free element of the list, or a new one. */
static vlUnfinished *take(vlUnfinishedList *list) {
  vlUnfinished *file = atomic_load(&list->first);
  while (file && !change(file, FREE, TAKEN))
    file = file->next;
  if (file)
    return file;
  file = list->allocator.allocate(list->allocator.user, sizeof *file);
  if (!file)
    return NULL;
  atomic_init(&file->state, TAKEN);
  atomic_init(&file->descriptor, -1);
  file->next = atomic_load(&list->first);
  while (!atomic_compare_exchange_weak(&list->first, &file->next, file)) {
  }
  return file;
}

vlUnfinished *vl_unfinished_add(vlUnfinishedList *list, const char *path, int descriptor,
                                vlUnfinishedFn *remove) {
  vlUnfinished *file = take(list);
  if (!file)
    return NULL;
  snprintf(file->path, sizeof file->path, "%s", path);
  atomic_store(&file->descriptor, descriptor);
  file->remove = remove;
  atomic_store(&file->state, FILLED);
  return file;
}

void vl_unfinished_drop(vlUnfinished *file) {
  if (!file || change(file, FILLED, FREE))
    return;
  for (;;)
    pause();
}

void vl_unfinished_remove(vlUnfinishedList *list) {
  for (vlUnfinished *file = atomic_load(&list->first); file; file = file->next) {
    if (!change(file, FILLED, REMOVED))
      continue;
    int descriptor = atomic_load(&file->descriptor);
    if (descriptor < 0)
      descriptor = open(file->path, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor >= 0)
      file->remove(descriptor, file->path);
  }
}

void vl_unfinished_free(vlUnfinishedList *list) {
  for (vlUnfinished *file = atomic_exchange(&list->first, NULL), *next; file; file = next) {
    next = file->next;
    list->allocator.release(list->allocator.user, file);
  }
}
