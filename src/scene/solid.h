/* scene/solid.h: closed solids in a group of shapes: whole spheres and closed parts of meshes.
 * It determines whether a point is inside a solid. */
#ifndef SCENE_SOLID_H
#define SCENE_SOLID_H

#include "math/transform.h"
#include "scene/mesh_solid.h"

typedef struct vlSolid {
  const vlShapeDef *shape; /* the first shape of the solid */
  bool sphere;
  vlMat4 shape_from_group; /* only set for spheres */
  vlMeshSolid meshes;      /* only set for meshes; vl_solid_free frees it */
} vlSolid;

/* Makes a solid of `count` shapes of the scene; shapes: their indices. An open solid contains
 * no point. False: out of memory. */
bool vl_solid_make(const vlScene *scene, const uint32_t *shapes, size_t count, vlSolid *solid);
void vl_solid_free(const vlScene *scene, vlSolid *solid);
/* Whether the point p (group space) is inside the solid. */
bool vl_solid_holds(const vlSolid *solid, const double p[3]);
/* Sphere k of a shape of many spheres (vlShapeDef.centers), as a separate shape. */
vlShapeDef vl_shape_one_sphere(const vlShapeDef *d, uint32_t k);
/* The bounding box of a shape, in group space. */
vlExtent vl_shape_box(const vlShapeDef *d);
/* Gives point i of n points on the solid's surface, in group space. The points are moved
 * towards the solid's centre by a thousandth of their distance from it. */
void vl_solid_sample(const vlSolid *solid, uint32_t i, uint32_t n, double p[3]);

#endif
