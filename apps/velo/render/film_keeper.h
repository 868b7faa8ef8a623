/* render/film_keeper.h: reads the film file of a continued render, and writes the film during
 * the render and at its end. */
#ifndef APP_RENDER_FILM_KEEPER_H
#define APP_RENDER_FILM_KEEPER_H

#include <pthread.h>

#include "render/channels.h"
#include "render/film_claim.h"
#include "render/outputs.h"
#include "render/receipt.h"

/* Settings shared by all films of a command. */
typedef struct FilmPlan {
  const char *path; /* path of the film file, with two eyes a pattern (pattern.h); null: no film
                       files */
  const char *from; /* path of the film to continue; null: none */
  bool overwrite;   /* the film that is there is not continued */
  FilmClaim claims[2]; /* of the film files: of the camera or the left eye, of the right eye */
  vlSceneDefs whole;   /* defs of the whole render, if the command renders a part of it */
  const ReceiptPlan *receipt;
  const Outputs *outputs;
  const Channels *channels;
} FilmPlan;

typedef struct FilmKeeper {
  char path[4096];    /* path of the film file; empty: none */
  vlFilmLock *lock;   /* of the claim */
  bool stream;        /* not a regular file: it is written once, at the end */
  double every;       /* seconds between two checkpoints */
  double share;       /* largest fraction of the time for checkpoints; 0: no limit */
  uint32_t window[4]; /* crop window of the whole render */
  vlReceipt *receipt;
  vlImage *attributes; /* those of the render's own image; its pixels are not used */
  double last, cost;   /* time of the last checkpoint; seconds it took */
  uint32_t written;    /* samples in the file */
  pthread_t thread;    /* the thread that syncs and renames the file */
  bool running, failing;
  vlFilmWriter *writer;
  vlResult result;
  vlError error;
} FilmKeeper;

/* view: of the plan's claims; if it has no path, no film is written. eye: the eye that the film
 * belongs to, or null for the camera. Returns -1 or the exit code. */
int film_keeper_start(FilmKeeper *keeper, const FilmPlan *plan, int view, const Job *job,
                      const char *eye);
/* Makes the receipt again for another range of samples. Returns -1 or the exit code. */
int film_keeper_describe(FilmKeeper *keeper, const FilmPlan *plan, const Job *job,
                         const char *eye);
/* Called after a pass. Writes a checkpoint when it is due. A failure is reported as a
 * warning. */
void film_keeper_checkpoint(FilmKeeper *keeper, const vlFilm *film);
/* Returns the estimated seconds for writing a film of `bytes` bytes at the end, from the
 * duration of the last checkpoint. */
double film_keeper_seconds(const FilmKeeper *keeper, uint64_t bytes);
/* Writes the film at the end. Returns the exit code. */
int film_keeper_finish(FilmKeeper *keeper, const vlFilm *film);
void film_keeper_free(FilmKeeper *keeper);

#endif
