/* trace/material/layers.hot.c: parameters, over a run of lanes, of the materials with random walks between layers and
 * of those that let diffuse light through. */
#include "math/hash.h"
#include "trace/texture/texture_run.h"

static void colour(vlTextureRun *r, int32_t node, float rows[][VL_ROW_SIZE], float scale) {
  float *const out[4] = {rows[0], rows[1], rows[2], rows[3]};
  vl_texture_spectrum(r, node, out);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = r->first; i < r->last; i++) rows[c][i] = vl_clamp(scale * rows[c][i], 0.0f, 1.0f);
}

static void alpha(vlTextureRun *r, const vlWorldMaterial *m, int32_t node, float *row) {
  vl_texture_float(r, node, row);
  for (uint32_t i = r->first; i < r->last; i++) {
    float x = row[i] > 0.0f ? row[i] : 0.0f;
    row[i] = m->remap ? __builtin_sqrtf(x) : x;
  }
}

/* Random numbers of a hit's own: of the pixel, its sample and the ray. */
static void seeds(vlTextureRun *r) {
  const vlPaths *p = r->paths;
  for (uint32_t i = r->first; i < r->last; i++) {
    uint32_t pixel = vl_hash3((uint32_t)p->px[i], (uint32_t)p->py[i], p->index[i]);
    uint32_t ray = vl_hash3(vl_float_bits(p->dx[i]), vl_float_bits(p->dy[i]), vl_float_bits(p->dz[i]));
    r->s->shade.seed[i] = vl_hash3(pixel, ray, vl_float_bits(p->ox[i]));
  }
}

void vl_stage_layers(vlTextureRun *r, const vlWorldMaterial *m) {
  const vlWorldLayers *l = m->own;
  vlShade *shade = &r->s->shade;
  float(*rows)[VL_ROW_SIZE] = shade->own;
  colour(r, l->albedo, rows + VL_L_ALBEDO, 1.0f);
  vl_texture_float(r, l->thickness, rows[VL_L_THICKNESS]);
  vl_texture_float(r, l->g, rows[VL_L_G]);
  for (uint32_t i = r->first; i < r->last; i++) {
    rows[VL_L_METAL][i] = l->metal ? 1.0f : 0.0f;
    rows[VL_L_THICKNESS][i] = vl_max(rows[VL_L_THICKNESS][i], 1.17549435e-38f); /* pbrt's least */
    rows[VL_L_G][i] = vl_clamp(rows[VL_L_G][i], -0.999f, 0.999f);
    rows[VL_L_DEPTH][i] = (float)l->depth;
    rows[VL_L_WALKS][i] = (float)l->walks;
  }
  if (l->metal) {
    for (uint32_t i = r->first; i < r->last; i++) {
      rows[VL_L_BASE_X][i] = shade->alpha_x[i];
      rows[VL_L_BASE_Y][i] = shade->alpha_y[i];
    }
    alpha(r, m, l->coat_u, shade->alpha_x);
    alpha(r, m, l->coat_v, shade->alpha_y);
    float inverse = 1.0f / m->eta_s; /* the metal lies in the coat's medium */
    for (int c = 0; c < 4; c++)
      for (uint32_t i = r->first; i < r->last; i++) {
        shade->eta[c][i] *= inverse;
        shade->k[c][i] *= inverse;
      }
  }
  seeds(r);
}

void vl_stage_translucent(vlTextureRun *r, const vlWorldMaterial *m) {
  vlShade *shade = &r->s->shade;
  colour(r, m->transmittance, shade->own + VL_T_TRANSMITTANCE, m->scale);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = r->first; i < r->last; i++)
      shade->reflectance[c][i] = vl_clamp(m->scale * shade->reflectance[c][i], 0.0f, 1.0f);
}
