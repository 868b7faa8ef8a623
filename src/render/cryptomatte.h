/* render/cryptomatte.h: names and their hashes for Cryptomatte (Psyop's specification 1.2).
 * Each object, material or instance has a unique name, and a hash of 32 bits that represents it
 * in the image. */
#ifndef RENDER_CRYPTOMATTE_H
#define RENDER_CRYPTOMATTE_H

#include "velo/channels.h"

typedef struct vlCryptomatte {
  vlIdKind kind;
  uint32_t count;        /* ids are 1 to count */
  uint32_t *hash;        /* of id - 1; no two are equal */
  uint8_t *tries;        /* by id - 1: number of rejected names (hash collisions) */
  _Atomic uint8_t *seen; /* by id - 1: 1 if it is in the image */
} vlCryptomatte;

/* The layer name of the kind's channels: "CryptoObject", ... */
const char *vl_cryptomatte_type(vlIdKind kind);
/* Makes names and hashes. Error: MEMORY; vl_cryptomatte_close is allowed after it. */
vlResult vl_cryptomatte_open(const vlWorld *world, vlIdKind kind, vlCryptomatte *c);
void vl_cryptomatte_close(vlContext *context, vlCryptomatte *c);
/* Writes the four header attributes to the image. The manifest lists the ids in the image. */
vlResult vl_cryptomatte_describe(const vlWorld *world, const vlCryptomatte *c, vlImage *image);

#endif
