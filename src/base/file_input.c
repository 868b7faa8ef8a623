/* base/file_input.c: see file_input.h. A file is known by its device and inode, so that links
 * and other spellings of its name do not matter. */
#include "base/file_input.h"

#include <stdio.h>

#include "base/array.h"
#include "base/text.h"

static int compare(const vlFileStamp *a, const vlFileStamp *b) {
  if (a->device != b->device)
    return a->device < b->device ? -1 : 1;
  return a->inode == b->inode ? 0 : a->inode < b->inode ? -1 : 1;
}

/* The index of the file, or the index at which it would be inserted. */
static size_t find(const vlFileInputs *inputs, const vlFileStamp *stamp) {
  size_t low = 0, high = inputs->list.count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (compare(&inputs->list.items[middle].stamp, stamp) < 0)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

static bool is_at(const vlFileInputs *inputs, size_t at, const vlFileStamp *stamp) {
  return at < inputs->list.count && compare(&inputs->list.items[at].stamp, stamp) == 0;
}

static bool insert(vlContext *context, vlFileInputs *inputs, const char *path,
                   const vlFileStamp *stamp, bool other) {
  size_t at = find(inputs, stamp);
  if (is_at(inputs, at, stamp)) {
    vlFileInput *known = &inputs->list.items[at];
    known->stamp = *stamp;
    known->other |= other;
    if (vl_text_is(known->path, path))
      return true;
    char *newer = vl_strdup(context, path); /* the earlier name may mean another file by now */
    if (!newer)
      return false;
    vl_free(context, known->path);
    known->path = newer;
    return true;
  }
  char *copy = vl_strdup(context, path);
  vlFileInput *slot = copy ? VL_INSERT(context, &inputs->list, at) : NULL;
  if (!slot) {
    vl_free(context, copy);
    return false;
  }
  *slot = (vlFileInput){copy, *stamp, other};
  return true;
}

bool vl_file_input(vlContext *context, const char *path, const struct stat *info,
                   vlOutputKind kind) {
  vlFileInputs *inputs = vl_context_file_inputs(context);
  if (!inputs || !S_ISREG(info->st_mode))
    return true;
  const vlFileStamp stamp = vl_file_stamp_of(info);
  pthread_mutex_lock(&inputs->mutex);
  bool good = insert(context, inputs, path, &stamp, kind != VL_OUTPUT_FILM);
  pthread_mutex_unlock(&inputs->mutex);
  return good;
}

bool vl_file_is_input(vlContext *context, const char *path, vlOutputKind kind, char *name,
                      size_t size) {
  vlFileInputs *inputs = context ? vl_context_file_inputs(context) : NULL;
  const vlFileStamp stamp = vl_file_stamp(path);
  bool found = false;
  if (!inputs || !stamp.there)
    return false;
  pthread_mutex_lock(&inputs->mutex);
  size_t at = find(inputs, &stamp);
  if (is_at(inputs, at, &stamp)) {
    const vlFileInput *known = &inputs->list.items[at];
    const vlFileStamp now = vl_file_stamp(known->path);
    /* A file system gives the inode of a removed file to a new one, which is not an input. */
    found = (known->other || kind != VL_OUTPUT_FILM) &&
            (vl_file_stamp_same(&known->stamp, &stamp) ||
             (now.there && compare(&now, &stamp) == 0));
    snprintf(name, size, "%s", known->path);
  }
  pthread_mutex_unlock(&inputs->mutex);
  return found;
}

vlResult vl_note_input(vlContext *context, const char *path, vlOutputKind kind) {
  struct stat info;
  if (!context || !path || (unsigned)kind > VL_OUTPUT_FILM)
    return VL_ERROR_ARGUMENT;
  if (stat(path, &info) != 0)
    return VL_ERROR_IO;
  return vl_file_input(context, path, &info, kind) ? VL_OK : VL_ERROR_MEMORY;
}
