/* image/exr_huffman.c: canonical Huffman codes of up to 58 bits. The symbols are the 65536
 * values and one more, which is the largest symbol in use. It repeats the last value n times;
 * the next eight bits hold n. Longer codes are numerically lower. */
#include "image/exr_huffman.h"

#include "base/bytes.h"

enum { SYMBOLS = 65537, MAX_LENGTH = 58 };

typedef struct Bits {
  const uint8_t *data;
  size_t at, end; /* in bits */
} Bits;

/* Reads n <= 8 bits, most significant first. Past the end they are 0 and `at` exceeds `end`. */
static uint32_t take(Bits *b, uint32_t n) {
  uint32_t v = 0;
  for (; n; n--, b->at++)
    v = v << 1 | (b->at < b->end ? b->data[b->at >> 3] >> (7 - (b->at & 7)) & 1u : 0);
  return v;
}

typedef struct Decoder {
  uint8_t length[SYMBOLS];
  uint32_t symbols[SYMBOLS];       /* sorted by length, then by value */
  uint64_t lowest[MAX_LENGTH + 1]; /* lowest code of each length */
  uint32_t count[MAX_LENGTH + 1], first[MAX_LENGTH + 1];
} Decoder;

/* Reads the lengths of the symbols in ascending order, six bits each. 59 to 62 stand for 2 to 5
 * zeros; 63 and a byte for 6 or more. */
static bool read_lengths(Decoder *d, Bits *b, uint32_t low, uint32_t high) {
  for (uint32_t i = low; i <= high;) {
    if (b->at >= b->end)
      return false;
    uint32_t l = take(b, 6);
    if (l <= MAX_LENGTH) {
      d->length[i++] = (uint8_t)l;
      continue;
    }
    uint32_t zeros = l == 63 ? take(b, 8) + 6 : l - 59 + 2;
    if (zeros > high + 1 - i)
      return false;
    i += zeros;
  }
  return b->at <= b->end;
}

static void make_codes(Decoder *d) {
  for (uint32_t i = 0; i < SYMBOLS; i++)
    d->count[d->length[i]]++;
  uint64_t code = 0;
  for (int l = MAX_LENGTH; l > 0; l--) {
    d->lowest[l] = code;
    code = (code + d->count[l]) >> 1;
  }
  uint32_t next[MAX_LENGTH + 1], at = 0;
  for (int l = 1; l <= MAX_LENGTH; l++) {
    d->first[l] = next[l] = at;
    at += d->count[l];
  }
  for (uint32_t i = 0; i < SYMBOLS; i++)
    if (d->length[i])
      d->symbols[next[d->length[i]]++] = i;
}

static bool next_symbol(const Decoder *d, Bits *b, uint32_t *symbol) {
  uint64_t code = 0;
  for (int l = 1; l <= MAX_LENGTH; l++) {
    if (b->at >= b->end)
      return false;
    code = code << 1 | take(b, 1);
    if (code >= d->lowest[l] && code - d->lowest[l] < d->count[l]) {
      *symbol = d->symbols[d->first[l] + (uint32_t)(code - d->lowest[l])];
      return true;
    }
  }
  return false;
}

static bool unpack(Decoder *d, const uint8_t *packed, size_t size, uint16_t *values,
                   size_t count) {
  uint32_t low = vl_little32(packed), high = vl_little32(packed + 4),
           bit_count = vl_little32(packed + 12), symbol;
  if (low >= SYMBOLS || high >= SYMBOLS || low > high)
    return false;
  Bits bits = {packed + 20, 0, (size - 20) * 8};
  if (!read_lengths(d, &bits, low, high))
    return false;
  make_codes(d);
  bits.at = (bits.at + 7) & ~(size_t)7;
  if (bits.at > bits.end || bit_count > bits.end - bits.at)
    return false;
  bits.end = bits.at + bit_count;
  for (size_t i = 0; i < count;) {
    if (!next_symbol(d, &bits, &symbol))
      return false;
    if (symbol != high) {
      values[i++] = (uint16_t)symbol;
      continue;
    }
    size_t n = take(&bits, 8);
    if (i == 0 || n > count - i || bits.at > bits.end)
      return false;
    for (; n; n--, i++)
      values[i] = values[i - 1];
  }
  return true;
}

vlResult vl_huffman_unpack(vlContext *context, const uint8_t *packed, size_t size,
                           uint16_t *values, size_t count) {
  if (count == 0)
    return VL_OK;
  if (size < 20)
    return VL_ERROR_SCENE;
  Decoder *d = vl_alloc_zero(context, 1, sizeof *d);
  if (!d)
    return VL_ERROR_MEMORY;
  bool ok = unpack(d, packed, size, values, count);
  vl_free(context, d);
  return ok ? VL_OK : VL_ERROR_SCENE;
}
