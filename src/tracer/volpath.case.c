/* tracer/volpath.case.c: what tests know of the tracer volpath. */
#include "tracer/tracer.case.h"

const TracerCase volpath_tracer = {TRANSPORT, MIRRORS, .room_spp = 512};
