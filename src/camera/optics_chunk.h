/* camera/optics_chunk.h: batches of points through a lens of many elements. Not hot: each point
 * needs an iterative search. */
#ifndef CAMERA_OPTICS_CHUNK_H
#define CAMERA_OPTICS_CHUNK_H

#include "camera/rays.h"

/* The parameters are those of the kernels in vlCameraKernels; count is padded. */
void vl_optics_unproject_chunk(const vlCameraCompiled *c, uint32_t count,
                               const vlCameraPixels *in, vlCameraPoints *out);
void vl_optics_project_chunk(const vlCameraCompiled *c, uint32_t count,
                             const vlCameraPoints *in, vlCameraPixels *out);

#endif
