/* render/outputs.h: the files of one render: checked before the work begins, written whole, several at once. */
#ifndef APP_RENDER_OUTPUTS_H
#define APP_RENDER_OUTPUTS_H

#include "velo/velo.h"

enum { MAX_OUTPUTS = 32 };

typedef struct Outputs {
  const char *paths[MAX_OUTPUTS];
  int count;
  bool half;
  bool patterns;            /* the names are patterns (pattern.h): folders with a % are made later */
  vlView view;              /* of 8-bit files */
  float exposure;           /* EV, of 8-bit files */
  bool meter;               /* by the picture itself, in place of exposure */
  const vlImage *layers[4]; /* what .exr files hold beside the picture; null: nothing */
} Outputs;

/* The file can hold more than a picture's colours. */
bool output_holds_layers(const char *path);
/* The suffix is one that velo writes; *eight_bit tells whether that format holds display values. */
bool output_suffix(const char *path, bool *eight_bit);
/* Both: -1 when all is well, else the exit code, all has been said. The first needs no file system. */
int outputs_check_names(const Outputs *outputs);
int outputs_check_folders(const Outputs *outputs);
/* Writes the picture into every file, even after one of them failed. `progress`: only into plain files, and a failure
 * is a warning. Returns STATUS_OK or the code of the first failure. */
int outputs_write(vlContext *context, const Outputs *outputs, const vlImage *image, bool progress);

#endif
