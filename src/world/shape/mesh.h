/* world/shape/mesh.h: what triangle meshes and meshes of bilinear patches share. */
#ifndef WORLD_SHAPE_MESH_H
#define WORLD_SHAPE_MESH_H

#include "world/shape/kinds.h"

/* Copies vertices, transformed to group space, and faces; at all times for a mesh that moves. */
vlResult vl_mesh_compile(vlWorld *world, const vlShapeDef *def, const vlMat4 *to_group, const vlMat4 *from_group,
                         vlWorldShape *shape, vlError *error);
/* Extends low and high by the corners of a face. */
void vl_mesh_bounds(const vlWorldShape *shape, uint32_t corners, uint32_t prim, double low[3], double high[3]);

#endif
