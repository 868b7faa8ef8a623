/* tools/faults/interpose.c: makes one call of the C library fail. tools/check_faults preloads
 * it:
 *   VELO_FAULT=CALL:K:ERRNO       the K-th call of that kind (from 1) fails
 *   VELO_FAULT=CALL:K+:ERRNO      that and all later ones
 *   VELO_FAULT=CALL:K:-SIGNAL     the K-th call succeeds, and its thread gets that signal right
 *                                 after it (open and
 * name) VELO_FAULT_COUNT=FILE         how many calls of that kind there were, at exit CALL:
 * memory (malloc, calloc, realloc, aligned), read (read, pread), write (write, pwrite,
 * ftruncate), sync, rename, link, open, name (open, fcntl, rename, link, unlink), thread. Calls
 * on standard input, output and error do not count. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
void *__libc_memalign(size_t alignment, size_t size);

static char fault_call[16];
static long fault_at; /* 0: no fault */
static int fault_errno, fault_stays;
static atomic_long calls;
static atomic_int ready;

static __attribute__((constructor)) void start(void) {
  const char *text = getenv("VELO_FAULT");
  char plus = 0;
  if (!text)
    return;
  if (sscanf(text, "%15[a-z]:%ld:%d", fault_call, &fault_at, &fault_errno) != 3 &&
      sscanf(text, "%15[a-z]:%ld%c:%d", fault_call, &fault_at, &plus, &fault_errno) != 4)
    return;
  fault_stays = plus == '+';
  atomic_store(&ready, 1);
}

static __attribute__((destructor)) void finish(void) {
  const char *path = getenv("VELO_FAULT_COUNT");
  atomic_store(&ready, 0);
  FILE *file = path ? fopen(path, "w") : NULL;
  if (!file)
    return;
  fprintf(file, "%ld\n", atomic_load(&calls));
  fclose(file);
}

static __thread int signal_due;

static int fails(const char *call) {
  if (!atomic_load(&ready) || strcmp(call, fault_call) != 0)
    return 0;
  long n = atomic_fetch_add(&calls, 1) + 1;
  if (n != fault_at && !(fault_stays && fault_at && n > fault_at))
    return 0;
  if (fault_errno < 0) {
    signal_due = -fault_errno;
    return 0;
  }
  errno = fault_errno;
  return 1;
}

/* Sends the signal after a call. Returns the call's result. */
static int after(int result) {
  int number = signal_due, code = errno;
  signal_due = 0;
  if (number)
    raise(number);
  errno = code;
  return result;
}
/* Whether a call that changes or opens a name fails: it counts under both kinds. */
static int name_fails(const char *call) {
  return fails(call) || fails("name");
}

/* The C library's own function that the function defined here replaces. */
#define NEXT(name, ...) ((__typeof__(name) *)dlsym(RTLD_NEXT, #name))(__VA_ARGS__)

void *malloc(size_t size) {
  return fails("memory") ? NULL : __libc_malloc(size);
}
void *calloc(size_t count, size_t size) {
  return fails("memory") ? NULL : __libc_calloc(count, size);
}
void *realloc(void *block, size_t size) {
  return size && fails("memory") ? NULL : __libc_realloc(block, size);
}
void *memalign(size_t alignment, size_t size) {
  return fails("memory") ? NULL : __libc_memalign(alignment, size);
}
void *aligned_alloc(size_t alignment, size_t size) {
  return memalign(alignment, size);
}
int posix_memalign(void **block, size_t alignment, size_t size) {
  void *p = memalign(alignment, size);
  if (!p)
    return ENOMEM;
  *block = p;
  return 0;
}

ssize_t read(int file, void *data, size_t size) {
  return file > 2 && fails("read") ? -1 : NEXT(read, file, data, size);
}
ssize_t pread(int file, void *data, size_t size, off_t at) {
  return file > 2 && fails("read") ? -1 : NEXT(pread, file, data, size, at);
}
ssize_t pread64(int file, void *data, size_t size, off64_t at) {
  return file > 2 && fails("read") ? -1 : NEXT(pread64, file, data, size, at);
}
ssize_t write(int file, const void *data, size_t size) {
  return file > 2 && fails("write") ? -1 : NEXT(write, file, data, size);
}
ssize_t pwrite(int file, const void *data, size_t size, off_t at) {
  return file > 2 && fails("write") ? -1 : NEXT(pwrite, file, data, size, at);
}
ssize_t pwrite64(int file, const void *data, size_t size, off64_t at) {
  return file > 2 && fails("write") ? -1 : NEXT(pwrite64, file, data, size, at);
}
int ftruncate(int file, off_t size) {
  return fails("write") ? -1 : NEXT(ftruncate, file, size);
}
int fsync(int file) {
  return fails("sync") ? -1 : NEXT(fsync, file);
}
int rename(const char *from, const char *to) {
  return name_fails("rename") ? -1 : after(NEXT(rename, from, to));
}
int linkat(int a, const char *from, int b, const char *to, int flags) {
  return name_fails("link") ? -1 : after(NEXT(linkat, a, from, b, to, flags));
}
int unlink(const char *path) {
  return fails("name") ? -1 : after(NEXT(unlink, path));
}
int fcntl(int file, int command, ...) {
  va_list more;
  va_start(more, command);
  void *argument = va_arg(more, void *);
  va_end(more);
  return fails("name") ? -1 : after(NEXT(fcntl, file, command, argument));
}
int fcntl64(int file, int command, ...) {
  va_list more;
  va_start(more, command);
  void *argument = va_arg(more, void *);
  va_end(more);
  return fails("name") ? -1 : after(NEXT(fcntl64, file, command, argument));
}
static mode_t mode_of(int flags, va_list more) {
  return flags & (O_CREAT | __O_TMPFILE) ? va_arg(more, mode_t) : 0;
}
#define OPEN(name)                                                         \
  int name(const char *path, int flags, ...) {                             \
    va_list more;                                                          \
    va_start(more, flags);                                                 \
    mode_t mode = mode_of(flags, more);                                    \
    va_end(more);                                                          \
    return name_fails("open") ? -1 : after(NEXT(name, path, flags, mode)); \
  }
OPEN(open)
OPEN(open64)
FILE *fopen(const char *path, const char *mode) {
  return fails("open") ? NULL : NEXT(fopen, path, mode);
}
FILE *fopen64(const char *path, const char *mode) {
  return fails("open") ? NULL : NEXT(fopen64, path, mode);
}
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*body)(void *),
                   void *argument) {
  return fails("thread") ? EAGAIN : NEXT(pthread_create, thread, attributes, body, argument);
}
