/* cli/signals.c: see signals.h. */
#include "cli/signals.h"

#include <signal.h>
#include <string.h>
#include <unistd.h>

static volatile sig_atomic_t pending, remember;

/* Only calls that are safe in a handler. */
static void say(const char *text) {
  ssize_t n = write(STDERR_FILENO, text, strlen(text));
  (void)n;
}

static void handle(int number) {
  if (!remember) {
    say("\nvelo: interrupted; nothing was rendered yet, nothing is written\n");
    _exit(128 + number);
  }
  if (pending) _exit(128 + number);
  pending = number;
}

void signals_install(void) {
  struct sigaction action;
  memset(&action, 0, sizeof action);
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  action.sa_handler = handle;
  /* Also where the shell had SIGINT ignored (background jobs of scripts): who sends it, means it. */
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

void signals_remember(void) {
  remember = 1;
}

int signals_pending(void) {
  return pending;
}
