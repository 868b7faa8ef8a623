/* import/ply/ply.h: meshes in PLY files (ASCII, binary of both byte orders, gzip) to plain arrays. Triangles stay,
 * faces of four corners become bilinear patches as in pbrt, larger faces become fans. What a header promises is
 * believed only as far as the file's bytes can hold it. */
#ifndef IMPORT_PLY_PLY_H
#define IMPORT_PLY_PLY_H

#include "base/context.h"
#include "velo/base.h"

typedef struct vlPlyMesh {
  uint32_t vertices, triangles, quads;
  float *positions;           /* 3 a vertex */
  float *normals, *uvs;       /* 3, 2 a vertex, or null */
  float *colors;              /* 4 a vertex, linear (the file's are in sRGB), or null */
  uint32_t *triangle_indices; /* 3 a triangle */
  uint32_t *quad_indices;     /* 4 a patch, p00 p10 p01 p11 */
} vlPlyMesh;

/* All arrays are blocks of the context. Errors: MISSING, IO, MEMORY, SCENE (with the line for text and header). _given:
 * a file that the caller names himself, with its colours (base/file.h). */
vlResult vl_ply_read_given(vlContext *context, const char *path, vlPlyMesh *mesh, vlError *error);
/* A file that a scene names, without colours. */
vlResult vl_ply_read(vlContext *context, const char *path, vlPlyMesh *mesh, vlError *error);
/* name: for errors. data[size] must be a zero byte; it is not changed. */
vlResult vl_ply_parse(vlContext *context, const char *name, const char *data, size_t size, vlPlyMesh *mesh,
                      vlError *error);
void vl_ply_free(vlContext *context, vlPlyMesh *mesh);

#endif
