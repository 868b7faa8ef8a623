/* tracer/bidirectional.case.c: what tests know of the tracer bidirectional. */
#include "tracer/tracer.case.h"

const TracerCase bidirectional_tracer = {TRANSPORT, MIRRORS, .spp = 128, .room_spp = 256};
