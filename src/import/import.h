/* import/import.h: importers read files of other formats into scenes. This is the interface of
 * the room. The scene keeps the first error with its line in the file; warnings go to the
 * context's log. */
#ifndef IMPORT_IMPORT_H
#define IMPORT_IMPORT_H

#include "velo/load.h"
#include "velo/scene_base.h"

/* X(suffix, function) for each suffix of scene files, with the function that reads them. def
 * may be null. */
#define VL_SCENE_FORMATS(X)     \
  X(".pbrt", vl_import_pbrt)    \
  X(".pbrt.gz", vl_import_pbrt) \
  X(".gltf", vl_import_gltf)    \
  X(".glb", vl_import_gltf)     \
  X(".obj", vl_import_obj)      \
  X(".obj.gz", vl_import_obj)   \
  X(".ply", vl_import_ply)      \
  X(".ply.gz", vl_import_ply)   \
  X(".stl", vl_import_stl)      \
  X(".stl.gz", vl_import_stl)   \
  X(".off", vl_import_off)      \
  X(".off.gz", vl_import_off)
#define VL_DECLARE_IMPORT(suffix, function) \
  vlResult function(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);
VL_SCENE_FORMATS(VL_DECLARE_IMPORT)
#undef VL_DECLARE_IMPORT

/* pbrt: a pbrt-v4 scene file, plain or compressed by gzip. gltf: a glTF 2.0 file, .gltf or .glb
 * as its content shows; the scene's defs are marked when camera or lights are missing. obj,
 * ply, stl, off: geometry without camera and lights; the scene's defs are marked
 * accordingly. */

/* A pbrt-v4 scene from memory; errors use `name` as the file's name, and relative file names
 * start from its folder. data is copied. */
vlResult vl_import_pbrt_memory(vlScene *scene, const char *data, size_t size, const char *name,
                               const vlLoadDef *def, vlError *error);

/* The same with the text of included files: pairs of a name, as Include gives it, and its text.
 * Such a file need not exist; others are read from the disk. */
vlResult vl_import_pbrt_texts(vlScene *scene, const char *path, const char *text,
                              const char *const *texts, size_t count, const vlLoadDef *def,
                              vlError *error);

#endif
