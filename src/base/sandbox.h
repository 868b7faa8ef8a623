/* base/sandbox.h: the folders in which the files of a scene must lie (vlContextDef.sandbox). */
#ifndef BASE_SANDBOX_H
#define BASE_SANDBOX_H

#include <pthread.h>

#include "velo/base.h"

typedef struct vlSandbox {
  vlAllocator allocator;
  char **folders; /* with symbolic links resolved */
  uint32_t count; /* 0: every file is allowed */
  pthread_mutex_t mutex;
  char **passed; /* folders of the files that the caller gave: names may begin there and lead
                    into the sandbox */
  size_t passed_count;
} vlSandbox;

/* Errors: MEMORY, MISSING (a folder). To be freed also after an error. */
vlResult vl_sandbox_make(vlSandbox *sandbox, const vlAllocator *allocator,
                         const char *const *folders, uint32_t count);
void vl_sandbox_free(vlSandbox *sandbox);
/* Whether a path leads into the sandbox, whether there is a file or not. The path may pass
 * through the folders above those of the sandbox, the current folder and folders of given
 * files, and through no other folder outside: the answer does not depend on what there is
 * outside. */
bool vl_sandbox_allows(vlSandbox *sandbox, const char *path);
/* Remembers the folder of a file that the caller gave. Any thread. Without memory its folder is
 * not passed. */
void vl_sandbox_pass(vlSandbox *sandbox, const char *path);

vlSandbox *vl_context_sandbox(vlContext *context); /* defined by context.c */

#endif
