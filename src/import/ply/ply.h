/* import/ply/ply.h: meshes in PLY files (ASCII, binary of both byte orders, gzip) become plain
 * arrays. Triangles remain triangles, faces of four corners become bilinear patches as in pbrt,
 * and larger faces become fans of triangles. Counts in the header are checked against the
 * number of bytes in the file. */
#ifndef IMPORT_PLY_PLY_H
#define IMPORT_PLY_PLY_H

#include "base/cancel.h"
#include "base/context.h"
#include "velo/base.h"

typedef struct vlPlyMesh {
  uint32_t vertices, triangles, quads;
  float *positions;     /* 3 per vertex, about `origin` */
  double origin[3];     /* 0, but of files that the caller names (import/far.h) */
  float *normals, *uvs; /* 3, 2 per vertex, or null */
  float *colors;        /* 4 per vertex, linear (converted from the file's sRGB), or null */
  float *face_colors; /* 3 per triangle, linear, or null; only of files that the caller names */
  uint32_t *triangle_indices; /* 3 per triangle */
  uint32_t *quad_indices;     /* 4 per patch: p00 p10 p01 p11 */
} vlPlyMesh;

/* All arrays are blocks of the context. Errors: MISSING, IO, MEMORY, SCENE (with the line
 * number in text files and headers). vl_ply_read_given reads a file that the caller names
 * (base/file.h), with its colours; without faces it is a cloud of points. task: of the load,
 * which stops with CANCELLED; null: none. broken: normals and uvs that are not finite are no
 * error (import/repair.h). */
vlResult vl_ply_read_given(vlContext *context, vlTask *task, const char *path, bool broken,
                           vlPlyMesh *mesh, vlError *error);
/* Reads a file that a scene names, without colours. */
vlResult vl_ply_read(vlContext *context, vlTask *task, const char *path, bool broken,
                     vlPlyMesh *mesh, vlError *error);
/* Reads from memory. name is used in errors. data[size] must be a zero byte; data is not
 * changed. */
vlResult vl_ply_parse(vlContext *context, const char *name, const char *data, size_t size,
                      vlPlyMesh *mesh, vlError *error);
/* Appends each patch to the triangles, as two of them. False: memory is exhausted; the mesh is
 * as before. */
bool vl_ply_split_quads(vlContext *context, vlPlyMesh *mesh);
void vl_ply_free(vlContext *context, vlPlyMesh *mesh);

#endif
