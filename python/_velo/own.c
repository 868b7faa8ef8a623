/* _velo/own.c: code of one's own (velo/own.h): the library's threads call Python functions of
 * velo/own.py. Each call takes the GIL once. An exception ends the call of the library that
 * needs the function, and is raised there. */
#include <math.h>
#include <string.h>

#include "own.h"

/* ---- calls ------------------------------------------------------------------------------- */

static PyObject *view_of(const Column *c) {
  if (!c->data) {
    Py_INCREF(Py_None);
    return Py_None;
  }
  return PyMemoryView_FromMemory((char *)(uintptr_t)c->data, (Py_ssize_t)(c->count * c->size),
                                 c->written ? PyBUF_WRITE : PyBUF_READ);
}

bool own_call(Own *own, PyObject *function, PyObject *first, const long *plain,
              Py_ssize_t plain_count, const Column *columns, Py_ssize_t column_count) {
  Py_ssize_t head = first ? 1 : 0;
  PyObject *arguments = PyTuple_New(head + plain_count + column_count), *result = NULL;
  bool good = arguments != NULL;
  if (good && first) {
    Py_INCREF(first);
    good = PyTuple_SetItem(arguments, 0, first) == 0;
  }
  for (Py_ssize_t i = 0; i < plain_count && good; i++) {
    PyObject *number = PyLong_FromLong(plain[i]);
    good = number && PyTuple_SetItem(arguments, head + i, number) == 0;
  }
  for (Py_ssize_t i = 0; i < column_count && good; i++) {
    PyObject *view = view_of(&columns[i]);
    good = view && PyTuple_SetItem(arguments, head + plain_count + i, view) == 0;
  }
  if (good)
    result = PyObject_CallObject(function, arguments);
  Py_XDECREF(arguments);
  if (result) {
    Py_DECREF(result);
    return true;
  }
  PyObject *type, *value, *trace;
  PyErr_Fetch(&type, &value, &trace);
  PyErr_NormalizeException(&type, &value, &trace);
  if (trace)
    PyException_SetTraceback(value, trace);
  Py_XDECREF(type);
  Py_XDECREF(trace);
  if (!long_call_fail(own, value)) {
    if (own->error)
      Py_XDECREF(value);
    else
      own->error = value;
  }
  return false;
}

static void rays(void *user, const vlOwnFilmPoints *p, const vlOwnRays *r) {
  Own *own = user;
  PyGILState_STATE state = PyGILState_Ensure();
  const void *const in[] = {p->x, p->y, p->lens_u, p->lens_v, p->time};
  void *const out[] = {r->ox, r->oy, r->oz, r->dx, r->dy, r->dz, r->weight};
  enum { IN = sizeof in / sizeof *in, OUT = sizeof out / sizeof *out };
  Column columns[IN + OUT];
  for (int i = 0; i < IN + OUT; i++)
    columns[i] = (Column){i < IN ? in[i] : out[i - IN], sizeof(double), p->count, i >= IN};
  const long plain[] = {p->width, p->height};
  if (!own_call(own, own->function, NULL, plain, 2, columns, IN + OUT))
    for (uint32_t i = 0; i < p->count; i++)
      r->dx[i] = (double)NAN;
  PyGILState_Release(state);
}

static void pixels(void *user, const vlOwnSpacePoints *p) {
  Own *own = user;
  PyGILState_STATE state = PyGILState_Ensure();
  const size_t d = sizeof(double);
  const Column columns[] = {{p->x, d, p->count, false},
                            {p->y, d, p->count, false},
                            {p->z, d, p->count, false},
                            {p->film_x, d, p->count, true},
                            {p->film_y, d, p->count, true}};
  const long plain[] = {p->width, p->height};
  if (!own_call(own, own->pixels, NULL, plain, 2, columns, sizeof columns / sizeof *columns))
    for (uint32_t i = 0; i < p->count; i++)
      p->film_x[i] = (double)NAN;
  PyGILState_Release(state);
}

static void numbers(void *user, const vlOwnSamples *s) {
  Own *own = user;
  PyGILState_STATE state = PyGILState_Ensure();
  const size_t n = sizeof(float);
  const Column columns[] = {{s->x, n, s->count, false},
                            {s->y, n, s->count, false},
                            {s->index, n, s->count, false},
                            {s->u, n, s->count, true},
                            {s->v, n, s->count, true}};
  const long plain[] = {s->dimension, s->seed};
  own_call(own, own->function, NULL, plain, 2, columns, sizeof columns / sizeof *columns);
  PyGILState_Release(state);
}

/* ---- objects ----------------------------------------------------------------------------- */

static void own_dealloc(Own *self) {
  Py_XDECREF(self->function);
  Py_XDECREF(self->pixels);
  Py_XDECREF(self->error);
  free_object((PyObject *)self);
}

/* own_new(kind, name, function, pixels or None, lens) */
static PyObject *own_new(PyObject *module, PyObject *arguments) {
  (void)module;
  static const char *const kinds[] = {"camera", "sampler", "tracer", NULL};
  PyObject *kind, *name, *function, *other;
  int lens;
  if (!PyArg_ParseTuple(arguments, "OOOOp:own_new", &kind, &name, &function, &other, &lens))
    return NULL;
  int found = find_choice(kinds, "kind of own code", kind);
  if (found < 0)
    return NULL;
  PyObject *keep = PyList_New(0);
  const char *text = keep ? keep_text(keep, name, "name") : NULL;
  bool fits = text && strlen(text) > 0 && strlen(text) < VL_OWN_NAME;
  Own *self = fits ? make_object(TYPE_OWN) : NULL;
  if (text && !fits)
    raise_value("name", name, "a text of 1 to %d bytes", VL_OWN_NAME - 1);
  if (self) {
    memcpy(self->name, text, strlen(text) + 1);
    self->kind = (vlOwnKind)found;
    Py_INCREF(function);
    self->function = function;
    if (other != Py_None) {
      Py_INCREF(other);
      self->pixels = other;
    }
    self->camera = (vlOwnCamera){self->name, rays, self->pixels ? pixels : NULL, lens, self};
    self->sampler = (vlOwnSampler){self->name, numbers, self};
    self->tracer = (vlOwnTracer){self->name, own_radiance, self};
  }
  Py_XDECREF(keep);
  return (PyObject *)self;
}

Own *own_read(PyObject *value, vlOwnKind kind, const char *what) {
  static const char *const classes[] = {"velo.OwnCamera", "velo.OwnSampler", "velo.OwnTracer"};
  if (is_object(value, TYPE_OWN) && ((Own *)value)->kind == kind)
    return (Own *)value;
  raise_value(what, value, "a %s", classes[kind]);
  return NULL;
}

const Own *own_of_camera(const vlCamera *camera) {
  return camera && camera->own ? camera->own->user : NULL;
}

const Own *own_of_sampler(const vlRenderDef *def) {
  return def && def->own_sampler ? def->own_sampler->user : NULL;
}

const Own *own_of_tracer(const vlRenderDef *def) {
  return def && def->own_tracer ? def->own_tracer->user : NULL;
}

bool own_check(const Own *own) {
  if (!own || !own->error)
    return true;
  Own *self = (Own *)(uintptr_t)own;
  PyErr_SetObject((PyObject *)Py_TYPE(self->error), self->error);
  Py_CLEAR(self->error);
  return false;
}

static PyType_Slot own_slots[] = {
    {Py_tp_doc, "Code of one's own."},
    {Py_tp_dealloc, own_dealloc},
    {0, NULL},
};
PyType_Spec own_spec = {"velo._velo.Own", sizeof(Own), 0,
                        Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION, own_slots};

PyMethodDef own_functions[] = {
    {"own_new", own_new, METH_VARARGS, "Code of one's own."},
    {NULL, NULL, 0, NULL},
};
