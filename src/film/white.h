/* film/white.h: white balance: the illuminant that appears white on the film. */
#ifndef FILM_WHITE_H
#define FILM_WHITE_H

#include "velo/scene.h"

/* The matrix (row-major, acts on XYZ) that maps the white of the CIE daylight of this colour temperature (kelvin; below
 * 4000 K a blackbody) to the white of the colour space, with Bradford's cone responses; as pbrt-v4's sensor cie1931
 * does. */
void vl_white_balance(double kelvin, vlColorSpace space, float m[9]);

#endif
