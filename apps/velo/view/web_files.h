/* view/web_files.h: the files of the page (folder web/), which the build puts into the program. */
#ifndef APP_VIEW_WEB_FILES_H
#define APP_VIEW_WEB_FILES_H

#include <stddef.h>

typedef struct WebFile {
  const char *name, *type; /* "app.js", "text/javascript; charset=utf-8" */
  const unsigned char *data;
  size_t size;
} WebFile;

/* The last has no name. */
extern const WebFile web_files[];

#endif
