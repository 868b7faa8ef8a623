/* tracer/random_walk.case.c: what tests know of the tracer random walk. */
#include "tracer/tracer.case.h"

/* it finds the ball by chance */
const TracerCase random_walk_tracer = {TRANSPORT, .spp = 8192, .least_of_lamp = 0.1};
