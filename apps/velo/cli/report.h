/* cli/report.h: everything that velo says on stderr: errors, warnings, notes, the status line of a terminal, and the
 * same as JSON, one object a line. Each message is one line; control characters of strangers' files do not get through.
 * The one place of the program with state of its own. Also: the exit codes. */
#ifndef APP_CLI_REPORT_H
#define APP_CLI_REPORT_H

#include "cli/json.h"
#include "velo/velo.h"

/* What velo returns to the shell; 128 + signal after SIGHUP (129), SIGINT (130), SIGXCPU (152) and SIGTERM (143). */
enum {
  STATUS_OK = 0,      /* done, every file written whole */
  STATUS_OTHER = 1,   /* image diff: over a threshold; anywhere: out of memory */
  STATUS_USAGE = 2,   /* the command line is wrong */
  STATUS_SCENE = 3,   /* a scene or image is wrong */
  STATUS_MISSING = 4, /* a file does not exist: the scene, or one that it names */
  STATUS_IO = 5       /* reading or writing failed: folder, permission, disk full */
};

typedef enum Verbosity { REPORT_QUIET = -1, REPORT_NORMAL = 0, REPORT_VERBOSE = 1 } Verbosity;

void report_setup(bool json, Verbosity verbosity);
/* Out of memory is reported with what the context holds, and with the limit (0: none). Null: no longer. */
void report_memory_of(const vlContext *context, size_t limit);
bool report_is_json(void);
bool report_is_quiet(void);
bool report_is_verbose(void);
/* stderr is a terminal that can redraw a line, and people read it. */
bool report_is_terminal(void);
int report_terminal_columns(void);

/* "velo: message"; all return the exit code, so that `return report_usage(...)` reads well. */
int report_usage(const char *format, ...) __attribute__((format(printf, 1, 2)));
int report_failure(int status, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* "velo: file:line:column: message". `file` stands where the library knows no place; may be null. */
int report_error(const vlError *error, vlResult result, const char *file);
void report_warning(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* Shown unless --quiet; not shown as JSON. */
void report_note(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* The context's log callback. */
void report_log(void *user, vlLogLevel level, const vlError *where, const char *message);
/* The line that is redrawn at the bottom of a terminal; null removes it. */
void report_status_line(const char *text);

/* A JSON line on stderr: begin, json_*(...) calls, end. Only when report_is_json(). */
Json report_json_begin(const char *event);
void report_json_end(Json *json);

#endif
