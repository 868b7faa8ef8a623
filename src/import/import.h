/* import/import.h: importers read files of other formats into scenes. This is the interface of
 * the room. The scene keeps the first error with its line in the file; warnings go to the
 * context's log. */
#ifndef IMPORT_IMPORT_H
#define IMPORT_IMPORT_H

#include "velo/load.h"
#include "velo/scene_base.h"

/* X(suffix, name) for each suffix of scene files; vl_import_NAME reads them. def may be
 * null. */
#define VL_SCENE_FORMATS(X) \
  X(".pbrt", pbrt)          \
  X(".pbrt.gz", pbrt)       \
  X(".gltf", gltf)          \
  X(".glb", gltf)           \
  X(".obj", obj)            \
  X(".obj.gz", obj)         \
  X(".ply", ply)            \
  X(".ply.gz", ply)         \
  X(".stl", stl)            \
  X(".stl.gz", stl)         \
  X(".off", off)            \
  X(".off.gz", off)
#define VL_DECLARE_IMPORT(suffix, name)                                             \
  vlResult vl_import_##name(vlScene *scene, const char *path, const vlLoadDef *def, \
                            vlError *error);
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
