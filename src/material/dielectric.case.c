/* material/dielectric.case.c: what tests know of the material dielectric. */
#include "material/material.case.h"

/* Fresnel at 0.2 radians for an index of 1.5: 0.0400; of a pane 2 r / (1 + r) = 0.0769. */
const MaterialCase dielectric_material = {{
    {.parameters = "\"float eta\" 1.5", .refracts = true},
    {.parameters = "\"float eta\" 1.5 \"float roughness\" .2", .refracts = true},
    {.parameters = "\"float eta\" 2.2 \"float uroughness\" .3 \"float vroughness\" .6",
     .refracts = true},
    {.parameters = "\"float eta\" .7 \"float roughness\" .3", .refracts = true},
}};
