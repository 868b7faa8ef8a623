/* world/light/shining.h: which faces of a mesh shine where an image says how much: those over whose part of the
 * image a texel is not black. The others are no lights. */
#ifndef WORLD_LIGHT_SHINING_H
#define WORLD_LIGHT_SHINING_H

#include "world/world.h"

typedef struct vlShining {
  uint64_t *bits; /* a bit a texel, rows of `words`; NULL: all faces shine */
  uint32_t width, height, words;
  const vlTextureNode *node; /* of the image; NULL: st are uv, clamped */
  vlWrap wrap, wrap_t;
  bool any; /* a bit is set */
} vlShining;

/* False: out of memory. */
bool vl_shining_make(const vlWorld *world, const vlEmitted *e, vlShining *s);
void vl_shining_free(const vlWorld *world, vlShining *s);

/* Does a face of a triangle mesh or of patches shine somewhere? True where that cannot be known. Never false where a
 * lookup of the emission is above 0. */
bool vl_shining_face(const vlShining *s, const vlWorldShape *shape, uint32_t prim);

#endif
