/* texture/run.hot.h: textures evaluated node by node over a run of lanes; private to hot
 * files. */
#ifndef TEXTURE_RUN_HOT_H
#define TEXTURE_RUN_HOT_H

#include <stddef.h>

#include "texture/lookup.h"
#include "trace/stages.h"

/* A run of lanes and a stack of scratch rows for nested textures. */
typedef struct vlTextureRun {
  const vlWorld *world;
  vlVertices *at;
  vlTraceScratch *s;    /* corners and stack */
  uint32_t first, last; /* at most VL_MATERIAL_LANES lanes */
  uint32_t top;         /* first free row */
  /* offsets added to uv and position, for bump maps; or null */
  const float *shift_u, *shift_v, *shift_x, *shift_y, *shift_z;
  bool rgb; /* spectra are evaluated as linear sRGB, 0 in the fourth row, for nodes with
               vl_node_has_rgb_colors */
} vlTextureRun;

/* Evaluate a texture: a float; a spectrum at the four wavelengths; a spectrum times scale,
 * clamped to [0, 1]. Results go to lanes [first, last) of rows that have the size of the whole
 * batch. */
void vl_texture_float(vlTextureRun *r, int32_t node, float *row);
void vl_texture_spectrum(vlTextureRun *r, int32_t node, float rows[][VL_ROW_SIZE]);
void vl_texture_albedo(vlTextureRun *r, int32_t node, float scale, float rows[][VL_ROW_SIZE]);
/* What an image gives at lane i, before it becomes a float or a spectrum. */
vlTexel vl_texture_texel(const vlTextureRun *r, const vlTextureNode *node, uint32_t i);
/* Takes a scratch row, of which only lanes [first, last) exist; the caller frees it by
 * restoring r->top. The stack cannot overflow: texture/compile.c limits nesting. */
static inline float *vl_texture_row(vlTextureRun *r) {
  uint32_t row = r->top < VL_TEXTURE_ROWS - 1 ? r->top++ : r->top;
  /* within the scratch memory */
  float *stack = (float *)(void *)((char *)r->s + offsetof(vlTraceScratch, textures));
  return stack + row * VL_MATERIAL_LANES - r->first;
}
_Static_assert(offsetof(vlTraceScratch, textures) >= sizeof(float[VL_BATCH]),
               "a row less `first` is in the memory");

#endif
