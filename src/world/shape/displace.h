/* world/shape/displace.h: displaced meshes, for shapes.c. */
#ifndef WORLD_SHAPE_DISPLACE_H
#define WORLD_SHAPE_DISPLACE_H

#include "math/transform.h"
#include "scene/scene.h"
#include "world/world.h"

/* *fine is *def with finer arrays of its own, in shape space; vl_world_displace_free frees them. m: group from
 * shape. Errors: SCENE (too fine), MEMORY. */
vlResult vl_world_displace(vlWorld *world, const vlScene *scene, const vlShapeDef *def, const vlMat4 *m,
                           vlShapeDef *fine, vlError *error);
void vl_world_displace_free(vlWorld *world, const vlShapeDef *fine);

#endif
