/* material/hair_inputs.hot.c: the hair material's parameters over a run of lanes. */
#include "material/inputs.hot.h"

/* Lower bound of the reflectance: black would need infinite absorption. No display shows the
 * difference. */
#define DARKEST 1e-5f

/* Computes the sigma_a with which a volume of hair has the given reflectance (Chiang et al.
 * 2016, equation 9). */
static void from_reflectance(vlTextureRun *r, float (*rows)[VL_ROW_SIZE]) {
  vlShade *shade = &r->at->shade;
  for (uint32_t i = r->first; i < r->last; i++) {
    float b = vl_clamp(rows[VL_H_BETA_N][i], 0.0f, 1.0f), b2 = b * b;
    float d = 5.969f - 0.215f * b + 2.532f * b2 - 10.73f * b2 * b + 5.574f * b2 * b2 +
              0.245f * b2 * b2 * b;
    for (int c = 0; c < 4; c++) {
      float x = vl_ln(vl_max(shade->reflectance[c][i], DARKEST)) / d;
      rows[VL_H_SIGMA_A + c][i] = x * x;
    }
  }
}

void vl_stage_hair(vlTextureRun *r, const vlWorldMaterial *m) {
  const vlWorldHair *h = m->own;
  vlShade *shade = &r->at->shade;
  float(*rows)[VL_ROW_SIZE] = shade->own;
  vl_texture_float(r, h->beta_m, rows[VL_H_BETA_M]);
  vl_texture_float(r, h->beta_n, rows[VL_H_BETA_N]);
  vl_texture_float(r, h->alpha, rows[VL_H_ALPHA]);
  vl_texture_float(r, h->eta, shade->eta_s);
  for (uint32_t i = r->first; i < r->last; i++) {
    rows[VL_H_ALPHA][i] *= 0.017453292f;
    rows[VL_H_ACROSS][i] = vl_clamp(2.0f * r->at->surface.v[i] - 1.0f, -1.0f, 1.0f);
    shade->eta_s[i] = vl_clamp(shade->eta_s[i], 1.0001f, 10.0f);
  }
  if (h->sigma_a >= 0)
    vl_texture_spectrum(r, h->sigma_a, rows + VL_H_SIGMA_A);
  if (m->reflectance >= 0)
    from_reflectance(r, rows);
  if (h->eumelanin >= 0) {
    float(*extra)[VL_ROW_SIZE] = rows + VL_H_ROWS;
    float *share = vl_texture_row(r);
    vl_texture_spectrum(r, h->eumelanin, rows + VL_H_SIGMA_A);
    vl_texture_float(r, h->eumelanin_share, share);
    for (int c = 0; c < 4; c++)
      for (uint32_t i = r->first; i < r->last; i++)
        rows[VL_H_SIGMA_A + c][i] *= vl_max(share[i], 0.0f);
    vl_texture_spectrum(r, h->pheomelanin, extra);
    vl_texture_float(r, h->pheomelanin_share, share);
    for (int c = 0; c < 4; c++)
      for (uint32_t i = r->first; i < r->last; i++)
        rows[VL_H_SIGMA_A + c][i] += extra[c][i] * vl_max(share[i], 0.0f);
  }
}
