/* base/digest.h: a 128-bit digest of bytes, which tells whether a file changed. It is
 * MurmurHash3_x64_128 (Austin Appleby, public domain) with seed 0. Each of the two words is
 * stored with its highest byte first, as `mmh3` prints it. The digest does not protect against
 * forged files. */
#ifndef BASE_DIGEST_H
#define BASE_DIGEST_H

#include <stddef.h>
#include <stdint.h>

void vl_digest(const void *data, size_t size, uint8_t digest[16]);
/* Writes a digest as 32 hexadecimal digits and a zero byte. */
void vl_digest_text(const uint8_t digest[16], char text[33]);

#endif
