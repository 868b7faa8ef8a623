/* texture/marble.h: the colour of marble. */
#ifndef TEXTURE_MARBLE_H
#define TEXTURE_MARBLE_H

#include "texture/noise.h"

/* The colour along a vein, from a spline over nine colours. */
static inline vlVec3 vl_node_marble(const vlTextureNode *node, vlTexturePoint at) {
  static const float colors[9][3] = {{.58f, .58f, .6f}, {.58f, .58f, .6f}, {.58f, .58f, .6f},
                                     {.5f, .5f, .5f},   {.6f, .59f, .58f}, {.58f, .58f, .6f},
                                     {.58f, .58f, .6f}, {.2f, .2f, .33f},  {.58f, .58f, .6f}};
  enum { SEGMENTS = 6 };
  vlVec3 p = vl_mul(vl_texture_space(node, at.p), node->scale);
  float width = vl_abs(node->scale) * vl_texture_space_width(node, at);
  float vein = p.y + node->def->variation *
                         vl_fractal_noise(p, width, node->def->omega, vl_node_octaves(node));
  float t = 0.5f + 0.5f * vl_sincos(vl_clamp(vein, -1e4f, 1e4f)).sin;
  float s = vl_clamp(t, 0.0f, 1.0f) * SEGMENTS;
  int first = (int)s < SEGMENTS - 1 ? (int)s : SEGMENTS - 1;
  s -= (float)first;
  float out[3];
  for (int k = 0; k < 3; k++) { /* cubic Bezier */
    float a = colors[first][k], b = colors[first + 1][k], c = colors[first + 2][k],
          d = colors[first + 3][k];
    float r = 1.0f - s;
    out[k] =
        1.5f * (r * r * r * a + 3.0f * r * r * s * b + 3.0f * r * s * s * c + s * s * s * d);
  }
  return vl_load3(out);
}

#endif
