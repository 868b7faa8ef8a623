/* base/file_write.c: atomic writing of files. See file.h. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/file_lock.h"
#include "base/file_stream.h"
#include "base/text.h"
#include "base/unfinished.h"

/* Temporary files are named by the process id alone, so that targets with the longest names can
 * be written. The writer holds a lock on its temporary file: one without a lock belongs to a
 * process that has ended. */
#define PREFIX ".velo-"
#define SUFFIX ".tmp"
enum { MAX_TRIES = 1000 };

/* Removes a temporary file (vlUnfinishedFn), unless another writer has it. */
static void remove_temporary(int descriptor, const char *path) {
  struct stat mine, named;
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 || fstat(descriptor, &mine) != 0)
    return;
  if (lstat(path, &named) == 0 && mine.st_ino == named.st_ino && mine.st_dev == named.st_dev)
    unlink(path);
}

/* Chooses the temporary file's name before the file has it. False: errno is set. */
static bool name_temporary(vlFileWriter *writer, unsigned number) {
  snprintf(writer->temporary, sizeof writer->temporary, "%.*s" PREFIX "%ld-%u" SUFFIX,
           (int)vl_folder_length(writer->target), writer->target, (long)getpid(), number);
  writer->unfinished =
      vl_unfinished_add(vl_context_unfinished(writer->context), writer->temporary,
                        writer->descriptor, remove_temporary);
  if (!writer->unfinished)
    errno = ENOMEM;
  return writer->unfinished;
}

/* The temporary file is gone, or is the target now. errno stays. */
static void drop_temporary(vlFileWriter *writer) {
  vl_unfinished_drop(writer->unfinished);
  writer->unfinished = NULL;
}

/* Opens a file without a name (O_TMPFILE), which disappears with its process. Not every file
 * system supports them. */
static bool open_nameless(vlFileWriter *writer) {
#if defined(O_TMPFILE) && defined(AT_SYMLINK_FOLLOW)
  char folder[4096];
  if (access("/proc/self/fd", X_OK) != 0)
    return false; /* needed to name the file later */
  snprintf(folder, sizeof folder, "%.*s.", (int)vl_folder_length(writer->target),
           writer->target);
  writer->descriptor = open(folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  return writer->descriptor >= 0;
#else
  (void)writer;
  return false;
#endif
}

/* Links the nameless file to a temporary name, just before it is renamed. False: errno is
 * set. */
static bool give_name(vlFileWriter *writer) {
  char self[64];
  snprintf(self, sizeof self, "/proc/self/fd/%d", writer->descriptor);
  for (unsigned i = 0; i < MAX_TRIES; i++) {
    if (!name_temporary(writer, i))
      break;
    if (linkat(AT_FDCWD, self, AT_FDCWD, writer->temporary, AT_SYMLINK_FOLLOW) == 0)
      return true;
    drop_temporary(writer);
    if (errno != EEXIST)
      break;
  }
  writer->temporary[0] = 0;
  return false;
}

/* Opens a new file and locks it; named: it has a name at once. False: errno is set. */
static bool open_temporary(vlFileWriter *writer, bool named) {
  if (!named && open_nameless(writer)) {
    flock(writer->descriptor, LOCK_EX | LOCK_NB);
    return true;
  }
  for (unsigned i = 0; i < MAX_TRIES; i++) {
    if (!name_temporary(writer, i))
      return false;
    writer->descriptor = open(writer->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (writer->descriptor < 0) {
      drop_temporary(writer);
      if (errno == EEXIST)
        continue;
      return false;
    }
    atomic_store(&writer->unfinished->descriptor, writer->descriptor);
    /* another process may have removed it as abandoned before it was locked */
    struct stat info;
    bool locked = flock(writer->descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    if (locked && fstat(writer->descriptor, &info) == 0 && info.st_nlink > 0)
      return true;
    drop_temporary(writer);
    close(writer->descriptor);
    writer->descriptor = -1;
  }
  errno = EEXIST;
  return false;
}

static bool is_temporary(const char *name) {
  size_t length = strlen(name), prefix = sizeof PREFIX - 1, suffix = sizeof SUFFIX - 1;
  if (length <= prefix + suffix || strncmp(name, PREFIX, prefix) != 0)
    return false;
  return vl_text_is(name + length - suffix, SUFFIX) &&
         strspn(name + prefix, "0123456789-") == length - prefix - suffix;
}

void vl_remove_leftovers(const char *path) {
  char target[4096], folder[4096];
  if (!path || !vl_follow_links(path, target, sizeof target))
    return;
  snprintf(folder, sizeof folder, "%.*s.", (int)vl_folder_length(target), target);
  DIR *directory = opendir(folder);
  if (!directory)
    return;
  struct dirent *entry;
  while ((entry = readdir(directory))) {
    if (vl_is_lock_name(entry->d_name))
      vl_file_lock_sweep(dirfd(directory), entry->d_name);
    if (!is_temporary(entry->d_name))
      continue;
    int fd =
        openat(dirfd(directory), entry->d_name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0)
      continue;
    struct stat mine, named;
    if (flock(fd, LOCK_EX | LOCK_NB) == 0 && fstat(fd, &mine) == 0 && S_ISREG(mine.st_mode) &&
        fstatat(dirfd(directory), entry->d_name, &named, AT_SYMLINK_NOFOLLOW) == 0 &&
        mine.st_ino == named.st_ino && mine.st_dev == named.st_dev)
      unlinkat(dirfd(directory), entry->d_name, 0);
    close(fd);
  }
  closedir(directory);
}

static vlResult fail(const char *path, int code, vlError *error) {
  if (code == ENOMEM)
    return vl_fail_memory(error);
  return vl_fail(error, VL_ERROR_IO, "cannot write %s: %s", path, strerror(code));
}

/* Opens what is no stream, after its checks. */
static vlResult open_file(vlFileWriter *writer, const char *path, bool named, vlError *error) {
  struct stat info;
  writer->in_memory = false;
  writer->replaces = stat(path, &info) == 0;
  if (writer->replaces) {
    writer->mode = info.st_mode & 0777;
    writer->owner = info.st_uid;
    writer->group = info.st_gid;
  }
  if (vl_follow_links(path, writer->target, sizeof writer->target))
    open_temporary(writer, named);
  if (writer->descriptor >= 0)
    return VL_OK;
  return fail(path, errno, error);
}

vlResult vl_file_open_write(vlFileWriter *writer, vlContext *context, const char *path,
                            vlOutputKind kind, vlError *error) {
  vl_file_open_memory(writer, context, path);
  vlResult result = vl_check_output(context, path, kind, error);
  if (result != VL_OK || vl_path_is_stream(path))
    return result;
  return open_file(writer, path, false, error);
}

vlResult vl_file_open_named(vlFileWriter *writer, vlContext *context, const char *path,
                            vlError *error) {
  vl_file_open_memory(writer, context, path);
  VL_TRY(vl_check_output(context, path, VL_OUTPUT_PLAIN, error));
  if (vl_path_is_stream(path))
    return vl_fail(error, VL_ERROR_IO, "cannot write %s: it is no regular file", path);
  return open_file(writer, path, true, error);
}

void vl_file_open_memory(vlFileWriter *writer, vlContext *context, const char *name) {
  writer->failed_errno = 0;
  writer->descriptor = -1;
  writer->context = context;
  writer->in_memory = true;
  writer->unfinished = NULL;
  writer->memory = NULL;
  writer->memory_size = writer->memory_capacity = 0;
  writer->replaces = false;
  writer->target[0] = writer->temporary[0] = 0;
  snprintf(writer->path, sizeof writer->path, "%s", name);
}

bool vl_file_reserve(vlFileWriter *writer, size_t size) {
  if (size <= writer->memory_capacity)
    return true;
  char *grown = vl_realloc_array(writer->context, writer->memory, size, 1);
  if (!grown) {
    writer->failed_errno = ENOMEM;
    return false;
  }
  writer->memory = grown;
  writer->memory_capacity = size;
  return true;
}

static void write_memory(vlFileWriter *writer, const void *data, size_t size, uint64_t offset) {
  size_t end = (size_t)offset + size;
  if (size == 0 || writer->failed_errno)
    return;
  if (end > writer->memory_capacity && !vl_file_reserve(writer, end + end / 2 + 4096))
    return;
  if (offset > writer->memory_size)
    memset(writer->memory + writer->memory_size, 0, offset - writer->memory_size);
  memcpy(writer->memory + offset, data, size);
  if (end > writer->memory_size)
    writer->memory_size = end;
}

/* How many bytes write or pwrite, which returned n, has taken. */
static size_t taken(vlFileWriter *writer, ssize_t n) {
  if (n >= 0)
    return (size_t)n;
  if (errno != EINTR)
    writer->failed_errno = errno;
  return 0;
}

void vl_file_write(vlFileWriter *writer, const void *data, size_t size) {
  const char *bytes = data;
  if (writer->in_memory) {
    write_memory(writer, data, size, writer->memory_size);
    return;
  }
  while (size && !writer->failed_errno) {
    size_t n = taken(writer, write(writer->descriptor, bytes, size));
    bytes += n;
    size -= n;
  }
}

void vl_file_write_at(vlFileWriter *writer, const void *data, size_t size, uint64_t offset) {
  const char *bytes = data;
  if (writer->in_memory) {
    write_memory(writer, data, size, offset);
    return;
  }
  while (size && !writer->failed_errno) {
    size_t n = taken(writer, pwrite(writer->descriptor, bytes, size, (off_t)offset));
    bytes += n;
    offset += n;
    size -= n;
  }
}

/* Keeps owner and permissions of the replaced file, as far as the user and the file system
 * allow. */
static void keep_permissions(const vlFileWriter *writer) {
  if (fchown(writer->descriptor, writer->owner, writer->group) != 0 &&
      fchown(writer->descriptor, (uid_t)-1, writer->group) != 0)
    errno = 0;
  if (fchmod(writer->descriptor, writer->mode) != 0)
    errno = 0;
}

/* Makes the new name durable, if the file system can sync a folder. */
static void sync_folder(const vlFileWriter *writer) {
  char folder[4096];
  snprintf(folder, sizeof folder, "%.*s.", (int)vl_folder_length(writer->target),
           writer->target);
  int descriptor = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0)
    return;
  fsync(descriptor);
  close(descriptor);
}

/* Hands the bytes of a stream to its other end. */
static vlResult commit_stream(vlFileWriter *writer, vlError *error) {
  if (!writer->failed_errno)
    writer->failed_errno =
        vl_stream_write(writer->context, writer->path, writer->memory, writer->memory_size);
  vl_file_abandon(writer);
  if (!writer->failed_errno)
    return VL_OK;
  if (writer->failed_errno == ENXIO || writer->failed_errno == EAGAIN)
    return vl_fail(error, VL_ERROR_IO, "cannot write %s: nobody reads it", writer->path);
  return fail(writer->path, writer->failed_errno, error);
}

vlResult vl_file_commit(vlFileWriter *writer, vlError *error) {
  if (writer->in_memory)
    return commit_stream(writer, error);
  if (writer->replaces)
    keep_permissions(writer);
  if (!writer->failed_errno && fsync(writer->descriptor) != 0 && errno != EINVAL &&
      errno != EROFS)
    writer->failed_errno = errno;
  if (!writer->failed_errno && !writer->temporary[0] && !give_name(writer))
    writer->failed_errno = errno;
  if (!writer->failed_errno && rename(writer->temporary, writer->target) != 0)
    writer->failed_errno = errno;
  if (writer->failed_errno && writer->temporary[0])
    unlink(writer->temporary);
  drop_temporary(writer);
  if (!writer->failed_errno)
    sync_folder(writer);
  if (close(writer->descriptor) != 0 && !writer->failed_errno)
    writer->failed_errno = errno;
  writer->descriptor = -1; /* closed last, because closing releases the lock */
  if (!writer->failed_errno)
    return VL_OK;
  return fail(writer->path, writer->failed_errno, error);
}

void vl_file_abandon(vlFileWriter *writer) {
  if (writer->in_memory) {
    vl_free(writer->context, writer->memory);
    writer->memory = NULL;
    return;
  }
  if (writer->descriptor < 0)
    return;
  if (writer->temporary[0])
    unlink(writer->temporary);
  drop_temporary(writer);
  close(writer->descriptor);
  writer->descriptor = -1;
}

vlResult vl_write_file(vlContext *context, const char *path, const void *data, size_t size,
                       vlError *error) {
  vlFileWriter writer;
  if (!context || !path || (!data && size))
    return vl_fail_argument(error, "file: context, path or data is null");
  VL_TRY(vl_file_open_write(&writer, context, path, VL_OUTPUT_PLAIN, error));
  vl_file_write(&writer, data, size);
  return vl_file_commit(&writer, error);
}
