/* render/cryptomatte.h: names and their hashes for Cryptomatte (Psyop's specification 1.2): each object, material or
 * instance has a name of its own, and 32 bits that stand for it in the image. */
#ifndef RENDER_CRYPTOMATTE_H
#define RENDER_CRYPTOMATTE_H

#include "velo/channels.h"

typedef struct vlCryptomatte {
  vlIdKind kind;
  uint32_t count;        /* of ids: 1 to count */
  uint32_t *hash;        /* of id - 1; no two are equal */
  uint8_t *tries;        /* names of id - 1 that did not do */
  _Atomic uint8_t *seen; /* id - 1 is in the image */
} vlCryptomatte;

/* "CryptoObject", ...: what its channels are called. */
const char *vl_cryptomatte_type(vlIdKind kind);
/* MEMORY; close does no harm then. */
vlResult vl_cryptomatte_open(const vlWorld *world, vlIdKind kind, vlCryptomatte *c);
void vl_cryptomatte_close(vlContext *context, vlCryptomatte *c);
/* The header's four attributes; the manifest lists what was seen. */
vlResult vl_cryptomatte_describe(const vlWorld *world, const vlCryptomatte *c, vlImage *image);

#endif
