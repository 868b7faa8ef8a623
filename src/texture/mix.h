/* texture/mix.h: the value of two inputs that a share mixes. */
#ifndef TEXTURE_MIX_H
#define TEXTURE_MIX_H

#include "texture/node.h"

/* share: weight of the second input. Also of the other kinds that mix two inputs
 * (SHARE in VL_TEXTURE_KINDS). */
static inline float vl_node_mix(float a, float b, float share) {
  return (1 - share) * a + share * b;
}

#endif
