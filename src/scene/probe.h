/* scene/probe.h: several hundred rays at the meshes of a scene: from the camera, and from
 * points near the scene's middle all around. */
#ifndef SCENE_PROBE_H
#define SCENE_PROBE_H

#include "math/transform.h"
#include "scene/extent.h"

enum {
  VL_PROBE_OUTSIDE = 160, /* rays from the eye, the first ones */
  VL_PROBE_POINTS = 7,    /* points near the middle */
  VL_PROBE_AROUND = 48,   /* rays from each of them */
  VL_PROBE_RAYS = VL_PROBE_OUTSIDE + VL_PROBE_POINTS * VL_PROBE_AROUND
};

/* A mesh with its transform to the world. */
typedef struct vlProbeMesh {
  const vlShapeDef *def;
  const vlExtent *blocks; /* the shape's */
  size_t shape;           /* its index */
  vlMat4 to_shape;
  bool flip, fixed; /* fixed: not an instance */
  vlExtent box;
} vlProbeMesh;

typedef struct vlSeen {
  double t;
  const vlProbeMesh *placed; /* null: nothing */
  bool back;
} vlSeen;

typedef struct vlProbe {
  vlProbeMesh *placed;
  size_t count;
  vlExtent **blocks; /* of each shape: the box of each BLOCK of its faces; null where they are
                        not made */
  double o[VL_PROBE_RAYS][3], d[VL_PROBE_RAYS][3];
  vlSeen seen[VL_PROBE_RAYS];
} vlProbe;

/* Makes the meshes of a scene ready for rays. False: memory is exhausted, or there are none or
 * more than 8 million faces. *s is zero before, and freed by vl_probe_free in either case. */
bool vl_probe_make(const vlScene *scene, vlProbe *s);
void vl_probe_free(const vlScene *scene, vlProbe *s);
/* Sets all rays: from the eye to points in the box, and from points near the box's middle. */
void vl_probe_aim(vlProbe *s, const vlExtent *box, const double eye[3]);
/* Finds what the first `count` rays meet. */
void vl_probe_cast(const vlScene *scene, vlProbe *s, uint32_t count);

#endif
