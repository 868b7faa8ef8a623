/* api/film_merge.c: vl_film_merge: merges films of one render, block by block. In each block,
 * files are added in the order of their number of samples, the largest first. A file is skipped
 * if an added file has all its samples. It is an error if it shares only some of its samples
 * with an added file. */
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "api/receipt.h"
#include "base/cookie.h"
#include "base/error.h"
#include "base/free.h"
#include "film/file.h"
#include "velo/film.h"

/* Files that are open at the same time; more files are merged in several rounds. */
enum { MAX_FILES = 200 };

typedef struct Part {
  vlFilmReader reader;
  uint64_t samples; /* of the current block */
  bool added;       /* its sums are a part of the result's */
} Part;

typedef struct Merge {
  vlContext *context;
  Part *parts;
  uint32_t count;
  uint32_t *order;               /* indices of parts, sorted by samples, most first */
  vlSampleSpan *ranges, *joined; /* samples of the result's block; working memory of join */
  uint32_t range_count;
  /* of the result's block: that of its only part, 0 if it has several */
  vlComparedNoise compared;
  char *sum, *data;     /* the result's block; one part's block */
  vlFilmReader earlier; /* the file that the result replaces; only what the result has, too;
                           descriptor -1: none */
  vlFileWriter file;
  vlError *error;
} Merge;

/* ---- which films belong together --------------------------------------------------------- */

typedef struct Difference {
  vlError *error;
  const char *path, *first;
} Difference;

static bool name_difference(void *user, const char *text) {
  Difference *d = user;
  vl_fail(d->error, VL_ERROR_SCENE, "%s and %s are of different renders: %s", d->path, d->first,
          text);
  return false;
}

static vlResult check_pair(const Merge *m, const vlFilmReader *r) {
  const vlFilmReader *first = &m->parts[0].reader;
  vlReceipt *then = NULL, *now = NULL;
  vlResult result = VL_OK;
  if (!first->texts.receipt != !r->texts.receipt)
    return vl_fail(m->error, VL_ERROR_SCENE,
                   "%s and %s are of different renders: one has no receipt", r->path,
                   first->path);
  if (r->texts.receipt) {
    result = vl_film_receipt(first, &then, m->error);
    if (result == VL_OK)
      result = vl_film_receipt(r, &now, m->error);
    Difference d = {m->error, r->path, first->path};
    uint32_t parts =
        VL_RECEIPT_SEQUENCE | VL_RECEIPT_FILES | VL_RECEIPT_CAMERA | VL_RECEIPT_SETTINGS;
    if (result == VL_OK && vl_receipt_compare(then, now, parts, name_difference, &d))
      result = VL_ERROR_SCENE;
    vl_receipt_destroy(then);
    vl_receipt_destroy(now);
  }
  vlOwnKind kind = vl_film_own_differs(&r->shape.own, &first->shape.own);
  if (result == VL_OK && kind < VL_OWN_KINDS) {
    const char *now_name = r->shape.own.name[kind], *then_name = first->shape.own.name[kind];
    result = vl_fail(m->error, VL_ERROR_SCENE,
                     "%s and %s are of different renders: own %s is \"%s\", was \"%s\"",
                     r->path, first->path, vl_own_words[kind], vl_short_text(now_name).text,
                     vl_short_text(then_name).text);
  }
  if (result == VL_OK && !vl_film_same_shape(&r->shape, &first->shape))
    result = vl_fail(m->error, VL_ERROR_SCENE,
                     "%s and %s are of different renders: their films differ (size, crop, "
                     "sequence or filter)",
                     r->path, first->path);
  return result;
}

static vlResult open_parts(Merge *m, const char *const *paths) {
  for (uint32_t i = 0; i < m->count; i++) {
    m->parts[i].reader.descriptor = -1;
    m->order[i] = i;
  }
  for (uint32_t i = 0; i < m->count; i++) {
    vlFilmReader *r = &m->parts[i].reader;
    VL_TRY(vl_film_reader_open(r, m->context, paths[i], m->error));
    if (i)
      VL_TRY(check_pair(m, r));
  }
  return VL_OK;
}

/* Opens the file that the result would replace. It must be a film, and of the same render
 * unless it is overwritten; an empty file is none. */
static vlResult open_earlier(Merge *m, const char *output, bool overwrite) {
  struct stat info;
  vlError own = {0}, *error = m->error;
  if (stat(output, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size == 0)
    return VL_OK;
  if (overwrite && vl_film_begins_as_film(output))
    return VL_OK;
  m->error = &own;
  vlResult result = vl_film_reader_open(&m->earlier, m->context, output, &own);
  if (result == VL_OK)
    result = check_pair(m, &m->earlier);
  m->error = error;
  if (result == VL_OK || result == VL_ERROR_MEMORY)
    return result;
  return vl_fail(error, result, "%s is not replaced: %s", output, own.message);
}

/* The first of the parts' receipts in the order of strcmp, with its attributes, so that the
 * header of the result does not depend on the order of the files. */
static const vlFilmTexts *choose_texts(const Merge *m) {
  const vlFilmTexts *min = &m->parts[0].reader.texts;
  for (uint32_t i = 1; i < m->count; i++) {
    const vlFilmTexts *texts = &m->parts[i].reader.texts;
    int order = min->receipt ? strcmp(texts->receipt, min->receipt) : 0;
    if (order == 0 && texts->attributes) /* films of earlier versions have none */
      order = min->attributes ? strcmp(texts->attributes, min->attributes) : -1;
    if (order < 0)
      min = texts;
  }
  return min;
}

/* ---- samples of a block ------------------------------------------------------------------ */

static bool contains(const vlSampleSpan *a, uint32_t n, const vlSampleSpan *b, uint32_t m) {
  uint32_t i = 0;
  for (uint32_t k = 0; k < m; k++) {
    while (i < n && a[i].end < b[k].end)
      i++;
    if (i == n || a[i].first > b[k].first)
      return false;
  }
  return true;
}

static bool overlap(const vlSampleSpan *a, uint32_t n, const vlSampleSpan *b, uint32_t m,
                    vlSampleSpan *common) {
  for (uint32_t i = 0, k = 0; i < n && k < m;) {
    uint32_t first = a[i].first > b[k].first ? a[i].first : b[k].first,
             end = a[i].end < b[k].end ? a[i].end : b[k].end;
    if (first < end) {
      *common = (vlSampleSpan){first, end};
      return true;
    }
    if (a[i].end < b[k].end)
      i++;
    else
      k++;
  }
  return false;
}

/* Adds ranges to those of the result; they do not overlap. */
static vlResult join(Merge *m, const vlSampleSpan *b, uint32_t count) {
  uint32_t n = 0;
  for (uint32_t i = 0, k = 0; i < m->range_count || k < count;) {
    bool first = k == count || (i < m->range_count && m->ranges[i].first < b[k].first);
    vlSampleSpan next = first ? m->ranges[i++] : b[k++];
    if (n && m->joined[n - 1].end == next.first)
      m->joined[n - 1].end = next.end;
    else if (n < VL_FILM_MAX_RANGES)
      m->joined[n++] = next;
    else
      return vl_fail(m->error, VL_ERROR_SCENE, "the films' samples have more than %d gaps",
                     VL_FILM_MAX_RANGES);
  }
  vlSampleSpan *swap = m->ranges;
  m->ranges = m->joined;
  m->joined = swap;
  m->range_count = n;
  return VL_OK;
}

/* Sets *counts to whether part i is to be added: false if an added part has all its samples. An
 * error if an added part has some of its samples, or the same samples with other sums. */
static vlResult choose(Merge *m, uint32_t i, bool *counts) {
  Part *p = &m->parts[i];
  vlFilmReader *r = &p->reader;
  vlSampleSpan common;
  *counts = true;
  for (uint32_t k = 0; k < m->count; k++) {
    Part *q = &m->parts[k];
    vlFilmReader *other = &q->reader;
    if (!q->added || !overlap(other->ranges, other->head.range_count, r->ranges,
                              r->head.range_count, &common))
      continue;
    if (!contains(other->ranges, other->head.range_count, r->ranges, r->head.range_count))
      return vl_fail(m->error, VL_ERROR_SCENE,
                     "%s and %s overlap: both have samples %u:%u of pixels %u,%u to %u,%u",
                     r->path, other->path, common.first, common.end, r->head.x0, r->head.y0,
                     r->head.x1, r->head.y1);
    *counts = false;
    if (p->samples != q->samples)
      continue;
    uint32_t mine, its;
    VL_TRY(vl_film_reader_crc(r, &mine, m->error));
    VL_TRY(vl_film_reader_crc(other, &its, m->error));
    if (mine != its)
      return vl_fail(m->error, VL_ERROR_SCENE,
                     "%s and %s have the same samples of pixels %u,%u with different sums",
                     r->path, other->path, r->head.x0, r->head.y0);
  }
  return VL_OK;
}

static int more_samples(const Merge *m, uint32_t a, uint32_t b) {
  uint64_t x = m->parts[a].samples, y = m->parts[b].samples;
  return x > y || (x == y && a < b);
}

/* Insertion sort, since the order changes little from block to block. */
static void sort_parts(Merge *m) {
  for (uint32_t i = 1; i < m->count; i++)
    for (uint32_t k = i; k > 0 && more_samples(m, m->order[k], m->order[k - 1]); k--) {
      uint32_t swap = m->order[k];
      m->order[k] = m->order[k - 1];
      m->order[k - 1] = swap;
    }
}

/* Whether the result's block has all samples of the earlier file's. */
static vlResult check_earlier(Merge *m) {
  vlFilmReader *r = &m->earlier;
  if (r->descriptor < 0)
    return VL_OK;
  vlResult result = vl_film_reader_next(r, m->error);
  if (result != VL_OK || contains(m->ranges, m->range_count, r->ranges, r->head.range_count))
    return result;
  return vl_fail(m->error, VL_ERROR_SCENE,
                 "%s is not replaced: it has samples of pixels %u,%u that the result lacks",
                 r->path, r->head.x0, r->head.y0);
}

static uint32_t last_end(const vlSampleSpan *ranges, uint32_t count) {
  return ranges[count - 1].end;
}

static vlResult merge_block(Merge *m) {
  vlResult result = VL_OK;
  for (uint32_t i = 0; i < m->count && result == VL_OK; i++) {
    Part *p = &m->parts[i];
    result = vl_film_reader_next(&p->reader, m->error);
    p->samples =
        result == VL_OK ? vl_film_samples(p->reader.ranges, p->reader.head.range_count) : 0;
    p->added = false;
  }
  if (result != VL_OK)
    return result;
  sort_parts(m);
  m->range_count = 0;
  const vlFilmBlockHead *h = &m->parts[0].reader.head;
  const vlFilmDef *def = &m->parts[0].reader.shape.def;
  size_t pixels = (size_t)(h->x1 - h->x0) * (h->y1 - h->y0);
  uint64_t samples = 0;
  for (uint32_t i = 0; i < m->count; i++) {
    Part *p = &m->parts[m->order[i]];
    bool counts, first = !m->range_count;
    if (!p->samples)
      break;
    if ((result = choose(m, m->order[i], &counts)) != VL_OK)
      return result;
    if (!counts)
      continue;
    m->compared = first ? p->reader.head.compared : (vlComparedNoise){.spp = 0};
    samples += p->samples;
    if (samples > UINT64_C(1) << 31)
      return vl_fail(m->error, VL_ERROR_SCENE,
                     "%s: a film holds at most 2^31 samples per pixel", p->reader.path);
    result = vl_film_reader_data(&p->reader, first ? m->sum : m->data, m->error);
    if (result == VL_OK && !first)
      vl_film_add_block(def, pixels, m->sum, last_end(m->ranges, m->range_count), m->data,
                        last_end(p->reader.ranges, p->reader.head.range_count));
    if (result == VL_OK)
      result = join(m, p->reader.ranges, p->reader.head.range_count);
    if (result != VL_OK)
      return result;
    p->added = true;
  }
  if ((result = check_earlier(m)) != VL_OK)
    return result;
  const uint32_t window[4] = {h->x0, h->y0, h->x1, h->y1};
  vlFilmBlockHead head;
  vl_film_block_head(def, window, m->range_count, &m->compared, &head);
  uint32_t crc = vl_film_crc(0, &head, sizeof head);
  crc = vl_film_crc(crc, m->ranges, m->range_count * sizeof *m->ranges);
  crc = vl_film_crc(crc, m->sum, head.data_size);
  vl_file_write(&m->file, &head, sizeof head);
  vl_file_write(&m->file, m->ranges, m->range_count * sizeof *m->ranges);
  vl_file_write(&m->file, m->sum, head.data_size);
  vl_file_write(&m->file, &crc, sizeof crc);
  return VL_OK;
}

/* ---- the call ---------------------------------------------------------------------------- */

static vlResult merge_opened(Merge *m, const char *output) {
  const vlFilmShape *shape = &m->parts[0].reader.shape;
  size_t size = vl_film_max_data(&shape->def);
  m->sum = vl_alloc(m->context, size);
  m->data = vl_alloc(m->context, size);
  m->ranges = vl_alloc_array(m->context, VL_FILM_MAX_RANGES, sizeof *m->ranges);
  m->joined = vl_alloc_array(m->context, VL_FILM_MAX_RANGES, sizeof *m->joined);
  char *header = vl_film_header_make(m->context, shape, choose_texts(m));
  vlResult result =
      m->sum && m->data && m->ranges && m->joined && header ? VL_OK : vl_fail_memory(m->error);
  if (result == VL_OK)
    result = vl_file_open_write(&m->file, m->context, output, VL_OUTPUT_FILM, m->error);
  if (result == VL_OK) {
    result = vl_film_put_header(&m->file, header);
    for (uint32_t b = 0;
         b < m->parts[0].reader.blocks && result == VL_OK && !m->file.failed_errno; b++)
      result = merge_block(m);
    for (uint32_t i = 0; i < m->count && result == VL_OK && !m->file.failed_errno; i++)
      /* checks that the file ends after the last block */
      result = vl_film_reader_next(&m->parts[i].reader, m->error);
    if (result == VL_OK)
      result = vl_file_commit(&m->file, m->error);
    else
      vl_file_abandon(&m->file);
  }
  vl_free(m->context, header);
  return result;
}

static vlResult merge_some(vlContext *context, const char *const *paths, uint32_t count,
                           bool overwrite, const char *output, vlError *error) {
  Merge m = {.context = context, .count = count, .earlier = {.descriptor = -1}, .error = error};
  m.parts = vl_alloc_zero(context, count, sizeof *m.parts);
  m.order = vl_alloc_array(context, count, sizeof *m.order);
  vlResult result = m.parts && m.order ? open_parts(&m, paths) : vl_fail_memory(error);
  if (result == VL_OK)
    result = open_earlier(&m, output, overwrite);
  if (result == VL_OK)
    result = merge_opened(&m, output);
  if (m.earlier.path)
    vl_film_reader_close(&m.earlier);
  for (uint32_t i = 0; i < count && m.parts && m.order; i++)
    if (m.parts[i].reader.path)
      vl_film_reader_close(&m.parts[i].reader);
  VL_FREE(context, m.parts, m.order, m.ranges, m.joined, m.sum, m.data);
  return result;
}

vlFilmMergeDef vl_default_film_merge_def(void) {
  return (vlFilmMergeDef){.cookie = VL_COOKIE_FILM_MERGE};
}

/* In rounds, with a temporary file that nobody else uses as long as the output is locked. */
static vlResult merge_many(vlContext *context, const char *const *paths, uint32_t count,
                           bool overwrite, const char *output, const vlFilmLock *lock,
                           vlError *error) {
  char between[sizeof lock->file.path];
  const char *some[MAX_FILES];
  if (!lock->file.path[0])
    return vl_fail(
        error, VL_ERROR_IO,
        "cannot write %s: more than %d films need a temporary file beside the result", output,
        MAX_FILES);
  vl_lock_sibling(&lock->file, between, sizeof between);
  vlResult result = VL_OK;
  for (uint32_t done = 0; done < count && result == VL_OK;) {
    uint32_t n = 0;
    if (done)
      some[n++] = between;
    while (n < MAX_FILES && done < count)
      some[n++] = paths[done++];
    bool last = done == count;
    result =
        merge_some(context, some, n, last ? overwrite : true, last ? output : between, error);
  }
  unlink(between);
  return result;
}

vlResult vl_film_merge(vlContext *context, const char *const *paths, uint32_t count,
                       const vlFilmMergeDef *def, const char *output, vlError *error) {
  vl_error_clear(error);
  vlFilmMergeDef standard = vl_default_film_merge_def();
  if (!def)
    def = &standard;
  if (!context || !paths || !count || !output || def->cookie != VL_COOKIE_FILM_MERGE)
    return vl_fail(
        error, VL_ERROR_ARGUMENT,
        "film merge: context, paths, count or output is null, or def.cookie is not that of a "
        "default def of this version");
  vlFilmLock *lock;
  vlResult result = vl_film_lock_write(context, output, &lock, error);
  if (result != VL_OK)
    return result;
  if (count <= MAX_FILES)
    result = merge_some(context, paths, count, def->overwrite, output, error);
  else
    result = merge_many(context, paths, count, def->overwrite, output, lock, error);
  vl_film_unlock(lock);
  return result;
}
