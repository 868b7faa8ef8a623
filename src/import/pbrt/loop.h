/* import/pbrt/loop.h: Loop subdivision of a triangle mesh to its limit surface (Loop 1987;
 * border rules and limit masks as in "Physically Based Rendering", 3rd edition, 3.8): pbrt's
 * shape "loopsubdiv". */
#ifndef IMPORT_PBRT_LOOP_H
#define IMPORT_PBRT_LOOP_H

#include "import/mesh.h"

/* Subdivides `levels` times. Indices must be in range. The result has positions and normals on
 * the limit surface; as in pbrt, normals are opposite to the winding and not normalised.
 * Errors: MEMORY; SCENE, with a message in `error`, for a mesh that is not a surface or has too
 * many faces. */
vlResult vl_loop_subdivide(vlContext *context, uint32_t vertices, const float *positions,
                           uint32_t faces, const uint32_t *indices, uint32_t levels,
                           vlMesh *mesh, vlError *error);

#endif
