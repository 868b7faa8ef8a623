/* medium/homogeneous.case.c: what tests know of homogeneous media. */
#include "medium/medium.case.h"

static double density(const double p[3], PlainNoise *noise) {
  (void)noise;
  (void)p;
  return 0.4;
}

const MediumCase homogeneous_medium = {
    .shape = "",
    .scatters = "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"float g\" .6",
    .emits =
        "\"rgb sigma_a\" [.7 .7 .7] \"rgb sigma_s\" [.5 .5 .5] \"rgb Le\" [.5 .5 .5] "
        "\"float Lescale\" 2",
    .absorbs = "\"rgb sigma_a\" [.2 .2 .2] \"rgb sigma_s\" [0 0 0] \"float scale\" 2",
    .transmittance = 0.44932896,
    .density = density,
    .alike = {"\"rgb sigma_a\" [.2 .5 .9] \"rgb sigma_s\" [.1 .3 .2]",
              "\"rgb sigma_a\" [.1 .25 .45] \"rgb sigma_s\" [.05 .15 .1] \"float scale\" 2"},
    .parameters =
        {
            {.parameter = "Lescale", .base = "\"rgb Le\" [.3 .2 .1]"},
        },
};
