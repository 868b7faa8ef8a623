/* base/file_stream.c: see file_stream.h. No call here blocks: a signal handler cannot end a
 * call that blocks if the signal comes just before it. */
#include "base/file_stream.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include "base/context.h"
#include "base/file.h"
#include "base/text.h"

/* A pipe that poll() calls writable takes PIPE (POSIX: PIPE_BUF, at least 512) bytes without
 * blocking. */
enum { PIECE = 4096, WAIT_MS = 100 };
/* seconds that an interrupted write waits for the other end */
static const double PATIENCE = 1;

/* A wait that goes on until the context is interrupted. */
typedef struct Wait {
  const vlContext *context;
  double since; /* when the context was found interrupted; 0: not yet */
} Wait;

/* Whether to wait on. Counts anew after `moved`: the other end took some bytes. */
static bool wait_on(Wait *wait, bool moved) {
  if (!vl_context_interrupted(wait->context))
    return true;
  double now = vl_seconds();
  if (wait->since <= 0 || moved)
    wait->since = now;
  return now - wait->since < PATIENCE;
}

bool vl_path_is_stream(const char *path) {
  struct stat info;
  if (vl_text_is(path, VL_STDOUT))
    return true;
  return stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

static int connect_socket(const char *path) {
  struct sockaddr_un address = {.sun_family = AF_UNIX};
  if (strlen(path) >= sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    return -1;
  }
  memcpy(address.sun_path, path, strlen(path));
  int fd = socket(AF_UNIX, SOCK_STREAM, 0);
  if (fd < 0)
    return -1;
  if (fcntl(fd, F_SETFD, FD_CLOEXEC) != 0 || fcntl(fd, F_SETFL, O_NONBLOCK) != 0 ||
      connect(fd, (struct sockaddr *)&address, sizeof address) != 0) {
    int code = errno;
    close(fd);
    errno = code;
    return -1;
  }
  return fd;
}

static int open_once(const char *path) {
  struct stat info;
  if (vl_text_is(path, VL_STDOUT))
    return fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  if (stat(path, &info) == 0 && S_ISSOCK(info.st_mode))
    return connect_socket(path);
  return open(path, O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

/* Opens the stream; waits until a pipe has a reader and a socket has room for a connection. -1:
 * errno is set. */
static int open_stream(Wait *wait, const char *path) {
  for (;;) {
    int fd = open_once(path), code = errno;
    bool later = code == EINTR || code == ENXIO || code == EAGAIN;
    if (fd >= 0 || !later)
      return fd;
    if (!wait_on(wait, false)) {
      errno = code == EINTR ? EAGAIN : code;
      return -1;
    }
    nanosleep(&(struct timespec){.tv_nsec = WAIT_MS * 1000000L / 5}, NULL);
  }
}

int vl_stream_write(vlContext *context, const char *path, const char *data, size_t size) {
  Wait wait = {.context = context};
  int fd = open_stream(&wait, path), code = 0;
  if (fd < 0)
    return errno;
  bool moved = false;
  while (size && !code) {
    struct pollfd one = {.fd = fd, .events = POLLOUT};
    int ready = poll(&one, 1, WAIT_MS);
    if (ready < 0 && errno != EINTR)
      code = errno;
    if (ready <= 0 && !code && !wait_on(&wait, moved))
      code = EAGAIN;
    moved = false;
    if (ready <= 0)
      continue;
    ssize_t n = write(fd, data, size < PIECE ? size : PIECE);
    if (n < 0 && errno != EINTR && errno != EAGAIN)
      code = errno;
    if (n <= 0)
      continue;
    data += n;
    size -= (size_t)n;
    moved = true;
  }
  if (close(fd) != 0 && !code)
    code = errno;
  return code;
}
