/* material/hair.case.c: what tests know of the material hair. */
#include "material/material.case.h"

const MaterialCase hair_material = {{
    {.parameters = "", .one_way = true},
    {.parameters = "\"rgb reflectance\" [.8 .5 .3] \"float beta_m\" .6 \"float beta_n\" .7",
     .one_way = true},
}};
