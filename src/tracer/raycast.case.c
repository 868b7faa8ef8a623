/* tracer/raycast.case.c: what tests know of the tracer raycast. */
#include "tracer/tracer.case.h"

/* the reflectance, or .8, times the cosine to the eye */
const TracerCase raycast_tracer = {
    .sky = {.even = 0.25}, .lamp = {.even = 0.25}, .mirror = {.even = 0.4}};
