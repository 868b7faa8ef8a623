/* view/watch.h: watches the files that a scene was made of (inotify). A change of a file, or
 * its replacement as editors do it, is noticed. */
#ifndef APP_VIEW_WATCH_H
#define APP_VIEW_WATCH_H

#include <stdbool.h>

#include "view/model.h"

typedef struct Watch Watch;
/* Null: the system gives no inotify. */
Watch *watch_create(void);
void watch_destroy(Watch *watch);
/* From now on watches these files. */
void watch_files(Watch *watch, const FileList *list);
/* Waits until a file changed and nothing has changed for a moment, at most `seconds`. any:
 * whatever else changes in the same folders counts, too. Returns whether something changed. */
bool watch_wait(Watch *watch, double seconds, bool any);

#endif
