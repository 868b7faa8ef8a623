/* tracer/path.case.c: what tests know of the tracer path. */
#include "tracer/tracer.case.h"

const TracerCase path_tracer = {TRANSPORT, MIRRORS};
