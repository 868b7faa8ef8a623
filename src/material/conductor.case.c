/* material/conductor.case.c: what tests know of the material conductor. */
#include "material/material.case.h"

const MaterialCase conductor_material = {{
    {.parameters = "\"rgb reflectance\" [1 1 1]", .albedo = {1, 1, 1}, .reflected = 1},
    {.parameters = "\"float roughness\" .2", .reflected = 1},
    {.parameters = "\"float uroughness\" .6 \"float vroughness\" .1", .reflected = 1},
    {.parameters = "\"rgb reflectance\" [.9 .5 .2] \"float roughness\" 1", .reflected = 1},
}};
