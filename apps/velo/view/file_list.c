/* view/file_list.c: see file_list.h. */
#include "view/file_list.h"

#include <stdlib.h>
#include <string.h>

void file_list_add(FileList *list, const char *path) {
  for (uint32_t i = 0; i < list->count; i++)
    if (strcmp(list->paths[i], path) == 0)
      return;
  char **larger = realloc(list->paths, (list->count + 1) * sizeof *larger);
  if (!larger)
    return;
  list->paths = larger;
  larger[list->count] = strdup(path);
  if (larger[list->count])
    list->count++;
}

void file_list_free(FileList *list) {
  for (uint32_t i = 0; i < list->count; i++)
    free(list->paths[i]);
  free(list->paths);
  *list = (FileList){.count = 0};
}
