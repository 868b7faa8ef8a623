/* scene/tilt.h: models that lie in a plane that is at right angles to no axis: a leaning ring,
 * a solar panel, a tilted disc. */
#ifndef SCENE_TILT_H
#define SCENE_TILT_H

#include "scene/extent.h"

/* Whether the surface of a model is spread in a plane: its standard deviation along the plane's
 * unit normal n is less than an eighth of that along any line in the plane. box: of the whole
 * scene. False also of rods, and of what lies in a line. Shapes in groups are left out. */
bool vl_tilt_find(const vlScene *scene, const vlExtent *box, double n[3]);

#endif
