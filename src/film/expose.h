/* film/expose.h: converts radiance (at a few wavelengths, or in linear Rec.709) to the film's
 * red, green and blue. */
#ifndef FILM_EXPOSE_H
#define FILM_EXPOSE_H

#include "film/film.h"

/* Radiance of n rays. Spectral: radiance[c] is given at lambda[c] (nm), sampled with density 1
 * / inv_pdf[c]. RGB (lambda[0] null): radiance[0..2] are linear Rec.709. All are multiplied by
 * exposure. Arrays of VL_PAD(n). */
typedef struct vlExposure {
  uint32_t n;
  const float *radiance[4], *lambda[4], *inv_pdf[4];
  float exposure;
} vlExposure;
void vl_film_expose(const vlFilm *film, vlIsa isa, const vlExposure *exposure, float *r,
                    float *g, float *b);

#endif
