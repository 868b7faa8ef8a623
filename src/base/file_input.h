/* base/file_input.h: the files that a context has read, so that no output replaces one of them.
 * They are kept if vlContextDef.keep_inputs is set. */
#ifndef BASE_FILE_INPUT_H
#define BASE_FILE_INPUT_H

#include <sys/stat.h>

#include "base/context.h"

/* Remembers a file that is being read; info: of its open descriptor. Any thread. False: out of
 * memory. */
bool vl_file_input(vlContext *context, const char *path, const struct stat *info,
                   vlOutputKind kind);
/* Whether the file at `path` is one that the context has read and that an output of this kind
 * would destroy. *name: the path with which it was read. */
bool vl_file_is_input(vlContext *context, const char *path, vlOutputKind kind, char *name,
                      size_t size);

#endif
