/* material/mix.case.c: what tests know of the material mix. */
#include "material/material.case.h"

const MaterialCase mix_material = {{
    {.parameters = "\"string materials\" [\"grey\" \"red\"] \"float amount\" .25",
     .albedo = {.75 * .5 + .25 * .8, .75 * .5 + .25 * .1, .75 * .5 + .25 * .1},
     .reflected = 1,
     .one_way = true}, /* each ray chooses one of the two */
    {.parameters = "\"string materials\" [\"grey\" \"red\"] \"float amount\" 1",
     .albedo = {.8, .1, .1},
     .reflected = 1},
}};
