/* texture/direction_mix.h: the weight of a direction mix, by the normal. */
#ifndef TEXTURE_DIRECTION_MIX_H
#define TEXTURE_DIRECTION_MIX_H

#include "texture/node.h"
#include "velo/texture.h"

/* Weight of the second input. The weight of the first is the cosine between the normal and the
 * node's direction. */
static inline float vl_node_direction_mix(const vlTextureNode *node, vlTexturePoint at) {
  const float *d = node->def->direction;
  return 1.0f - vl_abs(vl_dot(at.n, vl_load3(d)));
}

#endif
