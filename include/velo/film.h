/** @file
 * velo/film.h: films in files: stop a render and continue it, on another machine, days later; split it over machines
 * and merge the parts. Sums are exact (docs/decisions/0002-exact-film-sums.md), so that all ways to the same samples
 * give the same bytes. docs/film-files.md describes the format. */
#ifndef VELO_FILM_H
#define VELO_FILM_H

#include "velo/receipt.h"
#include "velo/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The samples first to end - 1 of a pixel. */
typedef struct vlSampleRange {
  uint32_t first, end;
} vlSampleRange;

/** How to write a film. */
typedef struct vlFilmWriteDef {
  uint32_t cookie;
  const vlReceipt
      *receipt; /**< of the whole render; kept in the header, compared by vl_film_merge; null (default): none */
  /** The pixels of the whole render: x0, y0, x1, y1, exclusive. The film's crop lies in it; the rest is without
   * samples, for other films to fill. All 0 (default): the film's crop. */
  uint32_t window[4];
} vlFilmWriteDef;
/** The default def. */
VL_API vlFilmWriteDef vl_default_film_write_def(void);
/** Writes a film file whole or not at all: to a temporary file in the same folder, synced, renamed, the folder synced;
 * a file that is replaced stays until then. Not while a render runs, except from its callback after a pass. def may be
 * null. Errors: ARGUMENT (also a film without samples), MEMORY, IO. */
VL_API vlResult vl_film_write(const vlFilm *film, const vlFilmWriteDef *def, const char *path, vlError *error);

/** A film file that is being written. */
typedef struct vlFilmWriter vlFilmWriter;
/** The first part of vl_film_write: writes a temporary file, on the workers of the film's context. The film may change
 * afterwards. Errors as vl_film_write; *writer is null then. */
VL_API vlResult vl_film_write_begin(const vlFilm *film, const vlFilmWriteDef *def, const char *path,
                                    vlFilmWriter **writer, vlError *error);
/** The second part: waits until the disk has the file, and gives it its name. Any thread, also while a render runs.
 * Destroys the writer. Errors: IO; the earlier file is as it was. */
VL_API vlResult vl_film_write_end(vlFilmWriter *writer, vlError *error);

/** A film file that is being read. One thread at a time. Its context must outlive it. */
typedef struct vlFilmFile vlFilmFile;
/** A part of a film: the samples of a rectangle of pixels. */
typedef struct vlFilmBlock {
  uint32_t x0, y0, x1, y1;     /**< pixels of the whole image, exclusive */
  uint32_t range_count;        /**< 0: without samples */
  const vlSampleRange *ranges; /**< its samples, ascending, apart; lives until the next block is read */
} vlFilmBlock;
/** Opens a film file and checks its header. Errors: ARGUMENT, MISSING, IO, MEMORY; SCENE: it is not a film file, or
 * damaged; UNSUPPORTED: of a later format version. */
VL_API vlResult vl_film_file_open(vlContext *context, const char *path, vlFilmFile **file, vlError *error);
/** Null is allowed. */
VL_API void vl_film_file_close(vlFilmFile *file);
/** Its film; crop: of the whole render. Lives as long as the file, as all that these functions return. */
VL_API const vlFilmDef *vl_film_file_def(const vlFilmFile *file);
/** The length of the sequence that its samples are from (vlRenderDef.sequence). */
VL_API uint32_t vl_film_file_sequence(const vlFilmFile *file);
/** The receipt of its render; null: it has none. */
VL_API const vlReceipt *vl_film_file_receipt(const vlFilmFile *file);
/** Reads the next block's place and samples, and checks all of it with `check`. Returns VL_OK with *block of width 0
 * after the last one. Errors: SCENE: damaged; IO, MEMORY. */
VL_API vlResult vl_film_file_next(vlFilmFile *file, bool check, vlFilmBlock *block, vlError *error);

/** Reads a film. Its crop is the rectangle of the pixels with samples. All of them must have the same samples, one
 * range, so that vl_render can continue it; with `partial` any samples will do, for vl_film_develop, vl_film_errors and
 * vl_film_spectrum alone. Errors: ARGUMENT, MISSING, IO, MEMORY, UNSUPPORTED; SCENE: not a film file, damaged, without
 * samples, or (not partial) with different samples. */
VL_API vlResult vl_film_read(vlContext *context, const char *path, bool partial, vlFilm **film, vlError *error);

/** Merges film files of one render that have different samples (or pixels) into one, with the bytes that a single
 * render of all of them would have written. The order and the grouping do not matter. Samples that a file shares with
 * another one count once, if one of the two has all the samples of the other in that block. `output` may be one of the
 * paths. Memory: that of a few blocks, for any number of files. Errors: SCENE: damaged, of different renders (the
 * message names the difference), or samples that overlap; ARGUMENT, MISSING, IO, MEMORY, UNSUPPORTED. */
VL_API vlResult vl_film_merge(vlContext *context, const char *const *paths, uint32_t count, const char *output,
                              vlError *error);

#ifdef __cplusplus
}
#endif
#endif
