/* scene/mesh_solid.h: a solid: all shapes of one material (and media) in one group, as
 * triangles whose vertices are welded by position. Functions determine whether the solid is
 * closed, to which side its normals point, and whether a point is inside. */
#ifndef SCENE_MESH_SOLID_H
#define SCENE_MESH_SOLID_H

#include "math/extent.h"
#include "scene/scene.h"

/* A part of a solid: the faces that are connected by shared corners. */
typedef struct vlMeshSolidPart {
  uint32_t faces, open_edges;
  double volume; /* signed volume: positive if normals point outwards; meaningless for open
                    parts */
  vlExtent box;
} vlMeshSolidPart;

typedef struct vlMeshSolid {
  uint32_t corners, faces;
  double *points;   /* 3 per corner, group space */
  uint32_t *faces3; /* 3 corners per face, counter-clockwise seen from the lit outside */
  uint32_t *part;   /* part of each face */
  vlMeshSolidPart *parts;
  uint32_t part_count;
} vlMeshSolid;

/* Makes a solid of triangles and bilinear patches (two triangles each); shapes of other kinds
 * are ignored. shapes: indices into scene->shapes. False: out of memory. The caller must free
 * the solid in either case. */
bool vl_mesh_solid_make(const vlScene *scene, const uint32_t *shapes, size_t count,
                        vlMeshSolid *solid);
void vl_mesh_solid_free(const vlScene *scene, vlMeshSolid *solid);
/* Winding number of the closed surface around p (group space): 0 outside, 1 inside, -1 inside
 * an inverted surface. The number of signed crossings of one ray from p. only: the part whose
 * crossings are counted; UINT32_MAX: all parts. */
int vl_mesh_solid_winding(const vlMeshSolid *solid, const double p[3], uint32_t part);

#endif
