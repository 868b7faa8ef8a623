/* raw/demosaic.h: the colours of every pixel of a mosaic. */
#ifndef RAW_DEMOSAIC_H
#define RAW_DEMOSAIC_H

#include "raw/raw.h"

/* Interpolates the colours that a pixel lacks: the mean of the pixels with that colour in the
 * window |dx|, |dy| <= r around it, weighted by (r + 1 - |dx|)(r + 1 - |dy|). r is the least
 * for which each quarter of the window has every colour: 1 for Bayer, where this is bilinear
 * interpolation, 2 for Quad Bayer. Pixels beyond the border are left out, and the weights of
 * the others add up to 1. A colour that the image does not have in the window is 0.
 *
 * mosaic: width * height; result: interleaved, as many values per pixel as colours. Not from
 * inside a parallel loop. */
void vl_raw_demosaic(vlContext *context, const vlRawDef *def, const float *mosaic,
                     float *result);

#endif
