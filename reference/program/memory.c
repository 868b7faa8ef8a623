/* program/memory.c: memory, which is given back when the program ends. */
#include <stdio.h>
#include <stdlib.h>

#include "color.h"

void *resize(void *array, size_t count, size_t size) {
  void *more = count < SIZE_MAX / size ? realloc(array, (count + 1) * size) : NULL;
  if (more) return more;
  fprintf(stderr, "velo-reference: no memory\n");
  exit(1);
}
