/* _velo/scene_add.c: adds textures, materials, media, emissions, lights, shapes, groups and
 * instances to a scene. */
#include <math.h>
#include <string.h>

#include "adding.h"

/* The numbers of an array, which live until the call ends; null with an exception. */
static const Numbers *read_array(Adding *a, PyObject *value, char type, const char *what) {
  if (a->array_count == MAX_ARRAYS) {
    raise_usage("too many arrays");
    return NULL;
  }
  Numbers *n = &a->arrays[a->array_count];
  if (!numbers_read(value, type, what, n))
    return NULL;
  a->array_count++;
  return n;
}

vlSceneFamily scene_family(Family family) {
  static const vlSceneFamily families[] = {
      [TEXTURES] = VL_SCENE_TEXTURES, [MATERIALS] = VL_SCENE_MATERIALS,
      [MEDIA] = VL_SCENE_MEDIA,       [EMISSION] = VL_SCENE_EMISSIONS,
      [LIGHTS] = VL_SCENE_LIGHTS,     [SHAPES] = VL_SCENE_SHAPES,
      [GROUPS] = VL_SCENE_GROUPS,     [INSTANCES] = VL_SCENE_INSTANCES};
  return families[family];
}

bool handle_is_valid(const Handle *h) {
  static const char *const things[] = {"texture", "material", "medium", "emission",
                                       "light",   "shape",    "group",  "instance"};
  int family = 0;
  while (strcmp(family_names[family], h->family) != 0)
    family++;
  const vlSceneFamily f = scene_family((Family)family);
  if (vl_scene_has(h->scene->scene, f, h->index) &&
      vl_scene_serial(h->scene->scene, f, h->index) == h->serial)
    return true;
  raise_usage("the %s was removed", things[family]);
  return false;
}

bool read_handle(const Scene *scene, PyObject *value, const char *family, const char *what,
                 uint32_t *index) {
  *index = 0;
  if (value == Py_None)
    return true;
  const Handle *h = (const Handle *)value;
  if (!is_object(value, TYPE_HANDLE) || strcmp(h->family, family) != 0) {
    raise_value(what, value, "one of the scene's %s", family);
    return false;
  }
  if (h->scene != scene) {
    raise_usage("%s is part of another scene", what);
    return false;
  }
  *index = h->index;
  return handle_is_valid(h);
}
static bool handle(const Adding *a, PyObject *value, const char *family, const char *what,
                   uint32_t *index) {
  return read_handle(a->scene, value, family, what, index);
}

static bool image_of(PyObject *value, const char *what, const vlImage **image) {
  if (!is_object(value, TYPE_IMAGE) || !((Image *)value)->image) {
    raise_value(what, value, "a velo.Image that is not closed");
    return false;
  }
  *image = ((Image *)value)->image;
  return true;
}

#define IS(text) (strcmp(name, text) == 0)
static const char *const spaces[] = {"srgb", "dci_p3", "rec2020", "aces2065_1", NULL};
static const char *const wraps[] = {"repeat", "black", "clamp", "octahedral", "mirror", NULL};
static const char *const encodings[] = {"linear", "srgb", "gamma", NULL};

static bool choice(const char *const *choices, const char *what, PyObject *value, int *result) {
  *result = find_choice(choices, what, value);
  return *result >= 0;
}

/* Each of these sets a keyword that has no row. 1: set; 0: unknown; -1: an exception. */

static int set_name(Adding *a, PyObject *value, const char **name) {
  *name = value == Py_None ? NULL : keep_text(a->keep, value, "name");
  return *name || value == Py_None ? 1 : -1;
}

/* A copy of the value's bytes. An int would be a number of zeros, a list is one by one: both
 * are refused. */
static bool bytes_of(const Adding *a, PyObject *value, const char *name, const void **data,
                     size_t *size) {
  PyObject *bytes = PyObject_CheckBuffer(value) ? PyBytes_FromObject(value) : NULL;
  if (!bytes)
    return raise_value(name, value, "bytes") != NULL;
  bool fine = keep_object(a->keep, bytes);
  if (fine) {
    *data = PyBytes_AsString(bytes);
    *size = (size_t)PyBytes_Size(bytes);
  }
  Py_DECREF(bytes);
  return fine;
}

static int set_texture(Adding *a, vlTextureDef *d, const char *name, PyObject *value) {
  int code;
  bool fine;
  if (IS("name")) {
    fine = set_name(a, value, &d->name) > 0;
  } else if (IS("image")) {
    fine = image_of(value, name, &d->image);
  } else if (IS("data")) {
    fine = bytes_of(a, value, name, &d->data, &d->data_size);
  } else if (IS("tint")) {
    fine = floats_copy(value, name, 4, d->tint);
  } else if (IS("channel")) {
    double channel; /* -1: the mean of the colours */
    fine = read_finite(value, name, &channel);
    if (fine && (channel != floor(channel) || channel < -1 || channel > 3))
      fine = raise_value(name, value, "a whole number from -1 to 3") != NULL;
    if (fine)
      d->channel = (int)channel;
  } else if (IS("texture_from_world")) {
    fine = numbers_copy(value, name, 16, d->texture_from_world);
  } else if (IS("st_from_uv")) {
    d->st_from_uv_given = true;
    fine = floats_copy(value, name, 6, d->st_from_uv);
  } else if (IS("encoding")) {
    fine = choice(encodings, name, value, &code);
    d->encoding_given = fine;
    if (fine)
      d->encoding = (vlEncoding)code;
  } else if (IS("wrap_t")) {
    fine = choice(wraps, name, value, &code);
    d->wrap_t_given = fine;
    if (fine)
      d->wrap_t = (vlWrap)code;
  } else if (IS("space")) {
    fine = choice(spaces, name, value, &code);
    if (fine)
      d->space = (vlColorSpace)code;
  } else if (IS("spectrum")) {
    fine = true; /* read before */
  } else {
    return 0;
  }
  return fine ? 1 : -1;
}

static int set_material(Adding *a, vlMaterialDef *d, const char *name, PyObject *value) {
  if (IS("name"))
    return set_name(a, value, &d->name);
  if (IS("reflectance") &&
      (d->kind == VL_MATERIAL_CONDUCTOR || d->kind == VL_MATERIAL_COATED_CONDUCTOR)) {
    d->use_reflectance = true;
    return 0;
  }
  if (IS("reflectance") && d->kind == VL_MATERIAL_SUBSURFACE)
    d->subsurface.from_reflectance = true;
  if (IS("reflectance") && d->kind == VL_MATERIAL_HAIR)
    d->hair.color = VL_HAIR_REFLECTANCE;
  if (IS("sigma_a") && d->kind == VL_MATERIAL_HAIR)
    d->hair.color = VL_HAIR_SIGMA_A;
  if (IS("materials")) {
    if (sequence_size(value, name, 2, 2) < 0)
      return -1;
    for (int i = 0; i < 2; i++) {
      PyObject *item = PySequence_GetItem(value, i);
      bool fine = item && handle(a, item, "materials", name, &d->materials[i].index);
      Py_XDECREF(item);
      if (!fine)
        return -1;
    }
    return 1;
  }
  return 0;
}

static int set_medium(Adding *a, vlMediumDef *d, const char *name, PyObject *value) {
  static const struct {
    const char *name;
    size_t offset;
    size_t per;
  } grids[] = {{"density", offsetof(vlMediumDef, density), 1},
               {"emission_scales", offsetof(vlMediumDef, emission_scales), 1},
               {"temperature", offsetof(vlMediumDef, temperature), 1},
               {"rgb_a", offsetof(vlMediumDef, rgb_a), 3},
               {"rgb_s", offsetof(vlMediumDef, rgb_s), 3},
               {"rgb_emission", offsetof(vlMediumDef, rgb_emission), 3}};
  const bool grid = d->kind == VL_MEDIUM_GRID || d->kind == VL_MEDIUM_RGB_GRID;
  if (grid && (IS("nx") || IS("ny") || IS("nz"))) {
    raise_usage("%s: the size of a grid is that of its arrays", name);
    return -1;
  }
  if (IS("name"))
    return set_name(a, value, &d->name);
  if (IS("transform") || IS("pose") || IS("world_from_medium"))
    return numbers_copy(value, name, 16, d->world_from_medium) ? 1 : -1;
  for (size_t i = 0; i < sizeof grids / sizeof *grids; i++) {
    if (!IS(grids[i].name) || !grid)
      continue;
    const Numbers *n = read_array(a, value, 'f', name);
    if (!n)
      return -1;
    if (n->dimensions != (grids[i].per == 3 ? 4 : 3) ||
        (grids[i].per == 3 && n->shape[3] != 3)) {
      raise_usage("%s: an array of nz x ny x nx%s", name, grids[i].per == 3 ? " x 3" : "");
      return -1;
    }
    bool others = false;
    for (size_t k = 0; k < sizeof grids / sizeof *grids; k++)
      others = others || (k != i && *(void *const *)(void *)((char *)d + grids[k].offset));
    if (others && (d->nx != n->shape[2] || d->ny != n->shape[1] || d->nz != n->shape[0])) {
      raise_usage("%s: the grids differ in size", name);
      return -1;
    }
    d->nz = (uint32_t)n->shape[0];
    d->ny = (uint32_t)n->shape[1];
    d->nx = (uint32_t)n->shape[2];
    memcpy((char *)d + grids[i].offset, &n->data, sizeof n->data);
    return 1;
  }
  return 0;
}

static int set_light(Adding *a, vlLightDef *d, const char *name, PyObject *value) {
  int code;
  if (IS("image"))
    return image_of(value, name, &d->image) ? 1 : -1;
  if (IS("lamp_data"))
    return bytes_of(a, value, name, &d->lamp_data, &d->lamp_size) ? 1 : -1;
  if (IS("transform") || IS("pose") || IS("world_from_light"))
    return numbers_copy(value, name, 16, d->world_from_light) ? 1 : -1;
  if (IS("medium"))
    return handle(a, value, "media", name, &d->medium.index) ? 1 : -1;
  if (IS("portal")) {
    d->has_portal = true;
    return floats_copy(value, name, 12, &d->portal[0][0]) ? 1 : -1;
  }
  if (IS("space")) {
    if (!choice(spaces, name, value, &code))
      return -1;
    d->space = (vlColorSpace)code;
    return 1;
  }
  return 0;
}

enum { POSITIONS, NORMALS, RADII = 12, WIDTHS };
const ShapeArray shape_arrays[SHAPE_ARRAYS] = {
    {"positions", 'f', offsetof(vlShapeDef, positions), 3},
    {"normals", 'f', offsetof(vlShapeDef, normals), 3},
    {"tangents", 'f', offsetof(vlShapeDef, tangents), 3},
    {"uvs", 'f', offsetof(vlShapeDef, uvs), 2},
    {"tangent_signs", 'f', offsetof(vlShapeDef, tangent_signs), 1},
    {"colors", 'f', offsetof(vlShapeDef, colors), 4},
    {"positions_close", 'f', offsetof(vlShapeDef, positions_close), 3},
    {"normals_close", 'f', offsetof(vlShapeDef, normals_close), 3},
    {"uvs_1", 'f', offsetof(vlShapeDef, more_uvs[0]), 2},
    {"uvs_2", 'f', offsetof(vlShapeDef, more_uvs[1]), 2},
    {"uvs_3", 'f', offsetof(vlShapeDef, more_uvs[2]), 2},
    {"centers", 'd', offsetof(vlShapeDef, centers), 3},
    {"radii", 'f', offsetof(vlShapeDef, radii), 1},
    {"widths", 'f', offsetof(vlShapeDef, widths), 2}};

const void *shape_array(const vlShapeDef *d, int array) {
  const void *at;
  memcpy(&at, (const char *)d + shape_arrays[array].offset, sizeof at);
  return at;
}

static void put_shape_array(vlShapeDef *d, int array, const void *at) {
  memcpy((char *)d + shape_arrays[array].offset, &at, sizeof at);
}

size_t shape_elements(const vlShapeDef *d, int array) {
  if (array >= RADII - 1) /* centers, radii, widths */
    return d->faces;
  return array == NORMALS && d->kind == VL_SHAPE_CURVES ? 2 * (size_t)d->faces : d->vertices;
}

/* An array of a shape; None takes one away that a shape which is changed can do without. */
static int set_shape_array(Adding *a, vlShapeDef *d, int array, PyObject *value) {
  const ShapeArray *row = &shape_arrays[array];
  if (value == Py_None && a->old && array != POSITIONS) {
    put_shape_array(d, array, NULL);
    return 1;
  }
  const Numbers *n = read_array(a, value, row->type, row->name);
  if (!n)
    return -1;
  if (n->count == 0 || n->count % row->per || n->count / row->per > 0x7fffffff) {
    raise_usage("%s: %zu numbers per element, it has %zu", row->name, row->per, n->count);
    return -1;
  }
  put_shape_array(d, array, n->data);
  const uint32_t count = (uint32_t)(n->count / row->per);
  a->given[array] = count;
  if (array == POSITIONS)
    d->vertices = count;
  if (array == POSITIONS && d->kind == VL_SHAPE_CURVES)
    d->faces = count / 4;
  if (array == RADII - 1)
    d->faces = count;
  return 1;
}

static int set_shape(Adding *a, vlShapeDef *d, const char *name, PyObject *value) {
  if (IS("name"))
    return set_name(a, value, &d->label.name);
  if (IS("transform") || IS("pose") || IS("group_from_shape"))
    return numbers_copy(value, name, 16, d->group_from_shape) ? 1 : -1;
  if (IS("material"))
    return handle(a, value, "materials", name, &d->material.index) ? 1 : -1;
  if (IS("emission"))
    return handle(a, value, "emission", name, &d->emission.index) ? 1 : -1;
  if (IS("group"))
    return handle(a, value, "groups", name, &d->group.index) ? 1 : -1;
  if (IS("inside"))
    return handle(a, value, "media", name, &d->inside.index) ? 1 : -1;
  if (IS("outside"))
    return handle(a, value, "media", name, &d->outside.index) ? 1 : -1;
  if (IS("times"))
    return numbers_copy(value, name, 2, d->times) ? 1 : -1;
  if (IS("reverse_orientation"))
    return read_flag(value, name, &d->reverse_orientation) ? 1 : -1;
  if (IS("backdrop"))
    return read_flag(value, name, &d->backdrop) ? 1 : -1;
  if (IS("hidden_from_camera"))
    return read_flag(value, name, &d->hidden_from_camera) ? 1 : -1;
  if (IS("indices")) {
    const Numbers *n = read_array(a, value, 'I', name);
    size_t per = d->kind == VL_SHAPE_BILINEAR ? 4 : 3;
    if (!n)
      return -1;
    if (n->count % per || n->count / per > 0x7fffffff) {
      raise_usage("indices: %zu numbers per face", per);
      return -1;
    }
    d->faces = (uint32_t)(n->count / per);
    d->indices = n->data;
    return 1;
  }
  for (int i = 0; i < SHAPE_ARRAYS; i++)
    if (IS(shape_arrays[i].name))
      return set_shape_array(a, d, i, value);
  return 0;
}

/* Arrays must be as long as the others: the library reads as many numbers as there are
 * vertices. */
static bool check_lengths(const Adding *a, const vlShapeDef *d) {
  for (int i = 0; i < SHAPE_ARRAYS; i++) {
    const size_t wanted = shape_elements(d, i);
    const bool kept = a->old && !a->given[i];
    const size_t got = kept ? shape_elements(a->old, i) : a->given[i];
    if (!shape_array(d, i) || got == wanted)
      continue;
    if (kept)
      raise_usage("%s: it has %zu elements, %zu are needed now: give it, too, or None",
                  shape_arrays[i].name, got, wanted);
    else
      raise_usage("%s: %zu elements are needed, it has %zu", shape_arrays[i].name, wanted, got);
    return false;
  }
  const bool more = d->more_uvs[0] || d->more_uvs[1] || d->more_uvs[2];
  if (!more || !a->old || d->vertices == a->old->vertices)
    return true;
  raise_usage("positions: a mesh with several sets of uvs keeps its number of %u vertices",
              (unsigned)a->old->vertices);
  return false;
}

/* ---- adding ------------------------------------------------------------------------------ */

const char *const family_names[] = {"textures", "materials", "media",     "emission", "lights",
                                    "shapes",   "groups",    "instances", NULL};

void default_def(Family family, int kind, bool spectrum, Def *def) {
  switch (family) {
    case TEXTURES:
      def->texture = vl_default_texture_def((vlTextureKind)kind, spectrum);
      break;
    case MATERIALS:
      def->material = vl_default_material_def((vlMaterialKind)kind);
      break;
    case MEDIA:
      def->medium = vl_default_medium_def((vlMediumKind)kind);
      break;
    case EMISSION:
      def->emission = vl_default_emission_def();
      break;
    case LIGHTS:
      def->light = vl_default_light_def((vlLightKind)kind);
      break;
    case SHAPES:
      def->shape = vl_default_shape_def((vlShapeKind)kind);
      break;
    case GROUPS:
    case INSTANCES:
      break;
  }
}

static int set_extra(Adding *a, Family family, Def *def, const char *name, PyObject *value) {
  switch (family) {
    case TEXTURES:
      return set_texture(a, &def->texture, name, value);
    case MATERIALS:
      return set_material(a, &def->material, name, value);
    case MEDIA:
      return set_medium(a, &def->medium, name, value);
    case LIGHTS:
      return set_light(a, &def->light, name, value);
    case SHAPES:
      return set_shape(a, &def->shape, name, value);
    case EMISSION:
    case GROUPS:
    case INSTANCES:
      break;
  }
  return 0;
}

/* An object takes the place of one that was removed. Index 0: it failed; the error is in the
 * scene, or in *error. */
static uint32_t add(vlScene *scene, Family family, const Def *def, vlError *error) {
  const uint32_t removed = vl_scene_removed(scene, scene_family(family), def);
  if (removed)
    return put_def(scene, family, removed, def, error) == VL_OK ? removed : 0;
  switch (family) {
    case TEXTURES:
      return vl_scene_add_texture(scene, &def->texture).index;
    case MATERIALS:
      return vl_scene_add_material(scene, &def->material).index;
    case MEDIA:
      return vl_scene_add_medium(scene, &def->medium).index;
    case EMISSION:
      return vl_scene_add_emission(scene, &def->emission).index;
    case LIGHTS:
      return vl_scene_add_light(scene, &def->light).index;
    case SHAPES:
      return vl_scene_add_shape(scene, &def->shape).index;
    case GROUPS:
    case INSTANCES:
      break;
  }
  return 0;
}

/* As add, of a group. */
static uint32_t add_named_group(vlScene *scene, const char *name, vlError *error) {
  const vlGroupId removed = {vl_scene_removed(scene, VL_SCENE_GROUPS, NULL)};
  if (!removed.index)
    return vl_scene_add_group(scene, name).index;
  return vl_scene_set_group(scene, removed, name, error) == VL_OK ? removed.index : 0;
}

/* Names for "from", which Python reserves. */
static bool is_from(const char *name) {
  return strcmp(name, "from_") == 0 || strcmp(name, "position") == 0;
}

/* The keywords of a family besides its rows, for messages. */
static bool append_extra(PyObject *names, Family family, const vlKindRow *row) {
  static const char *const texture[] = {"name",  "image",    "range",      "data",
                                        "tint",  "channel",  "encoding",   "wrap_t",
                                        "space", "spectrum", "st_from_uv", NULL};
  static const char *const material[] = {"name", "materials", NULL};
  static const char *const medium[] = {"name", "pose", "transform", "density", NULL};
  static const char *const light[] = {"pose",      "transform", "medium", "image",
                                      "lamp_data", "portal",    NULL};
  static const char *const position[] = {"position", "from_", NULL};
  static const char *const shape[] = {
      "name",     "pose",     "transform", "material",
      "emission", "group",    "inside",    "outside",
      "times",    "indices",  "positions", "normals",
      "uvs",      "tangents", "colors",    "radii",
      "centers",  "widths",   "backdrop",  "reverse_orientation",
      "uvs_1",    "uvs_2",    "uvs_3",     "hidden_from_camera",
      NULL};
  const char *const *const lists[] = {
      [TEXTURES] = texture, [MATERIALS] = material, [MEDIA] = medium,
      [LIGHTS] = light,     [SHAPES] = shape,       [INSTANCES] = NULL};
  for (const char *const *list = lists[family]; list && *list; list++)
    if (!append_text(names, *list))
      return false;
  const bool from =
      family == LIGHTS && find_parameter(row->parameters, row->parameter_count, "from") != NULL;
  return !from || (append_text(names, position[0]) && append_text(names, position[1]));
}

/* False, with an exception: two keywords name the same member. */
static bool check_doubles(PyObject *keywords) {
  static const char *const pairs[][2] = {
      {"pose", "transform"}, {"position", "from_"}, {"position", "from"}, {"from_", "from"}};
  for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
    if (!PyDict_GetItemString(keywords, pairs[i][0]) ||
        !PyDict_GetItemString(keywords, pairs[i][1]))
      continue;
    raise_usage("%s and %s are the same: give one of them", pairs[i][0], pairs[i][1]);
    return false;
  }
  return true;
}

bool set_all(Adding *a, Family family, const vlKindRow *row, const char *thing,
             PyObject *keywords, bool spectrum, Def *def) {
  const Target target = {(char *)def, a->keep, a->scene, spectrum};
  PyObject *name, *value;
  Py_ssize_t position = 0;
  if (!check_doubles(keywords))
    return false;
  while (PyDict_Next(keywords, &position, &name, &value)) {
    const char *text = keep_text(a->keep, name, "a keyword");
    int extra = text ? set_extra(a, family, def, text, value) : -1;
    if (extra < 0)
      return false;
    if (extra)
      continue;
    const vlParameter *p = find_parameter(row->parameters, row->parameter_count, text);
    vlParameter named; /* messages have the name that was given */
    const vlParameter *from =
        family == LIGHTS && is_from(text)
            ? find_parameter(row->parameters, row->parameter_count, "from")
            : NULL;
    if (from) {
      named = *from;
      named.keyword = text;
      p = &named;
    }
    if (!p && family == TEXTURES && spectrum && strncmp(text, "spectrum_", 9) == 0) {
      char other[32] = "float_";
      if (strlen(text) < 20)
        strcpy(other + 6, text + 9);
      p = find_parameter(row->parameters, row->parameter_count, other);
    }
    if (!p) {
      PyObject *names = PyList_New(0);
      if (names && (!append_names(names, row->parameters, row->parameter_count) ||
                    !append_extra(names, family, row)))
        Py_CLEAR(names);
      char what[96];
      PyOS_snprintf(what, sizeof what, "keyword of this %s", thing);
      return raise_unknown(what, text, names);
    }
    if (!set_parameter(&target, p, value))
      return false;
  }
  return family != SHAPES || check_lengths(a, &def->shape);
}

PyObject *new_handle(Scene *scene, Family family, uint32_t index) {
  Handle *h = make_object(TYPE_HANDLE);
  if (!h)
    return NULL;
  Py_INCREF((PyObject *)scene);
  h->scene = scene;
  h->family = family_names[family];
  h->index = index;
  h->serial = vl_scene_serial(scene->scene, scene_family(family), index);
  return (PyObject *)h;
}

/* Ends a call that has added an object: its handle, or an exception, that of the scene's error
 * if *error has none, after the call was taken back. */
static PyObject *settle(Scene *self, vlSceneCheckpoint *checkpoint, Family family,
                        uint32_t index, vlError *error) {
  if (error->code == VL_OK)
    vl_scene_result(self->scene, error);
  scene_settle(self, checkpoint, index != 0);
  if (index && family == INSTANCES)
    index = vl_scene_fill_instance(self->scene).index;
  return index ? new_handle(self, family, index)
               : raise_result(error->code == VL_OK ? VL_ERROR_ARGUMENT : error->code, error);
}

static PyObject *add_group(Scene *self, PyObject *name) {
  PyObject *keep = PyList_New(0);
  const char *text = !keep || name == Py_None ? NULL : keep_text(keep, name, "name");
  PyObject *result = NULL;
  vlError error = {0};
  vlSceneCheckpoint *checkpoint =
      keep && (text || name == Py_None) ? scene_attempt(self) : NULL;
  if (checkpoint)
    result =
        settle(self, checkpoint, GROUPS, add_named_group(self->scene, text, &error), &error);
  Py_XDECREF(keep);
  return result;
}

PyObject *scene_add(Scene *self, PyObject *arguments) {
  PyObject *family_name, *kind_name, *keywords;
  if (!PyArg_ParseTuple(arguments, "OOO!:_add", &family_name, &kind_name, &PyDict_Type,
                        &keywords) ||
      !scene_open(self))
    return NULL;
  int family = find_choice(family_names, "family", family_name);
  if (family < 0)
    return NULL;
  if (family == GROUPS)
    return add_group(self, kind_name);
  if (family == INSTANCES)
    return raise_usage("instances are added by add_instance");
  const vlKindFamily *kinds = vl_kind_family_find(family_names[family]);
  int kind = find_kind(kinds, kinds->thing, kind_name);
  if (kind < 0)
    return NULL;
  PyObject *wanted = PyDict_GetItemString(keywords, "spectrum");
  bool spectrum = family == TEXTURES && !(kinds->rows[kind]->traits & VL_TEXTURE_FLOAT_ONLY);
  if (family == TEXTURES && wanted && !read_flag(wanted, "spectrum", &spectrum))
    return NULL;
  Def def;
  default_def((Family)family, kind, spectrum, &def);
  Adding a = {.scene = self, .keep = PyList_New(0)};
  PyObject *result = NULL;
  if (a.keep &&
      set_all(&a, (Family)family, kinds->rows[kind], kinds->thing, keywords, spectrum, &def)) {
    vlSceneCheckpoint *checkpoint = scene_attempt(self);
    Call call;
    if (checkpoint && call_begin(&call, self->context, &self->busy)) {
      vlError error = {0};
      uint32_t index = add(self->scene, (Family)family, &def, &error);
      call_end(&call);
      result = settle(self, checkpoint, (Family)family, index, &error);
    } else {
      vl_scene_checkpoint_destroy(checkpoint);
    }
  }
  for (int i = 0; i < a.array_count; i++)
    numbers_release(&a.arrays[i]);
  Py_XDECREF(a.keep);
  return result;
}

/* _add_instance(group, matrices, times or None, name of the matrices): handle */
PyObject *scene_add_instance(Scene *self, PyObject *arguments) {
  PyObject *group, *matrices, *times;
  const char *what;
  if (!PyArg_ParseTuple(arguments, "OOOs:_add_instance", &group, &matrices, &times, &what) ||
      !scene_open(self))
    return NULL;
  vlGroupId id;
  if (!read_handle(self, group, "groups", "group", &id.index))
    return NULL;
  Numbers poses = {0}, seconds = {0};
  bool fine = numbers_read(matrices, 'd', what, &poses) &&
              (times == Py_None || numbers_read(times, 'd', "times", &seconds));
  size_t keys = times == Py_None ? 1 : seconds.count;
  if (fine && (keys == 0 || keys > 65536 || poses.count != 16 * keys))
    fine =
        raise_value(what, matrices,
                    "a matrix of 16 numbers, with times (at most 65536) one for each") != NULL;
  vlSceneCheckpoint *checkpoint = fine ? scene_attempt(self) : NULL;
  vlInstanceId instance = {0};
  if (checkpoint && times == Py_None)
    instance = vl_scene_add_instance(self->scene, id, poses.data, (vlSource){0});
  else if (checkpoint)
    instance = vl_scene_add_moving_instance(self->scene, id, (uint32_t)keys, seconds.data,
                                            poses.data, (vlSource){0});
  numbers_release(&poses);
  numbers_release(&seconds);
  vlError error = {0};
  return checkpoint ? settle(self, checkpoint, INSTANCES, instance.index, &error) : NULL;
}

/* _load_group(path, name or None, keywords, callback or None): handle, {what: number}. */
PyObject *scene_load_group(Scene *self, PyObject *arguments) {
  PyObject *path, *name, *keywords, *callback, *keep = PyList_New(0), *result = NULL;
  vlLoadedGroup loaded;
  Loading l = {.def = vl_default_load_def(), .loaded = &loaded};
  const Target target = {(char *)&l.def, keep, self, false};
  if (!keep ||
      !PyArg_ParseTuple(arguments, "OOO!O:_load_group", &path, &name, &PyDict_Type, &keywords,
                        &callback) ||
      !scene_open(self) ||
      !set_parameters(&target, VL_SETTING_LOAD, "keyword of load_group", keywords) ||
      !(l.file = keep_path(keep, path, "path")) ||
      (name != Py_None && !(l.name = keep_text(keep, name, "name"))) ||
      !load_file(self, &l, callback))
    goto end;
  PyObject *group = new_handle(self, GROUPS, loaded.group.index);
  if (group)
    result =
        Py_BuildValue("N{s:I,s:I,s:I,s:I,s:(ddd),s:(ddd)}", group, "shapes", loaded.shapes,
                      "first_object", loaded.first_object, "lights", loaded.lights, "emitters",
                      loaded.emitters, "low", loaded.low[0], loaded.low[1], loaded.low[2],
                      "high", loaded.high[0], loaded.high[1], loaded.high[2]);
end:
  Py_XDECREF(keep);
  return result;
}
