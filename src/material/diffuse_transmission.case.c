/* material/diffuse_transmission.case.c: what tests know of the material diffuse transmission.
 */
#include <math.h>

#include "material/material.case.h"

static void leaf(const MaterialAt *at, double value[3]) {
  static const double shares[2][3] = {{.3, .4, .1}, {.5, .2, .6}};
  for (int c = 0; c < 3; c++)
    value[c] = shares[at->in[2] < 0][c] * fabs(at->in[2]) / 3.14159265358979;
}

const MaterialCase diffuse_transmission_material = {{
    {.parameters = "\"rgb reflectance\" [.3 .4 .1] \"rgb transmittance\" [.5 .2 .6]",
     .albedo = {.8, .6, .7},
     .both_sides = true,
     .formula = leaf},
    {.parameters = "\"rgb reflectance\" [0 0 0] \"rgb transmittance\" [1 1 1]",
     .albedo = {1, 1, 1},
     .both_sides = true},
    {.parameters =
         "\"rgb reflectance\" [.2 .2 .2] \"rgb transmittance\" [.4 .4 .4] \"float scale\" .5",
     .albedo = {.3, .3, .3},
     .reflected = 1.0 / 3,
     .both_sides = true},
}};
