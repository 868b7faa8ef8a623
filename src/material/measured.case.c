/* material/measured.case.c: what tests know of the material measured. */
#include "material/material.case.h"

const MaterialCase measured_material = {{
    {.parameters = "\"string filename\" \"a.bsdf\"",
     .reflected = 1,
     .one_way = true}, /* a table of one direction */
    {.parameters = "\"string filename\" \"b.bsdf\"", .reflected = 1, .one_way = true},
}};
