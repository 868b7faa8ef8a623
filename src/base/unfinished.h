/* base/unfinished.h: the files of a context that it removes itself when it is done with them:
 * locks and temporary files with names. vl_remove_unfinished (velo/film.h) removes them where a
 * signal ends the process first. */
#ifndef BASE_UNFINISHED_H
#define BASE_UNFINISHED_H

#include <stdatomic.h>

#include "velo/base.h"

/* Removes the file if it is this process' own. descriptor: of the file; it may be another
 * process' where it was opened only for this. Calls only async-signal-safe functions; the
 * process ends afterwards, so nothing is closed. */
typedef void vlUnfinishedFn(int descriptor, const char *path);

typedef struct vlUnfinished {
  atomic_int state;
  atomic_int descriptor; /* set as soon as the file is open */
  vlUnfinishedFn *remove;
  struct vlUnfinished *next;
  char path[4096 + 64];
} vlUnfinished;

/* Elements stay in the list as long as the context, so that a signal handler can walk along it
 * at any time. Their memory is not that of the caller's objects: it is not counted. */
typedef struct vlUnfinishedList {
  _Atomic(vlUnfinished *) first;
  vlAllocator allocator;
} vlUnfinishedList;

/* The list of a context; in context.c. */
vlUnfinishedList *vl_context_unfinished(vlContext *context);

/* Notes a file before it is made. Null: no memory. Any thread. */
vlUnfinished *vl_unfinished_add(vlUnfinishedList *list, const char *path, int descriptor,
                                vlUnfinishedFn *remove);
/* After the file is gone or has its own name, and before its descriptor is closed. Null is
 * allowed. Where a signal handler is removing the file already, it waits for the process' end.
 * errno stays. */
void vl_unfinished_drop(vlUnfinished *file);
/* Removes the files of the list. Async-signal-safe. */
void vl_unfinished_remove(vlUnfinishedList *list);
void vl_unfinished_free(vlUnfinishedList *list);

#endif
