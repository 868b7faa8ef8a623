/* base/file_lock.c: see file_lock.h. The reasons are in docs/decisions/0020-locked-films.md. */
#include "base/file_lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/digest.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "base/unfinished.h"

#define PREFIX ".velo-"
#define SUFFIX ".lock"
#define SIBLING ".merge"
enum { DIGITS = 16, TRIES = 10, MILLISECONDS = 50, MAX_CHANGES = 1000 };

bool vl_is_lock_name(const char *name) {
  const size_t prefix = sizeof PREFIX - 1;
  return strlen(name) == prefix + DIGITS + sizeof SUFFIX - 1 &&
         strncmp(name, PREFIX, prefix) == 0 &&
         strspn(name + prefix, "0123456789abcdef") == DIGITS &&
         vl_text_is(name + prefix + DIGITS, SUFFIX);
}

/* The name is a digest, so that it fits where the file's own name is as long as names may
 * be. */
static bool name_lock(const char *path, char *name, size_t size) {
  char target[4096], text[33];
  uint8_t digest[16];
  if (!vl_follow_links(path, target, sizeof target))
    return false;
  const char *own = vl_file_name(target);
  vl_digest(own, strlen(own), digest);
  vl_digest_text(digest, text);
  snprintf(name, size, "%.*s" PREFIX "%.*s" SUFFIX, (int)(own - target), target, DIGITS, text);
  return true;
}

/* Sets the lock without waiting: 0, or errno; EAGAIN: another has it. */
static int set_lock(int descriptor) {
  struct flock lock;
  memset(&lock, 0, sizeof lock); /* l_pid must be 0; the range is the whole file */
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
#ifdef F_OFD_SETLK
  const int command = F_OFD_SETLK;
#else
  const int command = F_SETLK;
#endif
  while (fcntl(descriptor, command, &lock) != 0)
    if (errno != EINTR)
      return errno == EACCES ? EAGAIN : errno;
  return 0;
}

/* Whether the name still leads to this file: its owner removes it when it releases the lock. It
 * is opened, since an NFS client looks up a name anew only then; where no descriptor is left, a
 * look-up must do. */
static bool is_named(int descriptor, int folder, const char *name) {
  struct stat mine, named;
  int other = openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  bool there = other >= 0 ? fstat(other, &named) == 0
                          : fstatat(folder, name, &named, AT_SYMLINK_NOFOLLOW) == 0;
  if (other >= 0)
    close(other);
  return there && fstat(descriptor, &mine) == 0 && mine.st_nlink > 0 &&
         mine.st_ino == named.st_ino && mine.st_dev == named.st_dev;
}

/* Opens the lock's file, or makes it; any user may lock it, since its owner may have been
 * killed. -1: errno is set, EEXIST if another process made it meanwhile. */
static int open_lock(const char *path) {
  const int flags = O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  int descriptor = open(path, flags);
  if (descriptor >= 0 || errno != ENOENT)
    return descriptor;
  descriptor = open(path, flags | O_CREAT | O_EXCL, 0666);
  if (descriptor >= 0 && fchmod(descriptor, 0666) != 0)
    errno = 0;
  return descriptor;
}

/* Writes the name of vl_lock_sibling. name: of the lock's file. Async-signal-safe, as the next
 * two functions are. */
static void name_sibling(const char *name, char *sibling, size_t size) {
  const size_t length = strlen(name) - (sizeof SUFFIX - 1);
  if (length + sizeof SIBLING > size) {
    sibling[0] = 0;
    return;
  }
  memcpy(sibling, name, length);
  memcpy(sibling + length, SIBLING, sizeof SIBLING);
}

/* Removes a lock's file and its sibling, unless another process or another descriptor has the
 * lock. */
static void remove_lock(int descriptor, int folder, const char *name) {
  char sibling[sizeof((vlFileLock *)0)->path];
  if (set_lock(descriptor) != 0 || !is_named(descriptor, folder, name))
    return;
  name_sibling(name, sibling, sizeof sibling);
  unlinkat(folder, sibling, 0);
  unlinkat(folder, name, 0);
}

/* Of a process that ends (vlUnfinishedFn). */
static void remove_held(int descriptor, const char *path) {
  remove_lock(descriptor, AT_FDCWD, path);
}

static void drop(vlFileLock *lock) {
  vl_unfinished_drop(lock->unfinished);
  lock->unfinished = NULL;
}

/* One attempt: 0 and lock->descriptor, or errno. EAGAIN: another has the lock; EEXIST, ESTALE:
 * its file changed. The file is noted before it may be made. */
static int try_lock(vlFileLock *lock, vlContext *context) {
  lock->unfinished =
      vl_unfinished_add(vl_context_unfinished(context), lock->path, -1, remove_held);
  if (!lock->unfinished)
    return ENOMEM;
  int descriptor = open_lock(lock->path), code = descriptor < 0 ? errno : 0;
  atomic_store(&lock->unfinished->descriptor, descriptor);
  if (code == 0)
    code = set_lock(descriptor);
  if (code == 0 && !is_named(descriptor, AT_FDCWD, lock->path))
    code = ESTALE;
  if (code == 0) {
    lock->descriptor = descriptor;
    return 0;
  }
  drop(lock);
  if (descriptor >= 0)
    close(descriptor);
  return code;
}

vlResult vl_file_lock(vlFileLock *lock, vlContext *context, const char *path,
                      vlLockState *state, vlError *error) {
  lock->descriptor = -1;
  lock->unfinished = NULL;
  *state = VL_LOCK_BUSY;
  int code = name_lock(path, lock->path, sizeof lock->path) ? try_lock(lock, context) : errno;
  for (int busy = 0, changed = 0; busy < TRIES && changed < MAX_CHANGES;
       code = try_lock(lock, context)) {
    if (code == EAGAIN) { /* whoever sweeps the folder holds it for a moment */
      const struct timespec wait = {0, MILLISECONDS * 1000000L};
      nanosleep(&wait, NULL);
      busy++;
    } else if (code == ESTALE || code == EEXIST) {
      changed++;
    } else {
      break;
    }
  }
  if (code == 0)
    *state = VL_LOCK_HELD;
  if (code == 0 || code == EAGAIN || code == ESTALE || code == EEXIST)
    return VL_OK;
  if (code == ENOLCK || code == EINVAL || code == ENOSYS || code == EOPNOTSUPP) {
    *state = VL_LOCK_NONE;
    unlink(lock->path);
    return VL_OK;
  }
  if (code == ENOMEM)
    return vl_fail_memory(error);
  return vl_fail(error, VL_ERROR_IO, "cannot write %s: cannot lock it: %s", path,
                 strerror(code));
}

void vl_file_unlock(vlFileLock *lock) {
  if (lock->descriptor < 0)
    return;
  unlink(lock->path);
  drop(lock);
  close(lock->descriptor); /* last, because closing releases the lock */
  lock->descriptor = -1;
}

void vl_lock_sibling(const vlFileLock *lock, char *path, size_t size) {
  name_sibling(lock->path, path, size);
}

void vl_file_lock_sweep(int folder, const char *name) {
  int descriptor = openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0)
    return;
  remove_lock(descriptor, folder, name);
  close(descriptor);
}
