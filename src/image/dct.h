/* image/dct.h: the orthonormal inverse cosine transform of 8 x 8 values. Plain sums in a fixed
 * order give the same bits everywhere. */
#ifndef IMAGE_DCT_H
#define IMAGE_DCT_H

/* matrix[n][k]: the weight of frequency k in sample n. */
void vl_dct_make(float matrix[8][8]);
/* Transforms in place; values are stored by rows. */
void vl_dct_inverse(float block[64], const float matrix[8][8]);

#endif
