/* _velo/values.c: Python values in the members of defs, and back, through rows of
 * velo/schema.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "module.h"

bool keep_object(PyObject *keep, PyObject *object) {
  return object && PyList_Append(keep, object) == 0;
}

/* ---- names ------------------------------------------------------------------------------- */

bool same_word(const char *a, const char *b) {
  for (;; a++, b++) {
    while (*a == '_' || *a == '-' || *a == ' ' || *a == '.')
      a++;
    while (*b == '_' || *b == '-' || *b == ' ' || *b == '.')
      b++;
    char x = *a >= 'A' && *a <= 'Z' ? (char)(*a + 32) : *a,
         y = *b >= 'A' && *b <= 'Z' ? (char)(*b + 32) : *b;
    if (x != y)
      return false;
    if (!x)
      return true;
  }
}

bool raise_unknown(const char *thing, const char *name, PyObject *names) {
  PyObject *error = names ? call_package("unknown", "(ssO)", thing, name, names) : NULL;
  if (error)
    PyErr_SetObject((PyObject *)Py_TYPE(error), error);
  Py_XDECREF(error);
  Py_XDECREF(names);
  return false;
}

bool append_text(PyObject *list, const char *text) {
  PyObject *object = PyUnicode_FromString(text);
  bool fine = object && PyList_Append(list, object) == 0;
  Py_XDECREF(object);
  return fine;
}

bool append_names(PyObject *list, const vlParameter *rows, size_t count) {
  for (size_t i = 0; i < count; i++)
    if (rows[i].member && rows[i].member[0] && !(rows[i].flags & VL_PARAMETER_SHORTHAND) &&
        rows[i].type != VL_PARAMETER_BLOCK && !strchr(rows[i].member, '[') &&
        !append_text(list, vl_setting_keyword(&rows[i])))
      return false;
  return true;
}

bool append_settings(PyObject *list, vlSettingGroup group) {
  const vlKindRow *rows = vl_settings(group);
  return append_names(list, rows->parameters, rows->parameter_count);
}

/* The text of a str without zeros, in *bytes; null: it is none. */
static const char *name_text(PyObject *value, PyObject **bytes) {
  *bytes = PyUnicode_Check(value) ? PyUnicode_AsUTF8String(value) : NULL;
  const char *text = *bytes ? PyBytes_AsString(*bytes) : NULL;
  return text && strlen(text) == (size_t)PyBytes_Size(*bytes) ? text : NULL;
}

int find_choice(const char *const *choices, const char *what, PyObject *value) {
  const vlParameter row = {.type = VL_PARAMETER_CHOICE, .choices = choices};
  double number;
  return read_row(value, what, &row, &number) ? (int)number : -1;
}

int find_kind(const vlKindFamily *family, const char *thing, PyObject *name) {
  enum { MAX_KINDS = 64 };
  const char *choices[MAX_KINDS + 1] = {NULL};
  PyObject *bytes = NULL;
  const char *text = name_text(name, &bytes);
  int found = -1;
  for (uint32_t k = 0; text && k < family->kind_count && found < 0; k++) {
    const vlKindRow *row = family->rows[k];
    if ((row->name && same_word(row->name, text)) ||
        (row->alias && same_word(row->alias, text)))
      found = (int)k;
  }
  Py_XDECREF(bytes);
  if (found >= 0)
    return found;
  for (uint32_t k = 0; k < family->kind_count && k < MAX_KINDS; k++)
    choices[k] = family->words[k];
  return find_choice(choices, thing, name);
}

/* How well a name fits a row: 0 not, 4 best. "lens_tilt_x" is lens.lens_tilt_x rather than
 * lens.tilt_x. */
static int fits(const vlParameter *p, const char *name) {
  bool shorthand = p->flags & VL_PARAMETER_SHORTHAND;
  if (!p->member || !p->member[0] || (shorthand && !p->second))
    return 0;
  if (!shorthand && strcmp(p->member, name) == 0)
    return 4;
  if (!shorthand && strcmp(vl_setting_keyword(p), name) == 0)
    return 3;
  if (!shorthand && strlen(p->member) == strlen(name) && same_word(p->member, name))
    return 2;
  return p->name && strcmp(p->name, name) == 0;
}

const vlParameter *find_parameter(const vlParameter *rows, size_t count, const char *name) {
  const vlParameter *found = NULL;
  int best = 0;
  for (size_t i = 0; i < count; i++) {
    int fit = fits(&rows[i], name);
    if (fit > best) {
      best = fit;
      found = &rows[i];
    }
  }
  return found;
}

/* ---- spectra and ids --------------------------------------------------------------------- */

/* An attribute. The name is interned, since the interpreter's cache of methods keeps the
 * str. */
static PyObject *get_attribute(PyObject *object, const char *name) {
  PyObject *text = PyUnicode_InternFromString(name);
  PyObject *value = text ? PyObject_GetAttr(object, text) : NULL;
  Py_XDECREF(text);
  return value;
}

static const vlParameter any_float = {.type = VL_PARAMETER_FLOAT};
static const vlParameter positive = {
    .type = VL_PARAMETER_FLOAT, .low = 0, .high = INFINITY, .flags = VL_PARAMETER_ABOVE_LOW};

/* The parts of velo.Spectrum: kind, scale, value. */
static bool read_spectrum_object(PyObject *keep, PyObject *object, vlSpectrum *s,
                                 const char *what) {
  static const char *const kinds[] = {"constant", "rgb", "blackbody", "sampled", "named", NULL};
  static const char *const spaces[] = {"srgb", "dci_p3", "rec2020", "aces2065_1", NULL};
  PyObject *kind = get_attribute(object, "kind"), *value = get_attribute(object, "value");
  PyObject *scale = get_attribute(object, "scale"), *space = get_attribute(object, "space");
  bool parts = kind && value && scale && space;
  if (!parts)
    raise_value(what, object, "a number, three numbers, a spectrum's name or a velo.Spectrum");
  int k = parts ? find_choice(kinds, what, kind) : -1;
  int place = k >= 0 ? find_choice(spaces, what, space) : -1;
  bool fine = k >= 0 && place >= 0;
  if (fine && k == VL_SPECTRUM_SAMPLED) {
    bool pair = sequence_size(value, what, 2, 2) == 2;
    PyObject *pairs[2] = {pair ? PySequence_GetItem(value, 0) : NULL,
                          pair ? PySequence_GetItem(value, 1) : NULL};
    Numbers n[2];
    memset(n, 0, sizeof n);
    fine = pairs[0] && pairs[1] && numbers_read(pairs[0], 'f', what, &n[0]) &&
           numbers_read(pairs[1], 'f', what, &n[1]);
    if (fine && n[0].count != n[1].count)
      fine = raise_usage("%s: a sampled spectrum needs as many values as wavelengths", what) !=
             NULL;
    const char *data[2] = {NULL, NULL};
    for (int i = 0; fine && i < 2; i++) {
      PyObject *bytes =
          PyBytes_FromStringAndSize(n[i].data, (Py_ssize_t)(n[i].count * sizeof(float)));
      fine = keep_object(keep, bytes);
      if (fine)
        data[i] = PyBytes_AsString(bytes);
      Py_XDECREF(bytes);
    }
    *s = (vlSpectrum){.kind = VL_SPECTRUM_SAMPLED,
                      .count = (uint32_t)n[0].count,
                      .wavelengths = (const float *)(const void *)data[0],
                      .values = (const float *)(const void *)data[1]};
    for (int i = 0; i < 2; i++) {
      numbers_release(&n[i]);
      Py_XDECREF(pairs[i]);
    }
  } else if (fine && k == VL_SPECTRUM_BLACKBODY) {
    double kelvin = 0;
    fine = read_row(value, what, &positive, &kelvin);
    if (fine)
      *s = vl_spectrum_blackbody((float)kelvin);
  } else if (fine) {
    fine = read_spectrum(keep, value, s, what);
  }
  if (fine) {
    double factor = 1;
    fine = read_row(scale, what, &any_float, &factor);
    s->space = (vlColorSpace)place;
    s->scale = (float)factor;
  }
  Py_XDECREF(kind);
  Py_XDECREF(value);
  Py_XDECREF(scale);
  Py_XDECREF(space);
  return fine;
}

bool read_spectrum(PyObject *keep, PyObject *value, vlSpectrum *s, const char *what) {
  if (PyUnicode_Check(value)) {
    const char *name = keep_text(keep, value, what);
    if (!name)
      return false;
    *s = vl_spectrum_named(name);
    return true;
  }
  PyObject *space = get_attribute(value, "space");
  if (space) {
    Py_DECREF(space);
    return read_spectrum_object(keep, value, s, what);
  }
  PyErr_Clear();
  if (PyNumber_Check(value) && !PySequence_Check(value)) {
    double number;
    if (!read_row(value, what, &any_float, &number))
      return false;
    *s = vl_spectrum_constant((float)number);
    return true;
  }
  if (!PySequence_Check(value) && !PyObject_CheckBuffer(value)) {
    raise_value(what, value, "a number, three numbers, a spectrum's name or a velo.Spectrum");
    return false;
  }
  float rgb[3];
  if (!floats_copy(value, what, 3, rgb))
    return false;
  *s = vl_spectrum_rgb(rgb[0], rgb[1], rgb[2]);
  return true;
}

/* The index of a handle of this family; UINT32_MAX with an exception. */
static uint32_t handle_index(const Scene *scene, PyObject *value, const char *family,
                             const char *what) {
  const Handle *handle = (const Handle *)value;
  if (strcmp(handle->family, family) != 0) {
    raise_usage("%s: this is one of the scene's %s, not of its %s", what, handle->family,
                family);
    return UINT32_MAX;
  }
  if (!scene || handle->scene != scene) {
    raise_usage("%s is part of another scene", what);
    return UINT32_MAX;
  }
  return handle_is_valid(handle) ? handle->index : UINT32_MAX;
}

/* ---- members ----------------------------------------------------------------------------- */

static bool set_input(const Target *t, const vlParameter *p, PyObject *value, char *place,
                      bool spectrum) {
  const char *what = vl_setting_keyword(p);
  vlTextureId texture = {0};
  if (is_object(value, TYPE_HANDLE)) {
    texture.index = handle_index(t->scene, value, "textures", what);
    if (texture.index == UINT32_MAX)
      return false;
  }
  if (spectrum) {
    vlSpectrumInput *input = (vlSpectrumInput *)(void *)place;
    input->texture = texture;
    return texture.index || read_spectrum(t->keep, value, &input->value, what);
  }
  vlFloatInput *input = (vlFloatInput *)(void *)place;
  input->texture = texture;
  if (texture.index)
    return true;
  double number;
  int read = to_double(value, &number);
  if (read < 0)
    return false;
  if (!read) {
    raise_value(what, value, "a number or a texture");
    return false;
  }
  if (!read_row(value, what, p, &number))
    return false;
  input->value = (float)number;
  return true;
}

bool set_parameter(const Target *t, const vlParameter *p, PyObject *value) {
  const char *what = vl_setting_keyword(p);
  char *place = t->def + p->offset, *second = p->second ? t->def + p->second : NULL;
  double number;
  switch (p->type) {
    case VL_PARAMETER_BOOL:
    case VL_PARAMETER_COUNT:
    case VL_PARAMETER_FLOAT:
    case VL_PARAMETER_DOUBLE:
    case VL_PARAMETER_CHOICE:
      if (!read_row(value, what, p, &number))
        return false;
      vl_given_put(p, number, t->def);
      return true;
    case VL_PARAMETER_FLOAT3: {
      float three[3];
      if (!floats_copy(value, what, 3, three))
        return false;
      memcpy(place, three, sizeof three);
      return true;
    }
    case VL_PARAMETER_DOUBLE3: {
      double three[3];
      if (!numbers_copy(value, what, 3, three))
        return false;
      memcpy(place, three, sizeof three);
      return true;
    }
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE: {
      const char *text = NULL;
      if (value != Py_None) {
        text = p->type == VL_PARAMETER_FILE ? keep_path(t->keep, value, what)
                                            : keep_text(t->keep, value, what);
        if (!text)
          return false;
      }
      memcpy(place, &text, sizeof text);
      return true;
    }
    case VL_PARAMETER_SPECTRUM:
      return read_spectrum(t->keep, value, (vlSpectrum *)(void *)place, what);
    case VL_PARAMETER_FLOAT_INPUT:
      return set_input(t, p, value, place, false) &&
             (!second || set_input(t, p, value, second, false));
    case VL_PARAMETER_SPECTRUM_INPUT:
      return set_input(t, p, value, place, true);
    case VL_PARAMETER_EITHER_INPUT:
      return set_input(t, p, value, t->spectrum ? second : place, t->spectrum);
    case VL_PARAMETER_TEXTURE: {
      vlTextureId id = {0};
      if (value != Py_None) {
        if (!is_object(value, TYPE_HANDLE)) {
          raise_value(what, value, "a texture of the scene");
          return false;
        }
        id.index = handle_index(t->scene, value, "textures", what);
        if (id.index == UINT32_MAX)
          return false;
      }
      memcpy(place, &id, sizeof id);
      return true;
    }
    case VL_PARAMETER_BLOCK:
      raise_usage("%s cannot be set by a keyword", what);
      return false;
  }
  return false;
}

bool set_parameters(const Target *target, vlSettingGroup group, const char *thing,
                    PyObject *keywords) {
  PyObject *name, *value;
  Py_ssize_t position = 0;
  while (PyDict_Next(keywords, &position, &name, &value)) {
    const char *text = keep_text(target->keep, name, thing);
    if (!text)
      return false;
    const vlParameter *row = vl_setting(group, text);
    bool fine = row != NULL;
    if (!row) {
      PyObject *names = PyList_New(0);
      if (names && !append_settings(names, group))
        Py_CLEAR(names);
      raise_unknown(thing, text, names);
    } else {
      fine = set_parameter(target, row, value);
    }
    if (!fine)
      return false;
  }
  return true;
}

PyObject *get_parameter(const char *def, const vlParameter *p) {
  const char *place = def + p->offset;
  double three[3];
  switch (p->type) {
    case VL_PARAMETER_BOOL:
      return PyBool_FromLong(*(const bool *)place);
    case VL_PARAMETER_COUNT:
      return PyLong_FromUnsignedLong(*(const uint32_t *)(const void *)place);
    case VL_PARAMETER_FLOAT:
      return PyFloat_FromDouble((double)*(const float *)(const void *)place);
    case VL_PARAMETER_DOUBLE: {
      double value = *(const double *)(const void *)place;
      if (isnan(value))
        Py_RETURN_NONE;
      return PyFloat_FromDouble(value);
    }
    case VL_PARAMETER_FLOAT3:
    case VL_PARAMETER_DOUBLE3:
      for (int i = 0; i < 3; i++)
        three[i] = p->type == VL_PARAMETER_FLOAT3
                       ? (double)((const float *)(const void *)place)[i]
                       : ((const double *)(const void *)place)[i];
      return Py_BuildValue("(ddd)", three[0], three[1], three[2]);
    case VL_PARAMETER_CHOICE:
      return PyUnicode_FromString(p->choices[*(const int *)(const void *)place]);
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE: {
      const char *text = *(const char *const *)(const void *)place;
      if (!text)
        Py_RETURN_NONE;
      return PyUnicode_DecodeFSDefault(text);
    }
    case VL_PARAMETER_SPECTRUM:
    case VL_PARAMETER_FLOAT_INPUT:
    case VL_PARAMETER_SPECTRUM_INPUT:
    case VL_PARAMETER_EITHER_INPUT:
    case VL_PARAMETER_TEXTURE:
    case VL_PARAMETER_BLOCK:
      break;
  }
  return raise_usage("%s cannot be read", p->member);
}
