/* medium/density.hot.c: the density of a medium of any kind. */
#include "medium/kinds.row.h"
#include "medium/lookup.h"
#include "velo/medium.h"

#define DECLARE(kind, row, compile, density) vlMediumDensity density;
VL_MEDIUM_FUNCTIONS(DECLARE)

/* Of kinds without a density of their own. */
float vl_medium_density_one(VL_UNUSED const vlWorldMedium *m, VL_UNUSED vlVec3 p,
                            VL_UNUSED vlVec3 q) {
  return 1.0f;
}

float vl_medium_density(const vlWorldMedium *m, vlVec3 p, vlVec3 q) {
  switch ((vlMediumKind)m->kind) {
#define DENSITY(kind, row, compile, density) \
  case kind:                                 \
    return density(m, p, q);
    VL_MEDIUM_FUNCTIONS(DENSITY)
  }
  return 1.0f;
}
