/* import/find.h: finds the files that a scene file names by a relative path. */
#ifndef IMPORT_FIND_H
#define IMPORT_FIND_H

#include "velo/base.h"

typedef enum vlFound {
  VL_FOUND, /* beside a file of the scene, in a folder of the search path, or absolute */
  VL_FOUND_CURRENT, /* in the current folder only */
  VL_FOUND_NOT,     /* path is where the file should be */
  VL_FOUND_TOO_LONG /* the path does not fit */
} vlFound;

/* Writes the path of the file `name`: in the folder of the file `naming`, in that of the
 * scene's first file, in the folders of the search path (separated by ':'), in the current
 * folder. The first that exists counts; a file outside of the context's sandbox does not. first
 * and search_path may be null. */
vlFound vl_find_file(vlContext *context, const char *naming, const char *first,
                     const char *search_path, const char *name, char *path, size_t size);

#endif
