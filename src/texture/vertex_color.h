/* texture/vertex_color.h: the colour of the shape's vertices at a point, and the channel of a
 * colour that a float texture reads. */
#ifndef TEXTURE_VERTEX_COLOR_H
#define TEXTURE_VERTEX_COLOR_H

#include "texture/lookup.h"

/* A float from red, green, blue and coverage: the channel that the node selects. If it selects
 * none: the coverage if the image has it, otherwise the mean of the colours. mip is null for
 * vertex colours alone. */
static inline float vl_texture_channel(const vlTextureNode *node, const vlMipmap *mip,
                                       vlTexturePoint at) {
  vlTexel t = vl_texture_rgba(node, mip, at);
  float x = node->bias;
  if (node->channel >= 0)
    x += t.c[node->channel];
  else
    x += mip && mip->channels == 4 ? t.c[3] : (t.c[0] + t.c[1] + t.c[2]) * (1.0f / 3.0f);
  return node->cutoff == node->cutoff ? (x >= node->cutoff ? 1.0f : 0.0f) : x;
}

static inline float vl_node_vertex_color_float(const vlTextureNode *node, vlTexturePoint at) {
  return vl_texture_channel(node, NULL, at);
}

static inline vlVec3 vl_node_vertex_color_rgb(const vlTextureNode *node, vlTexturePoint at) {
  vlTexel t = vl_texture_rgba(node, NULL, at);
  return vl_load3(t.c);
}

#endif
