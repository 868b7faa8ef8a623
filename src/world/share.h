/* world/share.h: finds the shapes of the previous world whose geometry a shape has, too
 * (vlBuildDef.previous). */
#ifndef WORLD_SHARE_H
#define WORLD_SHARE_H

#include "world/world.h"

struct vlShapeSearch;

/* Whether shape `index` of the scene has the geometry that it had in the previous world, as
 * their ids tell. If so, the shape gets it; *done. The members of *s that belong to this world
 * alone must be set. False: out of memory. */
bool vl_shape_reuse(vlWorld *world, const struct vlScene *scene, size_t index, vlWorldShape *s,
                    bool *done);
/* The same by comparison with the geometry that was compiled for *s as the part that was added
 * last. If a shape of the previous world has the same, that part is dropped. False: out of
 * memory. */
bool vl_shape_match(vlWorld *world, size_t index, vlWorldShape *s);
/* Whether shape i of a world and shape j of the previous world look the same to the
 * accelerator. */
bool vl_shape_same(const vlWorld *world, size_t i, const vlWorld *previous, size_t j);

#endif
