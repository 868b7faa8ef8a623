/* import/points.h: clouds of points become meshes. */
#ifndef IMPORT_POINTS_H
#define IMPORT_POINTS_H

#include "import/plain.h"

/* Replaces the vertices of a mesh without triangles by discs or balls (plain.h). path: for the note. False: memory is
 * exhausted, or there are too many points; the mesh is as before. */
bool vl_import_points(vlContext *context, const char *path, vlPlainMesh *mesh);

#endif
