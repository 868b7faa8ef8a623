/* base/file_pending.c: files that other programs write (velo/pending.h). */
#include "base/error.h"
#include "base/file.h"
#include "velo/pending.h"

struct vlPendingFile {
  vlFileWriter writer;
  bool open; /* the writer was neither committed nor abandoned */
};

vlResult vl_pending_file_create(vlContext *context, const char *path, vlPendingFile **pending,
                                vlError *error) {
  vl_error_clear(error);
  if (pending)
    *pending = NULL;
  if (!context || !path || !pending)
    return vl_fail_argument(error, "pending file: an argument is null");
  vlPendingFile *p = vl_alloc(context, sizeof *p);
  if (!p)
    return vl_fail_memory(error);
  vlResult result = vl_file_open_named(&p->writer, context, path, error);
  p->open = result == VL_OK;
  if (result == VL_OK)
    *pending = p;
  else
    vl_free(context, p);
  return result;
}

const char *vl_pending_file_path(const vlPendingFile *pending) {
  return pending->writer.temporary;
}

vlResult vl_pending_file_commit(vlPendingFile *pending, vlError *error) {
  vl_error_clear(error);
  if (!pending || !pending->open)
    return vl_fail_argument(error, "pending file: it is not open");
  pending->open = false;
  return vl_file_commit(&pending->writer, error);
}

void vl_pending_file_destroy(vlPendingFile *pending) {
  if (!pending)
    return;
  if (pending->open)
    vl_file_abandon(&pending->writer);
  vl_free(pending->writer.context, pending);
}
