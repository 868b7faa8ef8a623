/* import/import.h: importers: files of other formats become scenes. The interface of this room. Errors are kept in the
 * scene (sticky) with their place; warnings go to the context's log. */
#ifndef IMPORT_IMPORT_H
#define IMPORT_IMPORT_H

#include "velo/scene.h"

/* X(suffix, name) for each suffix of scene files; vl_import_NAME reads them. def may be null. */
#define VL_SCENE_FORMATS(X) \
  X(".pbrt", pbrt)          \
  X(".pbrt.gz", pbrt)       \
  X(".gltf", gltf)          \
  X(".glb", gltf)           \
  X(".obj", obj)            \
  X(".obj.gz", obj)         \
  X(".ply", ply)            \
  X(".ply.gz", ply)
#define VL_DECLARE_IMPORT(suffix, name) \
  vlResult vl_import_##name(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);
VL_SCENE_FORMATS(VL_DECLARE_IMPORT)
#undef VL_DECLARE_IMPORT

/* pbrt: a pbrt-v4 scene file, gzip or plain. gltf: a glTF 2.0 file, by its content; where it has no camera or light the
 * scene's defs say so. obj, ply: plain geometry, Wavefront OBJ with its MTL libraries, and PLY; the scene's defs say
 * that camera and light are missing. */

/* A pbrt-v4 scene from memory; `name` stands for the file in errors and gives the folder of relative names. data is
 * copied. */
vlResult vl_import_pbrt_memory(vlScene *scene, const char *data, size_t size, const char *name, const vlLoadDef *def,
                               vlError *error);

#endif
