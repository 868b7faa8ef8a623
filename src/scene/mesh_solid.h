/* scene/mesh_solid.h: a body: all shapes of one material (and media) in one group, as triangles whose corners are
 * welded by position, so that it can be asked whether it is closed, which way its normals point, and whether a point is
 * in it. */
#ifndef SCENE_MESH_SOLID_H
#define SCENE_MESH_SOLID_H

#include "scene/scene.h"

/* Parts hang together by shared corners. */
typedef struct vlMeshSolidPart {
  uint32_t faces, open_edges;
  double volume; /* signed: positive where normals point outwards; of open parts of no meaning */
  double low[3], high[3];
} vlMeshSolidPart;

typedef struct vlMeshSolid {
  uint32_t corners, faces;
  double *points;   /* 3 a corner, group space */
  uint32_t *faces3; /* 3 corners a face, turned so that the normal by the right hand is the lit outside */
  uint32_t *part;   /* of each face */
  vlMeshSolidPart *parts;
  uint32_t part_count;
} vlMeshSolid;

/* Shapes are indices in scene->shapes; triangles and bilinear patches (two triangles each), others are ignored.
 * false: out of memory. Free in any case. */
bool vl_mesh_solid_make(const vlScene *scene, const uint32_t *shapes, size_t count, vlMeshSolid *body);
void vl_mesh_solid_free(const vlScene *scene, vlMeshSolid *body);
/* Winding number of the closed surface round a point, group space: 0 outside, 1 inside, -1 inside of an inverted one
 * (ray along an odd direction; crossings are counted with their sign). part: of that alone, or UINT32_MAX. */
int vl_mesh_solid_winding(const vlMeshSolid *body, const double p[3], uint32_t part);

#endif
