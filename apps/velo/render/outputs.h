/* render/outputs.h: the files of one render: checked before the work begins, written whole, several at once. While it
 * renders, and when it is stopped, the image of NAME.EXT is in NAME.part.EXT; only a finished render replaces NAME.EXT.
 */
#ifndef APP_RENDER_OUTPUTS_H
#define APP_RENDER_OUTPUTS_H

#include "velo/velo.h"

enum { MAX_OUTPUTS = 32 };

/* How far the image is that is written. */
typedef enum OutputStage {
  OUTPUT_PROGRESS, /* into NAME.part.EXT, not into pipes and devices; a failure is a warning */
  OUTPUT_STOPPED,  /* into NAME.part.EXT, as the last one */
  OUTPUT_FINISHED  /* into NAME.EXT; NAME.part.EXT goes */
} OutputStage;

typedef struct Outputs {
  const char *paths[MAX_OUTPUTS];
  int count;
  bool half;
  bool patterns;            /* the names are patterns (pattern.h): folders with a % are made later */
  vlView view;              /* of 8-bit files */
  float exposure;           /* EV, of 8-bit files */
  bool meter;               /* by the image itself, in place of exposure */
  const vlImage *layers[4]; /* what .exr files hold beside the image; null: nothing */
  struct {
    uint32_t part_spp; /* NAME.part.EXT was written with so many samples; 0: it was not */
    bool failing;      /* the last progress write failed, and this was reported */
  } files[MAX_OUTPUTS];
} Outputs;

/* The file can hold more than an image's colours. */
bool output_holds_layers(const char *path);
/* The suffix is one that velo writes; *eight_bit tells whether that format holds display values. */
bool output_suffix(const char *path, bool *eight_bit);
/* The most pixels each way that the format of this name holds. */
uint32_t output_largest_side(const char *path);
/* Both: -1 when all is well, else the exit code, all has been said. The first needs no file system. */
int outputs_check_names(const Outputs *outputs);
int outputs_check_folders(const Outputs *outputs);
/* NAME.part.EXT beside the file that `path` stands for; a name that would be too long for a folder is cut. false: too
 * long all the same, or a device or pipe, which has none. */
bool output_part_path(const char *path, char *part, size_t size);
/* Once NAME.EXT is whole: NAME.part.EXT goes, also an earlier render's. */
void output_remove_part(const char *path);
/* PATH.ids.json, cut likewise. */
bool output_ids_path(const char *path, char *ids, size_t size);
/* Writes the image of `spp` samples into every file, even after one of them failed. Returns STATUS_OK or the code of
 * the first failure. */
int outputs_write(vlContext *context, Outputs *outputs, const vlImage *image, uint32_t spp, OutputStage stage);
/* Where output i was written at that stage: its path, or its NAME.part.EXT (in `part`). */
const char *output_written(const Outputs *outputs, int i, OutputStage stage, char *part, size_t size);

#endif
