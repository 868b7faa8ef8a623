/* image/flip.h: the FLIP error of two images (Andersson, Nilsson, Akenine-Moller, Oskarsson,
 * Astrom, Fairchild: "FLIP: A Difference Evaluator for Alternating Images", HPG 2020), the
 * version for low dynamic range. */
#ifndef IMAGE_FLIP_H
#define IMAGE_FLIP_H

#include "base/context.h"

/* Pixels per degree in the paper's viewing conditions: 0.7 m from a screen 0.7 m wide with 3840
 * pixels. */
#define VL_FLIP_PIXELS_PER_DEGREE 67.0206

/* a, b: width*height pixels of linear Rec.709 R G B in [0, 1], interleaved. flip receives
 * width*height values in [0, 1]. */
vlResult vl_flip(vlContext *context, uint32_t width, uint32_t height, const float *a,
                 const float *b, float *flip);

#endif
