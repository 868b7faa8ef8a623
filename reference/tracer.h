/* tracer.h: the lecture's tracer: the radiance that comes back along a ray. */
#pragma once
#include "medium.h"

/* The radiance along a ray that starts in a medium (null: vacuum). A path has at most max_depth bounces. *met: whether
 * the ray met a surface. */
spectrum trace_ray(const world *w, ray r, const vlMediumDef *inside, uint32_t max_depth, sampler *s,
                   wavelengths *lambda, bool *met);
