/* filter/filter.case.h: what the tests of pixel filters must know of a kind beyond its row: its
 * formula, written apart from the library (test/conformance/sampling.h). */
#ifndef FILTER_FILTER_CASE_H
#define FILTER_FILTER_CASE_H

#include <math.h>

#include "velo/filter.h"
#include "velo/filter_kinds.h"

/* x: distance from the centre, pixels, along an axis with this radius. Any factor. */
typedef double FilterShape(const vlPixelFilter *filter, double x, double radius);

/* Declares the formula of each kind, which is in the file of the kind: filter/NAME.case.c. */
#define FILTER_CASE(kind, name) extern FilterShape name##_filter;
VL_PIXEL_FILTER_KINDS(FILTER_CASE)
#undef FILTER_CASE

#endif
