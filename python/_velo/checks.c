/* _velo/checks.c: numbers, flags and texts of the caller, each with its name and its range.
 * What does not fit is a UsageError; nothing is wrapped, rounded or read as "not given". */
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
  if (error)
    PyErr_SetObject((PyObject *)Py_TYPE(error), error);
  Py_XDECREF(error);
  return NULL;
}

/* Whether a conversion failed since the value is of another type or too large; other exceptions
 * are the caller's own. */
static bool unfit(void) {
  return PyErr_ExceptionMatches(PyExc_TypeError) || PyErr_ExceptionMatches(PyExc_ValueError) ||
         PyErr_ExceptionMatches(PyExc_ArithmeticError);
}

int to_double(PyObject *value, double *number) {
  bool texts = PyUnicode_Check(value) || PyBytes_Check(value) || PyByteArray_Check(value);
  if (texts || PyBool_Check(value) || PyComplex_Check(value))
    return 0;
  *number = PyFloat_AsDouble(value);
  if (*number != -1.0 || !PyErr_Occurred())
    return 1;
  if (!unfit())
    return -1;
  PyErr_Clear();
  return 0;
}

/* A whole number of any type: 1 read, 0 not one or beyond 64 bits, -1 an exception of the
 * caller's own. */
static int to_whole(PyObject *value, double *number) {
  if (!PyIndex_Check(value) || PyBool_Check(value))
    return to_double(value, number);
  PyObject *index = PyNumber_Index(value);
  int overflow = 0;
  long long read = index ? PyLong_AsLongLongAndOverflow(index, &overflow) : -1;
  Py_XDECREF(index);
  if (PyErr_Occurred() && !unfit())
    return -1;
  *number = (double)read;
  bool fine = !PyErr_Occurred() && !overflow;
  PyErr_Clear();
  return fine;
}

/* What the caller gave, for a row. *bytes holds the text, or is null. False: an exception of
 * the caller's own. */
static bool to_given(const vlParameter *row, PyObject *value, vlGiven *given,
                     PyObject **bytes) {
  *given = (vlGiven){.kind = VL_GIVEN_OTHER};
  *bytes = NULL;
  if (value == Py_None) {
    given->kind = VL_GIVEN_NOTHING;
  } else if (PyBool_Check(value)) {
    given->kind = VL_GIVEN_FLAG;
    given->number = value == Py_True;
  } else if (PyUnicode_Check(value)) {
    *bytes = PyUnicode_AsUTF8String(value);
    if (!*bytes)
      PyErr_Clear();
    given->text = *bytes ? PyBytes_AsString(*bytes) : NULL;
    if (given->text && strlen(given->text) == (size_t)PyBytes_Size(*bytes))
      given->kind = VL_GIVEN_TEXT;
  } else {
    int read = row->type == VL_PARAMETER_COUNT ? to_whole(value, &given->number)
                                               : to_double(value, &given->number);
    if (read < 0)
      return false;
    /* numpy's booleans */
    bool flag = row->type == VL_PARAMETER_BOOL && (given->number == 0 || given->number == 1);
    if (read)
      given->kind = flag ? VL_GIVEN_FLAG : VL_GIVEN_NUMBER;
  }
  return true;
}

/* factor: the value's unit (vlGiven). */
static bool read_given(PyObject *value, const char *what, const vlParameter *row, double factor,
                       double *number) {
  char message[VL_GIVEN_MESSAGE];
  vlGiven given;
  PyObject *bytes;
  if (!to_given(row, value, &given, &bytes))
    return false;
  given.factor = factor;
  bool fine = vl_given_check(row, what, &given, number, message);
  PyObject *shown = fine ? NULL : call_package("shown", "(O)", value);
  PyObject *text = shown ? PyUnicode_AsUTF8String(shown) : NULL;
  if (text) {
    given.shown = PyBytes_AsString(text);
    vl_given_check(row, what, &given, number, message);
    raise_usage("%s", message);
  }
  Py_XDECREF(text);
  Py_XDECREF(shown);
  Py_XDECREF(bytes);
  return fine;
}

bool read_row(PyObject *value, const char *what, const vlParameter *row, double *number) {
  return read_given(value, what, row, 1, number);
}

bool read_whole(PyObject *value, const char *what, int64_t low, int64_t high, int64_t *whole) {
  const vlParameter row = {
      .type = VL_PARAMETER_COUNT, .low = (double)low, .high = (double)high};
  double number;
  if (!read_row(value, what, &row, &number))
    return false;
  *whole = (int64_t)number;
  return true;
}

bool read_count(PyObject *value, const char *what, uint32_t low, uint32_t high,
                uint32_t *count) {
  int64_t whole;
  if (!read_whole(value, what, low, high, &whole))
    return false;
  *count = (uint32_t)whole;
  return true;
}

bool read_size(PyObject *width, PyObject *height, uint32_t most, uint32_t size[2]) {
  return read_count(width, "width", 1, most, &size[0]) &&
         read_count(height, "height", 1, most, &size[1]);
}

bool read_finite(PyObject *value, const char *what, double *number) {
  const vlParameter any = {.type = VL_PARAMETER_DOUBLE};
  return read_row(value, what, &any, number);
}

bool read_flag(PyObject *value, const char *what, bool *flag) {
  const vlParameter any = {.type = VL_PARAMETER_BOOL};
  double number;
  if (!read_row(value, what, &any, &number))
    return false;
  *flag = number != 0;
  return true;
}

/* check_value(value, what, type, low, high): the number, a bool or an int, where it fits; type:
 * "count", "number" or "flag". */
PyObject *check_value(PyObject *module, PyObject *arguments) {
  static const vlParameterType of[] = {VL_PARAMETER_COUNT, VL_PARAMETER_DOUBLE,
                                       VL_PARAMETER_BOOL};
  static const char *const words[] = {"count", "number", "flag", NULL};
  (void)module;
  PyObject *value, *type;
  const char *what;
  double number, low, high;
  if (!PyArg_ParseTuple(arguments, "OsOdd:check_value", &value, &what, &type, &low, &high))
    return NULL;
  int found = find_choice(words, "type", type);
  if (found < 0)
    return NULL;
  const vlParameter row = {.type = of[found], .low = low, .high = high};
  if (!read_row(value, what, &row, &number))
    return NULL;
  if (row.type == VL_PARAMETER_BOOL)
    return PyBool_FromLong(number != 0);
  return row.type == VL_PARAMETER_COUNT ? PyLong_FromDouble(number)
                                        : PyFloat_FromDouble(number);
}

/* check_choice(value, what, [words]): the index of the word. */
PyObject *check_choice(PyObject *module, PyObject *arguments) {
  enum { MAX_WORDS = 64 };
  (void)module;
  PyObject *value, *list;
  const char *what, *words[MAX_WORDS + 1] = {NULL};
  if (!PyArg_ParseTuple(arguments, "OsO!:check_choice", &value, &what, &PyList_Type, &list))
    return NULL;
  Py_ssize_t count = sequence_size(list, "the list of words", 1, MAX_WORDS);
  PyObject *keep = count > 0 ? PyList_New(0) : NULL, *result = NULL;
  if (keep && keep_texts(keep, list, count, "a word", words)) {
    int found = find_choice(words, what, value);
    if (found >= 0)
      result = PyLong_FromLong(found);
  }
  Py_XDECREF(keep);
  return result;
}

/* check_setting(value, what, group, name, by_unit): the value of a setting's row, where it
 * fits; by_unit: in the row's unit (degrees), not in that of the library (radians). */
PyObject *check_setting(PyObject *module, PyObject *arguments) {
  (void)module;
  PyObject *value;
  const char *what, *group, *name;
  double number;
  int by_unit;
  if (!PyArg_ParseTuple(arguments, "Osssp:check_setting", &value, &what, &group, &name,
                        &by_unit))
    return NULL;
  const vlParameter *row = NULL;
  for (int i = 0; vl_settings((vlSettingGroup)i); i++)
    if (strcmp(vl_settings((vlSettingGroup)i)->name, group) == 0)
      row = vl_setting((vlSettingGroup)i, name);
  if (!row)
    return raise_usage("there is no setting %s of %s", name, group);
  double factor = by_unit && row->factor != 0 ? row->factor : 1;
  if (!read_given(value, what, row, factor, &number))
    return NULL;
  if (row->type == VL_PARAMETER_COUNT)
    return PyLong_FromDouble(number);
  if (row->type == VL_PARAMETER_FLOAT || row->type == VL_PARAMETER_DOUBLE)
    return PyFloat_FromDouble(number / factor);
  Py_INCREF(value);
  return value;
}

/* unknown_name(thing, name, [names]): the message about a name that is not one of them. */
PyObject *unknown_name(PyObject *module, PyObject *arguments) {
  (void)module;
  PyObject *list;
  const char *thing, *name;
  if (!PyArg_ParseTuple(arguments, "ssO!:unknown_name", &thing, &name, &PyList_Type, &list))
    return NULL;
  const size_t count = (size_t)PyList_Size(list);
  const char **names = PyMem_Malloc((count + 1) * sizeof *names);
  PyObject *keep = PyList_New(0), *result = NULL;
  bool fine = names && keep && keep_texts(keep, list, (Py_ssize_t)count, "a name", names);
  if (fine) {
    char message[VL_GIVEN_MESSAGE];
    vl_unknown_name(thing, "", name, names, count, message);
    result = text_object(message);
  }
  PyMem_Free(names);
  Py_XDECREF(keep);
  return result;
}

const char *keep_text(PyObject *keep, PyObject *value, const char *what) {
  if (!PyUnicode_Check(value)) {
    raise_value(what, value, "a str");
    return NULL;
  }
  PyObject *bytes = PyUnicode_AsUTF8String(value);
  const char *text = bytes && keep_object(keep, bytes) ? PyBytes_AsString(bytes) : NULL;
  bool whole = text && strlen(text) == (size_t)PyBytes_Size(bytes);
  Py_XDECREF(bytes);
  if (whole)
    return text;
  if (!text && !(PyErr_Occurred() && unfit()))
    return NULL;
  raise_value(what, value, "text that UTF-8 can hold, without zeros");
  return NULL;
}

bool keep_texts(PyObject *keep, PyObject *values, Py_ssize_t count, const char *what,
                const char **texts) {
  for (Py_ssize_t i = 0; i < count; i++) {
    PyObject *item = PySequence_GetItem(values, i);
    texts[i] = item ? keep_text(keep, item, what) : NULL;
    Py_XDECREF(item);
    if (!texts[i])
      return false;
  }
  return true;
}

Py_ssize_t sequence_size(PyObject *value, const char *what, Py_ssize_t low, Py_ssize_t high) {
  bool sequence = PySequence_Check(value) && !PyUnicode_Check(value) && !PyBytes_Check(value);
  Py_ssize_t size = sequence ? PySequence_Size(value) : -1;
  if (size >= low && size <= high)
    return size;
  if (sequence && size < 0 && !unfit())
    return -1;
  if (low == high) {
    raise_value(what, value, "a list of %zd items", low);
    return -1;
  }
  raise_value(what, value, "a list of %zd to %zd items", low, high);
  return -1;
}

const char *keep_path(PyObject *keep, PyObject *value, const char *what) {
  PyObject *bytes = NULL;
  if (!PyUnicode_FSConverter(value, &bytes)) {
    if (unfit())
      raise_value(what, value, "a path: a str or an os.PathLike");
    return NULL;
  }
  const char *text = keep_object(keep, bytes) ? PyBytes_AsString(bytes) : NULL;
  Py_XDECREF(bytes);
  if (text && !*text) {
    raise_value(what, value, "a path, not empty");
    return NULL;
  }
  return text;
}

bool check_memory(const Context *context, uint64_t bytes, const char *what) {
  if (!context_check(context))
    return false;
  const char *who;
  uint64_t held = vl_context_memory(context->context, NULL), most = vl_memory_limit(&who);
  if (context->max_memory && context->max_memory < most) {
    most = context->max_memory;
    who = "max_memory allows";
  }
  if (held + bytes <= most)
    return true;
  char text[256];
  PyOS_snprintf(text, sizeof text, "%s needs %.1f GB%s, and %s %.1f GB", what,
                (double)(held + bytes) * 1e-9, held ? " with what is held" : "", who,
                (double)most * 1e-9);
  vlError error = {0};
  PyOS_snprintf(error.message, sizeof error.message, "%s", text);
  raise_result(VL_ERROR_MEMORY, &error);
  return false;
}
