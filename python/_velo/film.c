/* _velo/film.c: films: developed images, films in files, merging. */
#include <math.h>
#include <string.h>

#include "module.h"

static PyObject *film_object(Context *context, vlFilm *film, const vlFilmDef *def) {
  Film *self = make_object(TYPE_FILM);
  if (!self) {
    vl_film_destroy(film);
    return NULL;
  }
  Py_INCREF((PyObject *)context);
  self->context = context;
  self->film = film;
  self->def = *def;
  self->def.sensor = NULL;
  return (PyObject *)self;
}

static void film_dealloc(Film *self) {
  if (context_is_ours(self->context))
    vl_film_destroy(self->film);
  Py_XDECREF((PyObject *)self->context);
  free_object((PyObject *)self);
}

/* False with an exception: closed, or a render adds to it. */
static bool readable(Film *self) {
  if (!self->film) {
    raise_usage("the film is closed");
    return false;
  }
  if (self->busy && open_film != self) {
    raise_usage("a render is adding to the film: read it after a pass (progress.pass_done)");
    return false;
  }
  return true;
}

static PyObject *film_new(PyObject *module, PyObject *arguments) {
  (void)module;
  Context *context;
  Settings *settings;
  if (!PyArg_ParseTuple(arguments, "O!O!:film_new", base_types[TYPE_CONTEXT], &context,
                        base_types[TYPE_SETTINGS], &settings))
    return NULL;
  const uint32_t *c = settings->defs.film.crop;
  char what[96]; /* the film and its developed image */
  PyOS_snprintf(what, sizeof what, "an image of %u x %u pixels", c[2] - c[0], c[3] - c[1]);
  uint64_t image = 16 * (uint64_t)(c[2] - c[0]) * (c[3] - c[1]);
  if (!check_memory(context, vl_film_memory(&settings->defs.film) + image, what))
    return NULL;
  Call call;
  if (!call_begin(&call, context, NULL))
    return NULL;
  vlFilm *film = NULL;
  vlResult done = vl_film_create(context->context, &settings->defs.film, &film);
  call_end(&call);
  if (done == VL_ERROR_ARGUMENT)
    return raise_usage("film: a size, crop, filter, sensor or range of wavelengths is wrong");
  return done == VL_OK ? film_object(context, film, &settings->defs.film)
                       : raise_result(done, NULL);
}

typedef vlResult Develop(const vlFilm *, const vlDevelopDef *, vlImage **);
static vlResult spectrum(const vlFilm *film, const vlDevelopDef *def, vlImage **image) {
  (void)def;
  return vl_film_spectrum(film, image);
}

static PyObject *film_image(Film *self, PyObject *arguments) {
  static const char *const kinds[] = {"color", "errors", "spectrum", NULL};
  static Develop *const functions[] = {vl_film_develop, vl_film_errors, spectrum};
  PyObject *name, *number;
  double exposure;
  if (!PyArg_ParseTuple(arguments, "OO:_image", &name, &number) || !readable(self) ||
      !read_row(number, "exposure", vl_setting(VL_SETTING_RENDER, "exposure"), &exposure))
    return NULL;
  int kind = find_choice(kinds, "kind of image", name);
  vlDevelopDef def = vl_default_develop_def();
  def.exposure = (float)exposure;
  Call call;
  bool own = !self->busy;
  if (kind < 0 || !call_begin(&call, self->context, own ? &self->busy : NULL))
    return NULL;
  vlImage *image = NULL;
  vlResult done = functions[kind](self->film, &def, &image);
  call_end(&call);
  if (done == VL_ERROR_ARGUMENT)
    return raise_usage(kind == 1 ? "the film was made without errors=True"
                                 : "the film was made without buckets");
  return done == VL_OK ? image_object(self->context, image) : raise_result(done, NULL);
}

static PyObject *film_write(Film *self, PyObject *path) {
  PyObject *keep = PyList_New(0);
  const char *file = keep ? keep_path(keep, path, "path") : NULL;
  Call call;
  bool own = !self->busy;
  if (!file || !readable(self) || !call_begin(&call, self->context, own ? &self->busy : NULL)) {
    Py_XDECREF(keep);
    return NULL;
  }
  vlError error = {0};
  vlResult done = vl_film_write(self->film, NULL, file, &error);
  call_end(&call);
  Py_DECREF(keep);
  if (done != VL_OK)
    return raise_result(done, &error);
  Py_RETURN_NONE;
}

/* film_read(context, path, partial) */
static PyObject *film_read(PyObject *module, PyObject *arguments) {
  (void)module;
  Context *context;
  PyObject *path, *flag, *keep = PyList_New(0), *result = NULL;
  bool partial;
  Call call;
  if (!keep ||
      !PyArg_ParseTuple(arguments, "O!OO:film_read", base_types[TYPE_CONTEXT], &context, &path,
                        &flag) ||
      !read_flag(flag, "partial", &partial))
    goto end;
  const char *file = keep_path(keep, path, "path");
  if (!file || !call_begin(&call, context, NULL))
    goto end;
  vlError error = {0};
  vlFilm *film = NULL;
  vlFilmFile *header = NULL;
  vlFilmDef def = vl_default_film_def(1, 1);
  vlResult done = vl_film_file_open(context->context, file, &header, &error);
  if (done == VL_OK)
    def = *vl_film_file_def(header);
  vl_film_file_close(header);
  if (done == VL_OK)
    done = vl_film_read(context->context, file, partial, &film, &error);
  call_end(&call);
  result = done == VL_OK ? film_object(context, film, &def) : raise_result(done, &error);
end:
  Py_XDECREF(keep);
  return result;
}

/* film_merge(context, [paths], output, overwrite) */
static PyObject *film_merge(PyObject *module, PyObject *arguments) {
  (void)module;
  Context *context;
  PyObject *paths, *output, *keep = PyList_New(0);
  const char **texts = NULL;
  PyObject *flag;
  bool overwrite;
  if (!keep ||
      !PyArg_ParseTuple(arguments, "O!O!OO:film_merge", base_types[TYPE_CONTEXT], &context,
                        &PyList_Type, &paths, &output, &flag) ||
      !read_flag(flag, "overwrite", &overwrite))
    goto fail;
  Py_ssize_t count = PyList_Size(paths);
  texts = PyMem_Malloc((size_t)(count + 1) * sizeof *texts);
  const char *file = texts ? keep_path(keep, output, "output") : NULL;
  for (Py_ssize_t i = 0; file && i < count; i++)
    if (!(texts[i] = keep_path(keep, PyList_GetItem(paths, i), "an item of paths")))
      goto fail;
  Call call;
  if (!file || !call_begin(&call, context, NULL))
    goto fail;
  vlError error = {0};
  vlFilmMergeDef def = vl_default_film_merge_def();
  def.overwrite = overwrite;
  vlResult done = vl_film_merge(context->context, texts, (uint32_t)count, &def, file, &error);
  call_end(&call);
  PyMem_Free((void *)texts);
  Py_DECREF(keep);
  if (done != VL_OK)
    return raise_result(done, &error);
  Py_RETURN_NONE;
fail:
  PyMem_Free((void *)texts);
  Py_XDECREF(keep);
  return NULL;
}

static PyObject *film_spp(Film *self, void *unused) {
  (void)unused;
  return readable(self) ? PyLong_FromUnsignedLong(vl_film_spp(self->film)) : NULL;
}
static PyObject *film_size(Film *self, void *unused) {
  (void)unused;
  return Py_BuildValue("(II)", self->def.width, self->def.height);
}
static PyObject *film_crop(Film *self, void *unused) {
  (void)unused;
  const uint32_t *c = self->def.crop;
  return Py_BuildValue("(IIII)", c[0], c[1], c[2], c[3]);
}
static PyObject *film_clear(Film *self, PyObject *unused) {
  (void)unused;
  if (!self->film || self->busy)
    return raise_usage(self->film ? "a render is adding to the film" : "the film is closed");
  if (!context_check(self->context))
    return NULL;
  vl_film_clear(self->film);
  Py_RETURN_NONE;
}
static PyObject *film_close(Film *self, PyObject *unused) {
  (void)unused;
  if (self->busy)
    return raise_usage("a render is adding to the film");
  if (context_is_ours(self->context))
    vl_film_destroy(self->film);
  self->film = NULL;
  Py_RETURN_NONE;
}

static PyMethodDef film_methods[] = {
    {"_image", (PyCFunction)film_image, METH_VARARGS, "Develops the film: kind, exposure."},
    {"_write", (PyCFunction)film_write, METH_O, "Writes a film file."},
    {"clear", (PyCFunction)film_clear, METH_NOARGS, "clear()\n--\n\nRemoves all samples."},
    {"_close", (PyCFunction)film_close, METH_NOARGS, "Frees the film."},
    {NULL, NULL, 0, NULL},
};
static PyGetSetDef film_members[] = {
    {"spp", (getter)film_spp, NULL, "Samples per pixel, of finished passes.", NULL},
    {"resolution", (getter)film_size, NULL, "Width and height of the whole image, pixels.",
     NULL},
    {"crop", (getter)film_crop, NULL,
     "The pixels that are rendered: x0, y0, x1, y1; x1, y1 exclusive.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};
static PyType_Slot film_slots[] = {
    {Py_tp_doc, "The samples of an image."},
    {Py_tp_dealloc, film_dealloc},
    {Py_tp_methods, film_methods},
    {Py_tp_getset, film_members},
    {0, NULL},
};
PyType_Spec film_spec = {
    "velo._velo.Film", sizeof(Film), 0,
    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_DISALLOW_INSTANTIATION, film_slots};

PyMethodDef film_functions[] = {
    {"film_new", film_new, METH_VARARGS, "An empty film: context, settings."},
    {"film_read", film_read, METH_VARARGS, "Reads a film file: context, path, partial."},
    {"film_merge", film_merge, METH_VARARGS,
     "Merges film files: context, list of paths, output, overwrite."},
    {NULL, NULL, 0, NULL},
};
