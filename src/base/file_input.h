/* base/file_input.h: the files that a context has read, so that no output replaces one of them. They are kept if
 * vlContextDef.keep_inputs is set. */
#ifndef BASE_FILE_INPUT_H
#define BASE_FILE_INPUT_H

#include <sys/stat.h>

#include "base/array.h"
#include "base/context.h"
#include "base/file_stamp.h"

typedef struct vlFileInput {
  char *path; /* as it was opened */
  vlFileStamp stamp;
  bool other; /* it was read as another file than a film */
} vlFileInput;

/* Laid out as VL_ARRAY, by device and inode. */
typedef struct vlFileInputs {
  pthread_mutex_t mutex;
  VL_ARRAY(vlFileInput) list;
} vlFileInputs;

/* Remembers a file that is being read; info: of its open descriptor. Any thread. False: out of memory. */
bool vl_file_input(vlContext *context, const char *path, const struct stat *info, vlOutputKind kind);
/* Whether the file at `path` is one that the context has read and that an output of this kind would destroy. *name: the
 * path with which it was read. */
bool vl_file_is_input(vlContext *context, const char *path, vlOutputKind kind, char *name, size_t size);
void vl_file_inputs_free(vlContext *context, vlFileInputs *inputs);

#endif
