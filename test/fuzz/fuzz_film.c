/* test/fuzz/fuzz_film.c: fuzzes film files: header, blocks, develop, merge. Each input is used
 * twice: unchanged, and with repaired CRCs, so that the code behind their checks is reached. */
#include "fuzz.h"

#include <stdint.h>
static uint32_t crc32(const uint8_t *data, size_t size) {
  uint32_t crc = UINT32_MAX;
  for (size_t i = 0; i < size; i++) {
    crc ^= data[i];
    for (int k = 0; k < 8; k++)
      crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  return ~crc;
}

static uint32_t word(const uint8_t *at) {
  uint32_t value;
  memcpy(&value, at, sizeof value);
  return value;
}

/* Repairs the CRCs. Layout (docs/film-files.md): 24 bytes, the header, then blocks of 48 bytes,
 * ranges, sums and a CRC. */
static void repair(uint8_t *data, size_t size) {
  if (size < 24 || word(data + 12) > size - 24)
    return;
  size_t header = word(data + 12), at = 24 + header;
  uint32_t crc = crc32(data + 24, header);
  memcpy(data + 16, &crc, sizeof crc);
  crc = crc32(data, 20);
  memcpy(data + 20, &crc, sizeof crc);
  while (size - at >= 52) {
    uint64_t ranges = word(data + at + 4), sums, room = size - at - 52;
    memcpy(&sums, data + at + 24, sizeof sums);
    if (ranges * 8 > room || sums > room - ranges * 8)
      return;
    size_t length = 48 + (size_t)(ranges * 8 + sums);
    crc = crc32(data + at, length);
    memcpy(data + at + length, &crc, sizeof crc);
    at += length + 4;
  }
}

static void use(vlContext *context, const char *path) {
  vlFilm *film = NULL;
  vlFilmFile *file = NULL;
  vlImage *image = NULL;
  vlError error;
  if (vl_film_file_open(context, path, &file, &error) == VL_OK) {
    vlFilmBlock block = {.x1 = 1};
    while (block.x1 && vl_film_file_next(file, true, &block, &error) == VL_OK)
      continue;
    vl_film_file_close(file);
  }
  if (vl_film_read(context, path, true, &film, &error) == VL_OK) {
    if (vl_film_develop(film, NULL, &image) == VL_OK) {
      if (vl_film_file_open(context, path, &file, &error) == VL_OK)
        vl_film_file_attributes(file, image, &error);
      vl_film_file_close(file);
      vl_image_destroy(image);
    }
    if (vl_film_errors(film, NULL, &image) == VL_OK)
      vl_image_destroy(image);
    if (vl_film_spectrum(film, &image) == VL_OK)
      vl_image_destroy(image);
    vl_film_destroy(film);
  }
  char output[200];
  snprintf(output, sizeof output, "%s.merged", path);
  const char *const paths[2] = {path, path};
  vl_film_merge(context, paths, 2, NULL, output, &error);
  unlink(output);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  vlContext *context = fuzz_context();
  use(context, fuzz_file("input.film", data, size));
  uint8_t *copy = malloc(size + 1);
  if (!copy)
    exit(1);
  memcpy(copy, data, size);
  repair(copy, size);
  use(context, fuzz_file("input.film", copy, size));
  free(copy);
  fuzz_end(context);
  return 0;
}
