/* _velo/numbers.c: arrays of numbers from buffers and from nested sequences. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "module.h"

static size_t item_size(char type) {
  return type == 'd' ? sizeof(double) : type == 'f' ? sizeof(float) : sizeof(uint32_t);
}

/* Stores a number; an index must be a whole number that fits. */
static bool store(double value, char type, const char *what, char *result) {
  if (type == 'd') {
    memcpy(result, &value, sizeof value);
  } else if (type == 'f') {
    float single = (float)value;
    memcpy(result, &single, sizeof single);
  } else {
    if (!(value >= 0 && value <= 4294967295.0) || value != (double)(uint32_t)value) {
      raise_usage("%s: %.15g is not an index: a whole number from 0 to 4294967295", what,
                  value);
      return false;
    }
    uint32_t whole = (uint32_t)value;
    memcpy(result, &whole, sizeof whole);
  }
  return true;
}

/* One item of a buffer as a double. False: the format is not one of numbers. */
static bool load(const char *item, char format, Py_ssize_t size, double *value) {
#define CASE(letter, Type)            \
  case letter: {                      \
    Type v;                           \
    if (size != (Py_ssize_t)sizeof v) \
      return false;                   \
    memcpy(&v, item, sizeof v);       \
    *value = (double)v;               \
    return true;                      \
  }
  switch (format) {
    CASE('d', double)
    CASE('f', float)
    CASE('b', signed char)
    CASE('B', unsigned char)
    CASE('?', unsigned char)
    CASE('h', short)
    CASE('H', unsigned short)
    CASE('i', int)
    CASE('I', unsigned)
    CASE('l', long)
    CASE('L', unsigned long)
    CASE('q', long long)
    CASE('Q', unsigned long long)
  }
#undef CASE
  return false;
}

static char plain_format(const Py_buffer *view) {
  const char *format = view->format ? view->format : "B";
  if (*format == '@' || *format == '=' || *format == '<')
    format++;
  return format[0] && !format[1] ? format[0] : 0;
}

static bool from_buffer(PyObject *object, char type, const char *what, Numbers *n) {
  if (PyObject_GetBuffer(object, &n->view, PyBUF_FULL_RO) < 0) {
    PyErr_Clear();
    n->view.obj = NULL;
    raise_usage("%s: the buffer cannot be read", what);
    return false;
  }
  char format = plain_format(&n->view);
  if (n->view.ndim > 4) {
    raise_usage("%s has more than four dimensions", what);
    return false;
  }
  n->dimensions = n->view.ndim;
  n->count = 1;
  for (int i = 0; i < n->view.ndim; i++) {
    n->shape[i] = (size_t)n->view.shape[i];
    n->count *= n->shape[i];
  }
  bool same = format == type || (type == 'I' && (format == 'L' || format == 'i') &&
                                 n->view.itemsize == 4 && format != 'i');
  if (same && PyBuffer_IsContiguous(&n->view, 'C')) {
    n->data = n->view.buf;
    return true;
  }
  size_t size = item_size(type);
  char *plain = malloc((size_t)n->view.len + 1);
  n->owned = malloc(n->count * size + 1);
  bool fine = plain && n->owned;
  if (!fine)
    PyErr_NoMemory();
  else
    fine = PyBuffer_ToContiguous(plain, &n->view, n->view.len, 'C') == 0;
  for (size_t i = 0; fine && i < n->count; i++) {
    double value;
    fine = load(plain + i * (size_t)n->view.itemsize, format, n->view.itemsize, &value);
    if (!fine)
      raise_usage("%s: the array's type (format %s) is not one of numbers", what,
                  n->view.format ? n->view.format : "B");
    else
      fine = store(value, type, what, (char *)n->owned + i * size);
  }
  free(plain);
  n->data = n->owned;
  return fine;
}

enum { MAX_LISTED = 1 << 28 }; /* numbers of nested sequences; more are given as an array */

typedef struct Growing {
  char *data;
  size_t count, room;
} Growing;

static bool flatten(PyObject *object, char type, const char *what, int depth, Numbers *n,
                    Growing *g) {
  size_t size = item_size(type);
  if (depth > 0 && PyNumber_Check(object) && !PySequence_Check(object)) {
    double value;
    int read = to_double(object, &value);
    if (read < 0)
      return false;
    if (!read) {
      raise_value(what, object, "numbers");
      return false;
    }
    if (depth != n->dimensions && g->count) {
      raise_usage("%s: its rows differ in length", what);
      return false;
    }
    n->dimensions = depth;
    if (g->count == MAX_LISTED) {
      raise_usage("%s: more than %d numbers: give an array", what, MAX_LISTED);
      return false;
    }
    if (g->count == g->room) {
      size_t room = g->room ? 2 * g->room : 64;
      char *more = realloc(g->data, room * size);
      if (!more) {
        PyErr_NoMemory();
        return false;
      }
      g->data = more;
      g->room = room;
    }
    return store(value, type, what, g->data + size * g->count++);
  }
  if (depth >= 4 || !PySequence_Check(object) || PyUnicode_Check(object)) {
    raise_value(what, object, "numbers: an array or nested lists");
    return false;
  }
  Py_ssize_t length = sequence_size(object, what, 0, MAX_LISTED);
  if (length < 0)
    return false;
  if (n->shape[depth] == 0)
    n->shape[depth] = (size_t)length;
  if (n->shape[depth] != (size_t)length) {
    raise_usage("%s: its rows differ in length", what);
    return false;
  }
  for (Py_ssize_t i = 0; i < length; i++) {
    PyObject *item = PySequence_GetItem(object, i);
    bool fine = item && flatten(item, type, what, depth + 1, n, g);
    Py_XDECREF(item);
    if (!fine)
      return false;
  }
  return true;
}

bool numbers_read_any(PyObject *object, char type, const char *what, Numbers *n) {
  *n = (Numbers){0};
  if (PyBytes_Check(object)) {
    raise_value(what, object, "numbers: an array or nested lists");
    return false;
  }
  if (PyObject_CheckBuffer(object)) {
    if (from_buffer(object, type, what, n))
      return true;
    numbers_release(n);
    return false;
  }
  Growing g = {0};
  bool fine = flatten(object, type, what, 0, n, &g);
  n->owned = g.data;
  n->data = g.data;
  n->count = g.count;
  if (!fine)
    numbers_release(n);
  return fine;
}

/* The index of the first number that is not finite; count: there is none. */
static size_t first_not_finite(const Numbers *n, char type) {
  const float *singles = n->data;
  const double *doubles = n->data;
  size_t i = 0;
  while (i < n->count && (type == 'f' ? isfinite(singles[i]) : isfinite(doubles[i])))
    i++;
  return i;
}

bool numbers_read(PyObject *object, char type, const char *what, Numbers *n) {
  if (!numbers_read_any(object, type, what, n))
    return false;
  if (type == 'I')
    return true;
  size_t i = first_not_finite(n, type);
  if (i == n->count)
    return true;
  double value =
      type == 'f' ? (double)((const float *)n->data)[i] : ((const double *)n->data)[i];
  raise_usage("%s: item %zu of %zu is %g%s; all must be finite numbers", what, i, n->count,
              value, type == 'f' ? " as a 32-bit float" : "");
  numbers_release(n);
  return false;
}

void numbers_release(Numbers *n) {
  if (n->view.obj)
    PyBuffer_Release(&n->view);
  n->view.obj = NULL;
  free(n->owned);
  n->owned = NULL;
}

static bool copy(PyObject *object, char type, const char *what, size_t count, void *result) {
  Numbers n;
  if (!numbers_read(object, type, what, &n))
    return false;
  bool fine = n.count == count;
  if (fine)
    memcpy(result, n.data, count * item_size(type));
  else
    raise_usage("%s must have %zu numbers, it has %zu", what, count, n.count);
  numbers_release(&n);
  return fine;
}

bool numbers_copy(PyObject *object, const char *what, size_t count, double *result) {
  return copy(object, 'd', what, count, result);
}

bool floats_copy(PyObject *object, const char *what, size_t count, float *result) {
  return copy(object, 'f', what, count, result);
}

PyObject *make_bytes(size_t size, void **data) {
  PyObject *bytes = PyByteArray_FromStringAndSize(NULL, (Py_ssize_t)size);
  *data = bytes ? PyByteArray_AsString(bytes) : NULL;
  return bytes;
}
