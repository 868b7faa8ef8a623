/* shape/displace.h: displaced meshes, for shapes.c. */
#ifndef SHAPE_DISPLACE_H
#define SHAPE_DISPLACE_H

#include "math/transform.h"
#include "scene/scene.h"
#include "world/world.h"

/* Makes *fine: a copy of *def whose mesh is subdivided and displaced, in shape space. The
 * caller frees the arrays of *fine with vl_world_displace_free. m: group from shape. Errors:
 * SCENE (too many triangles), MEMORY. */
vlResult vl_world_displace(vlWorld *world, const vlScene *scene, const vlShapeDef *def,
                           const vlMat4 *m, vlShapeDef *fine, vlError *error);
void vl_world_displace_free(vlWorld *world, const vlShapeDef *fine);

#endif
