/* material/coated_conductor.case.c: what tests know of the material coated conductor. */
#include "material/material.case.h"

const MaterialCase coated_conductor_material = {{
    {.parameters = "", .reflected = 1},
    {.parameters = "\"float conductor.roughness\" .3 \"float interface.roughness\" .1",
     .reflected = 1,
     .walks = true},
    {.parameters = "\"rgb reflectance\" [.9 .5 .2] \"float conductor.roughness\" .5 \"float "
                   "interface.roughness\" .4",
     .reflected = 1,
     .walks = true},
}};
