/* base/file_output.c: whether a file can be written, and which file a path means. */
#include <errno.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"
#include "base/file.h"
#include "base/file_input.h"
#include "base/file_stream.h"
#include "base/text.h"

enum { MAX_LINKS = 40, MAX_NAME = 255 };

bool vl_follow_links(const char *path, char *target, size_t size) {
  char link[4096];
  if (strlen(path) >= size) {
    errno = ENAMETOOLONG;
    return false;
  }
  memcpy(target, path, strlen(path) + 1);
  for (int i = 0; i < MAX_LINKS; i++) {
    ssize_t n = readlink(target, link, sizeof link);
    if (n < 0)
      return true; /* not a link; other errors are reported when it is opened */
    size_t folder = n > 0 && link[0] == '/' ? 0 : vl_folder_length(target);
    if (folder + (size_t)n >= size) {
      errno = ENAMETOOLONG;
      return false;
    }
    memcpy(target + folder, link, (size_t)n);
    target[folder + (size_t)n] = 0;
  }
  errno = ELOOP;
  return false;
}

/* The folder of `path`, which is at most 4095 bytes long. */
static void folder_of(const char *path, char folder[4096]) {
  size_t n = vl_folder_length(path);
  while (n > 1 && path[n - 1] == '/')
    n--;
  snprintf(folder, 4096, "%.*s", n ? (int)n : 1, n ? path : ".");
}

static vlResult fail(const char *path, int code, vlError *error) {
  return vl_fail(error, VL_ERROR_IO, "cannot write %s: %s", path, strerror(code));
}

/* Checks the folder of a file to be made or replaced. */
static vlResult check_folder(const char *path, vlError *error) {
  char target[4096], folder[4096];
  struct stat info;
  if (!vl_follow_links(path, target, sizeof target))
    return fail(path, errno, error);
  size_t name = strlen(target + vl_folder_length(target));
  if (name == 0)
    return fail(path, *target ? EISDIR : ENOENT, error);
  if (name > MAX_NAME)
    return fail(path, ENAMETOOLONG, error);
  folder_of(target, folder);
  int code = stat(folder, &info) != 0 ? errno : 0;
  if (!code && !S_ISDIR(info.st_mode))
    return fail(path, ENOTDIR, error);
  if (!code && access(folder, W_OK | X_OK) != 0)
    code = errno;
  if (!code)
    return VL_OK;
  return vl_fail(error, VL_ERROR_IO, "cannot write %s: folder %s: %s", path, folder,
                 strerror(code));
}

vlResult vl_check_output(vlContext *context, const char *path, vlOutputKind kind,
                         vlError *error) {
  struct stat info;
  char input[4096];
  if (!path)
    return vl_fail_argument(error, "check of an output: path is null");
  if ((unsigned)kind > VL_OUTPUT_FILM)
    return vl_fail_argument(error, "check of an output: no such kind of file");
  if (strlen(path) >= 4096)
    return vl_fail(error, VL_ERROR_IO, "cannot write: path too long");
  if (vl_text_is(path, VL_STDOUT))
    return VL_OK;
  if (stat(path, &info) != 0) {
    if (errno == ELOOP || errno == ENAMETOOLONG)
      return fail(path, errno, error);
    return check_folder(path, error);
  }
  if (S_ISDIR(info.st_mode))
    return fail(path, EISDIR, error);
  if (S_ISBLK(info.st_mode))
    return vl_fail(error, VL_ERROR_IO, "cannot write %s: is a block device", path);
  if (access(path, W_OK) != 0)
    return fail(path, errno, error);
  if (!S_ISREG(info.st_mode))
    return VL_OK;
  if (!vl_file_is_input(context, path, kind, input, sizeof input))
    return check_folder(path, error);
  if (vl_text_is(input, path))
    return vl_fail_argument(error, "%s is an input of this command; it is not overwritten",
                            path);
  return vl_fail_argument(
      error, "%s is the file %s, an input of this command; it is not overwritten", path, input);
}

bool vl_file_id(const char *path, vlFileId *id) {
  struct stat info;
  char target[4096], folder[4096];
  memset(id, 0, sizeof *id);
  if (!path || !vl_follow_links(path, target, sizeof target))
    return false;
  bool there = stat(target, &info) == 0;
  if (!there) {
    folder_of(target, folder);
    if (stat(folder, &info) != 0)
      return false;
    snprintf(id->name, sizeof id->name, "%.255s", target + vl_folder_length(target));
  }
  id->device = (uint64_t)info.st_dev;
  id->inode = (uint64_t)info.st_ino;
  return true;
}
