/* import/pbrt/loop.h: Loop subdivision of a triangle mesh to its limit surface (Loop 1987; rules for borders and limit
 * masks as in "Physically Based Rendering", 3rd edition, 3.8): what pbrt's shape "loopsubdiv" is. */
#ifndef IMPORT_PBRT_LOOP_H
#define IMPORT_PBRT_LOOP_H

#include "base/context.h"

typedef struct vlLoopMesh {
  uint32_t vertices, faces;
  float *positions, *normals; /* 3 a vertex, on the limit surface; normals as pbrt has them: against the winding, and
                                 not normalised */
  uint32_t *indices;          /* 3 a face */
} vlLoopMesh;

/* Indices must be in range. Arrays are blocks of the context. Errors: MEMORY; SCENE (faces that cannot be part of a
 * surface, too many faces) with a message in error. */
vlResult vl_loop_subdivide(vlContext *context, uint32_t vertices, const float *positions, uint32_t faces,
                           const uint32_t *indices, uint32_t levels, vlLoopMesh *mesh, vlError *error);

#endif
