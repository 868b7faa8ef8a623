/* image/exr_dwa.h: decoding of DWAA and DWAB chunks, which OpenEXRCore 3.1 leaves to the C++
 * library. */
#ifndef IMAGE_EXR_DWA_H
#define IMAGE_EXR_DWA_H

#include "base/context.h"

typedef struct vlDwaChannel {
  const char *name;
  int type;    /* pixel type of the file: 0 uint, 1 half, 2 float */
  bool linear; /* pLinear of the channel list: the values are not encoded */
} vlDwaChannel;

/* Fills the decoding curve: 65536 halves, indexed by the bits of the encoded half. */
void vl_dwa_make_curve(uint16_t *curve);

/* Decodes one chunk of width*height pixels. unpacked receives, for each line, each channel's
 * values in the given order, as in an uncompressed file. Returns SCENE when the data is
 * broken. */
vlResult vl_dwa_unpack(vlContext *context, const vlDwaChannel *channels, uint32_t count,
                       uint32_t width, uint32_t height, const uint16_t *curve,
                       const uint8_t *packed, size_t packed_size, uint8_t *unpacked);

#endif
