/* film/file_common.c: functions that readers and writers of film files share. */
#include <string.h>
#include <zlib.h>

#include "film/file.h"

const char vl_film_magic[8] = {'V', 'E', 'L', 'O', 'F', 'I', 'L', 'M'};

uint32_t vl_film_crc(uint32_t crc, const void *data, size_t size) {
  return size ? (uint32_t)crc32_z(crc, data, size)
              : crc; /* crc32_z with null data would restart the CRC */
}

uint64_t vl_film_samples(const vlSampleSpan *ranges, uint32_t count) {
  uint64_t sum = 0;
  for (uint32_t i = 0; i < count; i++)
    sum += ranges[i].end - ranges[i].first;
  return sum;
}

vlResult vl_film_put_header(vlFileWriter *writer, const char *header) {
  size_t size = strlen(header);
  if (size > VL_FILM_MOST_HEADER)
    return VL_ERROR_ARGUMENT;
  vlFilmPreamble p = {.format = VL_FILM_FORMAT, .header_size = (uint32_t)size};
  memcpy(p.magic, vl_film_magic, sizeof p.magic);
  p.header_crc = vl_film_crc(0, header, size);
  p.crc = vl_film_crc(0, &p, offsetof(vlFilmPreamble, crc));
  vl_file_write(writer, &p, sizeof p);
  vl_file_write(writer, header, size);
  return VL_OK;
}

size_t vl_film_block_head(const vlFilmDef *def, const uint32_t place[4], uint32_t range_count,
                          const vlComparedNoise *compared, vlFilmBlockHead *head) {
  size_t pixels = (size_t)(place[2] - place[0]) * (place[3] - place[1]),
         each = vl_film_pixel_size(def);
  *head = (vlFilmBlockHead){.magic = VL_FILM_BLOCK_MAGIC,
                            .range_count = range_count,
                            .x0 = place[0],
                            .y0 = place[1],
                            .x1 = place[2],
                            .y1 = place[3],
                            .data_size = range_count ? pixels * each : 0};
  if (range_count && compared && compared->spp)
    head->compared = *compared;
  return sizeof *head + range_count * sizeof(vlSampleSpan) + head->data_size + sizeof(uint32_t);
}
