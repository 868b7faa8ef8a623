/* scene/extent.h: where the things of a scene are: points on them, and their bounding boxes. */
#ifndef SCENE_EXTENT_H
#define SCENE_EXTENT_H

#include "math/extent.h"
#include "math/transform.h"
#include "scene/scene.h"

/* Receives a point in world space. */
typedef void vlPointVisit(void *user, const double p[3]);
/* The box of one of many spheres, in the shape's space. */
vlExtent vl_extent_of_sphere(const vlShapeDef *shape, size_t i);
/* The corners of a triangle under a map (null: in the shape's space), and its normal as their
 * order gives it; its length is twice the area. */
void vl_mesh_face(const vlShapeDef *shape, const vlMat4 *m, size_t face, double p[3][3],
                  double n[3]);
/* Calls `visit` with the eight corners of a box, transformed. */
void vl_extent_visit_box(const vlMat4 *m, const vlExtent *box, vlPointVisit *visit, void *user);
/* Calls `visit` with all points of a shape, or the corners of its box, in the world. null: in
 * group space. */
void vl_extent_visit_shape(const vlShapeDef *shape, const vlMat4 *world_from_group,
                           vlPointVisit *visit, void *user);
/* The bounding boxes of the groups, in group space, and after them, at index groups.count, the
 * limits of what vl_extent_visit visits, in world space: everything; the caller frees the
 * array. False: the scene holds the error. */
bool vl_extent_groups(vlScene *scene, vlExtent **boxes);
/* Calls `visit` with points of the scene: several thousand vertices of each mesh, and the
 * corners of the boxes of other shapes and of instances. A file that moves gives points of all
 * its times instead. boxes: those of the groups, and the limits within which points are
 * visited. without[i]: shape i is left out; null: none is. */
void vl_extent_visit(const vlScene *scene, const vlExtent *boxes, const bool *without,
                     vlPointVisit *visit, void *user);

#endif
