/* film/file.h: film files (docs/film-files.md): a preamble, a header of JSON, then blocks of
 * pixels with their sums. Numbers are little-endian; sums are stored as they are in memory. */
#ifndef FILM_FILE_H
#define FILM_FILE_H

#include "base/file.h"
#include "base/file_lock.h"
#include "film/sums.h"
#include "velo/film.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
               "film files are little-endian, and sums are stored as they are");

enum {
  VL_FILM_FORMAT = 3, /* 1 and 2 are read, too: file_common.c */
  VL_FILM_MAX_RANGES = 1 << 16,
  VL_FILM_MAX_HEADER = 1 << 26 /* bytes */
};

typedef struct vlSampleSpan {
  uint32_t first, end;
} vlSampleSpan;

typedef struct vlFilmPreamble {
  char magic[8];
  uint32_t format, header_size, header_crc, crc; /* crc: of the bytes before this field */
} vlFilmPreamble;
_Static_assert(sizeof(vlFilmPreamble) == 24, "no padding");
extern const char vl_film_magic[8];

typedef struct vlFilmBlockHead {
  uint32_t magic, range_count, x0, y0, x1, y1;
  uint64_t data_size;       /* bytes of sums */
  vlComparedNoise compared; /* 0 where samples were not chosen by their noise */
} vlFilmBlockHead;
_Static_assert(sizeof(vlFilmBlockHead) == 48, "no padding");
enum { VL_FILM_BLOCK_MAGIC = 0x4b4c4256 }; /* "VBLK" */

/* What films of one render share. */
typedef struct vlFilmShape {
  vlFilmDef def; /* its crop is that of the whole render */
  uint32_t sequence;
  vlFilmOwn own;
} vlFilmShape;

/* Bytes of a pixel's mean, which blocks of format 2 with a comparison have. */
enum { VL_FILM_OLD_MEAN = 16 };
/* Bytes of a pixel's sums in a file. */
static inline size_t vl_film_pixel_size(const vlFilmDef *def) {
  return sizeof(vlFilmPixel) + (def->errors ? sizeof(vlFilmMoments) : 0) +
         def->buckets * (sizeof(vlInt128) + sizeof(int64_t));
}
/* The most bytes of a block's data, in files of all formats. */
static inline size_t vl_film_max_data(const vlFilmDef *def) {
  return (size_t)VL_FILM_BLOCK * VL_FILM_BLOCK * (vl_film_pixel_size(def) + VL_FILM_OLD_MEAN);
}
uint32_t vl_film_crc(uint32_t crc, const void *data, size_t size);

/* ---- header ------------------------------------------------------------------------------ */

/* What a header has beside the shape: JSON texts, each of which may be null. */
typedef struct vlFilmTexts {
  char *receipt, *attributes;
} vlFilmTexts;

/* Whether films are of one render, but for their receipts and own kinds. */
bool vl_film_same_shape(const vlFilmShape *a, const vlFilmShape *b);
/* The text of a header. Null: out of memory. */
char *vl_film_header_make(vlContext *context, const vlFilmShape *shape,
                          const vlFilmTexts *texts);
/* Reads a header. The caller frees the texts. Errors: SCENE, MEMORY. */
vlResult vl_film_header_read(vlContext *context, const char *path, const char *text,
                             size_t size, vlFilmShape *shape, vlFilmTexts *texts,
                             vlError *error);
/* The attributes of an image as JSON: {"name": ["type", value, ...]}. Null: out of memory. */
char *vl_film_attributes_make(vlContext *context, const vlImage *image);
/* Sets the attributes of such a text on an image. Errors: SCENE, MEMORY. */
vlResult vl_film_attributes_set(const char *path, const char *text, vlImage *image,
                                vlError *error);

/* ---- reading ----------------------------------------------------------------------------- */

typedef struct vlFilmReader {
  vlContext *context;
  int descriptor; /* -1: closed */
  uint64_t size, at;
  uint32_t format;
  char *path;
  vlFilmShape shape;
  vlFilmTexts texts;
  char buffer[4096];
  uint64_t buffer_at; /* offset of the buffer's bytes in the file */
  size_t buffered;    /* number of these bytes */
  uint32_t blocks, next;
  /* head and ranges of the block that was read last */
  vlFilmBlockHead head;
  vlSampleSpan *ranges;
  uint32_t range_capacity;
  uint64_t data_at;
  uint32_t crc; /* of head and ranges */
} vlFilmReader;

vlResult vl_film_reader_open(vlFilmReader *reader, vlContext *context, const char *path,
                             vlError *error);
/* Whether a file begins as film files do, damaged or not. */
bool vl_film_begins_as_film(const char *path);
void vl_film_reader_close(vlFilmReader *reader);
/* Reads the head and the ranges of the next block; reader->next <= reader->blocks. */
vlResult vl_film_reader_next(vlFilmReader *reader, vlError *error);
/* Reads and checks the data of that block: pixels (row by row), then moments, then spectra.
 * data: of vl_film_max_data bytes. */
vlResult vl_film_reader_data(vlFilmReader *reader, void *data, vlError *error);
/* Reads the CRC of that block from the file without checking it. */
vlResult vl_film_reader_crc(vlFilmReader *reader, uint32_t *crc, vlError *error);

/* ---- blocks of a film -------------------------------------------------------------------- */

typedef enum vlFilmCopy { VL_FROM_FILM, VL_TO_FILM } vlFilmCopy;
/* Copies the sums of a window's pixels between a film and a block's data as stored in the file.
 * The film has all arrays that its def asks for. Returns the end of the data. */
void *vl_film_copy_block(const vlFilm *film, const uint32_t window[4], vlFilmCopy way,
                         void *data);

/* ---- merging ----------------------------------------------------------------------------- */

/* Adds the sums in `from` to those in `to`; both hold a block's data as stored in the file.
 * to_end, from_end: the indices behind their last samples. */
void vl_film_add_block(const vlFilmDef *def, size_t pixels, void *to, uint32_t to_end,
                       const void *from, uint32_t from_end);

/* ---- earlier formats --------------------------------------------------------------------- */

/* The size of a block's data in a file of format 1 or 2. compared: it has a comparison, and
 * means with it. */
size_t vl_film_old_data_size(const vlFilmDef *def, uint32_t format, size_t pixels,
                             bool compared);
/* Brings a block's data of format 1 or 2 into the present form, in place; data has room for
 * vl_film_max_data bytes. */
void vl_film_convert_old_data(const vlFilmDef *def, size_t pixels, void *data);

/* ---- locks ------------------------------------------------------------------------------- */

struct vlFilmLock {
  vlContext *context;
  vlFileLock file;
};

/* As vl_film_lock; where another has the lock: IO. */
vlResult vl_film_lock_write(vlContext *context, const char *path, vlFilmLock **lock,
                            vlError *error);

/* ---- writing ----------------------------------------------------------------------------- */

/* The number of samples of a block. */
uint64_t vl_film_samples(const vlSampleSpan *ranges, uint32_t count);
/* Writes preamble and header. */
vlResult vl_film_put_header(vlFileWriter *writer, const char *header);
/* Fills a block's head. compared: null: none. Returns the size of the block in the file,
 * bytes. */
size_t vl_film_block_head(const vlFilmDef *def, const uint32_t window[4], uint32_t range_count,
                          const vlComparedNoise *compared, vlFilmBlockHead *head);

#endif
