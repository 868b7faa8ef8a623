/* base/cookie.h: the cookies that vl_default_*_def() stores in a def. They reveal a def that was filled by hand or by a
 * library of another ABI version. The highest byte is 'v', the next two are the ABI version, the lowest is the def's
 * kind. */
#ifndef BASE_COOKIE_H
#define BASE_COOKIE_H

#include "velo/base.h"

#define VL_COOKIE_OF(kind, abi) (0x76000000 | ((abi)&0xffff) << 8 | (kind))
#define VL_COOKIE(kind) VL_COOKIE_OF(kind, VL_ABI_VERSION)

enum {
  VL_COOKIE_CONTEXT = VL_COOKIE(0x01),
  VL_COOKIE_IMAGE = VL_COOKIE(0x02),
  VL_COOKIE_WRITE = VL_COOKIE(0x03),
  VL_COOKIE_CAMERA = VL_COOKIE(0x04),
  VL_COOKIE_TEXTURE = VL_COOKIE(0x05),
  VL_COOKIE_MATERIAL = VL_COOKIE(0x06),
  VL_COOKIE_EMISSION = VL_COOKIE(0x07),
  VL_COOKIE_LIGHT = VL_COOKIE(0x08),
  VL_COOKIE_SHAPE = VL_COOKIE(0x09),
  VL_COOKIE_LOAD = VL_COOKIE(0x0a),
  VL_COOKIE_BUILD = VL_COOKIE(0x0b),
  VL_COOKIE_FILM = VL_COOKIE(0x0c),
  VL_COOKIE_DEVELOP = VL_COOKIE(0x0d),
  VL_COOKIE_RENDER = VL_COOKIE(0x0e),
  VL_COOKIE_MEDIUM = VL_COOKIE(0x0f),
  VL_COOKIE_CHANNELS = VL_COOKIE(0x20),
  VL_COOKIE_BOXES = VL_COOKIE(0x31),
  VL_COOKIE_COMPLETE = VL_COOKIE(0x30),
  VL_COOKIE_CAMERA_FILE = VL_COOKIE(0x21),
  VL_COOKIE_OPTICS = VL_COOKIE(0x22),
  VL_COOKIE_VANISHING = VL_COOKIE(0x28),
  VL_COOKIE_CHECK = VL_COOKIE(0x33),
  VL_COOKIE_SAVE = VL_COOKIE(0x34),
  VL_COOKIE_RECEIPT = VL_COOKIE(0x35),
  VL_COOKIE_FILM_WRITE = VL_COOKIE(0x36),
  VL_COOKIE_DENOISE = VL_COOKIE(0x38)
};

#endif
