/* scene/body.h: a body: all shapes of one material (and media) in one group, as triangles whose corners are welded by
 * position, so that it can be asked whether it is closed, which way its normals point, and whether a point is in it. */
#ifndef SCENE_BODY_H
#define SCENE_BODY_H

#include "scene/scene.h"

/* Parts hang together by shared corners. */
typedef struct vlBodyPart {
  uint32_t faces, open_edges;
  double volume; /* signed: positive where normals point outwards; of open parts of no meaning */
  double low[3], high[3];
} vlBodyPart;

typedef struct vlBody {
  uint32_t corners, faces;
  double *points;   /* 3 a corner, group space */
  uint32_t *faces3; /* 3 corners a face, turned so that the normal by the right hand is the lit outside */
  uint32_t *part;   /* of each face */
  vlBodyPart *parts;
  uint32_t part_count;
} vlBody;

/* Shapes are indices in scene->shapes; triangles and bilinear patches (two triangles each), others are passed over.
 * false: out of memory. Free in any case. */
bool vl_body_make(const vlScene *scene, const uint32_t *shapes, size_t count, vlBody *body);
void vl_body_free(const vlScene *scene, vlBody *body);
/* Winding number of the closed surface round a point, group space: 0 outside, 1 inside, -1 inside of an inverted one
 * (ray along an odd direction; crossings are counted with their sign). part: of that alone, or UINT32_MAX. */
int vl_body_winding(const vlBody *body, const double p[3], uint32_t part);

#endif
