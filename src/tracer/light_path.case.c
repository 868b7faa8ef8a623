/* tracer/light_path.case.c: what tests know of the tracer light path. */
#include "tracer/tracer.case.h"

const TracerCase light_path_tracer = {TRANSPORT, .spp = 6144, .room_spp = 1024};
