/* scene/things.h: the things that a scene consists of: the faces of its meshes, the spheres of
 * many, instances, and shapes of all other kinds. */
#ifndef SCENE_THINGS_H
#define SCENE_THINGS_H

#include "scene/extent.h"

/* Receives the box of a thing in world space, and its surface; of what is no face, that of its
 * box. */
typedef void vlThingVisit(void *user, const vlExtent *box, double surface);
/* Calls `visit` with all things. boxes: those of the groups. */
void vl_things_visit(const vlScene *scene, const vlExtent *boxes, vlThingVisit *visit,
                     void *user);
/* Whether they are at most 8 million faces, instances not counted: more are not examined. */
bool vl_things_are_few(const vlScene *scene);

#endif
