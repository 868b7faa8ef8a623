/* material/thin_dielectric.case.c: what tests know of the material thin dielectric. */
#include "material/material.case.h"

const MaterialCase thin_dielectric_material = {{
    {.parameters = "\"float eta\" 1.5", .albedo = {1, 1, 1}, .reflected = 0.0769},
    {.parameters = "\"float eta\" 1.000001", .albedo = {1, 1, 1}},
}};
