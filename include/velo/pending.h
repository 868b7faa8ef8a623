/** @file
 * velo/pending.h: a file that another program writes, whole or not at all: it writes a
 * temporary file, which then replaces the target. */
#ifndef VELO_PENDING_H
#define VELO_PENDING_H

#include "velo/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A file that is not complete yet. Its context must outlive it. */
typedef struct vlPendingFile vlPendingFile;
/** Makes an empty temporary file in the folder of `path`, as vl_write_file does (a symbolic
 * link is followed). It is locked, so that vl_remove_leftovers keeps it while this process
 * lives. Errors: IO (also a path that is a pipe or device), ARGUMENT
 * (vlContextDef.keep_inputs), MEMORY. */
VL_API vlResult vl_pending_file_create(vlContext *context, const char *path,
                                       vlPendingFile **pending, vlError *error);
/** The path of the temporary file, which exists and must not be replaced by another. Valid
 * until the file is committed or destroyed. */
VL_API const char *vl_pending_file_path(const vlPendingFile *pending);
/** Syncs the temporary file and renames it to the target, which keeps its permissions. It is
 * removed on failure. Once per file. Errors: IO, MEMORY. */
VL_API vlResult vl_pending_file_commit(vlPendingFile *pending, vlError *error);
/** Frees a pending file. The temporary file is removed unless it was committed. Null is
 * allowed. */
VL_API void vl_pending_file_destroy(vlPendingFile *pending);

#ifdef __cplusplus
}
#endif

#endif
