/* world/light/emissive_faces.h: which faces of a mesh emit light if the emission is given by an image: those whose part
 * of the image has a texel that is not black. Only these become lights. */
#ifndef WORLD_LIGHT_EMISSIVE_FACES_H
#define WORLD_LIGHT_EMISSIVE_FACES_H

#include "world/world.h"

typedef struct vlEmissiveFaces {
  uint64_t *bits; /* one bit per texel, rows of `words`; null: all faces emit */
  uint32_t width, height, words;
  const vlTextureNode *node; /* of the image; null: st are uv, clamped */
  vlWrap wrap, wrap_t;
  bool any; /* at least one bit is set */
} vlEmissiveFaces;

/* Finds the texels that are not black. False: out of memory. */
bool vl_emissive_faces_make(const vlWorld *world, const vlEmitted *e, vlEmissiveFaces *s);
void vl_emissive_faces_free(const vlWorld *world, vlEmissiveFaces *s);

/* Whether a face of a triangle mesh or of patches emits light anywhere. True if that cannot be known. Never false
 * where a lookup of the emission is above 0. */
bool vl_face_emits(const vlEmissiveFaces *s, const vlWorldShape *shape, uint32_t prim);

#endif
