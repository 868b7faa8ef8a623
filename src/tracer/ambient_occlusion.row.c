/* tracer/ambient_occlusion.row.c: the name and the parameters of the tracer ambient occlusion.
 */
#include "tracer/tracer.row.h"

const vlKindRow vl_tracer_row_ambient_occlusion = {
    .name = "ambientocclusion",
    .alias = "ao",
    .description = "ambient occlusion: the fraction of directions that are not occluded",
    .traits = VL_TRACER_TRAIT_NO_MEDIA | VL_TRAIT_PBRT_NAME,
    VL_PARAMETERS(
        PARAMETER(BOOL, "cossample", render.ao_cosine,
                  "true: cosine-weighted directions; false: uniform ones", VL_DEFAULT(1)),
        PARAMETER(FLOAT, "maxdistance", render.ao_distance,
                  "distance beyond which nothing occludes, scene units", VL_DEFAULT(INFINITY),
                  VL_FROM(0), .flags = VL_PARAMETER_ABOVE_LOW | VL_PARAMETER_INFINITE)),
};
