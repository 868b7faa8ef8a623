/* tracer/merging.case.c: what tests know of the tracer merging. */
#include "tracer/tracer.case.h"

const TracerCase merging_tracer = {TRANSPORT, MIRRORS, .spp = 192, .room_spp = 128,
                                   .blurs = true};
