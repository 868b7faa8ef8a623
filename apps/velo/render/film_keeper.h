/* render/film_keeper.h: the film of a render in its file: read where it is continued, written while rendering and at
 * the end. */
#ifndef APP_RENDER_FILM_KEEPER_H
#define APP_RENDER_FILM_KEEPER_H

#include <pthread.h>

#include "render/outputs.h"
#include "render/receipt.h"

/* What the films of a command have in common. */
typedef struct FilmPlan {
  const char *path;  /* of the file, a pattern (pattern.h) for two eyes; null: films are not kept */
  const char *from;  /* of the film that is continued; null: none */
  vlSceneDefs whole; /* of the whole render, where the command renders a part of it */
  const ReceiptPlan *receipt;
  const Outputs *outputs;
} FilmPlan;

typedef struct FilmKeeper {
  char path[4096];    /* of the file; empty: the film is not kept */
  double every;       /* seconds between two checkpoints */
  double share;       /* of the time that checkpoints may take; 0: any */
  uint32_t window[4]; /* of the whole render */
  vlReceipt *receipt;
  double last, cost; /* time of the last checkpoint; seconds it took */
  uint32_t written;  /* samples in the file */
  pthread_t thread;  /* syncs and renames */
  bool running, failing;
  vlFilmWriter *writer;
  vlResult result;
  vlError error;
} FilmKeeper;

/* path: of this film; null: it is not kept. eye: whose film it is; null: that of the camera. Returns -1 or the exit
 * code. */
int film_keeper_start(FilmKeeper *keeper, const FilmPlan *plan, const char *path, vlContext *context, const Job *job,
                      const char *eye);
/* Makes the receipt again, for other samples. Returns -1 or the exit code. */
int film_keeper_describe(FilmKeeper *keeper, const FilmPlan *plan, vlContext *context, const Job *job, const char *eye);
/* After a pass: writes a checkpoint when it is due. A failure is a warning. */
void film_keeper_checkpoint(FilmKeeper *keeper, const vlFilm *film);
/* Estimated seconds of writing a film of so many bytes at the end: those of the last checkpoint. */
double film_keeper_seconds(const FilmKeeper *keeper, uint64_t bytes);
/* Writes the film at the end. Returns the exit code. */
int film_keeper_finish(FilmKeeper *keeper, const vlFilm *film);
void film_keeper_free(FilmKeeper *keeper);

#endif
