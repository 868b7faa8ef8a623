/* image/exr_dwa.c: decoding of DWA (DreamWorks' lossy compression, OpenEXR 2.2), from its
 * description in OpenEXR's sources. A chunk holds four streams: "unknown" channels (deflate);
 * the DCT's AC coefficients as run lengths of zeros (Huffman or deflate); the DC coefficients
 * (ZIP); run-length encoded channels (deflate), usually alpha. Rules in the chunk assign
 * channels to streams by name and type, and say which three channels form one colour (stored as
 * Y'CbCr, Rec.709). Coefficients are halves. The DCT is applied to encoded values: a power
 * curve of exponent 2.2 up to 1, an exponential above. */
#include "image/exr_dwa.h"

#include <zlib.h>

#include "base/bytes.h"
#include "base/free.h"
#include "base/text.h"
#include "image/exr_huffman.h"
#include "image/pixel.h"

enum { UNKNOWN = 0, LOSSY = 1, RUNS = 2 };
enum { HEAD_WORDS = 11, UINT = 0, HALF = 1, FLOAT = 2 };

typedef struct Plan {
  int scheme;
  int component; /* component of a colour: 0, 1 or 2; -1: none */
  bool done;
  size_t offset; /* offset of the channel in its stream (unknown or runs), bytes */
  size_t line;   /* offset of the channel's line in a line of the chunk, bytes */
} Plan;

typedef struct Dwa {
  vlContext *context;
  const vlDwaChannel *channels;
  Plan *plans;
  uint32_t count, width, height;
  const uint16_t *curve;
  uint8_t *unpacked;
  size_t line; /* bytes per line of the chunk */
  uint8_t *unknown, *runs;
  uint16_t *ac, *dc;
  size_t ac_count, dc_count, ac_at, dc_at;
  size_t unknown_size, runs_size; /* sizes of the streams, summed over the channels, bytes */
} Dwa;

/* ---- the inverse cosine transform of 8 x 8 values, orthonormal. Plain sums in a fixed order
 * give the same bits everywhere. */

/* 0.5 cos(k pi / 16) */
static const float COSINE[8] = {0.5f,        0.49039264f, 0.46193977f, 0.41573481f,
                                0.35355339f, 0.27778512f, 0.19134172f, 0.09754516f};

/* Entry of the orthonormal inverse transform: sample n of frequency k. */
static float basis(int n, int k) {
  if (k == 0)
    return COSINE[4];
  int angle = (2 * n + 1) * k % 32; /* in units of pi / 16, period 32 */
  if (angle > 16)
    angle = 32 - angle;
  return angle <= 8 ? (angle == 8 ? 0.0f : COSINE[angle]) : -COSINE[16 - angle];
}

/* matrix[n][k]: the weight of frequency k in sample n. */
static void dct_make(float matrix[8][8]) {
  for (int n = 0; n < 8; n++)
    for (int k = 0; k < 8; k++)
      matrix[n][k] = basis(n, k);
}

/* Transforms the rows of `from`; in `to` they are columns. */
static void dct_rows(const float from[64], const float matrix[8][8], float to[64]) {
  for (int n = 0; n < 8; n++)
    for (int y = 0; y < 8; y++) {
      float sum = 0.0f;
      for (int k = 0; k < 8; k++)
        sum += matrix[n][k] * from[8 * y + k];
      to[8 * n + y] = sum;
    }
}

/* Transforms values stored by rows, in place. */
static void dct_inverse(float block[64], const float matrix[8][8]) {
  float columns[64];
  dct_rows(block, matrix, columns);
  dct_rows(columns, matrix, block);
}

static size_t type_size(int type) {
  return type == HALF ? 2 : 4;
}

void vl_dwa_make_curve(uint16_t *curve) {
  for (uint32_t i = 0; i < 65536; i++) {
    bool finite = (i & 0x7c00u) != 0x7c00u;
    double x = finite ? vl_half_to_float((uint16_t)(i & 0x7fffu)) : 0.0;
    /* above 1: e^(2.2 (x - 1)) */
    double y = x <= 1.0
                   ? vl_pow_exact(x, 2.2)
                   : vl_exp2_exact((x > 100.0 ? 99.0 : x - 1.0) * 2.2 * 1.4426950408889634);
    curve[i] =
        finite ? (uint16_t)(vl_float_to_half((float)(y < 1e30 ? y : 1e30)) | (i & 0x8000u)) : 0;
  }
}

/* ---- which channel is where -------------------------------------------------------------- */

typedef struct Rule {
  char suffix[129];
  int scheme, component, type;
  bool any_case;
} Rule;

static bool rule_matches(const Rule *rule, const vlDwaChannel *channel) {
  const char *a = vl_last_part(channel->name), *b = rule->suffix;
  if (rule->type != channel->type)
    return false;
  for (; *a && *b; a++, b++) {
    char c = rule->any_case && *a >= 'A' && *a <= 'Z' ? (char)(*a + 'a' - 'A') : *a;
    if (c != *b)
      return false;
  }
  return !*a && !*b;
}

static void apply_rule(Dwa *d, const Rule *rule) { /* the last matching rule counts */
  for (uint32_t i = 0; i < d->count; i++) {
    if (!rule_matches(rule, &d->channels[i]))
      continue;
    d->plans[i].scheme = rule->scheme;
    if (rule->component >= 0)
      d->plans[i].component = rule->component;
  }
}

/* The built-in rules of files before version 2 of the compression. */
static void legacy_rules(Dwa *d) {
  static const struct {
    const char *suffix;
    int scheme, component;
  } OLD[] = {{"r", LOSSY, 0},     {"red", LOSSY, 0}, {"g", LOSSY, 1},   {"grn", LOSSY, 1},
             {"green", LOSSY, 1}, {"b", LOSSY, 2},   {"blu", LOSSY, 2}, {"blue", LOSSY, 2},
             {"y", LOSSY, -1},    {"by", LOSSY, -1}, {"ry", LOSSY, -1}, {"a", RUNS, -1}};
  for (size_t i = 0; i < VL_LENGTH(OLD); i++)
    for (int type = OLD[i].scheme == RUNS ? UINT : HALF; type <= FLOAT; type++) {
      Rule rule = {.scheme = OLD[i].scheme,
                   .component = OLD[i].component,
                   .type = type,
                   .any_case = true};
      memcpy(rule.suffix, OLD[i].suffix, strlen(OLD[i].suffix) + 1);
      apply_rule(d, &rule);
    }
}

/* Reads the rules of a chunk. Each rule is a zero-terminated suffix, a byte with component,
 * scheme and case, and a byte with the pixel type. */
static bool read_rules(Dwa *d, const uint8_t *p, size_t size) {
  size_t at = 0;
  while (at < size) {
    Rule rule;
    memset(&rule, 0, sizeof rule);
    for (size_t n = 0; at < size && p[at]; at++) {
      if (n + 1 >= sizeof rule.suffix)
        return false;
      rule.suffix[n++] = (char)p[at];
    }
    if (size - at < 3)
      return false;
    rule.component = (p[at + 1] >> 4) - 1;
    rule.scheme = p[at + 1] >> 2 & 3;
    rule.any_case = p[at + 1] & 1;
    rule.type = p[at + 2];
    at += 3;
    if (rule.component > 2 || rule.scheme > RUNS || rule.type > FLOAT)
      return false;
    apply_rule(d, &rule);
  }
  return true;
}

/* Returns the number of DC values of all channels and sets the channels' offsets. */
static size_t lay_out(Dwa *d) {
  size_t pixels = (size_t)d->width * d->height, lossy = 0;
  for (uint32_t i = 0; i < d->count; i++) {
    Plan *plan = &d->plans[i];
    size_t size = type_size(d->channels[i].type);
    plan->line = d->line;
    d->line += size * d->width;
    if (plan->scheme == LOSSY)
      lossy++;
    size_t *stream = plan->scheme == RUNS ? &d->runs_size : &d->unknown_size;
    if (plan->scheme != LOSSY) {
      plan->offset = *stream;
      *stream += size * pixels;
    }
  }
  return lossy * ((d->width + 7) / 8) * ((d->height + 7) / 8);
}

/* ---- streams ----------------------------------------------------------------------------- */

static bool inflate_exactly(const uint8_t *from, size_t from_size, void *to, size_t size) {
  uLongf length = size;
  return uncompress(to, &length, from, from_size) == Z_OK && length == size;
}

/* OpenEXR's ZIP: deflate of byte differences, with the even bytes before the odd ones. */
static bool unzip(const uint8_t *from, size_t from_size, uint8_t *to, uint8_t *scratch,
                  size_t size) {
  if (!inflate_exactly(from, from_size, scratch, size))
    return false;
  for (size_t i = 1; i < size; i++)
    scratch[i] = (uint8_t)(scratch[i - 1] + scratch[i] - 128);
  size_t half = (size + 1) / 2;
  for (size_t i = 0; i < size; i++)
    to[i] = scratch[i / 2 + (i & 1 ? half : 0)];
  return true;
}

/* Run lengths: a negative count copies bytes, others repeat one. */
static bool expand_runs(const uint8_t *from, size_t from_size, uint8_t *to, size_t size) {
  size_t out = 0, at = 0;
  while (at < from_size) {
    int n = (int8_t)from[at++];
    size_t length = n < 0 ? (size_t)-n : (size_t)n + 1;
    if (length > size - out || (n < 0 ? length : 1) > from_size - at)
      return false;
    if (n < 0)
      memcpy(to + out, from + at, length);
    else
      memset(to + out, from[at], length);
    at += n < 0 ? length : 1;
    out += length;
  }
  return out == size;
}

/* ---- the DCT ----------------------------------------------------------------------------- */

static const uint8_t ZIGZAG[64] = {
    0,  1,  5,  6,  14, 15, 27, 28, 2,  4,  7,  13, 16, 26, 29, 42, 3,  8,  12, 17, 25, 30,
    41, 43, 9,  11, 18, 24, 31, 40, 44, 53, 10, 19, 23, 32, 39, 45, 52, 54, 20, 22, 33, 38,
    46, 51, 55, 60, 21, 34, 37, 47, 50, 56, 59, 61, 35, 36, 48, 49, 57, 58, 62, 63};

/* AC values of the next block: 0xff00 ends the block, 0xffnn stands for nn zeros. */
static bool next_block(Dwa *d, uint16_t dc, const float matrix[8][8], float block[64]) {
  uint16_t zigzag[64] = {dc};
  for (uint32_t i = 1; i < 64;) {
    if (d->ac_at >= d->ac_count)
      return false;
    uint16_t v = d->ac[d->ac_at++];
    if (v == 0xff00)
      i = 64;
    else if (v >> 8 == 0xff)
      i += v & 0xffu;
    else
      zigzag[i++] = v;
  }
  for (int i = 0; i < 64; i++)
    block[i] = vl_half_to_float(zigzag[ZIGZAG[i]]);
  dct_inverse(block, matrix);
  return true;
}

static void store_block(Dwa *d, uint32_t channel, uint32_t bx, uint32_t by, bool curve,
                        const float block[64]) {
  const vlDwaChannel *c = &d->channels[channel];
  for (uint32_t y = by * 8; y < d->height && y < by * 8 + 8; y++)
    for (uint32_t x = bx * 8; x < d->width && x < bx * 8 + 8; x++) {
      uint16_t h = vl_float_to_half(block[(y & 7) * 8 + (x & 7)]);
      if (curve)
        h = d->curve[h];
      uint8_t *to = d->unpacked + (size_t)y * d->line + d->plans[channel].line +
                    (size_t)x * type_size(c->type);
      float f = vl_half_to_float(h);
      if (c->type == HALF)
        memcpy(to, &h, 2);
      else
        memcpy(to, &f, 4);
    }
}

/* Decodes one channel, or the three channels of a colour. The AC blocks of the three channels
 * alternate; their DC planes follow each other. */
static bool unpack_lossy(Dwa *d, const uint32_t *channel, uint32_t count) {
  uint32_t blocks_x = (d->width + 7) / 8, blocks_y = (d->height + 7) / 8;
  size_t plane = (size_t)blocks_x * blocks_y;
  float matrix[8][8], block[3][64];
  if (plane * count > d->dc_count - d->dc_at)
    return false;
  dct_make(matrix);
  for (uint32_t by = 0; by < blocks_y; by++)
    for (uint32_t bx = 0; bx < blocks_x; bx++) {
      for (uint32_t c = 0; c < count; c++)
        if (!next_block(d, d->dc[d->dc_at + c * plane + (size_t)by * blocks_x + bx], matrix,
                        block[c]))
          return false;
      for (int i = 0; count == 3 && i < 64; i++) {
        float y = block[0][i], cb = block[1][i], cr = block[2][i];
        block[0][i] = y + 1.5747f * cr;
        block[1][i] = y - 0.1873f * cb - 0.4682f * cr;
        block[2][i] = y + 1.8556f * cb;
      }
      for (uint32_t c = 0; c < count; c++)
        store_block(d, channel[c], bx, by, count == 3 || !d->channels[channel[c]].linear,
                    block[c]);
    }
  d->dc_at += plane * count;
  for (uint32_t c = 0; c < count; c++)
    d->plans[channel[c]].done = true;
  return true;
}

/* Compares layers: the part of the name before the last dot. Channels without a layer come
 * first. */
static int compare_layers(const char *a, const char *b) {
  size_t n = (size_t)(vl_last_part(a) - a), m = (size_t)(vl_last_part(b) - b);
  n -= n > 0;
  m -= m > 0;
  int order = memcmp(a, b, n < m ? n : m);
  return order ? order : n < m ? -1 : n > m;
}

/* Finds the channels of one layer's colour; found is 7 when all three exist. */
static bool unpack_color(Dwa *d, const char *layer) {
  uint32_t color[3] = {0}, found = 0;
  for (uint32_t k = 0; k < d->count; k++) {
    if (compare_layers(d->channels[k].name, layer) != 0 || d->plans[k].component < 0)
      continue;
    color[d->plans[k].component] = k;
    found |= 1u << d->plans[k].component;
  }
  if (found != 7)
    return true;
  for (int k = 0; k < 3; k++)
    if (d->plans[color[k]].scheme != LOSSY || d->channels[color[k]].type == UINT)
      return false;
  return unpack_lossy(d, color, 3);
}

/* Decodes the colours first, layer by layer, then the other channels in order. */
static bool unpack_channels(Dwa *d) {
  const char *layer = NULL;
  for (;;) {
    const char *next = NULL;
    for (uint32_t i = 0; i < d->count; i++) {
      const char *name = d->channels[i].name;
      if ((!layer || compare_layers(name, layer) > 0) &&
          (!next || compare_layers(name, next) < 0))
        next = name;
    }
    if (!next)
      break;
    layer = next;
    if (!unpack_color(d, layer))
      return false;
  }
  for (uint32_t i = 0; i < d->count; i++) {
    const Plan *plan = &d->plans[i];
    size_t size = type_size(d->channels[i].type), pixels = (size_t)d->width * d->height;
    if (plan->done)
      continue;
    if (plan->scheme == LOSSY && (d->channels[i].type == UINT || !unpack_lossy(d, &i, 1)))
      return false;
    for (uint32_t y = 0; y < d->height && plan->scheme != LOSSY; y++) {
      uint8_t *to = d->unpacked + (size_t)y * d->line + plan->line;
      size_t at = plan->offset + (size_t)y * d->width * (plan->scheme == RUNS ? 1 : size);
      if (plan->scheme == UNKNOWN)
        memcpy(to, d->unknown + at, d->width * size);
      /* the first bytes of all values, then all second bytes, ... */
      for (size_t k = 0; plan->scheme == RUNS && k < d->width * size; k++)
        to[k] = d->runs[at + k / size + k % size * pixels];
    }
  }
  return true;
}

/* ---- a chunk ----------------------------------------------------------------------------- */

static vlResult unpack_streams(Dwa *d, const uint64_t *head, const uint8_t *p) {
  const uint64_t unknown_packed = head[2], ac_packed = head[3], dc_packed = head[4],
                 runs_packed = head[5], runs_middle = head[6];
  size_t dc_bytes = d->dc_count * 2;
  d->unknown = vl_alloc(d->context, d->unknown_size + 1);
  d->runs = vl_alloc(d->context, d->runs_size + 1);
  d->ac = vl_alloc_array(d->context, d->ac_count + 1, 2);
  d->dc = vl_alloc_array(d->context, d->dc_count + 1, 2);
  size_t scratch_size = dc_bytes > runs_middle ? dc_bytes : (size_t)runs_middle;
  uint8_t *scratch = vl_alloc(d->context, scratch_size + 1);
  vlResult result =
      d->unknown && d->runs && d->ac && d->dc && scratch ? VL_OK : VL_ERROR_MEMORY;
  if (result == VL_OK) {
    bool ok =
        unknown_packed == 0 || inflate_exactly(p, unknown_packed, d->unknown, d->unknown_size);
    p += unknown_packed;
    if (ok && ac_packed && head[10] == 0) {
      result = vl_huffman_unpack(d->context, p, ac_packed, d->ac, d->ac_count);
      ok = result == VL_OK;
    } else if (ac_packed) {
      ok = ok && inflate_exactly(p, ac_packed, d->ac, d->ac_count * 2);
    }
    p += ac_packed;
    ok = ok && (dc_packed == 0 || unzip(p, dc_packed, (uint8_t *)d->dc, scratch, dc_bytes));
    p += dc_packed;
    ok = ok && (runs_packed == 0 ||
                (inflate_exactly(p, runs_packed, scratch, (size_t)runs_middle) &&
                 expand_runs(scratch, (size_t)runs_middle, d->runs, d->runs_size)));
    ok = ok && unpack_channels(d);
    if (!ok && result == VL_OK)
      result = VL_ERROR_SCENE;
  }
  VL_FREE(d->context, scratch, d->unknown, d->runs, d->ac, d->dc);
  return result;
}

/* Reads header and rules. Every size must match the channels, and all streams must lie in the
 * chunk. */
static vlResult unpack(Dwa *d, const uint8_t *packed, size_t size) {
  uint64_t head[HEAD_WORDS];
  if (size < HEAD_WORDS * 8)
    return VL_ERROR_SCENE;
  for (int i = 0; i < HEAD_WORDS; i++)
    head[i] = vl_little(packed + 8 * i, 8);
  size_t at = HEAD_WORDS * 8;
  if (head[0] > 2)
    return VL_ERROR_SCENE;
  if (head[0] < 2) {
    legacy_rules(d);
  } else {
    /* size of the rules, including the two bytes of the size itself */
    size_t rules = size - at >= 2 ? vl_little16(packed + at) : 0;
    if (rules < 2 || rules > size - at || !read_rules(d, packed + at + 2, rules - 2))
      return VL_ERROR_SCENE;
    at += rules;
  }
  size_t dc_count = lay_out(d), left = size - at;
  for (int i = 2; i <= 5; i++) {
    if (head[i] > left)
      return VL_ERROR_SCENE;
    left -= head[i];
  }
  if (head[2] ? head[1] != d->unknown_size : d->unknown_size)
    return VL_ERROR_SCENE;
  if (head[5] ? head[7] != d->runs_size || head[6] > 2 * head[7] + 1024 : d->runs_size)
    return VL_ERROR_SCENE;
  if (head[9] != dc_count || (dc_count && !head[4]) || head[8] > 63 * (uint64_t)dc_count ||
      head[10] > 1)
    return VL_ERROR_SCENE;
  if (head[8] && !head[3])
    return VL_ERROR_SCENE;
  if (!head[5])
    head[6] = 0;
  d->ac_count = (size_t)head[8];
  d->dc_count = dc_count;
  return unpack_streams(d, head, packed + at);
}

vlResult vl_dwa_unpack(vlContext *context, const vlDwaChannel *channels, uint32_t count,
                       uint32_t width, uint32_t height, const uint16_t *curve,
                       const uint8_t *packed, size_t packed_size, uint8_t *unpacked) {
  Dwa d = {.context = context,
           .channels = channels,
           .count = count,
           .width = width,
           .height = height,
           .curve = curve,
           .unpacked = unpacked};
  d.plans = vl_alloc_zero(context, count, sizeof *d.plans);
  if (!d.plans)
    return VL_ERROR_MEMORY;
  for (uint32_t i = 0; i < count; i++)
    d.plans[i].component = -1;
  vlResult result = unpack(&d, packed, packed_size);
  vl_free(context, d.plans);
  return result;
}
