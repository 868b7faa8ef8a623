/* world/nanovdb.c: NanoVDB files. */
#include "base/error.h"
#include "world/medium.h"
#include "world/world.h"

vlResult vl_nanovdb_read(vlWorld *world, const char *path, const char *name, const vlSparseGrid **grid,
                         vlError *error) {
  (void)world, (void)grid, (void)name;
  return vl_fail(error, VL_ERROR_SCENE, "%s: NanoVDB files are not understood yet", path);
}
