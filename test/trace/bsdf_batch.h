/* bsdf_batch.h: lanes for the BSDF tests: all arrays of a batch in one struct, filled lane by
 * lane. */
#ifndef TEST_TRACE_BSDF_BATCH_H
#define TEST_TRACE_BSDF_BATCH_H

#include <string.h>

#include "material/bsdf.hot.h"
#include "material/kinds.row.h"
#include "statistics.h"

enum { BATCH = 1024 };

typedef struct Batch {
  float reflectance[4][BATCH], eta[4][BATCH], k[4][BATCH], alpha_x[BATCH], alpha_y[BATCH],
      eta_s[BATCH];
  const vlCoatTable *coat[BATCH];
  float own[VL_BSDF_ROWS][BATCH], lambda[4][BATCH];
  uint32_t seed[BATCH];
  const vlMeasured *measured[BATCH];
  float ox[BATCH], oy[BATCH], oz[BATCH], ix[BATCH], iy[BATCH], iz[BATCH], lobe[BATCH], u[BATCH],
      v[BATCH];
  float value[4][BATCH], pdf[BATCH], weight[4][BATCH], scale[BATCH];
  uint32_t flags[BATCH];
} Batch;

/* One surface. */
typedef struct Surface {
  vlBsdfKind kind;
  float reflectance, eta, k, alpha_x, alpha_y, eta_s;
  const vlCoatTable *coat;
  const float *own; /* VL_BSDF_ROWS values */
  const vlMeasured *measured;
} Surface;

static inline vlBsdfParams batch_params(Batch *b) {
  vlBsdfParams p;
  for (int c = 0; c < 4; c++)
    p.tint[c] = NULL;
  for (int c = 0; c < 4; c++) {
    p.reflectance[c] = b->reflectance[c];
    p.eta[c] = b->eta[c];
    p.k[c] = b->k[c];
  }
  p.alpha_x = b->alpha_x;
  p.alpha_y = b->alpha_y;
  p.eta_s = b->eta_s;
  p.coat = b->coat;
  for (int k = 0; k < VL_BSDF_ROWS; k++)
    p.own[k] = b->own[k];
  for (int c = 0; c < 4; c++)
    p.lambda[c] = b->lambda[c];
  p.seed = b->seed;
  p.measured = b->measured;
  return p;
}
static inline void batch_surface(Batch *b, uint32_t i, const Surface *s) {
  for (int c = 0; c < 4; c++) {
    b->reflectance[c][i] = s->reflectance * (1.0f - 0.1f * (float)c);
    b->eta[c][i] = s->eta * (1.0f + 0.2f * (float)c);
    b->k[c][i] = s->k * (1.0f - 0.1f * (float)c);
  }
  b->alpha_x[i] = s->alpha_x;
  b->alpha_y[i] = s->alpha_y;
  b->eta_s[i] = s->eta_s;
  b->coat[i] = s->coat;
  b->measured[i] = s->measured;
  for (int k = 0; s->own && k < VL_BSDF_ROWS; k++)
    b->own[k][i] = s->own[k];
  for (int c = 0; c < 4; c++)
    b->lambda[c][i] = 420.0f + 80.0f * (float)c;
}
/* theta from +z; above pi/2 from below */
static inline void batch_wo(Batch *b, uint32_t i, double theta, double phi) {
  b->ox[i] = (float)(sin(theta) * cos(phi));
  b->oy[i] = (float)(sin(theta) * sin(phi));
  b->oz[i] = (float)cos(theta);
}
static inline void batch_numbers(Batch *b, uint32_t n, statRng *rng) {
  for (uint32_t i = 0; i < n; i++) {
    b->lobe[i] = stat_float(rng);
    b->u[i] = stat_float(rng);
    b->v[i] = stat_float(rng);
  }
}
static inline void batch_eval(const vlBsdfKernels *k, vlBsdfKind kind, uint32_t n, Batch *b) {
  vlBsdfParams p = batch_params(b);
  vlBsdfDirections wo = {b->ox, b->oy, b->oz}, wi = {b->ix, b->iy, b->iz};
  float *value[4] = {b->value[0], b->value[1], b->value[2], b->value[3]};
  k->eval[kind](n, &p, wo, wi, value, b->pdf);
}
/* the pdf is also written to b->pdf */
static inline void batch_sample(const vlBsdfKernels *k, vlBsdfKind kind, uint32_t n, Batch *b) {
  vlBsdfParams p = batch_params(b);
  vlBsdfDirections wo = {b->ox, b->oy, b->oz}, wi = {b->ix, b->iy, b->iz};
  vlBsdfRandom random = {b->lobe, b->u, b->v};
  vlBsdfSampled out = {
      wi, {b->weight[0], b->weight[1], b->weight[2], b->weight[3]}, b->pdf, b->flags, b->scale};
  k->sample[kind](n, &p, wo, random, out);
}

#endif
