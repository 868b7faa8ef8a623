/* world/medium/nanovdb.h: between nanovdb_file.c, which finds a grid in a file, and nanovdb.c, which takes it apart. */
#ifndef WORLD_MEDIUM_NANOVDB_H
#define WORLD_MEDIUM_NANOVDB_H

#include "base/context.h"

/* The grid of that name, unpacked, 8-byte aligned; a block of the context; null: the file has none of that name. */
typedef struct vlNanoGrid {
  uint64_t *words;
  size_t size; /* bytes */
} vlNanoGrid;
vlResult vl_nanovdb_find(vlContext *context, const char *path, const char *name, vlNanoGrid *grid, vlError *error);

#endif
