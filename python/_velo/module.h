/* _velo/module.h: what the files of the extension module share. The module uses velo's public
 * headers and CPython's stable ABI of 3.10 only, with the buffer protocol. Its classes are
 * thin: python/velo adds the convenient methods. */
#ifndef VELO_PYTHON_MODULE_H
#define VELO_PYTHON_MODULE_H

#ifndef Py_LIMITED_API
#define Py_LIMITED_API 0x030A0000
#endif
#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include <locale.h>
#include <velo/edit.h>
#include <velo/setting.h>
#include <velo/velo.h>
#include "py_buffer.h"

/* ---- objects ----------------------------------------------------------------------------- */

typedef struct Context {
  PyObject_HEAD vlContext *context;
  uint64_t max_memory; /* bytes; 0: no limit */
  long pid;            /* of the process that made it: after fork() its threads are missing */
} Context;

typedef struct Scene {
  PyObject_HEAD Context *context;
  vlScene *scene;
  PyObject *keep; /* list: what the scene's defs point at */
  bool busy;      /* a thread works on it without the GIL */
} Scene;

typedef struct World {
  PyObject_HEAD Context *context;
  vlWorld *world;
  unsigned users; /* calls in progress */
} World;

typedef struct Film {
  PyObject_HEAD Context *context;
  vlFilm *film;
  vlFilmDef def;
  char sensor[64];
  bool busy;
} Film;

typedef struct Image {
  PyObject_HEAD Context *context;
  vlImage *image;
  Py_ssize_t exports; /* buffers in use */
} Image;

/* Channels `first` to `first + count - 1` of an image, as a buffer; flat: without the last
 * dimension. */
typedef struct Plane {
  PyObject_HEAD Image *image;
  uint32_t first, count;
  bool flat;
} Plane;

typedef struct Camera {
  PyObject_HEAD vlCameraDef def;
  vlCamera camera;
  PyObject *keep;    /* what the lens points at; may be null */
  PyObject *warning; /* str or None */
} Camera;

/* A copy of a scene's defs, changed by keyword arguments. */
typedef struct Settings {
  PyObject_HEAD vlSceneDefs defs;
  PyObject *keep; /* list */
} Settings;

/* Code of one's own: Python functions that the library's threads call. velo/own.py has the
 * classes around it. */
typedef struct Own {
  PyObject_HEAD vlOwnKind kind;
  char name[VL_OWN_NAME];
  PyObject *function, *pixels; /* of velo/own.py; pixels may be null */
  PyObject *error;             /* the first exception outside of a long call; null: none */
  vlOwnCamera camera;
  vlOwnSampler sampler;
  vlOwnTracer tracer;
} Own;

/* The id of a texture, material, medium, emission, shape or group in a scene. */
typedef struct Handle {
  PyObject_HEAD Scene *scene;
  const char *family; /* of velo/schema.h, or "groups" */
  uint32_t index;
  uint64_t serial; /* vl_scene_serial */
} Handle;

/* The classes that the module makes objects of. The Python package replaces them by its
 * subclasses. */
enum {
  TYPE_CONTEXT,
  TYPE_SCENE,
  TYPE_WORLD,
  TYPE_FILM,
  TYPE_IMAGE,
  TYPE_PLANE,
  TYPE_CAMERA,
  TYPE_SETTINGS,
  TYPE_HANDLE,
  TYPE_OWN,
  TYPE_COUNT
};
extern PyTypeObject *base_types[TYPE_COUNT], *types[TYPE_COUNT];
extern PyType_Spec context_spec, scene_spec, world_spec, film_spec, image_spec, plane_spec,
    camera_spec, settings_spec, handle_spec, own_spec;

/* A new object of a class, all zero; null with an exception. */
void *make_object(int type);
/* The end of every tp_dealloc. */
void free_object(PyObject *self);
bool is_object(PyObject *object, int type);

/* ---- calls of the library ---------------------------------------------------------------- */

/* A call of the library without the GIL. */
typedef struct Call {
  PyThreadState *thread;
  bool *busy;
  locale_t locale; /* of the thread before */
} Call;
/* Checks that the context may be used by this process and thread, marks `busy` (may be null)
 * and releases the GIL. False: an exception is set. */
bool call_begin(Call *call, const Context *context, bool *busy);
/* The locale "C", in which calls run: numbers of files have a decimal point, whatever locale
 * Python has. */
locale_t plain_locale(void);
void call_end(Call *call);
/* The same check alone, for calls that keep the GIL. */
bool context_check(const Context *context);
/* Whether the context belongs to this process, without an exception. */
bool context_is_ours(const Context *context);

/* A call that takes long: a load, a build, a render, ground truth. It runs on a thread of its
 * own (long_call.c). */
typedef struct Waiting Waiting;
typedef struct LongCall {
  const Context *context;
  vlCancel *cancel;   /* for the def of the call */
  PyObject *callback; /* null: none */
  PyObject *poll; /* called without arguments about fifty times a second while the call runs; an
                     exception ends the call; its answer is not used. null: none */
  Film *film;     /* which the callback may read after a pass; may be null */
  Waiting *waiting;
  const Own *own[6]; /* whose functions it calls; null: none */
  PyObject *error;   /* the first exception of these functions; null: none */
} LongCall;
typedef vlResult LongBody(void *user);
/* callback: a callable, or None. False: an exception is set. True: long_call_end must
 * follow. */
bool long_call_begin(LongCall *call, const Context *context, PyObject *callback);
/* Runs body(user) without the GIL; *result is what it returns. False: an exception is set, by a
 * signal, the callback, or since the call could not run. */
bool long_call_run(LongCall *call, bool *busy, LongBody *body, void *user, vlResult *result);
/* Takes the poll of a call; None: none. False: an exception is set. */
bool long_call_poll(LongCall *call, PyObject *poll);
void long_call_end(LongCall *call);
/* The callbacks for the def of a call; user is the LongCall. */
bool long_call_progress(void *user, const vlProgress *progress);
bool long_call_step(void *user, const vlStep *step);
/* Ends the long calls that call this code, with an exception (taken). False: there are none. */
bool long_call_fail(const Own *own, PyObject *error);
/* The film that this thread may read, although a render runs: inside a callback after a
 * pass. */
extern _Thread_local const Film *open_film;
/* shut_down(): stops the calls of other threads, and waits for them; later ones are errors. */
PyObject *shut_down(PyObject *module, PyObject *unused);

/* Calls a function of velo/_errors.py with arguments as Py_BuildValue("(...)") makes them. */
PyObject *call_package(const char *name, const char *format, ...);
/* Sets the exception of a result, or of `error` where it has a message; returns null. */
PyObject *raise_result(vlResult result, const vlError *error);
/* Sets velo.UsageError; returns null. */
PyObject *raise_usage(const char *format, ...);
/* Sets velo.UsageError: `what` must be ..., it is ...; returns null. The format says what it
 * must be. */
PyObject *raise_value(const char *what, PyObject *value, const char *format, ...);

/* ---- the caller's numbers and texts ------------------------------------------------------ */

enum { MAX_PIXELS = 1 << 24 }; /* of a side of a camera's image */

/* A str of a text that need not be UTF-8. */
PyObject *text_object(const char *text);
/* 1: *number is read; 0: it is not a number; -1: an exception of the caller's own. */
int to_double(PyObject *value, double *number);
/* Each of these is false (null, -1) with an exception that names `what`, the range and the
 * value. */
bool read_whole(PyObject *value, const char *what, int64_t low, int64_t high, int64_t *whole);
bool read_count(PyObject *value, const char *what, uint32_t low, uint32_t high,
                uint32_t *count);
bool read_size(PyObject *width, PyObject *height, uint32_t most, uint32_t size[2]);
/* A value of any row of one number, a flag or a choice, in the def's unit. */
bool read_row(PyObject *value, const char *what, const vlParameter *row, double *number);
bool read_finite(PyObject *value, const char *what, double *number);
bool read_flag(PyObject *value, const char *what, bool *flag);
/* For the package's own checks. */
PyObject *check_value(PyObject *module, PyObject *arguments);
PyObject *check_choice(PyObject *module, PyObject *arguments);
PyObject *check_setting(PyObject *module, PyObject *arguments);
PyObject *unknown_name(PyObject *module, PyObject *arguments);
/* The number of items of a sequence that is not a text. */
Py_ssize_t sequence_size(PyObject *value, const char *what, Py_ssize_t low, Py_ssize_t high);
/* UTF-8 text of a str, kept alive by the list. */
const char *keep_text(PyObject *keep, PyObject *value, const char *what);
/* keep_text for the first `count` items of a sequence. */
bool keep_texts(PyObject *keep, PyObject *values, Py_ssize_t count, const char *what,
                const char **texts);
const char *keep_path(PyObject *keep, PyObject *value, const char *what);
/* Whether this many bytes more than the context holds now may be taken; `what` is what needs
 * them. */
bool check_memory(const Context *context, uint64_t bytes, const char *what);

/* ---- values ------------------------------------------------------------------------------ */

/* Numbers of a buffer or of nested sequences, as doubles, floats or uint32s. */
typedef struct Numbers {
  Py_buffer view; /* view.obj null: not used */
  void *owned;    /* null: data is the view's */
  const void *data;
  size_t count;   /* of all numbers */
  int dimensions; /* at most 4 */
  size_t shape[4];
} Numbers;
/* type: 'd', 'f' or 'I'. All must be finite. False with an exception that names `what`. */
bool numbers_read(PyObject *object, char type, const char *what, Numbers *numbers);
/* The same for arrays in which infinities and NaN have a meaning. */
bool numbers_read_any(PyObject *object, char type, const char *what, Numbers *numbers);
void numbers_release(Numbers *numbers);
/* Exactly `count` doubles; floats. */
bool numbers_copy(PyObject *object, const char *what, size_t count, double *result);
bool floats_copy(PyObject *object, const char *what, size_t count, float *result);
/* A bytearray with `size` bytes; *data points at them. */
PyObject *make_bytes(size_t size, void **data);

/* Where a parameter's value comes from and what keeps it alive. */
typedef struct Target {
  char *def;
  PyObject *keep;     /* list */
  const Scene *scene; /* of textures and the like; may be null */
  bool spectrum;      /* textures: which member EITHER_INPUT sets */
} Target;
/* The parameter with that name among `count`: its member, the member's last word, or its name
 * in files. */
const vlParameter *find_parameter(const vlParameter *rows, size_t count, const char *name);
bool set_parameter(const Target *target, const vlParameter *row, PyObject *value);
PyObject *get_parameter(const char *def, const vlParameter *row);
/* velo.UsageError: there is no such keyword, with the nearest of names. `names` is a list,
 * stolen. */
bool raise_unknown(const char *thing, const char *name, PyObject *names);
/* Appends the names of rows to a list. */
bool append_names(PyObject *list, const vlParameter *rows, size_t count);
/* Compares letters and digits only, whatever their case: "blackman-harris" is
 * "BLACKMAN_HARRIS". */
bool same_word(const char *a, const char *b);
/* Appends a text in lower case where it is a constant's name (AMBIENT_OCCLUSION). */
bool append_text(PyObject *list, const char *text);
bool append_settings(PyObject *list, vlSettingGroup group);
/* Index of a word in a list that ends with null, comparing letters and digits only; -1 with an
 * exception. */
int find_choice(const char *const *choices, const char *what, PyObject *value);
bool keep_object(PyObject *keep, PyObject *object); /* appends, without stealing */
bool read_spectrum(PyObject *keep, PyObject *value, vlSpectrum *spectrum, const char *what);

/* Sets each item of a dict. Unknown names are UsageErrors. */
bool set_parameters(const Target *target, vlSettingGroup group, const char *thing,
                    PyObject *keywords);

/* Kind `name` of a family; -1 with an exception. thing: what messages call it. */
int find_kind(const vlKindFamily *family, const char *thing, PyObject *name);

/* The code of one's own behind a def's pointers; null: none. */
const Own *own_of_camera(const vlCamera *camera);
const Own *own_of_sampler(const vlRenderDef *def);
const Own *own_of_tracer(const vlRenderDef *def);
/* An Own of this kind from a Python value; null with an exception. */
Own *own_read(PyObject *value, vlOwnKind kind, const char *what);
/* Raises the exception that its function left outside of a long call, if any. False: raised.
 * own may be null. */
bool own_check(const Own *own);

/* ---- functions of the files -------------------------------------------------------------- */

/* False, with an exception: its object was removed. */
bool handle_is_valid(const Handle *handle);
/* takes the image, also when it fails */
PyObject *image_object(Context *context, vlImage *image);
/* The dict of a def. */
PyObject *raw_values(const vlRawDef *def);
bool scene_open(const Scene *self); /* false: an exception is set */
/* Begins a call that adds to the scene; null with an exception. scene_settle ends it: if it is
 * not done, the scene is as it was. */
vlSceneCheckpoint *scene_attempt(const Scene *self);
void scene_settle(Scene *self, vlSceneCheckpoint *checkpoint, bool done);
/* A file that is read. */
typedef struct Loading {
  vlScene *scene;
  const char *file, *name;
  vlLoadDef def;
  vlLoadedGroup *loaded; /* null: it is added to the scene; else as a group */
  vlError error;
} Loading;
/* false: an exception is set */
bool load_file(Scene *self, Loading *loading, PyObject *callback);
PyObject *scene_add(Scene *self, PyObject *arguments);
PyObject *scene_load_group(Scene *self, PyObject *arguments);
PyObject *scene_add_instance(Scene *self, PyObject *arguments);
PyObject *scene_set(Scene *self, PyObject *arguments);
PyObject *scene_show(Scene *self, PyObject *arguments);
PyObject *scene_remove(Scene *self, PyObject *handle);
PyObject *scene_handles(Scene *self, PyObject *family);
PyObject *scene_get(Scene *self, PyObject *handle);
PyObject *scene_mesh(Scene *self, PyObject *handle);
PyObject *scene_instance(Scene *self, PyObject *handle);
PyObject *world_trace(World *self, PyObject *arguments);
PyObject *world_occluded(World *self, PyObject *arguments);
PyObject *camera_object(const vlCameraDef *def, PyObject *keep);
PyObject *camera_write(Camera *self, PyObject *arguments);
PyObject *numbers_tuple(const double *values, int count); /* of floats */
extern PyMethodDef camera_functions[], camera_file_functions[], film_functions[],
    image_functions[], render_functions[], world_functions[], own_functions[],
    own_trace_functions[], raw_functions[], sensor_functions[];

#endif
