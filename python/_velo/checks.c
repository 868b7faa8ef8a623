/* _velo/checks.c: numbers, flags and texts of the caller, each with its name and its range. What does not fit is a
 * UsageError; nothing is wrapped, rounded or read as "not given". */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "module.h"

PyObject *text_object(const char *text) {
  return PyUnicode_DecodeUTF8(text, (Py_ssize_t)strlen(text), "replace");
}

PyObject *raise_value(const char *what, PyObject *value, const char *format, ...) {
  char rule[256];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(rule, sizeof rule, format, arguments);
  va_end(arguments);
  PyErr_Clear();
  PyObject *error = call_package("wrong_value", "(ssO)", what, rule, value);
  if (error) PyErr_SetObject((PyObject *)Py_TYPE(error), error);
  Py_XDECREF(error);
  return NULL;
}

/* Whether a conversion failed since the value is of another type or too large; other exceptions are the caller's own.
 */
static bool unfit(void) {
  return PyErr_ExceptionMatches(PyExc_TypeError) || PyErr_ExceptionMatches(PyExc_ValueError) ||
         PyErr_ExceptionMatches(PyExc_ArithmeticError);
}

int to_double(PyObject *value, double *number) {
  bool texts = PyUnicode_Check(value) || PyBytes_Check(value) || PyByteArray_Check(value);
  if (texts || PyBool_Check(value) || PyComplex_Check(value)) return 0;
  *number = PyFloat_AsDouble(value);
  if (*number != -1.0 || !PyErr_Occurred()) return 1;
  if (!unfit()) return -1;
  PyErr_Clear();
  return 0;
}

/* A whole number of any type: 1 read, 0 not one or beyond 64 bits, -1 an exception of the caller's own. */
static int to_whole(PyObject *value, int64_t *whole) {
  double number;
  if (PyIndex_Check(value) && !PyBool_Check(value)) {
    PyObject *index = PyNumber_Index(value);
    int overflow = 0;
    long long read = index ? PyLong_AsLongLongAndOverflow(index, &overflow) : -1;
    Py_XDECREF(index);
    if (PyErr_Occurred() && !unfit()) return -1;
    *whole = (int64_t)read;
    bool fine = !PyErr_Occurred() && !overflow;
    PyErr_Clear();
    return fine;
  }
  int read = to_double(value, &number);
  if (read <= 0) return read;
  if (!(fabs(number) < 9e15) || number != floor(number)) return 0;
  *whole = (int64_t)number;
  return 1;
}

bool read_whole(PyObject *value, const char *what, int64_t low, int64_t high, int64_t *whole) {
  int read = to_whole(value, whole);
  if (read < 0) return false;
  if (read && *whole >= low && *whole <= high) return true;
  if (high == INT64_MAX) return raise_value(what, value, "a whole number of at least %lld", (long long)low), false;
  return raise_value(what, value, "a whole number from %lld to %lld", (long long)low, (long long)high), false;
}

bool read_count(PyObject *value, const char *what, uint32_t low, uint32_t high, uint32_t *count) {
  int64_t whole;
  if (!read_whole(value, what, low, high, &whole)) return false;
  *count = (uint32_t)whole;
  return true;
}

bool read_size(PyObject *width, PyObject *height, uint32_t most, uint32_t size[2]) {
  return read_count(width, "width", 1, most, &size[0]) && read_count(height, "height", 1, most, &size[1]);
}

/* "a number above 0, or infinity" */
static void put_rule(const Range *r, char *text, size_t size) {
  bool low = r->low > -INFINITY, high = r->high < INFINITY;
  const char *more = r->infinite ? ", or infinity" : r->unset ? ", or None" : "";
  if (!low && !high)
    snprintf(text, size, "a finite number%s", more);
  else if (!high)
    snprintf(text, size, "a finite number%s %g%s", r->above ? " above" : " of at least", r->low, more);
  else if (!low)
    snprintf(text, size, "a finite number %s %g%s", r->below ? "below" : "of at most", r->high, more);
  else
    snprintf(text, size, "a number %s %g %s %g%s", r->above ? "above" : "from", r->low,
             r->below   ? "to below"
             : r->above ? "up to"
                        : "to",
             r->high, more);
}

bool read_real(PyObject *value, const char *what, const Range *r, double *number) {
  if (value == Py_None && r->unset) {
    *number = VL_UNSET;
    return true;
  }
  int read = to_double(value, number);
  if (read < 0) return false;
  double x = *number;
  bool finite = read && (r->single ? fabs(x) <= (double)__FLT_MAX__ : isfinite(x));
  if (read && isinf(x) && r->infinite) finite = true;
  bool low = finite && (r->above ? x > r->low : x >= r->low), high = finite && (r->below ? x < r->high : x <= r->high);
  if (low && high) return true;
  char rule[160];
  put_rule(r, rule, sizeof rule);
  return raise_value(what, value, "%s", rule), false;
}

bool read_finite(PyObject *value, const char *what, double *number) {
  const Range any = {.low = -INFINITY, .high = INFINITY};
  return read_real(value, what, &any, number);
}

bool read_flag(PyObject *value, const char *what, bool *flag) {
  double number = value == Py_True;
  int read = PyBool_Check(value) ? 1 : to_double(value, &number); /* numpy's booleans are numbers */
  if (read < 0) return false;
  if (!read || (number != 0 && number != 1)) return raise_value(what, value, "True or False"), false;
  *flag = number == 1;
  return true;
}

const char *keep_text(PyObject *keep, PyObject *value, const char *what) {
  if (!PyUnicode_Check(value)) return raise_value(what, value, "a str"), NULL;
  PyObject *bytes = PyUnicode_AsUTF8String(value);
  const char *text = bytes && keep_object(keep, bytes) ? PyBytes_AsString(bytes) : NULL;
  bool whole = text && strlen(text) == (size_t)PyBytes_Size(bytes);
  Py_XDECREF(bytes);
  if (whole) return text;
  if (!text && !(PyErr_Occurred() && unfit())) return NULL;
  return raise_value(what, value, "text that UTF-8 can hold, without zeros"), NULL;
}

bool keep_texts(PyObject *keep, PyObject *values, Py_ssize_t count, const char *what, const char **texts) {
  for (Py_ssize_t i = 0; i < count; i++) {
    PyObject *item = PySequence_GetItem(values, i);
    texts[i] = item ? keep_text(keep, item, what) : NULL;
    Py_XDECREF(item);
    if (!texts[i]) return false;
  }
  return true;
}

Py_ssize_t sequence_size(PyObject *value, const char *what, Py_ssize_t low, Py_ssize_t high) {
  bool sequence = PySequence_Check(value) && !PyUnicode_Check(value) && !PyBytes_Check(value);
  Py_ssize_t size = sequence ? PySequence_Size(value) : -1;
  if (size >= low && size <= high) return size;
  if (sequence && size < 0 && !unfit()) return -1;
  if (low == high) return raise_value(what, value, "a list of %zd items", low), -1;
  return raise_value(what, value, "a list of %zd to %zd items", low, high), -1;
}

const char *keep_path(PyObject *keep, PyObject *value, const char *what) {
  PyObject *bytes = NULL;
  if (!PyUnicode_FSConverter(value, &bytes)) {
    if (unfit()) raise_value(what, value, "a path: a str or an os.PathLike");
    return NULL;
  }
  const char *text = keep_object(keep, bytes) ? PyBytes_AsString(bytes) : NULL;
  Py_XDECREF(bytes);
  if (text && !*text) return raise_value(what, value, "a path, not empty"), NULL;
  return text;
}

bool check_memory(const Context *context, uint64_t bytes, const char *what) {
  if (!context_check(context)) return false;
  const char *who;
  uint64_t held = vl_context_memory(context->context, NULL), most = vl_memory_limit(&who);
  if (context->max_memory && context->max_memory < most) most = context->max_memory, who = "max_memory allows";
  if (held + bytes <= most) return true;
  char text[256];
  PyOS_snprintf(text, sizeof text, "%s needs %.1f GB%s, and %s %.1f GB", what, (double)(held + bytes) * 1e-9,
                held ? " with what is held" : "", who, (double)most * 1e-9);
  vlError error = {0};
  PyOS_snprintf(error.message, sizeof error.message, "%s", text);
  raise_result(VL_ERROR_MEMORY, &error);
  return false;
}
