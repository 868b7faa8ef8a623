/* material/diffuse_transmission.case.c: what tests know of the material diffuse transmission.
 */
#include "material/material.case.h"

const MaterialCase diffuse_transmission_material = {{
    {.parameters = "\"rgb reflectance\" [.3 .4 .1] \"rgb transmittance\" [.5 .2 .6]",
     .albedo = {.8, .6, .7},
     .both_sides = true},
    {.parameters = "\"rgb reflectance\" [0 0 0] \"rgb transmittance\" [1 1 1]",
     .albedo = {1, 1, 1},
     .both_sides = true},
    {.parameters =
         "\"rgb reflectance\" [.2 .2 .2] \"rgb transmittance\" [.4 .4 .4] \"float scale\" .5",
     .albedo = {.3, .3, .3},
     .reflected = 1.0 / 3,
     .both_sides = true},
}};
