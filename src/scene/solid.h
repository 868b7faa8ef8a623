/* scene/solid.h: closed solids of a group, and whether a point is inside one: whole spheres and the closed parts of
 * meshes. */
#ifndef SCENE_SOLID_H
#define SCENE_SOLID_H

#include "math/transform.h"
#include "scene/mesh_solid.h"

typedef struct vlSolid {
  const vlShapeDef *shape; /* the first shape */
  bool sphere;
  vlMat4 shape_from_group; /* spheres only */
  vlMeshSolid meshes;      /* meshes only; freed by vl_solid_free */
} vlSolid;

/* False: out of memory. An open solid contains no point. */
bool vl_solid_make(const vlScene *scene, const uint32_t *shapes, size_t count, vlSolid *solid);
void vl_solid_free(const vlScene *scene, vlSolid *solid);
/* Whether p (group space) is inside. */
bool vl_solid_holds(const vlSolid *solid, const double p[3]);
/* The sphere k of many (vlShapeDef.centers) as a shape of its own. */
vlShapeDef vl_shape_one_sphere(const vlShapeDef *d, uint32_t k);
/* The box of one shape in group space. */
void vl_shape_box(const vlShapeDef *d, double low[3], double high[3]);
/* Point i of n on the solid's surface, moved towards its centre by a thousandth of the distance. */
void vl_solid_sample(const vlSolid *solid, uint32_t i, uint32_t n, double p[3]);

#endif
