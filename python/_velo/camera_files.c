/* _velo/camera_files.c: camera files and trajectories. */
#include <math.h>
#include <string.h>

#include "module.h"

/* How a file is read or written. */
typedef struct FileCall {
  PyObject *keep; /* a list of the objects whose texts def and path point at */
  vlCameraFileDef def;
  const char *path, *drops[32];
} FileCall;

/* False: an error of Python's. In each case `keep` is released by the caller. */
static bool file_call(FileCall *f, PyObject *path, PyObject *dialect, PyObject *frame,
                      PyObject *drop) {
  const char *known[VL_CAMERA_DIALECT_COUNT + 1] = {0};
  for (int i = 0; i < VL_CAMERA_DIALECT_COUNT; i++)
    known[i] = vl_camera_dialect_name((vlCameraDialect)i);
  if (dialect != Py_None) {
    int found = find_choice(known, "dialect", dialect);
    if (found < 0)
      return false;
    f->def.dialect = (vlCameraDialect)found;
  }
  if (frame != Py_None) {
    bool number = PyLong_Check(frame) && !PyBool_Check(frame);
    int64_t index;
    if (number && !read_whole(frame, "frame", 0, UINT32_MAX, &index))
      return false;
    PyObject *text = number ? PyObject_Str(frame) : (Py_INCREF(frame), frame);
    f->def.frame = text ? keep_text(f->keep, text, "frame") : NULL;
    Py_XDECREF(text);
    if (!f->def.frame)
      return false;
  }
  Py_ssize_t count = drop == Py_None ? 0 : sequence_size(drop, "drop", 0, 32);
  if (count < 0 || !keep_texts(f->keep, drop, count, "drop", f->drops))
    return false;
  f->def.drop = f->drops;
  f->def.drop_count = (uint32_t)count;
  f->path = keep_path(f->keep, path, "path");
  return f->path != NULL;
}

/* width, height: of files without an image size; 0: not given. */
static bool begin_read(FileCall *f, Call *call, Context *context, PyObject *path,
                       PyObject *dialect, PyObject *frame, PyObject *width, PyObject *height) {
  *f = (FileCall){.keep = PyList_New(0), .def = vl_default_camera_file_def()};
  return f->keep && read_count(width, "width", 0, MAX_PIXELS, &f->def.width) &&
         read_count(height, "height", 0, MAX_PIXELS, &f->def.height) &&
         file_call(f, path, dialect, frame, Py_None) && call_begin(call, context, NULL);
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
  PyObject *path, *dialect, *frame, *width, *height, *result = NULL;
  FileCall f;
  Call call;
  if (!PyArg_ParseTuple(arguments, "O!OOOOO:camera_read", base_types[TYPE_CONTEXT], &context,
                        &path, &dialect, &frame, &width, &height))
    return NULL;
  if (!begin_read(&f, &call, context, path, dialect, frame, width, height))
    goto end;
  vlError error = {0};
  vlCameraRecord record;
  vlResult done = vl_camera_read(context->context, f.path, &f.def, &record, &error);
  call_end(&call);
  if (done != VL_OK) {
    raise_result(done, &error);
    goto end;
  }
  PyObject *camera = warn_unread(f.path, &record) ? camera_object(&record.camera, NULL) : NULL;
  if (camera)
    result =
        Py_BuildValue("(NsINN)", camera, vl_camera_dialect_name(record.dialect), record.frames,
                      text_object(record.name), PyBool_FromLong(record.size_assumed));
end:
  Py_XDECREF(f.keep);
  return result;
}

/* _write(context, path, dialect, name, drop) */
PyObject *camera_write(Camera *self, PyObject *arguments) {
  Context *context;
  PyObject *path, *dialect, *drop, *text, *result = NULL;
  if (!PyArg_ParseTuple(arguments, "O!OOOO:_write", base_types[TYPE_CONTEXT], &context, &path,
                        &dialect, &text, &drop))
    return NULL;
  FileCall f = {.keep = PyList_New(0), .def = vl_default_camera_file_def()};
  const char *name = f.keep ? keep_text(f.keep, text, "name") : NULL;
  if (!name || !file_call(&f, path, dialect, Py_None, drop))
    goto end;
  vlCameraRecord record = {.camera = self->def, .frames = 1};
  if (self->camera.eye_circle != 0) {
    raise_usage(
        "an eye of omnidirectional stereo is held by no file; write the camera of both eyes");
    goto end;
  }
  if (strlen(name) >= sizeof record.name) {
    raise_value("name", text, "at most %zu bytes long", sizeof record.name - 1);
    goto end;
  }
  memcpy(record.name, name, strlen(name));
  Call call;
  if (!call_begin(&call, context, NULL))
    goto end;
  vlError error = {0};
  vlResult done = vl_camera_write(context->context, f.path, &f.def, &record, &error);
  call_end(&call);
  result = done == VL_OK ? Py_NewRef(Py_None) : raise_result(done, &error);
end:
  Py_XDECREF(f.keep);
  return result;
}

/* trajectory_read(context, path, dialect, width, height): a list of (name, camera or None,
 * matrix, time or None) */
static PyObject *trajectory_read(PyObject *module, PyObject *arguments) {
  (void)module;
  Context *context;
  PyObject *path, *dialect, *width, *height, *result = NULL;
  FileCall f;
  Call call;
  if (!PyArg_ParseTuple(arguments, "O!OOOO:trajectory_read", base_types[TYPE_CONTEXT], &context,
                        &path, &dialect, &width, &height))
    return NULL;
  if (!begin_read(&f, &call, context, path, dialect, Py_None, width, height))
    goto end;
  vlError error = {0};
  vlTrajectory *trajectory = NULL;
  vlResult done = vl_trajectory_load(context->context, f.path, &f.def, &trajectory, &error);
  call_end(&call);
  if (done != VL_OK) {
    raise_result(done, &error);
    goto end;
  }
  const vlCameraRecord *first = vl_trajectory_camera(trajectory, 0);
  result = !first || warn_unread(f.path, first) ? PyList_New(0) : NULL;
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
  Py_XDECREF(f.keep);
  return result;
}

PyMethodDef camera_file_functions[] = {
    {"camera_read", camera_read, METH_VARARGS, "Reads a camera file."},
    {"trajectory_read", trajectory_read, METH_VARARGS, "Reads a file of many poses."},
    {NULL, NULL, 0, NULL},
};
