/* render/child.c: see child.h. */
#include "render/child.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/signals.h"

extern char **environ;

bool child_find(const char *folders, const char *name, char *program, size_t size) {
  while (folders && *folders) {
    const size_t n = strcspn(folders, ":");
    struct stat info;
    if (folders[0] == '/' &&
        snprintf(program, size, "%.*s/%s", (int)n, folders, name) < (int)size &&
        access(program, X_OK) == 0 && stat(program, &info) == 0 && S_ISREG(info.st_mode))
      return true;
    folders += n + (folders[n] == ':');
  }
  return false;
}

/* Makes `from` descriptor `to` of the child; negative: /dev/null. */
static void give(posix_spawn_file_actions_t *actions, int from, int to) {
  if (from >= 0)
    posix_spawn_file_actions_adddup2(actions, from, to);
  else
    posix_spawn_file_actions_addopen(actions, to, "/dev/null", O_RDWR, 0);
}

static int spawn(Child *child, const char *program, const char *const *words,
                 const posix_spawn_file_actions_t *actions) {
  posix_spawnattr_t attributes;
  sigset_t none, reset;
  char *copies[CHILD_MAX_WORDS];
  int count = 0;
  for (; words[count] && count < CHILD_MAX_WORDS - 1; count++)
    copies[count] = (char *)words[count];
  copies[count] = NULL;
  sigemptyset(&none);
  sigemptyset(&reset);
  sigaddset(&reset, SIGPIPE);
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  posix_spawnattr_setsigdefault(&attributes, &reset);
  posix_spawnattr_setsigmask(&attributes, &none);
  const int code = posix_spawn(&child->id, program, actions, &attributes, copies, environ);
  posix_spawnattr_destroy(&attributes);
  return code;
}

int child_start(Child *child, const char *program, const char *const *words, int output,
                int further) {
  posix_spawn_file_actions_t actions;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return errno;
  fcntl(ends[1], F_SETFL, O_NONBLOCK);
  child->messages = tmpfile();
  posix_spawn_file_actions_init(&actions);
  give(&actions, ends[0], STDIN_FILENO);
  give(&actions, output, STDOUT_FILENO);
  give(&actions, child->messages ? fileno(child->messages) : -1, STDERR_FILENO);
  if (further >= 0)
    give(&actions, further, 3);
  const int code = spawn(child, program, words, &actions);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);
  child->input = ends[1];
  if (code == 0)
    return 0;
  close(ends[1]);
  child->input = -1;
  if (child->messages)
    fclose(child->messages);
  child->messages = NULL;
  return code;
}

bool child_write(const Child *child, const char *data, size_t size) {
  while (size > 0) {
    struct pollfd ready = {.fd = child->input, .events = POLLOUT};
    if (signals_pending())
      return false;
    if (poll(&ready, 1, CHILD_WAIT) <= 0)
      continue;
    const ssize_t n = write(child->input, data, size);
    if (n < 0 && errno != EAGAIN && errno != EINTR)
      return false;
    data += n > 0 ? n : 0;
    size -= n > 0 ? (size_t)n : 0;
  }
  return true;
}

/* The first or last line that is not empty. */
static void read_message(const Child *child, ChildLine which, char *line, size_t size) {
  char next[300];
  line[0] = 0;
  if (!child->messages)
    return;
  rewind(child->messages);
  while (fgets(next, sizeof next, child->messages)) {
    next[strcspn(next, "\n")] = 0;
    if (next[0] && (which == CHILD_LAST_LINE || !line[0]))
      snprintf(line, size, "%s", next);
  }
}

int child_finish(Child *child, bool abandon, ChildLine which, char *line, size_t size) {
  int status = -1;
  const struct timespec pause = {.tv_nsec = CHILD_WAIT * 1000000L};
  close(child->input); /* the end of its input */
  child->input = -1;
  if (abandon)
    kill(child->id, SIGKILL);
  for (;;) {
    if (signals_pending())
      kill(child->id, SIGKILL);
    const pid_t ended = waitpid(child->id, &status, WNOHANG);
    if (ended == child->id || (ended < 0 && errno != EINTR))
      break;
    nanosleep(&pause, NULL);
  }
  read_message(child, which, line, size);
  if (child->messages)
    fclose(child->messages);
  child->messages = NULL;
  return status;
}

int child_start_apart(pid_t *child, const char *program, char *const *words,
                      const char *messages) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, messages, O_WRONLY | O_CREAT, 0600);
  const int code = posix_spawn(child, program, &actions, NULL, words, environ);
  posix_spawn_file_actions_destroy(&actions);
  return code;
}

void child_first_line(const char *messages, char *line, size_t size) {
  FILE *file = fopen(messages, "r");
  line[0] = 0;
  if (file && !fgets(line, (int)size, file))
    line[0] = 0;
  if (file)
    fclose(file);
  line[strcspn(line, "\n")] = 0;
}

void child_end_text(int status, char *text, size_t size) {
  if (WIFSIGNALED(status))
    snprintf(text, size, "it was ended by signal %d", WTERMSIG(status));
  else
    snprintf(text, size, "it ended with exit code %d", WEXITSTATUS(status));
}
