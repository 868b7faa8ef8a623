/* base/digest.c: see digest.h. */
#include "base/digest.h"

static uint64_t rotate(uint64_t x, int bits) {
  return x << bits | x >> (64 - bits);
}

static uint64_t mix(uint64_t k) {
  k = (k ^ k >> 33) * 0xff51afd7ed558ccdu;
  k = (k ^ k >> 33) * 0xc4ceb9fe1a85ec53u;
  return k ^ k >> 33;
}

/* Loads up to 8 bytes; the first byte becomes the lowest. */
static uint64_t load(const uint8_t *bytes, size_t count) {
  uint64_t value = 0;
  for (size_t i = 0; i < count; i++)
    value |= (uint64_t)bytes[i] << 8 * i;
  return value;
}

static const uint64_t c1 = 0x87c37b91114253d5u, c2 = 0x4cf5ad432745937fu;

static uint64_t scramble1(uint64_t k) {
  return rotate(k * c1, 31) * c2;
}
static uint64_t scramble2(uint64_t k) {
  return rotate(k * c2, 33) * c1;
}

void vl_digest(const void *data, size_t size, uint8_t digest[16]) {
  const uint8_t *bytes = data;
  uint64_t h1 = 0, h2 = 0;
  size_t blocks = size / 16, rest = size % 16;
  for (size_t i = 0; i < blocks; i++, bytes += 16) {
    h1 = (rotate(h1 ^ scramble1(load(bytes, 8)), 27) + h2) * 5 + 0x52dce729u;
    h2 = (rotate(h2 ^ scramble2(load(bytes + 8, 8)), 31) + h1) * 5 + 0x38495ab5u;
  }
  if (rest > 8)
    h2 ^= scramble2(load(bytes + 8, rest - 8));
  if (rest > 0)
    h1 ^= scramble1(load(bytes, rest < 8 ? rest : 8));
  h1 ^= size;
  h2 ^= size;
  h1 += h2;
  h2 += h1;
  h1 = mix(h1);
  h2 = mix(h2);
  h1 += h2;
  h2 += h1;
  for (int i = 0; i < 8; i++) {
    digest[i] = (uint8_t)(h1 >> (56 - 8 * i));
    digest[8 + i] = (uint8_t)(h2 >> (56 - 8 * i));
  }
}

void vl_digest_text(const uint8_t digest[16], char text[33]) {
  static const char digits[] = "0123456789abcdef";
  for (int i = 0; i < 16; i++) {
    text[2 * i] = digits[digest[i] >> 4];
    text[2 * i + 1] = digits[digest[i] & 15];
  }
  text[32] = 0;
}
