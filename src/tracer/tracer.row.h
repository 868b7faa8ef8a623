/* tracer/tracer.row.h: for the files that hold rows of tracers: parameters that several kinds
 * share. pbrt calls tracers integrators. A row describes members of vlSceneDefs. */
#ifndef TRACER_TRACER_ROW_H
#define TRACER_TRACER_ROW_H

#include <math.h>
#include "schema/schema.h"
#include "velo/render.h"

#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlSceneDefs, __VA_ARGS__)
#define DEPTH                                                                           \
  PARAMETER(COUNT, "maxdepth", render.max_depth,                                        \
            "largest number of bounces of a path; numbers above 4096 are read as 4096", \
            VL_DEFAULT(5), VL_FROM(0), .flags = VL_PARAMETER_RULE)
#define MAX_DEPTH_OF_KIND(name, member, kind)                                                  \
  PARAMETER(COUNT, name, render.member,                                                        \
            "largest number of " kind " of a path; 0: no other limit than maxdepth", .low = 0, \
            .high = 4096, .flags = VL_PARAMETER_OWN)
#define MAX_DEPTHS_OF_KINDS                                                                    \
  MAX_DEPTH_OF_KIND("maxdiffusedepth", max_diffuse_depth, "diffuse bounces"),                  \
      MAX_DEPTH_OF_KIND("maxglossydepth", max_glossy_depth, "glossy or specular reflections"), \
      MAX_DEPTH_OF_KIND("maxtransmissiondepth", max_transmission_depth, "transmissions"),      \
      MAX_DEPTH_OF_KIND("maxvolumedepth", max_volume_depth, "scatterings in media")
#define REGULARIZE                                                                            \
  PARAMETER(BOOL, "regularize", build.regularize,                                             \
            "regularization: surfaces that a path hits after it has been scattered are made " \
            "rougher",                                                                        \
            VL_DEFAULT(0))
extern const char *const vl_tracer_light_samplers[];
#define LIGHT_SAMPLER                                                                     \
  PARAMETER(CHOICE, "lightsampler", build.light_sampler,                                  \
            "method that chooses a light for a shading point; exhaustive is read as bvh", \
            .choices = vl_tracer_light_samplers, .flags = VL_PARAMETER_RULE)
/* Parameters of pbrt that velo ignores. */
#define IGNORED(TYPE, file_name)                                                  \
  {                                                                               \
    .name = file_name, .member = "", .type = VL_PARAMETER_##TYPE,                 \
    .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND, .description = "ignored" \
  }
/* All of the tracers that follow paths from the camera only. */
#define ONE_WAY                                                                         \
  DEPTH, MAX_DEPTHS_OF_KINDS, LIGHT_SAMPLER, REGULARIZE, IGNORED(BOOL, "samplelights"), \
      IGNORED(BOOL, "samplebsdf")
#define PATHS                                                       \
  PARAMETER(COUNT, "photonsperiteration", render.light_paths,       \
            "number of light paths per pass; unset: one per pixel", \
            .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND)
#define TWO_WAY                                                                              \
  DEPTH, PATHS, IGNORED(BOOL, "regularize"), IGNORED(BOOL, "visualizestrategies"),           \
      IGNORED(BOOL, "visualizeweights"), IGNORED(FLOAT, "sigma"),                            \
      IGNORED(FLOAT, "largestepprobability"), IGNORED(COUNT, "bootstrapsamples"),            \
      IGNORED(COUNT, "chains"), IGNORED(COUNT, "mutationsperpixel"), IGNORED(COUNT, "seed"), \
      IGNORED(COUNT, "iterations")
#define RADIUS                                                                               \
  PARAMETER(DOUBLE, "radius", render.merge_radius,                                           \
            "merging radius of the first pass, scene units; unset: the width of two pixels", \
            VL_FROM(0), .flags = VL_PARAMETER_UNSET | VL_PARAMETER_ABOVE_LOW)

#endif
