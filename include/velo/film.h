/** @file
 * velo/film.h: films in files: a render can be stopped and continued later, also on another
 * machine, or split over machines and merged. The sums of a film are exact
 * (docs/decisions/0002-exact-film-sums.md), so that the same samples give the same bytes in any
 * order and grouping. docs/film-files.md describes the format. */
#ifndef VELO_FILM_H
#define VELO_FILM_H

#include "velo/own.h"
#include "velo/receipt.h"
#include "velo/render.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The samples first to end - 1 of a pixel. */
typedef struct vlSampleRange {
  uint32_t first, end; /**< index of the first sample; index behind the last */
} vlSampleRange;

/** A lock on a film file: nobody else writes it. Its context must outlive it. */
typedef struct vlFilmLock vlFilmLock;
/** Locks the file `path`, which need not exist, against other processes and other locks of this
 * one. All functions that write films respect it. *lock is null and the result VL_OK where
 * another has the lock (after half a second). The lock ends with the process, however that
 * ends; it works over NFS. Where the file system has no locks, a warning is logged and *lock
 * locks nothing; so does that of a device or pipe. Errors: ARGUMENT, MEMORY, IO. */
VL_API vlResult vl_film_lock(vlContext *context, const char *path, vlFilmLock **lock,
                             vlError *error);
/** Releases a lock. Null is allowed. */
VL_API void vl_film_unlock(vlFilmLock *lock);
/** For a signal handler that ends the process: removes the lock files of films and the
 * temporary files of all writers that this context has made and not removed yet.
 * Async-signal-safe. The process must end afterwards without another call that uses the
 * context; threads that are writing files wait for its end. Null is allowed. */
VL_API void vl_remove_unfinished(vlContext *context);

/** How to write a film. */
typedef struct vlFilmWriteDef {
  uint32_t cookie;
  /** The text of the receipt of the whole render (vl_receipt_text), read during the call only.
   * It is stored in the header, which is JSON; vl_film_merge compares it. Null (default):
   * none. */
  const char *receipt;
  /** The pixels of the whole render: x0, y0, x1, y1; x1, y1 exclusive. It must contain the
   * film's crop, whose sides are sides of the window or at multiples of 32 pixels. The other
   * pixels have no samples in this file. All 0 (default): the film's crop. */
  uint32_t window[4];
  /** An image whose attributes are kept in the header for vl_film_file_attributes, read during
   * the call only. Null (default): none. Films of one render have the same. */
  const vlImage *attributes;
  /** The lock of this path, if the caller has it: it stays. Null (default): the file is locked
   * while it is written. */
  vlFilmLock *lock;
} vlFilmWriteDef;
/** The default def. */
VL_API vlFilmWriteDef vl_default_film_write_def(void);
/** Writes a film file whole or not at all: writes a temporary file in the same folder, syncs
 * it, renames it and syncs the folder. An earlier file of that name stays until then. Must not
 * be called while a render runs, except from its callback after a pass. def may be null.
 * Errors: ARGUMENT (also a film without samples), MEMORY; IO: also where another has the lock.
 */
VL_API vlResult vl_film_write(const vlFilm *film, const vlFilmWriteDef *def, const char *path,
                              vlError *error);

/** A film file that is being written. The film's context must outlive it. */
typedef struct vlFilmWriter vlFilmWriter;
/** The first part of vl_film_write: writes the temporary file, on the workers of the film's
 * context. When it returns, the film may change again. Errors: as vl_film_write; *writer is
 * null then. */
VL_API vlResult vl_film_write_begin(const vlFilm *film, const vlFilmWriteDef *def,
                                    const char *path, vlFilmWriter **writer, vlError *error);
/** The second part: waits until the file is on the disk, then renames it. May be called on any
 * thread, also while a render runs. Destroys the writer, also after an error. Errors: ARGUMENT;
 * IO: the earlier file is unchanged. */
VL_API vlResult vl_film_write_end(vlFilmWriter *writer, vlError *error);

/** A film file that is being read. Only one thread at a time may use it. Its context must
 * outlive it. */
typedef struct vlFilmFile vlFilmFile;
/** A part of a film: at most 32 x 32 pixels and the samples that they have. */
typedef struct vlFilmBlock {
  uint32_t x0, y0, x1, y1;     /**< its pixels in the whole image; x1, y1 exclusive */
  uint32_t range_count;        /**< 0: without samples */
  const vlSampleRange *ranges; /**< its samples, ascending, with gaps between the ranges; valid
                                  until the next read */
} vlFilmBlock;
/** Opens a film file and checks its header. Errors: ARGUMENT, MISSING, IO, MEMORY; SCENE: it is
 * not a film file, or it is damaged; UNSUPPORTED: it has a later format version. */
VL_API vlResult vl_film_file_open(vlContext *context, const char *path, vlFilmFile **file,
                                  vlError *error);
/** Closes a film file. Null is allowed. */
VL_API void vl_film_file_close(vlFilmFile *file);
/** The def of its film; crop is that of the whole render. Valid until the file is closed, as
 * all results of these functions except a block's ranges. */
VL_API const vlFilmDef *vl_film_file_def(const vlFilmFile *file);
/** The length of the sample sequence that its samples were taken from (vlRenderDef.sequence).
 */
VL_API uint32_t vl_film_file_sequence(const vlFilmFile *file);
/** The receipt of its render; null: it has none. */
VL_API const vlReceipt *vl_film_file_receipt(const vlFilmFile *file);
/** Sets the attributes that the film keeps (vlFilmWriteDef.attributes) on an image, in their
 * order. Errors: ARGUMENT, MEMORY; SCENE: one of them is wrong. */
VL_API vlResult vl_film_file_attributes(const vlFilmFile *file, vlImage *image, vlError *error);
/** Reads the position and the sample ranges of the next block. With `check` it also reads the
 * sums and checks their CRC and their range. After the last block it returns VL_OK and *block
 * has x0 = x1. Errors: SCENE: the file is damaged; IO, MEMORY. */
VL_API vlResult vl_film_file_next(vlFilmFile *file, bool check, vlFilmBlock *block,
                                  vlError *error);

/** Reads a film, owned by the caller. Its crop is the bounding rectangle of the pixels with
 * samples. Without `partial`, each pixel of the crop must have one range of samples, all with
 * the same first sample, so that vl_render can continue the film. With `partial` they may
 * differ; such a film is only for vl_film_develop, vl_film_errors and vl_film_spectrum. Errors:
 * ARGUMENT, MISSING, IO, MEMORY, UNSUPPORTED; SCENE: the file is not a film file, is damaged,
 * has no samples, or (without `partial`) has pixels without samples or with other first
 * samples. */
VL_API vlResult vl_film_read(vlContext *context, const char *path, bool partial, vlFilm **film,
                             vlError *error);

/** The name of the code of one's own (velo/own.h) of this kind that made the film's samples;
 * null: none. Film files keep it. vl_render refuses to add samples made by code of another
 * name, and vl_film_merge to join them. The string lives until the film changes. */
VL_API const char *vl_film_own(const vlFilm *film, vlOwnKind kind);

/** How to merge films. */
typedef struct vlFilmMergeDef {
  uint32_t cookie;
  /** Replaces an earlier film whatever it holds. False (default): only a film of the same
   * render all of whose samples the result has. Other files are never replaced. If the earlier
   * file stays, the result is SCENE. */
  bool overwrite;
} vlFilmMergeDef;
/** The default def. */
VL_API vlFilmMergeDef vl_default_film_merge_def(void);
/** Merges `count` film files of one render that have different samples or pixels. The result
 * has the bytes that a single render of all these samples would have written. The order and the
 * grouping of merges do not matter. If two files share samples of a block, one of them must
 * have all the samples of the other there; shared samples count once. `output` may be one of
 * the paths; it is locked from the first read to the last write. It needs the memory of a few
 * blocks, for any number of files. def may be null. Errors: SCENE: a file is damaged, the files
 * are of different renders (the message names the difference), samples overlap partly, or the
 * earlier output would be lost; ARGUMENT, MISSING, MEMORY, UNSUPPORTED; IO: also where another
 * has the lock of the output. */
VL_API vlResult vl_film_merge(vlContext *context, const char *const *paths, uint32_t count,
                              const vlFilmMergeDef *def, const char *output, vlError *error);

#ifdef __cplusplus
}
#endif
#endif
