/* _velo/own.h: what own.c and own_trace.c share: calls of the functions of velo/own.py. */
#ifndef VELO_PYTHON_OWN_H
#define VELO_PYTHON_OWN_H

#include "module.h"

/* An argument: `count` numbers of `size` bytes, as a memoryview; data null: None. */
typedef struct Column {
  const void *data;
  size_t size;
  uint32_t count;
  bool written;
} Column;
/* Calls function([first,] *plain, *columns) with the GIL. False: it raised, and the calls that
 * need it are ended. */
bool own_call(Own *own, PyObject *function, PyObject *first, const long *plain,
              Py_ssize_t plain_count, const Column *columns, Py_ssize_t column_count);
/* vlOwnRadianceFn; user is the Own. */
void own_radiance(void *user, vlTrace *trace, const vlOwnPaths *paths);

#endif
