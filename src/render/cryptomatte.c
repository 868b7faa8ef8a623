/* render/cryptomatte.c: see cryptomatte.h. */
#include "render/cryptomatte.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "base/context.h"
#include "base/free.h"
#include "base/text.h"
#include "world/world.h"

/* ---- the hash ---------------------------------------------------------------------------- */

static uint32_t rotate(uint32_t x, int bits) {
  return x << bits | x >> (32 - bits);
}
static uint32_t mix_block(uint32_t k) {
  return rotate(k * 0xcc9e2d51u, 15) * 0x1b873593u;
}

/* MurmurHash3_x86_32 (Appleby, public domain) with seed 0; blocks are little-endian. */
static uint32_t murmur(const char *text) {
  const uint8_t *bytes = (const uint8_t *)text;
  size_t length = strlen(text);
  uint32_t h = 0;
  for (size_t i = 0; i + 4 <= length; i += 4) {
    uint32_t k = bytes[i] | (uint32_t)bytes[i + 1] << 8 | (uint32_t)bytes[i + 2] << 16 |
                 (uint32_t)bytes[i + 3] << 24;
    h = rotate(h ^ mix_block(k), 13) * 5 + 0xe6546b64u;
  }
  uint32_t tail = 0;
  for (size_t i = length & ~(size_t)3, k = 0; i < length; i++, k += 8)
    tail |= (uint32_t)bytes[i] << k;
  h ^= mix_block(tail);
  h ^= (uint32_t)length;
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  return h ^ h >> 16;
}

/* Cryptomatte's hash of a name. It is stored as the bits of a float, so exponents of all zeros
 * (denormal) or all ones (infinity, NaN) are avoided. */
uint32_t vl_cryptomatte_hash(const char *name) {
  uint32_t h = murmur(name), exponent = h >> 23 & 255;
  return exponent == 0 || exponent == 255 ? h ^ 1u << 23 : h;
}

/* ---- names ------------------------------------------------------------------------------- */

enum { NAME_PART = 200, NAME_SIZE = NAME_PART + 32 };

/* Scene names are arbitrary bytes. In the manifest a name is UTF-8 without control characters,
 * of limited length. */
static void clean(const char *from, char to[NAME_PART + 1]) {
  size_t n = 0;
  while (*from) {
    uint32_t code;
    size_t bytes = vl_utf8_length(from, strnlen(from, 4), &code);
    bool good = bytes > 0 && (unsigned char)from[0] >= 32 && from[0] != 127;
    if (n + (good ? bytes : 1) > NAME_PART)
      break;
    if (good)
      memcpy(to + n, from, bytes);
    if (!good)
      to[n] = '_';
    n += good ? bytes : 1;
    from += bytes ? bytes : 1;
  }
  to[n] = 0;
}

/* The scene's name of the id. Where that name is missing or not unique, the id is added. */
static void make_name(const vlWorld *world, vlIdKind kind, uint32_t id, uint32_t tries,
                      char name[NAME_SIZE]) {
  vlIdInfo info = {0};
  char part[NAME_PART + 1];
  vl_world_id_info(world, kind, id, &info);
  clean(info.name ? info.name : info.type ? info.type : "", part);
  bool own = info.name && !info.shared_name;
  uint32_t more = tries - (own && tries ? 1 : 0);
  if (own && tries == 0)
    snprintf(name, NAME_SIZE, "%s", part);
  else if (more == 0)
    snprintf(name, NAME_SIZE, "%s.%u", part, id);
  else
    snprintf(name, NAME_SIZE, "%s.%u.%u", part, id, more);
}

const char *vl_cryptomatte_type(vlIdKind kind) {
  switch (kind) {
    case VL_ID_OBJECT:
      return "CryptoObject";
    case VL_ID_MATERIAL:
      return "CryptoMaterial";
    case VL_ID_INSTANCE:
      return "CryptoInstance";
  }
  return "CryptoAsset";
}

/* Chooses a distinct hash for each id. Two of some thousand names may have the same 32 bits;
 * then the later one gets another name. */
static void choose_hashes(const vlWorld *world, vlCryptomatte *c, uint32_t *table,
                          uint32_t mask) {
  char name[NAME_SIZE];
  for (uint32_t id = 1; id <= c->count; id++)
    for (uint32_t tries = 0; tries < 256; tries++) {
      make_name(world, c->kind, id, tries, name);
      uint32_t hash = vl_cryptomatte_hash(name), at = hash & mask;
      while (table[at] && table[at] != hash)
        at = (at + 1) & mask;
      if (table[at] == hash && tries < 255)
        continue;
      table[at] = c->hash[id - 1] = hash;
      c->tries[id - 1] = (uint8_t)tries;
      break;
    }
}

vlResult vl_cryptomatte_open(const vlWorld *world, vlIdKind kind, vlCryptomatte *c) {
  vlContext *context = world->context;
  c->kind = kind;
  c->count = vl_world_id_count(world, kind);
  uint32_t size = 16;
  while (size / 2 <= c->count && size < 0x80000000u)
    size *= 2;
  c->hash = vl_alloc_zero(context, (size_t)c->count + 1, sizeof *c->hash);
  c->tries = vl_alloc_zero(context, (size_t)c->count + 1, 1);
  c->seen = vl_alloc_zero(context, (size_t)c->count + 1, 1);
  uint32_t *table = vl_alloc_zero(context, size, sizeof *table);
  bool whole = c->hash && c->tries && c->seen && table;
  if (whole)
    choose_hashes(world, c, table, size - 1);
  vl_free(context, table);
  return whole ? VL_OK : VL_ERROR_MEMORY;
}

void vl_cryptomatte_close(vlContext *context, vlCryptomatte *c) {
  VL_FREE(context, c->hash, c->tries, (void *)c->seen);
}

/* ---- the header -------------------------------------------------------------------------- */

/* Writes {"name":"0123abcd",...}; to may be null. Returns its length in bytes. */
static size_t write_manifest(const vlWorld *world, const vlCryptomatte *c, char *to) {
  char name[NAME_SIZE], entry[2 * NAME_SIZE + 16];
  size_t n = 0;
  if (to)
    to[n] = '{';
  n++;
  for (uint32_t id = 1; id <= c->count; id++) {
    if (!atomic_load(&c->seen[id - 1]))
      continue;
    make_name(world, c->kind, id, c->tries[id - 1], name);
    size_t k = 0;
    if (n > 1)
      entry[k++] = ',';
    entry[k++] = '"';
    for (const char *at = name; *at; at++) {
      if (*at == '"' || *at == '\\')
        entry[k++] = '\\';
      entry[k++] = *at;
    }
    k += (size_t)snprintf(entry + k, sizeof entry - k, "\":\"%08x\"", c->hash[id - 1]);
    if (to)
      memcpy(to + n, entry, k);
    n += k;
  }
  if (to) {
    to[n] = '}';
    to[n + 1] = 0;
  }
  return n + 1;
}

static vlResult set_text(vlImage *image, uint32_t key, const char *name, const char *text) {
  char full[64]; /* the key is the first seven of the eight hexadecimal digits */
  snprintf(full, sizeof full, "cryptomatte/%07x/%s", key >> 4, name);
  vlAttribute attribute = {.name = full, .type = VL_ATTRIBUTE_STRING, .string = text};
  return vl_image_set_attribute(image, &attribute);
}

vlResult vl_cryptomatte_describe(const vlWorld *world, const vlCryptomatte *c, vlImage *image) {
  char *manifest = vl_alloc(world->context, write_manifest(world, c, NULL) + 1);
  if (!manifest)
    return VL_ERROR_MEMORY;
  write_manifest(world, c, manifest);
  const char *type = vl_cryptomatte_type(c->kind);
  uint32_t key = vl_cryptomatte_hash(type);
  vlResult result = set_text(image, key, "name", type);
  if (result == VL_OK)
    result = set_text(image, key, "hash", "MurmurHash3_32");
  if (result == VL_OK)
    result = set_text(image, key, "conversion", "uint32_to_float32");
  if (result == VL_OK)
    result = set_text(image, key, "manifest", manifest);
  vl_free(world->context, manifest);
  return result;
}
