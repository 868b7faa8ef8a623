/* render/film_keeper.h: the film of a render in its file: read where it is continued, written while rendering and at
 * the end. */
#ifndef APP_RENDER_FILM_KEEPER_H
#define APP_RENDER_FILM_KEEPER_H

#include <pthread.h>

#include "render/receipt.h"

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

/* path: null: the film is not kept. Takes the receipt. */
void film_keeper_start(FilmKeeper *keeper, const char *path, const Arguments *arguments, const vlFilmDef *whole,
                       vlReceipt *receipt);
/* After a pass: writes a checkpoint when it is due. A failure is a warning. */
void film_keeper_checkpoint(FilmKeeper *keeper, const vlFilm *film);
/* Writes the film at the end. receipt: replaces that of the start; null: none. Returns the exit code. */
int film_keeper_finish(FilmKeeper *keeper, const vlFilm *film);
void film_keeper_free(FilmKeeper *keeper);

#endif
