/* plain_noise.h: Perlin's noise of 2002 from its definition, in double. */
#ifndef TEST_WORLD_PLAIN_NOISE_H
#define TEST_WORLD_PLAIN_NOISE_H

#include <math.h>

#include "math/noise.h"

/* Each corner of the cell has a direction to an edge of a cube; its dot products with the way
 * to the point are blended by 6t^5 - 15t^4 + 10t^3. */
static double plain_noise(double x, double y, double z) {
  double p[3] = {x, y, z};
  double sum = 0;
  long cell[3];
  for (int i = 0; i < 3; i++)
    cell[i] = (long)floor(p[i]);
  for (int c = 0; c < 8; c++) {
    int hash = 0;
    double weight = 1;
    double d[3];
    for (int i = 0; i < 3; i++) {
      int far = c >> i & 1;
      double t = p[i] - (double)cell[i];
      double fade = t * t * t * (10 + t * (6 * t - 15));
      weight *= far ? fade : 1 - fade;
      d[i] = t - far;
      hash = vl_noise_permutation[(hash + (cell[i] & 255) + far) & 255];
    }
    /* the twelve edges, and four of them again; of each a pair of axes */
    static const int axes[16][2] = {{0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 2}, {0, 2},
                                    {0, 2}, {0, 2}, {1, 2}, {1, 2}, {1, 2}, {1, 2},
                                    {0, 1}, {0, 1}, {1, 2}, {1, 2}};
    int h = hash & 15;
    sum += weight * ((h & 1 ? -d[axes[h][0]] : d[axes[h][0]]) +
                     (h & 2 ? -d[axes[h][1]] : d[axes[h][1]]));
  }
  return sum;
}

#endif
