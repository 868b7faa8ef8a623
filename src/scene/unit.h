/* scene/unit.h: the length of a scene's unit, for lights whose numbers are those of a scene in
 * metres (docs/decisions/0031-units.md). */
#ifndef SCENE_UNIT_H
#define SCENE_UNIT_H

#include "scene/scene.h"

/* A unit of the scene is `metres` long: candela and lumens of the lights and emissions from
 * first_light and first_emission on give the light that they give in metres. What is far away,
 * and what is given as luminance or illuminance, does not change. */
void vl_scene_state_unit(vlScene *scene, size_t first_light, size_t first_emission,
                         double metres);

#endif
