/* cli/report.h: all output of velo on stderr: errors, warnings, notes, the status line of a
 * terminal, and the same as JSON, one object per line. Each message is one line; control
 * characters from files are removed. This is the only part of the program with global state.
 * Also defines the exit codes. */
#ifndef APP_CLI_REPORT_H
#define APP_CLI_REPORT_H

#include "cli/json.h"
#include "cli/macros.h"
#include "velo/base.h"

/* Exit codes of velo. After SIGHUP, SIGINT, SIGUSR1, SIGUSR2, SIGTERM or SIGXCPU: 128 + signal
 * (129, 130, 138, 140, 143, 152). */
enum {
  STATUS_OK = 0,      /* success: every file was written completely */
  STATUS_OTHER = 1,   /* image diff: a threshold was exceeded; any command: out of memory */
  STATUS_USAGE = 2,   /* wrong command line */
  STATUS_SCENE = 3,   /* wrong scene or image */
  STATUS_MISSING = 4, /* a missing file: the scene, or one that it names */
  STATUS_IO = 5       /* reading or writing failed: directory, permission, disk full */
};

/* The first of two exit codes that is no success. */
static inline int first_failure(int first, int second) {
  return first != STATUS_OK ? first : second;
}

typedef enum Verbosity { REPORT_QUIET = -1, REPORT_NORMAL = 0, REPORT_VERBOSE = 1 } Verbosity;

void report_setup(bool json, Verbosity verbosity);
/* Sets the context whose memory use an out-of-memory error reports, and the memory limit in
 * bytes (0: none). A null context: no report of memory use. */
void report_memory_of(const vlContext *context, size_t limit);
bool report_is_json(void);
bool report_is_quiet(void);
bool report_is_verbose(void);
/* Whether stderr is a terminal that can redraw a line and the output is text. */
bool report_is_terminal(void);
int report_terminal_columns(void);

/* Reports "velo: message". All return the exit code, for `return report_usage(...)`. */
int report_usage(const char *format, ...) PRINTF(1, 2);
/* Sets the file that contains the command line: report_usage then names this file and returns
 * STATUS_SCENE. Null: the user's command line. */
void report_usage_of(const char *file);
int report_failure(int status, const char *format, ...) PRINTF(2, 3);
/* The message of an error; where it has none, the name of the result. */
const char *error_text(const vlError *error, vlResult result);
/* Reports "velo: file:line:column: message". `file` is used when the library's error has no
 * location; may be null. VL_OK: nothing is reported, and -1 returned. */
int report_error(const vlError *error, vlResult result, const char *file);
/* The same at the end of a command: VL_OK is STATUS_OK. */
int report_finish(const vlError *error, vlResult result, const char *file);
/* Reports that the memory is exhausted. Returns the exit code. */
int report_no_memory(void);
/* Flushes stdout at the end of a command that prints text. Returns `status`, or STATUS_IO after
 * reporting that it cannot be written. A reader that has seen enough (velo help render | head)
 * is no error. */
int report_stdout(int status);
void report_warning(const char *format, ...) PRINTF(1, 2);
/* Reports a result that has no vlError: "FILE: WHAT: out of memory". Returns the exit code; -1
 * for VL_OK. */
int report_reason(vlResult result, const char *file, const char *what);
/* Reports a note. Prints nothing with --quiet or in JSON mode. */
void report_note(const char *format, ...) PRINTF(1, 2);
/* Receives each error and warning besides stderr. kind: "warning"; null: an error. what:
 * message and location. Called on the thread that reports. */
typedef void ReportFn(void *user, const char *kind, const vlError *what);
/* Sets who receives them; null: nobody. */
void report_listen(ReportFn *listener, void *user);
/* The context's log callback. */
void report_log(void *user, vlLogLevel level, const vlError *where, const char *message);
/* Sets the status line that is redrawn at the bottom of a terminal; null removes it. */
void report_status_line(const char *text);

/* A JSON line on stderr: begin, json_*(...) calls, end. Only when report_is_json(). */
Json *report_json_begin(const char *event);
void report_json_end(Json *json);

#endif
