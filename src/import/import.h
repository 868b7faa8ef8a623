/* import/import.h: importers: files of other formats become scenes. The interface of this room. Errors are kept in the
 * scene (sticky) with their place; warnings go to the context's log. */
#ifndef IMPORT_IMPORT_H
#define IMPORT_IMPORT_H

#include "velo/scene.h"

/* Reads a pbrt-v4 scene file, plain or gzip. def may be null. */
vlResult vl_import_pbrt(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);
/* The same from memory, which is copied. `name` stands for the file in errors; relative paths start at its folder. */
vlResult vl_import_pbrt_memory(vlScene *scene, const char *data, size_t size, const char *name, const vlLoadDef *def,
                               vlError *error);

/* Reads a glTF 2.0 file (.gltf or .glb, by its content). The scene's defs record a missing camera or missing lights. */
vlResult vl_import_gltf(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);

/* Reads plain geometry: Wavefront OBJ with its MTL libraries, or PLY. The scene's defs record that camera and lights
 * are missing. */
vlResult vl_import_obj(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);
vlResult vl_import_ply(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);

#endif
