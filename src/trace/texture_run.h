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

static inline vlTexturePoint vl_texture_point_of(const vlTextureRun *r, uint32_t i) {
  const vlSurface *f = r->surface;
  vlTexturePoint at;
  at.u = f->u[i], at.v = f->v[i];
  at.p = vl_vec3(f->px[i], f->py[i], f->pz[i]);
  at.n = vl_vec3(f->gx[i], f->gy[i], f->gz[i]); /* the true surface's, as pbrt's */
  at.width = f->width[i];
  at.uv_width = f->width[i] * f->uv_scale[i];
  if (r->shift_u) {
    at.u += r->shift_u[i], at.v += r->shift_v[i];
    at.p = vl_add(at.p, vl_vec3(r->shift_x[i], r->shift_y[i], r->shift_z[i]));
  }
  return at;
}

/* The principled material's rows of a run; the coat's normal stays in the world until there are frames. */
void VL_HOT(vl_stage_principled)(vlTextureRun *r, const vlWorldMaterial *m);
void VL_HOT(vl_stage_coat_frames)(const vlSurface *surface, vlShade *shade, uint32_t first, uint32_t last);

#endif
