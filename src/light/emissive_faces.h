/* light/emissive_faces.h: finds the faces of a mesh that emit light if the emission is
 * given by an image. A face emits if a texel of its part of the image is not black. Only
 * emitting faces become lights. */
#ifndef LIGHT_EMISSIVE_FACES_H
#define LIGHT_EMISSIVE_FACES_H

#include "velo/lookup.h"
#include "world/world.h"

typedef struct vlEmissiveFaces {
  uint64_t *bits; /* one bit per texel, in rows of `words` integers; null: all faces emit */
  uint32_t width, height, words;
  const vlTextureNode *node; /* texture node of the image; null: (s, t) is uv, clamped */
  vlWrap wrap, wrap_t;
  bool any; /* at least one bit is set */
} vlEmissiveFaces;

/* Finds the texels that are not black. False: out of memory. */
bool vl_emissive_faces_make(const vlWorld *world, const vlEmitted *e, vlEmissiveFaces *s);
void vl_emissive_faces_free(const vlWorld *world, vlEmissiveFaces *s);

/* Whether a face of a mesh (triangles or patches) emits light anywhere. Returns true if this
 * cannot be determined. It never returns false for a face on which a lookup of the emission
 * exceeds 0. */
bool vl_face_emits(const vlEmissiveFaces *s, const vlWorldShape *shape, uint32_t prim);

#endif
