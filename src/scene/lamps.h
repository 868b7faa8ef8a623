/* scene/lamps.h: how brightly the scene's own lamps light it. */
#ifndef SCENE_LAMPS_H
#define SCENE_LAMPS_H

#include "scene/extent.h"

/* Luminance of a light's spectrum after pbrt's normalisation: emission divided by the
 * spectrum's luminance (for RGB: by that of the colour space's white). */
double vl_light_def_luminance(const vlSpectrum *spectrum);

/* The median, over points of the scene, of the illuminance in lux of a surface that faces the
 * lamps (lights but the infinite ones), without shadows; 0 if there are none, or none lights a
 * point. boxes: those of the groups. */
double vl_lamp_illuminance(const vlScene *scene, const vlExtent *boxes);

/* The same of the surfaces that emit light and are brighter than white (radiance 1): lamps, not
 * displays. It is the median over points of the other surfaces; a surface is a point light in
 * the middle of its box that faces everything. Emission by images and surfaces in groups do
 * not count. */
double vl_surface_illuminance(const vlScene *scene, const vlExtent *boxes);

#endif
