/* view/web_files.h: the files of the pages, which the build puts into the program: web/, the
 * lecture and its scenes. */
#ifndef APP_VIEW_WEB_FILES_H
#define APP_VIEW_WEB_FILES_H

#include <stddef.h>

typedef struct WebFile {
  const char *name, *type; /* "app.js", "text/javascript; charset=utf-8" */
  const unsigned char *data;
  size_t size; /* a zero follows */
} WebFile;

/* The last has no name. */
extern const WebFile web_files[];
/* The file of this name; null: there is none. */
const WebFile *web_file_find(const char *name);

#endif
