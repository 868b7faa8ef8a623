/* material/dielectric.case.c: what tests know of the material dielectric. */
#include "material/material.case.h"

#include "material/microfacets.case.h"

/* From above; the radiance is divided by the square of the index below (pbrt book 9.7). */
static void ground_glass(const MaterialAt *at, double value[3]) {
  const double eta = 1.8;
  const double alpha_x = .5;
  const double alpha_y = .3;
  double half[3];
  value[0] = plain_reflection(at->out, at->in, alpha_x, alpha_y, eta);
  if (at->in[2] < 0) {
    plain_half(at->in, eta, at->out, half);
    const double in = plain_dot(at->in, half);
    const double out = plain_dot(at->out, half);
    const double denominator = in + out / eta;
    value[0] = out > 0 && in < 0 ? plain_facets(half, alpha_x, alpha_y) *
                                       plain_seen(at->out, at->in, alpha_x, alpha_y) *
                                       (1 - plain_fresnel(out, eta)) * fabs(in * out) /
                                       (at->out[2] * denominator * denominator * eta * eta)
                                 : 0;
  }
  value[1] = value[2] = value[0];
}

/* Fresnel at 0.2 radians for an index of 1.5: 0.0400; of a pane 2 r / (1 + r) = 0.0769. */
const MaterialCase dielectric_material = {{
    {.parameters = "\"float eta\" 1.5", .refracts = 1.5},
    {.parameters = "\"float eta\" 1.5 \"float roughness\" .2", .refracts = 1.5},
    {.parameters = "\"float eta\" 2.2 \"float uroughness\" .3 \"float vroughness\" .6",
     .refracts = 2.2},
    {.parameters = "\"float eta\" .7 \"float roughness\" .3", .refracts = .7},
    {.parameters = "\"float eta\" 1.8 \"float uroughness\" .5 \"float vroughness\" .3 "
                   "\"bool remaproughness\" false",
     .refracts = 1.8,
     .formula = ground_glass},
}};
