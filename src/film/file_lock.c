/* film/file_lock.c: locks on film files: one process at a time writes a film. */

#include "base/error.h"
#include "base/file_stream.h"
#include "film/file.h"
#include "velo/film.h"

vlResult vl_film_lock(vlContext *context, const char *path, vlFilmLock **lock, vlError *error) {
  vl_error_clear(error);
  if (lock)
    *lock = NULL;
  if (!context || !path || !lock)
    return vl_fail_argument(error, "film lock: context, path or lock is null");
  vlFilmLock *made = vl_alloc_zero(context, 1, sizeof *made);
  if (!made)
    return vl_fail_memory(error);
  made->context = context;
  made->file.descriptor = -1;
  vlLockState state = VL_LOCK_NONE;
  vlResult result = VL_OK;
  bool is_device = vl_path_is_stream(path); /* there is nothing to keep */
  if (!is_device)
    result = vl_file_lock(&made->file, context, path, &state, error);
  if (result == VL_OK && state == VL_LOCK_NONE && !is_device)
    vl_log(context, VL_LOG_WARNING, NULL,
           "%s: this file system has no locks; two processes that write it would not notice",
           path);
  if (result == VL_OK && state != VL_LOCK_BUSY) {
    *lock = made;
    return VL_OK;
  }
  vl_free(context, made);
  return result;
}

void vl_film_unlock(vlFilmLock *lock) {
  if (!lock)
    return;
  vl_file_unlock(&lock->file);
  vl_free(lock->context, lock);
}

vlResult vl_film_lock_write(vlContext *context, const char *path, vlFilmLock **lock,
                            vlError *error) {
  vlResult result = vl_film_lock(context, path, lock, error);
  if (result != VL_OK || *lock)
    return result;
  return vl_fail(error, VL_ERROR_IO, "cannot write %s: another process is writing it", path);
}
