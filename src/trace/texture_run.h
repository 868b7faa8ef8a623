/* trace/texture_run.h: textures evaluated node by node over a run of lanes; private to the hot files of trace. */
#ifndef TRACE_TEXTURE_RUN_H
#define TRACE_TEXTURE_RUN_H

#include "trace/stages.h"
#include "world/texture_lookup.h"

/* A run of lanes and a stack of scratch rows for nested textures. */
typedef struct vlTextureRun {
  const vlWorld *world;
  vlTraceScratch *s;
  const vlPaths *paths;
  const vlSurface *surface;
  uint32_t first, last;
  uint32_t top;                                                 /* first free row */
  const float *shift_u, *shift_v, *shift_x, *shift_y, *shift_z; /* added to uv and position (bump), or null */
} vlTextureRun;

/* Results go to lanes [first, last) of out (rows of the whole batch). */
void VL_HOT(vl_texture_float)(vlTextureRun *r, int32_t node, float *out);
void VL_HOT(vl_texture_spectrum)(vlTextureRun *r, int32_t node, float *const out[4]);
/* A scratch row; the caller gives it back by restoring r->top. */
static inline float *vl_texture_row(vlTextureRun *r) {
  return r->s->rows[r->top < VL_TEXTURE_ROWS - 1 ? r->top++ : r->top]; /* enough: world/texture.c limits nesting */
}

#endif
