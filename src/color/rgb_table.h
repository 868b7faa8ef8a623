/* color/rgb_table.h: lookup of the RGB to spectrum table (Jakob and Hanika 2019), for hot loops: branch-free, vectorises
 * with gathers, the same bits everywhere. The tables are constant data made by tools/rgb_table.c when velo is built. */
#ifndef COLOR_RGB_TABLE_H
#define COLOR_RGB_TABLE_H

#include "color/color.h"

enum { VL_RGB_TABLE_SIZE = 32 };

typedef struct vlRgbTable {
  const float *coefficients; /* [largest component 3][z][y][x][3] */
} vlRgbTable;
/* Lives forever. */
const vlRgbTable *vl_rgb_table(vlColorSpace space);

/* Position of v in [0,1] on an axis whose nodes crowd towards 0 and 1: v = 8 u^4 below one half, mirrored above. */
static inline float vl_rgb_table_axis(float v) {
  float near = v < 0.5f ? v : 1.0f - v;
  float u = __builtin_sqrtf(__builtin_sqrtf(near * 0.125f));
  return (v < 0.5f ? u : 1.0f - u) * (float)(VL_RGB_TABLE_SIZE - 1);
}
static inline float vl_rgb_table_mix(float t, float a, float b) {
  return a + t * (b - a);
}

/* Coefficients of the reflectance whose colour under the space's illuminant is r, g, b (clamped to [0,1]). */
static inline vlSigmoid vl_rgb_table_lookup(const vlRgbTable *table, float r, float g, float b) {
  enum { N = VL_RGB_TABLE_SIZE };
  r = r > 0.0f ? (r < 1.0f ? r : 1.0f) : 0.0f;
  g = g > 0.0f ? (g < 1.0f ? g : 1.0f) : 0.0f;
  b = b > 0.0f ? (b < 1.0f ? b : 1.0f) : 0.0f;
  int big = r > g ? (r > b ? 0 : 2) : (g > b ? 1 : 2);
  float z = big == 0 ? r : big == 1 ? g : b;
  float inv = (float)(N - 1) / (z > 1e-20f ? z : 1e-20f);
  float x = (big == 0 ? g : big == 1 ? b : r) * inv;
  float y = (big == 0 ? b : big == 1 ? r : g) * inv;
  float w = vl_rgb_table_axis(z);
  int i = (int)x, j = (int)y, k = (int)w;
  i = i > N - 2 ? N - 2 : i;
  j = j > N - 2 ? N - 2 : j;
  k = k > N - 2 ? N - 2 : k;
  float dx = x - (float)i, dy = y - (float)j, dz = w - (float)k;
  const float *p = table->coefficients + 3 * (((big * N + k) * N + j) * N + i);
  enum { X = 3, Y = 3 * N, Z = 3 * N * N };
  float c[3];
  for (int q = 0; q < 3; q++) {
    float low = vl_rgb_table_mix(dy, vl_rgb_table_mix(dx, p[q], p[q + X]), vl_rgb_table_mix(dx, p[q + Y], p[q + X + Y]));
    float high = vl_rgb_table_mix(dy, vl_rgb_table_mix(dx, p[q + Z], p[q + X + Z]),
                                  vl_rgb_table_mix(dx, p[q + Y + Z], p[q + X + Y + Z]));
    c[q] = vl_rgb_table_mix(dz, low, high);
  }
  return (vlSigmoid){c[0], c[1], c[2]};
}

#endif
