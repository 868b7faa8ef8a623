/* scene/faces.h: the triangles of a scene in world space, those in groups left out. */
#ifndef SCENE_FACES_H
#define SCENE_FACES_H

#include "scene/scene.h"
#include "velo/shape_kinds.h"

typedef struct vlFace {
  const vlShapeDef *shape;
  double corners[3][3];
  double area[3];   /* half of the cross product of the edges: the outside's direction, and its
                       length is the area */
  double size;      /* the length of `area`, which is finite and more than 0 */
  double middle[3]; /* the corners' mean */
} vlFace;

/* Triangles without an area are not visited. */
typedef void vlFaceVisit(void *user, const vlFace *face);
void vl_faces_visit(const vlScene *scene, vlFaceVisit *visit, void *user);
/* Whether a shape, also one in a group, is seen from one side only. */
bool vl_faces_one_sided(const vlScene *scene);

#endif
