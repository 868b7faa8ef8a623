/* scene/stray.h: parts of a model that are far away from the rest, and small: a triangle that
 * was left behind, an object at the origin of another file. */
#ifndef SCENE_STRAY_H
#define SCENE_STRAY_H

#include "scene/extent.h"

/* Finds the box of a scene without its stray parts. Begins with a core: the box, axis by axis,
 * outside of which there are on each side at most 2 thousandths of the surface. Everything that
 * is no further from it than its diagonal belongs to it and makes it larger, until nothing else
 * does; what is left is stray. So masts that are connected, grounds and scattered objects
 * belong to the model. Leaves boxes[scene->groups.count], the limits of vl_extent_visit, as
 * they are where nothing is stray, and of files that move. boxes: those of the groups. *count:
 * the number of faces, instances and other shapes that are stray. */
void vl_stray_limit(const vlScene *scene, vlExtent *boxes, uint64_t *count);

#endif
