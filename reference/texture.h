/* texture.h: the value of a texture, a number or a spectrum, at a point of a surface (pbrt book 10). */
#ifndef REFERENCE_TEXTURE_H
#define REFERENCE_TEXTURE_H

#include "world.h"

/* Reads the images and spectra of all textures. False, with an error. */
bool read_textures(world *w, vlError *error);
void free_textures(world *w);

/* An input of a material or shape: its texture's value at the point, else its own. */
double number_at(const world *w, vlFloatInput input, const shade_record *at);
/* `own`: the spectrum of the input, read. */
spectrum spectrum_at(const world *w, vlSpectrumInput input, const color *own, vlParameterRole role,
                     const shade_record *at, const wavelengths *lambda);
/* Where in the texture the point is. */
square_point texture_coordinates(const vlTextureDef *def, const shade_record *at);

#endif
