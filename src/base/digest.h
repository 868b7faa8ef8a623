/* base/digest.h: a 128-bit digest of bytes, for telling whether a file changed: MurmurHash3_x64_128 (Austin Appleby,
 * public domain) with seed 0, the two words in order, each from its highest byte on, as `mmh3` and others print it. It
 * is no protection against a forged file. */
#ifndef BASE_DIGEST_H
#define BASE_DIGEST_H

#include <stddef.h>
#include <stdint.h>

void vl_digest(const void *data, size_t size, uint8_t digest[16]);
/* As 32 hexadecimal digits and a zero. */
void vl_digest_text(const uint8_t digest[16], char text[33]);

#endif
