/* import/points.h: clouds of points become meshes of triangles. */
#ifndef IMPORT_POINTS_H
#define IMPORT_POINTS_H

#include "import/mesh.h"

/* Replaces the vertices of a mesh without triangles by discs or balls. path: for the note.
 * False: memory is exhausted, or there are too many points. */
bool vl_import_points(vlContext *context, const char *path, vlMesh *mesh);

#endif
