/* film/blocks.h: the blocks of a film file, grouped into rectangles of pixels with the same
 * samples. */
#ifndef APP_FILM_BLOCKS_H
#define APP_FILM_BLOCKS_H

#include "velo/film.h"

/* A list of ranges of samples. */
typedef struct RangeList {
  vlSampleRange *ranges;
  uint32_t count;
} RangeList;

/* A rectangle of pixels and its samples. */
typedef struct FilmPart {
  uint32_t window[4];
  RangeList samples;
} FilmPart;

typedef struct FilmParts {
  FilmPart *parts;
  uint32_t count;
  RangeList *lists; /* owned; the parts point into these lists */
  uint32_t list_count;
} FilmParts;

/* Reads all blocks and groups them; `check` also verifies their checksums. If planned is 0, the
 * parts list the samples that the film has. Otherwise they list the samples of [0, planned)
 * that it lacks. Parts without samples are omitted. Returns -1, or the exit code after
 * reporting the error. */
int film_parts_read(vlFilmFile *file, bool check, uint32_t planned, FilmParts *parts);
void film_parts_free(FilmParts *parts);

#endif
