/* material/coated_diffuse.case.c: what tests know of the material coated diffuse. */
#include "material/material.case.h"

const MaterialCase coated_diffuse_material = {{
    {.parameters = "\"rgb reflectance\" [.9 .5 .2] \"float roughness\" 0", .reflected = 1},
    {.parameters = "\"rgb reflectance\" [.9 .5 .2] \"float roughness\" .25", .reflected = 1},
    {.parameters =
         "\"rgb reflectance\" [1 1 1] \"float uroughness\" .1 \"float vroughness\" .5",
     .reflected = 1},
    {.parameters =
         "\"rgb reflectance\" [.5 .5 .5] \"float thickness\" .5 \"rgb albedo\" [.9 .5 .1] "
         "\"float g\" .3",
     .reflected = 1,
     .walks = true},
}};
