/* api/film_file.c: the public functions for film files: header, receipt, blocks. */
#include <string.h>

#include "api/receipt.h"
#include "base/error.h"
#include "base/free.h"
#include "film/file.h"
#include "velo/film.h"

struct vlFilmFile {
  vlFilmReader reader;
  vlReceipt *receipt;
  char *data; /* memory for the data of one block, allocated when the first block is checked */
  vlSampleRange *ranges; /* of the block that was read last */
  uint32_t capacity;     /* number of ranges that have memory */
};

vlResult vl_film_receipt(const vlFilmReader *reader, vlReceipt **receipt, vlError *error) {
  vlError own = {0};
  vlResult result = vl_receipt_parse(reader->context, reader->texts.receipt,
                                     strlen(reader->texts.receipt), receipt, &own);
  if (result == VL_OK)
    return VL_OK;
  if (result == VL_ERROR_MEMORY)
    return vl_fail_memory(error);
  return vl_fail(error, result, "%s: film file: %s", reader->path, own.message);
}

vlResult vl_film_file_open(vlContext *context, const char *path, vlFilmFile **file,
                           vlError *error) {
  vl_error_clear(error);
  if (file)
    *file = NULL;
  if (!context || !path || !file)
    return vl_fail_argument(error, "film file: context, path or file is null");
  vlFilmFile *made = vl_alloc_zero(context, 1, sizeof *made);
  if (!made)
    return vl_fail_memory(error);
  vlResult result = vl_film_reader_open(&made->reader, context, path, error);
  if (result != VL_OK) {
    vl_free(context, made);
    return result;
  }
  if (made->reader.texts.receipt)
    result = vl_film_receipt(&made->reader, &made->receipt, error);
  if (result != VL_OK) {
    vl_film_file_close(made);
    return result;
  }
  *file = made;
  return VL_OK;
}

void vl_film_file_close(vlFilmFile *file) {
  if (!file)
    return;
  vlContext *context = file->reader.context;
  vl_receipt_destroy(file->receipt);
  VL_FREE(context, file->data, file->ranges);
  vl_film_reader_close(&file->reader);
  vl_free(context, file);
}

const vlFilmDef *vl_film_file_def(const vlFilmFile *file) {
  return &file->reader.shape.def;
}
uint32_t vl_film_file_sequence(const vlFilmFile *file) {
  return file->reader.shape.sequence;
}
const vlReceipt *vl_film_file_receipt(const vlFilmFile *file) {
  return file->receipt;
}

vlResult vl_film_file_attributes(const vlFilmFile *file, vlImage *image, vlError *error) {
  vl_error_clear(error);
  if (!file || !image)
    return vl_fail_argument(error, "film file: file or image is null");
  const vlFilmReader *r = &file->reader;
  return r->texts.attributes
             ? vl_film_attributes_set(r->path, r->texts.attributes, image, error)
             : VL_OK;
}

/* Reads the data of the block whose head was read last: a check of its checksum. */
static vlResult check_data(vlFilmFile *file, vlError *error) {
  vlFilmReader *r = &file->reader;
  if (!file->data)
    file->data = vl_alloc(r->context, vl_film_max_data(&r->shape.def));
  if (!file->data)
    return vl_fail_memory(error);
  return vl_film_reader_data(r, file->data, error);
}

vlResult vl_film_file_next(vlFilmFile *file, bool check, vlFilmBlock *block, vlError *error) {
  vl_error_clear(error);
  if (block)
    *block = (vlFilmBlock){.range_count = 0};
  if (!file || !block)
    return vl_fail_argument(error, "film file: file or block is null");
  vlFilmReader *r = &file->reader;
  if (r->next > r->blocks)
    return VL_OK;
  bool last = r->next == r->blocks;
  vlResult result = vl_film_reader_next(r, error);
  if (result != VL_OK || last)
    return result;
  if (check)
    VL_TRY(check_data(file, error));
  const vlFilmBlockHead *h = &r->head;
  if (h->range_count > file->capacity) {
    vlSampleRange *more =
        vl_realloc_array(r->context, file->ranges, h->range_count, sizeof *more);
    if (!more)
      return vl_fail_memory(error);
    file->ranges = more;
    file->capacity = h->range_count;
  }
  for (uint32_t i = 0; i < h->range_count; i++)
    file->ranges[i] = (vlSampleRange){r->ranges[i].first, r->ranges[i].end};
  *block = (vlFilmBlock){h->x0, h->y0, h->x1, h->y1, h->range_count, file->ranges};
  return VL_OK;
}
