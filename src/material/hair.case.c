/* material/hair.case.c: what tests know of the material hair. */
#include "material/material.case.h"

/* Hair that absorbs all light that enters it reflects by its scales: the eye is 8.74 degrees
 * from the normal along the hair, the scales are tilted by 10, so the light goes to where a
 * mirror turned by these would send it: to 20 - 8.74 degrees, of whose sine 1 - v is left, v =
 * .0316 the variance of beta_m = .2 (pbrt book 9.9.3, 9.9.6). */
const MaterialCase hair_material = {{
    {.parameters = "", .one_way = true},
    {.parameters = "\"rgb reflectance\" [.8 .5 .3] \"float beta_m\" .6 \"float beta_n\" .7",
     .one_way = true},
    {.parameters =
         "\"rgb sigma_a\" [500 500 500] \"float beta_m\" .2 \"float beta_n\" .6 \"float alpha\" 10",
     .along = .189097,
     .one_way = true},
}};
