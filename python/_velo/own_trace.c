/* _velo/own_trace.c: a tracer of one's own in Python (velo/trace.h): calls of its function, and
 * the questions that it asks. velo/own.py has the layout of the structs as numpy sees it. */
#include <math.h>
#include <string.h>

#include "own.h"

static const char ALIVE[] = "velo.trace", ENDED[] = "velo.trace.ended";

void own_radiance(void *user, vlTrace *trace, const vlOwnPaths *p) {
  Own *own = user;
  PyGILState_STATE state = PyGILState_Ensure();
  PyObject *capsule = PyCapsule_New(trace, ALIVE, NULL);
  const size_t n = sizeof(float);
  const size_t rows = VL_OWN_BATCH * 4 * n;
  const Column columns[] = {
      {p->rays, sizeof *p->rays, 1, false}, {p->x, n, p->count, false},
      {p->y, n, p->count, false},           {p->index, n, p->count, false},
      {p->time, n, p->count, false},        {p->lambda, rows, 1, false},
      {p->white, rows, 1, false},           {p->radiance, rows, 1, true},
      {p->alpha, n, p->count, true}};
  const long plain[] = {p->count, p->max_depth};
  bool good = capsule && own_call(own, own->function, capsule, plain, 2, columns,
                                  sizeof columns / sizeof *columns);
  for (uint32_t i = 0; !good && i < p->count; i++)
    p->radiance[0][i] = NAN;
  if (capsule)
    PyCapsule_SetName(capsule, ENDED);
  Py_XDECREF(capsule);
  PyGILState_Release(state);
}

/* ---- questions --------------------------------------------------------------------------- */

enum { ROW = VL_OWN_BATCH * sizeof(float) };
typedef enum Question {
  HITS,
  OCCLUDED,
  LEAVE,
  LIGHTS,
  BSDF,
  BOUNCE,
  NUMBERS,
  QUESTIONS
} Question;
static const struct {
  const char *name;
  size_t input, output; /* bytes */
} questions[QUESTIONS] = {[HITS] = {"hits", sizeof(vlTraceRays), sizeof(vlTraceHits)},
                          [OCCLUDED] = {"occluded", sizeof(vlTraceRays), VL_OWN_BATCH},
                          [LEAVE] = {"leave", 3 * ROW, sizeof(vlTraceRays)},
                          [LIGHTS] = {"lights", 0, sizeof(vlTraceLights)},
                          [BSDF] = {"bsdf", 3 * ROW, 5 * ROW},
                          [BOUNCE] = {"bounce", 0, sizeof(vlTraceBounce)},
                          [NUMBERS] = {"numbers", 0, 2 * ROW}};

static void answer(Question question, vlTrace *trace, uint32_t number, void *in, void *out) {
  float(*rows)[VL_OWN_BATCH] = out;
  switch (question) {
    case HITS:
      vl_world_trace(trace, in, out);
      break;
    case OCCLUDED:
      vl_world_occluded(trace, in, out);
      break;
    case LEAVE:
      vl_trace_leave(trace, in, out);
      break;
    case LIGHTS:
      vl_trace_lights(trace, number, out);
      break;
    case BSDF:
      vl_trace_bsdf(trace, in, rows, rows[4]);
      break;
    case BOUNCE:
      vl_trace_bounce(trace, number, out);
      break;
    case NUMBERS:
      vl_trace_numbers(trace, number, rows[0], rows[1]);
      break;
    case QUESTIONS:
      break;
  }
}

/* trace_ask(trace, question, number, input or None, output) */
static PyObject *trace_ask(PyObject *module, PyObject *arguments) {
  (void)module;
  PyObject *capsule, *input, *output;
  const char *name;
  unsigned int number;
  if (!PyArg_ParseTuple(arguments, "OsIOO:trace_ask", &capsule, &name, &number, &input,
                        &output))
    return NULL;
  if (!PyCapsule_IsValid(capsule, ALIVE))
    return raise_usage("the trace is over: it lives during the call of the tracer");
  vlTrace *trace = PyCapsule_GetPointer(capsule, ALIVE);
  int question = 0;
  while (question < QUESTIONS && strcmp(questions[question].name, name) != 0)
    question++;
  if (question == QUESTIONS)
    return raise_usage("no question %s", name);
  Py_buffer in = {0}, out = {0};
  if (input != Py_None && PyObject_GetBuffer(input, &in, PyBUF_SIMPLE) != 0)
    return NULL;
  bool good = PyObject_GetBuffer(output, &out, PyBUF_WRITABLE) == 0;
  bool fits = good && (size_t)in.len == questions[question].input &&
              (size_t)out.len == questions[question].output;
  if (fits) {
    PyThreadState *thread = PyEval_SaveThread();
    answer((Question)question, trace, number, in.buf, out.buf);
    PyEval_RestoreThread(thread);
  } else if (good) {
    raise_usage("%s: buffers of another size", name);
  }
  if (good)
    PyBuffer_Release(&out);
  if (input != Py_None)
    PyBuffer_Release(&in);
  if (!fits)
    return NULL;
  Py_RETURN_NONE;
}

PyMethodDef own_trace_functions[] = {
    {"trace_ask", trace_ask, METH_VARARGS, "A question of a tracer of one's own."},
    {NULL, NULL, 0, NULL},
};
