/* base/file_lock.h: a lock on the name of a file that is replaced by renaming others. It lies
 * beside the file, in a hidden file of its own: ".velo-" and 16 digits, which follow from the
 * name, and ".lock". */
#ifndef BASE_FILE_LOCK_H
#define BASE_FILE_LOCK_H

#include "base/context.h"

typedef struct vlFileLock {
  int descriptor;                  /* of the lock's file; -1: not held */
  struct vlUnfinished *unfinished; /* the lock's file while it is held */
  char path[4096 + 64];            /* of the lock's file */
} vlFileLock;

typedef enum vlLockState {
  VL_LOCK_HELD,
  VL_LOCK_BUSY, /* another process or another vlFileLock of this process has it */
  VL_LOCK_NONE  /* the file system has no locks */
} vlLockState;

/* Takes the lock of the file `path`, whose symbolic links are followed and which need not
 * exist. Waits half a second at most. The system releases the lock when the process ends in
 * whatever way; vl_file_unlock and vl_remove_unfinished also remove the lock's file. One that a
 * killed process leaves is empty, locks nothing, and is removed by vl_remove_leftovers. The
 * lock is an open file description lock (fcntl): NFS servers know it, and closing other
 * descriptors does not release it. Errors: IO, MEMORY. */
vlResult vl_file_lock(vlFileLock *lock, vlContext *context, const char *path,
                      vlLockState *state, vlError *error);
/* Does nothing if the lock is not held. */
void vl_file_unlock(vlFileLock *lock);
/* Removes a lock's file and the file of vl_lock_sibling if no process holds the lock. folder: a
 * descriptor. */
void vl_file_lock_sweep(int folder, const char *name);
/* Whether a file's name without its folder is that of a lock. */
bool vl_is_lock_name(const char *name);
/* The name of a temporary file that only the owner of the lock uses; size: at least that of
 * lock->path. */
void vl_lock_sibling(const vlFileLock *lock, char *path, size_t size);

#endif
