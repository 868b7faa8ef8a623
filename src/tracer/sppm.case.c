/* tracer/sppm.case.c: what tests know of the tracer sppm. */
#include "tracer/tracer.case.h"

const TracerCase sppm_tracer = {TRANSPORT,       MIRRORS,       .spp = 192,
                                .room_spp = 128, .blurs = true, .mirrors_are_free = true};
