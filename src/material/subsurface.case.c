/* material/subsurface.case.c: what tests know of the material subsurface. */
#include "material/material.case.h"

const MaterialCase subsurface_material = {{
    {.parameters = "\"float roughness\" 0", .refracts = 1.33},
    {.parameters = "\"float roughness\" .3", .refracts = 1.33},
}};
