/* texture/scale.h: the value of a scaled texture. */
#ifndef TEXTURE_SCALE_H
#define TEXTURE_SCALE_H

#include "texture/node.h"

static inline float vl_node_scale(float a, float amount) {
  return a * amount;
}

#endif
