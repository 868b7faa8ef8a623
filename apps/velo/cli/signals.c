/* cli/signals.c: see signals.h. */
#include "cli/signals.h"

#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "cli/macros.h"
#include "velo/film.h"

enum { MAX_SIGNALS = 2 }; /* after this number of signals, the next one ends the program */
enum { MAX_CONTEXTS = 8 };

static atomic_int pending, count;
static atomic_bool remember, on_terminal, ending;
static _Atomic time_t last; /* time of the last signal that counted, seconds */
static _Atomic(vlContext *) watched[MAX_CONTEXTS];

/* Nobody may read the messages: what a pipe does not take at once is dropped, so that the
 * signal still ends velo. Calls only async-signal-safe functions. */
static void say(const char *text) {
  struct pollfd ready = {.fd = STDERR_FILENO, .events = POLLOUT};
  if (poll(&ready, 1, 0) != 1 || !(ready.revents & POLLOUT))
    return;
  ssize_t ignored = write(STDERR_FILENO, text, strlen(text));
  (void)ignored;
}

/* Ends the program. A further signal returns to this. */
static void end(int code) {
  if (atomic_exchange(&ending, true))
    return;
  for (int i = 0; i < MAX_CONTEXTS; i++)
    vl_remove_unfinished(atomic_exchange(&watched[i], NULL));
  _exit(code);
}

static void handle(int number) {
  if (!remember) {
    if (on_terminal)
      say("\n"); /* ends the line on which the terminal shows ^C */
    say("velo: interrupted; nothing was rendered yet, nothing is written\n");
    end(128 + number);
    return;
  }
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  int none = 0;
  if (atomic_compare_exchange_strong(&pending, &none, number)) {
    last = now.tv_sec;
    count = 1;
  } else if (now.tv_sec > last + 1) {
    last = now.tv_sec;
    if (++count > MAX_SIGNALS)
      end(128 + pending);
  }
}

void signals_install(void) {
  on_terminal = isatty(STDERR_FILENO) != 0;
  static const int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2};
  for (size_t i = 0; i < LENGTH(numbers); i++) {
    struct sigaction action, before;
    memset(&action, 0, sizeof action);
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    action.sa_handler = handle;
    if (sigaction(numbers[i], NULL, &before) == 0 && before.sa_handler == SIG_IGN)
      continue;
    sigaction(numbers[i], &action, NULL);
  }
}

void signals_watch(vlContext *context) {
  for (int i = 0; i < MAX_CONTEXTS; i++) {
    vlContext *none = NULL;
    if (atomic_compare_exchange_strong(&watched[i], &none, context))
      return;
  }
}

void signals_forget(vlContext *context) {
  for (int i = 0; i < MAX_CONTEXTS && context; i++) {
    vlContext *same = context;
    if (atomic_compare_exchange_strong(&watched[i], &same, NULL))
      return;
  }
  while (context && ending)
    pause(); /* the handler, in another thread, uses it */
}

void signals_remember(void) {
  remember = true;
}

int signals_pending(void) {
  return pending;
}

int signals_status(void) {
  return 128 + pending;
}

int signals_count(void) {
  return count;
}
