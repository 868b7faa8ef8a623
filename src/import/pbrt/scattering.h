/* import/pbrt/scattering.h: measured scattering of liquids and solids, under pbrt's names. */
#ifndef IMPORT_PBRT_SCATTERING_H
#define IMPORT_PBRT_SCATTERING_H

#include <stddef.h>

/* Per millimetre, linear sRGB. Scattering is the reduced coefficient (used with g = 0). */
typedef struct vlScattering {
  const char *name;
  float scattering[3], absorption[3];
} vlScattering;
/* Null past the end. */
const vlScattering *vl_scattering_preset(size_t index);

#endif
