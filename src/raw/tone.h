/* raw/tone.h: sRGB's curve to 16 bits, by a table. */
#ifndef RAW_TONE_H
#define RAW_TONE_H

#include "raw/raw.h"

enum { VL_TONE_CODES = 65536, VL_TONE_CELLS = 16384 };

/* The code of a linear value v in [0, 1) is the last one that begins at or before v. */
typedef struct vlTone {
  double begin[VL_TONE_CODES + 1]; /* of each code: sRGB's inverse of (code - 1/2) / 65535 */
  float near[VL_TONE_CELLS + 1];   /* about the code of i / VL_TONE_CELLS, with its fraction */
} vlTone;

/* Fills the table: 0.5 MB of doubles, 66,000 times the curve, which is less than the curve of
 * each value from a tenth of a megapixel on. Not from inside a parallel loop. */
void vl_tone_make(vlContext *context, vlTone *tone);
/* The codes of count values times scale; NaN and negative ones are 0. Any thread. */
void vl_tone_apply(const vlTone *tone, double scale, const float *values, size_t count,
                   uint16_t *codes);

#endif
