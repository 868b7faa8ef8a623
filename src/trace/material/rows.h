/* trace/material/rows.h: evaluation of material parameters over a run of lanes; private to the
 * hot files of trace/material and to subsurface.hot.c. Results go to lanes [r->first, r->last)
 * of the rows. */
#ifndef TRACE_MATERIAL_ROWS_H
#define TRACE_MATERIAL_ROWS_H

#include "texture/run.hot.h"

/* Evaluates a spectrum texture at the four wavelengths. */
static inline void vl_rows_spectrum(vlTextureRun *r, int32_t node, float rows[][VL_ROW_SIZE]) {
  float *const out[4] = {rows[0], rows[1], rows[2], rows[3]};
  vl_texture_spectrum(r, node, out);
}

/* Evaluates a spectrum texture times scale, clamped to [0, 1]. */
static inline void vl_rows_albedo(vlTextureRun *r, int32_t node, float scale,
                                  float rows[][VL_ROW_SIZE]) {
  vl_rows_spectrum(r, node, rows);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = r->first; i < r->last; i++)
      rows[c][i] = vl_clamp(scale * rows[c][i], 0.0f, 1.0f);
}

/* Evaluates a roughness texture to the microfacets' alpha. If the material has pbrt's
 * remaproughness, alpha is the square root of the roughness. */
static inline void vl_row_alpha(vlTextureRun *r, const vlWorldMaterial *m, int32_t node,
                                float *alpha) {
  vl_texture_float(r, node, alpha);
  for (uint32_t i = r->first; i < r->last; i++) {
    float x = alpha[i] > 0.0f ? alpha[i] : 0.0f;
    alpha[i] = m->remap ? __builtin_sqrtf(x) : x;
  }
}

#endif
