/* world/medium/kinds.h: the compile function of each kind of medium, and functions that the
 * kinds share. */
#ifndef WORLD_MEDIUM_KINDS_H
#define WORLD_MEDIUM_KINDS_H

#include "velo/medium.h"
#include "world/world.h"

/* There is one function per kind. It sets the box, the majorants, and the members that only
 * this kind has. The caller has set the coefficients, the emission, `scatters` and `grey`. A
 * missing function is a link error. */
#define VL_MEDIUM_COMPILES(K, k)                                                           \
  vlResult vl_compile_medium_##k(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, \
                                 vlError *error);
VL_MEDIUM_KINDS(VL_MEDIUM_COMPILES)
#undef VL_MEDIUM_COMPILES

/* Allocates the majorants of x * y * z equal cells of the box. The caller fills them. Null: out
 * of memory. */
float *vl_medium_majorants(vlWorld *world, vlWorldMedium *m, uint32_t x, uint32_t y,
                           uint32_t z);
/* Compiles emission by temperature. Blackbody spectra are normalised to a maximum of 1, not to
 * a luminance, as in pbrt-v4. */
vlResult vl_medium_temperature(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                               vlError *error);

#endif
