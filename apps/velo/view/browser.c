/* view/browser.c: see browser.h. */
#include "view/browser.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/report.h"
#include "view/private_file.h"

/* Exit codes of the process. */
enum { NO_PROGRAM = 127, NO_FILE = 126 };

static const int ignored[] = {SIGINT, SIGHUP, SIGQUIT, SIGTERM};

static void handle_signals(void (*handler)(int)) {
  for (size_t i = 0; i < sizeof ignored / sizeof *ignored; i++)
    signal(ignored[i], handler);
}

/* ---- in the process ---------------------------------------------------------------------- */

/* Writes a page that leads to the address, readable by its owner only. The token of the address
 * would be seen by other users of the machine in the arguments of a program. */
static bool write_page(const char *address, char path[PRIVATE_PATH]) {
  static const char format[] =
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>velo</title>\n"
      "<meta http-equiv=\"refresh\" content=\"0;url=%s\">\n<p><a href=\"%s\">velo "
      "view</a></p>\n</html>\n";
  FILE *out = private_file_make("velo-view-", ".html", path);
  if (!out)
    return false;
  bool good = fprintf(out, format, address, address) > 0;
  good &= fclose(out) == 0;
  if (!good)
    unlink(path);
  return good;
}

static pid_t start_program(char *path) {
  const pid_t child = fork();
  if (child != 0)
    return child;
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  handle_signals(SIG_DFL);
  char program[] = "xdg-open";
  char *const words[] = {program, path, NULL};
  execvp(words[0], words);
  _exit(NO_PROGRAM);
}

/* Reads the address, which a line feed ends. False: there is none. */
static bool read_address(int from, char *address, size_t size) {
  size_t got = 0;
  while (got + 1 < size && read(from, address + got, 1) == 1) {
    if (address[got] == '\n') {
      address[got] = 0;
      return true;
    }
    got++;
  }
  return false;
}

/* Opens the page; removes it when velo ends, which closes the pipe. */
static void wait_and_open(int from) {
  char address[512], path[PRIVATE_PATH];
  if (!read_address(from, address, sizeof address))
    _exit(0);
  if (!write_page(address, path))
    _exit(NO_FILE);
  handle_signals(SIG_IGN); /* Ctrl-C in the terminal reaches this process, too */
  pid_t program = start_program(path);
  struct pollfd end = {.fd = from, .events = POLLIN};
  int status = 0;
  while (poll(&end, 1, program > 0 ? 100 : -1) <= 0)
    if (program > 0 && waitpid(program, &status, WNOHANG) == program) {
      program = 0;
      if (WIFEXITED(status) && WEXITSTATUS(status) == NO_PROGRAM)
        break;
    }
  unlink(path);
  _exit(WIFEXITED(status) && WEXITSTATUS(status) == NO_PROGRAM ? NO_PROGRAM : 0);
}

/* ---- in velo ----------------------------------------------------------------------------- */

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
  if (browser->child &&
      (write(browser->pipe, address, strlen(address)) < 0 || write(browser->pipe, "\n", 1) < 0))
    report_note("open the address in a browser");
}

void browser_collect(Browser *browser) {
  int status;
  if (!browser->child || waitpid(browser->child, &status, WNOHANG) != browser->child)
    return;
  browser->child = 0;
  close(browser->pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) == NO_PROGRAM)
    report_note("xdg-open is missing: open the address in a browser");
  if (WIFEXITED(status) && WEXITSTATUS(status) == NO_FILE)
    report_note("no file that leads a browser to the page can be written: open the address");
}

void browser_end(Browser *browser) {
  if (!browser->child)
    return;
  close(browser->pipe);
  waitpid(browser->child, NULL, 0);
  browser->child = 0;
}
