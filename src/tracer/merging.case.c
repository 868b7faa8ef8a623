/* tracer/merging.case.c: what tests know of the tracer merging. */
#include "tracer/tracer.case.h"

const TracerCase merging_tracer = {TRANSPORT, .spp = 192};
