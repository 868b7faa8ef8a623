/* render/continue.h: `velo render --continue FILE.film`: continues the command in the film's
 * receipt, if everything that determines its samples is unchanged. */
#ifndef APP_RENDER_CONTINUE_H
#define APP_RENDER_CONTINUE_H

#include "render/film_claim.h"
#include "render/receipt.h"
#include "velo/film.h"

typedef struct Continue {
  const char *path; /* path of the film; null: a render from the beginning */
  vlContext *context;
  vlFilmFile *file;
  Arguments arguments; /* the command's arguments and those given beside --continue; the receipt
                          owns their texts */
} Continue;

/* Reads the film's receipt and replaces *arguments by those of its command. If each eye has a
 * film (%v in the name), it reads the receipt of the left film. Returns -1 or the exit code. */
int continue_open(Continue *c, const Arguments **arguments);
/* Reads the film that the claim's file has already, or that of --continue; *film stays if there
 * is none. Its receipt must equal `now`, and it must have the samples before those that will be
 * rendered. If it has only some of the pixels, they become the crop of defs. film null: only
 * checks. Returns -1, or the exit code after naming the differences. */
int continue_film(const FilmClaim *claim, const Arguments *arguments, const vlReceipt *now,
                  vlContext *context, vlSceneDefs *defs, vlFilm **film);
void continue_close(Continue *c);

#endif
