/* cli/sha256.c: see sha256.h. */
#include "cli/sha256.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { BLOCK = 64 };

typedef struct Sha256 {
  uint32_t state[8];
  uint64_t bytes;
} Sha256;

/* The word with its bits turned to the right by 1 to 31 places. */
static uint32_t turn(uint32_t x, int bits) {
  return x >> bits | x << (32 - bits);
}

/* A word of the file's bytes, the highest first. */
static uint32_t read_word(const uint8_t *p) {
  return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

/* FIPS 180-4, section 6.2.2. v[0] to v[7] are its a to h; k: its constants, section 4.2.2, the
 * fractions of the cube roots of the first 64 primes. */
static void take_block(Sha256 *s, const uint8_t block[BLOCK]) {
  static const uint32_t k[64] = {
      0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4,
      0xab1c5ed5, 0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe,
      0x9bdc06a7, 0xc19bf174, 0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f,
      0x4a7484aa, 0x5cb0a9dc, 0x76f988da, 0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7,
      0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967, 0x27b70a85, 0x2e1b2138, 0x4d2c6dfc,
      0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85, 0xa2bfe8a1, 0xa81a664b,
      0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070, 0x19a4c116,
      0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
      0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7,
      0xc67178f2};
  uint32_t w[64], v[8];
  memcpy(v, s->state, sizeof v);
  for (int i = 0; i < 16; i++)
    w[i] = read_word(block + 4 * i);
  for (int i = 16; i < 64; i++) {
    uint32_t a = w[i - 15], b = w[i - 2];
    w[i] = w[i - 16] + (turn(a, 7) ^ turn(a, 18) ^ a >> 3) + w[i - 7] +
           (turn(b, 17) ^ turn(b, 19) ^ b >> 10);
  }
  for (int i = 0; i < 64; i++) {
    uint32_t e = v[4], a = v[0];
    uint32_t t1 = v[7] + (turn(e, 6) ^ turn(e, 11) ^ turn(e, 25)) + ((e & v[5]) ^ (~e & v[6])) +
                  k[i] + w[i];
    uint32_t t2 =
        (turn(a, 2) ^ turn(a, 13) ^ turn(a, 22)) + ((a & v[1]) ^ (a & v[2]) ^ (v[1] & v[2]));
    memmove(v + 1, v, 7 * sizeof *v); /* h = g, g = f, ... b = a */
    v[4] += t1;
    v[0] = t1 + t2;
  }
  for (int i = 0; i < 8; i++)
    s->state[i] += v[i];
}

bool sha256_file(const char *path, char text[SHA256_TEXT]) {
  Sha256 s = {.state = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c,
                        0x1f83d9ab, 0x5be0cd19}};
  uint8_t block[2 * BLOCK] = {0};
  FILE *in = fopen(path, "rb");
  if (!in)
    return false;
  size_t n;
  while ((n = fread(block, 1, BLOCK, in)) == BLOCK) {
    take_block(&s, block);
    s.bytes += BLOCK;
  }
  bool read = !ferror(in);
  fclose(in);
  s.bytes += n;
  memset(block + n, 0, sizeof block - n);
  block[n] = 0x80;
  const size_t end = n + 9 > BLOCK ? 2 * BLOCK : BLOCK;
  for (size_t i = 0; i < 8; i++)
    block[end - 1 - i] = (uint8_t)(8 * s.bytes >> 8 * i);
  for (size_t at = 0; at < end; at += BLOCK)
    take_block(&s, block + at);
  for (int i = 0; i < 8; i++)
    snprintf(text + 8 * i, 9, "%08x", s.state[i]);
  return read;
}
