/* _velo/sensor.c: sensors: their numbers, and exposures to stored spectral images. A sensor is
 * named at each call, by a preset or a file, with keywords that replace its numbers. */
#include <string.h>

#include <velo/sensor_raw.h>

#include "module.h"

/* Makes the sensor of (name or path, is_file, keywords). Null with an exception. */
static vlSensor *make_sensor(Context *context, PyObject *name, int is_file, PyObject *keywords,
                             PyObject *keep) {
  vlSensorDef def = vl_default_sensor_def();
  vlError error = {0};
  vlSensor *sensor = NULL;
  const Target target = {(char *)&def, keep, NULL, false};
  const char *text =
      is_file ? keep_path(keep, name, "sensor") : keep_text(keep, name, "sensor");
  if (!text || !context_check(context))
    return NULL;
  vlResult done = is_file ? vl_sensor_read(context->context, text, &def, &error)
                          : vl_sensor_preset(text, &def, &error);
  if (done == VL_ERROR_ARGUMENT) {
    raise_usage("%s", error.message);
    return NULL;
  }
  PyObject *pattern = PyDict_GetItemString(keywords, "pattern"); /* borrowed */
  if (done == VL_OK && pattern) {
    const char *letters = keep_text(keep, pattern, "pattern");
    if (!letters)
      return NULL;
    done = vl_sensor_set_pattern(&def, letters, &error);
  }
  PyObject *others = PyDict_Copy(keywords);
  if (pattern && others)
    PyDict_DelItemString(others, "pattern");
  bool fine = others && (done != VL_OK || set_parameters(&target, VL_SETTING_SENSOR,
                                                         "number of a sensor", others));
  Py_XDECREF(others);
  if (!fine)
    return NULL;
  if (done == VL_OK)
    done = vl_sensor_create(context->context, &def, &sensor, &error);
  if (done == VL_ERROR_ARGUMENT)
    raise_usage("%s", error.message);
  else if (done != VL_OK)
    raise_result(done, &error);
  return sensor;
}

/* sensor_numbers(context, name, is_file, keywords): {keyword: value}, with "pattern" and
 * "filters". */
static PyObject *sensor_numbers(PyObject *module, PyObject *arguments) {
  (void)module;
  Context *context;
  PyObject *name, *keywords;
  int is_file;
  if (!PyArg_ParseTuple(arguments, "O!OpO!:sensor_numbers", base_types[TYPE_CONTEXT], &context,
                        &name, &is_file, &PyDict_Type, &keywords))
    return NULL;
  PyObject *keep = PyList_New(0);
  vlSensor *sensor = keep ? make_sensor(context, name, is_file, keywords, keep) : NULL;
  PyObject *result = sensor ? PyDict_New() : NULL;
  const vlKindRow *rows = vl_settings(VL_SETTING_SENSOR);
  for (uint32_t i = 0; result && i < rows->parameter_count; i++) {
    const vlParameter *row = &rows->parameters[i];
    if (row->flags & VL_PARAMETER_RULE)
      continue;
    PyObject *value = get_parameter((const char *)vl_sensor_def(sensor), row);
    if (!value || PyDict_SetItemString(result, vl_setting_keyword(row), value) < 0)
      Py_CLEAR(result);
    Py_XDECREF(value);
  }
  char text[2 * VL_SENSOR_CELLS + 1];
  PyObject *pattern =
      result ? PyUnicode_FromString(vl_sensor_pattern(vl_sensor_def(sensor), text)) : NULL;
  if (result && (!pattern || PyDict_SetItemString(result, "pattern", pattern) < 0))
    Py_CLEAR(result);
  Py_XDECREF(pattern);
  vl_sensor_destroy(sensor);
  Py_XDECREF(keep);
  return result;
}

static PyObject *sensor_presets(PyObject *module, PyObject *unused) {
  (void)module;
  (void)unused;
  PyObject *list = PyList_New(0);
  for (uint32_t i = 0; list && vl_sensor_preset_name(i); i++) {
    PyObject *text = PyUnicode_FromString(vl_sensor_preset_name(i));
    if (!text || PyList_Append(list, text) < 0)
      Py_CLEAR(list);
    Py_XDECREF(text);
  }
  return list;
}

/* The images of a frame: numbers and electrons. */
static vlResult make_images(Context *context, const vlImage *like, vlImage *images[2]) {
  static const char *const names[1] = {"electrons"};
  vlImageDef def = vl_default_image_def(vl_image_width(like), vl_image_height(like), 1);
  def.type = VL_PIXEL_U16;
  def.encoding = VL_ENCODING_LINEAR;
  vlResult done = vl_image_create(context->context, &def, &images[0]);
  def.type = VL_PIXEL_F32;
  def.names = names;
  return done == VL_OK ? vl_image_create(context->context, &def, &images[1]) : done;
}

static PyObject *frame_object(Context *context, vlImage *images[2], const vlSensorOutput *out) {
  PyObject *numbers = image_object(context, images[0]);
  images[0] = NULL;
  PyObject *electrons = numbers ? image_object(context, images[1]) : NULL;
  images[1] = electrons ? NULL : images[1];
  if (!electrons) {
    Py_XDECREF(numbers);
    return NULL;
  }
  return Py_BuildValue("(NN{sKsKsKsKsKsd})", numbers, electrons, "full",
                       (unsigned long long)out->full, "black", (unsigned long long)out->black,
                       "white", (unsigned long long)out->white, "not_finite",
                       (unsigned long long)out->not_finite, "negative",
                       (unsigned long long)out->negative, "film_noise", out->film_noise);
}

/* sensor_expose(context, name, is_file, keywords, image, exposure): numbers, electrons,
 * counts */
static PyObject *sensor_expose(PyObject *module, PyObject *arguments) {
  (void)module;
  Context *context;
  PyObject *name, *keywords, *image, *settings, *result = NULL;
  int is_file;
  if (!PyArg_ParseTuple(arguments, "O!OpO!O!O!:sensor_expose", base_types[TYPE_CONTEXT],
                        &context, &name, &is_file, &PyDict_Type, &keywords,
                        base_types[TYPE_IMAGE], &image, &PyDict_Type, &settings))
    return NULL;
  vlImage *source = ((Image *)image)->image;
  vlImage *images[2] = {NULL, NULL};
  vlExposureDef exposure = vl_default_exposure_def();
  PyObject *keep = PyList_New(0);
  const Target target = {(char *)&exposure, keep, NULL, false};
  if (!source) {
    Py_XDECREF(keep);
    return raise_usage("the image is closed");
  }
  bool fine =
      keep && set_parameters(&target, VL_SETTING_EXPOSURE, "number of an exposure", settings);
  vlSensor *sensor = fine ? make_sensor(context, name, is_file, keywords, keep) : NULL;
  Call call;
  if (sensor && call_begin(&call, context, NULL)) {
    vlError error = {0};
    vlSensorOutput out = {.film_noise = 0};
    ((Image *)image)->exports++; /* it is not closed meanwhile */
    vl_exposure_set_window(&exposure, source);
    vlResult done = make_images(context, source, images);
    for (int i = 0; i < 2 && done == VL_OK; i++)
      done = vl_exposure_write_window(&exposure, images[i]);
    if (done == VL_OK) {
      out.numbers = vl_image_pixels(images[0]);
      out.electrons = vl_image_pixels(images[1]);
      done = vl_sensor_expose(sensor, source, &exposure, &out, &error);
    }
    call_end(&call);
    ((Image *)image)->exports--;
    if (done == VL_OK)
      result = frame_object(context, images, &out);
    else if (done == VL_ERROR_ARGUMENT)
      raise_usage("%s", error.message);
    else
      raise_result(done, &error);
  }
  vl_image_destroy(images[0]);
  vl_image_destroy(images[1]);
  vl_sensor_destroy(sensor);
  Py_XDECREF(keep);
  return result;
}

/* sensor_raw(context, name, is_file, keywords, exposure, numbers, light or None): what velo.Raw
 * has beside the numbers of a frame. */
static PyObject *sensor_raw(PyObject *module, PyObject *arguments) {
  (void)module;
  Context *context;
  PyObject *name, *keywords, *settings, *image, *light, *result = NULL;
  float white[VL_SPECTRUM_VALUES];
  int is_file;
  if (!PyArg_ParseTuple(arguments, "O!OpO!O!O!O:sensor_raw", base_types[TYPE_CONTEXT], &context,
                        &name, &is_file, &PyDict_Type, &keywords, &PyDict_Type, &settings,
                        base_types[TYPE_IMAGE], &image, &light) ||
      (light != Py_None && !floats_copy(light, "light", VL_SPECTRUM_VALUES, white)))
    return NULL;
  const vlImage *numbers = ((Image *)image)->image;
  vlExposureDef exposure = vl_default_exposure_def();
  PyObject *keep = PyList_New(0);
  const Target target = {(char *)&exposure, keep, NULL, false};
  bool fine = keep && numbers &&
              set_parameters(&target, VL_SETTING_EXPOSURE, "number of an exposure", settings);
  vlSensor *sensor = fine ? make_sensor(context, name, is_file, keywords, keep) : NULL;
  vlRaw *raw = NULL;
  vlError error = {0};
  if (sensor) {
    vl_exposure_set_window(&exposure, numbers);
    vlResult done =
        vl_sensor_raw(sensor, &exposure, light == Py_None ? NULL : white,
                      vl_image_width(numbers), vl_image_height(numbers), &raw, &error);
    result = done == VL_OK ? raw_values(vl_raw_def(raw)) : raise_result(done, &error);
  }
  vl_raw_destroy(raw);
  vl_sensor_destroy(sensor);
  Py_XDECREF(keep);
  return result;
}

PyMethodDef sensor_functions[] = {
    {"sensor_numbers", sensor_numbers, METH_VARARGS, "The numbers of a sensor."},
    {"sensor_presets", sensor_presets, METH_NOARGS, "The names of presets."},
    {"sensor_expose", sensor_expose, METH_VARARGS, "Exposes a sensor to an image."},
    {"sensor_raw", sensor_raw, METH_VARARGS, "The values of a frame's raw image."},
    {NULL, NULL, 0, NULL},
};
