/* import/names.h: a small open-addressing hash table from strings to indices. The strings are
 * not owned. */
#ifndef IMPORT_NAMES_H
#define IMPORT_NAMES_H

#include "base/context.h"

typedef struct vlNamed {
  const char *name;
  uint32_t index;
} vlNamed;

typedef struct vlNameTable {
  vlNamed *slots;
  uint32_t capacity, count;
} vlNameTable;
/* Slots of an open-addressing table of so many items: a power of two, at least twice as many.
 */
static inline size_t vl_table_size(size_t items) {
  size_t size = 16;
  while (size < 2 * items)
    size *= 2;
  return size;
}
/* false: out of memory */
bool vl_names_add(vlContext *context, vlNameTable *table, const char *name, uint32_t index);
bool vl_names_find(const vlNameTable *table, const char *name, uint32_t *index);
const char *vl_names_nearest(const vlNameTable *table, const char *name);

/* The end of a message: the name that is meant, or nothing for null. */
typedef struct vlHint {
  char text[200];
} vlHint;
vlHint vl_hint(const char *near);

#endif
