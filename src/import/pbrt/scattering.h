/* import/pbrt/scattering.h: measured scattering of real liquids and solids, by the names that pbrt gives them. */
#ifndef IMPORT_PBRT_SCATTERING_H
#define IMPORT_PBRT_SCATTERING_H

#include <stddef.h>

/* Per millimetre, linear sRGB; scattering is the reduced coefficient (to be used with g = 0). */
typedef struct vlScattering {
  const char *name;
  float scattering[3], absorption[3];
} vlScattering;
/* Null past the end. */
const vlScattering *vl_scattering_preset(size_t index);

#endif
