/* film/file_write.c: vl_film_write: writes a film to a file. All workers write blocks, each
 * block at its own offset. */
#include <errno.h>
#include <stdatomic.h>
#include <string.h>
#include <unistd.h>

#include "base/cookie.h"
#include "base/error.h"
#include "base/free.h"
#include "base/json.h"
#include "film/file.h"
#include "velo/film.h"

struct vlFilmWriter {
  vlContext *context;
  vlFilmLock *lock; /* null: the caller has it */
  vlFileWriter file;
};

typedef struct Run {
  const vlFilm *film;
  const uint32_t *window;
  uint64_t *offsets; /* of the blocks in the file, bytes */
  char *buffers;     /* of buffer_size bytes, one for each worker */
  size_t buffer_size;
  int descriptor;
  char *memory; /* of a film that is written as a stream: the whole file; null: it has a
                   descriptor */
  atomic_int failed_errno;
} Run;

vlFilmWriteDef vl_default_film_write_def(void) {
  return (vlFilmWriteDef){.cookie = VL_COOKIE_FILM_WRITE};
}

/* The samples of the film's pixels in a block of the window. Empty: none. */
static vlSampleSpan samples_of(const vlFilm *film, const uint32_t block_window[4]) {
  const uint32_t *c = film->def.crop, first = film->sequence.first;
  if (block_window[0] < c[0] || block_window[1] < c[1] || block_window[2] > c[2] ||
      block_window[3] > c[3])
    return (vlSampleSpan){first, first};
  return (vlSampleSpan){
      first,
      first + vl_film_block_spp(film, vl_film_block_at(c, block_window[0], block_window[1]))};
}

/* The head of a block of the window. Returns the size of the block in the file, bytes. */
static size_t head_of(const vlFilm *film, const uint32_t block_window[4], vlSampleSpan samples,
                      vlFilmBlockHead *head) {
  bool filled = samples.first < samples.end;
  const vlComparedNoise *compared =
      filled && film->compared
          ? film->compared + vl_film_block_at(film->def.crop, block_window[0], block_window[1])
          : NULL;
  return vl_film_block_head(&film->def, block_window, filled, compared, head);
}

/* Whether the crop lies in the window and no block of the window is partly inside the crop. */
static bool fits_grid(const uint32_t window[4], const uint32_t crop[4]) {
  for (int i = 0; i < 4; i++)
    if (crop[i] != window[i] && crop[i] % VL_FILM_BLOCK != 0)
      return false;
  return crop[0] >= window[0] && crop[1] >= window[1] && crop[2] <= window[2] &&
         crop[3] <= window[3];
}

static void write_block(void *user, uint32_t block, uint32_t worker) {
  Run *run = user;
  if (atomic_load(&run->failed_errno))
    return;
  char *buffer = run->buffers + worker * run->buffer_size, *to = buffer;
  uint32_t block_window[4];
  vl_film_block_window(run->window, block, block_window);
  vlSampleSpan range = samples_of(run->film, block_window);
  vlFilmBlockHead head;
  head_of(run->film, block_window, range, &head);
  memcpy(to, &head, sizeof head);
  to += sizeof head;
  if (head.range_count) {
    memcpy(to, &range, sizeof range);
    to = vl_film_copy_block(run->film, block_window, VL_FROM_FILM, to + sizeof range);
  }
  uint32_t crc = vl_film_crc(0, buffer, (size_t)(to - buffer));
  memcpy(to, &crc, sizeof crc);
  to += sizeof crc;
  uint64_t at = run->offsets[block];
  if (run->memory) {
    memcpy(run->memory + at, buffer, (size_t)(to - buffer));
    return;
  }
  for (const char *from = buffer; from < to;) {
    ssize_t n = pwrite(run->descriptor, from, (size_t)(to - from), (off_t)at);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0) {
      atomic_store(&run->failed_errno, errno);
      return;
    }
    from += n;
    at += (uint64_t)n;
  }
}

static vlResult write_blocks(vlFilmWriter *writer, Run *run, uint64_t at, vlError *error) {
  uint32_t count = vl_film_block_count(run->window),
           threads = vl_context_threads(writer->context);
  run->buffer_size = sizeof(vlFilmBlockHead) + sizeof(vlSampleSpan) + sizeof(uint32_t) +
                     vl_film_max_data(&run->film->def);
  run->buffer_size = (run->buffer_size + 63) & ~(size_t)63;
  run->offsets = vl_alloc_array(writer->context, count, sizeof *run->offsets);
  run->buffers = vl_alloc_array(writer->context, threads, run->buffer_size);
  vlResult result = run->offsets && run->buffers ? VL_OK : vl_fail_memory(error);
  for (uint32_t i = 0; i < count && result == VL_OK; i++) {
    uint32_t block_window[4];
    vlFilmBlockHead head;
    vl_film_block_window(run->window, i, block_window);
    run->offsets[i] = at;
    at += head_of(run->film, block_window, samples_of(run->film, block_window), &head);
  }
  if (result == VL_OK && writer->file.in_memory && !vl_file_reserve(&writer->file, at))
    result = vl_fail_memory(error);
  if (writer->file.in_memory) {
    run->memory = writer->file.memory;
    writer->file.memory_size = at;
  }
  if (result == VL_OK)
    vl_parallel_for(writer->context, count, write_block, run);
  VL_FREE(writer->context, run->offsets, run->buffers);
  if (!writer->file.failed_errno)
    writer->file.failed_errno = atomic_load(&run->failed_errno);
  return result;
}

static vlResult check(const vlFilm *film, const vlFilmWriteDef *def, const char *path,
                      const uint32_t window[4], vlError *error) {
  if (def->cookie != VL_COOKIE_FILM_WRITE)
    return vl_fail_argument(
        error, "film file: def.cookie is not that of a default def of this version");
  if (film->in_pass || film->sequence.uneven || !film->spp || !film->front)
    return vl_fail_argument(
        error, "%s: the film has no samples, or pixels with different samples", path);
  if (window[2] > film->def.width || window[3] > film->def.height ||
      !fits_grid(window, film->def.crop))
    return vl_fail_argument(
        error,
        "%s: the film's crop must lie in the window and end at its sides or at "
        "multiples of %d pixels",
        path, VL_FILM_BLOCK);
  return VL_OK;
}

/* The header holds the receipt as a part of its JSON. */
static vlResult check_receipt(const char *receipt, const char *path, vlError *error) {
  if (!receipt)
    return VL_OK;
  json_error_t wrong;
  json_t *tree = vl_json_parse(receipt, strlen(receipt), JSON_REJECT_DUPLICATES, &wrong);
  if (!tree && vl_json_lacks_memory(&wrong))
    return vl_fail_memory(error);
  if (!tree)
    return vl_fail_argument(error, "%s: receipt: line %d: %s", path, wrong.line, wrong.text);
  json_decref(tree);
  return VL_OK;
}

static char *make_header(vlContext *context, const vlFilmShape *shape,
                         const vlFilmWriteDef *def) {
  vlFilmTexts texts = {
      .attributes = def->attributes ? vl_film_attributes_make(context, def->attributes) : NULL};
  char *header = NULL;
  texts.receipt = (char *)(uintptr_t)def->receipt; /* is not changed */
  if (!def->attributes || texts.attributes)
    header = vl_film_header_make(context, shape, &texts);
  vl_free(context, texts.attributes);
  return header;
}

vlResult vl_film_write_begin(const vlFilm *film, const vlFilmWriteDef *def, const char *path,
                             vlFilmWriter **writer, vlError *error) {
  vl_error_clear(error);
  vlFilmWriteDef standard = vl_default_film_write_def();
  if (!def)
    def = &standard;
  if (writer)
    *writer = NULL;
  if (!film || !path || !writer)
    return vl_fail_argument(error, "film file: film, path or writer is null");
  bool whole = !def->window[2] && !def->window[3];
  const uint32_t *window = whole ? film->def.crop : def->window;
  vlResult result = check(film, def, path, window, error);
  if (result == VL_OK)
    result = check_receipt(def->receipt, path, error);
  if (result != VL_OK)
    return result;
  vlFilmShape shape = {film->def, film->sequence.length, film->sequence.own};
  memcpy(shape.def.crop, window, sizeof shape.def.crop);
  vlFilmWriter *made = vl_alloc_zero(film->context, 1, sizeof *made);
  char *header = make_header(film->context, &shape, def);
  if (!made || !header) {
    VL_FREE(film->context, made, header);
    return vl_fail_memory(error);
  }
  made->context = film->context;
  if (!def->lock)
    result = vl_film_lock_write(film->context, path, &made->lock, error);
  if (result == VL_OK)
    result = vl_file_open_write(&made->file, film->context, path, VL_OUTPUT_FILM, error);
  if (result == VL_OK) {
    Run run = {.film = film, .window = window, .descriptor = made->file.descriptor};
    result = vl_film_put_header(&made->file, header);
    if (result == VL_OK)
      result = write_blocks(made, &run, sizeof(vlFilmPreamble) + strlen(header), error);
    if (result == VL_OK && made->file.failed_errno)
      result = vl_fail(error, VL_ERROR_IO, "cannot write %s: %s", path,
                       strerror(made->file.failed_errno));
    if (result != VL_OK)
      vl_file_abandon(&made->file);
  }
  vl_free(film->context, header);
  if (result == VL_OK) {
    *writer = made;
  } else {
    vl_film_unlock(made->lock);
    vl_free(film->context, made);
  }
  return result;
}

vlResult vl_film_write_end(vlFilmWriter *writer, vlError *error) {
  vl_error_clear(error);
  if (!writer)
    return vl_fail_argument(error, "film file: writer is null");
  vlResult result = vl_file_commit(&writer->file, error);
  vl_film_unlock(writer->lock);
  vl_free(writer->context, writer);
  return result;
}

vlResult vl_film_write(const vlFilm *film, const vlFilmWriteDef *def, const char *path,
                       vlError *error) {
  vlFilmWriter *writer;
  VL_TRY(vl_film_write_begin(film, def, path, &writer, error));
  return vl_film_write_end(writer, error);
}
