/* import/points.h: meshes of files of plain geometry; clouds of points become such meshes. */
#ifndef IMPORT_POINTS_H
#define IMPORT_POINTS_H

#include "base/context.h"

/* A mesh of triangles. All arrays are blocks of the scene's context, which the call takes,
 * also on failure. */
typedef struct vlPlainMesh {
  uint32_t vertices, triangles;
  float *positions, *normals, *uvs; /* 3, 3, 2 per vertex; normals and uvs may be null */
  float *colors;                    /* 4 per vertex, linear, or null */
  float *face_colors;               /* 3 per triangle, linear, or null; colors go before */
  uint32_t *indices;                /* 3 per triangle */
  double origin[3];                 /* of the positions (far.h) */
} vlPlainMesh;

/* Replaces the vertices of a mesh without triangles by discs or balls. path: for the note.
 * False: memory is exhausted, or there are too many points; the mesh is as before. */
bool vl_import_points(vlContext *context, const char *path, vlPlainMesh *mesh);

#endif
