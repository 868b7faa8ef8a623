/* material/diffuse.case.c: what tests know of the material diffuse. */
#include "material/material.case.h"

static void even(const MaterialAt *at, double value[3]) {
  static const double reflectance[3] = {.5, .3, .8};
  for (int c = 0; c < 3; c++)
    value[c] = at->in[2] > 0 ? reflectance[c] * at->in[2] / 3.14159265358979 : 0;
}

const MaterialCase diffuse_material = {{
    {.parameters = "\"rgb reflectance\" [.5 .3 .8]",
     .albedo = {.5, .3, .8},
     .reflected = 1,
     .formula = even},
    {.parameters = "\"rgb reflectance\" [1 1 1]", .albedo = {1, 1, 1}, .reflected = 1},
    {.parameters = "\"rgb reflectance\" [0 0 1]", .albedo = {0, 0, 1}, .reflected = 1},
}};
