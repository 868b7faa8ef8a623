/* schema/tracers.c: rows of the tracers, which pbrt calls integrators. A row describes members
 * of vlSceneDefs. */
#include <math.h>

#include "schema/schema.h"
#include "velo/render.h"

#define PARAMETER(TYPE, ...) VL_PARAMETER(TYPE, vlSceneDefs, __VA_ARGS__)
#define DEPTH                                                                           \
  PARAMETER(COUNT, "maxdepth", render.max_depth,                                        \
            "largest number of bounces of a path; numbers above 4096 are read as 4096", \
            VL_DEFAULT(5), VL_FROM(0), .flags = VL_PARAMETER_RULE)
#define REGULARIZE                                                                            \
  PARAMETER(BOOL, "regularize", build.regularize,                                             \
            "regularization: surfaces that a path hits after it has been scattered are made " \
            "rougher",                                                                        \
            VL_DEFAULT(0))
static const char *const light_samplers[] = {"bvh", "power", "uniform", "exhaustive", NULL};
#define LIGHT_SAMPLER                                                                     \
  PARAMETER(CHOICE, "lightsampler", build.light_sampler,                                  \
            "method that chooses a light for a shading point; exhaustive is read as bvh", \
            .choices = light_samplers, .flags = VL_PARAMETER_RULE)
/* Parameters of pbrt that velo ignores. */
#define IGNORED(TYPE, file_name)                                                  \
  {                                                                               \
    .name = file_name, .member = "", .type = VL_PARAMETER_##TYPE,                 \
    .flags = VL_PARAMETER_RULE | VL_PARAMETER_SHORTHAND, .description = "ignored" \
  }
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

static const vlParameter path_parameters[] = {DEPTH, LIGHT_SAMPLER, REGULARIZE,
                                              IGNORED(BOOL, "samplelights"),
                                              IGNORED(BOOL, "samplebsdf")};
VL_KIND_ROW(path, .name = "path", .alias = "simplepath",
            .description = "path tracing: paths from the camera; ignores media",
            .traits = VL_TRACER_TRAIT_NO_MEDIA | VL_TRAIT_PBRT_NAME)

static const vlParameter volpath_parameters[] = {DEPTH, LIGHT_SAMPLER, REGULARIZE,
                                                 IGNORED(BOOL, "samplelights"),
                                                 IGNORED(BOOL, "samplebsdf")};
VL_KIND_ROW(
    volpath, .name = "volpath", .alias = "simplevolpath",
    .description =
        "volumetric path tracing: paths from the camera, also through media and subsurface "
        "materials",
    .traits = VL_TRAIT_PBRT_NAME)

VL_KIND_ROW_EMPTY(raycast, .name = "raycast",
                  .description = "colour of the surface that each camera ray hits first",
                  .traits = VL_TRACER_TRAIT_NO_MEDIA)

static const vlParameter ambient_occlusion_parameters[] = {
    PARAMETER(BOOL, "cossample", render.ao_cosine,
              "true: cosine-weighted directions; false: uniform ones", VL_DEFAULT(1)),
    PARAMETER(FLOAT, "maxdistance", render.ao_distance,
              "distance beyond which nothing occludes, scene units", VL_DEFAULT(INFINITY),
              VL_FROM(0), .flags = VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_INFINITE),
};
VL_KIND_ROW(
    ambient_occlusion, .name = "ambientocclusion", .alias = "ao",
    .description = "ambient occlusion: the fraction of directions that are not occluded",
    .traits = VL_TRACER_TRAIT_NO_MEDIA | VL_TRAIT_PBRT_NAME)

static const vlParameter bidirectional_parameters[] = {TWO_WAY, IGNORED(FLOAT, "radius")};
VL_KIND_ROW(bidirectional, .name = "bidirectional", .alias = "bdpt",
            .description =
                "bidirectional path tracing: paths from the camera and paths from the lights, "
                "connected",
            .traits = VL_TRAIT_PBRT_ALIAS)

static const vlParameter merging_parameters[] = {TWO_WAY, RADIUS};
VL_KIND_ROW(
    merging, .name = "merging",
    .description = "bidirectional path tracing that also merges path vertices within a radius")

static const vlParameter sppm_parameters[] = {TWO_WAY, RADIUS};
VL_KIND_ROW(sppm, .name = "sppm",
            .description =
                "stochastic progressive photon mapping: merging, with bounces counted as in "
                "pbrt's sppm",
            .traits = VL_TRAIT_PBRT_NAME)

static const vlParameter light_path_parameters[] = {DEPTH};
VL_KIND_ROW(light_path, .name = "lightpath",
            .description = "light tracing: paths from the lights, connected to the camera",
            .traits = VL_TRAIT_PBRT_NAME)

static const vlParameter random_walk_parameters[] = {DEPTH};
VL_KIND_ROW(
    random_walk, .name = "randomwalk",
    .description =
        "paths without light sampling, scattered uniformly over the sphere; for comparison",
    .traits = VL_TRACER_TRAIT_NO_MEDIA | VL_TRAIT_PBRT_NAME)

#define ROW(NAME, name) [VL_TRACER_##NAME] = &name##_row,
VL_KIND_FAMILY(vl_tracer_family, VL_TRACER_KINDS, ROW, "tracers", "integrator", "Integrator")
