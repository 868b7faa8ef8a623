/* texture/wrinkled.h: the value of turbulence. */
#ifndef TEXTURE_WRINKLED_H
#define TEXTURE_WRINKLED_H

#include "texture/noise.h"

static inline float vl_node_wrinkled(const vlTextureNode *node, vlTexturePoint at) {
  return vl_turbulence(vl_texture_space(node, at.p), vl_texture_space_width(node, at),
                       node->def->omega, vl_node_octaves(node));
}

#endif
