/* scene/posture.h: how the surface of a model is spread along the three axes: what is the same
 * mirrored, what lies flat, on what it stands. */
#ifndef SCENE_POSTURE_H
#define SCENE_POSTURE_H

#include "scene/extent.h"

/* Measures of the surface in a box, along each axis. Of points, which have no surface, each
 * counts as one, and normals are 0. Shapes in groups are left out. */
typedef struct vlPosture {
  bool points;        /* most of the model is points */
  double symmetry[3]; /* 0 to 1: the share that stays where it is if the axis is mirrored, in
                         cells of a sixteenth of the box */
  double normal[3];   /* the mean normal */
  double facing[3];   /* the mean absolute component of the normals */
  double middle[3];   /* of the mass of the surface, 0 to 1 */
  double flat[3]; /* what is at right angles to the axis, in areas of the box seen along it */
  double ends[3][2];    /* the part of it in the outermost 3 % at the low and the high end */
  double silhouette[3]; /* the surface seen along the axis, both sides, in the same unit */
  double covered[3]; /* the share of 16 x 16 cells seen along the axis with anything in them */
  double lowest[3];  /* the largest share in a layer of a sixteenth in the lowest third */
} vlPosture;

/* False: there is nothing to measure, or the scene has more than 8 million faces. */
bool vl_posture_find(const vlScene *scene, const vlExtent *box, vlPosture *posture);

#endif
