/* base/bytes.h: numbers in the bytes of files. */
#ifndef BASE_BYTES_H
#define BASE_BYTES_H

#include <stdint.h>

/* The 32-bit number whose least byte is the first. */
static inline uint32_t vl_little32(const void *at) {
  const uint8_t *b = (const uint8_t *)at;
  return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

#endif
