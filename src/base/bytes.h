/* base/bytes.h: numbers in the bytes of files. */
#ifndef BASE_BYTES_H
#define BASE_BYTES_H

#include <stddef.h>
#include <stdint.h>

/* The 16-bit number whose least byte is the first. */
static inline uint32_t vl_little16(const void *at) {
  const uint8_t *b = (const uint8_t *)at;
  return b[0] | (uint32_t)b[1] << 8;
}

/* The 32-bit number whose least byte is the first. */
static inline uint32_t vl_little32(const void *at) {
  const uint8_t *b = (const uint8_t *)at;
  return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}
/* The number of `count` bytes, at most 8, whose least one is the first, or the last. */
static inline uint64_t vl_little(const void *at, size_t count) {
  uint64_t value = 0;
  while (count-- > 0)
    value = value << 8 | ((const uint8_t *)at)[count];
  return value;
}
static inline uint64_t vl_big(const void *at, size_t count) {
  uint64_t value = 0;
  for (size_t i = 0; i < count; i++)
    value = value << 8 | ((const uint8_t *)at)[i];
  return value;
}

#endif
