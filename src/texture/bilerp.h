/* texture/bilerp.h: the weights of the four corners of a bilinear interpolation. */
#ifndef TEXTURE_BILERP_H
#define TEXTURE_BILERP_H

#include "texture/node.h"

/* Weights of the four inputs a, b, c, d. The weighted inputs are added in this order, starting
 * from 0. */
typedef struct vlBilerpWeights {
  float w[4];
} vlBilerpWeights;
static inline vlBilerpWeights vl_node_bilerp(const vlTextureNode *node, vlTexturePoint at) {
  vlVec2 st = vl_texture_st(node, at);
  return (vlBilerpWeights){
      {(1 - st.x) * (1 - st.y), (1 - st.x) * st.y, st.x * (1 - st.y), st.x * st.y}};
}
static inline float vl_node_bilerp_add(float sum, float weight, float input) {
  return sum + weight * input;
}

#endif
