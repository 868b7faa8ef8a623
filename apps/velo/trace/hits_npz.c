/* trace/hits_npz.c: hits as an archive of NumPy's arrays (.npz): a ZIP file (PKWARE's
 * APPNOTE 6.3, sections 4.3.7, 4.3.12, 4.3.16) whose members are stored as they are, without a
 * date. */
#include <inttypes.h>
#include <string.h>
#include <zlib.h>

#include "cli/macros.h"
#include "cli/text.h"
#include "trace/hits_file.h"

/* Bytes: of a name at most; of a member's header, its line in the directory, and the
 * directory's end, without names. */
enum { NAME = 32, LOCAL = 30, CENTRAL = 46, END = 22 };
enum { MEMBER_MARK = 0x04034b50, LINE_MARK = 0x02014b50, END_MARK = 0x06054b50, VERSION = 20 };

/* An array of the archive. */
typedef struct Member {
  char name[NAME]; /* of its file */
  char start[HITS_NPY_START];
  size_t start_length;
  uint32_t crc, bytes, offset; /* of the whole array's file; where its header begins */
} Member;

typedef struct Archive {
  FILE *out;
  uint32_t length; /* bytes written */
} Archive;

static void put(Archive *a, const void *data, size_t size) {
  fwrite(data, 1, size, a->out);
  a->length += (uint32_t)size;
}

/* Numbers of 2 and 4 bytes, the lowest first. */
static void put_number(Archive *a, uint32_t value, int size) {
  unsigned char bytes[4];
  for (int i = 0; i < size; i++)
    bytes[i] = (unsigned char)(value >> 8 * i);
  put(a, bytes, (size_t)size);
}

/* What the header of a member and its line in the directory have in common. */
static void put_common(Archive *a, const Member *m) {
  const uint32_t first_day = 0x21; /* 1980-01-01 */
  put_number(a, VERSION, 2);
  put_number(a, 0, 2); /* flags */
  put_number(a, 0, 2); /* stored */
  put_number(a, 0, 2); /* time */
  put_number(a, first_day, 2);
  put_number(a, m->crc, 4);
  put_number(a, m->bytes, 4);
  put_number(a, m->bytes, 4);
  put_number(a, (uint32_t)strlen(m->name), 2);
  put_number(a, 0, 2); /* no extra field */
}

static void put_member(Archive *a, Member *m, const void *rows, size_t bytes) {
  m->offset = a->length;
  const uLong start = crc32(0, (const Bytef *)m->start, (uInt)m->start_length);
  m->crc = (uint32_t)crc32(start, rows, (uInt)bytes);
  m->bytes = (uint32_t)(m->start_length + bytes);
  put_number(a, MEMBER_MARK, 4);
  put_common(a, m);
  put(a, m->name, strlen(m->name));
  put(a, m->start, m->start_length);
  put(a, rows, bytes);
}

static void put_directory(Archive *a, const Member *members, uint32_t count) {
  const uint32_t from = a->length;
  for (uint32_t i = 0; i < count; i++) {
    const Member *m = &members[i];
    put_number(a, LINE_MARK, 4);
    put_number(a, VERSION, 2); /* made by */
    put_common(a, m);
    put_number(a, 0, 2); /* no comment */
    put_number(a, 0, 2); /* the first disk */
    put_number(a, 0, 2); /* attributes */
    put_number(a, 0, 4);
    put_number(a, m->offset, 4);
    put(a, m->name, strlen(m->name));
  }
  const uint32_t length = a->length - from;
  put_number(a, END_MARK, 4);
  put_number(a, 0, 4); /* the first disk */
  put_number(a, count, 2);
  put_number(a, count, 2);
  put_number(a, length, 4);
  put_number(a, from, 4);
  put_number(a, 0, 2); /* no comment */
}

bool hits_fit_npz(const HitsFile *h) {
  const uint64_t others = HITS_FIELDS * (HITS_NPY_START + LOCAL + CENTRAL + 2 * NAME) + END;
  const uint64_t rows = h->count * (h->occluded ? 1 : h->hits);
  return rows <= (UINT32_MAX - others) / (h->occluded ? 1 : HITS_ROW);
}

void hits_write_npz(const HitsFile *h, FILE *out) {
  static const HitsField occluded = {"occluded", "|b1", 0, 0};
  Archive a = {.out = out};
  Member members[HITS_FIELDS];
  const uint32_t count = h->occluded ? 1 : HITS_FIELDS;
  const bool several = h->hits > 1 && !h->occluded;
  for (uint32_t i = 0; i < count && !ferror(out); i++) {
    const HitsField *f = h->occluded ? &occluded : &hits_fields[i];
    const void *rows = h->occluded ? (const void *)h->occluded : hits_field_rows(&h->rows, f);
    Member *m = &members[i];
    char shape[64], type[16];
    text_set(m->name, "%s.npy", f->name);
    text_set(type, "'%s'", f->type);
    text_set(shape, "%" PRIu64 ",", h->count);
    if (several)
      text_add(shape, sizeof shape, " %u,", h->hits);
    if (f->columns)
      text_add(shape, sizeof shape, " %u,", f->columns);
    m->start_length = hits_npy_start(m->start, type, shape);
    put_member(&a, m, rows, (size_t)h->count * (several ? h->hits : 1) * hits_field_size(f));
  }
  put_directory(&a, members, count);
}
