/* _velo/module.c: the module: its classes, and functions without an object. */
#include "module.h"

#include <string.h>

PyTypeObject *base_types[TYPE_COUNT], *types[TYPE_COUNT];
static const char *const type_names[TYPE_COUNT] = {"Context", "Scene", "World",  "Film",
                                                   "Image",   "Plane", "Camera", "Settings",
                                                   "Handle",  "Own"};

void *make_object(int type) {
  allocfunc allocate = (allocfunc)PyType_GetSlot(types[type], Py_tp_alloc);
  return allocate(types[type], 0);
}

void free_object(PyObject *self) {
  PyTypeObject *type = Py_TYPE(self);
  freefunc release = (freefunc)PyType_GetSlot(type, Py_tp_free);
  release(self);
  Py_DECREF(type);
}

bool is_object(PyObject *object, int type) {
  return PyObject_TypeCheck(object, base_types[type]);
}

/* set_type(name, class): objects of this name are of this class from now on. */
static PyObject *set_type(PyObject *module, PyObject *arguments) {
  (void)module;
  const char *name;
  PyObject *type;
  if (!PyArg_ParseTuple(arguments, "sO:set_type", &name, &type))
    return NULL;
  for (int i = 0; i < TYPE_COUNT; i++) {
    if (strcmp(name, type_names[i]) != 0)
      continue;
    if (!PyType_Check(type) || !PyType_IsSubtype((PyTypeObject *)type, base_types[i]))
      return PyErr_Format(PyExc_TypeError, "not a subclass of %s", name);
    Py_INCREF(type);
    Py_DECREF(types[i]);
    types[i] = (PyTypeObject *)type;
    Py_RETURN_NONE;
  }
  return PyErr_Format(PyExc_ValueError, "no class %s", name);
}

static PyObject *version(PyObject *module, PyObject *unused) {
  (void)module;
  (void)unused;
  return PyUnicode_FromString(vl_version()->text);
}

static PyObject *texts(const char *(*name)(uint32_t)) {
  PyObject *list = PyList_New(0);
  for (uint32_t i = 0; list && name(i); i++) {
    PyObject *text = PyUnicode_FromString(name(i));
    if (!text || PyList_Append(list, text) < 0)
      Py_CLEAR(list);
    Py_XDECREF(text);
  }
  return list;
}

static PyObject *spectrum_names(PyObject *module, PyObject *unused) {
  (void)module;
  (void)unused;
  return texts(vl_spectrum_name);
}
static PyObject *sensor_names(PyObject *module, PyObject *unused) {
  (void)module;
  (void)unused;
  return texts(vl_sensor_name);
}
static PyObject *channel_names(PyObject *module, PyObject *unused) {
  (void)module;
  (void)unused;
  return texts(vl_channel_name);
}

/* The description of a parameter with the unit of its value here: an angle that files have in
 * degrees is in radians. */
static PyObject *described(const vlParameter *p) {
  const char *unit = p->unit, *text = p->description ? p->description : "";
  if (unit && p->factor != 0 && strcmp(unit, "degrees") == 0)
    unit = "radians";
  else if (p->factor != 0)
    unit = NULL;
  return unit ? PyUnicode_FromFormat("%s (%s)", text, unit) : PyUnicode_FromString(text);
}

/* The keyword that sets a parameter: the last word of its member, as `interocular`; of a number
 * of a projection, which is a member of no name of its own, its name in files. Null: none. */
static const char *keyword_of(const vlParameter *p) {
  if (p->flags & VL_PARAMETER_SHORTHAND || !p->member || !p->member[0])
    return NULL;
  if (strncmp(p->member, "shape[", 6) == 0)
    return p->name;
  const char *dot = strrchr(p->member, '.');
  return dot ? dot + 1 : p->member;
}

/* kinds(family): {kind: {keyword: description}} of a family of velo/schema.h. */
static PyObject *kinds(PyObject *module, PyObject *arguments) {
  (void)module;
  PyObject *name;
  const char *families[32] = {0};
  if (!PyArg_ParseTuple(arguments, "O:kinds", &name))
    return NULL;
  for (uint32_t i = 0; i < 31 && vl_kind_family(i); i++)
    families[i] = vl_kind_family(i)->name;
  int found = find_choice(families, "family of kinds", name);
  if (found < 0)
    return NULL;
  const vlKindFamily *family = vl_kind_family((uint32_t)found);
  PyObject *result = PyDict_New();
  for (uint32_t k = 0; result && k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    PyObject *words = PyDict_New();
    for (uint32_t i = 0; words && i < row->parameter_count; i++) {
      const vlParameter *p = &row->parameters[i];
      const char *keyword = keyword_of(p);
      if (!keyword)
        continue;
      PyObject *text = described(p);
      if (!text || PyDict_SetItemString(words, keyword, text) < 0)
        Py_CLEAR(words);
      Py_XDECREF(text);
    }
    if (!words || PyDict_SetItemString(result, family->words[k], words) < 0)
      Py_CLEAR(result);
    Py_XDECREF(words);
  }
  return result;
}

static PyMethodDef functions[] = {
    {"set_type", set_type, METH_VARARGS, "Makes objects of this name instances of this class."},
    {"version", version, METH_NOARGS, "The library's version."},
    {"spectrum_names", spectrum_names, METH_NOARGS, "Names of the library's spectra."},
    {"sensor_names", sensor_names, METH_NOARGS, "Names of the library's sensors."},
    {"channel_names", channel_names, METH_NOARGS, "Names of ground truth channels."},
    {"kinds", kinds, METH_VARARGS, "Kinds of a family with their keywords."},
    {"check_value", check_value, METH_VARARGS, "A number, where it is one that may be given."},
    {"check_choice", check_choice, METH_VARARGS,
     "The index of a word, where it is one of some."},
    {"check_setting", check_setting, METH_VARARGS, "The value of a setting, where it is one."},
    {"unknown_name", unknown_name, METH_VARARGS, "The message about an unknown name."},
    {"shut_down", shut_down, METH_NOARGS,
     "Stops the calls of other threads; later ones are errors."},
    {NULL, NULL, 0, NULL},
};

static struct PyModuleDef module_def = {PyModuleDef_HEAD_INIT, .m_name = "velo._velo",
                                        .m_doc = "velo's library for the Python package velo.",
                                        .m_size = -1, .m_methods = functions};

PyMODINIT_FUNC PyInit__velo(void) {
  PyType_Spec *specs[TYPE_COUNT] = {&context_spec, &scene_spec, &world_spec,  &film_spec,
                                    &image_spec,   &plane_spec, &camera_spec, &settings_spec,
                                    &handle_spec,  &own_spec};
  PyObject *module = PyModule_Create(&module_def);
  if (!module)
    return NULL;
  for (int i = 0; i < TYPE_COUNT; i++) {
    PyObject *type = PyType_FromSpec(specs[i]);
    if (!type || PyModule_AddObjectRef(module, type_names[i], type) < 0)
      return NULL;
    base_types[i] = (PyTypeObject *)type;
    Py_INCREF(type);
    types[i] = (PyTypeObject *)type;
  }
  PyMethodDef *tables[] = {camera_functions, camera_file_functions, film_functions,
                           image_functions,  render_functions,      world_functions,
                           own_functions,    own_trace_functions,   raw_functions,
                           sensor_functions};
  for (size_t i = 0; i < sizeof tables / sizeof *tables; i++)
    if (PyModule_AddFunctions(module, tables[i]) < 0)
      return NULL;
  return module;
}
