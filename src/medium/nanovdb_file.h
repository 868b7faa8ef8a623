/* medium/nanovdb_file.h: interface between nanovdb_file.c, which finds a grid in a file, and
 * nanovdb_grid.c, which converts the grid. */
#ifndef MEDIUM_NANOVDB_FILE_H
#define MEDIUM_NANOVDB_FILE_H

#include "base/context.h"

/* An unpacked grid in a memory block of the context, aligned to 8 bytes. words is null if the
 * file has no grid of that name. */
typedef struct vlNanoGrid {
  uint64_t *words;
  size_t size; /* bytes */
} vlNanoGrid;
vlResult vl_nanovdb_find(vlContext *context, const char *path, const char *name,
                         vlNanoGrid *grid, vlError *error);

#endif
