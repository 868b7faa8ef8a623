/* image/dct.c: see dct.h. */
#include "image/dct.h"

/* 0.5 cos(k pi / 16) */
static const float COSINE[8] = {0.5f,        0.49039264f, 0.46193977f, 0.41573481f,
                                0.35355339f, 0.27778512f, 0.19134172f, 0.09754516f};

/* Entry of the orthonormal inverse transform: sample n of frequency k. */
static float basis(int n, int k) {
  if (k == 0)
    return COSINE[4];
  int angle = (2 * n + 1) * k % 32; /* in units of pi / 16, period 32 */
  if (angle > 16)
    angle = 32 - angle;
  return angle <= 8 ? (angle == 8 ? 0.0f : COSINE[angle]) : -COSINE[16 - angle];
}

void vl_dct_make(float matrix[8][8]) {
  for (int n = 0; n < 8; n++)
    for (int k = 0; k < 8; k++)
      matrix[n][k] = basis(n, k);
}

void vl_dct_inverse(float block[64], const float matrix[8][8]) {
  float rows[64];
  for (int y = 0; y < 8; y++)
    for (int n = 0; n < 8; n++) {
      float sum = 0.0f;
      for (int k = 0; k < 8; k++)
        sum += matrix[n][k] * block[8 * y + k];
      rows[8 * y + n] = sum;
    }
  for (int n = 0; n < 8; n++)
    for (int x = 0; x < 8; x++) {
      float sum = 0.0f;
      for (int k = 0; k < 8; k++)
        sum += matrix[n][k] * rows[8 * k + x];
      block[8 * n + x] = sum;
    }
}
