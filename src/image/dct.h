/* image/dct.h: the inverse cosine transform of 8 x 8 values, orthonormal, with fixed bits: plain sums in a fixed order.
 */
#ifndef IMAGE_DCT_H
#define IMAGE_DCT_H

/* matrix[n][k]: what frequency k gives sample n. */
void vl_dct_make(float matrix[8][8]);
/* In place, row by row. */
void vl_dct_inverse(float block[64], const float matrix[8][8]);

#endif
