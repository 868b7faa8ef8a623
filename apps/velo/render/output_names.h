/* render/output_names.h: the names of all files that a command will write, checked together
 * before it begins: none is a file that was read, and no two are the same file. */
#ifndef APP_RENDER_OUTPUT_NAMES_H
#define APP_RENDER_OUTPUT_NAMES_H

#include "render/outputs.h"
#include "velo/base.h"

typedef struct OutputName {
  char *path;
  vlOutputKind kind;
  vlFileId id;
} OutputName;

typedef struct OutputNames {
  OutputName *items;
  size_t count, capacity;
  bool failed; /* out of memory */
  bool frames; /* what cannot be written is reported then: it must not stop the other frames */
} OutputNames;

void output_names_add(OutputNames *names, const char *path, vlOutputKind kind);
/* Adds an image; part: also NAME.part.EXT; ids: also the files that describe its ids. */
void output_names_add_image(OutputNames *names, const char *path, bool part, bool ids);
/* Checks all names against each other and against what the context has read, then frees them.
 * Returns -1, or the exit code after reporting the error. */
int output_names_check(OutputNames *names, vlContext *context);
/* The same for the images of a command without progress images. */
int outputs_check_inputs(vlContext *context, const Outputs *outputs);

#endif
