/* texture/noise.h: what the textures from noise share. Patterns and constants are those of pbrt
 * (pbrt 3rd edition, 10.6; the fourth edition keeps them). */
#ifndef TEXTURE_NOISE_H
#define TEXTURE_NOISE_H

#include "math/noise.h"
#include "texture/node.h"
#include "velo/texture.h"

/* Width of the footprint in texture space: its width in world units times the largest factor by
 * which the map from world to texture space stretches a length. */
static inline float vl_texture_space_width(const vlTextureNode *node, vlTexturePoint at) {
  const float *m = node->texture_from_world;
  float x = m[0] * m[0] + m[4] * m[4] + m[8] * m[8],
        y = m[1] * m[1] + m[5] * m[5] + m[9] * m[9];
  float z = m[2] * m[2] + m[6] * m[6] + m[10] * m[10];
  return at.width * __builtin_sqrtf(vl_max(x, vl_max(y, z)));
}

static inline uint32_t vl_node_octaves(const vlTextureNode *node) {
  return node->def->octaves < 64 ? node->def->octaves : 64;
}

#endif
