/* texture/fbm.h: the value of fractional Brownian motion. */
#ifndef TEXTURE_FBM_H
#define TEXTURE_FBM_H

#include "texture/noise.h"

static inline float vl_node_fbm(const vlTextureNode *node, vlTexturePoint at) {
  return vl_fractal_noise(vl_texture_space(node, at.p), vl_texture_space_width(node, at),
                          node->def->omega, vl_node_octaves(node));
}

#endif
