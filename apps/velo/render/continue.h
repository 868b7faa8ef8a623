/* render/continue.h: `velo render --continue FILE.film`: the command in the film's receipt goes on, if everything that
 * determines its samples is as it was. */
#ifndef APP_RENDER_CONTINUE_H
#define APP_RENDER_CONTINUE_H

#include "render/receipt.h"

typedef struct Continue {
  const char *path; /* of the film; null: a render from the beginning */
  vlContext *context;
  vlFilmFile *file;
  Arguments arguments; /* of the command, with what is given beside it; texts live in the receipt */
} Continue;

/* Reads the film's receipt and replaces *arguments by those of its command. Of a film for each eye (%v in the name) it
 * reads the left one's. Returns -1 or the exit code. */
int continue_open(Continue *c, const Arguments **arguments);
/* Reads the film in `path`, if its receipt is `now` and it has the samples before those that are to be rendered; its
 * pixels, where it has not all, become the crop of defs. Returns -1, or the exit code after naming the differences. */
int continue_film(const char *path, const Arguments *arguments, const vlReceipt *now, vlContext *context,
                  vlSceneDefs *defs, vlFilm **film);
void continue_close(Continue *c);

#endif
