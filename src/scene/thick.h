/* scene/thick.h: rooms whose walls have an outside of their own: from outside they are boxes
 * that show nothing of what is in them. */
#ifndef SCENE_THICK_H
#define SCENE_THICK_H

#include "scene/probe.h"
#include "velo/shape.h"

/* The box of the walls' outside, and that of their inside. */
typedef struct vlThick {
  vlExtent outer, inner;
} vlThick;

/* Whether the rays, which are cast, say so: from the eye nearly all meet the
 * scene's box on its faces; from a point inside they meet walls all around, behind which the
 * box ends, and something else than walls. middle: becomes that point. */
bool vl_thick_find(const vlProbe *s, const vlExtent *box, vlThick *thick, double middle[3]);
/* Whether a face with these corners belongs to a wall between the eye and the inside. */
bool vl_thick_hides(const vlThick *thick, const double corners[3][3], const double eye[3]);

#endif
