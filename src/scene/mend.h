/* scene/mend.h: what hides a model, or a part of it, by mistakes that other programs do not
 * show: an opacity of 0 everywhere, parts that are wound the wrong way, outlines drawn by a
 * shell around the model. */
#ifndef SCENE_MEND_H
#define SCENE_MEND_H

#include "scene/scene.h"

/* Changes a model that is completed:
 * - if no shape has any opacity, all get theirs back;
 * - a closed one-sided shape whose faces look inwards at a closed shape of nearly the same
 *   volume is its outline: it is left out, since no light would come through it;
 * - other ones that contain no shape are seen from both sides, unless they are nearly all.
 * It depends on nothing but the shapes. False: the scene holds the error. */
bool vl_mend_model(vlScene *scene);

#endif
