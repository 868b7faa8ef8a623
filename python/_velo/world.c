/* _velo/world.c: worlds. */
#include <string.h>

#include "module.h"

typedef struct Building {
  const vlScene *scene;
  vlBuildDef def;
  vlWorld *world;
  vlError error;
} Building;
static vlResult run_build(void *user) {
  Building *b = user;
  return vl_world_build(b->scene, &b->def, &b->world, &b->error);
}

/* world_build(scene, settings, previous world or None, callback or None) */
static PyObject *world_build(PyObject *module, PyObject *arguments) {
  (void)module;
  Scene *scene;
  Settings *settings;
  PyObject *object, *callback;
  if (!PyArg_ParseTuple(arguments, "O!O!OO:world_build", base_types[TYPE_SCENE], &scene,
                        base_types[TYPE_SETTINGS], &settings, &object, &callback))
    return NULL;
  if (!scene->scene)
    return raise_usage("the scene is closed");
  World *previous = object == Py_None ? NULL : (World *)object;
  if (previous && !is_object(object, TYPE_WORLD))
    return raise_usage("previous must be a velo.World");
  if (previous && !previous->world)
    return raise_usage("the previous world is closed");
  if (previous && previous->context != scene->context)
    return raise_usage("the previous world has another context");
  LongCall call;
  if (!long_call_begin(&call, scene->context, callback))
    return NULL;
  Building b = {.scene = scene->scene, .def = settings->defs.build};
  b.def.previous = previous ? previous->world : NULL;
  b.def.cancel = call.cancel;
  b.def.progress = call.callback ? long_call_step : NULL;
  b.def.progress_user = &call;
  if (previous)
    previous->users++;
  vlResult done;
  bool fine = long_call_run(&call, &scene->busy, run_build, &b, &done);
  long_call_end(&call);
  if (previous)
    previous->users--;
  if (fine && done != VL_OK)
    return raise_result(done, &b.error);
  World *self = fine ? make_object(TYPE_WORLD) : NULL;
  if (!self) {
    if (context_is_ours(scene->context))
      vl_world_destroy(b.world);
    return NULL;
  }
  Py_INCREF((PyObject *)scene->context);
  self->context = scene->context;
  self->world = b.world;
  return (PyObject *)self;
}

static void world_dealloc(World *self) {
  if (context_is_ours(self->context))
    vl_world_destroy(self->world);
  Py_XDECREF((PyObject *)self->context);
  free_object((PyObject *)self);
}

static PyObject *world_close(World *self, PyObject *unused) {
  (void)unused;
  if (self->users)
    return raise_usage("the world is in use");
  if (context_is_ours(self->context))
    vl_world_destroy(self->world);
  self->world = NULL;
  Py_RETURN_NONE;
}

static PyObject *world_closed(World *self, void *unused) {
  (void)unused;
  return PyBool_FromLong(self->world == NULL);
}

static PyObject *world_info(World *self, void *unused) {
  (void)unused;
  if (!self->world)
    return raise_usage("the world is closed");
  vlWorldInfo i;
  vl_world_info(self->world, &i);
  return Py_BuildValue(
      "{s:K,s:K,s:K,s:K,s:K,s:K,s:(ddd),s:(ddd),s:d}", "triangles",
      (unsigned long long)i.triangles, "primitives", (unsigned long long)i.primitives,
      "instances", (unsigned long long)i.instances, "lights", (unsigned long long)i.lights,
      "texture_bytes", (unsigned long long)i.texture_bytes, "bytes",
      (unsigned long long)i.bytes, "bounds_min", (double)i.bounds_min[0],
      (double)i.bounds_min[1], (double)i.bounds_min[2], "bounds_max", (double)i.bounds_max[0],
      (double)i.bounds_max[1], (double)i.bounds_max[2], "build_seconds", i.build_seconds);
}

static PyObject *text_or_none(const char *text) {
  if (!text)
    Py_RETURN_NONE;
  return text_object(text);
}

/* _ids(kind): a list of dicts, that of id 1 first. */
static PyObject *world_ids(World *self, PyObject *name) {
  static const char *const kinds[] = {"object", "material", "instance", NULL};
  if (!self->world)
    return raise_usage("the world is closed");
  int kind = find_choice(kinds, "kind of id", name);
  if (kind < 0)
    return NULL;
  PyObject *list = PyList_New(0);
  for (uint32_t id = 1; list && id <= vl_world_id_count(self->world, (vlIdKind)kind); id++) {
    vlIdInfo info;
    vl_world_id_info(self->world, (vlIdKind)kind, id, &info);
    PyObject *entry = Py_BuildValue(
        "{s:I,s:N,s:N,s:N,s:N,s:N,s:N,s:I,s:I}", "id", id, "name", text_or_none(info.name),
        "path", text_or_none(info.path), "place", text_or_none(info.place), "type",
        text_or_none(info.type), "shared_name", PyBool_FromLong(info.shared_name), "file",
        text_or_none(info.source.file), "line", info.source.line, "material", info.material);
    if (!entry || PyList_Append(list, entry) < 0)
      Py_CLEAR(list);
    Py_XDECREF(entry);
  }
  return list;
}

static PyMethodDef world_methods[] = {
    {"_close", (PyCFunction)world_close, METH_NOARGS, "Frees the world."},
    {"_ids", (PyCFunction)world_ids, METH_O, "What the ids of a kind stand for."},
    {"_trace", (PyCFunction)world_trace, METH_VARARGS,
     "Hits of rays: origins, directions, t_min, t_max, times, hits, bits of the fields."},
    {"_occluded", (PyCFunction)world_occluded, METH_VARARGS,
     "Whether rays are blocked: origins, directions, t_min, t_max, times."},
    {NULL, NULL, 0, NULL},
};
static PyGetSetDef world_members[] = {
    {"closed", (getter)world_closed, NULL, "Whether it was closed.", NULL},
    {"info", (getter)world_info, NULL,
     "Counts, bytes, bounds (scene units) and seconds of the build.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};
static PyType_Slot world_slots[] = {
    {Py_tp_doc, "A compiled scene. It never changes."},
    {Py_tp_dealloc, world_dealloc},
    {Py_tp_methods, world_methods},
    {Py_tp_getset, world_members},
    {0, NULL},
};
PyType_Spec world_spec = {
    "velo._velo.World", sizeof(World), 0,
    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_DISALLOW_INSTANTIATION, world_slots};

PyMethodDef world_functions[] = {
    {"world_build", world_build, METH_VARARGS,
     "Compiles a scene: scene, settings, previous world, callback."},
    {NULL, NULL, 0, NULL},
};
