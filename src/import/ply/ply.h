/* import/ply/ply.h: meshes in PLY files (ASCII, binary of both byte orders, gzip) become
 * meshes. Triangles remain triangles, faces of four corners become bilinear patches as in pbrt,
 * and larger faces become fans of triangles. Counts in the header are checked against the
 * number of bytes in the file. */
#ifndef IMPORT_PLY_PLY_H
#define IMPORT_PLY_PLY_H

#include "base/cancel.h"
#include "import/mesh.h"

/* Colours are converted from the file's sRGB. Errors: MISSING, IO, MEMORY, SCENE (with the line
 * number in text files and headers). vl_ply_read_given reads a file that the caller names
 * (base/file.h), with its colours; without faces it is a cloud of points. task: of the load,
 * which stops with CANCELLED; null: none. broken: normals and uvs that are not finite are no
 * error (import/repair.h). */
vlResult vl_ply_read_given(vlContext *context, vlTask *task, const char *path, bool broken,
                           vlMesh *mesh, vlError *error);
/* Reads a file that a scene names, without colours. */
vlResult vl_ply_read(vlContext *context, vlTask *task, const char *path, bool broken,
                     vlMesh *mesh, vlError *error);
/* Reads from memory. name is used in errors. data[size] must be a zero byte; data is not
 * changed. */
vlResult vl_ply_parse(vlContext *context, const char *name, const char *data, size_t size,
                      vlMesh *mesh, vlError *error);

#endif
