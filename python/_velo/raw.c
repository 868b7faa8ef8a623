/* _velo/raw.c: raw images. The package's class velo.Raw holds the numbers as an image of 16-bit
 * integers and a dict of what vlRawDef has beside its size; each call here makes a vlRaw of the
 * two. */
#include <string.h>

#include "module.h"

enum { COLORS = VL_RAW_MAX_COLORS };

/* ---- from Python ------------------------------------------------------------------------- */

static bool get_float(PyObject *values, const char *name, float *result) {
  PyObject *value = PyDict_GetItemString(values, name);
  double number;
  if (!value || !read_finite(value, name, &number))
    return value ? false : (raise_usage("raw image: %s is missing", name), false);
  *result = (float)number;
  return true;
}

static bool get_count(PyObject *values, const char *name, uint32_t high, uint32_t *result) {
  PyObject *value = PyDict_GetItemString(values, name);
  return value ? read_count(value, name, 0, high, result)
               : (raise_usage("raw image: %s is missing", name), false);
}

static bool get_text(PyObject *keep, PyObject *values, const char *name, const char **text) {
  PyObject *value = PyDict_GetItemString(values, name);
  *text = value ? keep_text(keep, value, name) : NULL;
  return *text || PyErr_Occurred() || raise_usage("raw image: %s is missing", name);
}

/* One black level, or one for each cell of the pattern. */
static bool get_black(PyObject *values, vlRawDef *def) {
  uint32_t cells = def->pattern_rows * def->pattern_columns;
  PyObject *black = PyDict_GetItemString(values, "black");
  double levels[VL_RAW_MAX_CELLS];
  bool is_list = black && (PySequence_Check(black) || PyObject_CheckBuffer(black));
  if (!is_list) {
    uint32_t level;
    if (!get_count(values, "black", 65535, &level))
      return false;
    for (uint32_t i = 0; i < cells; i++)
      def->black[i] = (uint16_t)level;
    return true;
  }
  if (!numbers_copy(black, "black", cells, levels))
    return false;
  for (uint32_t i = 0; i < cells; i++) {
    if (!(levels[i] >= 0.0 && levels[i] <= 65535.0) || levels[i] != (uint16_t)levels[i])
      return raise_value("black", black, "integers from 0 to 65535");
    def->black[i] = (uint16_t)levels[i];
  }
  return true;
}

/* The neutral and the matrices: numbers, or None. */
static bool get_color(PyObject *values, vlRawDef *def) {
  uint8_t colors[COLORS];
  uint32_t count = vl_raw_colors(def, colors);
  float both[2 * 3 * COLORS];
  PyObject *neutral = PyDict_GetItemString(values, "neutral");
  PyObject *matrices = PyDict_GetItemString(values, "matrices");
  if (neutral && neutral != Py_None && !floats_copy(neutral, "neutral", count, def->neutral))
    return false;
  if (!matrices || matrices == Py_None)
    return true;
  if (!floats_copy(matrices, "matrices", 6 * count, both))
    return false;
  memcpy(def->matrices[0], both, 3 * count * sizeof *both);
  memcpy(def->matrices[1], both + 3 * count, 3 * count * sizeof *both);
  return true;
}

static bool read_texts(PyObject *values, vlRawDef *def) {
  PyObject *keep = PyList_New(0);
  const char *pattern, *camera;
  vlError error = {0};
  bool done = keep && get_text(keep, values, "pattern", &pattern) && pattern &&
              get_text(keep, values, "camera", &camera) && camera;
  if (done && strlen(camera) >= sizeof def->camera)
    done = raise_usage("camera must be a text of at most 63 characters");
  if (done) {
    vlResult result = vl_raw_set_pattern(def, pattern, &error);
    done = result == VL_OK || raise_result(result, &error);
  }
  if (done)
    memcpy(def->camera, camera, strlen(camera) + 1);
  Py_XDECREF(keep);
  return done;
}

static bool read_def(PyObject *values, vlRawDef *def) {
  uint32_t white;
  if (!read_texts(values, def) || !get_count(values, "bits", 16, &def->bits) ||
      !get_count(values, "white", 65535, &white) || !get_count(values, "iso", 65535, &def->iso))
    return false;
  def->white = (uint16_t)white;
  return get_black(values, def) && get_float(values, "exposure_time", &def->exposure_time) &&
         get_float(values, "f_number", &def->f_number) &&
         get_float(values, "focal_length", &def->focal_length) &&
         get_float(values, "gain", &def->gain) &&
         get_float(values, "read_noise", &def->read_noise) &&
         get_float(values, "baseline_exposure", &def->baseline_exposure) &&
         get_color(values, def);
}

/* The raw image of an image of numbers and a dict; null with an exception. */
static vlRaw *make_raw(Image *numbers, PyObject *values) {
  vlRaw *raw = NULL;
  vlError error = {0};
  if (!numbers->image || vl_image_type(numbers->image) != VL_PIXEL_U16 ||
      vl_image_channels(numbers->image) != 1) {
    raise_usage("the numbers of a raw image are an array of rows x columns of uint16");
    return NULL;
  }
  vlRawDef def =
      vl_default_raw_def(vl_image_width(numbers->image), vl_image_height(numbers->image));
  if (!read_def(values, &def) || !context_check(numbers->context))
    return NULL;
  vlResult result = vl_raw_create(numbers->context->context, &def, &raw, &error);
  if (result != VL_OK) {
    raise_result(result, &error);
    return NULL;
  }
  memcpy(vl_raw_numbers(raw), vl_image_const_pixels(numbers->image),
         sizeof(uint16_t) * def.width * def.height);
  return raw;
}

/* ---- to Python --------------------------------------------------------------------------- */

static PyObject *list_of(const float *values, uint32_t count) {
  PyObject *list = PyList_New((Py_ssize_t)count);
  for (uint32_t i = 0; list && i < count; i++)
    if (PyList_SetItem(list, (Py_ssize_t)i, PyFloat_FromDouble((double)values[i])) < 0)
      Py_CLEAR(list);
  return list;
}

static bool is_known(const float *values, uint32_t count) {
  for (uint32_t i = 0; i < count; i++)
    if (values[i] != 0.0f)
      return true;
  return false;
}

/* [matrix for A, matrix for D65], each a list of rows; None: not known. */
static PyObject *matrices_of(const vlRawDef *def, uint32_t count) {
  if (!is_known(def->matrices[0], 3 * count))
    return Py_NewRef(Py_None);
  PyObject *both = PyList_New(2);
  for (int i = 0; both && i < 2; i++) {
    PyObject *rows = PyList_New((Py_ssize_t)count);
    for (uint32_t k = 0; rows && k < count; k++)
      if (PyList_SetItem(rows, (Py_ssize_t)k, list_of(def->matrices[i] + 3 * k, 3)) < 0)
        Py_CLEAR(rows);
    if (!rows || PyList_SetItem(both, i, rows) < 0)
      Py_CLEAR(both);
  }
  return both;
}

static PyObject *black_of(const vlRawDef *def) {
  uint32_t cells = def->pattern_rows * def->pattern_columns;
  bool is_one = true;
  for (uint32_t i = 1; i < cells; i++)
    is_one = is_one && def->black[i] == def->black[0];
  if (is_one)
    return PyLong_FromLong(def->black[0]);
  PyObject *list = PyList_New((Py_ssize_t)cells);
  for (uint32_t i = 0; list && i < cells; i++)
    if (PyList_SetItem(list, (Py_ssize_t)i, PyLong_FromLong(def->black[i])) < 0)
      Py_CLEAR(list);
  return list;
}

PyObject *raw_values(const vlRawDef *def) {
  uint8_t colors[COLORS];
  uint32_t count = vl_raw_colors(def, colors);
  char pattern[80];
  vl_raw_pattern_text(def, pattern);
  PyObject *neutral =
      is_known(def->neutral, count) ? list_of(def->neutral, count) : Py_NewRef(Py_None);
  return Py_BuildValue(
      "{s:s,s:I,s:N,s:I,s:s,s:d,s:d,s:d,s:I,s:d,s:d,s:d,s:N,s:N}", "pattern", pattern, "bits",
      def->bits, "black", black_of(def), "white", (unsigned)def->white, "camera", def->camera,
      "exposure_time", (double)def->exposure_time, "f_number", (double)def->f_number,
      "focal_length", (double)def->focal_length, "iso", def->iso, "gain", (double)def->gain,
      "read_noise", (double)def->read_noise, "baseline_exposure",
      (double)def->baseline_exposure, "neutral", neutral, "matrices", matrices_of(def, count));
}

/* (image of the numbers, dict of the values) of a raw image, which is taken. */
static PyObject *parts_of(Context *context, vlRaw *raw) {
  const vlRawDef *def = vl_raw_def(raw);
  vlImageDef image_def = vl_default_image_def(def->width, def->height, 1);
  vlImage *image = NULL;
  image_def.type = VL_PIXEL_U16;
  vlResult result = vl_image_create(context->context, &image_def, &image);
  PyObject *values = result == VL_OK ? raw_values(def) : raise_result(result, NULL);
  if (image)
    memcpy(vl_image_pixels(image), vl_raw_const_numbers(raw),
           sizeof(uint16_t) * def->width * def->height);
  vl_raw_destroy(raw);
  if (!values) {
    vl_image_destroy(image);
    return NULL;
  }
  PyObject *numbers = image_object(context, image);
  if (!numbers) {
    Py_DECREF(values);
    return NULL;
  }
  return Py_BuildValue("(NN)", numbers, values);
}

/* ---- calls ------------------------------------------------------------------------------- */

/* raw_check(numbers, values): the values as a raw image has them. */
static PyObject *raw_check(PyObject *module, PyObject *arguments) {
  (void)module;
  Image *numbers;
  PyObject *values;
  if (!PyArg_ParseTuple(arguments, "O!O!:raw_check", base_types[TYPE_IMAGE], &numbers,
                        &PyDict_Type, &values))
    return NULL;
  vlRaw *raw = make_raw(numbers, values);
  if (!raw)
    return NULL;
  PyObject *result = raw_values(vl_raw_def(raw));
  vl_raw_destroy(raw);
  return result;
}

/* raw_write(numbers, values, path) */
static PyObject *raw_write(PyObject *module, PyObject *arguments) {
  (void)module;
  Image *numbers;
  PyObject *values, *path, *keep = PyList_New(0);
  Call call;
  vlError error = {0};
  if (!keep || !PyArg_ParseTuple(arguments, "O!O!O:raw_write", base_types[TYPE_IMAGE], &numbers,
                                 &PyDict_Type, &values, &path)) {
    Py_XDECREF(keep);
    return NULL;
  }
  const char *file = keep_path(keep, path, "path");
  vlRaw *raw = file ? make_raw(numbers, values) : NULL;
  if (!raw || !call_begin(&call, numbers->context, NULL)) {
    vl_raw_destroy(raw);
    Py_DECREF(keep);
    return NULL;
  }
  vlResult result = vl_raw_write(raw, file, &error);
  vl_raw_destroy(raw);
  call_end(&call);
  Py_DECREF(keep);
  if (result != VL_OK)
    return raise_result(result, &error);
  Py_RETURN_NONE;
}

/* raw_read(context, path): (numbers, values) */
static PyObject *raw_read(PyObject *module, PyObject *arguments) {
  (void)module;
  Context *context;
  PyObject *path, *keep = PyList_New(0);
  Call call;
  vlError error = {0};
  vlRaw *raw = NULL;
  if (!keep ||
      !PyArg_ParseTuple(arguments, "O!O:raw_read", base_types[TYPE_CONTEXT], &context, &path)) {
    Py_XDECREF(keep);
    return NULL;
  }
  const char *file = keep_path(keep, path, "path");
  if (!file || !call_begin(&call, context, NULL)) {
    Py_DECREF(keep);
    return NULL;
  }
  vlResult result = vl_raw_read(context->context, file, &raw, &error);
  call_end(&call);
  Py_DECREF(keep);
  return result == VL_OK ? parts_of(context, raw) : raise_result(result, &error);
}

/* raw_develop(numbers, values, step, exposure): an image */
static PyObject *raw_develop(PyObject *module, PyObject *arguments) {
  static const char *const steps[] = {"black", "white", "demosaic", "color", "tone", NULL};
  (void)module;
  Image *numbers;
  PyObject *values, *step, *exposure;
  double ev;
  Call call;
  vlError error = {0};
  vlImage *image = NULL;
  vlRawDevelopDef def = vl_default_raw_develop_def();
  if (!PyArg_ParseTuple(arguments, "O!O!OO:raw_develop", base_types[TYPE_IMAGE], &numbers,
                        &PyDict_Type, &values, &step, &exposure) ||
      !read_finite(exposure, "exposure", &ev))
    return NULL;
  int stop_at = find_choice(steps, "stop_at", step);
  vlRaw *raw = stop_at >= 0 ? make_raw(numbers, values) : NULL;
  if (!raw || !call_begin(&call, numbers->context, NULL)) {
    vl_raw_destroy(raw);
    return NULL;
  }
  def.stop_at = (vlRawStep)stop_at;
  def.exposure = (float)ev;
  vlResult result = vl_raw_develop(raw, &def, &image, &error);
  vl_raw_destroy(raw);
  call_end(&call);
  return result == VL_OK ? image_object(numbers->context, image) : raise_result(result, &error);
}

/* raw_match_color(numbers, values, sensitivities, light or None): the values with neutral and
 * matrices. */
static PyObject *raw_match_color(PyObject *module, PyObject *arguments) {
  (void)module;
  Image *numbers;
  PyObject *values, *sensitivities, *light;
  uint8_t colors[COLORS];
  float curves[COLORS * VL_SPECTRUM_VALUES], spectrum[VL_SPECTRUM_VALUES];
  vlError error = {0};
  if (!PyArg_ParseTuple(arguments, "O!O!OO:raw_match_color", base_types[TYPE_IMAGE], &numbers,
                        &PyDict_Type, &values, &sensitivities, &light))
    return NULL;
  vlRaw *raw = make_raw(numbers, values);
  if (!raw)
    return NULL;
  vlRawDef def = *vl_raw_def(raw);
  vl_raw_destroy(raw);
  size_t count = VL_SPECTRUM_VALUES * (size_t)vl_raw_colors(&def, colors);
  if (!floats_copy(sensitivities, "sensitivities", count, curves) ||
      (light != Py_None && !floats_copy(light, "light", VL_SPECTRUM_VALUES, spectrum)))
    return NULL;
  vlResult result =
      vl_raw_match_color(&def, curves, light == Py_None ? NULL : spectrum, &error);
  return result == VL_OK ? raw_values(&def) : raise_result(result, &error);
}

PyMethodDef raw_functions[] = {
    {"raw_check", raw_check, METH_VARARGS, "The values of a raw image: numbers, values."},
    {"raw_write", raw_write, METH_VARARGS, "Writes a raw file: numbers, values, path."},
    {"raw_read", raw_read, METH_VARARGS, "Reads a raw file: context, path."},
    {"raw_develop", raw_develop, METH_VARARGS,
     "An image: numbers, values, last step, exposure."},
    {"raw_match_color", raw_match_color, METH_VARARGS,
     "Values with colour: numbers, values, sensitivities, light or None."},
    {NULL, NULL, 0, NULL},
};
