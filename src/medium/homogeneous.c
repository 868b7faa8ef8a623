/* medium/homogeneous.c: media that are the same everywhere. */
#include "medium/compile.h"
#include "medium/lookup.h"

vlCompileMedium vl_compile_medium_homogeneous;

vlResult vl_compile_medium_homogeneous(vlWorld *world, const vlMediumDef *def, vlWorldMedium *m,
                                       vlError *error) {
  (void)world;
  (void)def;
  (void)error;
  m->uniform = true;
  m->extinction = vl_medium_mean_extinction(m);
  return VL_OK;
}
