/* base/file_record.c: see file_record.h. */
#include "base/file_record.h"

#include <string.h>

#include "base/array.h"
#include "base/digest.h"

/* Returns the index of the path, or the index at which it would be inserted. */
static size_t find(const vlFileRecords *records, const char *path, bool *found) {
  size_t low = 0, high = records->files.count;
  *found = false;
  while (low < high && !*found) {
    size_t middle = low + (high - low) / 2;
    int order = strcmp(path, records->files.items[middle].path);
    if (order == 0) {
      low = middle;
      *found = true;
    }
    if (order < 0)
      high = middle;
    if (order > 0)
      low = middle + 1;
  }
  return low;
}

static bool insert(vlContext *context, vlFileRecords *records, const vlFileRecord *record) {
  bool found;
  size_t at = find(records, record->path, &found);
  if (found) {
    records->files.items[at].size = record->size;
    memcpy(records->files.items[at].digest, record->digest, sizeof record->digest);
    return true;
  }
  char *path = vl_strdup(context, record->path);
  vlFileRecord *slot = path ? VL_INSERT(context, &records->files, at) : NULL;
  if (!slot) {
    vl_free(context, path);
    return false;
  }
  *slot = *record;
  slot->path = path;
  return true;
}

bool vl_file_record(vlContext *context, const char *path, const void *data, size_t size) {
  vlFileRecords *records = vl_context_file_records(context);
  pthread_mutex_lock(&records->mutex);
  bool on = records->on;
  pthread_mutex_unlock(&records->mutex);
  if (!on)
    return true;
  vlFileRecord record = {.path = path, .size = size};
  vl_digest(data, size, record.digest);
  pthread_mutex_lock(&records->mutex);
  bool good = insert(context, records, &record);
  pthread_mutex_unlock(&records->mutex);
  return good;
}

void vl_context_record_files(vlContext *context, bool on) {
  vlFileRecords *records = vl_context_file_records(context);
  pthread_mutex_lock(&records->mutex);
  records->on = on;
  pthread_mutex_unlock(&records->mutex);
}

const vlFileRecord *vl_context_file(vlContext *context, uint32_t index) {
  vlFileRecords *records = vl_context_file_records(context);
  return index < records->files.count ? &records->files.items[index] : NULL;
}
