/* image/exr_huffman.h: OpenEXR's Huffman coding of 16-bit values (PIZ and DWA). */
#ifndef IMAGE_EXR_HUFFMAN_H
#define IMAGE_EXR_HUFFMAN_H

#include "base/context.h"

/* Decodes exactly `count` values. Returns SCENE when the data is broken. */
vlResult vl_huffman_unpack(vlContext *context, const uint8_t *packed, size_t size,
                           uint16_t *values, size_t count);

#endif
