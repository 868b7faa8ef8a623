/* import/plain.h: defaults shared by formats that hold geometry alone (OBJ, PLY, STL, OFF). */
#ifndef IMPORT_PLAIN_H
#define IMPORT_PLAIN_H

#include "import/mesh.h"
#include "scene/scene.h"

/* Marks camera and lights as missing, so that vl_scene_complete adds them. */
void vl_import_plain_settings(vlScene *scene);

/* Sets them, and reads the file, which is freed with the context's allocator. *at, *end: its
 * bytes. False: the scene has an error. */
bool vl_import_plain_read(vlScene *scene, const char *path, char **data, const char **at,
                          const char **end);

/* Reports what is wrong at a line of a file, 0: none, with the word that is; null: none.
 * Returns false. */
bool vl_import_plain_fail(vlScene *scene, vlResult code, const char *path, uint32_t line,
                          const char *what, const char *word);

/* Adds the mesh, whose arrays it takes, to the scene, unless that has an error. Without
 * triangles its vertices are points: discs across their normals; without normals small balls.
 * The median distance to the fourth neighbour is their radius, within 1/2000 and 1/50 of the
 * diagonal. load: its permissive repairs normals and uvs; may be null. Returns vl_scene_result.
 */
vlResult vl_import_plain_mesh(vlScene *scene, const char *path, const vlLoadDef *load,
                              vlMesh *mesh, vlError *error);

#endif
