/* color/rgb_table.h: lookup in the RGB to spectrum table (Jakob and Hanika 2019) for hot loops.
 * The code has no branches, vectorises with gathers and gives the same bits on every machine.
 * The tables are constant data that tools/color_tables makes when velo is built. Three
 * differences from the paper make a small table exact to 1e-3:
 * - Light colours use the complement, sigmoid(-x) = 1 - sigmoid(x), so that one table of dark
 *   colours serves both. Its resolution increases towards black, where the coefficients vary
 *   most.
 * - The table stores c sqrt(m (1 - m)), where m is the mean of r, g, b. Near black c grows as
 *   m^-1/2, while this product stays smooth. Along the greys it is linear, so that greys become
 *   constant spectra.
 * - The nodes of the axes are denser towards both ends (2 u^2). Interpolation weights are
 *   linear in the colour itself. */
#ifndef COLOR_RGB_TABLE_H
#define COLOR_RGB_TABLE_H

#include "base/attributes.h"
#include "color/color.h"

enum { VL_RGB_TABLE_XY = 40, VL_RGB_TABLE_Z = 48 };

typedef struct vlRgbTable {
  const float *coefficients; /* [largest component 3][z][y][x][3]; z: the largest component; x,
                                y: the other two divided by it, in cyclic order */
} vlRgbTable;
/* Static storage. */
const vlRgbTable *vl_rgb_table(vlColorSpace space);

/* Converts the value v in [0,1] of a component to its position u in [0,1] on a table axis; the
 * second function is the inverse. */
static inline float vl_rgb_axis(float v) {
  float w = 1.0f - v, near = v < w ? v : w;
  float u = __builtin_sqrtf(0.5f * near);
  return v < 0.5f ? u : 1.0f - u;
}
static inline float vl_rgb_axis_value(float u) {
  float w = 1.0f - u, low = 2.0f * u * u, high = 1.0f - 2.0f * w * w;
  return u < 0.5f ? low : high;
}

typedef struct vlRgbCell {
  int index;
  float t; /* weight of the upper node */
} vlRgbCell;
static inline vlRgbCell vl_rgb_cell(float v, int size) {
  int i = (int)(vl_rgb_axis(v) * (float)(size - 1));
  i = i < size - 2 ? i : size - 2;
  float step = 1.0f / (float)(size - 1);
  float low = vl_rgb_axis_value((float)i * step),
        high = vl_rgb_axis_value((float)(i + 1) * step);
  return (vlRgbCell){i, (v - low) / (high - low)};
}

/* Position of a colour in the table: its cell, the weights of the cell's upper nodes, and the
 * factor on the stored coefficients. The computation reads no memory. */
typedef struct vlRgbPoint {
  int index;
  float x, y, z, scale;
} vlRgbPoint;
VL_INLINE vlRgbPoint vl_rgb_point(float r, float g, float b) {
  r = r > 0.0f ? r : 0.0f;
  g = g > 0.0f ? g : 0.0f;
  b = b > 0.0f ? b : 0.0f;
  r = r < 1.0f ? r : 1.0f;
  g = g < 1.0f ? g : 1.0f;
  b = b < 1.0f ? b : 1.0f;
  float low = r < g ? r : g, high = r < g ? g : r;
  low = low < b ? low : b;
  high = high > b ? high : b;
  int flip = low + high > 1.0f;
  r = flip ? 1.0f - r : r;
  g = flip ? 1.0f - g : g;
  b = flip ? 1.0f - b : b;
  float z = flip ? 1.0f - low : high;
  int red = r == z, green = g == z;
  float x = red ? g : green ? b : r;
  float y = red ? b : green ? r : g;
  int face = red ? 0 : green ? 1 : 2;
  float divisor = z > 0.0f ? z : 1.0f;
  x = x / divisor;
  y = y / divisor;
  x = z > 0.0f ? x : 1.0f;
  y = z > 0.0f ? y : 1.0f;
  vlRgbCell cx = vl_rgb_cell(x, VL_RGB_TABLE_XY), cy = vl_rgb_cell(y, VL_RGB_TABLE_XY);
  vlRgbCell cz = vl_rgb_cell(z, VL_RGB_TABLE_Z);
  int i =
      3 * (((face * VL_RGB_TABLE_Z + cz.index) * VL_RGB_TABLE_XY + cy.index) * VL_RGB_TABLE_XY +
           cx.index);
  float m = (r + g + b) * (1.0f / 3.0f);
  float k = __builtin_sqrtf(m * (1.0f - m));
  /* black: exactly -2^30, for which the sigmoid is exactly 0 */
  k = k > 4.656612873e-10f ? k : 4.656612873e-10f;
  float scale = (flip ? -1.0f : 1.0f) / k;
  return (vlRgbPoint){i, cx.t, cy.t, cz.t, scale};
}

/* Interpolates one of the three coefficients; k is its index. */
VL_INLINE float vl_rgb_coefficient(const float *p, int k, vlRgbPoint at) {
  enum { X = 3, Y = 3 * VL_RGB_TABLE_XY, Z = 3 * VL_RGB_TABLE_XY * VL_RGB_TABLE_XY };
  int i = at.index + k;
  float a = p[i], b = p[i + Y], c = p[i + Z], d = p[i + Z + Y];
  a = a + at.x * (p[i + X] - a);
  b = b + at.x * (p[i + X + Y] - b);
  c = c + at.x * (p[i + X + Z] - c);
  d = d + at.x * (p[i + X + Z + Y] - d);
  a = a + at.y * (b - a);
  c = c + at.y * (d - c);
  return at.scale * (a + at.z * (c - a));
}

/* Coefficients of the reflectance with colour r, g, b (clamped to [0,1]) under the space's
 * illuminant. Loops that must vectorise under clang call the functions above instead, since
 * clang loses the simd pragma when this function is inlined through another. */
VL_INLINE vlSigmoid vl_rgb_table_lookup(const vlRgbTable *table, float r, float g, float b) {
  vlRgbPoint at = vl_rgb_point(r, g, b);
  const float *p = table->coefficients;
  return (vlSigmoid){vl_rgb_coefficient(p, 0, at), vl_rgb_coefficient(p, 1, at),
                     vl_rgb_coefficient(p, 2, at)};
}

#endif
