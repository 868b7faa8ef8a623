/* shape/mesh.h: what triangle meshes and meshes of bilinear patches share. */
#ifndef SHAPE_MESH_H
#define SHAPE_MESH_H

#include "shape/shape_kind.h"

/* Copies the faces, and the vertices transformed to group space. The vertices of a moving mesh
 * are copied for every time step. */
vlResult vl_mesh_compile(vlWorld *world, const vlShapeDef *def, const vlMat4 *to_group,
                         const vlMat4 *from_group, vlWorldShape *shape, vlError *error);
/* Extends the box [low, high] by the corners of a face. corners: indices per face, 3 or 4. */
void vl_mesh_bounds(const vlWorldShape *shape, uint32_t corners, uint32_t prim, double low[3],
                    double high[3]);

#endif
