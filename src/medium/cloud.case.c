/* medium/cloud.case.c: what tests know of clouds. */
#include "medium/medium.case.h"

/* The slope of noise, by pbrt's differences. */
static void slope(PlainNoise *noise, const double p[3], double d[3]) {
  const double step = 0.01;
  for (int k = 0; k < 3; k++) {
    double q[3] = {p[0], p[1], p[2]};
    q[k] += step;
    d[k] = (noise(q[0], q[1], q[2]) - noise(p[0], p[1], p[2])) / step;
  }
}

/* pbrt-v4 (CloudMedium::Density): two octaves of wisps move the point along the noise's slope,
 * five octaves of noise are thinner with height, and below y = .5 a floor is added. The density
 * is 3, the wispiness 1, the frequency 5; the extinction 1. */
static double density(const double p[3], PlainNoise *noise) {
  double q[3] = {5 * p[0], 5 * p[1], 5 * p[2]};
  for (int i = 0; i < 2; i++) {
    const double size = i ? 19.9 : 10;
    const double at[3] = {size * q[0], size * q[1], size * q[2]};
    double d[3];
    slope(noise, at, d);
    for (int k = 0; k < 3; k++)
      q[k] += (i ? 0.025 : 0.05) * d[k];
  }
  const double sum = 0.5 * plain_fractal(noise, q, 0, 0.5, 5);
  const double thin = fmin(fmax((1 - p[1]) * 4.5 * 3 * sum, 0), 1);
  return fmin(thin + 2 * fmax(0, 0.5 - p[1]), 1);
}

const MediumCase cloud_medium = {
    .shape = BOX "\"float density\" 3 ",
    .scatters = "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"float g\" .5",
    .absorbs = "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [0 0 0]",
    .density = density,
    /* above y = 1 the noise counts the other way */
    .tall =
        "\"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 3 1] \"float density\" 3 "
        "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [0 0 0]",
    .parameters =
        {
            {.base = "\"point3 p0\" [-1 -1 -1];\"point3 p1\" [1 1 1];\"float density\" 4"},
            {.parameter = "density", .value = "\"float density\" 3"},
        },
};
