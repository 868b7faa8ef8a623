/* import/import.h: files of other people to a scene. The face of this room. Errors land in the scene (sticky) with
 * their place; warnings go to the context's log. */
#ifndef IMPORT_IMPORT_H
#define IMPORT_IMPORT_H

#include "velo/scene.h"

/* A pbrt-v4 scene file, gzip or plain. def may be null. */
vlResult vl_import_pbrt(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);
/* The same from memory; `name` stands for the file in errors and gives the folder of relative names. data is copied. */
vlResult vl_import_pbrt_memory(vlScene *scene, const char *data, size_t size, const char *name, const vlLoadDef *def,
                               vlError *error);

/* A glTF 2.0 file (.gltf or .glb, by its content). Where it has no camera or light the scene's defs say so. */
vlResult vl_import_gltf(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);

/* Plain geometry: Wavefront OBJ with its MTL libraries, and PLY. The scene's defs say that camera and light are
 * missing. */
vlResult vl_import_obj(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);
vlResult vl_import_ply(vlScene *scene, const char *path, const vlLoadDef *def, vlError *error);

#endif
