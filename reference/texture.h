/* texture.h: the value of a texture, a number or a spectrum, at a point of a surface (pbrt book 10). */
#pragma once
#include "world.h"

/* Reads the images of all textures. False, with an error. */
bool read_images(world *w, vlError *error);

/* An input of a material or shape: its texture's value at the point, else its own. */
double number_at(const world *w, vlFloatInput input, const shade_record *at);
spectrum spectrum_at(const world *w, const vlSpectrumInput *input, vlParameterRole role, const shade_record *at,
                     const wavelengths *lambda);
/* Where in the texture the point is. */
square_point texture_coordinates(const vlTextureDef *def, const shade_record *at);
