/* _velo/scene.c: scenes: files, camera, contents. */
#include <string.h>

#include "adding.h"
#include "module.h"

bool scene_open(const Scene *self) {
  if (!self->scene) {
    raise_usage("the scene is closed");
    return false;
  }
  if (self->busy) {
    raise_usage("another thread is using the scene");
    return false;
  }
  return context_check(self->context);
}

vlSceneCheckpoint *scene_attempt(const Scene *self) {
  vlSceneCheckpoint *checkpoint = NULL;
  vlError error = {0};
  if (!scene_open(self)) /* conversions of arguments may have run code that closed it */
    return NULL;
  vlResult done = vl_scene_checkpoint(self->scene, &checkpoint, &error);
  if (done != VL_OK)
    raise_result(done, &error);
  return checkpoint;
}

void scene_settle(Scene *self, vlSceneCheckpoint *checkpoint, bool done) {
  if (done)
    vl_scene_checkpoint_destroy(checkpoint);
  else
    vl_scene_roll_back(self->scene, checkpoint);
}

/* scene_new(context) */
static PyObject *scene_new(PyTypeObject *type, PyObject *arguments, PyObject *keywords) {
  static char *names[] = {"context", NULL};
  Context *context;
  if (!PyArg_ParseTupleAndKeywords(arguments, keywords, "O!:Scene", names,
                                   base_types[TYPE_CONTEXT], &context))
    return NULL;
  Call call;
  if (!call_begin(&call, context, NULL))
    return NULL;
  vlScene *scene = NULL;
  vlResult done = vl_scene_create(context->context, &scene);
  call_end(&call);
  if (done != VL_OK)
    return raise_result(done, NULL);
  Scene *self = (Scene *)((allocfunc)PyType_GetSlot(type, Py_tp_alloc))(type, 0);
  if (!self) {
    vl_scene_destroy(scene);
    return NULL;
  }
  Py_INCREF((PyObject *)context);
  self->context = context;
  self->scene = scene;
  self->keep = PyList_New(0);
  if (!self->keep) {
    Py_DECREF((PyObject *)self);
    return NULL;
  }
  return (PyObject *)self;
}

static void scene_dealloc(Scene *self) {
  if (context_is_ours(self->context))
    vl_scene_destroy(self->scene);
  Py_XDECREF(self->keep);
  Py_XDECREF((PyObject *)self->context);
  free_object((PyObject *)self);
}

static PyObject *scene_close(Scene *self, PyObject *unused) {
  (void)unused;
  if (self->busy)
    return raise_usage("another thread is using the scene");
  if (context_is_ours(self->context))
    vl_scene_destroy(self->scene);
  self->scene = NULL;
  Py_RETURN_NONE;
}

static vlResult run_load(void *user) {
  Loading *l = user;
  return l->loaded
             ? vl_scene_load_group(l->scene, l->file, &l->def, l->name, l->loaded, &l->error)
             : vl_scene_load(l->scene, l->file, &l->def, &l->error);
}

bool load_file(Scene *self, Loading *l, PyObject *callback) {
  LongCall call;
  vlSceneCheckpoint *checkpoint = scene_attempt(self);
  if (!checkpoint)
    return false;
  if (!long_call_begin(&call, self->context, callback)) {
    scene_settle(self, checkpoint, true);
    return false;
  }
  l->scene = self->scene;
  l->def.cancel = call.cancel;
  l->def.progress = call.callback ? long_call_step : NULL;
  l->def.progress_user = &call;
  vlResult done;
  bool fine = long_call_run(&call, &self->busy, run_load, l, &done);
  long_call_end(&call);
  scene_settle(self, checkpoint, fine && done == VL_OK);
  if (fine && done != VL_OK)
    fine = raise_result(done, &l->error) != NULL;
  return fine;
}

/* _load(path, keywords of vlLoadDef, callback or None) */
static PyObject *scene_load(Scene *self, PyObject *arguments) {
  PyObject *path, *keywords, *callback, *keep = PyList_New(0);
  Loading l = {.def = vl_default_load_def()};
  const Target target = {(char *)&l.def, keep, self, false};
  bool fine =
      keep &&
      PyArg_ParseTuple(arguments, "OO!O:_load", &path, &PyDict_Type, &keywords, &callback) &&
      scene_open(self) &&
      set_parameters(&target, VL_SETTING_LOAD, "keyword of load", keywords) &&
      (l.file = keep_path(keep, path, "path")) && load_file(self, &l, callback);
  Py_XDECREF(keep);
  if (!fine)
    return NULL;
  Py_RETURN_NONE;
}

/* _complete(keywords of vlCompleteDef) */
static PyObject *scene_complete(Scene *self, PyObject *keywords) {
  PyObject *keep = PyList_New(0);
  vlCompleteDef def = vl_default_complete_def();
  const Target target = {(char *)&def, keep, self, false};
  vlSceneCheckpoint *checkpoint = NULL;
  Call call;
  if (!keep || !PyDict_Check(keywords) || !scene_open(self) ||
      !set_parameters(&target, VL_SETTING_COMPLETE, "keyword of load", keywords) ||
      !(checkpoint = scene_attempt(self)) || !call_begin(&call, self->context, &self->busy)) {
    vl_scene_checkpoint_destroy(checkpoint);
    Py_XDECREF(keep);
    return NULL;
  }
  vlError error = {0};
  vlResult done = vl_scene_complete(self->scene, &def, &error);
  call_end(&call);
  scene_settle(self, checkpoint, done == VL_OK);
  Py_DECREF(keep);
  if (done != VL_OK)
    return raise_result(done, &error);
  Py_RETURN_NONE;
}

/* _save(path, strict): {what is lost: how often} */
static void lost(void *user, const char *what, uint64_t count) {
  PyGILState_STATE state = PyGILState_Ensure();
  PyObject *number = PyLong_FromUnsignedLongLong(count);
  PyObject *text = text_object(what);
  if (!number || !text || PyDict_SetItem(user, text, number) < 0)
    PyErr_WriteUnraisable(NULL);
  Py_XDECREF(text);
  Py_XDECREF(number);
  PyGILState_Release(state);
}
static PyObject *scene_save(Scene *self, PyObject *arguments) {
  PyObject *path, *flag, *keep = PyList_New(0), *losses = PyDict_New();
  bool strict;
  const char *file;
  vlSaveDef def = vl_default_save_def();
  Call call;
  if (!keep || !losses || !PyArg_ParseTuple(arguments, "OO:_save", &path, &flag) ||
      !read_flag(flag, "strict", &strict) || !scene_open(self) ||
      !(file = keep_path(keep, path, "path")) ||
      !call_begin(&call, self->context, &self->busy)) {
    Py_XDECREF(keep);
    Py_XDECREF(losses);
    return NULL;
  }
  def.strict = strict;
  def.lost = lost;
  def.lost_user = losses;
  vlError error = {0};
  vlResult done = vl_scene_save(self->scene, file, &def, &error);
  call_end(&call);
  Py_DECREF(keep);
  if (done == VL_OK)
    return losses;
  Py_DECREF(losses);
  return raise_result(done, &error);
}

static PyObject *scene_info(Scene *self, void *unused) {
  (void)unused;
  if (!scene_open(self))
    return NULL;
  vlSceneInfo i;
  vl_scene_info(self->scene, &i);
#define COUNT(field) #field, (unsigned long long)i.field
  return Py_BuildValue("{s:K,s:K,s:K,s:K,s:K,s:K,s:K,s:K,s:K,s:K}", COUNT(shapes),
                       COUNT(triangles), COUNT(vertices), COUNT(textures), COUNT(materials),
                       COUNT(lights), COUNT(emissive_shapes), COUNT(groups), COUNT(instances),
                       COUNT(media));
#undef COUNT
}

static PyObject *scene_camera(Scene *self, PyObject *unused) {
  (void)unused;
  if (!scene_open(self))
    return NULL;
  return camera_object(&vl_scene_defs(self->scene)->camera, (PyObject *)self);
}

static PyObject *scene_set_camera(Scene *self, PyObject *object) {
  if (!scene_open(self))
    return NULL;
  if (!is_object(object, TYPE_CAMERA))
    return raise_value("camera", object, "a velo.Camera");
  if (!keep_object(self->keep, object))
    return NULL;
  const Camera *camera = (const Camera *)object;
  vlSceneDefs *defs = vl_scene_defs(self->scene);
  defs->camera = camera->def;
  defs->camera_missing = false;
  defs->film.width = camera->def.width;
  defs->film.height = camera->def.height;
  const uint32_t whole[4] = {0, 0, camera->def.width, camera->def.height};
  memcpy(defs->film.crop, whole, sizeof whole);
  Py_RETURN_NONE;
}

static PyObject *scene_camera_medium(Scene *self, PyObject *unused) {
  (void)unused;
  if (!scene_open(self))
    return NULL;
  uint32_t index = vl_scene_defs(self->scene)->camera_medium.index;
  if (!index)
    Py_RETURN_NONE;
  return new_handle(self, MEDIA, index);
}

static PyObject *scene_set_camera_medium(Scene *self, PyObject *value) {
  uint32_t index;
  if (!scene_open(self) || !read_handle(self, value, "media", "camera_medium", &index))
    return NULL;
  vl_scene_defs(self->scene)->camera_medium.index = index;
  Py_RETURN_NONE;
}

static PyMethodDef scene_methods[] = {
    {"_load", (PyCFunction)scene_load, METH_VARARGS, "Adds the contents of a file."},
    {"_complete", (PyCFunction)scene_complete, METH_O, "Adds camera, light and ground."},
    {"_save", (PyCFunction)scene_save, METH_VARARGS, "Writes a scene file."},
    {"_add", (PyCFunction)scene_add, METH_VARARGS,
     "Adds a texture, material, medium, emission, light or shape."},
    {"_load_group", (PyCFunction)scene_load_group, METH_VARARGS, "Loads a file as one group."},
    {"_add_instance", (PyCFunction)scene_add_instance, METH_VARARGS, "Places a group."},
    {"_set", (PyCFunction)scene_set, METH_VARARGS, "Changes an object."},
    {"_show", (PyCFunction)scene_show, METH_VARARGS,
     "Shows or hides a light, a shape or an instance."},
    {"_remove", (PyCFunction)scene_remove, METH_O, "Removes an instance."},
    {"_handles", (PyCFunction)scene_handles, METH_O, "The handles of a family."},
    {"_get", (PyCFunction)scene_get, METH_O, "The keywords of an object."},
    {"_mesh", (PyCFunction)scene_mesh, METH_O, "The arrays of a mesh."},
    {"_instance", (PyCFunction)scene_instance, METH_O,
     "An instance's group, pose, whether it moves and is shown."},
    {"_camera", (PyCFunction)scene_camera, METH_NOARGS, "The scene's camera."},
    {"_set_camera", (PyCFunction)scene_set_camera, METH_O,
     "Sets the scene's camera and image size."},
    {"_camera_medium", (PyCFunction)scene_camera_medium, METH_NOARGS,
     "The medium around the camera, or None."},
    {"_set_camera_medium", (PyCFunction)scene_set_camera_medium, METH_O,
     "Sets the medium around the camera."},
    {"_close", (PyCFunction)scene_close, METH_NOARGS, "Frees the scene."},
    {NULL, NULL, 0, NULL},
};
static PyObject *scene_context(Scene *self, void *unused) {
  (void)unused;
  Py_INCREF((PyObject *)self->context);
  return (PyObject *)self->context;
}

static PyGetSetDef scene_members[] = {
    {"context", (getter)scene_context, NULL, "The context that it was made from.", NULL},
    {"info", (getter)scene_info, NULL, "Counts of shapes, triangles, textures and so on.",
     NULL},
    {NULL, NULL, NULL, NULL, NULL},
};
static PyType_Slot scene_slots[] = {
    {Py_tp_doc, "The description of a world and of how its image is taken."},
    {Py_tp_new, scene_new},
    {Py_tp_dealloc, scene_dealloc},
    {Py_tp_methods, scene_methods},
    {Py_tp_getset, scene_members},
    {0, NULL},
};
PyType_Spec scene_spec = {"velo._velo.Scene", sizeof(Scene), 0,
                          Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE, scene_slots};
