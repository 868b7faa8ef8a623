/* _velo/context.c: contexts, short calls without the GIL, exceptions. */
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

#include "module.h"

/* Calls a function of velo/_errors.py. The name is looked up in the module's dict: getattr
 * would keep each new str in the interpreter's cache of methods. */
PyObject *call_package(const char *name, const char *format, ...) {
  PyObject *module = PyImport_ImportModule("velo._errors");
  PyObject *function = module ? PyDict_GetItemString(PyModule_GetDict(module), name) : NULL;
  va_list arguments;
  va_start(arguments, format);
  PyObject *tuple = function ? Py_VaBuildValue(format, arguments) : NULL;
  va_end(arguments);
  PyObject *result = tuple ? PyObject_CallObject(function, tuple) : NULL;
  if (module && !function)
    PyErr_Format(PyExc_ImportError, "velo._errors has no %s", name);
  Py_XDECREF(tuple);
  Py_XDECREF(module);
  return result;
}

/* ---- exceptions -------------------------------------------------------------------------- */

static PyObject *raise_error(vlResult result, const char *message, const char *file,
                             unsigned line, unsigned column) {
  PyObject *error =
      call_package("make", "(iNII)", (int)result, text_object(message), line, column);
  if (error && file && file[0]) {
    PyObject *text = PyUnicode_DecodeFSDefault(file);
    if (!text || PyObject_SetAttrString(error, "file", text) < 0)
      Py_CLEAR(error);
    Py_XDECREF(text);
  }
  if (error)
    PyErr_SetObject((PyObject *)Py_TYPE(error), error);
  Py_XDECREF(error);
  return NULL;
}

PyObject *raise_result(vlResult result, const vlError *error) {
  if (PyErr_Occurred())
    return NULL;
  const char *message = error && error->message[0] ? error->message : vl_result_name(result);
  return error ? raise_error(result, message, error->file, error->line, error->column)
               : raise_error(result, message, NULL, 0, 0);
}

PyObject *raise_usage(const char *format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return raise_error(VL_ERROR_ARGUMENT, text, NULL, 0, 0);
}

/* ---- calls ------------------------------------------------------------------------------- */

bool context_is_ours(const Context *context) {
  return context && context->context && context->pid == (long)getpid();
}

bool context_check(const Context *context) {
  if (!context || !context->context) {
    raise_usage("the context is closed");
    return false;
  }
  if (context->pid != (long)getpid()) {
    PyObject *error = call_package("fork_error", "()");
    if (error)
      PyErr_SetObject((PyObject *)Py_TYPE(error), error);
    Py_XDECREF(error);
    return false;
  }
  return true;
}

locale_t plain_locale(void) {
  static locale_t plain; /* guarded by the GIL */
  if (!plain)
    plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
  return plain;
}

bool call_begin(Call *call, const Context *context, bool *busy) {
  *call = (Call){0};
  if (!context_check(context))
    return false;
  if (busy && *busy) {
    raise_usage("another thread is using this object");
    return false;
  }
  if (busy)
    *busy = true;
  call->busy = busy;
  call->locale = uselocale(plain_locale());
  call->thread = PyEval_SaveThread();
  return true;
}

void call_end(Call *call) {
  PyEval_RestoreThread(call->thread);
  uselocale(call->locale);
  if (call->busy)
    *call->busy = false;
}

/* ---- contexts ---------------------------------------------------------------------------- */

static void log_message(void *user, vlLogLevel level, const vlError *where,
                        const char *message) {
  (void)user;
  PyGILState_STATE state = PyGILState_Ensure();
  PyObject *type, *value, *trace;
  PyErr_Fetch(&type, &value, &trace);
  PyObject *answer = call_package("log", "(iNNII)", (int)level, text_object(message),
                                  text_object(where ? where->file : ""),
                                  where ? where->line : 0, where ? where->column : 0);
  if (!answer)
    PyErr_WriteUnraisable(NULL);
  Py_XDECREF(answer);
  PyErr_Restore(type, value, trace);
  PyGILState_Release(state);
}

/* More threads than a few for each processor wait for each other: a thousand on two processors
 * take seconds. */
enum { MAX_PER_PROCESSOR = 4 };

static const int64_t MAX_MEMORY = (int64_t)1 << 53; /* bytes; larger numbers are not exact */

static PyObject *context_new(PyTypeObject *type, PyObject *arguments, PyObject *keywords) {
  static char *names[] = {"threads", "max_memory", "keep_inputs", NULL};
  vlContextDef def = vl_default_context_def();
  const uint32_t most_threads = MAX_PER_PROCESSOR * def.threads;
  PyObject *threads = NULL, *most = NULL, *keep_inputs = NULL;
  int64_t memory = 0;
  if (!PyArg_ParseTupleAndKeywords(arguments, keywords, "|OOO:Context", names, &threads, &most,
                                   &keep_inputs))
    return NULL;
  double count = def.threads;
  if (threads &&
      !read_row(threads, "threads", vl_setting(VL_SETTING_CONTEXT, "threads"), &count))
    return NULL;
  def.threads = (uint32_t)count;
  if (def.threads > most_threads)
    def.threads = most_threads;
  if (most && !read_whole(most, "max_memory", 0, MAX_MEMORY, &memory))
    return NULL;
  if (keep_inputs && !read_flag(keep_inputs, "keep_inputs", &def.keep_inputs))
    return NULL;
  def.max_memory = (size_t)memory;
  def.log = log_message;
  Context *self = (Context *)((allocfunc)PyType_GetSlot(type, Py_tp_alloc))(type, 0);
  if (!self)
    return NULL;
  self->pid = (long)getpid();
  self->max_memory = (uint64_t)memory;
  vlResult result = vl_context_create(&def, &self->context);
  if (result == VL_OK)
    return (PyObject *)self;
  Py_DECREF((PyObject *)self);
  return raise_result(result, NULL);
}

static void context_dealloc(Context *self) {
  if (context_is_ours(self)) {
    PyThreadState *thread = PyEval_SaveThread();
    vl_context_destroy(self->context);
    PyEval_RestoreThread(thread);
  }
  free_object((PyObject *)self);
}

typedef vlResult PathCall(vlContext *context, const char *path, vlError *error);

static vlResult note_input(vlContext *context, const char *path, vlError *error) {
  vlResult result = vl_note_input(context, path, VL_OUTPUT_PLAIN);
  if (result == VL_ERROR_IO)
    snprintf(error->message, sizeof error->message, "no such file: %.400s", path);
  return result;
}

static vlResult check_output(vlContext *context, const char *path, vlError *error) {
  return vl_check_output(context, path, VL_OUTPUT_PLAIN, error);
}

static PyObject *with_path(const Context *self, PyObject *path, PathCall *call) {
  if (!context_check(self))
    return NULL;
  PyObject *keep = PyList_New(0);
  const char *file = keep ? keep_path(keep, path, "path") : NULL;
  vlError error = {0};
  vlResult result = file ? call(self->context, file, &error) : VL_OK;
  Py_XDECREF(keep);
  if (!file)
    return NULL;
  if (result != VL_OK)
    return raise_result(result, &error);
  Py_RETURN_NONE;
}

static PyObject *context_note_input(Context *self, PyObject *path) {
  return with_path(self, path, note_input);
}

static PyObject *context_check_output(Context *self, PyObject *path) {
  return with_path(self, path, check_output);
}

static PyMethodDef context_methods[] = {
    {"note_input", (PyCFunction)context_note_input, METH_O,
     "note_input(path): remembers a file that the program reads itself, so that keep_inputs "
     "protects it, too."},
    {"check_output", (PyCFunction)context_check_output, METH_O,
     "check_output(path): raises the error that writing a file there would raise, without "
     "writing."},
    {NULL, NULL, 0, NULL},
};

static PyObject *context_memory(Context *self, void *unused) {
  (void)unused;
  if (!context_check(self))
    return NULL;
  return PyLong_FromSize_t(vl_context_memory(self->context, NULL));
}
static PyObject *context_threads(Context *self, void *unused) {
  (void)unused;
  return PyLong_FromUnsignedLong(vl_context_threads(self->context));
}

static PyGetSetDef context_members[] = {
    {"memory", (getter)context_memory, NULL, "Bytes that the context and its objects hold now.",
     NULL},
    {"threads", (getter)context_threads, NULL, "Number of worker threads.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};
static PyType_Slot context_slots[] = {
    {Py_tp_doc,
     "Memory, log and worker threads of all objects. threads: default the processors, at most "
     "four "
     "for each; "
     "max_memory: bytes, 0: no limit; "
     "keep_inputs: files that were read are not overwritten, which is a UsageError."},
    {Py_tp_new, context_new},
    {Py_tp_dealloc, context_dealloc},
    {Py_tp_getset, context_members},
    {Py_tp_methods, context_methods},
    {0, NULL},
};
PyType_Spec context_spec = {"velo._velo.Context", sizeof(Context), 0,
                            Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE, context_slots};
