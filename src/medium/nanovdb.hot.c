/* medium/nanovdb.hot.c: the density of a medium of a NanoVDB file. */
#include "medium/lookup.h"

vlMediumDensity vl_medium_density_nanovdb;

float vl_medium_density_nanovdb(const vlWorldMedium *m, vlVec3 p, VL_UNUSED vlVec3 q) {
  return vl_sparse_lookup(m->sparse, p);
}
