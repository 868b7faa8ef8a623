/* scene/upright.h: which way is up in a file that does not say it: on which side a model
 * stands. */
#ifndef SCENE_UPRIGHT_H
#define SCENE_UPRIGHT_H

#include "scene/plain.h"

/* Of y and z, one is `up` already. Takes the other, with its front (of z: -y, as modellers have
 * it), if the model stands on its lowest part only so: a bust on its plinth, a figure on its
 * feet, a vase on its foot, a chair on its legs; or if only so it has a ground: a plain
 * (scene/plain.h), or the plane of a city; or if its surface is spread so: the same on both
 * sides along `up`, but above and below only along the other axis; terrain; a storey; a survey
 * in points; a chart that would look down. Otherwise up and front stay as they are, as of
 * models that lie either way. boxes: those of the groups. *plains: gets the searches for
 * plains. Returns whether they changed. */
bool vl_upright_find(const vlScene *scene, const vlExtent *boxes, vlPlains *plains,
                     double up[3], double front[3]);

#endif
