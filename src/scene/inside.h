/* scene/inside.h: lamps in the free space of a model that encloses its camera: a room, a city
 * under a dome. */
#ifndef SCENE_INSIDE_H
#define SCENE_INSIDE_H

#include "scene/extent.h"

/* Adds point lights around the scene's camera or, if it is not inside the model, around the
 * freest point near the model's middle: above it and on all sides, each halfway to the surface
 * in its direction. A lamp gives the surface nearest to it `strength` lux. boxes: those of the
 * groups. False: the scene holds the error. */
bool vl_scene_add_lamps(vlScene *scene, const vlExtent *boxes, const double up[3],
                        float strength);

#endif
