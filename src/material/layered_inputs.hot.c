/* material/layered_inputs.hot.c: parameters, over a run of lanes, of the layered materials
 * (random walks) and of diffuse transmission. */
#include "material/inputs.hot.h"
#include "math/hash.h"

/* A seed for each hit, from the pixel, its sample and the ray. */
static void seeds(vlTextureRun *r) {
  const vlPaths *p = &r->at->paths;
  for (uint32_t i = r->first; i < r->last; i++) {
    uint32_t pixel = vl_hash3((uint32_t)p->px[i], (uint32_t)p->py[i], p->index[i]);
    uint32_t ray =
        vl_hash3(vl_float_bits(p->d.x[i]), vl_float_bits(p->d.y[i]), vl_float_bits(p->d.z[i]));
    r->at->shade.seed[i] = vl_hash3(pixel, ray, vl_float_bits(p->o.x[i]));
  }
}

void vl_stage_layers(vlTextureRun *r, const vlWorldMaterial *m) {
  const vlWorldLayers *l = m->layers;
  vlShade *shade = &r->at->shade;
  float(*rows)[VL_ROW_SIZE] = shade->own;
  vl_texture_albedo(r, l->albedo, 1.0f, rows + VL_L_ALBEDO);
  vl_texture_float(r, l->thickness, rows[VL_L_THICKNESS]);
  vl_texture_float(r, l->g, rows[VL_L_G]);
  for (uint32_t i = r->first; i < r->last; i++) {
    rows[VL_L_METAL][i] = l->metal ? 1.0f : 0.0f;
    /* the smallest normal float, as pbrt */
    rows[VL_L_THICKNESS][i] = vl_max(rows[VL_L_THICKNESS][i], 0x1p-126f);
    rows[VL_L_G][i] = vl_clamp(rows[VL_L_G][i], -0.999f, 0.999f);
    rows[VL_L_DEPTH][i] = (float)l->depth;
    rows[VL_L_WALKS][i] = (float)l->walks;
  }
  if (l->metal) {
    for (uint32_t i = r->first; i < r->last; i++) {
      rows[VL_L_BASE_X][i] = shade->alpha_x[i];
      rows[VL_L_BASE_Y][i] = shade->alpha_y[i];
    }
    vl_stage_roughness(r, m, l->coat_u, shade->alpha_x);
    vl_stage_roughness(r, m, l->coat_v, shade->alpha_y);
    float inverse = 1.0f / m->eta_s; /* the metal's outside is the coat's medium */
    for (int c = 0; c < 4; c++)
      for (uint32_t i = r->first; i < r->last; i++) {
        shade->eta[c][i] *= inverse;
        shade->k[c][i] *= inverse;
      }
  }
  seeds(r);
}

void vl_stage_translucent(vlTextureRun *r, const vlWorldMaterial *m) {
  vlShade *shade = &r->at->shade;
  vl_texture_albedo(r, m->transmittance, m->scale, shade->own + VL_T_TRANSMITTANCE);
  for (int c = 0; c < 4; c++)
    for (uint32_t i = r->first; i < r->last; i++)
      shade->reflectance[c][i] = vl_clamp(m->scale * shade->reflectance[c][i], 0.0f, 1.0f);
}
