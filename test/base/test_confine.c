/* test/base/test_confine.c: vl_confine: what a confined process can open and start. Each case
 * confines a child, which tries and reports by its exit code. */
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/prctl.h>
#endif

#include "unit.h"
#include "velo/confine.h"

extern char **environ;

static char folder[64] = "/tmp/velo-confine-XXXXXX";

static const char *in_folder(const char *name) {
  static char paths[4][128];
  static int next;
  char *path = paths[next++ % 4];
  snprintf(path, sizeof paths[0], "%s/%s", folder, name);
  return path;
}

static void put(const char *name) {
  int fd = open(in_folder(name), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  assert_true(fd >= 0);
  assert_int_equal(write(fd, "text", 4), 4);
  close(fd);
}

static int set_up(void **state) {
  (void)state;
  if (!mkdtemp(folder) || mkdir(in_folder("in"), 0700) || mkdir(in_folder("out"), 0700) ||
      mkdir(in_folder("no"), 0700))
    return -1;
  put("in/file");
  put("out/old");
  put("no/file");
  put("given");
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command);
}

static bool reads(const char *name) {
  int fd = open(in_folder(name), O_RDONLY | O_CLOEXEC);
  if (fd >= 0)
    close(fd);
  return fd >= 0;
}

static bool writes(const char *name) {
  int fd = open(in_folder(name), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (fd >= 0)
    close(fd);
  return fd >= 0;
}

static bool opens_socket(int domain) {
  int fd = socket(domain, SOCK_STREAM, 0);
  if (fd >= 0)
    close(fd);
  return fd >= 0 || errno != EPERM;
}

/* Whether another program starts, in a process of its own. */
static bool starts_program(void) {
  char *const words[] = {"true", NULL};
  int status = 0;
  pid_t child = fork();
  if (child == 0) {
    execve("/bin/true", words, environ);
    _exit(errno == EPERM || errno == EACCES ? 77 : 1);
  }
  return waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 77;
}

enum {
  READS_IN = 1 << 0,
  READS_GIVEN = 1 << 1,
  READS_NO = 1 << 2,
  WRITES_OUT = 1 << 3,
  RENAMES_OUT = 1 << 4,
  WRITES_IN = 1 << 5,
  OPENS_SOCKET = 1 << 6,
  STARTS = 1 << 7,
  READS_STATM = 1 << 8
};

static unsigned tried(void) {
  unsigned could = 0;
  if (reads("in/file"))
    could |= READS_IN;
  if (reads("given"))
    could |= READS_GIVEN;
  if (reads("no/file") || reads("no"))
    could |= READS_NO;
  if (writes("out/new"))
    could |= WRITES_OUT;
  if (rename(in_folder("out/new"), in_folder("out/old")) == 0)
    could |= RENAMES_OUT;
  if (writes("in/file") || writes("in/new") || unlink(in_folder("in/file")) == 0)
    could |= WRITES_IN;
  if (opens_socket(AF_INET) || opens_socket(AF_UNIX))
    could |= OPENS_SOCKET;
  if (starts_program())
    could |= STARTS;
  /* where there is one, the library reads it for the size of the memory */
  if (access("/proc/self/statm", F_OK) != 0 ||
      open("/proc/self/statm", O_RDONLY | O_CLOEXEC) >= 0)
    could |= READS_STATM;
  return could;
}

static void *try_on_thread(void *result) {
  *(unsigned *)result = tried();
  return NULL;
}

typedef struct Answer {
  vlConfined done;
  unsigned could;
} Answer;

/* Confines a child process and returns what it could do, on its main thread or on a thread made
 * after. */
static Answer confined(bool sockets, bool thread) {
  Answer answer = {0};
  int ends[2], status;
  assert_int_equal(pipe(ends), 0);
  pid_t child = fork();
  if (child == 0) {
    const char *const read_paths[] = {in_folder("in"), in_folder("given"),
                                      in_folder("missing")};
    const char *const write_paths[] = {in_folder("out/image_%04d.exr")};
    answer.done = vl_confine(read_paths, 3, write_paths, 1, sockets);
    pthread_t other;
    if (!thread)
      answer.could = tried();
    else if (pthread_create(&other, NULL, try_on_thread, &answer.could) == 0)
      pthread_join(other, NULL);
    _exit(write(ends[1], &answer, sizeof answer) == sizeof answer ? 0 : 1);
  }
  close(ends[1]);
  assert_int_equal(read(ends[0], &answer, sizeof answer), sizeof answer);
  close(ends[0]);
  assert_int_equal(waitpid(child, &status, 0), child);
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  return answer;
}

static void check_answer(const Answer *a, bool sockets) {
  const unsigned always = READS_IN | READS_GIVEN | WRITES_OUT | RENAMES_OUT | READS_STATM;
  print_message("files %d (Landlock %u), network %d, programs %d\n", a->done.files,
                a->done.landlock, a->done.network, a->done.programs);
  assert_int_equal(a->could & always, always);
  if (a->done.files)
    assert_int_equal(a->could & (READS_NO | WRITES_IN), 0);
  assert_int_equal(!(a->could & OPENS_SOCKET), a->done.network);
  assert_int_equal(!(a->could & STARTS), a->done.programs);
  assert_false(sockets && a->done.network);
  assert_int_equal(a->done.files, a->done.landlock > 0);
}

static void test_confined(void **state) {
  (void)state;
  const Answer a = confined(false, false);
  check_answer(&a, false);
}

static void test_threads_made_after(void **state) {
  (void)state;
  const Answer a = confined(false, true);
  check_answer(&a, false);
}

static void test_sockets_of_a_server(void **state) {
  (void)state;
  const Answer a = confined(true, false);
  check_answer(&a, true);
}

/* Linux on these processors has seccomp, unless an outer sandbox forbids it. */
static void test_seccomp_is_there(void **state) {
  (void)state;
#if defined(__linux__) && (defined(__x86_64__) || defined(__aarch64__))
  const Answer a = confined(false, false);
  if (prctl(PR_GET_SECCOMP) < 0)
    skip(); /* a kernel, or an emulator, without it */
  assert_true(a.done.network && a.done.programs);
#else
  skip();
#endif
}

/* Skipped where the kernel has no Landlock. */
static void test_landlock(void **state) {
  (void)state;
  const Answer a = confined(false, false);
  if (!a.done.files) {
    print_message("skip: this kernel has no Landlock\n");
    skip();
  }
  assert_int_equal(a.could, READS_IN | READS_GIVEN | WRITES_OUT | RENAMES_OUT | READS_STATM);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_landlock), cmocka_unit_test(test_seccomp_is_there),
      cmocka_unit_test(test_confined), cmocka_unit_test(test_threads_made_after),
      cmocka_unit_test(test_sockets_of_a_server)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
