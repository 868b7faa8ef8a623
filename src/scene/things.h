/* scene/things.h: the things that a scene consists of: the faces of its meshes, the spheres of
 * many, instances, and shapes of all other kinds. */
#ifndef SCENE_THINGS_H
#define SCENE_THINGS_H

#include "scene/extent.h"

/* A thing in world space. */
typedef struct vlThing {
  vlExtent box;
  vlExtent body;  /* of a needle (a face with one edge below a tenth of the two others) the box
                     of this edge: where the face is, but for its tip; of all others `box` */
  double surface; /* of what is no face, that of its box */
} vlThing;

typedef void vlThingVisit(void *user, const vlThing *thing);
/* Calls `visit` with all things. boxes: those of the groups. */
void vl_things_visit(const vlScene *scene, const vlExtent *boxes, vlThingVisit *visit,
                     void *user);
/* Whether they are at most 8 million faces, instances not counted: more are not examined. */
bool vl_things_are_few(const vlScene *scene);

#endif
