/* trace/hits_npz.c: hits as an archive of NumPy's arrays (.npz): a ZIP file (PKWARE's
 * APPNOTE 6.3, sections 4.3.7, 4.3.12, 4.3.16) whose members are stored as they are, without a
 * date. */
#include <inttypes.h>
#include <string.h>

#include "cli/macros.h"
#include "trace/hits_file.h"

enum { FIELDS = 12, NAME = 32, LOCAL = 30, CENTRAL = 46, END = 22 };

/* An array of the archive: `size` bytes in each of its rows. */
typedef struct Member {
  const char *name, *type;
  const void *rows;
  size_t size;
  uint32_t
      columns; /* numbers of a row; 0: the row is one number, without a dimension of its own */
  char start[HITS_NPY_START];
  size_t start_length;
  uint32_t crc, bytes, offset; /* of the whole array's file; where its header begins */
} Member;

typedef struct Archive {
  FILE *out;
  uint32_t table[256]; /* of the CRC */
  uint32_t length;     /* bytes written */
} Archive;

/* CRC-32 with the polynomial of ISO 3309, byte by byte by a table (RFC 1952, section 8). */
static void make_table(uint32_t table[256]) {
  for (uint32_t i = 0; i < 256; i++) {
    uint32_t c = i;
    for (int bit = 0; bit < 8; bit++)
      c = c & 1 ? 0xedb88320u ^ c >> 1 : c >> 1;
    table[i] = c;
  }
}

static uint32_t crc_of(const uint32_t table[256], uint32_t crc, const void *data, size_t size) {
  const unsigned char *bytes = data;
  crc = ~crc;
  for (size_t i = 0; i < size; i++)
    crc = table[(crc ^ bytes[i]) & 255] ^ crc >> 8;
  return ~crc;
}

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
  const uint32_t version = 20, first_day = 0x21; /* 1980-01-01 */
  put_number(a, version, 2);
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

static void put_member(Archive *a, Member *m, size_t bytes) {
  m->offset = a->length;
  m->crc = crc_of(a->table, 0, m->start, m->start_length);
  m->crc = crc_of(a->table, m->crc, m->rows, bytes);
  m->bytes = (uint32_t)(m->start_length + bytes);
  put_number(a, 0x04034b50, 4);
  put_common(a, m);
  put(a, m->name, strlen(m->name));
  put(a, m->start, m->start_length);
  put(a, m->rows, bytes);
}

static void put_directory(Archive *a, const Member *members, uint32_t count) {
  const uint32_t from = a->length;
  for (uint32_t i = 0; i < count; i++) {
    const Member *m = &members[i];
    put_number(a, 0x02014b50, 4);
    put_number(a, 20, 2); /* made by */
    put_common(a, m);
    put_number(a, 0, 2); /* no comment */
    put_number(a, 0, 2); /* the first disk */
    put_number(a, 0, 2); /* attributes */
    put_number(a, 0, 4);
    put_number(a, m->offset, 4);
    put(a, m->name, strlen(m->name));
  }
  const uint32_t length = a->length - from;
  put_number(a, 0x06054b50, 4);
  put_number(a, 0, 4); /* the first disk */
  put_number(a, count, 2);
  put_number(a, count, 2);
  put_number(a, length, 4);
  put_number(a, from, 4);
  put_number(a, 0, 2); /* no comment */
}

static uint32_t list_members(const HitsFile *h, Member members[FIELDS]) {
  const vlCastHits *r = &h->rows;
  if (h->occluded) {
    members[0] = (Member){"occluded.npy", "'|b1'", h->occluded, .size = 1};
    return 1;
  }
  const Member all[FIELDS] = {
      {"valid.npy", "'|b1'", r->valid, .size = 1},
      {"t.npy", "'<f8'", r->t, .size = 8},
      {"distance.npy", "'<f8'", r->distance, .size = 8},
      {"position.npy", "'<f8'", r->position, .size = 24, .columns = 3},
      {"normal.npy", "'<f4'", r->normal, .size = 12, .columns = 3},
      {"shading_normal.npy", "'<f4'", r->shading_normal, .size = 12, .columns = 3},
      {"uv.npy", "'<f4'", r->uv, .size = 8, .columns = 2},
      {"velocity.npy", "'<f8'", r->velocity, .size = 24, .columns = 3},
      {"object_id.npy", "'<u4'", r->object, .size = 4},
      {"instance_id.npy", "'<u4'", r->instance, .size = 4},
      {"primitive_id.npy", "'<u4'", r->primitive, .size = 4},
      {"material_id.npy", "'<u4'", r->material, .size = 4}};
  memcpy(members, all, sizeof all);
  return FIELDS;
}

bool hits_fit_npz(const HitsFile *h) {
  const uint64_t row = 3 * 24 + 2 * 8 + 4 * 4 + 2 * 12 + 8 + 1,
                 others = FIELDS * (HITS_NPY_START + LOCAL + CENTRAL + 2 * NAME) + END;
  const uint64_t rows = h->count * (h->occluded ? 1 : h->hits);
  return rows <= (UINT32_MAX - others) / (h->occluded ? 1 : row);
}

void hits_write_npz(const HitsFile *h, FILE *out) {
  Archive a = {.out = out};
  Member members[FIELDS];
  const uint32_t count = list_members(h, members);
  const bool several = h->hits > 1 && !h->occluded;
  make_table(a.table);
  for (uint32_t i = 0; i < count && !ferror(out); i++) {
    Member *m = &members[i];
    char shape[64], hits[16] = "", columns[16] = "";
    if (several)
      text_set(hits, " %u,", h->hits);
    if (m->columns)
      text_set(columns, " %u,", m->columns);
    text_set(shape, "%" PRIu64 ",%s%s", h->count, hits, columns);
    m->start_length = hits_npy_start(m->start, m->type, shape);
    put_member(&a, m, (size_t)h->count * (several ? h->hits : 1) * m->size);
  }
  put_directory(&a, members, count);
}
