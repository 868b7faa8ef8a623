/* _velo/py_buffer.h: the buffer protocol for modules that load in Python 3.10, too.
 *
 * CPython's stable ABI has it since 3.11 only, so its headers hide it from Py_LIMITED_API 3.10.
 * CPython 3.10 has the same functions, the same slots of types, and Py_buffer with the same
 * members in the same order: they are those of PEP 3118 (3.0 to today; in 3.10 they are in
 * Include/cpython/object.h and abstract.h, in 3.11 in Include/pybuffer.h). That 3.10 loads the
 * module is tested by test/python/test_older.py.
 *
 * Included by module.h alone, after Python.h. The headers are those of 3.11 or later: they show
 * the slots' numbers (Py_bf_getbuffer). */
#ifndef VELO_PYTHON_PY_BUFFER_H
#define VELO_PYTHON_PY_BUFFER_H

typedef struct Py_buffer {
  void *buf;
  PyObject *obj; /* owned */
  Py_ssize_t len, itemsize;
  int readonly, ndim;
  char *format;
  Py_ssize_t *shape, *strides, *suboffsets;
  void *internal;
} Py_buffer;

int PyObject_CheckBuffer(PyObject *object);
int PyObject_GetBuffer(PyObject *object, Py_buffer *view, int flags);
void PyBuffer_Release(Py_buffer *view);
int PyBuffer_IsContiguous(const Py_buffer *view, char order);
int PyBuffer_ToContiguous(void *buffer, const Py_buffer *view, Py_ssize_t size, char order);

/* what a buffer must have (PEP 3118) */
enum {
  PyBUF_SIMPLE = 0,
  PyBUF_WRITABLE = 0x1,
  PyBUF_FORMAT = 0x4,
  PyBUF_ND = 0x8,
  PyBUF_STRIDES = 0x10 | PyBUF_ND,
  PyBUF_INDIRECT = 0x100 | PyBUF_STRIDES,
  PyBUF_RECORDS_RO = PyBUF_STRIDES | PyBUF_FORMAT,
  PyBUF_FULL_RO = PyBUF_INDIRECT | PyBUF_FORMAT,
};
/* what PyMemoryView_FromMemory gives */
enum { PyBUF_READ = 0x100, PyBUF_WRITE = 0x200 };

#endif
