/* _velo/render.c: settings, renders, ground truth and boxes. */
#include <math.h>
#include <string.h>

#include "module.h"
#include "velo/filter_kinds.h"
#include "velo/sampler.h"
#include "velo/tracer.h"

/* ---- settings ---------------------------------------------------------------------------- */

static void settings_dealloc(Settings *self) {
  Py_XDECREF(self->keep);
  free_object((PyObject *)self);
}

static const vlParameter *settings_row(const char *name) {
  static const char *const families[] = {"tracers", "films", "samplers"};
  const vlParameter *row = vl_setting(VL_SETTING_RENDER, name);
  for (size_t i = 0; !row && i < sizeof families / sizeof *families; i++) {
    const vlKindFamily *family = vl_kind_family_find(families[i]);
    for (uint32_t k = 0; !row && family && k < family->kind_count; k++) {
      row = find_parameter(family->rows[k]->parameters, family->rows[k]->parameter_count, name);
      if (row && (row->type == VL_PARAMETER_BLOCK || row->flags & VL_PARAMETER_SHORTHAND))
        row = NULL;
    }
  }
  return row;
}

/* scene_settings(scene): a copy of its defs. */
static PyObject *scene_settings(PyObject *module, PyObject *object) {
  (void)module;
  if (!is_object(object, TYPE_SCENE))
    return raise_usage("expected a Scene");
  Scene *scene = (Scene *)object;
  if (!scene_open(scene))
    return NULL;
  Settings *self = make_object(TYPE_SETTINGS);
  if (!self)
    return NULL;
  self->defs = *vl_scene_defs(scene->scene);
  self->keep = PyList_New(0);
  if (!self->keep || !keep_object(self->keep, object)) {
    Py_DECREF((PyObject *)self);
    return NULL;
  }
  return (PyObject *)self;
}

enum { MAX_SENSORS = 63 };

static PyObject *settings_set(Settings *self, PyObject *arguments) {
  const char *name;
  PyObject *text, *value;
  if (!PyArg_ParseTuple(arguments, "OO:set", &text, &value))
    return NULL;
  if (!(name = keep_text(self->keep, text, "a keyword")))
    return NULL;
  const vlParameter *row = settings_row(name);
  if (!row) {
    PyObject *names = PyList_New(0);
    if (names && !append_settings(names, VL_SETTING_RENDER))
      Py_CLEAR(names);
    raise_unknown("keyword of render", name, names);
    return NULL;
  }
  if (strcmp(row->member, "render.tracer") == 0 && is_object(value, TYPE_OWN)) {
    Own *own = own_read(value, VL_OWN_TRACER, "tracer");
    if (!own || !keep_object(self->keep, value))
      return NULL;
    self->defs.render.own_tracer = &own->tracer;
  } else if (row->type == VL_PARAMETER_CHOICE && strcmp(row->member, "render.tracer") == 0) {
    self->defs.render.own_tracer = NULL;
    int kind = find_kind(vl_kind_family_find("tracers"), "tracer", value);
    if (kind < 0)
      return NULL;
    self->defs.render.tracer = (vlTracer)kind;
  } else if (strcmp(row->member, "render.sampler") == 0 && is_object(value, TYPE_OWN)) {
    Own *own = own_read(value, VL_OWN_SAMPLER, "sampler");
    if (!own || !keep_object(self->keep, value))
      return NULL;
    self->defs.render.own_sampler = &own->sampler;
  } else if (row->type == VL_PARAMETER_CHOICE && strcmp(row->member, "render.sampler") == 0) {
    self->defs.render.own_sampler = NULL;
    int kind = find_kind(vl_kind_family_find("samplers"), "sampler", value);
    if (kind < 0)
      return NULL;
    self->defs.render.sampler = (vlSamplerKind)kind;
  } else if (row->type == VL_PARAMETER_CHOICE && strcmp(row->member, "film.filter.kind") == 0) {
    int kind = find_kind(vl_kind_family_find("filters"), "filter", value);
    if (kind < 0)
      return NULL;
    self->defs.film.filter = vl_default_pixel_filter((vlPixelFilterKind)kind);
  } else if (strcmp(row->member, "film.sensor") == 0 && value != Py_None) {
    const char *names[MAX_SENSORS + 1] = {0};
    for (uint32_t i = 0; i < MAX_SENSORS && vl_sensor_name(i); i++)
      names[i] = vl_sensor_name(i);
    int sensor = find_choice(names, "sensor", value);
    if (sensor < 0)
      return NULL;
    self->defs.film.sensor = names[sensor];
  } else {
    const Target target = {(char *)&self->defs, self->keep, NULL, false};
    if (!set_parameter(&target, row, value))
      return NULL;
  }
  Py_RETURN_NONE;
}

static PyObject *settings_get(Settings *self, PyObject *name) {
  PyObject *keep = PyList_New(0), *result = NULL;
  const char *text = keep ? keep_text(keep, name, "name") : NULL;
  const vlParameter *row = text ? settings_row(text) : NULL;
  if (text)
    result = row ? get_parameter((const char *)&self->defs, row)
                 : raise_usage("no setting %s", text);
  Py_XDECREF(keep);
  return result;
}

static PyObject *settings_size(Settings *self, PyObject *arguments) {
  PyObject *width, *height;
  double size[2];
  if (!PyArg_ParseTuple(arguments, "OO:set_size", &width, &height))
    return NULL;
  if (!read_row(width, "resolution's width", vl_setting(VL_SETTING_PROGRAM, "width"),
                &size[0]) ||
      !read_row(height, "resolution's height", vl_setting(VL_SETTING_PROGRAM, "height"),
                &size[1]))
    return NULL;
  vlFilmDef *film = &self->defs.film;
  film->width = (uint32_t)size[0];
  film->height = (uint32_t)size[1];
  film->crop[0] = film->crop[1] = 0;
  film->crop[2] = film->width;
  film->crop[3] = film->height;
  Py_RETURN_NONE;
}

static PyObject *settings_crop(Settings *self, PyObject *arguments) {
  const uint32_t width = self->defs.film.width, height = self->defs.film.height;
  PyObject *edges[4];
  uint32_t c[4];
  if (!PyArg_ParseTuple(arguments, "OOOO:set_crop", &edges[0], &edges[1], &edges[2], &edges[3]))
    return NULL;
  for (int i = 0; i < 4; i++)
    if (!read_count(edges[i], "a number of crop", 0, i & 1 ? height : width, &c[i]))
      return NULL;
  if (c[0] >= c[2] || c[1] >= c[3])
    return raise_value("crop", arguments, "x0, y0, x1, y1 with x0 < x1 and y0 < y1");
  memcpy(self->defs.film.crop, c, sizeof c);
  Py_RETURN_NONE;
}

/* set_coarse(factor): the film of 1/factor of the size. */
static PyObject *settings_coarse(Settings *self, PyObject *number) {
  uint32_t factor;
  if (!read_count(number, "coarse's factor", 1, VL_MAX_COARSE, &factor))
    return NULL;
  self->defs.film = vl_coarse_film_def(&self->defs.film, factor);
  Py_RETURN_NONE;
}
static PyObject *settings_get_size(Settings *self, void *unused) {
  (void)unused;
  return Py_BuildValue("(II)", self->defs.film.width, self->defs.film.height);
}

static PyObject *settings_get_crop(Settings *self, void *unused) {
  (void)unused;
  const uint32_t *c = self->defs.film.crop;
  return Py_BuildValue("(IIII)", c[0], c[1], c[2], c[3]);
}

static PyObject *settings_copy(Settings *self, PyObject *unused) {
  (void)unused;
  Settings *copy = make_object(TYPE_SETTINGS);
  if (!copy)
    return NULL;
  copy->defs = self->defs;
  copy->keep = PyList_New(0);
  if (!copy->keep || !keep_object(copy->keep, (PyObject *)self)) {
    Py_DECREF((PyObject *)copy);
    return NULL;
  }
  return (PyObject *)copy;
}

/* names(): all keywords. */
static PyObject *settings_names(Settings *self, PyObject *unused) {
  (void)self;
  (void)unused;
  PyObject *names = PyList_New(0);
  if (names && !append_settings(names, VL_SETTING_RENDER))
    Py_CLEAR(names);
  return names;
}

static PyMethodDef settings_methods[] = {
    {"set", (PyCFunction)settings_set, METH_VARARGS, "Sets a keyword."},
    {"get", (PyCFunction)settings_get, METH_O, "The value of a keyword."},
    {"set_size", (PyCFunction)settings_size, METH_VARARGS,
     "Width and height, pixels; the crop becomes the whole image."},
    {"set_crop", (PyCFunction)settings_crop, METH_VARARGS, "x0, y0, x1, y1, pixels."},
    {"copy", (PyCFunction)settings_copy, METH_NOARGS,
     "The same settings, to be changed on their own."},
    {"set_coarse", (PyCFunction)settings_coarse, METH_O,
     "The size of a coarse image of this factor."},
    {"names", (PyCFunction)settings_names, METH_NOARGS, "All keywords."},
    {NULL, NULL, 0, NULL},
};
static PyGetSetDef settings_members[] = {
    {"size", (getter)settings_get_size, NULL, "Width and height, pixels.", NULL},
    {"crop", (getter)settings_get_crop, NULL, "x0, y0, x1, y1, pixels.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};
static PyType_Slot settings_slots[] = {
    {Py_tp_doc, "The settings of a render."},
    {Py_tp_dealloc, settings_dealloc},
    {Py_tp_methods, settings_methods},
    {Py_tp_getset, settings_members},
    {0, NULL},
};
PyType_Spec settings_spec = {
    "velo._velo.Settings", sizeof(Settings), 0,
    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_DISALLOW_INSTANTIATION,
    settings_slots};

/* ---- renders ----------------------------------------------------------------------------- */

typedef struct Rendering {
  const vlWorld *world;
  const vlCamera *camera;
  vlFilm *film;
  vlRenderDef def;
  vlRenderStats stats;
  vlError error;
} Rendering;
static vlResult run_render(void *user) {
  Rendering *r = user;
  return vl_render(r->world, r->camera, r->film, &r->def, &r->stats, &r->error);
}

/* render(world, camera, film, settings, callback or None): how many samples were left out, and
 * how many numbers of a sampler of one's own were replaced; column and row of such a sample. */
static PyObject *render(PyObject *module, PyObject *arguments) {
  (void)module;
  World *world;
  Camera *camera;
  Film *film;
  Settings *settings;
  PyObject *callback;
  if (!PyArg_ParseTuple(arguments, "O!O!O!O!O:render", base_types[TYPE_WORLD], &world,
                        base_types[TYPE_CAMERA], &camera, base_types[TYPE_FILM], &film,
                        base_types[TYPE_SETTINGS], &settings, &callback))
    return NULL;
  if (!world->world || !film->film)
    return raise_usage(world->world ? "the film is closed" : "the world is closed");
  if (!check_memory(world->context,
                    vl_render_memory(world->world, &film->def, &settings->defs.render),
                    "the render"))
    return NULL;
  LongCall call;
  if (!long_call_begin(&call, world->context, callback))
    return NULL;
  call.film = film;
  call.own[0] = own_of_camera(&camera->camera);
  call.own[1] = own_of_sampler(&settings->defs.render);
  call.own[2] = own_of_tracer(&settings->defs.render);
  Rendering r = {.world = world->world,
                 .camera = &camera->camera,
                 .film = film->film,
                 .def = settings->defs.render};
  r.def.cancel = call.cancel;
  r.def.progress = call.callback ? long_call_progress : NULL;
  r.def.progress_user = &call;
  world->users++;
  vlResult done;
  bool fine = long_call_run(&call, &film->busy, run_render, &r, &done);
  long_call_end(&call);
  world->users--;
  if (!fine)
    return NULL;
  if (done != VL_OK && done != VL_CANCELLED)
    return raise_result(done, &r.error);
  const vlRenderStats s = r.stats;
  return Py_BuildValue("(KKII)", (unsigned long long)s.not_finite,
                       (unsigned long long)s.own_numbers, s.worst_x, s.worst_y);
}

typedef struct Choosing {
  const vlWorld *world;
  const vlCamera *camera;
  vlFilmDef film;
  vlRenderDef def;
  vlTracerChoice choice;
  vlError error;
} Choosing;
static vlResult run_choice(void *user) {
  Choosing *c = user;
  return vl_choose_tracer(c->world, c->camera, &c->film, &c->def, true, &c->choice, &c->error);
}

static PyObject *trial_list(const vlKindFamily *tracers, const vlTracerChoice *choice) {
  PyObject *list = PyList_New(0);
  for (uint32_t i = 0; list && i < choice->count; i++) {
    const vlTracerTrial *t = &choice->trials[i];
    PyObject *trial =
        Py_BuildValue("{s:s,s:I,s:d,s:d,s:d,s:d,s:d}", "tracer", tracers->rows[t->tracer]->name,
                      "light_paths", t->light_paths, "error", t->error, "tail", t->tail,
                      "missing", t->missing, "cost", t->cost, "work", t->work);
    if (!trial || PyList_Append(list, trial) < 0)
      Py_CLEAR(list);
    Py_XDECREF(trial);
  }
  return list;
}

/* choose_tracer(world, camera, settings, spp): ({"tracer": name, "light_paths": number},
 * [trials]) */
static PyObject *choose_tracer(PyObject *module, PyObject *arguments) {
  (void)module;
  World *world;
  Camera *camera;
  Settings *settings;
  PyObject *number;
  uint32_t spp;
  if (!PyArg_ParseTuple(arguments, "O!O!O!O:choose_tracer", base_types[TYPE_WORLD], &world,
                        base_types[TYPE_CAMERA], &camera, base_types[TYPE_SETTINGS], &settings,
                        &number) ||
      !read_count(number, "spp", 1, UINT32_MAX, &spp))
    return NULL;
  if (!world->world)
    return raise_usage("the world is closed");
  LongCall call;
  if (!long_call_begin(&call, world->context, Py_None))
    return NULL;
  call.own[0] = own_of_camera(&camera->camera);
  call.own[1] = own_of_sampler(&settings->defs.render);
  Choosing c = {.world = world->world,
                .camera = &camera->camera,
                .film = settings->defs.film,
                .def = settings->defs.render};
  c.def.spp = spp;
  c.def.cancel = call.cancel;
  bool busy = false;
  world->users++;
  vlResult done;
  bool fine = long_call_run(&call, &busy, run_choice, &c, &done);
  long_call_end(&call);
  world->users--;
  if (!fine)
    return NULL;
  if (done != VL_OK)
    return raise_result(done, &c.error);
  const vlKindFamily *tracers = vl_kind_family_find("tracers");
  return Py_BuildValue("{s:s,s:I},N", "tracer", tracers->rows[c.choice.tracer]->name,
                       "light_paths", c.choice.light_paths, trial_list(tracers, &c.choice));
}

typedef struct Truth {
  const vlWorld *world;
  const vlCamera *camera;
  vlChannelsDef def;
  vlImage *floats, *ids;
  vlError error;
} Truth;
static vlResult run_channels(void *user) {
  Truth *t = user;
  return vl_render_channels(t->world, t->camera, &t->def, &t->floats, &t->ids, &t->error);
}

/* A camera of the flow channels, or None. */
static bool other_camera(PyObject *object, const char *what, const vlCamera **camera) {
  if (object == Py_None)
    return true;
  if (!is_object(object, TYPE_CAMERA)) {
    raise_value(what, object, "a velo.Camera, or None");
    return false;
  }
  *camera = &((Camera *)object)->camera;
  return true;
}

/* channels(world, camera, film or None, settings, [names], keywords, forward or None, backward
 * or None, poll or None): (image of floats or None, image of ids or None). */
static PyObject *channels(PyObject *module, PyObject *arguments) {
  (void)module;
  World *world;
  Camera *camera;
  Settings *settings;
  PyObject *film, *names, *keywords, *forward, *backward, *poll;
  if (!PyArg_ParseTuple(arguments, "O!O!OO!O!O!OOO:channels", base_types[TYPE_WORLD], &world,
                        base_types[TYPE_CAMERA], &camera, &film, base_types[TYPE_SETTINGS],
                        &settings, &PyList_Type, &names, &PyDict_Type, &keywords, &forward,
                        &backward, &poll))
    return NULL;
  if (!world->world)
    return raise_usage("the world is closed");
  Truth t = {
      .world = world->world,
      .camera = &camera->camera,
      .def = vl_default_channels_def(settings->defs.film.width, settings->defs.film.height)};
  vlChannelsDef *def = &t.def;
  memcpy(def->crop, settings->defs.film.crop, sizeof def->crop);
  def->space = settings->defs.film.space;
  def->render = &settings->defs.render;
  def->exposure = settings->defs.develop.exposure;
  def->channels = 0;
  const char *known[VL_CHANNEL_COUNT + 1] = {0};
  for (uint32_t i = 0; i < VL_CHANNEL_COUNT; i++)
    known[i] = vl_channel_name(i);
  for (Py_ssize_t i = 0; i < PyList_Size(names); i++) {
    int channel = find_choice(known, "channel", PyList_GetItem(names, i));
    if (channel < 0)
      return NULL;
    def->channels |= 1u << channel;
  }
  if (film != Py_None) {
    if (!is_object(film, TYPE_FILM) || !((Film *)film)->film)
      return raise_value("film", film, "a velo.Film that is not closed");
    def->film = ((Film *)film)->film;
    def->samples = vl_film_spp(def->film);
  }
  if (!other_camera(forward, "forward", &def->forward) ||
      !other_camera(backward, "backward", &def->backward))
    return NULL;
  const uint64_t width = def->crop[2] - def->crop[0], height = def->crop[3] - def->crop[1];
  if (!check_memory(world->context, 16 * width * height * (uint64_t)PyList_Size(names),
                    "ground truth"))
    return NULL;
  const Target target = {(char *)def, settings->keep, NULL, false};
  if (!set_parameters(&target, VL_SETTING_CHANNELS, "keyword of channels", keywords))
    return NULL;
  LongCall call;
  if (!long_call_begin(&call, world->context, Py_None))
    return NULL;
  if (!long_call_poll(&call, poll)) {
    long_call_end(&call);
    return NULL;
  }
  def->cancel = call.cancel;
  call.own[0] = own_of_camera(&camera->camera);
  call.own[1] = own_of_sampler(def->render);
  call.own[2] = own_of_camera(def->forward);
  call.own[3] = own_of_camera(def->backward);
  world->users++;
  vlResult done;
  bool fine = long_call_run(&call, film == Py_None ? NULL : &((Film *)film)->busy, run_channels,
                            &t, &done);
  long_call_end(&call);
  world->users--;
  if (!fine)
    return NULL;
  if (done != VL_OK)
    return raise_result(done, &t.error);
  vlImage *floats = t.floats, *ids = t.ids;
  PyObject *images[2] = {Py_None, Py_None};
  if (floats && !(images[0] = image_object(world->context, floats))) {
    vl_image_destroy(ids);
    return NULL;
  }
  if (ids && !(images[1] = image_object(world->context, ids)))
    return NULL;
  PyObject *result = PyTuple_Pack(2, images[0], images[1]);
  if (floats)
    Py_DECREF(images[0]);
  if (ids)
    Py_DECREF(images[1]);
  return result;
}

static PyObject *box_object(const vlIdBox *b) {
  PyObject *outline = Py_None, *space = Py_None;
  if (b->has_outline)
    outline =
        Py_BuildValue("(dddd)", b->outline[0], b->outline[1], b->outline[2], b->outline[3]);
  if (b->has_space) {
    PyObject *matrix = PyTuple_New(16);
    for (int i = 0; matrix && i < 16; i++)
      PyTuple_SetItem(matrix, i, PyFloat_FromDouble(b->world_from_box[i]));
    space = Py_BuildValue("{s:(ddd),s:(ddd),s:N}", "low", b->low[0], b->low[1], b->low[2],
                          "high", b->high[0], b->high[1], b->high[2], "world_from_box", matrix);
  }
  if (outline == Py_None)
    Py_INCREF(Py_None);
  if (space == Py_None)
    Py_INCREF(Py_None);
  return Py_BuildValue("{s:K,s:K,s:(IIII),s:(IIII),s:N,s:N}", "seen",
                       (unsigned long long)b->seen, "all", (unsigned long long)b->all,
                       "seen_box", b->seen_box[0], b->seen_box[1], b->seen_box[2],
                       b->seen_box[3], "all_box", b->all_box[0], b->all_box[1], b->all_box[2],
                       b->all_box[3], "outline", outline, "space", space);
}

static PyObject *box_list(const vlIdBox *boxes, uint32_t count) {
  PyObject *list = PyList_New(0);
  for (uint32_t i = 0; list && i < count; i++) {
    PyObject *box = box_object(&boxes[i]);
    if (!box || PyList_Append(list, box) < 0)
      Py_CLEAR(list);
    Py_XDECREF(box);
  }
  return list;
}

typedef struct Boxing {
  const vlWorld *world;
  const vlCamera *camera;
  vlBoxesDef def;
  vlIdBox *objects, *instances;
  vlError error;
} Boxing;
static vlResult run_boxes(void *user) {
  Boxing *b = user;
  return vl_world_boxes(b->world, b->camera, &b->def, b->objects, b->instances, &b->error);
}

/* boxes(world, camera, settings): (list of objects' boxes, list of instances' boxes), that of
 * id 1 first. */
static PyObject *boxes(PyObject *module, PyObject *arguments) {
  (void)module;
  World *world;
  Camera *camera;
  Settings *settings;
  if (!PyArg_ParseTuple(arguments, "O!O!O!:boxes", base_types[TYPE_WORLD], &world,
                        base_types[TYPE_CAMERA], &camera, base_types[TYPE_SETTINGS], &settings))
    return NULL;
  if (!world->world)
    return raise_usage("the world is closed");
  uint32_t objects = vl_world_id_count(world->world, VL_ID_OBJECT),
           instances = vl_world_id_count(world->world, VL_ID_INSTANCE);
  vlIdBox *list = PyMem_Malloc(((size_t)objects + instances + 1) * sizeof *list);
  if (!list)
    return PyErr_NoMemory();
  Boxing b = {
      .world = world->world,
      .camera = &camera->camera,
      .def = vl_default_boxes_def(settings->defs.film.width, settings->defs.film.height),
      .objects = list,
      .instances = list + objects};
  memcpy(b.def.crop, settings->defs.film.crop, sizeof b.def.crop);
  const uint64_t pixels =
      (uint64_t)(b.def.crop[2] - b.def.crop[0]) * (b.def.crop[3] - b.def.crop[1]);
  if (!check_memory(world->context, 8 * pixels, "boxes")) {
    PyMem_Free(list);
    return NULL;
  }
  LongCall call;
  if (!long_call_begin(&call, world->context, Py_None)) {
    PyMem_Free(list);
    return NULL;
  }
  b.def.cancel = call.cancel;
  call.own[0] = own_of_camera(&camera->camera);
  world->users++;
  vlResult done;
  bool fine = long_call_run(&call, NULL, run_boxes, &b, &done);
  long_call_end(&call);
  world->users--;
  PyObject *result = NULL;
  if (fine && done == VL_OK)
    result =
        Py_BuildValue("(NN)", box_list(list, objects), box_list(list + objects, instances));
  else if (fine)
    raise_result(done, &b.error);
  PyMem_Free(list);
  return result;
}

static PyObject *autofocus(PyObject *module, PyObject *arguments) {
  (void)module;
  World *world;
  Camera *camera;
  PyObject *point[2];
  double x, y, distance = 0;
  if (!PyArg_ParseTuple(arguments, "O!O!OO:autofocus", base_types[TYPE_WORLD], &world,
                        base_types[TYPE_CAMERA], &camera, &point[0], &point[1]) ||
      !read_finite(point[0], "x", &x) || !read_finite(point[1], "y", &y))
    return NULL;
  if (!world->world)
    return raise_usage("the world is closed");
  Call call;
  if (!call_begin(&call, world->context, NULL))
    return NULL;
  vlError error = {0};
  vlResult done = vl_autofocus(world->world, &camera->camera, x, y, &distance, &error);
  call_end(&call);
  if (!own_check(own_of_camera(&camera->camera)))
    return NULL;
  return done == VL_OK ? PyFloat_FromDouble(distance) : raise_result(done, &error);
}

/* image_describe([images], camera, settings, scene's file or None, samples, time or None, mode
 * of the channels or None, denoiser or None): sets the header attributes of the first image. */
static PyObject *image_describe(PyObject *module, PyObject *arguments) {
  (void)module;
  PyObject *images, *file, *time, *texts[2];
  Camera *camera;
  Settings *settings;
  vlHeaderDef def = vl_default_header_def();
  static const char *const names[2] = {"velo.channels", "velo.denoiser"};
  if (!PyArg_ParseTuple(arguments, "O!O!O!OIOOO:image_describe", &PyList_Type, &images,
                        base_types[TYPE_CAMERA], &camera, base_types[TYPE_SETTINGS], &settings,
                        &file, &def.samples, &time, &texts[0], &texts[1]))
    return NULL;
  vlSceneDefs defs = settings->defs;
  defs.camera = camera->def; /* not the scene's: another one may have been given */
  def.camera = &camera->camera;
  def.defs = &defs;
  if (time != Py_None && (def.time = PyFloat_AsDouble(time)) == -1.0 && PyErr_Occurred())
    return NULL;
  if (file != Py_None && !(def.scene = PyUnicode_AsUTF8AndSize(file, NULL)))
    return NULL;
  vlImage *first = NULL;
  vlResult result = VL_OK;
  for (Py_ssize_t i = 0; i < PyList_Size(images) && result == VL_OK; i++) {
    PyObject *item = PyList_GetItem(images, i);
    if (!is_object(item, TYPE_IMAGE) || !((Image *)item)->image)
      return raise_usage("expected an Image");
    if (first)
      result = vl_image_add_attributes(first, ((Image *)item)->image);
    else
      result = vl_image_set_header(first = ((Image *)item)->image, &def);
  }
  for (int i = 0; i < 2 && first && result == VL_OK; i++) {
    vlAttribute text = {.name = names[i], .type = VL_ATTRIBUTE_STRING};
    if (texts[i] == Py_None)
      continue;
    if (!(text.string = PyUnicode_AsUTF8AndSize(texts[i], NULL)))
      return NULL;
    result = vl_image_set_attribute(first, &text);
  }
  if (result != VL_OK)
    return raise_result(result, NULL);
  Py_RETURN_NONE;
}

PyMethodDef render_functions[] = {
    {"image_describe", image_describe, METH_VARARGS, "Sets an image's header attributes."},
    {"scene_settings", scene_settings, METH_O, "A copy of a scene's settings."},
    {"render", render, METH_VARARGS, "Adds samples to a film."},
    {"choose_tracer", choose_tracer, METH_VARARGS, "The race of the tracers."},
    {"channels", channels, METH_VARARGS, "Ground truth."},
    {"boxes", boxes, METH_VARARGS, "Bounding boxes of objects and instances."},
    {"autofocus", autofocus, METH_VARARGS, "The focus distance for a pixel."},
    {NULL, NULL, 0, NULL},
};
