/* _velo/image.c: images and their channels as buffers; image files, views, comparison. */
#include <string.h>

#include "module.h"

PyObject *image_object(Context *context, vlImage *image) {
  Image *self = image ? make_object(TYPE_IMAGE) : NULL;
  if (!self) {
    vl_image_destroy(image);
    return image ? NULL : raise_usage("no image");
  }
  Py_INCREF((PyObject *)context);
  self->context = context;
  self->image = image;
  return (PyObject *)self;
}

static void image_dealloc(Image *self) {
  if (context_is_ours(self->context))
    vl_image_destroy(self->image);
  Py_XDECREF((PyObject *)self->context);
  free_object((PyObject *)self);
}

static vlImage *open_image(Image *self) {
  if (!self->image) {
    raise_usage("the image is closed");
    return NULL;
  }
  return self->image;
}

/* ---- buffers: rows, columns, channels ---------------------------------------------------- */

static const char *const formats[] = {"B", "H", "e", "f", "I"};
static const Py_ssize_t sizes[] = {1, 2, 2, 4, 4};

typedef struct Layout {
  Py_ssize_t shape[3], strides[3];
} Layout;

static int fill_view(PyObject *self, Image *image, uint32_t first, uint32_t count, bool flat,
                     Py_buffer *view, int flags) {
  view->obj = NULL;
  vlImage *pixels = open_image(image);
  if (!pixels) {
    PyErr_SetString(PyExc_BufferError, "the image is closed");
    return -1;
  }
  uint32_t channels = vl_image_channels(pixels), type = (uint32_t)vl_image_type(pixels);
  bool part = count != channels;
  if (part && (flags & PyBUF_STRIDES) != PyBUF_STRIDES) {
    PyErr_SetString(PyExc_BufferError, "some channels of an image are not contiguous");
    return -1;
  }
  Layout *layout = PyMem_Malloc(sizeof *layout);
  if (!layout) {
    PyErr_NoMemory();
    return -1;
  }
  Py_ssize_t size = sizes[type], width = (Py_ssize_t)vl_image_width(pixels),
             height = (Py_ssize_t)vl_image_height(pixels);
  *layout = (Layout){{height, width, (Py_ssize_t)count},
                     {width * (Py_ssize_t)channels * size, (Py_ssize_t)channels * size, size}};
  view->buf = (char *)vl_image_pixels(pixels) + (Py_ssize_t)first * size;
  view->len = width * height * (Py_ssize_t)count * size;
  view->itemsize = size;
  view->readonly = 0;
  view->ndim = flat ? 2 : 3;
  view->format = flags & PyBUF_FORMAT ? (char *)(uintptr_t)formats[type] : NULL;
  view->shape = flags & PyBUF_ND ? layout->shape : NULL;
  view->strides = (flags & PyBUF_STRIDES) == PyBUF_STRIDES ? layout->strides : NULL;
  view->suboffsets = NULL;
  view->internal = layout;
  if (!(flags & PyBUF_ND))
    view->ndim = 1;
  Py_INCREF((PyObject *)self);
  view->obj = self;
  image->exports++;
  return 0;
}

static int image_buffer(Image *self, Py_buffer *view, int flags) {
  return fill_view((PyObject *)self, self, 0, self->image ? vl_image_channels(self->image) : 0,
                   false, view, flags);
}
static void image_release(Image *self, Py_buffer *view) {
  PyMem_Free(view->internal);
  self->exports--;
}
static int plane_buffer(Plane *self, Py_buffer *view, int flags) {
  return fill_view((PyObject *)self, self->image, self->first, self->count, self->flat, view,
                   flags);
}
static void plane_release(Plane *self, Py_buffer *view) {
  PyMem_Free(view->internal);
  self->image->exports--;
}
static void plane_dealloc(Plane *self) {
  Py_XDECREF((PyObject *)self->image);
  free_object((PyObject *)self);
}

static PyObject *image_plane(Image *self, PyObject *arguments) {
  unsigned first, count;
  int flat;
  if (!PyArg_ParseTuple(arguments, "IIp:_plane", &first, &count, &flat) || !open_image(self))
    return NULL;
  uint32_t channels = vl_image_channels(self->image);
  if (count == 0 || first >= channels || count > channels - first || (flat && count != 1))
    return raise_usage("the image has no such channels");
  Plane *plane = make_object(TYPE_PLANE);
  if (!plane)
    return NULL;
  Py_INCREF((PyObject *)self);
  *plane = (Plane){.ob_base = plane->ob_base,
                   .image = self,
                   .first = first,
                   .count = count,
                   .flat = flat != 0};
  return (PyObject *)plane;
}

/* ---- new images -------------------------------------------------------------------------- */

static const char *const encodings[] = {"linear", "srgb", "gamma", NULL};

/* image_new(context, array, names or None, encoding) */
static PyObject *image_new(PyObject *module, PyObject *arguments) {
  (void)module;
  PyObject *array, *names, *encoding, *keep = NULL, *result = NULL;
  Context *context;
  if (!PyArg_ParseTuple(arguments, "O!OOO:image_new", base_types[TYPE_CONTEXT], &context,
                        &array, &names, &encoding))
    return NULL;
  int code = find_choice(encodings, "encoding", encoding);
  if (code < 0)
    return NULL;
  Py_buffer view;
  if (PyBytes_Check(array) || PyObject_GetBuffer(array, &view, PyBUF_FULL_RO) < 0)
    return raise_value("image", array, "an array of rows x columns x channels");
  const char *format = view.format ? view.format : "B";
  if (*format == '<' || *format == '=' || *format == '@')
    format++;
  int type = -1;
  for (int i = 0; i < 5; i++)
    if (strcmp(formats[i], format) == 0)
      type = i;
  if (type < 0 && strcmp(format, "L") == 0 && view.itemsize == 4)
    type = VL_PIXEL_U32;
  vlImage *image = NULL;
  const char *texts[1024];
  if (view.ndim < 2 || view.ndim > 3 || view.shape[0] < 1 || view.shape[1] < 1 ||
      view.shape[0] > 1 << 24 || view.shape[1] > 1 << 24 ||
      (view.ndim == 3 && (view.shape[2] < 1 || view.shape[2] > 1024))) {
    raise_usage(
        "an image is an array of rows x columns, or of rows x columns x channels (at most "
        "1024)");
    goto end;
  }
  bool convert = type < 0;
  vlImageDef def = vl_default_image_def((uint32_t)view.shape[1], (uint32_t)view.shape[0],
                                        view.ndim == 3 ? (uint32_t)view.shape[2] : 1);
  def.type = convert ? VL_PIXEL_F32 : (vlPixelType)type;
  def.encoding = (vlEncoding)code;
  if (names != Py_None) {
    keep = PyList_New(0);
    Py_ssize_t count = sequence_size(names, "names", def.channels, def.channels);
    if (!keep || count < 0 || !keep_texts(keep, names, count, "names", texts))
      goto end;
    def.names = texts;
  }
  if (!context_check(context))
    goto end;
  vlResult made = vl_image_create(context->context, &def, &image);
  if (made != VL_OK) {
    raise_result(made, NULL);
    goto end;
  }
  if (convert) {
    Numbers n;
    if (!numbers_read_any(array, 'f', "image", &n))
      goto end;
    memcpy(vl_image_pixels(image), n.data, n.count * sizeof(float));
    numbers_release(&n);
  } else if (PyBuffer_ToContiguous(vl_image_pixels(image), &view, view.len, 'C') < 0) {
    goto end;
  }
  result = image_object(context, image);
  image = NULL;
end:
  vl_image_destroy(image);
  Py_XDECREF(keep);
  PyBuffer_Release(&view);
  return result;
}

/* image_read(context, path, names or None) */
static PyObject *image_read(PyObject *module, PyObject *arguments) {
  (void)module;
  Context *context;
  PyObject *path, *names, *keep = PyList_New(0), *result = NULL;
  const char *texts[1024];
  Py_ssize_t count = 0;
  if (!keep || !PyArg_ParseTuple(arguments, "O!OO:image_read", base_types[TYPE_CONTEXT],
                                 &context, &path, &names))
    goto end;
  const char *file = keep_path(keep, path, "path");
  if (!file)
    goto end;
  if (names != Py_None && (count = sequence_size(names, "channels", 1, 1024)) < 0)
    goto end;
  if (!keep_texts(keep, names, count, "channels", texts))
    goto end;
  Call call;
  if (!call_begin(&call, context, NULL))
    goto end;
  vlError error = {0};
  vlImage *image = NULL;
  vlResult done = count ? vl_image_read_channels(context->context, file, texts, (uint32_t)count,
                                                 &image, &error)
                        : vl_image_read(context->context, file, &image, &error);
  call_end(&call);
  result = done == VL_OK ? image_object(context, image) : raise_result(done, &error);
end:
  Py_XDECREF(keep);
  return result;
}

/* image_write([images], path, keywords) */
static PyObject *image_write(PyObject *module, PyObject *arguments) {
  (void)module;
  PyObject *images, *path, *keywords, *keep = PyList_New(0);
  const vlImage *list[64];
  vlImage *shown[64] = {NULL}; /* ids as other programs show them */
  if (!keep || !PyArg_ParseTuple(arguments, "O!OO!:image_write", &PyList_Type, &images, &path,
                                 &PyDict_Type, &keywords)) {
    Py_XDECREF(keep);
    return NULL;
  }
  vlWriteDef def = vl_default_write_def();
  const Target target = {(char *)&def, keep, NULL, false};
  const char *file = keep_path(keep, path, "path");
  Py_ssize_t count = PyList_Size(images);
  if (!file ||
      !set_parameters(&target, VL_SETTING_WRITE, "option of an image file", keywords)) {
    Py_DECREF(keep);
    return NULL;
  }
  if (count < 1 || count > 64) {
    Py_DECREF(keep);
    return raise_usage("1 to 64 images");
  }
  Context *context = NULL;
  for (Py_ssize_t i = 0; i < count; i++) {
    PyObject *item = PyList_GetItem(images, i);
    if (!is_object(item, TYPE_IMAGE) || !open_image((Image *)item)) {
      Py_DECREF(keep);
      return PyErr_Occurred() ? NULL : raise_usage("expected an Image");
    }
    list[i] = ((Image *)item)->image;
    context = ((Image *)item)->context;
  }
  Call call;
  if (!call_begin(&call, context, NULL)) {
    Py_DECREF(keep);
    return NULL;
  }
  vlError error = {0};
  vlResult done = VL_OK;
  for (Py_ssize_t i = 0; i < count && done == VL_OK; i++)
    if (vl_image_type(list[i]) == VL_PIXEL_U32) {
      done = vl_image_show_ids(list[i], &shown[i]);
      list[i] = shown[i];
    }
  if (done == VL_OK)
    done = count == 1 ? vl_image_write(list[0], file, &def, &error)
                      : vl_image_write_layers(list, (uint32_t)count, file, &def, &error);
  for (Py_ssize_t i = 0; i < count; i++)
    vl_image_destroy(shown[i]);
  call_end(&call);
  Py_DECREF(keep);
  if (done != VL_OK)
    return raise_result(done, &error);
  Py_RETURN_NONE;
}

/* ---- views and comparison ---------------------------------------------------------------- */

static PyObject *image_view(Image *self, PyObject *arguments) {
  static const char *const views[] = {"standard", "khronos_neutral", "agx", "raw", NULL};
  PyObject *name, *number;
  double exposure;
  if (!PyArg_ParseTuple(arguments, "OO:_view", &name, &number) || !open_image(self) ||
      !read_row(number, "exposure", vl_setting(VL_SETTING_PROGRAM, "exposure"), &exposure))
    return NULL;
  int view = find_choice(views, "view", name);
  Call call;
  if (view < 0 || !call_begin(&call, self->context, NULL))
    return NULL;
  vlImage *image = NULL;
  vlResult done = vl_image_view(self->image, (vlView)view, (float)exposure, NULL, &image);
  call_end(&call);
  return done == VL_OK ? image_object(self->context, image) : raise_result(done, NULL);
}

/* _compare(reference, heat): {measure: number}, and the image of differences or None. */
static PyObject *image_compare(Image *self, PyObject *arguments) {
  PyObject *other;
  int wanted;
  if (!PyArg_ParseTuple(arguments, "O!p:_compare", base_types[TYPE_IMAGE], &other, &wanted))
    return NULL;
  Image *reference = (Image *)other;
  if (!open_image(self) || !open_image(reference))
    return NULL;
  Call call;
  if (!call_begin(&call, self->context, NULL))
    return NULL;
  vlImageDiff d;
  vlError error = {0};
  vlImage *heat = NULL;
  vlResult done =
      vl_image_compare(reference->image, self->image, &d, wanted ? &heat : NULL, &error);
  call_end(&call);
  if (done != VL_OK)
    return raise_result(done, &error);
  PyObject *map = heat ? image_object(self->context, heat) : (Py_INCREF(Py_None), Py_None);
  if (!map)
    return NULL;
  return Py_BuildValue("{s:d,s:d,s:d,s:d,s:d,s:d,s:K,s:K}N", "mse", d.mse, "rel_mse", d.rel_mse,
                       "psnr", d.psnr, "flip", d.flip, "mean_ratio", d.mean_ratio, "max_abs",
                       d.max_abs, "differing", (unsigned long long)d.differing, "not_finite",
                       (unsigned long long)d.not_finite, map);
}

/* _unset([names]): an image of this size of 32-bit floats, in the same context, whose values
 * the caller sets. */
static PyObject *image_unset(Image *self, PyObject *names) {
  const char *texts[1024];
  if (!open_image(self) || !context_check(self->context))
    return NULL;
  Py_ssize_t count = sequence_size(names, "names", 1, 1024);
  PyObject *keep = PyList_New(0), *result = NULL;
  if (keep && count > 0 && keep_texts(keep, names, count, "names", texts)) {
    vlImageDef def = vl_default_image_def(vl_image_width(self->image),
                                          vl_image_height(self->image), (uint32_t)count);
    def.names = texts;
    def.unset = true;
    vlImage *image = NULL;
    vlResult made = vl_image_create(self->context->context, &def, &image);
    result = made == VL_OK ? image_object(self->context, image) : raise_result(made, NULL);
  }
  Py_XDECREF(keep);
  return result;
}

typedef struct Denoising {
  const vlImage *image;
  vlDenoiseDef def;
  vlImage *clean;
  vlDenoiseStats stats;
  vlError error;
} Denoising;
static vlResult run_denoise(void *user) {
  Denoising *d = user;
  return vl_denoise(d->image, &d->def, &d->clean, &d->stats, &d->error);
}

/* False: warnings are exceptions here. */
static bool warn_not_finite(const vlDenoiseStats *stats) {
  enum { OF_DENOISE = 3 }; /* whose caller the warning names */
  return !stats->not_finite ||
         PyErr_WarnFormat(
             PyExc_RuntimeWarning, OF_DENOISE,
             "%llu pixels are not finite; the denoised image has their neighbours' light there",
             (unsigned long long)stats->not_finite) == 0;
}

/* _denoise(denoiser, poll or None) */
static PyObject *image_denoise(Image *self, PyObject *arguments) {
  static const char *const denoisers[] = {"velo", "oidn", NULL};
  PyObject *denoiser, *poll;
  if (!PyArg_ParseTuple(arguments, "OO:_denoise", &denoiser, &poll))
    return NULL;
  int kind = find_choice(denoisers, "denoiser", denoiser);
  if (kind < 0 || !open_image(self))
    return NULL;
  Denoising d = {.image = self->image, .def = vl_default_denoise_def()};
  d.def.denoiser = (vlDenoiser)kind;
  LongCall call;
  if (!long_call_begin(&call, self->context, Py_None))
    return NULL;
  d.def.cancel = call.cancel;
  vlResult done;
  bool fine = long_call_poll(&call, poll) && long_call_run(&call, NULL, run_denoise, &d, &done);
  long_call_end(&call);
  if (fine && done != VL_OK)
    return raise_result(done, &d.error);
  if (!fine || !warn_not_finite(&d.stats)) {
    vl_image_destroy(d.clean);
    return NULL;
  }
  return image_object(self->context, d.clean);
}

/* ---- attributes -------------------------------------------------------------------------- */

static PyObject *image_attributes(Image *self, void *unused) {
  static const int counts[] = {1, 1, 0, 2, 3, 9, 16, 4, 8, 1, 16, 0};
  (void)unused;
  if (!open_image(self))
    return NULL;
  PyObject *result = PyDict_New();
  for (uint32_t i = 0; result && i < vl_image_attribute_count(self->image); i++) {
    vlAttribute a;
    vl_image_attribute(self->image, i, &a);
    int count = counts[a.type];
    PyObject *value = NULL;
    if (count == 0) {
      value = text_object(a.string);
    } else if (count == 1) {
      value = a.type == VL_ATTRIBUTE_INT ? PyLong_FromLong((long)a.numbers[0])
                                         : PyFloat_FromDouble(a.numbers[0]);
    } else {
      value = PyTuple_New(count);
      for (int k = 0; value && k < count; k++)
        PyTuple_SetItem(value, k, PyFloat_FromDouble(a.numbers[k]));
    }
    PyObject *name = value ? text_object(a.name) : NULL;
    if (!name || PyDict_SetItem(result, name, value) < 0)
      Py_CLEAR(result);
    Py_XDECREF(name);
    Py_XDECREF(value);
  }
  return result;
}

enum { MAX_NUMBERS = 16 }; /* of an attribute */

/* _attributes(): a list of (name, type, text or None, 16 numbers), for pickle. */
static PyObject *image_pickled_attributes(Image *self, PyObject *unused) {
  (void)unused;
  if (!open_image(self))
    return NULL;
  PyObject *list = PyList_New(0);
  for (uint32_t i = 0; list && i < vl_image_attribute_count(self->image); i++) {
    vlAttribute a;
    vl_image_attribute(self->image, i, &a);
    PyObject *numbers = PyTuple_New(MAX_NUMBERS);
    for (int k = 0; numbers && k < MAX_NUMBERS; k++)
      PyTuple_SetItem(numbers, k, PyFloat_FromDouble(a.numbers[k]));
    const bool text = a.type == VL_ATTRIBUTE_STRING || a.type == VL_ATTRIBUTE_STRINGS;
    PyObject *item =
        numbers ? Py_BuildValue("(yizN)", a.name, (int)a.type, text ? a.string : NULL, numbers)
                : NULL;
    if (!item || PyList_Append(list, item) < 0)
      Py_CLEAR(list);
    Py_XDECREF(item);
  }
  return list;
}

/* _set_attributes(list): those of _attributes(). */
static PyObject *image_set_attributes(Image *self, PyObject *list) {
  if (!open_image(self))
    return NULL;
  const Py_ssize_t count = sequence_size(list, "attributes", 0, 1 << 20);
  for (Py_ssize_t i = 0; i < count; i++) {
    PyObject *item = PySequence_GetItem(list, i), *numbers = NULL;
    vlAttribute a = {0};
    int type = -1;
    bool fine = item &&
                PyArg_ParseTuple(item, "yizO:attribute", &a.name, &type, &a.string, &numbers) &&
                numbers_copy(numbers, "an attribute", MAX_NUMBERS, a.numbers);
    if (fine && (type < 0 || type > VL_ATTRIBUTE_STRINGS)) {
      raise_usage("an attribute has an unknown type");
      fine = false;
    }
    a.type = (vlAttributeType)type;
    if (fine && !a.string)
      a.string = "";
    vlResult done = fine ? vl_image_set_attribute(self->image, &a) : VL_OK;
    if (done != VL_OK)
      raise_result(done, NULL);
    Py_XDECREF(item);
    if (!fine || done != VL_OK)
      return NULL;
  }
  if (count < 0)
    return NULL;
  Py_RETURN_NONE;
}

static PyObject *image_names(Image *self, void *unused) {
  (void)unused;
  if (!open_image(self))
    return NULL;
  uint32_t count = vl_image_channels(self->image);
  PyObject *names = PyTuple_New((Py_ssize_t)count);
  for (uint32_t i = 0; names && i < count; i++) {
    PyObject *name = text_object(vl_image_channel_name(self->image, i));
    if (!name || PyTuple_SetItem(names, (Py_ssize_t)i, name) < 0)
      Py_CLEAR(names);
  }
  return names;
}
static PyObject *image_width(Image *self, void *unused) {
  (void)unused;
  return open_image(self) ? PyLong_FromUnsignedLong(vl_image_width(self->image)) : NULL;
}
static PyObject *image_height(Image *self, void *unused) {
  (void)unused;
  return open_image(self) ? PyLong_FromUnsignedLong(vl_image_height(self->image)) : NULL;
}
static PyObject *image_encoding(Image *self, void *unused) {
  (void)unused;
  return open_image(self) ? PyUnicode_FromString(encodings[vl_image_encoding(self->image)])
                          : NULL;
}

static PyObject *image_close(Image *self, PyObject *unused) {
  (void)unused;
  if (self->exports) {
    PyErr_SetString(PyExc_BufferError, "arrays share the image's memory: it cannot be closed");
    return NULL;
  }
  if (context_is_ours(self->context))
    vl_image_destroy(self->image);
  self->image = NULL;
  Py_RETURN_NONE;
}

static PyMethodDef image_methods[] = {
    {"_plane", (PyCFunction)image_plane, METH_VARARGS,
     "Channels as a buffer: first, count, flat."},
    {"_view", (PyCFunction)image_view, METH_VARARGS,
     "8-bit image for displays: view, exposure."},
    {"_compare", (PyCFunction)image_compare, METH_VARARGS, "Differences from a reference."},
    {"_unset", (PyCFunction)image_unset, METH_O, "An image of the same size, not set."},
    {"_denoise", (PyCFunction)image_denoise, METH_VARARGS, "A denoised copy."},
    {"_close", (PyCFunction)image_close, METH_NOARGS, "Frees the pixels."},
    {"_attributes", (PyCFunction)image_pickled_attributes, METH_NOARGS,
     "The attributes, for pickle."},
    {"_set_attributes", (PyCFunction)image_set_attributes, METH_O,
     "Sets those of _attributes()."},
    {NULL, NULL, 0, NULL},
};
static PyGetSetDef image_members[] = {
    {"width", (getter)image_width, NULL, "Pixels in a row.", NULL},
    {"height", (getter)image_height, NULL, "Number of rows.", NULL},
    {"_names", (getter)image_names, NULL, "Names of the channels.", NULL},
    {"encoding", (getter)image_encoding, NULL, "Encoding of integers: linear, srgb or gamma.",
     NULL},
    {"attributes", (getter)image_attributes, NULL,
     "Attributes by name, those of OpenEXR headers.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};
static PyType_Slot image_slots[] = {
    {Py_tp_doc, "Pixels: a buffer of rows x columns x channels."},
    {Py_tp_dealloc, image_dealloc},
    {Py_tp_methods, image_methods},
    {Py_tp_getset, image_members},
    {Py_bf_getbuffer, image_buffer},
    {Py_bf_releasebuffer, image_release},
    {0, NULL},
};
PyType_Spec image_spec = {
    "velo._velo.Image", sizeof(Image), 0,
    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_DISALLOW_INSTANTIATION, image_slots};
static PyType_Slot plane_slots[] = {
    {Py_tp_doc,
     "Some channels of an image: a buffer of rows x columns, or of rows x columns x channels."},
    {Py_tp_dealloc, plane_dealloc},
    {Py_bf_getbuffer, plane_buffer},
    {Py_bf_releasebuffer, plane_release},
    {0, NULL},
};
PyType_Spec plane_spec = {"velo._velo.Plane", sizeof(Plane), 0,
                          Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION, plane_slots};

PyMethodDef image_functions[] = {
    {"image_new", image_new, METH_VARARGS,
     "An image with a copy of an array: context, array, names, encoding."},
    {"image_read", image_read, METH_VARARGS,
     "Reads an image file: context, path, names of channels or None."},
    {"image_write", image_write, METH_VARARGS,
     "Writes images to one file: list, path, keywords."},
    {NULL, NULL, 0, NULL},
};
