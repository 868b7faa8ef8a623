/* tracer/ambient_occlusion.case.c: what tests know of the tracer ambient occlusion. */
#include "tracer/tracer.case.h"

const TracerCase ambient_occlusion_tracer = {
    .spp = 320, .sky = {.even = 1}, .lamp = {.even = 1, .ball = -1}, MIRRORS};
