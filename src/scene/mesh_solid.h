/* scene/mesh_solid.h: a solid: all shapes of one material (and media) in one group, as triangles whose vertices are
 * welded by position. It tells whether the solid is closed, which way its normals point, and whether a point is inside.
 */
#ifndef SCENE_MESH_SOLID_H
#define SCENE_MESH_SOLID_H

#include "scene/scene.h"

/* A part: faces connected by shared corners. */
typedef struct vlMeshSolidPart {
  uint32_t faces, open_edges;
  double volume; /* signed: positive when normals point outwards; meaningless for open parts */
  double low[3], high[3];
} vlMeshSolidPart;

typedef struct vlMeshSolid {
  uint32_t corners, faces;
  double *points;   /* 3 per corner, group space */
  uint32_t *faces3; /* 3 corners per face, counter-clockwise seen from the lit outside */
  uint32_t *part;   /* part of each face */
  vlMeshSolidPart *parts;
  uint32_t part_count;
} vlMeshSolid;

/* Makes a solid of triangles and bilinear patches (two triangles each); other shapes are ignored. shapes: indices in
 * scene->shapes. False: out of memory. The solid must be freed in any case. */
bool vl_mesh_solid_make(const vlScene *scene, const uint32_t *shapes, size_t count, vlMeshSolid *solid);
void vl_mesh_solid_free(const vlScene *scene, vlMeshSolid *solid);
/* Winding number of the closed surface around p (group space): 0 outside, 1 inside, -1 inside an inverted surface.
 * Counts the signed crossings of one ray. only: the part that counts, or UINT32_MAX for all. */
int vl_mesh_solid_winding(const vlMeshSolid *solid, const double p[3], uint32_t part);

#endif
