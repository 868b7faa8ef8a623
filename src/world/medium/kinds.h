/* world/medium/kinds.h: what each kind of medium compiles, and what kinds share. */
#ifndef WORLD_MEDIUM_KINDS_H
#define WORLD_MEDIUM_KINDS_H

#include "world/world.h"

/* A function per kind: sets the box, the majorants, and what the kind alone has. Coefficients, emission, `scatters` and
 * `grey` are set. A kind without one does not link. */
#define VL_MEDIUM_COMPILES(K, k) \
  vlResult vl_compile_medium_##k(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error);
VL_MEDIUM_KINDS(VL_MEDIUM_COMPILES)
#undef VL_MEDIUM_COMPILES

/* Allocates the majorants of x * y * z equal cells of the box, to be filled; null: out of memory. */
float *vl_medium_majorants(vlWorld *world, vlWorldMedium *m, uint32_t x, uint32_t y, uint32_t z);
/* Temperature: black bodies as in pbrt-v4, normalised to a maximum of 1, not to a luminance. */
vlResult vl_medium_temperature(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m, vlError *error);

#endif
