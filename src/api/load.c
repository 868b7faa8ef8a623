/* api/load.c: vl_scene_load: chooses the importer by the file name; reads velo's camera description in glTF files. */
#include <string.h>
#include <sys/stat.h>

#include "base/cookie.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "import/import.h"
#include "scene/scene.h"
#include "velo/camera_file.h"

/* A glTF camera is a pinhole camera. Velo's exporter writes the full camera into the extras. */
static vlResult load_gltf(vlScene *scene, const char *path, const vlLoadDef *load, vlError *error) {
  vlResult result = vl_import_gltf(scene, path, load, error);
  if (result != VL_OK || !scene->camera_in_full) return result;
  vlCameraFileDef def = vl_default_camera_file_def();
  def.dialect = VL_CAMERA_DIALECT_GLTF;
  def.frame = load ? load->camera : NULL;
  vlCameraRecord record;
  vlError inside;
  vl_error_clear(&inside);
  result = vl_camera_read(scene->context, path, &def, &record, &inside);
  if (result != VL_OK) {
    vl_scene_fail(scene, result, (vlSource){inside.file[0] ? inside.file : path, inside.line, inside.column}, "%s",
                  inside.message[0] ? inside.message : vl_result_name(result));
    return vl_scene_result(scene, error);
  }
  vlFilmDef *film = &scene->defs.film;
  const uint32_t whole[4] = {0, 0, record.camera.width, record.camera.height};
  film->width = whole[2], film->height = whole[3];
  memcpy(film->crop, whole, sizeof whole);
  scene->defs.camera = record.camera;
  return VL_OK;
}

vlResult vl_scene_load(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error) {
  vl_error_clear(error);
  if (!scene || !path) return vl_fail(error, VL_ERROR_ARGUMENT, "vl_scene_load needs a scene and a path");
  if (def && def->cookie != VL_COOKIE_LOAD)
    return vl_fail(error, VL_ERROR_ARGUMENT, "the def does not come from vl_default_load_def()");
  if (scene->error.code != VL_OK) return vl_scene_result(scene, error);
  struct stat info;
  bool readable = stat(path, &info) == 0 && !S_ISDIR(info.st_mode);
  if (!readable || vl_ends_with(path, ".pbrt") || vl_ends_with(path, ".pbrt.gz"))
    return vl_import_pbrt(scene, path, def, error);
  if (vl_ends_with(path, ".gltf") || vl_ends_with(path, ".glb")) return load_gltf(scene, path, def, error);
  if (vl_ends_with(path, ".obj") || vl_ends_with(path, ".obj.gz")) return vl_import_obj(scene, path, def, error);
  if (vl_ends_with(path, ".ply") || vl_ends_with(path, ".ply.gz")) return vl_import_ply(scene, path, def, error);
  vl_scene_fail(scene, VL_ERROR_SCENE, (vlSource){0},
                "%.300s: unknown kind of scene file (known: .pbrt, .pbrt.gz, .gltf, .glb, .obj, .ply)", path);
  return vl_scene_result(scene, error);
}
