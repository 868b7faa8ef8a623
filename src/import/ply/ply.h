/* import/ply/ply.h: meshes in PLY files (ASCII, binary of both byte orders, gzip) become
 * meshes. Triangles remain triangles, faces of four corners become bilinear patches as in pbrt,
 * and larger faces become fans of triangles. Counts in the header are checked against the
 * number of bytes in the file. */
#ifndef IMPORT_PLY_PLY_H
#define IMPORT_PLY_PLY_H

#include "base/cancel.h"
#include "import/mesh.h"

typedef struct vlPlyOptions {
  vlTask *task; /* of the load, which stops with CANCELLED; null: none */
  bool given;   /* the caller names the file (base/file.h), which is a whole scene: faces keep
                   their colours, and without faces it is a cloud of points */
  bool broken;  /* normals and uvs that are not finite are no error (import/repair.h) */
} vlPlyOptions;

/* Colours are converted from the file's sRGB; those of a file that a scene names are left out.
 * Errors: MISSING, IO, MEMORY, SCENE (with the line number in text files and headers). */
vlResult vl_ply_read(vlContext *context, const char *path, const vlPlyOptions *options,
                     vlMesh *mesh, vlError *error);
/* Reads from memory, with colours. name is used in errors. data[size] must be a zero byte; data
 * is not changed. */
vlResult vl_ply_parse(vlContext *context, const char *name, const char *data, size_t size,
                      const vlPlyOptions *options, vlMesh *mesh, vlError *error);

#endif
