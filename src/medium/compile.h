/* medium/compile.h: functions that the files that compile media share. */
#ifndef MEDIUM_COMPILE_H
#define MEDIUM_COMPILE_H

#include "velo/medium.h"
#include "world/world.h"

/* There is one function per kind (medium/kinds.row.h). It sets the box, the majorants, and the
 * members that only this kind has. The caller has set the coefficients, the emission,
 * `scatters` and `grey`. */
typedef vlResult vlCompileMedium(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                                 vlError *error);

/* Allocates the majorants of x * y * z equal cells of the box. The caller fills them. Null: out
 * of memory. */
float *vl_medium_majorants(vlWorld *world, vlWorldMedium *m, uint32_t x, uint32_t y,
                           uint32_t z);
/* Compiles emission by temperature. Blackbody spectra are normalised to a maximum of 1, not to
 * a luminance, as in pbrt-v4. */
vlResult vl_medium_temperature(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                               vlError *error);

/* Copies the grids of the def, and sets the box and the majorants. Of an RGB grid own_sigma and
 * rgb_scale are set before. */
vlResult vl_medium_cells(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                         vlError *error);

#endif
