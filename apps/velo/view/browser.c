/* view/browser.c: see browser.h. */
#include "view/browser.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/report.h"

enum { NO_PROGRAM = 127 };

/* In the process: reads the address until the pipe ends, and becomes xdg-open. */
static void wait_and_open(int from) {
  char address[512];
  size_t size = 0;
  ssize_t got;
  while (size < sizeof address - 1 &&
         (got = read(from, address + size, sizeof address - 1 - size)) > 0)
    size += (size_t)got;
  if (!size)
    _exit(0);
  address[size] = 0;
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  char program[] = "xdg-open";
  char *const words[] = {program, address, NULL};
  execvp(words[0], words);
  _exit(NO_PROGRAM);
}

void browser_prepare(Browser *browser) {
  int ends[2];
  *browser = (Browser){0};
  if ((!getenv("DISPLAY") && !getenv("WAYLAND_DISPLAY")) || pipe(ends) != 0)
    return;
  fcntl(ends[0], F_SETFD, FD_CLOEXEC);
  fcntl(ends[1], F_SETFD, FD_CLOEXEC);
  const pid_t child = fork();
  if (child == 0) {
    close(ends[1]);
    wait_and_open(ends[0]);
  }
  close(ends[0]);
  if (child > 0)
    *browser = (Browser){child, ends[1]};
  else
    close(ends[1]);
}

void browser_open(Browser *browser, const char *address) {
  if (!browser->child)
    return;
  if (address && write(browser->pipe, address, strlen(address)) < 0)
    report_note("open the address in a browser");
  close(browser->pipe);
}

void browser_collect(Browser *browser) {
  int status;
  if (!browser->child || waitpid(browser->child, &status, WNOHANG) != browser->child)
    return;
  browser->child = 0;
  if (WIFEXITED(status) && WEXITSTATUS(status) == NO_PROGRAM)
    report_note("xdg-open is missing: open the address in a browser");
}
