/* view/engine_copied.h: a command that a page has copied, with the image that it shall make. */
#ifndef APP_VIEW_ENGINE_COPIED_H
#define APP_VIEW_ENGINE_COPIED_H

#include "view/engine_parts.h"

typedef struct Copied {
  /* of the command, each with its zero; the last two are -o and the image's name */
  char *words;
  size_t size;    /* bytes of all words */
  vlImage *image; /* as it was saved then, with its header */
  vlView view;
  double exposure; /* EV, for 8-bit files */
  uint32_t spp;
  char file[300]; /* the image's name */
} Copied;

/* Null is allowed. */
void copied_free(Copied *copied);

#endif
