/* texture/kinds.h: the functions of all kinds of textures (VL_TEXTURE_KINDS). They are inline
 * and take values. Two evaluators share them and thus agree to the bit: batch.hot.c over a
 * batch, point.c at a single point. Both switch over vlTextureKind without a default, so that a
 * missing kind is a compile error. */
#ifndef TEXTURE_KINDS_H
#define TEXTURE_KINDS_H

#include "texture/bilerp.h"
#include "texture/checkerboard.h"
#include "texture/direction_mix.h"
#include "texture/dots.h"
#include "texture/fbm.h"
#include "texture/image.h"
#include "texture/marble.h"
#include "texture/mix.h"
#include "texture/scale.h"
#include "texture/windy.h"
#include "texture/wrinkled.h"
#include "velo/texture.h"
#include "world/world.h"

/* ---- what both evaluators do for each kind ----------------------------------------------- */

/* Sets the uv and vertex colour of a texture point on a triangle, as far as the node reads
 * them. */
static inline void vl_texture_at_corner(const vlTextureNode *node, const vlTextureCorner *where,
                                        vlTexturePoint *at) {
  for (int c = 0; c < 4; c++)
    at->color[c] = 1.0f;
  if (!where || !where->shape->triangles)
    return;
  const vlWorldShape *s = where->shape;
  const uint32_t *f = s->indices + 3 * (size_t)where->prim;
  const float *uvs = node->uv_set ? s->more_uvs[node->uv_set - 1] : NULL;
  if (uvs) {
    at->u = at->v = 0;
    for (int k = 0; k < 3; k++) {
      at->u += where->weights[k] * uvs[2 * (size_t)f[k]];
      at->v += where->weights[k] * uvs[2 * (size_t)f[k] + 1];
    }
  }
  for (int c = 0; node->colors && s->colors && c < 4; c++) {
    float sum = 0;
    for (int k = 0; k < 3; k++)
      sum += where->weights[k] * s->colors[4 * (size_t)f[k] + (size_t)c];
    at->color[c] = sum > 0.0f ? sum : 0.0f;
  }
}

#endif
