/* tracer/tracer.row.c: the family of tracers: the list of its rows, each from the file of its
 * kind. */
#include "tracer/tracer.row.h"

#include "tracer/kinds.row.h"
#include "velo/tracer.h"

const char *const vl_tracer_light_samplers[] = {"bvh", "power", "uniform", "exhaustive", NULL};

#define DECLARE(kind, row, trace) extern const vlKindRow row;
VL_TRACER_FUNCTIONS(DECLARE)

#define ROW(kind, row, trace) [kind] = &row,
static const vlKindRow *const rows[] = {VL_TRACER_FUNCTIONS(ROW)};
const vlKindFamily vl_tracer_family =
    VL_KIND_FAMILY(rows, VL_TRACER_KINDS, "tracers", "integrator", "Integrator");
