/* texture/checkerboard.h: the value of a checkerboard: squares of (s, t), or cubes in texture
 * space. */
#ifndef TEXTURE_CHECKERBOARD_H
#define TEXTURE_CHECKERBOARD_H

#include "texture/node.h"
#include "velo/texture.h"

/* Weight of the second input, 0 or 1. The pattern is not filtered; the samples of a pixel
 * antialias it. (pbrt filters it by ray differentials.) */
static inline float vl_node_checkerboard(const vlTextureNode *node, vlTexturePoint at) {
  if (node->def->dimension == 3) {
    vlVec3 q = vl_texture_space(node, at.p);
    int64_t sum = (int64_t)__builtin_floorf(q.x) + (int64_t)__builtin_floorf(q.y) +
                  (int64_t)__builtin_floorf(q.z);
    return sum & 1 ? 1.0f : 0.0f;
  }
  vlVec2 st = vl_texture_st(node, at);
  int64_t sum = (int64_t)__builtin_floorf(st.x) + (int64_t)__builtin_floorf(st.y);
  return sum & 1 ? 1.0f : 0.0f;
}

#endif
