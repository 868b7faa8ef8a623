/* _velo/rays.c: rays of the caller through a world. Arrays of float32 and float64 are read
 * where they are; others are copied. Results are bytearrays, which the package shows as arrays.
 */
#include <string.h>

#include <velo/rays.h>

#include "module.h"

/* Rows of 3 numbers, or one number each, of every ray or of all rays. */
typedef struct Column {
  Py_buffer view; /* view.obj null: not used */
  Numbers numbers;
  vlRayArray array;
  uint64_t count; /* of rows */
  double single;  /* a number for all rays */
} Column;

static void column_release(Column *c) {
  if (c->view.obj)
    PyBuffer_Release(&c->view);
  c->view.obj = NULL;
  numbers_release(&c->numbers);
}

/* Whether the numbers of a buffer can be read where they are: rows at equal steps. */
static bool fits_in_place(const Py_buffer *v, int columns) {
  const char *format = v->format ? v->format : "B";
  bool number = (strcmp(format, "f") == 0 && v->itemsize == sizeof(float)) ||
                (strcmp(format, "d") == 0 && v->itemsize == sizeof(double));
  int axes = columns > 1 ? v->ndim - 1 : v->ndim;
  if (!number || axes < 0 || v->ndim > 32)
    return false;
  if (columns > 1 && (v->shape[axes] != columns || v->strides[axes] != v->itemsize))
    return false;
  for (int i = 0; i + 1 < axes; i++)
    if (v->strides[i] != v->strides[i + 1] * v->shape[i + 1])
      return false;
  return true;
}

static bool column_in_place(PyObject *object, int columns, Column *c) {
  if (!PyObject_CheckBuffer(object) || PyBytes_Check(object) || PyByteArray_Check(object))
    return false;
  if (PyObject_GetBuffer(object, &c->view, PyBUF_RECORDS_RO) < 0) {
    PyErr_Clear();
    c->view.obj = NULL;
    return false;
  }
  if (!fits_in_place(&c->view, columns)) {
    PyBuffer_Release(&c->view);
    c->view.obj = NULL;
    return false;
  }
  int axes = columns > 1 ? c->view.ndim - 1 : c->view.ndim;
  c->count = 1;
  for (int i = 0; i < axes; i++)
    c->count *= (uint64_t)c->view.shape[i];
  c->array = (vlRayArray){.data = c->view.buf,
                          .step = axes > 0 ? (int64_t)c->view.strides[axes - 1] : 0,
                          .doubles = c->view.itemsize == sizeof(double)};
  return true;
}

static bool column_copied(PyObject *object, const char *what, int columns, Column *c) {
  if (!numbers_read_any(object, 'd', what, &c->numbers))
    return false;
  const Numbers *n = &c->numbers;
  bool rows = n->dimensions > 0 && n->shape[n->dimensions - 1] == (size_t)columns;
  if (columns > 1 && !rows) {
    raise_usage("%s: an array of rows of %d numbers", what, columns);
    return false;
  }
  c->count = n->count / (size_t)columns;
  c->array = (vlRayArray){.data = n->count ? n->data : (const void *)"",
                          .step = columns * (int)sizeof(double),
                          .doubles = true};
  return true;
}

/* A single number for all rays. 0: it is none; -1: an exception. */
static int column_single(PyObject *object, Column *c) {
  if (PyObject_CheckBuffer(object) || PySequence_Check(object) || !PyNumber_Check(object))
    return 0;
  int read = to_double(object, &c->single);
  c->count = 1;
  c->array = (vlRayArray){.data = &c->single, .doubles = true};
  return read;
}

/* None is for columns of one number that are not given. */
static bool column_read(PyObject *object, const char *what, int columns, Column *c) {
  if (columns == 1 && object == Py_None)
    return true;
  int single = columns == 1 ? column_single(object, c) : 0;
  if (single)
    return single > 0;
  return column_in_place(object, columns, c) || column_copied(object, what, columns, c);
}

/* ---- the rays of a call ------------------------------------------------------------------ */

enum { ORIGINS, DIRECTIONS, T_MIN, T_MAX, TIMES, COLUMNS };
static const struct {
  const char *name;
  int numbers;
} columns[COLUMNS] = {
    {"origins", 3}, {"directions", 3}, {"t_min", 1}, {"t_max", 1}, {"times", 1}};

/* A call that casts rays. */
typedef struct Casting {
  Column column[COLUMNS];
  const vlWorld *world;
  vlCastRays rays;
  vlCastDef def;
  vlCastHits hits;
  uint8_t *occluded; /* null: hits are asked for */
  vlCastStats stats;
  vlError error;
} Casting;

static void casting_release(Casting *c) {
  for (int i = 0; i < COLUMNS; i++)
    column_release(&c->column[i]);
}

/* The number of rays: that of the rows of each column, unless it has one row for all rays. */
static bool count_rays(Casting *c) {
  int longest = ORIGINS;
  for (int i = 0; i < COLUMNS; i++) {
    const Column *a = &c->column[longest], *b = &c->column[i];
    if (b->array.data && b->count != 1 && a->count == 1)
      longest = i;
  }
  c->rays.count = c->column[longest].count;
  for (int i = 0; i < COLUMNS; i++) {
    Column *b = &c->column[i];
    if (!b->array.data || b->count == c->rays.count)
      continue;
    if (b->count != 1) {
      raise_usage("%s has %llu rows, and %s has %llu: the same number, or 1 for all rays",
                  columns[i].name, (unsigned long long)b->count, columns[longest].name,
                  (unsigned long long)c->rays.count);
      return false;
    }
    b->array.step = 0;
  }
  return true;
}

static bool read_rays(Casting *c, PyObject *const objects[COLUMNS]) {
  for (int i = 0; i < COLUMNS; i++)
    if (!column_read(objects[i], columns[i].name, columns[i].numbers, &c->column[i]))
      return false;
  if (!count_rays(c))
    return false;
  c->rays.origins = c->column[ORIGINS].array;
  c->rays.directions = c->column[DIRECTIONS].array;
  c->rays.t_min = c->column[T_MIN].array;
  c->rays.t_max = c->column[T_MAX].array;
  c->rays.times = c->column[TIMES].array;
  return true;
}

static vlResult run_cast(void *user) {
  Casting *c = user;
  if (c->occluded)
    return vl_world_cast_occluded(c->world, &c->rays, &c->def, c->occluded, &c->stats,
                                  &c->error);
  return vl_world_cast(c->world, &c->rays, &c->def, &c->hits, &c->stats, &c->error);
}

/* Runs the call without the GIL. False: an exception is set. */
static bool cast(World *self, Casting *c) {
  LongCall call;
  vlResult done = VL_OK;
  if (!long_call_begin(&call, self->context, Py_None))
    return false;
  c->world = self->world;
  c->def.cancel = call.cancel;
  self->users++;
  bool fine = long_call_run(&call, NULL, run_cast, c, &done);
  self->users--;
  long_call_end(&call);
  if (fine && done != VL_OK)
    raise_result(done, &c->error);
  return fine && done == VL_OK;
}

static PyObject *stats_object(const vlCastStats *s) {
  return Py_BuildValue("(KKKK)", (unsigned long long)s->met, (unsigned long long)s->not_finite,
                       (unsigned long long)s->zero_directions, (unsigned long long)s->too_far);
}

/* ---- results ----------------------------------------------------------------------------- */

/* The fields of velo.RayHits, in its order: bytes of a row. */
enum { FIELDS = 12, MAX_ROWS_LOG2 = 48 };
static const size_t field_sizes[FIELDS] = {1, 8, 8, 24, 12, 12, 8, 24, 4, 4, 4, 4};

static void point_at(vlCastHits *h, void *const data[FIELDS]) {
  *h = (vlCastHits){.valid = data[0],
                    .t = data[1],
                    .distance = data[2],
                    .position = data[3],
                    .normal = data[4],
                    .shading_normal = data[5],
                    .uv = data[6],
                    .velocity = data[7],
                    .object = data[8],
                    .instance = data[9],
                    .primitive = data[10],
                    .material = data[11]};
}

/* A bytearray, or None, for each field; null with an exception. */
static PyObject *make_fields(const World *self, uint64_t rows, unsigned wanted,
                             void *data[FIELDS]) {
  uint64_t bytes = 0;
  for (int i = 0; i < FIELDS; i++)
    bytes += wanted >> i & 1 ? field_sizes[i] : 0;
  if (rows >> MAX_ROWS_LOG2)
    return raise_usage("%llu rows of hits are too many", (unsigned long long)rows);
  if (!check_memory(self->context, bytes * rows, "the result"))
    return NULL;
  PyObject *fields = PyTuple_New(FIELDS);
  for (int i = 0; fields && i < FIELDS; i++) {
    PyObject *item = Py_None;
    if (wanted >> i & 1)
      item = make_bytes(field_sizes[i] * (size_t)rows, &data[i]);
    else
      Py_INCREF(Py_None);
    if (!item || PyTuple_SetItem(fields, i, item) < 0)
      Py_CLEAR(fields);
  }
  return fields;
}

static PyObject *trace(World *self, Casting *c, unsigned wanted) {
  void *data[FIELDS] = {NULL};
  if (c->rays.count >> MAX_ROWS_LOG2)
    return raise_usage("%llu rays are too many", (unsigned long long)c->rays.count);
  PyObject *fields = make_fields(self, c->rays.count * c->def.hits, wanted, data);
  if (!fields)
    return NULL;
  point_at(&c->hits, data);
  if (!cast(self, c)) {
    Py_DECREF(fields);
    return NULL;
  }
  return Py_BuildValue("(KNN)", (unsigned long long)c->rays.count, fields,
                       stats_object(&c->stats));
}

static bool world_is_open(const World *self) {
  if (!self->world)
    raise_usage("the world is closed");
  return self->world != NULL;
}

PyObject *world_trace(World *self, PyObject *arguments) {
  PyObject *objects[COLUMNS], *hits, *result = NULL;
  unsigned wanted;
  Casting c = {.def = vl_default_cast_def()};
  if (!PyArg_ParseTuple(arguments, "OOOOOOI:_trace", &objects[0], &objects[1], &objects[2],
                        &objects[3], &objects[4], &hits, &wanted) ||
      !world_is_open(self) || !read_count(hits, "hits", 1, VL_MAX_CAST_HITS, &c.def.hits))
    return NULL;
  if (read_rays(&c, objects))
    result = trace(self, &c, wanted);
  casting_release(&c);
  return result;
}

static PyObject *occluded(World *self, Casting *c) {
  void *data = NULL;
  if (c->rays.count >> MAX_ROWS_LOG2)
    return raise_usage("%llu rays are too many", (unsigned long long)c->rays.count);
  if (!check_memory(self->context, c->rays.count, "the result"))
    return NULL;
  PyObject *bytes = make_bytes((size_t)c->rays.count, &data);
  c->occluded = data;
  if (!bytes || !cast(self, c)) {
    Py_XDECREF(bytes);
    return NULL;
  }
  return Py_BuildValue("(KNN)", (unsigned long long)c->rays.count, bytes,
                       stats_object(&c->stats));
}

PyObject *world_occluded(World *self, PyObject *arguments) {
  PyObject *objects[COLUMNS], *result = NULL;
  Casting c = {.def = vl_default_cast_def()};
  if (!PyArg_ParseTuple(arguments, "OOOOO:_occluded", &objects[0], &objects[1], &objects[2],
                        &objects[3], &objects[4]) ||
      !world_is_open(self))
    return NULL;
  if (read_rays(&c, objects))
    result = occluded(self, &c);
  casting_release(&c);
  return result;
}
