/* texture/windy.h: the height of waves on windy water. */
#ifndef TEXTURE_WINDY_H
#define TEXTURE_WINDY_H

#include "texture/noise.h"

static inline float vl_node_windy(const vlTextureNode *node, vlTexturePoint at) {
  vlVec3 p = vl_texture_space(node, at.p);
  float width = vl_texture_space_width(node, at);
  float wind = vl_fractal_noise(vl_mul(p, 0.1f), 0.1f * width, 0.5f, 3);
  return vl_abs(wind) * vl_fractal_noise(p, width, 0.5f, 6);
}

#endif
