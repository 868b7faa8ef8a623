/* program/memory.c: memory, which is given back when the program ends, and the tables of spectra in it. */
#include <stdio.h>
#include <stdlib.h>

#include "color.h"

void *resize(void *array, size_t count, size_t size) {
  void *more = count < SIZE_MAX / size ? realloc(array, (count + 1) * size) : NULL;
  if (more) return more;
  fprintf(stderr, "velo-reference: no memory\n");
  exit(1);
}

/* The tables are kept in 1024 lists; a spectrum's address says in which it is looked for. */
const color *find_color(const vlSpectrum *s, vlParameterRole role) {
  static color *lists[1024];
  color **c = &lists[(uintptr_t)s / 16 % 1024];
  while (*c && ((*c)->of != s || (*c)->role != role)) c = &(*c)->next;
  if (!*c) *c = make_color(s, role);
  return *c;
}
