/* film/white.h: white balance: the illuminant that appears white on the film. */
#ifndef FILM_WHITE_H
#define FILM_WHITE_H

#include "velo/spectrum.h"

/* Computes the white balance matrix (row-major, acts on XYZ) with Bradford's cone responses. It
 * maps the white of CIE daylight of this colour temperature (kelvin; a blackbody below 4000 K)
 * to the white of the colour space. This is the white balance of pbrt-v4's sensor cie1931. */
void vl_white_balance(double kelvin, vlColorSpace space, float m[9]);

#endif
