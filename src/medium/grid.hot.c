/* medium/grid.hot.c: the density of a medium on a grid. */
#include "medium/lookup.h"

vlMediumDensity vl_medium_density_grid;

float vl_medium_density_grid(const vlWorldMedium *m, vlVec3 p, vlVec3 q) {
  (void)p;
  return vl_dense_lookup(&m->density, q);
}
