/* film/file_common.c: functions that readers, writers and mergers of film files share;
 * blocks of formats 1 and 2. */
#include <string.h>
#include <zlib.h>

#include "base/text.h"
#include "film/file.h"

const char vl_film_magic[8] = {'V', 'E', 'L', 'O', 'F', 'I', 'L', 'M'};

uint32_t vl_film_crc(uint32_t crc, const void *data, size_t size) {
  /* crc32_z with null data would restart the CRC */
  return size ? (uint32_t)crc32_z(crc, data, size) : crc;
}

uint64_t vl_film_samples(const vlSampleSpan *ranges, uint32_t count) {
  uint64_t sum = 0;
  for (uint32_t i = 0; i < count; i++)
    sum += ranges[i].end - ranges[i].first;
  return sum;
}

vlResult vl_film_put_header(vlFileWriter *writer, const char *header) {
  size_t size = strlen(header);
  if (size > VL_FILM_MAX_HEADER)
    return VL_ERROR_ARGUMENT;
  vlFilmPreamble p = {.format = VL_FILM_FORMAT, .header_size = (uint32_t)size};
  memcpy(p.magic, vl_film_magic, sizeof p.magic);
  p.header_crc = vl_film_crc(0, header, size);
  p.crc = vl_film_crc(0, &p, offsetof(vlFilmPreamble, crc));
  vl_file_write(writer, &p, sizeof p);
  vl_file_write(writer, header, size);
  return VL_OK;
}

size_t vl_film_block_head(const vlFilmDef *def, const uint32_t window[4], uint32_t range_count,
                          const vlComparedNoise *compared, vlFilmBlockHead *head) {
  size_t pixels = (size_t)(window[2] - window[0]) * (window[3] - window[1]),
         each = vl_film_pixel_size(def);
  *head = (vlFilmBlockHead){.magic = VL_FILM_BLOCK_MAGIC,
                            .range_count = range_count,
                            .x0 = window[0],
                            .y0 = window[1],
                            .x1 = window[2],
                            .y1 = window[3],
                            .data_size = range_count ? pixels * each : 0};
  if (range_count && compared && compared->spp)
    head->compared = *compared;
  return sizeof *head + range_count * sizeof(vlSampleSpan) + head->data_size + sizeof(uint32_t);
}

void *vl_film_copy_block(const vlFilm *film, const uint32_t window[4], vlFilmCopy way,
                         void *data) {
  const size_t buckets = film->def.buckets;
  const struct {
    void *items;
    size_t size; /* bytes for a pixel; 0: the film has no such array */
  } arrays[] = {{film->front, sizeof(vlFilmPixel)},
                {film->moments[0], film->def.errors ? sizeof(vlFilmMoments) : 0},
                {film->spectrum.sums[0], buckets * sizeof(vlInt128)},
                {film->spectrum.weights[0], buckets * sizeof(int64_t)}};
  const size_t first =
      (size_t)(window[1] - film->def.crop[1]) * film->width + (window[0] - film->def.crop[0]);
  char *stored = data;
  for (size_t k = 0; k < VL_LENGTH(arrays); k++) {
    const size_t size = arrays[k].size, bytes = (window[2] - window[0]) * size;
    for (uint32_t y = window[1]; size && y < window[3]; y++) {
      const size_t pixel = first + (size_t)(y - window[1]) * film->width;
      char *held = (char *)arrays[k].items + pixel * size;
      if (way == VL_FROM_FILM)
        memcpy(stored, held, bytes);
      else
        memcpy(held, stored, bytes);
      stored += bytes;
    }
  }
  return stored;
}

/* Adds a block of sums. The sums are integers, so the order does not matter. The reader has
 * checked that no sum can overflow. */
void vl_film_add_block(const vlFilmDef *def, size_t pixels, void *to, uint32_t to_end,
                       const void *from, uint32_t from_end) {
  vlFilmPixel *p = to;
  const vlFilmPixel *q = from;
  vlFilmMoments *m = (void *)(p + pixels);
  const vlFilmMoments *n = (const void *)(q + pixels);
  size_t moments = def->errors ? pixels : 0, cells = pixels * def->buckets;
  uint32_t part = vl_first_part(to_end > from_end ? to_end : from_end);
  for (size_t i = 0; i < moments; i++) {
    vlFilmMoments more = n[i];
    if (vl_first_part(to_end) != part)
      vl_film_join_parts(&m[i], &p[i]);
    if (vl_first_part(from_end) != part)
      vl_film_join_parts(&more, &q[i]);
    vl_film_sum_moments(&m[i], &more);
  }
  for (size_t i = 0; i < pixels; i++) {
    for (int c = 0; c < 3; c++)
      p[i].color[c] += q[i].color[c];
    p[i].alpha += q[i].alpha;
    p[i].weight += q[i].weight;
  }
  vlPackedInt128 *sums = (void *)(m + moments);
  const vlPackedInt128 *more = (const void *)(n + moments);
  for (size_t i = 0; i < cells; i++)
    sums[i] += more[i];
  int64_t *weights = (void *)(sums + cells);
  const int64_t *other = (const void *)(more + cells);
  for (size_t i = 0; i < cells; i++)
    weights[i] += other[i];
}

/* ---- blocks of formats 1 and 2. They lack the sums of the first part of the samples, which
 * films with errors have; format 2 has the means of earlier samples in blocks that adaptive
 * sampling compared. All samples of such a film become its first part. So its standard errors
 * are those of independent samples, until more samples join them. */

typedef struct OldMoments {
  vlInt128 plain[3];
  uint64_t squares[3][3];
  uint64_t samples;
} OldMoments;
_Static_assert(sizeof(OldMoments) == 128, "as in the files");

size_t vl_film_old_data_size(const vlFilmDef *def, uint32_t format, size_t pixels,
                             bool compared) {
  size_t each =
      vl_film_pixel_size(def) - (def->errors ? sizeof(vlFilmMoments) - sizeof(OldMoments) : 0);
  return pixels * (each + (format == 2 && compared ? VL_FILM_OLD_MEAN : 0));
}

void vl_film_convert_old_data(const vlFilmDef *def, size_t pixels, void *data) {
  if (!def->errors)
    return;
  const vlFilmPixel *pixel = data;
  char *moments = (char *)data + pixels * sizeof *pixel;
  size_t spectra = pixels * def->buckets * (sizeof(vlInt128) + sizeof(int64_t));
  memmove(moments + pixels * sizeof(vlFilmMoments), moments + pixels * sizeof(OldMoments),
          spectra);
  for (size_t i = pixels; i-- > 0;) { /* each moves to a later address, the last one first */
    OldMoments old;
    memcpy(&old, moments + i * sizeof old, sizeof old);
    vlFilmMoments made = {.samples = old.samples};
    for (int c = 0; c < 3; c++)
      made.plain[c] = old.plain[c];
    memcpy(made.squares, old.squares, sizeof made.squares);
    vl_film_join_parts(&made, &pixel[i]);
    memcpy(moments + i * sizeof made, &made, sizeof made);
  }
}
