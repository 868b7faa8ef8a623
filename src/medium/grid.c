/* medium/grid.c: media with a density on a grid (pbrt book 11.4). */
#include "medium/compile.h"

vlCompileMedium vl_compile_medium_grid;

vlResult vl_compile_medium_grid(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                                vlError *error) {
  vlResult r = vl_medium_cells(world, def, m, error);
  return r == VL_OK && def->temperature ? vl_medium_temperature(world, def, m, error) : r;
}
