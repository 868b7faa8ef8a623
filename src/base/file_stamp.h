/* base/file_stamp.h: what tells, without reading it, that a file is unchanged. */
#ifndef BASE_FILE_STAMP_H
#define BASE_FILE_STAMP_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/stat.h>

typedef struct vlFileStamp {
  bool there;                   /* false: no file; the other members are 0 */
  uint64_t device, inode, size; /* size: bytes */
  int64_t seconds, nanoseconds; /* time of the last modification */
} vlFileStamp;

static inline vlFileStamp vl_file_stamp_of(const struct stat *info) {
  return (vlFileStamp){true,
                       (uint64_t)info->st_dev,
                       (uint64_t)info->st_ino,
                       (uint64_t)info->st_size,
                       (int64_t)info->st_mtim.tv_sec,
                       (int64_t)info->st_mtim.tv_nsec};
}

/* The stamp of the file at `path`, which may be null. */
static inline vlFileStamp vl_file_stamp(const char *path) {
  struct stat info;
  if (!path || stat(path, &info) != 0)
    return (vlFileStamp){0};
  return vl_file_stamp_of(&info);
}

static inline bool vl_file_stamp_same(const vlFileStamp *a, const vlFileStamp *b) {
  return a->there == b->there && a->device == b->device && a->inode == b->inode &&
         a->size == b->size && a->seconds == b->seconds && a->nanoseconds == b->nanoseconds;
}

#endif
