/* _velo/camera.c: cameras: keywords, projection of arrays. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "module.h"

/* ---- making ------------------------------------------------------------------------------ */

/* Where a pose is a matrix, eye, lookat and up become its own: they are what get() returns, and
 * what replace(eye=...) starts from. */
static void match_pose(vlCameraDef *def) {
  const double *m = def->world_from_camera;
  if (!def->has_matrix)
    return;
  for (int i = 0; i < 3; i++) {
    def->eye[i] = m[4 * i + 3];
    def->lookat[i] = m[4 * i + 3] + m[4 * i + 2];
    def->up[i] = -m[4 * i + 1];
  }
  def->roll = 0;
}

/* The second pose of a def, which is a matrix where the camera moves. */
static void set_motion(vlCameraDef *def, const vlCamera *made) {
  for (int i = 0; i < 3; i++)
    def->eye_close[i] = def->lookat_close[i] = def->up_close[i] = VL_UNSET;
  def->roll_close = VL_UNSET;
  def->has_matrix_close = made->moves;
  if (!made->moves)
    return;
  memcpy(def->world_from_camera_close, made->world_from_camera_close,
         sizeof def->world_from_camera_close);
  memcpy(def->pose_times, made->pose_times, sizeof def->pose_times);
}

/* Roll beside a matrix becomes a part of the matrix. */
static void take_roll(vlCameraDef *def, const vlCamera *made) {
  if (!def->has_matrix || def->roll == 0)
    return;
  memcpy(def->world_from_camera, made->world_from_camera, sizeof def->world_from_camera);
  set_motion(def, made);
}

static PyObject *camera_wrap(const vlCameraDef *def, const vlCamera *compiled,
                             const char *warning, PyObject *keep) {
  Camera *self = make_object(TYPE_CAMERA);
  if (!self)
    return NULL;
  self->def = *def;
  take_roll(&self->def, compiled);
  match_pose(&self->def);
  self->camera = *compiled;
  Py_XINCREF(keep);
  self->keep = keep;
  self->warning = warning ? PyUnicode_FromString(warning) : (Py_INCREF(Py_None), Py_None);
  return (PyObject *)self;
}

PyObject *camera_object(const vlCameraDef *def, PyObject *keep) {
  vlCamera compiled;
  const char *warning = NULL;
  vlError error = {0};
  vlResult done = vl_camera_make(def, &compiled, &warning, &error);
  if (!own_check(def->own ? def->own->user : NULL))
    return NULL;
  if (done != VL_OK)
    return raise_result(done, &error);
  return camera_wrap(def, &compiled, warning, keep);
}

static void camera_dealloc(Camera *self) {
  Py_XDECREF(self->keep);
  Py_XDECREF(self->warning);
  free_object((PyObject *)self);
}

/* The numbers that give the focal length: some by themselves, others with those of a group. */
typedef enum FocalGroup { FOCAL_ALONE, FOCAL_PLANE, FOCAL_SENSOR, FOCAL_SCREEN } FocalGroup;
static const struct {
  size_t member; /* a double of vlCameraDef */
  FocalGroup group;
  bool alone; /* it needs no other number of the group */
} focal_numbers[] = {
    {offsetof(vlCameraDef, fov), FOCAL_ALONE, true},
    {offsetof(vlCameraDef, fx), FOCAL_ALONE, true},
    {offsetof(vlCameraDef, fy), FOCAL_ALONE, true},
    {offsetof(vlCameraDef, view_distance), FOCAL_PLANE, true},
    {offsetof(vlCameraDef, zoom), FOCAL_PLANE, false},
    {offsetof(vlCameraDef, pixel_size), FOCAL_PLANE, false},
    {offsetof(vlCameraDef, focal_mm), FOCAL_SENSOR, false},
    {offsetof(vlCameraDef, sensor_width_mm), FOCAL_SENSOR, false},
    {offsetof(vlCameraDef, screen_min_x), FOCAL_SCREEN, false},
    {offsetof(vlCameraDef, screen_max_x), FOCAL_SCREEN, false},
    {offsetof(vlCameraDef, screen_min_y), FOCAL_SCREEN, false},
    {offsetof(vlCameraDef, screen_max_y), FOCAL_SCREEN, false},
};
enum { FOCAL_NUMBERS = sizeof focal_numbers / sizeof *focal_numbers };

static double *focal_number(vlCameraDef *def, size_t i) {
  return (double *)((char *)def + focal_numbers[i].member);
}

static void unset_focal(vlCameraDef *def, unsigned kept_groups) {
  for (size_t i = 0; i < FOCAL_NUMBERS; i++)
    if (!(kept_groups >> focal_numbers[i].group & 1))
      *focal_number(def, i) = VL_UNSET;
}

static bool set_k(vlCameraDef *def, PyObject *value) {
  double k[9];
  if (!numbers_copy(value, "K", 9, k))
    return false;
  if (k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    raise_value("K", value, "[fx skew cx; 0 fy cy; 0 0 1]");
    return false;
  }
  def->fx = k[0];
  def->skew = k[1];
  def->cx = k[2];
  def->fy = k[4];
  def->cy = k[5];
  return true;
}

static bool set_coefficients(vlCameraDef *def, PyObject *value) {
  Numbers n;
  if (!numbers_read(value, 'd', "distortion_coefficients", &n))
    return false;
  bool fine = n.count <= 14 && n.dimensions <= 1;
  if (fine) {
    memcpy(def->distortion_coefficients, n.data, n.count * sizeof(double));
    def->distortion_count = (uint32_t)n.count;
  } else {
    raise_value("distortion_coefficients", value, "a list of at most 14 numbers");
  }
  numbers_release(&n);
  return fine;
}

static bool set_shutter(vlCameraDef *def, PyObject *value) {
  Numbers n;
  if (!numbers_read(value, 'd', "shutter", &n))
    return false;
  bool fine = n.dimensions == 2 && n.shape[1] == 2 && n.shape[0] <= VL_SHUTTER_POINTS;
  if (!fine)
    raise_value("shutter", value, "a list of at most %d pairs of time and opening",
                VL_SHUTTER_POINTS);
  const double *pairs = n.data;
  for (size_t i = 0; fine && i < n.shape[0]; i++) {
    def->shutter_at[i] = pairs[2 * i];
    def->shutter_value[i] = pairs[2 * i + 1];
  }
  if (fine)
    def->shutter_points = (uint32_t)n.shape[0];
  numbers_release(&n);
  return fine;
}

/* colmap: (model, parameters) */
static bool set_colmap(vlCameraDef *def, PyObject *keep, PyObject *value) {
  if (sequence_size(value, "colmap", 2, 2) < 0)
    return false;
  PyObject *model = PySequence_GetItem(value, 0),
           *parameters = model ? PySequence_GetItem(value, 1) : NULL;
  Numbers n = {0};
  const char *name = parameters ? keep_text(keep, model, "colmap's model") : NULL;
  bool fine = name && numbers_read(parameters, 'd', "colmap", &n);
  vlError error = {0};
  if (fine) {
    vlResult done = vl_camera_def_colmap(def, name, n.data, (uint32_t)n.count, &error);
    fine = done == VL_OK || raise_result(done, &error) != NULL;
    numbers_release(&n);
  }
  Py_XDECREF(model);
  Py_XDECREF(parameters);
  return fine;
}

/* 1: set; 0: not one of these names; -1: an exception. */
static int set_special(vlCameraDef *def, PyObject *keep, const char *name, PyObject *value) {
  bool fine;
  if (strcmp(name, "K") == 0) {
    fine = set_k(def, value);
  } else if (strcmp(name, "world_from_camera") == 0) {
    def->has_matrix = true;
    fine = numbers_copy(value, name, 16, def->world_from_camera);
  } else if (strcmp(name, "camera_from_world") == 0) {
    vlCameraDef other = vl_default_camera_def(1, 1);
    vlCamera inverse;
    other.has_matrix = def->has_matrix = true;
    fine = numbers_copy(value, name, 16, other.world_from_camera);
    vlError error = {0};
    vlResult done = fine ? vl_camera_make(&other, &inverse, NULL, &error) : VL_OK;
    if (done != VL_OK) {
      raise_result(done, &error);
      return -1;
    }
    if (fine)
      memcpy(def->world_from_camera, inverse.camera_from_world,
             sizeof inverse.camera_from_world);
  } else if (strcmp(name, "world_from_camera_close") == 0) {
    def->has_matrix_close = true;
    fine = numbers_copy(value, name, 16, def->world_from_camera_close);
  } else if (strcmp(name, "own") == 0) {
    Own *own = value == Py_None ? NULL : own_read(value, VL_OWN_CAMERA, name);
    fine = value == Py_None || (own && keep_object(keep, value));
    if (fine)
      def->own = own ? &own->camera : NULL;
  } else if (strcmp(name, "pose_times") == 0) {
    fine = numbers_copy(value, name, 2, def->pose_times);
  } else if (strcmp(name, "focus_pixel") == 0) {
    fine = numbers_copy(value, name, 2, def->lens.focus_pixel);
  } else if (strcmp(name, "shape") == 0) {
    Numbers n;
    fine = numbers_read(value, 'd', name, &n);
    if (fine && (n.count < 1 || n.count > 2))
      fine = raise_value(name, value, "one or two numbers") != NULL;
    for (size_t i = 0; fine && i < n.count; i++)
      def->shape[i] = ((const double *)n.data)[i];
    numbers_release(&n);
  } else if (strcmp(name, "distortion_coefficients") == 0) {
    fine = set_coefficients(def, value);
  } else if (strcmp(name, "shutter") == 0) {
    fine = set_shutter(def, value);
  } else if (strcmp(name, "colmap") == 0) {
    fine = set_colmap(def, keep, value);
  } else {
    return 0;
  }
  return fine ? 1 : -1;
}

static const char *const special_names[] = {"K",
                                            "world_from_camera",
                                            "camera_from_world",
                                            "world_from_camera_close",
                                            "pose_times",
                                            "focus_pixel",
                                            "shape",
                                            "distortion_coefficients",
                                            "shutter",
                                            "colmap",
                                            "own",
                                            NULL};

/* The row of a camera's parameter: of all cameras, or of the def's projection; with `any` also
 * of other projections, as scene files name them, but for the numbers of their shapes: one name
 * is not the same number of each. Null: there is none. */
static const vlParameter *camera_row(const vlCameraDef *def, const char *name, bool any) {
  const vlParameter *row = vl_setting(VL_SETTING_CAMERA, name);
  const vlKindFamily *family = vl_kind_family_find("cameras");
  const vlParameter *projections = vl_setting(VL_SETTING_CAMERA, "projection");
  if (row || !family || !projections)
    return row;
  const char *projection = projections->choices[def->projection];
  for (int own = 1; own >= (any ? 0 : 1); own--)
    for (uint32_t k = 0; k < family->kind_count; k++) {
      if (own && !same_word(family->words[k], projection))
        continue;
      const vlKindRow *kind = family->rows[k];
      row = find_parameter(kind->parameters, kind->parameter_count, name);
      if (row && row->type != VL_PARAMETER_BLOCK &&
          (own || strncmp(row->member, "shape[", 6) != 0))
        return row;
    }
  return NULL;
}

/* Unsets the numbers that the given ones replace. A group stays where they are the part of it
 * that needs the rest. Where an f-number or a tilted lens needs the sensor's width, or one of
 * its two numbers that describes the lens alone, that one stays. False: an exception. */
static bool forget_focal(vlCameraDef *def, PyObject *keep, PyObject *keywords) {
  const vlLensDef *lens = &def->lens;
  PyObject *name;
  Py_ssize_t position = 0;
  bool whole = false;
  unsigned groups = 0;
  while (PyDict_Next(keywords, &position, &name, NULL)) {
    const char *text = keep_text(keep, name, "a keyword");
    if (!text)
      return false;
    const vlParameter *row = camera_row(def, text, true);
    whole = whole || strcmp(text, "K") == 0 || strcmp(text, "colmap") == 0;
    for (size_t i = 0; row && i < FOCAL_NUMBERS; i++)
      if (row->offset == focal_numbers[i].member) {
        whole = whole || focal_numbers[i].alone;
        groups |= 1u << focal_numbers[i].group;
      }
  }
  if (!whole && !groups)
    return true;
  double focal_mm = def->focal_mm;
  double sensor_width_mm = def->sensor_width_mm;
  unset_focal(def, whole ? 0 : groups);
  if (isnan(lens->f_number) && lens->lens_tilt_x == 0 && lens->lens_tilt_y == 0)
    return true;
  def->sensor_width_mm = sensor_width_mm;
  if (isnan(sensor_width_mm))
    def->focal_mm = focal_mm;
  return true;
}

static bool set_keywords(vlCameraDef *def, PyObject *keep, PyObject *keywords) {
  PyObject *name, *value;
  Py_ssize_t position = 0;
  const Target target = {(char *)def, keep, NULL, false};
  PyObject *projection = PyDict_GetItemString(keywords, "projection");
  if (projection &&
      !set_parameter(&target, vl_setting(VL_SETTING_CAMERA, "projection"), projection))
    return false;
  if (!forget_focal(def, keep, keywords))
    return false;
  while (PyDict_Next(keywords, &position, &name, &value)) {
    const char *text = keep_text(keep, name, "a keyword");
    if (!text)
      return false;
    if (strcmp(text, "eye") == 0 || strcmp(text, "lookat") == 0 || strcmp(text, "up") == 0)
      def->has_matrix = false;
    int special = set_special(def, keep, text, value);
    if (special < 0)
      return false;
    if (special)
      continue;
    const vlParameter *row = camera_row(def, text, true);
    if (!row) {
      PyObject *names = PyList_New(0);
      for (int i = 0; names && special_names[i]; i++) {
        PyObject *word = PyUnicode_FromString(special_names[i]);
        if (!word || PyList_Append(names, word) < 0)
          Py_CLEAR(names);
        Py_XDECREF(word);
      }
      if (names && !append_settings(names, VL_SETTING_CAMERA))
        Py_CLEAR(names);
      return raise_unknown("keyword of a camera", text, names);
    }
    vlParameter named = *row; /* messages have the name that was given */
    named.keyword = strncmp(row->member, "shape[", 6) == 0 ? text : row->keyword;
    if (!set_parameter(&target, &named, value))
      return false;
  }
  return true;
}

/* camera_new(width, height, keywords) */
static PyObject *camera_new(PyObject *module, PyObject *arguments) {
  (void)module;
  PyObject *width, *height, *keywords;
  uint32_t size[2];
  if (!PyArg_ParseTuple(arguments, "OOO!:camera_new", &width, &height, &PyDict_Type,
                        &keywords) ||
      !read_size(width, height, MAX_PIXELS, size))
    return NULL;
  vlCameraDef def = vl_default_camera_def(size[0], size[1]);
  PyObject *keep = PyList_New(0);
  PyObject *result =
      keep && set_keywords(&def, keep, keywords) ? camera_object(&def, keep) : NULL;
  Py_XDECREF(keep);
  return result;
}

/* _replace(keywords): this camera with other parameters. */
static PyObject *camera_replace(Camera *self, PyObject *keywords) {
  vlCameraDef def = self->def;
  PyObject *keep = PyList_New(0);
  if (!keep || (self->keep && !keep_object(keep, self->keep)) || !PyDict_Check(keywords)) {
    Py_XDECREF(keep);
    return NULL;
  }
  PyObject *result = set_keywords(&def, keep, keywords) ? camera_object(&def, keep) : NULL;
  /* of an eye of omnidirectional stereo, which no def has */
  if (result && ((Camera *)result)->camera.projection == self->camera.projection)
    ((Camera *)result)->camera.eye_circle = self->camera.eye_circle;
  Py_XDECREF(keep);
  return result;
}

/* ---- changes of the compiled camera ------------------------------------------------------ */

static PyObject *with_compiled(Camera *self, vlResult done, const vlCamera *made,
                               const vlError *error) {
  if (!own_check(own_of_camera(&self->camera)))
    return NULL;
  if (done != VL_OK)
    return raise_result(done, error);
  vlCameraDef def = self->def;
  def.width = made->width;
  def.height = made->height;
  def.has_matrix = true;
  memcpy(def.world_from_camera, made->world_from_camera, sizeof def.world_from_camera);
  set_motion(&def, made);
  return camera_wrap(&def, made, NULL, self->keep);
}

/* The lens of a def whose pixels become those of `made`: a focal length in millimetres fixes
 * the sensor's width, a pixel in focus moves, and a lens of many elements has a focal length of
 * its own. */
static void fit_lens(vlCameraDef *def, const vlCameraDef *before, const vlCamera *made) {
  def->sensor_width_mm = before->sensor_width_mm;
  if (!isnan(before->focal_mm) && made->fx > 0)
    def->sensor_width_mm = before->focal_mm * made->width / made->fx;
  memcpy(def->lens.focus_pixel, made->lens.focus_pixel, sizeof def->lens.focus_pixel);
  const bool alike =
      (uint64_t)made->width * before->height == (uint64_t)made->height * before->width;
  if (def->lens.optics && alike)
    def->fx = def->fy = def->cx = def->cy = VL_UNSET; /* else replace() is refused */
}

/* Focal length and principal point of a def become those of `made`. */
static void set_pixels(vlCameraDef *def, const vlCameraDef *before, const vlCamera *made) {
  unset_focal(def, 0);
  def->fx = made->fx;
  def->fy = made->fy;
  def->cx = made->cx;
  def->cy = made->cy;
  def->skew = made->skew;
  fit_lens(def, before, made);
}

/* An eye of a stereo pair. That of off-axis stereo has a principal point of its own. */
static PyObject *with_eye(Camera *self, const vlCamera *made) {
  PyObject *result = with_compiled(self, VL_OK, made, NULL);
  if (result && made->cx != self->camera.cx)
    set_pixels(&((Camera *)result)->def, &self->def, made);
  return result;
}

/* A camera with other pixels. */
static PyObject *with_pixels(Camera *self, vlResult done, const vlCamera *made) {
  PyObject *result = with_compiled(self, done, made, NULL);
  if (result) {
    vlCameraDef *def = &((Camera *)result)->def;
    set_pixels(def, &self->def, made);
    memcpy(def->eye, self->def.eye, sizeof def->eye); /* the pose stays as it was given */
    memcpy(def->lookat, self->def.lookat, sizeof def->lookat);
    memcpy(def->up, self->def.up, sizeof def->up);
    def->roll = self->def.roll;
    def->has_matrix = self->def.has_matrix;
    def->has_matrix_close = self->def.has_matrix_close;
    memcpy(def->eye_close, self->def.eye_close, sizeof def->eye_close);
    memcpy(def->lookat_close, self->def.lookat_close, sizeof def->lookat_close);
    memcpy(def->up_close, self->def.up_close, sizeof def->up_close);
    def->roll_close = self->def.roll_close;
    memcpy(def->pose_times, self->def.pose_times, sizeof def->pose_times);
  }
  return result;
}

static PyObject *camera_resize(Camera *self, PyObject *arguments) {
  PyObject *width, *height;
  uint32_t size[2];
  if (!PyArg_ParseTuple(arguments, "OO:_resize", &width, &height) ||
      !read_size(width, height, MAX_PIXELS, size))
    return NULL;
  if (size[0] == self->camera.width && size[1] == self->camera.height) {
    Py_INCREF((PyObject *)self);
    return (PyObject *)self;
  }
  vlCamera made;
  vlResult done = vl_camera_resize(&self->camera, size[0], size[1], &made);
  return with_pixels(self, done, &made);
}
static PyObject *camera_coarse(Camera *self, PyObject *number) {
  uint32_t factor;
  if (!read_count(number, "coarse's factor", 1, VL_MAX_COARSE, &factor))
    return NULL;
  vlCamera made;
  vlResult done = vl_camera_coarse(&self->camera, factor, &made);
  return with_pixels(self, done, &made);
}
static PyObject *camera_move(Camera *self, PyObject *matrix) {
  double m[16];
  if (!numbers_copy(matrix, "world_from_camera", 16, m))
    return NULL;
  vlCamera made;
  vlError error = {0};
  vlResult done = vl_camera_move(&self->camera, m, &made, &error);
  return with_compiled(self, done, &made, &error);
}
static PyObject *camera_at(Camera *self, PyObject *time) {
  double seconds;
  if (!read_finite(time, "time", &seconds))
    return NULL;
  vlCamera made;
  vlResult done = vl_camera_at(&self->camera, seconds, &made);
  return with_compiled(self, done, &made, NULL);
}
static PyObject *camera_stereo(Camera *self, PyObject *unused) {
  (void)unused;
  vlCamera eyes[2];
  vlError error = {0};
  vlResult done = vl_camera_stereo(&self->def, &eyes[0], &eyes[1], NULL, &error);
  if (done != VL_OK)
    return raise_result(done, &error);
  return Py_BuildValue("(NN)", with_eye(self, &eyes[0]), with_eye(self, &eyes[1]));
}

/* ---- projection of arrays ---------------------------------------------------------------- */

static bool read_rows(PyObject *object, const char *what, size_t columns, Numbers *n) {
  if (!numbers_read_any(object, 'd', what, n))
    return false;
  if (n->count % columns == 0 && (n->dimensions == 0 || n->shape[n->dimensions - 1] == columns))
    return true;
  numbers_release(n);
  raise_usage("%s: an array of rows of %zu numbers", what, columns);
  return false;
}

/* _project(points): pixels, z, valid as bytearrays. */
static PyObject *camera_project(Camera *self, PyObject *points) {
  Numbers n;
  if (!read_rows(points, "points", 3, &n))
    return NULL;
  size_t count = n.count / 3;
  void *data[3] = {NULL, NULL, NULL};
  PyObject *pixels = make_bytes(count * 16, &data[0]), *z = make_bytes(count * 8, &data[1]),
           *valid = make_bytes(count, &data[2]);
  if (pixels && z && valid) {
    PyThreadState *thread = PyEval_SaveThread();
    vl_camera_project_batch(&self->camera, count, n.data, data[0], data[1], data[2]);
    PyEval_RestoreThread(thread);
  }
  numbers_release(&n);
  PyObject *result = Py_BuildValue("(NNN)", pixels, z, valid);
  if (own_check(own_of_camera(&self->camera)))
    return result;
  Py_XDECREF(result);
  return NULL;
}

/* _unproject(pixels): origins, directions, valid as bytearrays. */
static PyObject *camera_unproject(Camera *self, PyObject *pixels) {
  Numbers n;
  if (!read_rows(pixels, "pixels", 2, &n))
    return NULL;
  size_t count = n.count / 2;
  void *data[3] = {NULL, NULL, NULL};
  PyObject *origins = make_bytes(count * 24, &data[0]),
           *directions = make_bytes(count * 24, &data[1]), *valid = make_bytes(count, &data[2]);
  if (origins && directions && valid) {
    PyThreadState *thread = PyEval_SaveThread();
    vl_camera_unproject_batch(&self->camera, count, n.data, data[0], data[1], data[2]);
    PyEval_RestoreThread(thread);
  }
  numbers_release(&n);
  PyObject *result = Py_BuildValue("(NNN)", origins, directions, valid);
  if (own_check(own_of_camera(&self->camera)))
    return result;
  Py_XDECREF(result);
  return NULL;
}

/* _film_times(pixels): seconds as a bytearray. */
static PyObject *camera_film_times(Camera *self, PyObject *pixels) {
  Numbers n;
  if (!read_rows(pixels, "pixels", 2, &n))
    return NULL;
  size_t count = n.count / 2;
  void *data = NULL;
  PyObject *times = make_bytes(count * sizeof(double), &data);
  if (times)
    vl_camera_film_times(&self->camera, count, n.data, data);
  numbers_release(&n);
  return times;
}

typedef vlResult JacobianFn(const vlCamera *camera, size_t count, const double *in, double *out,
                            uint8_t *valid, vlError *error);

/* Rows of `inputs` numbers to Jacobians of `outputs` rows: numbers, valid as bytearrays. */
static PyObject *camera_jacobian(Camera *self, PyObject *rows, const char *what, size_t inputs,
                                 size_t outputs, JacobianFn *jacobian) {
  Numbers n;
  if (!read_rows(rows, what, inputs, &n))
    return NULL;
  size_t count = n.count / inputs;
  void *data[2] = {NULL, NULL};
  PyObject *numbers =
      make_bytes(count * outputs * VL_JACOBIAN_COLUMNS * sizeof(double), &data[0]);
  PyObject *valid = make_bytes(count, &data[1]);
  vlError error;
  vlResult result = VL_OK;
  if (numbers && valid) {
    PyThreadState *thread = PyEval_SaveThread();
    result = jacobian(&self->camera, count, n.data, data[0], data[1], &error);
    PyEval_RestoreThread(thread);
  }
  numbers_release(&n);
  if (result == VL_OK)
    return Py_BuildValue("(NN)", numbers, valid);
  Py_XDECREF(numbers);
  Py_XDECREF(valid);
  return raise_result(result, &error);
}

static PyObject *camera_project_jacobian(Camera *self, PyObject *points) {
  return camera_jacobian(self, points, "points", 3, 2, vl_camera_project_jacobian);
}

static PyObject *camera_unproject_jacobian(Camera *self, PyObject *pixels) {
  return camera_jacobian(self, pixels, "pixels", 2, 6, vl_camera_unproject_jacobian);
}

static PyObject *camera_solid_angle(Camera *self, PyObject *arguments) {
  PyObject *point[2];
  double x, y;
  if (!PyArg_ParseTuple(arguments, "OO:solid_angle", &point[0], &point[1]) ||
      !read_finite(point[0], "x", &x) || !read_finite(point[1], "y", &y))
    return NULL;
  double angle = vl_camera_solid_angle(&self->camera, x, y);
  return own_check(own_of_camera(&self->camera)) ? PyFloat_FromDouble(angle) : NULL;
}

/* ---- members ----------------------------------------------------------------------------- */

PyObject *numbers_tuple(const double *values, int count) {
  PyObject *tuple = PyTuple_New(count);
  for (int i = 0; tuple && i < count; i++)
    PyTuple_SetItem(tuple, i, PyFloat_FromDouble(values[i]));
  return tuple;
}
static PyObject *camera_k(Camera *self, void *unused) {
  (void)unused;
  const vlCamera *c = &self->camera;
  const double k[9] = {c->fx, c->skew, c->cx, 0, c->fy, c->cy, 0, 0, 1};
  return numbers_tuple(k, 9);
}
static PyObject *camera_pose(Camera *self, void *unused) {
  (void)unused;
  return numbers_tuple(self->camera.world_from_camera, 16);
}
static PyObject *camera_inverse(Camera *self, void *unused) {
  (void)unused;
  return numbers_tuple(self->camera.camera_from_world, 16);
}
static PyObject *camera_size(Camera *self, void *unused) {
  (void)unused;
  return Py_BuildValue("(II)", self->camera.width, self->camera.height);
}
static PyObject *camera_projection(Camera *self, void *unused) {
  (void)unused;
  return PyUnicode_FromString(vl_projection_name(self->camera.projection));
}
static PyObject *camera_coefficients(Camera *self, void *unused) {
  (void)unused;
  return numbers_tuple(self->def.distortion_coefficients, (int)self->def.distortion_count);
}
static PyObject *camera_outside(Camera *self, void *unused) {
  (void)unused;
  return PyFloat_FromDouble(self->camera.outside);
}
static PyObject *camera_warning(Camera *self, void *unused) {
  (void)unused;
  Py_INCREF(self->warning);
  return self->warning;
}
static PyObject *camera_get(Camera *self, PyObject *name) {
  PyObject *keep = PyList_New(0), *result = NULL;
  const char *text = keep ? keep_text(keep, name, "name") : NULL;
  const vlParameter *row = text ? camera_row(&self->def, text, false) : NULL;
  if (row) {
    result = get_parameter((const char *)&self->def, row);
  } else if (text) {
    PyObject *names = PyList_New(0);
    if (names && !append_settings(names, VL_SETTING_CAMERA))
      Py_CLEAR(names);
    raise_unknown("parameter of a camera", text, names);
  }
  Py_XDECREF(keep);
  return result;
}

/* ---- the type ---------------------------------------------------------------------------- */

static PyMethodDef camera_methods[] = {
    {"_replace", (PyCFunction)camera_replace, METH_O, "This camera with other parameters."},
    {"_resize", (PyCFunction)camera_resize, METH_VARARGS, "For another image size."},
    {"_coarse", (PyCFunction)camera_coarse, METH_O,
     "With pixels that are this many times as wide and high."},
    {"_move", (PyCFunction)camera_move, METH_O, "With another pose."},
    {"_at", (PyCFunction)camera_at, METH_O, "Frozen at a time."},
    {"_stereo", (PyCFunction)camera_stereo, METH_NOARGS, "Both eyes."},
    {"_project", (PyCFunction)camera_project, METH_O, "Points to pixels."},
    {"_unproject", (PyCFunction)camera_unproject, METH_O, "Pixels to rays."},
    {"_film_times", (PyCFunction)camera_film_times, METH_O, "Times of pixels."},
    {"_project_jacobian", (PyCFunction)camera_project_jacobian, METH_O,
     "Derivatives of pixels."},
    {"_unproject_jacobian", (PyCFunction)camera_unproject_jacobian, METH_O,
     "Derivatives of rays."},
    {"solid_angle", (PyCFunction)camera_solid_angle, METH_VARARGS,
     "solid_angle(x, y)\n--\n\nSolid angle of the pixel around the film point (x, y), "
     "steradians."},
    {"_write", (PyCFunction)camera_write, METH_VARARGS, "Writes a camera file."},
    {"_get", (PyCFunction)camera_get, METH_O, "A parameter as it was given."},
    {NULL, NULL, 0, NULL},
};
static PyGetSetDef camera_members[] = {
    {"_k", (getter)camera_k, NULL, "K by rows.", NULL},
    {"_world_from_camera", (getter)camera_pose, NULL, "The pose by rows.", NULL},
    {"_camera_from_world", (getter)camera_inverse, NULL, "Its inverse.", NULL},
    {"resolution", (getter)camera_size, NULL, "Width and height, pixels.", NULL},
    {"projection", (getter)camera_projection, NULL, "Name of the projection.", NULL},
    {"distortion_coefficients", (getter)camera_coefficients, NULL,
     "Coefficients of the distortion.", NULL},
    {"outside", (getter)camera_outside, NULL, "Share of the image without rays, 0 to 1.", NULL},
    {"warning", (getter)camera_warning, NULL,
     "What is questionable about the parameters; None: nothing.", NULL},
    {NULL, NULL, NULL, NULL, NULL},
};
static PyType_Slot camera_slots[] = {
    {Py_tp_doc, "A compiled camera. It never changes."},
    {Py_tp_dealloc, camera_dealloc},
    {Py_tp_methods, camera_methods},
    {Py_tp_getset, camera_members},
    {0, NULL},
};
PyType_Spec camera_spec = {
    "velo._velo.Camera", sizeof(Camera), 0,
    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_BASETYPE | Py_TPFLAGS_DISALLOW_INSTANTIATION, camera_slots};

PyMethodDef camera_functions[] = {
    {"camera_new", camera_new, METH_VARARGS, "A camera: width, height, keywords."},
    {NULL, NULL, 0, NULL},
};
