/* film/white.h: white balance: what kind of light a film takes for white. */
#ifndef FILM_WHITE_H
#define FILM_WHITE_H

#include "velo/scene.h"

/* Row-major, acts on XYZ: the CIE daylight of this colour temperature (below 4000 K a blackbody) becomes the white of
 * the colour space, by Bradford's cone responses; as pbrt-v4's sensor cie1931 does. */
void vl_white_balance(double kelvin, vlColorSpace space, float m[9]);

#endif
