/* import/pbrt/scattering.h: measured scattering coefficients of liquids and solids, with pbrt's
 * names. */
#ifndef IMPORT_PBRT_SCATTERING_H
#define IMPORT_PBRT_SCATTERING_H

#include <stddef.h>

/* Coefficients per millimetre for the channels of linear sRGB. The scattering coefficient is
 * the reduced one, used with g = 0. */
typedef struct vlScattering {
  const char *name;
  float scattering[3], absorption[3];
} vlScattering;
/* The preset at an index; null past the end. */
const vlScattering *vl_scattering_preset(size_t index);

#endif
