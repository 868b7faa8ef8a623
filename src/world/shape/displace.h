/* world/shape/displace.h: meshes that a texture displaces, for shapes.c. */
#ifndef WORLD_SHAPE_DISPLACE_H
#define WORLD_SHAPE_DISPLACE_H

#include "math/transform.h"
#include "scene/scene.h"
#include "world/world.h"

/* *fine is *def with finer arrays of its own, still in shape space, given back by vl_world_displace_free. m: shape to
 * group. Errors: SCENE (too fine), MEMORY. */
vlResult vl_world_displace(vlWorld *world, const vlScene *scene, const vlShapeDef *def, const vlMat4 *m,
                           vlShapeDef *fine, vlError *error);
void vl_world_displace_free(vlWorld *world, const vlShapeDef *fine);

#endif
