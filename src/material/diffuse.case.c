/* material/diffuse.case.c: what tests know of the material diffuse. */
#include "material/material.case.h"

const MaterialCase diffuse_material = {{
    {.parameters = "\"rgb reflectance\" [.5 .3 .8]", .albedo = {.5, .3, .8}, .reflected = 1},
    {.parameters = "\"rgb reflectance\" [1 1 1]", .albedo = {1, 1, 1}, .reflected = 1},
    {.parameters = "\"rgb reflectance\" [0 0 1]", .albedo = {0, 0, 1}, .reflected = 1},
}};
