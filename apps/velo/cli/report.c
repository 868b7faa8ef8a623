/* cli/report.c: see report.h. */
#include "cli/report.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli/macros.h"
#include "cli/signals.h"

enum { MAX_LOGGED = 100 }; /* limit of warnings: an untrusted file may cause one per line */

static struct {
  bool json, terminal, line_shown;
  unsigned logged; /* number of the library's warnings and notes */
  Verbosity verbosity;
  const vlContext *context; /* whose memory use is reported; may be null */
  size_t memory_limit;
  const char *usage_file; /* the file that holds the command line; null: the command line is the
                             user's own */
  Json line;              /* of --log-json, that is begun */
  char *json_text;
  size_t json_size;
  ReportFn *listener;
  void *listener_user;
} state;

void report_listen(ReportFn *listener, void *user) {
  state.listener = listener;
  state.listener_user = user;
}

void report_setup(bool json, Verbosity verbosity) {
  const char *term = getenv("TERM");
  state.json = json;
  state.verbosity = verbosity;
  state.terminal = !json && isatty(STDERR_FILENO) && term && *term && strcmp(term, "dumb") != 0;
}

void report_memory_of(const vlContext *context, size_t limit) {
  state.context = context;
  state.memory_limit = limit;
}

bool report_is_json(void) {
  return state.json;
}

bool report_is_quiet(void) {
  return state.verbosity == REPORT_QUIET;
}

bool report_is_verbose(void) {
  return state.verbosity == REPORT_VERBOSE;
}

bool report_is_terminal(void) {
  return state.terminal;
}

int report_terminal_columns(void) {
  struct winsize size;
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/* Writes to stderr. A signal cannot end a call that blocks, so this waits with poll(): what
 * nobody reads is dropped once the program is asked to stop. */
static void put_bytes(const char *data, size_t size) {
  enum { PIECE = 4096, WAIT_MS = 100, MAX_WAITS = 10 };
  for (int waits = 0; size && waits < MAX_WAITS;) {
    struct pollfd one = {.fd = STDERR_FILENO, .events = POLLOUT};
    int ready = poll(&one, 1, WAIT_MS);
    if (ready <= 0)
      waits += signals_pending() > 0;
    if (ready < 0 && errno != EINTR)
      return;
    if (ready <= 0)
      continue;
    ssize_t n = write(STDERR_FILENO, data, size < PIECE ? size : PIECE);
    if (n < 0 && errno != EINTR && errno != EAGAIN)
      return;
    if (n > 0) {
      data += n;
      size -= (size_t)n;
    }
  }
}

/* Writes one line by one call, so that lines of several programs do not mix. */
static void put_line(const char *text) {
  char line[4096];
  size_t n = 0;
  if (state.line_shown)
    n = (size_t)text_set(line, "\r\033[K");
  state.line_shown = false;
  for (const char *s = text; *s && n + 2 < sizeof line; s++)
    line[n++] =
        (unsigned char)*s < 0x20 || *s == 0x7f ? (*s == '\n' || *s == '\t' ? ' ' : '?') : *s;
  line[n++] = '\n';
  put_bytes(line, n);
}

void report_status_line(const char *text) {
  if (!state.terminal || state.verbosity == REPORT_QUIET || (!text && !state.line_shown))
    return;
  char line[700];
  int n = text_set(line, "\r%s\033[K", text ? text : "");
  put_bytes(line, n < (int)sizeof line ? (size_t)n : sizeof line - 1);
  state.line_shown = text != NULL;
}

Json *report_json_begin(const char *event) {
  FILE *out = open_memstream(&state.json_text, &state.json_size);
  state.line = (Json){.out = out ? out : stderr};
  json_begin(&state.line, NULL, '{');
  json_text(&state.line, "event", event);
  return &state.line;
}

void report_json_end(Json *json) {
  json_close(json);
  if (json->out == stderr)
    return;
  if (fclose(json->out) == 0)
    put_bytes(state.json_text, state.json_size);
  free(state.json_text);
  state.json_text = NULL;
  fflush(stderr);
}

/* kind: "warning", ...; null for errors, whose lines have no prefix word. */
static void say(const char *kind, int status, const vlError *where, const char *fallback_file,
                const char *message) {
  const char *file = where && where->file[0] ? where->file : fallback_file;
  uint32_t line = where && where->file[0] ? where->line : 0, column = line ? where->column : 0;
  if (state.listener) {
    vlError what = {.line = line, .column = column};
    text_set(what.file, "%s", file ? file : "");
    text_set(what.message, "%s", message);
    state.listener(state.listener_user, kind, &what);
  }
  if (state.json) {
    Json *json = report_json_begin(kind ? kind : "error");
    if (!kind)
      json_integer(json, "status", status);
    json_location(json, file, line, column);
    json_text(json, "message", message);
    report_json_end(json);
    return;
  }
  char location[700] = "", text[4096];
  if (file && column)
    text_set(location, "%s:%u:%u: ", file, line, column);
  else if (file && line)
    text_set(location, "%s:%u: ", file, line);
  else if (file)
    text_set(location, "%s: ", file);
  text_set(text, "velo: %s%s%s%s", kind ? kind : "", kind ? ": " : "", location, message);
  put_line(text);
}

void report_usage_of(const char *file) {
  state.usage_file = file;
}

int report_usage(const char *format, ...) {
  FORMATTED(text, format);
  int status = state.usage_file ? STATUS_SCENE : STATUS_USAGE;
  say(NULL, status, NULL, state.usage_file, text);
  return status;
}

int report_failure(int status, const char *format, ...) {
  FORMATTED(text, format);
  say(NULL, status, NULL, NULL, text);
  return status;
}

static int status_of(vlResult result) {
  switch (result) {
    case VL_OK:
    case VL_CANCELLED:
      return STATUS_OK;
    case VL_ERROR_ARGUMENT: /* a value of a file that the library rejects; the command line was
                               checked before */
    case VL_ERROR_SCENE:
    case VL_ERROR_UNSUPPORTED:
      return STATUS_SCENE;
    case VL_ERROR_MISSING:
      return STATUS_MISSING;
    case VL_ERROR_IO:
      return STATUS_IO;
    case VL_ERROR_MEMORY:
      return STATUS_OTHER;
  }
  return STATUS_OTHER;
}

int report_stdout(int status) {
  if (fflush(stdout) == 0 && !ferror(stdout))
    return status;
  struct pollfd out = {.fd = STDOUT_FILENO};
  if (poll(&out, 1, 0) == 1 && out.revents & POLLERR)
    return status; /* the pipe's reader has gone */
  return report_failure(STATUS_IO, "cannot write to stdout");
}

/* "1.0 kB", "12.3 MB" */
static const char *bytes_text(char text[32], size_t bytes) {
  double number = (double)bytes;
  if (number < 1e3)
    snprintf(text, 32, "%.0f bytes", number);
  else if (number < 1e6)
    snprintf(text, 32, "%.1f kB", number * 1e-3);
  else
    snprintf(text, 32, "%.1f MB", number * 1e-6);
  return text;
}

const char *error_text(const vlError *error, vlResult result) {
  return error->message[0] ? error->message : vl_result_name(result);
}

int report_error(const vlError *error, vlResult result, const char *file) {
  const int status = status_of(result);
  const char *message = error ? error_text(error, result) : vl_result_name(result);
  char longer[700];
  if (result == VL_OK)
    return -1;
  if (result == VL_ERROR_MEMORY && state.context) {
    size_t peak;
    vl_context_memory(state.context, &peak);
    char bytes[32];
    int n = text_set(longer, "%s", message);
    if (peak)
      n = text_set(longer, "%s; at most %s were held", message, bytes_text(bytes, peak));
    if (state.memory_limit && n > 0 && n < (int)sizeof longer)
      snprintf(longer + n, sizeof longer - (size_t)n, "%s --max-memory allows %s",
               peak ? "," : ";", bytes_text(bytes, state.memory_limit));
    message = longer;
  }
  /* Messages about files that cannot be opened already name them. */
  if (file && strstr(message, file))
    file = NULL;
  say(NULL, status, error, file, message);
  return status;
}

int report_no_memory(void) {
  return report_error(NULL, VL_ERROR_MEMORY, NULL);
}

int report_finish(const vlError *error, vlResult result, const char *file) {
  return result == VL_OK ? STATUS_OK : report_error(error, result, file);
}

int report_reason(vlResult result, const char *file, const char *what) {
  vlError error = {0};
  if (result == VL_ERROR_ARGUMENT)
    text_set(error.message, "%s", what);
  else
    text_set(error.message, "%s: %s", what, vl_result_name(result));
  return report_error(&error, result, file);
}

void report_warning(const char *format, ...) {
  FORMATTED(text, format);
  say("warning", 0, NULL, NULL, text);
}

void report_note(const char *format, ...) {
  FORMATTED(text, format);
  if (state.verbosity == REPORT_QUIET || state.json)
    return;
  char line[2100];
  text_set(line, "velo: %s", text);
  put_line(line);
}

void report_log(UNUSED void *user, vlLogLevel level, const vlError *where,
                const char *message) {
  if (level == VL_LOG_INFO && state.verbosity == REPORT_QUIET)
    return;
  if (level >= VL_LOG_DEBUG && state.verbosity != REPORT_VERBOSE)
    return;
  if (level > VL_LOG_ERROR && state.verbosity != REPORT_VERBOSE &&
      state.logged++ >= MAX_LOGGED) {
    if (state.logged == MAX_LOGGED + 1)
      report_warning("%d warnings and notes are enough: more are not shown", MAX_LOGGED);
    return;
  }
  static const char *const kinds[] = {"error", "warning", "note", "debug"};
  say(kinds[level <= VL_LOG_DEBUG ? level : VL_LOG_DEBUG], 0, where, NULL, message);
}
