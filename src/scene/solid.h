/* scene/solid.h: closed bodies of a group to ask whether a point is in them: whole spheres and the closed parts of
 * meshes. */
#ifndef SCENE_SOLID_H
#define SCENE_SOLID_H

#include "math/transform.h"
#include "scene/mesh_solid.h"

typedef struct vlSolid {
  const vlShapeDef *shape; /* the (first) one */
  bool sphere;
  vlMat4 shape_from_group; /* sphere */
  vlMeshSolid body;        /* meshes; freed by vl_solid_free */
} vlSolid;

/* false: out of memory. Not closed at all: no point is inside. */
bool vl_solid_make(const vlScene *scene, const uint32_t *shapes, size_t count, vlSolid *solid);
void vl_solid_free(const vlScene *scene, vlSolid *solid);
/* p in group space. */
bool vl_solid_holds(const vlSolid *solid, const double p[3]);
/* The box of one shape in group space. */
/* The sphere k of many (vlShapeDef.centers) as a shape of its own. */
vlShapeDef vl_shape_one_sphere(const vlShapeDef *d, uint32_t k);
void vl_shape_box(const vlShapeDef *d, double low[3], double high[3]);
/* Point i of n on the solid's surface, a thousandth nearer to its middle. */
void vl_solid_sample(const vlSolid *solid, uint32_t i, uint32_t n, double p[3]);

#endif
