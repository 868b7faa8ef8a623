/* render/film_claim.h: a film file that a command writes. It is locked until the command ends,
 * so that no other process writes it. A film that is there already is continued if it is of the
 * same render, else refused (continue.h). */
#ifndef APP_RENDER_FILM_CLAIM_H
#define APP_RENDER_FILM_CLAIM_H

#include "cli/macros.h"
#include "cli/options.h"
#include "velo/film.h"

typedef struct FilmClaim {
  char path[4096]; /* of the film file; empty: none */
  char from[4096]; /* of the film of --continue; empty: none */
  vlFilmLock *lock;
  /* the film in `path`, unless it is `from`, or is overwritten; null: none */
  vlFilmFile *earlier;
} FilmClaim;

/* Locks the file and opens the film that is there. from: of --continue; "": none. Returns -1,
 * or the exit code after reporting that another process writes it, or that it is not a film. */
int film_claim(FilmClaim *claim, vlContext *context, const char *path, const char *from,
               bool overwrite);
void film_claim_release(FilmClaim *claim);
/* Says why the film that is there stays: "WHY; --overwrite replaces it". Returns the exit
 * code. */
int film_claim_refuse(const char *format, ...) PRINTF(1, 2);
/* Checks --overwrite. Returns -1 or the exit code. */
int film_claim_check(bool overwrite, const char *film, const char *from);
/* Settings of the earlier film that the command leaves open: sums of errors, which it may have
 * for outputs of another command. */
void film_claim_take(const FilmClaim *claim, vlFilmDef *film);
/* Takes the tracer and the number of light paths, which a race would choose, from the earlier
 * film. Returns whether its command names them. */
bool film_claim_take_tracer(const FilmClaim *claim, vlRenderDef *render);

#endif
