/* texture/dots.h: the weight of dots in cells of (s, t). */
#ifndef TEXTURE_DOTS_H
#define TEXTURE_DOTS_H

#include "math/noise.h"
#include "texture/node.h"

/* 1 inside a dot, 0 outside. Texture space is divided into unit cells. About half of them
 * contain a dot of radius 0.35 at a random place. */
static inline float vl_node_dots(const vlTextureNode *node, vlTexturePoint at) {
  const float radius = 0.35f, shift = 0.5f - radius;
  vlVec2 st = vl_texture_st(node, at);
  float s = __builtin_floorf(st.x + 0.5f), t = __builtin_floorf(st.y + 0.5f);
  if (!(vl_noise(s + 0.5f, t + 0.5f, 0.5f) > 0.0f))
    return 0.0f;
  float x = st.x - (s + shift * vl_noise(s + 1.5f, t + 2.8f, 0.5f));
  float y = st.y - (t + shift * vl_noise(s + 4.5f, t + 9.8f, 0.5f));
  return x * x + y * y < radius * radius ? 1.0f : 0.0f;
}

#endif
