/* material/coated_conductor.case.c: what tests know of the material coated conductor. */
#include "material/material.case.h"

/* A smooth metal of index .5 + 3i under a smooth coat of index 1.5, 0.2 radians from the
 * normal: the coat reflects .0400 on either side, the metal .7692 of what is in the coat (.8222
 * of what is in air); of their sum (1 - .04)^2 .7692 / (1 - .04 .7692) is the metal's. */
#define SMOOTH                                                                             \
  "\"float conductor.roughness\" 0 \"float interface.roughness\" 0 \"float thickness\" 0 " \
  "\"spectrum conductor.eta\" [300 .5 900 .5] \"spectrum conductor.k\" [300 3 900 3]"

const MaterialCase coated_conductor_material = {{
    {.parameters = "", .reflected = 1},
    {.parameters = "\"float conductor.roughness\" .3 \"float interface.roughness\" .1",
     .reflected = 1,
     .walks = true},
    {.parameters = "\"rgb reflectance\" [.9 .5 .2] \"float conductor.roughness\" .5 "
                   "\"float interface.roughness\" .4",
     .reflected = 1,
     .walks = true},
    {.parameters = SMOOTH, .albedo = {.771430, .771430, .771430}, .reflected = 1},
}};
