/* _velo/scene_edit.c: changes to the objects of a scene (velo/edit.h), and handles. */
#include <string.h>
#include <velo/edit.h>

#include "adding.h"

int handle_family_of(const Scene *self, PyObject *object, uint32_t *index) {
  if (!scene_open(self))
    return -1;
  if (!is_object(object, TYPE_HANDLE)) {
    raise_value("handle", object, "a velo.Handle of the scene");
    return -1;
  }
  const Handle *h = (const Handle *)object;
  if (h->scene != self) {
    raise_usage("the handle is part of another scene");
    return -1;
  }
  int family = 0;
  while (strcmp(family_names[family], h->family) != 0)
    family++;
  *index = h->index;
  return handle_is_valid(h) ? family : -1;
}

bool get_def(const vlScene *scene, Family family, uint32_t index, Def *def, int *kind) {
#define GET(FAMILY, member, Id, function, number)                    \
  case FAMILY: {                                                     \
    const __typeof__(def->member) *d = function(scene, (Id){index}); \
    if (d)                                                           \
      def->member = *d, *kind = (int)(number);                       \
    return d != NULL;                                                \
  }
  switch (family) {
    GET(TEXTURES, texture, vlTextureId, vl_scene_texture, d->kind)
    GET(MATERIALS, material, vlMaterialId, vl_scene_material, d->kind)
    GET(MEDIA, medium, vlMediumId, vl_scene_medium, d->kind)
    GET(EMISSION, emission, vlEmissionId, vl_scene_emission, 0)
    GET(LIGHTS, light, vlLightId, vl_scene_light, d->kind)
    GET(SHAPES, shape, vlShapeId, vl_scene_shape, d->kind)
    case GROUPS:
    case INSTANCES:
      break;
  }
#undef GET
  return false;
}

static PyObject *outcome(vlResult result, const vlError *error) {
  if (result != VL_OK)
    return raise_result(result, error);
  Py_RETURN_NONE;
}

/* ---- changes ----------------------------------------------------------------------------- */

vlResult put_def(vlScene *scene, Family family, uint32_t index, const Def *def,
                 vlError *error) {
  switch (family) {
    case TEXTURES:
      return vl_scene_set_texture(scene, (vlTextureId){index}, &def->texture, error);
    case MATERIALS:
      return vl_scene_set_material(scene, (vlMaterialId){index}, &def->material, error);
    case EMISSION:
      return vl_scene_set_emission(scene, (vlEmissionId){index}, &def->emission, error);
    case LIGHTS:
      return vl_scene_set_light(scene, (vlLightId){index}, &def->light, error);
    case MEDIA:
      return vl_scene_set_medium(scene, (vlMediumId){index}, &def->medium, error);
    case SHAPES:
      return vl_scene_set_shape(scene, (vlShapeId){index}, &def->shape, error);
    case GROUPS:
    case INSTANCES:
      break;
  }
  return VL_ERROR_ARGUMENT;
}

/* Whether the keywords name only what a shape can be given without compiling it again. */
static bool is_look(PyObject *keywords) {
  return PyDict_Size(keywords) == (PyDict_GetItemString(keywords, "material") != NULL) +
                                      (PyDict_GetItemString(keywords, "emission") != NULL);
}

/* A shape's material and emission. */
static PyObject *set_look(Scene *self, uint32_t index, PyObject *keywords) {
  PyObject *material = PyDict_GetItemString(keywords, "material"),
           *emission = PyDict_GetItemString(keywords, "emission");
  vlMaterialId m = {0};
  vlEmissionId e = {0};
  if ((material && !read_handle(self, material, "materials", "material", &m.index)) ||
      (emission && !read_handle(self, emission, "emission", "emission", &e.index)))
    return NULL;
  const vlShapeId shape = {index};
  vlError error = {0};
  vlResult result = VL_OK;
  if (emission)
    result = vl_scene_set_shape_emission(self->scene, shape, e, &error);
  if (material && result == VL_OK)
    result = vl_scene_set_shape_material(self->scene, shape, m, &error);
  return outcome(result, &error);
}

static PyObject *set_instance(Scene *self, uint32_t index, PyObject *keywords) {
  PyObject *transform = PyDict_GetItemString(keywords, "transform"),
           *pose = PyDict_GetItemString(keywords, "pose");
  double m[16];
  if (!transform == !pose || PyDict_Size(keywords) != 1)
    return raise_usage("of an instance, its pose (or transform) can be changed");
  if (!numbers_copy(pose ? pose : transform, pose ? "pose" : "transform", 16, m))
    return NULL;
  vlError error = {0};
  return outcome(vl_scene_set_instance(self->scene, (vlInstanceId){index}, m, &error), &error);
}

/* The default def of another kind, with the object's name and place. */
static void change_kind(Family family, int kind, bool spectrum, Def *def) {
  const Def old = *def;
  default_def(family, kind, spectrum, def);
  if (family == TEXTURES) {
    def->texture.name = old.texture.name;
    def->texture.source = old.texture.source;
  }
  if (family == MATERIALS) {
    def->material.name = old.material.name;
    def->material.source = old.material.source;
  }
  if (family == EMISSION)
    def->emission.source = old.emission.source;
  if (family == LIGHTS)
    def->light.source = old.light.source;
  if (family == MEDIA) {
    def->medium.name = old.medium.name;
    def->medium.source = old.medium.source;
  }
  if (family == SHAPES) {
    const vlShapeDef *o = &old.shape;
    vlShapeDef *d = &def->shape;
    d->label = o->label;
    d->source = o->source;
    d->group = o->group;
    d->material = o->material;
    d->emission = o->emission;
    d->inside = o->inside;
    d->outside = o->outside;
    memcpy(d->group_from_shape, o->group_from_shape, sizeof d->group_from_shape);
  }
}

/* _set(handle, kind or None, keywords) */
PyObject *scene_set(Scene *self, PyObject *arguments) {
  PyObject *object, *kind_name, *keywords;
  uint32_t index;
  if (!PyArg_ParseTuple(arguments, "OOO!:_set", &object, &kind_name, &PyDict_Type, &keywords))
    return NULL;
  int family = handle_family_of(self, object, &index), kind = 0;
  if (family < 0)
    return NULL;
  if (kind_name != Py_None && family == INSTANCES)
    return raise_usage("an instance has no kind");
  if (family == SHAPES && kind_name == Py_None && is_look(keywords))
    return set_look(self, index, keywords);
  if (family == INSTANCES)
    return set_instance(self, index, keywords);
  if (family == GROUPS)
    return raise_usage("%s cannot be changed", family_names[family]);
  Def def;
  if (!get_def(self->scene, (Family)family, index, &def, &kind))
    return raise_usage("the scene has no such object");
  const vlKindFamily *kinds = vl_kind_family_find(family_names[family]);
  bool spectrum = family == TEXTURES && def.texture.spectrum;
  if (kind_name != Py_None) {
    kind = find_kind(kinds, kinds->thing, kind_name);
    if (kind < 0)
      return NULL;
    change_kind((Family)family, kind, spectrum, &def);
  }
  const Def old = def;
  Adding a = {
      .scene = self, .keep = PyList_New(0), .old = family == SHAPES ? &old.shape : NULL};
  PyObject *result = NULL;
  self->busy = true; /* code that the conversions run must not free what the def points at */
  bool fine = a.keep && set_all(&a, (Family)family, kinds->rows[kind], kinds->thing, keywords,
                                spectrum, &def);
  self->busy = false;
  if (fine) {
    Call call;
    if (call_begin(&call, self->context, &self->busy)) {
      vlError error = {0};
      vlResult done = put_def(self->scene, (Family)family, index, &def, &error);
      call_end(&call);
      result = outcome(done, &error);
    }
  }
  for (int i = 0; i < a.array_count; i++)
    numbers_release(&a.arrays[i]);
  Py_XDECREF(a.keep);
  return result;
}

/* _show(handle, shown) */
PyObject *scene_show(Scene *self, PyObject *arguments) {
  PyObject *object;
  PyObject *flag;
  bool shown;
  uint32_t index;
  if (!PyArg_ParseTuple(arguments, "OO:_show", &object, &flag) ||
      !read_flag(flag, "shown", &shown))
    return NULL;
  int family = handle_family_of(self, object, &index);
  if (family < 0)
    return NULL;
  vlError error = {0};
  switch ((Family)family) {
    case LIGHTS:
      return outcome(vl_scene_show_light(self->scene, (vlLightId){index}, shown, &error),
                     &error);
    case SHAPES:
      return outcome(vl_scene_show_shape(self->scene, (vlShapeId){index}, shown, &error),
                     &error);
    case INSTANCES:
      return outcome(vl_scene_show_instance(self->scene, (vlInstanceId){index}, shown, &error),
                     &error);
    case TEXTURES:
    case MATERIALS:
    case MEDIA:
    case EMISSION:
    case GROUPS:
      break;
  }
  return raise_usage("lights, shapes and instances can be hidden, not %s",
                     family_names[family]);
}

/* _remove(handle) */
PyObject *scene_remove(Scene *self, PyObject *object) {
  uint32_t index;
  int family = handle_family_of(self, object, &index);
  if (family < 0)
    return NULL;
  vlError error = {0};
  return outcome(vl_scene_remove(self->scene, scene_family((Family)family), index, &error),
                 &error);
}

/* ---- handles ----------------------------------------------------------------------------- */

/* _handles(family): a list. */
PyObject *scene_handles(Scene *self, PyObject *name) {
  if (!scene_open(self))
    return NULL;
  int family = find_choice(family_names, "family", name);
  if (family < 0)
    return NULL;
  const vlSceneFamily f = scene_family((Family)family);
  const uint32_t highest = vl_scene_highest(self->scene, f);
  PyObject *list = PyList_New(0);
  for (uint32_t index = 1; list && index <= highest; index++) {
    if (!vl_scene_has(self->scene, f, index))
      continue;
    PyObject *h = new_handle(self, (Family)family, index);
    if (!h || PyList_Append(list, h) < 0)
      Py_CLEAR(list);
    Py_XDECREF(h);
  }
  return list;
}

static void handle_dealloc(Handle *self) {
  Py_XDECREF((PyObject *)self->scene);
  free_object((PyObject *)self);
}
static PyObject *handle_repr(Handle *self) {
  return PyUnicode_FromFormat("<velo.Handle: number %u of the scene's %s>", self->index,
                              self->family);
}
static PyObject *handle_compare(Handle *self, PyObject *object, int operation) {
  if (!is_object(object, TYPE_HANDLE) || (operation != Py_EQ && operation != Py_NE))
    Py_RETURN_NOTIMPLEMENTED;
  const Handle *other = (const Handle *)object;
  bool same = self->scene == other->scene && self->index == other->index &&
              self->serial == other->serial && strcmp(self->family, other->family) == 0;
  return PyBool_FromLong(same == (operation == Py_EQ));
}
static Py_hash_t handle_hash(Handle *self) {
  return (Py_hash_t)(((uintptr_t)self->scene >> 4) ^ ((uintptr_t)self->index << 3) ^
                     (uintptr_t)self->family[0]) &
         0x7fffffff;
}

static PyObject *handle_index_member(Handle *self, void *unused) {
  (void)unused;
  return PyLong_FromUnsignedLong(self->index);
}
static PyObject *handle_family(Handle *self, void *unused) {
  (void)unused;
  return PyUnicode_FromString(self->family);
}

static PyObject *handle_kind(Handle *self, void *unused) {
  (void)unused;
  uint32_t index;
  int family = handle_family_of(self->scene, (PyObject *)self, &index), kind;
  Def def;
  if (family < 0)
    return NULL;
  if (!get_def(self->scene->scene, (Family)family, index, &def, &kind))
    Py_RETURN_NONE;
  const vlKindFamily *kinds = vl_kind_family_find(family_names[family]);
  return PyUnicode_FromString(kinds->words[kind]);
}

static PyObject *handle_name(Handle *self, void *unused) {
  (void)unused;
  uint32_t index;
  int family = handle_family_of(self->scene, (PyObject *)self, &index), kind;
  if (family < 0)
    return NULL;
  Def def;
  vlInstanceInfo info;
  const char *name = NULL;
  if (get_def(self->scene->scene, (Family)family, index, &def, &kind))
    name = family == TEXTURES    ? def.texture.name
           : family == MATERIALS ? def.material.name
           : family == MEDIA     ? def.medium.name
           : family == SHAPES    ? def.shape.label.name
                                 : NULL;
  if (family == INSTANCES &&
      vl_scene_instance(self->scene->scene, (vlInstanceId){index}, &info) == VL_OK)
    name = info.label.name;
  if (!name || !name[0])
    Py_RETURN_NONE;
  return text_object(name);
}

static PyObject *copy_array(const void *data, size_t size) {
  void *to = NULL;
  PyObject *bytes = make_bytes(size, &to);
  if (bytes && size)
    memcpy(to, data, size);
  return bytes;
}

/* _mesh(handle): (positions, indices, number of corners of a face, 16 numbers) */
PyObject *scene_mesh(Scene *self, PyObject *object) {
  uint32_t index;
  int family = handle_family_of(self, object, &index);
  if (family < 0)
    return NULL;
  const vlShapeDef *d =
      family == SHAPES ? vl_scene_shape(self->scene, (vlShapeId){index}) : NULL;
  if (!d || (d->kind != VL_SHAPE_TRIANGLES && d->kind != VL_SHAPE_BILINEAR) || !d->positions ||
      !d->indices)
    return raise_usage("this is not a mesh of triangles or bilinear patches");
  const int corners = d->kind == VL_SHAPE_BILINEAR ? 4 : 3;
  PyObject *matrix = PyTuple_New(16);
  for (int i = 0; matrix && i < 16; i++)
    PyTuple_SetItem(matrix, i, PyFloat_FromDouble(d->group_from_shape[i]));
  return matrix
             ? Py_BuildValue("(NNiN)",
                             copy_array(d->positions, (size_t)d->vertices * 3 * sizeof(float)),
                             copy_array(d->indices,
                                        (size_t)d->faces * (size_t)corners * sizeof(uint32_t)),
                             corners, matrix)
             : NULL;
}

/* _instance(handle): (group, 16 numbers, moves, shown) */
PyObject *scene_instance(Scene *self, PyObject *object) {
  uint32_t index;
  int family = handle_family_of(self, object, &index);
  vlInstanceInfo info;
  if (family < 0)
    return NULL;
  if (family != INSTANCES ||
      vl_scene_instance(self->scene, (vlInstanceId){index}, &info) != VL_OK)
    return raise_usage("this is not an instance of the scene");
  PyObject *matrix = PyTuple_New(16);
  for (int i = 0; matrix && i < 16; i++)
    PyTuple_SetItem(matrix, i, PyFloat_FromDouble(info.world_from_group[i]));
  return matrix ? Py_BuildValue("(NNNN)", new_handle(self, GROUPS, info.group.index), matrix,
                                PyBool_FromLong(info.moves), PyBool_FromLong(info.shown))
                : NULL;
}

static PyGetSetDef handle_members[] = {
    {"index", (getter)handle_index_member, NULL, "Its number in the scene, from 1.", NULL},
    {"family", (getter)handle_family, NULL,
     "textures, materials, media, emission, lights, shapes, groups or instances.", NULL},
    {"kind", (getter)handle_kind, NULL,
     "Its kind, \"principled\" for example; None: of groups and instances.", NULL},
    {"name", (getter)handle_name, NULL,
     "Its name in the file, or that it was given; None: it has none.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};
static PyType_Slot handle_slots[] = {
    {Py_tp_doc,
     "A texture, material, medium, emission, light, shape, group or instance of a scene."},
    {Py_tp_dealloc, handle_dealloc},
    {Py_tp_repr, handle_repr},
    {Py_tp_richcompare, handle_compare},
    {Py_tp_hash, handle_hash},
    {Py_tp_getset, handle_members},
    {0, NULL},
};
PyType_Spec handle_spec = {"velo._velo.Handle", sizeof(Handle), 0,
                           Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION,
                           handle_slots};
