/* base/file.c: see file.h. */
#include "base/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <zlib.h>

#include "base/error.h"
#include "base/file_input.h"
#include "base/file_record.h"
#include "base/free.h"
#include "base/sandbox.h"
#include "base/text.h"

double vl_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The name in the folder of `path` that is nearest to its last component; empty if none is
 * near. */
static void nearest_file(const char *path, char *result, size_t size) {
  result[0] = 0;
  char folder[4096];
  const char *name = path + vl_folder_length(path);
  if (!vl_folder_of(path, folder, sizeof folder))
    return;
  DIR *directory = opendir(folder);
  if (!directory)
    return;
  uint32_t best = (uint32_t)strlen(name) / 3 + 1;
  struct dirent *entry;
  for (int seen = 0; seen < 20000 && (entry = readdir(directory)); seen++) {
    if (entry->d_name[0] == '.')
      continue;
    uint32_t d = vl_edit_distance(name, entry->d_name);
    if (d < best || (d == best && result[0] && strcmp(entry->d_name, result) < 0)) {
      best = d;
      snprintf(result, size, "%s", entry->d_name);
    }
  }
  closedir(directory);
}

static vlResult fail_open(const char *path, int code, vlError *error) {
  if (code == ENOENT || code == ENOTDIR) {
    char near[256];
    nearest_file(path, near, sizeof near);
    if (near[0])
      return vl_fail(error, VL_ERROR_MISSING, "no such file: %s (did you mean \"%s\"?)", path,
                     near);
    return vl_fail(error, VL_ERROR_MISSING, "no such file: %s", path);
  }
  return vl_fail(error, VL_ERROR_IO, "cannot read %s: %s", path, strerror(code));
}

/* Limits against decompression bombs: text compresses by a factor of 3 to 50. Output beyond
 * both limits is refused. */
enum { MAX_RATIO = 200, MAX_UNPACKED = 64 << 20 };

static vlResult gunzip_all(vlContext *context, const char *path, char **data, size_t *size,
                           vlError *error) {
  z_stream z;
  memset(&z, 0, sizeof z);
  if (inflateInit2(&z, 15 + 16) != Z_OK)
    return vl_fail_memory(error);
  size_t capacity = *size * 4 + 65536, used = 0;
  char *out = vl_alloc(context, capacity + 1);
  z.next_in = (Bytef *)*data;
  size_t left = *size;
  int status = out ? Z_OK : Z_MEM_ERROR;
  while (status == Z_OK) {
    if (z.avail_in == 0) {
      z.avail_in = left > 1u << 30 ? 1u << 30 : (uInt)left;
      left -= z.avail_in;
    }
    if (used > MAX_UNPACKED && used / MAX_RATIO > *size) {
      status = Z_VERSION_ERROR;
      break;
    }
    if (capacity == used) {
      char *more = vl_realloc_array(context, out, capacity * 2 + 1, 1);
      if (!more) {
        status = Z_MEM_ERROR;
        break;
      }
      out = more;
      capacity *= 2;
    }
    size_t room = capacity - used > 1u << 24 ? 1u << 24 : capacity - used;
    z.next_out = (Bytef *)out + used;
    z.avail_out = (uInt)room;
    uInt before_in = z.avail_in;
    status = inflate(&z, Z_NO_FLUSH);
    used += room - z.avail_out;
    /* a gzip file may consist of several members */
    if (status == Z_STREAM_END && (z.avail_in || left)) {
      status = inflateReset2(&z, 15 + 16);
    } else if (status == Z_BUF_ERROR ||
               (status == Z_OK && before_in == 0 && left == 0 && room == z.avail_out)) {
      status = Z_DATA_ERROR; /* the stream ended too early */
    }
  }
  inflateEnd(&z);
  if (status != Z_STREAM_END) {
    vl_free(context, out);
    if (status == Z_MEM_ERROR)
      return vl_fail_memory(error);
    if (status == Z_VERSION_ERROR)
      return vl_fail(error, VL_ERROR_SCENE, "%s: unpacks to more than %d times its size", path,
                     MAX_RATIO);
    return vl_fail(error, VL_ERROR_SCENE, "%s: broken gzip file", path);
  }
  out[used] = 0;
  vl_free(context, *data);
  *data = out;
  *size = used;
  return VL_OK;
}

/* Why a file is refused: it has no end, or reading it may block. Null: a regular file, or a
 * pipe if pipes are allowed. */
static const char *not_a_file(const struct stat *info, bool pipes) {
  if (S_ISDIR(info->st_mode))
    return "is a folder";
  if (S_ISCHR(info->st_mode) || S_ISBLK(info->st_mode))
    return "is a device";
  if (S_ISSOCK(info->st_mode))
    return "is a socket";
  return S_ISFIFO(info->st_mode) && !pipes ? "is a pipe" : NULL;
}

/* Checks the file's type before opening, since opening a pipe blocks and opening a device may
 * have side effects; and again after opening, since the name may refer to another file by
 * then. */
static int open_file(vlContext *context, const char *path, bool given, vlError *error) {
  struct stat info;
  /* asked first: the answer is the same for a missing file */
  if (!given && !vl_context_allows(context, path)) {
    vl_fail(error, VL_ERROR_IO, "cannot read %s: it lies outside of the sandbox", path);
    return -1;
  }
  if (stat(path, &info) != 0) {
    fail_open(path, errno, error);
    return -1;
  }
  if (given)
    vl_sandbox_pass(vl_context_sandbox(context), path);
  const char *what = not_a_file(&info, given);
  int fd = what ? -1 : open(path, O_RDONLY | O_CLOEXEC | (given ? 0 : O_NONBLOCK));
  if (!what && fd < 0) {
    fail_open(path, errno, error);
    return -1;
  }
  if (!what && fstat(fd, &info) != 0)
    what = strerror(errno);
  if (!what)
    what = not_a_file(&info, given);
  if (!what)
    return fd;
  if (fd >= 0)
    close(fd);
  vl_fail(error, VL_ERROR_IO, "cannot read %s: %s", path, what);
  return -1;
}

/* The text that Git stores in place of a large file. */
static bool is_lfs_pointer(const char *data, size_t size) {
  static const char begin[] = "version https://git-lfs.github.com/spec/";
  return size < 1024 && size >= sizeof begin && memcmp(data, begin, sizeof begin - 1) == 0;
}

static vlResult fail_lfs_pointer(const char *path, vlError *error) {
  return vl_fail(error, VL_ERROR_MISSING,
                 "%s is a Git LFS pointer, not the file itself: git lfs pull fetches it", path);
}

/* Turns UTF-16 with a byte order mark into UTF-8, where the text begins with ASCII (binary
 * files may begin with the mark's bytes). */
static vlResult utf16_to_utf8(vlContext *context, char **data, size_t *size, vlError *error) {
  enum { LOOK = 8 };
  const unsigned char *from = (const unsigned char *)*data;
  const bool big = *size >= 2 && from[0] == 0xfe && from[1] == 0xff;
  if (!big && !(*size >= 2 && from[0] == 0xff && from[1] == 0xfe))
    return VL_OK;
  for (size_t i = 2; i + 1 < *size && i < 2 + 2 * LOOK; i += 2)
    if (from[i + !big] != 0 || from[i + big] == 0 || from[i + big] > 0x7e)
      return VL_OK;
  char *to = vl_alloc_array(context, *size / 2 + 1, 3);
  if (!to)
    return vl_fail_memory(error);
  size_t used = 0;
  for (size_t i = 2; i + 1 < *size; i += 2) {
    uint32_t c = (uint32_t)from[i + big] | (uint32_t)from[i + !big] << 8, next = 0;
    if (i + 3 < *size)
      next = (uint32_t)from[i + 2 + big] | (uint32_t)from[i + 2 + !big] << 8;
    if (c >= 0xd800 && c < 0xdc00 && next >= 0xdc00 && next < 0xe000) {
      c = 0x10000 + ((c - 0xd800) << 10) + (next - 0xdc00);
      i += 2;
    }
    if (c >= 0xd800 && c < 0xe000)
      c = 0xfffd; /* half of a pair */
    if (c < 0x80) {
      to[used++] = (char)c;
      continue;
    }
    const int more = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3; /* bytes after the first */
    to[used++] = (char)((0xf00 >> (more + 1) & 0xff) | c >> 6 * more);
    for (int k = more - 1; k >= 0; k--)
      to[used++] = (char)(0x80 | (c >> 6 * k & 0x3f));
  }
  to[used] = 0;
  vl_free(context, *data);
  *data = to;
  *size = used;
  return VL_OK;
}

/* Notes an open file as an input of the context. False: out of memory, and the file is
 * closed. */
static bool note_input(vlContext *context, const char *path, int fd, struct stat *info) {
  if (fstat(fd, info) != 0)
    info->st_size = 0;
  const bool noted = vl_file_input(context, path, info, VL_OUTPUT_PLAIN);
  if (!noted)
    close(fd);
  return noted;
}

/* Reads a descriptor to its end. size: of the file; 0: not known. *block ends with a zero,
 * which *used does not count; it is set on errors, too. */
static vlResult read_to_end(vlContext *context, const char *path, int fd, size_t size,
                            char **block, size_t *used, vlError *error) {
  enum { FIRST_SIZE = 65536 };
  size_t capacity = (size ? size : FIRST_SIZE) + 1;
  *used = 0;
  *block = vl_alloc(context, capacity);
  if (!*block)
    return vl_fail_memory(error);
  for (;;) {
    const ssize_t got = read(fd, *block + *used, capacity - *used);
    if (got == 0)
      break;
    if (got < 0 && errno != EINTR)
      return vl_fail(error, VL_ERROR_IO, "cannot read %s: %s", path, strerror(errno));
    *used += got > 0 ? (size_t)got : 0;
    if (*used < capacity)
      continue;
    /* a pipe has no size, and a file may have grown */
    char *grown = vl_realloc_array(context, *block, 2 * capacity, 1);
    if (!grown)
      return vl_fail_memory(error);
    *block = grown;
    capacity *= 2;
  }
  (*block)[*used] = 0;
  return VL_OK;
}

/* Records the bytes of a file, and turns them into text. gunzip: as for vl_file_read. */
static vlResult take_bytes(vlContext *context, const char *path, bool gunzip, char **block,
                           size_t *used, vlError *error) {
  if (!vl_file_record(context, path, *block, *used))
    return vl_fail_memory(error);
  const bool gzipped =
      *used >= 2 && (unsigned char)(*block)[0] == 0x1f && (unsigned char)(*block)[1] == 0x8b;
  if (gunzip && gzipped)
    VL_TRY(gunzip_all(context, path, block, used, error));
  if (gunzip)
    VL_TRY(utf16_to_utf8(context, block, used, error));
  return is_lfs_pointer(*block, *used) ? fail_lfs_pointer(path, error) : VL_OK;
}

static vlResult read_file(vlContext *context, const char *path, bool given, bool gunzip,
                          char **data, size_t *size, vlError *error) {
  *data = NULL;
  *size = 0;
  vlError opening = {0};
  int fd = open_file(context, path, given, &opening);
  if (fd < 0) {
    if (error)
      *error = opening;
    return opening.code;
  }
  struct stat info = {0};
  if (!note_input(context, path, fd, &info))
    return vl_fail_memory(error);
  char *block;
  size_t used;
  vlResult result = read_to_end(context, path, fd, info.st_size > 0 ? (size_t)info.st_size : 0,
                                &block, &used, error);
  close(fd);
  if (result == VL_OK)
    result = take_bytes(context, path, gunzip, &block, &used, error);
  if (result != VL_OK) {
    vl_free(context, block);
    return result;
  }
  *data = block;
  *size = used;
  return VL_OK;
}

vlResult vl_file_read(vlContext *context, const char *path, bool gunzip, char **data,
                      size_t *size, vlError *error) {
  return read_file(context, path, false, gunzip, data, size, error);
}

vlResult vl_file_read_given(vlContext *context, const char *path, bool gunzip, char **data,
                            size_t *size, vlError *error) {
  return read_file(context, path, true, gunzip, data, size, error);
}

/* The file's bytes in anonymous pages of its own, for systems that map no file at a given
 * address. */
static char *read_pages(int fd, size_t length) {
  char *block =
      mmap(NULL, length + 1, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (block == MAP_FAILED)
    return block;
  for (size_t used = 0; used < length;) {
    ssize_t got = pread(fd, block + used, length - used, (off_t)used);
    if (got < 0 && errno == EINTR)
      continue;
    if (got <= 0) {
      if (got == 0)
        errno = EIO; /* the file has become shorter */
      int code = errno;
      munmap(block, length + 1);
      errno = code;
      return MAP_FAILED;
    }
    used += (size_t)got;
  }
  return block;
}

vlResult vl_file_check(vlContext *context, const char *path, vlError *error) {
  if (vl_context_allows(context, path) && access(path, R_OK) == 0)
    return VL_OK;
  char *data = NULL;
  size_t size;
  const vlResult result = vl_file_read(context, path, false, &data, &size, error);
  vl_free(context, data);
  return result;
}

vlResult vl_file_map(vlContext *context, const char *path, const char **data, size_t *size,
                     vlError *error) {
  *data = NULL;
  struct stat info;
  if (stat(path, &info) != 0)
    return fail_open(path, errno, error);
  if (!S_ISREG(info.st_mode))
    return VL_OK;
  int fd = open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0)
    return fail_open(path, errno, error);
  if (!note_input(context, path, fd, &info))
    return vl_fail_memory(error);
  size_t length = (size_t)info.st_size;
  /* Maps zero pages first, then the file over them: a zero byte follows even if the file fills
   * its last page. */
  char *block = mmap(NULL, length + 1, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  bool good = block != MAP_FAILED;
  if (good && length &&
      mmap(block, length, PROT_READ, MAP_PRIVATE | MAP_FIXED, fd, 0) == MAP_FAILED) {
    munmap(block, length + 1);
    block = read_pages(fd, length);
    good = block != MAP_FAILED;
  }
  int code = errno;
  close(fd);
  if (!good)
    return vl_fail(error, VL_ERROR_IO, "cannot read %s: %s", path, strerror(code));
  if (is_lfs_pointer(block, length)) {
    vl_file_unmap(block, length);
    return fail_lfs_pointer(path, error);
  }
  *data = block;
  *size = length;
  return VL_OK;
}

void vl_file_unmap(const char *data, size_t size) {
  if (data)
    munmap(vl_owned(data), size + 1);
}
