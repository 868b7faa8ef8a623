/* medium/grid.hot.c: the density of a medium on a grid. */
#include "medium/lookup.h"

vlMediumDensity vl_medium_density_grid;

float vl_medium_density_grid(const vlWorldMedium *m, VL_UNUSED vlVec3 p, vlVec3 q) {
  return vl_dense_lookup(&m->density, q);
}
