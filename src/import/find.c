/* import/find.c: see find.h. */
#include "import/find.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/context.h"
#include "base/text.h"

static bool exists(vlContext *context, const char *path) {
  struct stat info;
  return vl_context_allows(context, path) && stat(path, &info) == 0;
}

/* Looks in the folder of the file `base`. */
static bool beside(vlContext *context, const char *base, const char *name, char *path,
                   size_t size) {
  char other[4096];
  if (!base || !vl_path_join(base, name, other, sizeof other) || !exists(context, other) ||
      strlen(other) >= size)
    return false;
  memcpy(path, other, strlen(other) + 1);
  return true;
}

static bool on_path(vlContext *context, const char *folders, const char *name, char *path,
                    size_t size) {
  char base[4096];
  while (folders && *folders) {
    size_t length = strcspn(folders, ":");
    int n = snprintf(base, sizeof base, "%.*s/.", (int)length, folders);
    if (length && n > 0 && (size_t)n < sizeof base && beside(context, base, name, path, size))
      return true;
    folders += length + (folders[length] == ':');
  }
  return false;
}

vlFound vl_find_file(vlContext *context, const char *naming, const char *first,
                     const char *search_path, const char *name, char *path, size_t size) {
  if (!vl_path_join(naming, name, path, size))
    return VL_FOUND_TOO_LONG;
  if (exists(context, path) || name[0] == '/')
    return exists(context, path) ? VL_FOUND : VL_FOUND_NOT;
  if (beside(context, first, name, path, size) ||
      on_path(context, search_path, name, path, size))
    return VL_FOUND;
  return beside(context, "./.", name, path, size) ? VL_FOUND_CURRENT : VL_FOUND_NOT;
}
