/* api/load.c: vl_scene_load: chooses the importer by the name of the scene file, and reads the
 * camera that velo wrote into a glTF file. */
#include <math.h>
#include <stdio.h>
#include <sys/stat.h>

#include "base/cookie.h"
#include "base/error.h"
#include "base/machine.h"
#include "base/text.h"
#include "base/unset.h"
#include "import/import.h"
#include "scene/scene.h"
#include "velo/camera_file.h"
#include "velo/check.h"

typedef vlResult Import(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);

#define FORMAT(suffix, function) {suffix, function},
static const struct {
  const char *suffix;
  Import *import;
} formats[] = {VL_SCENE_FORMATS(FORMAT)};
enum { FORMATS = VL_LENGTH(formats) };

/* Reads the complete camera from the extras, where velo's exporter writes it. glTF's own camera
 * is only a pinhole. */
static vlResult load_whole_camera(vlScene *scene, const char *path, const vlLoadDef *load,
                                  vlError *error) {
  vlCameraFileDef def = vl_default_camera_file_def();
  def.dialect = VL_CAMERA_DIALECT_GLTF;
  def.frame = load ? load->camera : NULL;
  vlCameraRecord record;
  vlError inside;
  vl_error_clear(&inside);
  vlResult result = vl_camera_read(scene->context, path, &def, &record, &inside);
  if (result != VL_OK) {
    vl_scene_fail(scene, result,
                  (vlSource){inside.file[0] ? inside.file : path, inside.line, inside.column},
                  "%s", inside.message[0] ? inside.message : vl_result_name(result));
    return vl_scene_result(scene, error);
  }
  vlFilmDef *film = &scene->defs.film;
  const uint32_t whole[4] = {0, 0, record.camera.width, record.camera.height};
  film->width = whole[2];
  film->height = whole[3];
  memcpy(film->crop, whole, sizeof whole);
  scene->defs.camera = record.camera;
  return VL_OK;
}

static vlResult check_load(const vlScene *scene, const char *path, const vlLoadDef *def,
                           vlError *error) {
  vl_error_clear(error);
  if (!scene || !path)
    return vl_fail_argument(error, "scene load: scene or path is null");
  if (def && def->cookie != VL_COOKIE_LOAD)
    return vl_fail_argument(error, "scene load: " VL_BAD_COOKIE);
  const double times[2] = {def ? def->time : VL_UNSET, def ? def->time_close : VL_UNSET};
  for (int i = 0; i < 2; i++)
    if (!vl_is_unset(times[i]) && !isfinite(times[i]))
      return vl_fail_argument(error, "scene load: time is %g; it must be finite", times[i]);
  if (def && !vl_is_unset(def->unit) && !(def->unit >= 1e-9 && def->unit <= 1e9))
    return vl_fail_argument(error, "scene load: unit is %g m; it must be from 1e-9 to 1e9",
                            def->unit);
  return vl_scene_result(scene, error);
}

/* What is set while a file is loaded. */
typedef struct Loading {
  size_t lights, emissions; /* that the scene had before */
  vlTask task;
  unsigned floats;
  void *locale;
} Loading;

static void start_loading(vlScene *scene, const vlLoadDef *def, Loading *l) {
  vlLoadDef load = def ? *def : vl_default_load_def();
  vl_task_start(&l->task, load.cancel, load.progress, load.progress_user);
  scene->task = &l->task;
  l->lights = scene->lights.count;
  l->emissions = scene->emissions.count;
  l->floats = vl_machine_set_floats();
  l->locale = vl_machine_set_numerals();
}

static void end_loading(vlScene *scene, const vlLoadDef *def, const Loading *l) {
  vl_machine_restore_numerals(l->locale);
  vl_machine_restore_floats(l->floats);
  if (def && !vl_is_unset(def->unit))
    vl_scene_state_unit(scene, l->lights, l->emissions, def->unit);
  scene->task = NULL;
}

vlResult vl_scene_load_memory(vlScene *scene, const char *name, const void *data, size_t size,
                              const vlLoadDef *def, vlError *error) {
  VL_TRY(check_load(scene, name, def, error));
  if (!data && size)
    return vl_fail_argument(error, "scene load: data is null");
  Loading loading;
  start_loading(scene, def, &loading);
  vlResult result = vl_import_pbrt_memory(scene, data ? data : "", size, name, def, error);
  end_loading(scene, def, &loading);
  return result;
}

vlResult vl_scene_load(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error) {
  VL_TRY(check_load(scene, path, def, error));
  struct stat info;
  bool readable = stat(path, &info) == 0 && !S_ISDIR(info.st_mode);
  Import *import = readable ? NULL : vl_import_pbrt; /* a file that cannot be read goes to an
                                                        importer that reports why */
  char known[200] = "";
  for (int i = 0; i < FORMATS; i++) {
    size_t n = strlen(known);
    snprintf(known + n, sizeof known - n, "%s%s", i ? ", " : "", formats[i].suffix);
    if (!import && vl_ends_with(path, formats[i].suffix))
      import = formats[i].import;
  }
  if (import) {
    Loading loading;
    start_loading(scene, def, &loading);
    vlResult result = vl_scene_stopped(scene, 0) ? vl_scene_result(scene, error)
                                                 : import(scene, path, def, error);
    end_loading(scene, def, &loading);
    return result == VL_OK && scene->camera_in_full ? load_whole_camera(scene, path, def, error)
                                                    : result;
  }
  vl_scene_fail(scene, VL_ERROR_SCENE, (vlSource){0},
                "%.300s: unknown kind of scene file (known: %s)", path, known);
  return vl_scene_result(scene, error);
}

vlResult vl_scene_diagnose(vlScene *scene, const char *path, const vlLoadDef *def,
                           vlProblemFn *tell, void *user, vlError *error) {
  if (!scene || !tell)
    return vl_fail_argument(error, "scene diagnose: scene or tell is null");
  scene->problem = tell;
  scene->problem_user = user;
  vlResult result = vl_scene_load(scene, path, def, error);
  scene->problem = NULL;
  return result;
}
