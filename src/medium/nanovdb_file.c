/* medium/nanovdb_file.c: reads NanoVDB files. A file consists of segments; a segment has
 * a header, grid descriptions, and the grids, plain or compressed by zlib. The layout is that
 * of format version 32: header 16 bytes; description 176 bytes and a name; then the grids in
 * the same order. All sizes are checked against the file's size. */
#include <string.h>
#include <zlib.h>

#include "base/bytes.h"
#include "base/error.h"
#include "base/file.h"
#include "medium/nanovdb_file.h"

enum { HEADER = 16, DESCRIPTION = 176, MAJOR = 32 };
enum { CODEC_NONE = 0, CODEC_ZIP = 1, CODEC_BLOSC = 2 };

static const char magic[7] = {'N', 'a', 'n', 'o', 'V', 'D', 'B'}; /* a digit follows */

static vlResult damaged(const char *path, vlError *error) {
  return vl_fail(error, VL_ERROR_SCENE,
                 "%s: the NanoVDB file is damaged: it ends before what it announces", path);
}

/* Unpacks one grid. Packed bytes: [data, data + packed); size: bytes when unpacked. */
static vlResult unpack(vlContext *context, const char *path, uint32_t codec, const char *data,
                       uint64_t packed, uint64_t size, vlNanoGrid *grid, vlError *error) {
  if (codec == CODEC_BLOSC)
    return vl_fail(error, VL_ERROR_SCENE,
                   "%s: the grid is packed by BLOSC; only plain and ZIP are understood", path);
  if (codec != CODEC_NONE && codec != CODEC_ZIP)
    return vl_fail(error, VL_ERROR_SCENE, "%s: the NanoVDB file names an unknown codec (%u)",
                   path, codec);
  /* zlib compresses at most 1032 : 1 */
  if (size > (codec == CODEC_ZIP ? packed * 1032 : packed) || size < 8)
    return damaged(path, error);
  grid->words = vl_alloc_array(context, (size + 7) / 8, 8);
  if (!grid->words)
    return vl_fail_memory(error);
  grid->size = size;
  grid->words[(size + 7) / 8 - 1] = 0;
  if (codec == CODEC_NONE) {
    memcpy(grid->words, data, size);
    return VL_OK;
  }
  uint64_t length = packed >= 8 ? vl_little(data, 8) : 0;
  uLongf unpacked = size;
  if (packed >= 8 && length <= packed - 8 &&
      uncompress((Bytef *)grid->words, &unpacked, (const Bytef *)(data + 8), length) == Z_OK &&
      unpacked == size)
    return VL_OK;
  vl_free(context, grid->words);
  grid->words = NULL;
  return vl_fail(error, VL_ERROR_SCENE,
                 "%s: the NanoVDB file is damaged: zlib cannot unpack the grid", path);
}

/* Searches the segment at `at`. *next: start of the following segment; 0 if the grid was
 * found. */
static vlResult search_segment(vlContext *context, const char *path, const char *data,
                               size_t size, size_t at, const char *name, vlNanoGrid *grid,
                               size_t *next, vlError *error) {
  if (size - at < HEADER)
    return damaged(path, error);
  const char *head = data + at;
  if (memcmp(head, magic, sizeof magic) != 0)
    return vl_fail(error, VL_ERROR_SCENE, "%s: this is no NanoVDB file", path);
  uint32_t version = vl_little32(head + 8), count = vl_little16(head + 12);
  if (version >> 21 != MAJOR)
    return vl_fail(error, VL_ERROR_SCENE,
                   "%s: NanoVDB version %u.%u is not understood (known: %d)", path,
                   version >> 21, version >> 10 & 0x7ff, MAJOR);
  uint32_t codec = vl_little16(head + 14);
  size_t description = at + HEADER, body = description;
  for (uint32_t i = 0; i < count; i++) { /* the data of the grids follow the last description */
    if (size - body < DESCRIPTION)
      return damaged(path, error);
    uint32_t length = vl_little32(data + body + 136);
    if (size - body - DESCRIPTION < length)
      return damaged(path, error);
    body += DESCRIPTION + length;
  }
  size_t wanted = strlen(name);
  for (uint32_t i = 0; i < count; i++) {
    const char *d = data + description;
    uint64_t unpacked = vl_little(d, 8), packed = vl_little(d + 8, 8);
    uint32_t length = vl_little32(d + 136);
    if (packed > size - body)
      return damaged(path, error);
    bool found = length >= wanted && memcmp(d + DESCRIPTION, name, wanted) == 0 &&
                 (length == wanted || d[DESCRIPTION + wanted] == 0);
    if (found) {
      *next = 0;
      return unpack(context, path, codec, data + body, packed, unpacked, grid, error);
    }
    body += packed;
    description += DESCRIPTION + length;
  }
  *next = body;
  return VL_OK;
}

vlResult vl_nanovdb_find(vlContext *context, const char *path, const char *name,
                         vlNanoGrid *grid, vlError *error) {
  char *data;
  size_t size;
  *grid = (vlNanoGrid){0};
  vlResult r = vl_file_read(context, path, false, &data, &size, error);
  if (r != VL_OK)
    return r;
  size_t at = 0, next = 0;
  do {
    r = search_segment(context, path, data, size, at, name, grid, &next, error);
    if (r != VL_OK || next == 0)
      break;
    at = next;
  } while (at < size);
  vl_free(context, data);
  return r;
}
