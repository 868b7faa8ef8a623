/* film/file_reader.c: reads film files block by block. All bytes are checked: preamble, header
 * and blocks have CRCs, and their sizes must match the size of the file. */
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file_input.h"
#include "base/free.h"
#include "film/file.h"

static vlResult damaged(const vlFilmReader *r, const char *what, vlError *error) {
  return vl_fail(error, VL_ERROR_SCENE, "%s: damaged film file: %s", r->path, what);
}

/* Reads `size` bytes at offset `at`. The caller has checked that the file is long enough. */
static vlResult get_bytes(const vlFilmReader *r, void *data, size_t size, uint64_t at,
                          vlError *error) {
  char *to = data;
  while (size) {
    ssize_t n = pread(r->descriptor, to, size, (off_t)at);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      return vl_fail(error, VL_ERROR_IO, "cannot read %s: %s", r->path, strerror(errno));
    if (n == 0)
      return damaged(r, "it ends too early", error);
    to += n;
    at += (uint64_t)n;
    size -= (size_t)n;
  }
  return VL_OK;
}

/* Reads `size` bytes at `at`, which the file has. Small pieces come from a buffer, since a part
 * of a render has many blocks without samples. */
static vlResult get(vlFilmReader *r, void *data, size_t size, uint64_t at, vlError *error) {
  if (size > sizeof r->buffer)
    return get_bytes(r, data, size, at, error);
  if (at < r->buffer_at || at + size > r->buffer_at + r->buffered) {
    uint64_t rest = r->size - at;
    r->buffer_at = at;
    r->buffered = 0;
    size_t count = rest < sizeof r->buffer ? (size_t)rest : sizeof r->buffer;
    VL_TRY(get_bytes(r, r->buffer, count, at, error));
    r->buffered = count;
  }
  memcpy(data, r->buffer + (at - r->buffer_at), size);
  return VL_OK;
}

static vlResult read_header(vlFilmReader *r, vlError *error) {
  vlFilmPreamble p;
  if (r->size < sizeof p)
    return vl_fail(error, VL_ERROR_SCENE, "%s: not a film file", r->path);
  VL_TRY(get(r, &p, sizeof p, 0, error));
  if (memcmp(p.magic, vl_film_magic, sizeof p.magic) != 0)
    return vl_fail(error, VL_ERROR_SCENE, "%s: not a film file", r->path);
  if (vl_film_crc(0, &p, offsetof(vlFilmPreamble, crc)) != p.crc)
    return damaged(r, "its first bytes", error);
  if (p.format < 1 || p.format > VL_FILM_FORMAT)
    return vl_fail(error, VL_ERROR_UNSUPPORTED,
                   "%s: film file of format %u; this version of velo reads format %d", r->path,
                   p.format, VL_FILM_FORMAT);
  if (p.header_size > r->size - sizeof p || p.header_size > VL_FILM_MAX_HEADER)
    return damaged(r, "it ends too early", error);
  char *text = vl_alloc(r->context, (size_t)p.header_size + 1);
  if (!text)
    return vl_fail_memory(error);
  vlResult result = get(r, text, p.header_size, sizeof p, error);
  if (result == VL_OK && vl_film_crc(0, text, p.header_size) != p.header_crc)
    result = damaged(r, "its header", error);
  if (result == VL_OK)
    result = vl_film_header_read(r->context, r->path, text, p.header_size, &r->shape, &r->texts,
                                 error);
  vl_free(r->context, text);
  r->format = p.format;
  r->at = sizeof p + p.header_size;
  r->blocks = vl_film_block_count(r->shape.def.crop);
  return result;
}

vlResult vl_film_reader_open(vlFilmReader *r, vlContext *context, const char *path,
                             vlError *error) {
  *r = (vlFilmReader){.context = context, .descriptor = -1, .path = vl_strdup(context, path)};
  if (!r->path)
    return vl_fail_memory(error);
  struct stat info;
  r->descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  vlResult result = VL_OK;
  if (r->descriptor < 0 || fstat(r->descriptor, &info) != 0)
    result = vl_fail(error, errno == ENOENT ? VL_ERROR_MISSING : VL_ERROR_IO,
                     "cannot read %s: %s", path, strerror(errno));
  else if (!S_ISREG(info.st_mode))
    result = vl_fail(error, VL_ERROR_IO, "cannot read %s: %s", path,
                     S_ISDIR(info.st_mode) ? strerror(EISDIR) : "a film is a regular file");
  else if (!vl_file_input(context, path, &info, VL_OUTPUT_FILM))
    result = vl_fail_memory(error);
  else
    r->size = (uint64_t)info.st_size;
  if (result == VL_OK)
    result = read_header(r, error);
  if (result != VL_OK)
    vl_film_reader_close(r);
  return result;
}

bool vl_film_begins_as_film(const char *path) {
  char magic[sizeof vl_film_magic];
  int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  ssize_t n = descriptor < 0 ? -1 : pread(descriptor, magic, sizeof magic, 0);
  if (descriptor >= 0)
    close(descriptor);
  return n == (ssize_t)sizeof magic && memcmp(magic, vl_film_magic, sizeof magic) == 0;
}

void vl_film_reader_close(vlFilmReader *r) {
  if (r->descriptor >= 0)
    close(r->descriptor);
  r->descriptor = -1;
  VL_FREE(r->context, r->path, r->texts.receipt, r->texts.attributes, r->ranges);
  r->path = r->texts.receipt = r->texts.attributes = NULL;
  r->ranges = NULL;
}

/* Whether ranges are ascending, have gaps between them, and have at most as many samples as a
 * film can hold. */
static bool good_ranges(const vlSampleSpan *ranges, uint32_t count) {
  for (uint32_t i = 0; i < count; i++)
    if (ranges[i].first >= ranges[i].end || (i && ranges[i].first <= ranges[i - 1].end))
      return false;
  return vl_film_samples(ranges, count) < UINT64_C(1) << 31;
}

vlResult vl_film_reader_next(vlFilmReader *r, vlError *error) {
  if (r->next == r->blocks) {
    r->next++;
    return r->at == r->size ? VL_OK : damaged(r, "bytes behind its end", error);
  }
  uint32_t window[4];
  vlFilmBlockHead expected, *h = &r->head;
  uint64_t left = r->size - r->at;
  if (left < sizeof *h + sizeof(uint32_t))
    return damaged(r, "it ends too early", error);
  vlResult result = get(r, h, sizeof *h, r->at, error);
  if (result != VL_OK)
    return result;
  vl_film_block_window(r->shape.def.crop, r->next, window);
  bool good = h->magic == VL_FILM_BLOCK_MAGIC && h->range_count <= VL_FILM_MAX_RANGES;
  uint32_t ranges = good ? h->range_count : 0;
  size_t whole = vl_film_block_head(&r->shape.def, window, ranges, NULL, &expected);
  if (ranges && r->format < VL_FILM_FORMAT) {
    size_t pixels = (size_t)(window[2] - window[0]) * (window[3] - window[1]),
           present = expected.data_size;
    expected.data_size =
        vl_film_old_data_size(&r->shape.def, r->format, pixels, h->compared.spp > 0);
    whole += expected.data_size - present;
  }
  if (!good || h->x0 != window[0] || h->y0 != window[1] || h->x1 != window[2] ||
      h->y1 != window[3] || h->data_size != expected.data_size)
    return damaged(r, "a block's head", error);
  if (whole > left)
    return damaged(r, "it ends too early", error);
  if (h->range_count > r->range_capacity) {
    vlSampleSpan *more = vl_realloc_array(r->context, r->ranges, h->range_count, sizeof *more);
    if (!more)
      return vl_fail_memory(error);
    r->ranges = more;
    r->range_capacity = h->range_count;
  }
  size_t size = h->range_count * sizeof *r->ranges;
  if (size && (result = get(r, r->ranges, size, r->at + sizeof *h, error)) != VL_OK)
    return result;
  if (!good_ranges(r->ranges, h->range_count))
    return damaged(r, "a block's samples", error);
  r->crc = vl_film_crc(vl_film_crc(0, h, sizeof *h), r->ranges, size);
  if (r->format == 1)
    h->compared = (vlComparedNoise){.spp = 0}; /* of another estimate */
  r->data_at = r->at + sizeof *h + size;
  r->at += whole;
  r->next++;
  if (h->data_size)
    return VL_OK;
  uint32_t crc;
  result = vl_film_reader_crc(r, &crc, error);
  return result != VL_OK || crc == r->crc ? result : damaged(r, "the CRC of a block", error);
}

vlResult vl_film_reader_crc(vlFilmReader *r, uint32_t *crc, vlError *error) {
  return get(r, crc, sizeof *crc, r->data_at + r->head.data_size, error);
}

/* ---- values ------------------------------------------------------------------------------ */

static bool within(vlInt128 value, uint64_t samples, int bits) {
  vlInt128 max = (vlInt128)samples << bits;
  return value >= -max && value <= max;
}

/* Whether sums are possible for this number of samples. If they are, no addition to them can
 * overflow. */
static bool good_values(const vlFilmDef *def, size_t pixels, uint64_t samples,
                        const void *data) {
  const vlFilmPixel *p = data;
  bool good = true;
  for (size_t i = 0; i < pixels; i++) {
    for (int c = 0; c < 3; c++)
      good &= within(p[i].color[c], samples, 44 + VL_COLOR_BITS);
    good &= within(p[i].alpha, samples, 4 + VL_ALPHA_BITS) &&
            within(p[i].weight, samples, 4 + VL_WEIGHT_BITS);
  }
  const vlFilmMoments *m = (const void *)(p + pixels);
  for (size_t i = 0; i < pixels && def->errors; i++) {
    for (int c = 0; c < 3; c++)
      good &= within(m[i].plain[c], samples, 40 + VL_COLOR_BITS) &&
              within(m[i].first[c], samples, 44 + VL_COLOR_BITS);
    good &= m[i].samples <= samples && within(m[i].first_weight, samples, 4 + VL_WEIGHT_BITS);
  }
  const vlPackedInt128 *sums = (const void *)(m + (def->errors ? pixels : 0));
  const int64_t *weights = (const void *)(sums + pixels * def->buckets);
  for (size_t i = 0; i < pixels * def->buckets; i++)
    good &= within(sums[i], 4 * samples, 44 + VL_COLOR_BITS) &&
            within(weights[i], 4 * samples, 4 + VL_WEIGHT_BITS);
  return good;
}

vlResult vl_film_reader_data(vlFilmReader *r, void *data, vlError *error) {
  const vlFilmBlockHead *h = &r->head;
  if (!h->data_size)
    return VL_OK;
  uint32_t crc;
  VL_TRY(get(r, data, h->data_size, r->data_at, error));
  VL_TRY(vl_film_reader_crc(r, &crc, error));
  if (vl_film_crc(r->crc, data, h->data_size) != crc)
    return damaged(r, "the CRC of a block", error);
  size_t pixels = (size_t)(h->x1 - h->x0) * (h->y1 - h->y0);
  uint64_t samples = vl_film_samples(r->ranges, h->range_count);
  if (r->format < VL_FILM_FORMAT)
    vl_film_convert_old_data(&r->shape.def, pixels, data);
  if (!good_values(&r->shape.def, pixels, samples, data))
    return damaged(r, "sums that its samples cannot have", error);
  return VL_OK;
}
