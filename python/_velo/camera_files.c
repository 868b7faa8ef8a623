/* _velo/camera_files.c: camera files and trajectories. */
#include <math.h>
#include <string.h>

#include "module.h"

static bool file_def(vlCameraFileDef *def, PyObject *keep, PyObject *dialect, PyObject *frame,
                     PyObject *drop, const char **drops) {
  const char *known[VL_CAMERA_DIALECT_COUNT + 1] = {0};
  for (int i = 0; i < VL_CAMERA_DIALECT_COUNT; i++)
    known[i] = vl_camera_dialect_name((vlCameraDialect)i);
  if (dialect != Py_None) {
    int found = find_choice(known, "dialect", dialect);
    if (found < 0)
      return false;
    def->dialect = (vlCameraDialect)found;
  }
  if (frame != Py_None) {
    bool number = PyLong_Check(frame) && !PyBool_Check(frame);
    int64_t index;
    if (number && !read_whole(frame, "frame", 0, UINT32_MAX, &index))
      return false;
    PyObject *text = number ? PyObject_Str(frame) : (Py_INCREF(frame), frame);
    def->frame = text ? keep_text(keep, text, "frame") : NULL;
    Py_XDECREF(text);
    if (!def->frame)
      return false;
  }
  Py_ssize_t count = drop == Py_None ? 0 : sequence_size(drop, "drop", 0, 32);
  if (count < 0 || !keep_texts(keep, drop, count, "drop", drops))
    return false;
  def->drop = drops;
  def->drop_count = (uint32_t)count;
  return true;
}

/* The image size for files without one; 0: not given. */
static bool file_size(PyObject *width, PyObject *height, vlCameraFileDef *def) {
  return read_count(width, "width", 0, MAX_PIXELS, &def->width) &&
         read_count(height, "height", 0, MAX_PIXELS, &def->height);
}

/* Warns of the fields that velo does not understand. Returns false if the warning is an error
 * of Python's. */
static bool warn_unread(const char *file, const vlCameraRecord *record) {
  if (record->unread == 0)
    return true;
  return PyErr_WarnFormat(PyExc_UserWarning, 1,
                          "%s: line %u: %u fields are not understood and without effect: %s%s",
                          file, record->unread_line, record->unread, record->unread_names,
                          record->unread > VL_UNREAD_NAMES ? ", ..." : "") == 0;
}

/* camera_read(context, path, dialect, frame, width, height): camera, dialect, frames, name,
 * size_assumed */
static PyObject *camera_read(PyObject *module, PyObject *arguments) {
  (void)module;
  Context *context;
  PyObject *path, *dialect, *frame, *width, *height, *keep = PyList_New(0), *result = NULL;
  vlCameraFileDef def = vl_default_camera_file_def();
  const char *file, *drops[32];
  if (!keep ||
      !PyArg_ParseTuple(arguments, "O!OOOOO:camera_read", base_types[TYPE_CONTEXT], &context,
                        &path, &dialect, &frame, &width, &height) ||
      !file_size(width, height, &def) ||
      !file_def(&def, keep, dialect, frame, Py_None, drops) ||
      !(file = keep_path(keep, path, "path")))
    goto end;
  Call call;
  if (!call_begin(&call, context, NULL))
    goto end;
  vlError error = {0};
  vlCameraRecord record;
  vlResult done = vl_camera_read(context->context, file, &def, &record, &error);
  call_end(&call);
  if (done != VL_OK) {
    raise_result(done, &error);
    goto end;
  }
  PyObject *camera = warn_unread(file, &record) ? camera_object(&record.camera, NULL) : NULL;
  if (camera)
    result =
        Py_BuildValue("(NsINN)", camera, vl_camera_dialect_name(record.dialect), record.frames,
                      text_object(record.name), PyBool_FromLong(record.size_assumed));
end:
  Py_XDECREF(keep);
  return result;
}

/* _write(context, path, dialect, name, drop) */
PyObject *camera_write(Camera *self, PyObject *arguments) {
  Context *context;
  PyObject *path, *dialect, *drop, *text, *keep = PyList_New(0);
  const char *name, *file, *drops[32];
  vlCameraFileDef def = vl_default_camera_file_def();
  if (!keep ||
      !PyArg_ParseTuple(arguments, "O!OOOO:_write", base_types[TYPE_CONTEXT], &context, &path,
                        &dialect, &text, &drop) ||
      !(name = keep_text(keep, text, "name")) ||
      !file_def(&def, keep, dialect, Py_None, drop, drops) ||
      !(file = keep_path(keep, path, "path"))) {
    Py_XDECREF(keep);
    return NULL;
  }
  vlCameraRecord record = {.camera = self->def, .frames = 1};
  if (self->camera.eye_circle != 0) {
    Py_DECREF(keep);
    return raise_usage(
        "an eye of omnidirectional stereo is held by no file; write the camera of both eyes");
  }
  if (strlen(name) >= sizeof record.name) {
    Py_DECREF(keep);
    return raise_value("name", text, "at most %zu bytes long", sizeof record.name - 1);
  }
  memcpy(record.name, name, strlen(name));
  Call call;
  if (!call_begin(&call, context, NULL)) {
    Py_DECREF(keep);
    return NULL;
  }
  vlError error = {0};
  vlResult done = vl_camera_write(context->context, file, &def, &record, &error);
  call_end(&call);
  Py_DECREF(keep);
  if (done != VL_OK)
    return raise_result(done, &error);
  Py_RETURN_NONE;
}

/* trajectory_read(context, path, dialect, width, height): a list of (name, camera or None,
 * matrix, time or None) */
static PyObject *trajectory_read(PyObject *module, PyObject *arguments) {
  (void)module;
  Context *context;
  PyObject *path, *dialect, *width, *height, *keep = PyList_New(0), *result = NULL;
  vlCameraFileDef def = vl_default_camera_file_def();
  const char *file, *drops[32];
  if (!keep ||
      !PyArg_ParseTuple(arguments, "O!OOOO:trajectory_read", base_types[TYPE_CONTEXT], &context,
                        &path, &dialect, &width, &height) ||
      !file_size(width, height, &def) ||
      !file_def(&def, keep, dialect, Py_None, Py_None, drops) ||
      !(file = keep_path(keep, path, "path")))
    goto end;
  Call call;
  if (!call_begin(&call, context, NULL))
    goto end;
  vlError error = {0};
  vlTrajectory *trajectory = NULL;
  vlResult done = vl_trajectory_load(context->context, file, &def, &trajectory, &error);
  call_end(&call);
  if (done != VL_OK) {
    raise_result(done, &error);
    goto end;
  }
  const vlCameraRecord *first = vl_trajectory_camera(trajectory, 0);
  result = !first || warn_unread(file, first) ? PyList_New(0) : NULL;
  for (uint32_t i = 0; result && i < vl_trajectory_frames(trajectory); i++) {
    vlTrajectoryFrame frame;
    vl_trajectory_frame(trajectory, i, &frame);
    const vlCameraRecord *record =
        frame.camera < 0 ? NULL : vl_trajectory_camera(trajectory, (uint32_t)frame.camera);
    PyObject *camera = Py_None, *time = Py_None;
    if (record) {
      vlCameraDef own = record->camera;
      own.has_matrix = true;
      memcpy(own.world_from_camera, frame.world_from_camera, sizeof own.world_from_camera);
      camera = camera_object(&own, NULL);
    } else {
      Py_INCREF(Py_None);
    }
    if (!isnan(frame.time))
      time = PyFloat_FromDouble(frame.time);
    else
      Py_INCREF(Py_None);
    PyObject *entry = camera ? Py_BuildValue("(NNNN)", text_object(frame.name), camera,
                                             numbers_tuple(frame.world_from_camera, 16), time)
                             : NULL;
    if (!entry || PyList_Append(result, entry) < 0)
      Py_CLEAR(result);
    Py_XDECREF(entry);
  }
  vl_trajectory_destroy(trajectory);
end:
  Py_XDECREF(keep);
  return result;
}

PyMethodDef camera_file_functions[] = {
    {"camera_read", camera_read, METH_VARARGS, "Reads a camera file."},
    {"trajectory_read", trajectory_read, METH_VARARGS, "Reads a file of many poses."},
    {NULL, NULL, 0, NULL},
};
