/* world/texture/texture_node.h: the value of each kind of texture node at one point. The functions are inline and take
 * values. Two evaluators share these functions and thus agree to the bit: trace/texture/texture.hot.c over a batch,
 * textures.c at a single point. Both switch over vlNodeKind without a default, so that a missing kind is a compile
 * error. */
#ifndef WORLD_TEXTURE_TEXTURE_NODE_H
#define WORLD_TEXTURE_TEXTURE_NODE_H

#include "world/texture/texture_noise.h"

/* Kinds of nodes whose value is one function of the point, vl_node_NAME(node, at), listed by the type of the value.
 * Both evaluators take cases from these lists; they treat the other kinds separately. */
/* A float. */
#define VL_FLOAT_NODES(X) \
  X(FBM, fbm)             \
  X(WRINKLED, wrinkled)   \
  X(WINDY, windy)
/* A colour, linear RGB (vlVec3). */
#define VL_COLOR_NODES(X) X(MARBLE, marble)
/* The weight of the second of two inputs, which are floats or spectra. */
#define VL_SHARE_NODES(X)       \
  X(CHECKERBOARD, checkerboard) \
  X(DOTS, dots)                 \
  X(DIRECTION_MIX, direction_mix)

/* ---- nodes with inputs ------------------------------------------------------------------------------------------- */

/* VL_NODE_SCALE */
static inline float vl_node_scale(float a, float amount) {
  return a * amount;
}

/* VL_NODE_MIX, VL_NODE_CHECKERBOARD, VL_NODE_DOTS and VL_NODE_DIRECTION_MIX. share: weight of the second input. */
static inline float vl_node_mix(float a, float b, float share) {
  return (1 - share) * a + share * b;
}

/* VL_NODE_CHECKERBOARD: weight of the second input, 0 or 1. The pattern is not filtered; the samples of a pixel
 * antialias it. (pbrt filters it by ray differentials.) */
static inline float vl_node_checkerboard(const vlTextureNode *node, vlTexturePoint at) {
  if (node->dimension == 3) {
    vlVec3 q = vl_texture_space(node, at.p);
    int64_t sum = (int64_t)__builtin_floorf(q.x) + (int64_t)__builtin_floorf(q.y) + (int64_t)__builtin_floorf(q.z);
    return sum & 1 ? 1.0f : 0.0f;
  }
  vlVec2 st = vl_texture_st(node, at);
  int64_t sum = (int64_t)__builtin_floorf(st.x) + (int64_t)__builtin_floorf(st.y);
  return sum & 1 ? 1.0f : 0.0f;
}

/* VL_NODE_DIRECTION_MIX: weight of the second input. The weight of the first is the cosine between the normal and the
 * node's direction. */
static inline float vl_node_direction_mix(const vlTextureNode *node, vlTexturePoint at) {
  return 1.0f - vl_abs(vl_dot(at.n, vl_vec3(node->direction[0], node->direction[1], node->direction[2])));
}

/* VL_NODE_BILERP: weights of the four inputs a, b, c, d. The weighted inputs are added in this order, starting from
 * 0. */
typedef struct vlBilerpWeights {
  float w[4];
} vlBilerpWeights;
static inline vlBilerpWeights vl_node_bilerp(const vlTextureNode *node, vlTexturePoint at) {
  vlVec2 st = vl_texture_st(node, at);
  return (vlBilerpWeights){{(1 - st.x) * (1 - st.y), (1 - st.x) * st.y, st.x * (1 - st.y), st.x * st.y}};
}
static inline float vl_node_bilerp_add(float sum, float weight, float input) {
  return sum + weight * input;
}

/* ---- floats ------------------------------------------------------------------------------------------------------ */

/* A float from red, green, blue and coverage: the channel that the node selects. If it selects none: the coverage if
 * the image has it, otherwise the mean of the colours. mip is null for vertex colours alone. */
static inline float vl_texture_channel(const vlTextureNode *node, const vlMipmap *mip, vlTexturePoint at) {
  vlTexel t = vl_texture_rgba(node, mip, at);
  float x = node->bias;
  if (node->channel >= 0)
    x += t.c[node->channel];
  else
    x += mip && mip->channels == 4 ? t.c[3] : (t.c[0] + t.c[1] + t.c[2]) * (1.0f / 3.0f);
  return node->cutoff == node->cutoff ? (x >= node->cutoff ? 1.0f : 0.0f) : x;
}

/* The value of a plain image node (vlTextureNode.plain) whose texel is t. */
static inline float vl_plain_float(const vlMipmap *mip, vlTexel t) {
  uint32_t channels = mip->channels;
  return channels == 1 ? t.c[0] : channels == 4 ? t.c[3] : (t.c[0] + t.c[1] + t.c[2]) * (1.0f / 3.0f);
}

/* VL_NODE_IMAGE as a float, by pbrt's rule: the value of a grey image, the mean of three channels, the alpha of
 * four. */
static inline float vl_node_image_float(const vlTextureNode *node, const vlMipmap *mip, vlTexturePoint at) {
  if (!node->plain) return vl_texture_channel(node, mip, at);
  return vl_plain_float(mip, vl_texture_image(node, mip, at));
}

/* VL_NODE_VERTEX_COLOR */
static inline float vl_node_vertex_color_float(const vlTextureNode *node, vlTexturePoint at) {
  return vl_texture_channel(node, NULL, at);
}

/* ---- colours, linear RGB ----------------------------------------------------------------------------------------- */

/* The colour of a plain image node whose texel is t. */
static inline vlVec3 vl_plain_rgb(const vlMipmap *mip, vlTexel t) {
  bool grey = mip->channels < 3;
  return vl_vec3(t.c[0], grey ? t.c[0] : t.c[1], grey ? t.c[0] : t.c[2]);
}

/* VL_NODE_IMAGE */
static inline vlVec3 vl_node_image_rgb(const vlTextureNode *node, const vlMipmap *mip, vlTexturePoint at) {
  if (node->plain) return vl_plain_rgb(mip, vl_texture_image(node, mip, at));
  vlTexel t = vl_texture_rgba(node, mip, at);
  return vl_vec3(t.c[0], t.c[1], t.c[2]);
}

/* VL_NODE_VERTEX_COLOR */
static inline vlVec3 vl_node_vertex_color_rgb(const vlTextureNode *node, vlTexturePoint at) {
  vlTexel t = vl_texture_rgba(node, NULL, at);
  return vl_vec3(t.c[0], t.c[1], t.c[2]);
}

#endif
