/* tracer/tracer.row.c: the family of tracers: the list of its rows, each from the file of its
 * kind. */
#include "tracer/tracer.row.h"

#include "tracer/kinds.row.h"
#include "velo/tracer.h"

const char *const vl_tracer_light_samplers[] = {"bvh", "power", "uniform", "exhaustive", NULL};

VL_TRACER_FUNCTIONS(VL_DECLARE_ROW)
const vlKindFamily vl_tracer_family = VL_KIND_FAMILY(
    VL_TRACER_FUNCTIONS(VL_LIST_ROW), VL_TRACER_KINDS, "tracers", "integrator", "Integrator");
