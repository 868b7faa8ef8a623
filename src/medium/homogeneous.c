/* medium/homogeneous.c: media that are the same everywhere. */
#include "medium/compile.h"
#include "medium/lookup.h"

vlCompileMedium vl_compile_medium_homogeneous;

vlResult vl_compile_medium_homogeneous(VL_UNUSED vlWorld *world,
                                       VL_UNUSED const vlMediumDef *def, vlWorldMedium *m,
                                       VL_UNUSED vlError *error) {
  m->uniform = true;
  m->extinction = vl_medium_mean_extinction(m);
  return VL_OK;
}
