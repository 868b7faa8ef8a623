/* scene/upright.h: which way is up in a file that does not say it: on which side a model
 * stands. */
#ifndef SCENE_UPRIGHT_H
#define SCENE_UPRIGHT_H

#include "scene/plain.h"

/* Chooses between y and z, one of which is `up`, and changes `up` and `front` if the other axis
 * fits the model better (the front of z is -y, as modellers have it). The other axis is taken
 * if one of these holds along it, and along `up` there is no ground and no terrain:
 * - the model stands on its lowest part: a bust on its plinth, a figure on its feet, a chair;
 * - it has a ground: a plain (scene/plain.h), or the plane of a city;
 * - it is terrain, a storey, a survey in points, or consists of parts that stand side by side;
 * - top and bottom resemble each other along `up`, and differ along the other axis;
 * - it is a flat chart that looks down along `up`.
 * Otherwise, as for models that lie either way, both stay as they are. boxes: those of the
 * groups. *plains: gets the searches for plains. Returns whether they changed. */
bool vl_upright_find(const vlScene *scene, const vlExtent *boxes, vlPlains *plains,
                     double up[3], double front[3]);

#endif
