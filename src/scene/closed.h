/* scene/closed.h: models that are seen from inside: rooms with walls on all sides, domes around
 * a model. */
#ifndef SCENE_CLOSED_H
#define SCENE_CLOSED_H

#include "scene/thick.h"

typedef enum vlClosedKind {
  VL_CLOSED_NOT,   /* the model is seen from outside */
  VL_CLOSED_ROOM,  /* its walls hide it */
  VL_CLOSED_DOME,  /* a shell eight times as large as what it contains, or larger */
  VL_CLOSED_EMPTY, /* a shell that contains nothing: a panorama */
  VL_CLOSED_TURNED /* an object seen from outside whose one-sided faces look into it */
} vlClosedKind;

/* What surrounds a model. */
typedef struct vlClosed {
  vlClosedKind kind;
  /* for each shape: it is a part of the shell; null for NOT; the caller frees it */
  bool *shell;
  bool inward; /* the shell's faces look inwards */
  bool emits;  /* the shell emits light */
  bool walls;  /* a room whose walls have an outside of their own: `thick` is set */
  vlThick thick;
  double middle[3];
} vlClosed;

/* Finds out by several hundred rays: from `eye` into the scene's box, and from its middle in
 * all directions. objects: TURNED is told from the other kinds, which it else is one of. False:
 * the scene holds the error. */
bool vl_closed_find(vlScene *scene, const vlExtent *box, const vlExtent *boxes,
                    const double eye[3], bool objects, vlClosed *closed);

/* How far each of `count` rays gets until it meets a mesh, in lengths of its direction;
 * INFINITY where it meets none, or the scene has more than 8 million faces. False: the scene
 * holds the error. */
bool vl_closed_reach(vlScene *scene, const double (*from)[3], const double (*toward)[3],
                     uint32_t count, double *reach);

/* Leaves out the shell's faces between `eye` and the middle. *count: their number. False: the
 * scene holds the error. */
bool vl_closed_open(vlScene *scene, const vlClosed *closed, const double eye[3],
                    uint64_t *count);

#endif
