/* sampler/cells.hot.h: the samplers that divide the unit square into cells: regular,
 * stratified, n-rooks, multi-jittered, Hammersley. Each assigns cells to samples by a random
 * permutation per pixel and dimension, so that dimensions are independent. Source: Suffern,
 * "Ray Tracing from the Ground Up", chapter 5. */
#ifndef SAMPLER_CELLS_HOT_H
#define SAMPLER_CELLS_HOT_H

#include "sampler/chunk.hot.h"

/* 1-D points: sample `index` is in cell permute(index) of s->set cells, jittered or at the
 * cell's centre. */
VL_INLINE void vl_cells_1d(const int jittered, const vlSampler *s, const vlSamplerChunk *c,
                           float *u) {
  _Alignas(64) uint32_t cell[VL_SAMPLER_CHUNK];
  vl_permute_lanes(c->n, vl_permutation(s->set), c->index, c->key, 0, cell);
  uint32_t bits = s->jitter_bits, down = 32 - bits, half = 1u << (bits - 1);
  float scale = 1.0f / ((float)s->set * (float)(1u << bits));
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < c->n; i++) {
    uint32_t jitter = jittered ? vl_hash2(c->key[i], cell[i]) >> down : half;
    u[i] = vl_cell_float(cell[i] << bits | jitter, scale);
  }
}

/* Regular and stratified points. A row has grid_x or grid_x - 1 cells, and its height is
 * proportional to their number, so that all cells have the same area for any spp. */
VL_INLINE void vl_grid_2d(const int jittered, const vlSampler *s, const vlSamplerChunk *c,
                          float *u, float *v) {
  _Alignas(64) uint32_t cell[VL_SAMPLER_CHUNK];
  vl_permute_lanes(c->n, vl_permutation(s->set), c->index, c->key, 0, cell);
  uint32_t bits = s->jitter_bits, down = 32 - bits, half = 1u << (bits - 1);
  uint32_t columns = s->grid_x, fewer = columns > 1 ? columns - 1 : 1, edge = s->wide * columns;
  float inverse = 1.0f / (float)columns, inverse_fewer = 1.0f / (float)fewer,
        unit = 1.0f / (float)(1u << bits);
  float scale_y = unit / (float)s->set;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < c->n; i++) {
    uint32_t k = cell[i], narrow = k >= edge;
    uint32_t across = narrow ? fewer : columns;
    float inv = narrow ? inverse_fewer : inverse;
    uint32_t column = vl_divide(narrow ? k - edge : k, across, inv).remainder;
    uint32_t h = vl_hash2(c->key[i], k);
    uint32_t jx = jittered ? h >> down : half;
    uint32_t jy = jittered ? vl_hash(h) >> down : half;
    u[i] = vl_cell_float(column << bits | jx, inv * unit);
    v[i] = vl_cell_float(((k - column) << bits) + across * jy, scale_y);
  }
}

VL_INLINE void vl_nrooks_2d(const vlSampler *s, const vlSamplerChunk *c, float *u, float *v) {
  _Alignas(64) uint32_t row[VL_SAMPLER_CHUNK], column[VL_SAMPLER_CHUNK];
  vlPermutation p = vl_permutation(s->set);
  vl_permute_lanes(c->n, p, c->index, c->key, 0, column);
  vl_permute_lanes(c->n, p, c->index, c->key, 0x68e31da4u, row);
  uint32_t bits = s->jitter_bits, down = 32 - bits;
  float scale = 1.0f / ((float)s->set * (float)(1u << bits));
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < c->n; i++) {
    uint32_t h = vl_hash2(c->key[i], column[i]);
    u[i] = vl_cell_float(column[i] << bits | h >> down, scale);
    v[i] = vl_cell_float(row[i] << bits | vl_hash(h) >> down, scale);
  }
}

/* Correlated multi-jittered points (Kensler 2013, "Correlated Multi-Jittered Sampling", the
 * form for any number of samples). m and n are the numbers of columns and rows. Sample k = row
 * m + column has y = (k + jitter) / set, x = (px(column) + (py(row) + jitter) / n) / m. */
VL_INLINE void vl_multi_jittered_2d(const vlSampler *s, const vlSamplerChunk *c, float *u,
                                    float *v) {
  _Alignas(64) uint32_t k[VL_SAMPLER_CHUNK], row[VL_SAMPLER_CHUNK], column[VL_SAMPLER_CHUNK];
  uint32_t m = s->grid_x, n = (s->set + m - 1) / m;
  vl_permute_lanes(c->n, vl_permutation(s->set), c->index, c->key, 0, k);
  float inverse = 1.0f / (float)m;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < c->n; i++) {
    vlDivision d = vl_divide(k[i], m, inverse);
    row[i] = d.quotient;
    column[i] = d.remainder;
  }
  vl_permute_lanes(c->n, vl_permutation(m), column, c->key, 0x68e31da4u, column);
  vl_permute_lanes(c->n, vl_permutation(n), row, c->key, 0xb5297a4du, row);
  uint32_t bits = s->jitter_bits, down = 32 - bits;
  float unit = 1.0f / (float)(1u << bits), scale_x = unit / ((float)m * (float)n),
        scale_y = unit / (float)s->set;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < c->n; i++) {
    uint32_t h = vl_hash2(c->key[i], k[i]);
    u[i] = vl_cell_float((column[i] * n + row[i]) << bits | h >> down, scale_x);
    v[i] = vl_cell_float(k[i] << bits | vl_hash(h) >> down, scale_y);
  }
}

/* Hammersley points: point i of n is (i / n, radical inverse of i). Its x is jittered within
 * the column, and the binary digits of its y are flipped at random. */
VL_INLINE void vl_hammersley_2d(const vlSampler *s, const vlSamplerChunk *c, float *u,
                                float *v) {
  _Alignas(64) uint32_t k[VL_SAMPLER_CHUNK];
  vl_permute_lanes(c->n, vl_permutation(s->set), c->index, c->key, 0, k);
  uint32_t bits = s->jitter_bits, down = 32 - bits;
  float scale = 1.0f / ((float)s->set * (float)(1u << bits));
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < c->n; i++) {
    uint32_t h = vl_hash2(c->key[i], k[i]);
    u[i] = vl_cell_float(k[i] << bits | h >> down, scale);
    v[i] = vl_unit_float(vl_reverse_bits(k[i]) ^ vl_hash(c->key[i] + 0x1b56c4e9u));
  }
}

#endif
