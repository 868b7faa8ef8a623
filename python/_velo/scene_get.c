/* _velo/scene_get.c: reads the objects of a scene back, as the keywords that set them: what its
 * kind's row describes, and the rest of the def. Spectra and arrays are tuples whose first item
 * is a tag, "spectrum" or "array"; python/velo/scene.py makes objects of them. */
#include <string.h>

#include "adding.h"

typedef struct Getting {
  Scene *scene;
  PyObject *dict;
} Getting;

/* Adds an item, which it owns; null: an exception. */
static bool put(const Getting *g, const char *name, PyObject *value) {
  bool fine = value && PyDict_SetItemString(g->dict, name, value) == 0;
  Py_XDECREF(value);
  return fine;
}

static PyObject *none(void) {
  Py_INCREF(Py_None);
  return Py_None;
}

static PyObject *text_or_none(const char *text) {
  return text ? text_object(text) : none();
}

static PyObject *handle_or_none(const Getting *g, Family family, uint32_t index) {
  return index ? new_handle(g->scene, family, index) : none();
}

/* ("array", bytes, type, (rows, columns, ...)); the dimensions end with 0. */
static PyObject *array_of(const void *data, char type, const size_t *shape) {
  size_t count = 1;
  PyObject *sizes = PyList_New(0);
  for (int i = 0; sizes && shape[i]; i++) {
    count *= shape[i];
    PyObject *size = PyLong_FromSize_t(shape[i]);
    if (!size || PyList_Append(sizes, size) < 0)
      Py_CLEAR(sizes);
    Py_XDECREF(size);
  }
  if (!sizes)
    return NULL;
  void *to = NULL;
  const size_t bytes = count * (type == 'd' ? sizeof(double) : sizeof(float));
  PyObject *copy = make_bytes(bytes, &to);
  if (copy)
    memcpy(to, data, bytes);
  return Py_BuildValue("(sNCN)", "array", copy, type, sizes);
}

static PyObject *matrix_of(const double *m) {
  return array_of(m, 'd', (const size_t[]){4, 4, 0});
}

/* ("spectrum", kind, value, scale, space) */
static PyObject *spectrum_of(const vlSpectrum *s) {
  static const char *const kinds[] = {"constant", "rgb", "blackbody", "sampled", "named"};
  static const char *const spaces[] = {"srgb", "dci_p3", "rec2020", "aces2065_1"};
  PyObject *value = NULL;
  const size_t count[] = {s->count, 0};
  switch (s->kind) {
    case VL_SPECTRUM_CONSTANT:
      value = PyFloat_FromDouble((double)s->value);
      break;
    case VL_SPECTRUM_RGB:
      value = Py_BuildValue("(ddd)", (double)s->rgb[0], (double)s->rgb[1], (double)s->rgb[2]);
      break;
    case VL_SPECTRUM_BLACKBODY:
      value = PyFloat_FromDouble((double)s->kelvin);
      break;
    case VL_SPECTRUM_SAMPLED:
      value = Py_BuildValue("(NN)", array_of(s->wavelengths, 'f', count),
                            array_of(s->values, 'f', count));
      break;
    case VL_SPECTRUM_NAMED:
      value = text_object(s->name);
      break;
  }
  return value ? Py_BuildValue("(ssNds)", "spectrum", kinds[s->kind], value, (double)s->scale,
                               spaces[s->space])
               : NULL;
}

/* A copy, as an object of Python. */
static PyObject *image_copy(const Getting *g, const vlImage *from) {
  enum { MAX_CHANNELS = 64 };
  const char *names[MAX_CHANNELS];
  const uint32_t channels = vl_image_channels(from);
  if (channels > MAX_CHANNELS)
    return raise_usage("an image of %u channels cannot be read back", (unsigned)channels);
  for (uint32_t i = 0; i < channels; i++)
    names[i] = vl_image_channel_name(from, i);
  vlImageDef def = vl_default_image_def(vl_image_width(from), vl_image_height(from), channels);
  def.names = names;
  def.type = vl_image_type(from);
  def.encoding = vl_image_encoding(from);
  vlImage *image = NULL;
  vlResult made = vl_image_create(g->scene->context->context, &def, &image);
  if (made != VL_OK)
    return raise_result(made, NULL);
  static const size_t sizes[] = {[VL_PIXEL_U8] = 1,
                                 [VL_PIXEL_U16] = 2,
                                 [VL_PIXEL_F16] = 2,
                                 [VL_PIXEL_F32] = 4,
                                 [VL_PIXEL_U32] = 4};
  memcpy(vl_image_pixels(image), vl_image_const_pixels(from),
         sizes[def.type] * channels * def.width * def.height);
  return image_object(g->scene->context, image);
}

/* ---- what rows describe ------------------------------------------------------------------ */

static PyObject *number_input(const Getting *g, const vlFloatInput *input) {
  return input->texture.index ? new_handle(g->scene, TEXTURES, input->texture.index)
                              : PyFloat_FromDouble((double)input->value);
}

static PyObject *spectrum_input(const Getting *g, const vlSpectrumInput *input) {
  return input->texture.index ? new_handle(g->scene, TEXTURES, input->texture.index)
                              : spectrum_of(&input->value);
}

/* The value of a row's parameter. */
static PyObject *value_of(const Getting *g, const vlParameter *p, const char *def,
                          bool spectrum) {
  const void *at = def + p->offset;
  switch (p->type) {
    case VL_PARAMETER_SPECTRUM:
      return spectrum_of(at);
    case VL_PARAMETER_FLOAT_INPUT:
      return number_input(g, at);
    case VL_PARAMETER_SPECTRUM_INPUT:
      return spectrum_input(g, at);
    case VL_PARAMETER_EITHER_INPUT:
      return spectrum ? spectrum_input(g, (const void *)(def + p->second))
                      : number_input(g, at);
    case VL_PARAMETER_TEXTURE:
      return handle_or_none(g, TEXTURES, ((const vlTextureId *)at)->index);
    case VL_PARAMETER_BOOL:
    case VL_PARAMETER_COUNT:
    case VL_PARAMETER_FLOAT:
    case VL_PARAMETER_DOUBLE:
    case VL_PARAMETER_FLOAT3:
    case VL_PARAMETER_DOUBLE3:
    case VL_PARAMETER_CHOICE:
    case VL_PARAMETER_STRING:
    case VL_PARAMETER_FILE:
      return get_parameter(def, p);
    case VL_PARAMETER_BLOCK:
      break;
  }
  return none();
}

/* Whether a keyword is not read back, since it would change what the object is, or since its
 * value follows from others. */
static bool is_left_out(Family family, const Def *def, const char *name) {
  const char *const follow[] = {"wrap_t",
                                "wrap_t_given",
                                "encoding",
                                "encoding_given",
                                "st_from_uv_given",
                                "use_reflectance",
                                "nx",
                                "ny",
                                "nz"};
  for (size_t i = 0; i < sizeof follow / sizeof *follow; i++)
    if (strcmp(name, follow[i]) == 0)
      return true;
  if (family != MATERIALS)
    return false;
  const vlMaterialDef *m = &def->material;
  const bool reflectance = strcmp(name, "reflectance") == 0;
  if (m->kind == VL_MATERIAL_CONDUCTOR || m->kind == VL_MATERIAL_COATED_CONDUCTOR)
    return reflectance && !m->use_reflectance;
  if (m->kind == VL_MATERIAL_SUBSURFACE)
    return reflectance && !m->subsurface.from_reflectance;
  if (m->kind == VL_MATERIAL_HAIR)
    return (reflectance && m->hair.color != VL_HAIR_REFLECTANCE) ||
           (strcmp(name, "sigma_a") == 0 && m->hair.color != VL_HAIR_SIGMA_A);
  return false;
}

static bool get_row(const Getting *g, Family family, const vlKindRow *row, const Def *def,
                    bool spectrum) {
  for (uint32_t i = 0; i < row->parameter_count; i++) {
    const vlParameter *p = &row->parameters[i];
    if (!p->member || !p->member[0] || (p->flags & VL_PARAMETER_SHORTHAND) ||
        p->type == VL_PARAMETER_BLOCK || strchr(p->member, '['))
      continue;
    const char *name = vl_setting_keyword(p);
    char other[48];
    if (p->type == VL_PARAMETER_EITHER_INPUT && spectrum) {
      PyOS_snprintf(other, sizeof other, "spectrum_%s", name + strlen("float_"));
      name = other;
    }
    if (!is_left_out(family, def, name) &&
        !put(g, name, value_of(g, p, (const char *)def, spectrum)))
      return false;
  }
  return true;
}

/* ---- the rest of the defs ---------------------------------------------------------------- */

static bool get_texture(const Getting *g, const vlTextureDef *d) {
  static const char *const encodings[] = {"linear", "srgb", "gamma"};
  static const char *const wraps[] = {"repeat", "black", "clamp", "octahedral", "mirror"};
  bool fine =
      put(g, "name", text_or_none(d->name)) && put(g, "spectrum", PyBool_FromLong(d->spectrum));
  if (d->image)
    fine = fine && put(g, "image", image_copy(g, d->image));
  if (d->data)
    fine = fine && put(g, "data", PyBytes_FromStringAndSize(d->data, (Py_ssize_t)d->data_size));
  if (d->encoding_given)
    fine = fine && put(g, "encoding", PyUnicode_FromString(encodings[d->encoding]));
  if (d->wrap_t_given)
    fine = fine && put(g, "wrap_t", PyUnicode_FromString(wraps[d->wrap_t]));
  if (d->st_from_uv_given)
    fine =
        fine && put(g, "st_from_uv", array_of(d->st_from_uv, 'f', (const size_t[]){2, 3, 0}));
  if (d->kind == VL_TEXTURE_IMAGE || d->kind == VL_TEXTURE_VERTEX_COLOR)
    fine = fine && put(g, "tint", array_of(d->tint, 'f', (const size_t[]){4, 0})) &&
           put(g, "channel", PyLong_FromLong(d->channel));
  return fine && put(g, "texture_from_world", matrix_of(d->texture_from_world));
}

static bool get_material(const Getting *g, const vlMaterialDef *d) {
  if (d->kind == VL_MATERIAL_MIX &&
      !put(g, "materials",
           Py_BuildValue("(NN)", handle_or_none(g, MATERIALS, d->materials[0].index),
                         handle_or_none(g, MATERIALS, d->materials[1].index))))
    return false;
  return put(g, "name", text_or_none(d->name));
}

static bool get_grid(const Getting *g, const vlMediumDef *d, const char *name,
                     const float *data, size_t per) {
  const size_t shape[] = {d->nz, d->ny, d->nx, per, 0};
  return !data || put(g, name, array_of(data, 'f', shape));
}

static bool get_medium(const Getting *g, const vlMediumDef *d) {
  return put(g, "name", text_or_none(d->name)) &&
         put(g, "transform", matrix_of(d->world_from_medium)) &&
         get_grid(g, d, "density", d->density, 0) &&
         get_grid(g, d, "emission_scales", d->emission_scales, 0) &&
         get_grid(g, d, "temperature", d->temperature, 0) &&
         get_grid(g, d, "rgb_a", d->rgb_a, 3) && get_grid(g, d, "rgb_s", d->rgb_s, 3) &&
         get_grid(g, d, "rgb_emission", d->rgb_emission, 3);
}

static bool get_light(const Getting *g, const vlLightDef *d) {
  static const size_t corners[] = {4, 3, 0};
  return put(g, "transform", matrix_of(d->world_from_light)) &&
         put(g, "medium", handle_or_none(g, MEDIA, d->medium.index)) &&
         (!d->image || put(g, "image", image_copy(g, d->image))) &&
         (!d->lamp_data ||
          put(g, "lamp_data",
              PyBytes_FromStringAndSize(d->lamp_data, (Py_ssize_t)d->lamp_size))) &&
         (!d->has_portal || put(g, "portal", array_of(d->portal, 'f', corners)));
}

static bool get_shape(const Getting *g, const vlShapeDef *d) {
  const size_t faces[] = {d->faces, d->kind == VL_SHAPE_BILINEAR ? 4 : 3, 0};
  bool fine =
      put(g, "name", text_or_none(d->label.name)) &&
      put(g, "material", handle_or_none(g, MATERIALS, d->material.index)) &&
      put(g, "emission", handle_or_none(g, EMISSION, d->emission.index)) &&
      put(g, "group", handle_or_none(g, GROUPS, d->group.index)) &&
      put(g, "inside", handle_or_none(g, MEDIA, d->inside.index)) &&
      put(g, "outside", handle_or_none(g, MEDIA, d->outside.index)) &&
      put(g, "transform", matrix_of(d->group_from_shape)) &&
      put(g, "reverse_orientation", PyBool_FromLong(d->reverse_orientation)) &&
      put(g, "backdrop", PyBool_FromLong(d->backdrop)) &&
      put(g, "hidden_from_camera", PyBool_FromLong(d->hidden_from_camera)) &&
      (!d->indices || put(g, "indices", array_of(d->indices, 'I', faces))) &&
      (!d->positions_close || put(g, "times", Py_BuildValue("(dd)", d->times[0], d->times[1])));
  for (int i = 0; fine && i < SHAPE_ARRAYS; i++) {
    const void *data = shape_array(d, i);
    const size_t per = shape_arrays[i].per;
    const size_t shape[] = {shape_elements(d, i), per == 1 ? 0 : per, 0};
    fine = !data || put(g, shape_arrays[i].name, array_of(data, shape_arrays[i].type, shape));
  }
  return fine;
}

static bool get_instance(const Getting *g, uint32_t index) {
  vlInstanceInfo info;
  if (vl_scene_instance(g->scene->scene, (vlInstanceId){index}, &info) != VL_OK) {
    raise_usage("the instance was removed");
    return false;
  }
  const size_t times[] = {info.keys, 0}, poses[] = {info.keys, 4, 4, 0};
  return put(g, "group", handle_or_none(g, GROUPS, info.group.index)) &&
         (info.moves ? put(g, "transform", array_of(info.poses, 'd', poses)) &&
                           put(g, "times", array_of(info.times, 'd', times))
                     : put(g, "transform", matrix_of(info.world_from_group)));
}

static bool get_rest(const Getting *g, Family family, const Def *def) {
  switch (family) {
    case TEXTURES:
      return get_texture(g, &def->texture);
    case MATERIALS:
      return get_material(g, &def->material);
    case MEDIA:
      return get_medium(g, &def->medium);
    case LIGHTS:
      return get_light(g, &def->light);
    case SHAPES:
      return get_shape(g, &def->shape);
    case EMISSION:
    case GROUPS:
    case INSTANCES:
      break;
  }
  return true;
}

/* _get(handle): the keywords that make the object. */
PyObject *scene_get(Scene *self, PyObject *object) {
  uint32_t index;
  int family = handle_family_of(self, object, &index), kind = 0;
  if (family < 0)
    return NULL;
  const Getting g = {self, PyDict_New()};
  Def def;
  bool fine = g.dict != NULL;
  if (family == INSTANCES) {
    fine = fine && get_instance(&g, index);
  } else if (family != GROUPS) {
    if (!get_def(self->scene, (Family)family, index, &def, &kind)) {
      Py_XDECREF(g.dict);
      return raise_usage("the scene has no such object");
    }
    const vlKindRow *row = vl_kind_family_find(family_names[family])->rows[kind];
    fine = fine &&
           get_row(&g, (Family)family, row, &def, family == TEXTURES && def.texture.spectrum) &&
           get_rest(&g, (Family)family, &def);
  }
  if (fine)
    return g.dict;
  Py_XDECREF(g.dict);
  return NULL;
}
