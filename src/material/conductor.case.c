/* material/conductor.case.c: what tests know of the material conductor. */
#include "material/material.case.h"

#include "material/microfacets.case.h"

/* Alpha is the square root of the roughness. */
static void brushed(const MaterialAt *at, double value[3]) {
  static const double eta[3] = {.2, 1, 1.5};
  static const double k[3] = {3, 2, 4};
  for (int c = 0; c < 3; c++)
    value[c] = at->in[2] > 0
                   ? plain_reflection(at->out, at->in, sqrt(.6), sqrt(.1), eta[c] + k[c] * I)
                   : 0;
}

const MaterialCase conductor_material = {{
    {.parameters = "\"rgb reflectance\" [1 1 1]", .albedo = {1, 1, 1}, .reflected = 1},
    {.parameters = "\"float roughness\" .2", .reflected = 1},
    {.parameters = "\"float uroughness\" .6 \"float vroughness\" .1", .reflected = 1},
    {.parameters = "\"rgb reflectance\" [.9 .5 .2] \"float roughness\" 1", .reflected = 1},
    {.parameters = "\"rgb eta\" [.2 1 1.5] \"rgb k\" [3 2 4] \"float uroughness\" .6 "
                   "\"float vroughness\" .1",
     .reflected = 1,
     .formula = brushed},
}};
