/* texture/image.h: the value of an image at a point. */
#ifndef TEXTURE_IMAGE_H
#define TEXTURE_IMAGE_H

#include "texture/vertex_color.h"

/* The value of a plain image node (vlTextureNode.plain) whose texel is t. */
static inline float vl_plain_float(const vlMipmap *mip, vlTexel t) {
  uint32_t channels = mip->channels;
  return channels < 3    ? t.c[0]
         : channels == 4 ? t.c[3]
                         : (t.c[0] + t.c[1] + t.c[2]) * (1.0f / 3.0f);
}

/* An image as a float, by pbrt's rule: the value of a grey image, the mean of three channels,
 * the alpha of four. */
static inline float vl_node_image_float(const vlTextureNode *node, const vlMipmap *mip,
                                        vlTexturePoint at) {
  if (!node->plain)
    return vl_texture_channel(node, mip, at);
  return vl_plain_float(mip, vl_texture_image(node, mip, at));
}

/* The colour of a plain image node whose texel is t. */
static inline vlVec3 vl_plain_rgb(const vlMipmap *mip, vlTexel t) {
  bool grey = mip->channels < 3;
  return vl_vec3(t.c[0], grey ? t.c[0] : t.c[1], grey ? t.c[0] : t.c[2]);
}

/* An image as a colour, linear RGB. */
static inline vlVec3 vl_node_image_rgb(const vlTextureNode *node, const vlMipmap *mip,
                                       vlTexturePoint at) {
  if (node->plain)
    return vl_plain_rgb(mip, vl_texture_image(node, mip, at));
  vlTexel t = vl_texture_rgba(node, mip, at);
  return vl_load3(t.c);
}

#endif
