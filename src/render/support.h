/* render/support.h: what tracers do not render. vl_render uses VL_TRACER_VOLPATH in place of a
 * tracer that lacks a feature of the scene, and the race of the tracers (choose.c) leaves such
 * scenes out. */
#ifndef RENDER_SUPPORT_H
#define RENDER_SUPPORT_H

#include "velo/render.h"
#include "velo/tracer.h"
#include "world/world.h"

/* A set of tracers. */
#define VL_TRACER_BIT(tracer) (1u << (tracer))

/* Sets *lack as vl_tracer_lacks, for any of a set of tracers. Error: MEMORY. */
vlResult vl_tracers_lack(const vlWorld *world, const vlCamera *camera, const vlFilmDef *film,
                         uint32_t tracers, const char **lack);
/* Whether some segments of paths have one medium from one end and another from the other.
 * Traces a batch of paths with fixed random numbers. Error: MEMORY. In media_fit.c. */
vlResult vl_media_differ(const vlWorld *world, const vlCamera *camera, bool *differ);

#endif
