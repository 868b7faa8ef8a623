/* view/file_list.h: the files that a scene was made of. */
#ifndef APP_VIEW_FILE_LIST_H
#define APP_VIEW_FILE_LIST_H

#include <stdint.h>

/* Paths of files, each once. */
typedef struct FileList {
  char **paths;
  uint32_t count;
} FileList;
/* Adds a path unless the list has it, or there is no memory. */
void file_list_add(FileList *list, const char *path);
void file_list_free(FileList *list);

#endif
