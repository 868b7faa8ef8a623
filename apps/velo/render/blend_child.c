/* render/blend_child.c: see blend_child.h. Blender's Python runs PROGRAM, which finds the
 * add-on and hands over to it. The words behind "--" are the folder of velo's Python module and
 * that of the add-on (empty: Blender finds it), the version of velo, then the words of
 * headless.py. */
#include "render/blend_child.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/job.h"
#include "render/noise.h"

enum { PATH_SIZE = 4096, WORD_SIZE = 64 };

static const char PROGRAM[] =
    "import os, sys\n"
    "words = sys.argv[sys.argv.index('--') + 1:]\n"
    "folders = words[:2] + os.environ.get('PYTHONPATH', '').split(os.pathsep)\n"
    "sys.path[:0] = [folder for folder in folders if folder]\n"
    "try:\n"
    "    from velo_blender import headless\n"
    "except ImportError as error:\n"
    "    text = ' '.join(('the add-on velo_blender is not installed in Blender (%s)' % "
    "error).split())\n"
    "    os.write(3, ('error\\t4\\t' + text + '\\n"
    "').encode())\n"
    "    os._exit(0)\n"
    "headless.main(words[2:])\n";

/* ---- where things are -------------------------------------------------------------------- */

/* The folder `name` beside the folder of the running program (bin): of an installed velo or of
 * a build. path is empty if there is no file `inside` in it. */
static void find_beside_program(const char *name, const char *inside, char *path, size_t size) {
  char program[PATH_SIZE];
  const ssize_t n = readlink("/proc/self/exe", program, sizeof program - 1);
  program[n > 0 ? n : 0] = 0;
  for (int i = 0; i < 2 && *program; i++) {
    char *slash = strrchr(program, '/');
    *(slash ? slash : program) = 0;
  }
  const bool fits = snprintf(path, size, "%s/%s/%s", program, name, inside) < (int)size;
  const bool there = fits && access(path, R_OK) == 0;
  /* cuts "/" and `inside` off, or everything */
  path[there ? strlen(path) - strlen(inside) - 1 : 0] = 0;
}

/* ---- what Blender tells ------------------------------------------------------------------ */

/* Takes the next word of a line: up to a tab. */
static char *next_word(char **line) {
  char *word = *line, *tab = strchr(word, '\t');
  *line = tab ? tab + 1 : word + strlen(word);
  if (tab)
    *tab = 0;
  return word;
}

static long next_number(char **line) {
  return strtol(next_word(line), NULL, 10);
}

/* An event that ends a wait. */
typedef enum BlenderEvent { EVENT_NONE, EVENT_SCENE, EVENT_DONE, EVENT_ERROR } BlenderEvent;

/* Follows one line of headless.py: an event and its values, separated by tabs. */
static BlenderEvent take_line(Blender *b, char *line) {
  const char *kind = next_word(&line);
  if (strcmp(kind, "warning") == 0)
    report_warning("%s: %s", b->scene, line);
  if (strcmp(kind, "progress") == 0 && b->shown)
    progress_show_frames(b->shown, b->number, strtod(line, NULL));
  if (strcmp(kind, "scene") == 0) {
    text_set(b->version, "%s", next_word(&line));
    b->first = next_number(&line);
    b->last = next_number(&line);
    return EVENT_SCENE;
  }
  if (strcmp(kind, "done") == 0) {
    b->width = next_number(&line);
    b->height = next_number(&line);
    b->spp = next_number(&line);
    return EVENT_DONE;
  }
  if (strcmp(kind, "error") == 0) {
    const long code = next_number(&line);
    b->failed = code >= STATUS_OTHER && code <= STATUS_IO ? (int)code : STATUS_OTHER;
    report_failure(b->failed, "%s%s%s", code == STATUS_USAGE ? "" : b->scene,
                   code == STATUS_USAGE ? "" : ": ", line);
    return EVENT_ERROR;
  }
  return EVENT_NONE;
}

/* Takes the whole lines that were read, up to the first one whose event ends a wait. Returns
 * that event; EVENT_NONE: there was none. */
static BlenderEvent take_lines(Blender *b) {
  BlenderEvent event = EVENT_NONE;
  char *end;
  while (event == EVENT_NONE && (end = memchr(b->held, '\n', b->held_count))) {
    *end = 0;
    char line[sizeof b->held];
    text_set(line, "%s", b->held);
    b->held_count -= (size_t)(end + 1 - b->held);
    memmove(b->held, end + 1, b->held_count);
    event = take_line(b, line);
  }
  if (b->held_count == sizeof b->held)
    b->held_count = 0; /* no line of headless.py is that long */
  return event;
}

/* Reports how Blender ended before it had done what it was asked for. */
static int report_end(Blender *b) {
  char line[300], ended[100];
  const int status = child_finish(&b->child, true, CHILD_LAST_LINE, line, sizeof line);
  b->runs = false;
  if (signals_pending())
    return signals_status();
  child_end_text(status, ended, sizeof ended);
  return report_failure(STATUS_IO, "%s: Blender did not render it: %s%s%s", b->scene, ended,
                        line[0] ? "; " : "", line);
}

/* Waits for an event. Returns -1, or the exit code after reporting the error. */
static int wait_for(Blender *b, BlenderEvent wanted) {
  for (;;) {
    const BlenderEvent event = take_lines(b);
    if (event == EVENT_ERROR)
      return b->failed;
    if (event == wanted)
      return -1;
    if (signals_pending())
      return signals_status();
    struct pollfd ready = {.fd = b->events, .events = POLLIN};
    if (poll(&ready, 1, CHILD_WAIT) <= 0)
      continue;
    const ssize_t n = read(b->events, b->held + b->held_count, sizeof b->held - b->held_count);
    if (n > 0)
      b->held_count += (size_t)n;
    else if (n == 0 || (errno != EINTR && errno != EAGAIN))
      return report_end(b);
  }
}

/* ---- what Blender is asked --------------------------------------------------------------- */

/* The words of the options that the add-on follows: "spp=64". */
typedef struct Words {
  const char *list[CHILD_MAX_WORDS];
  int count;
  char texts[16][WORD_SIZE];
  int text_count;
  char camera[PATH_SIZE + 16], frame[PATH_SIZE + 16];
} Words;

static void add_word(Words *words, const char *word) {
  if (words->count < CHILD_MAX_WORDS - 1)
    words->list[words->count++] = word;
}

PRINTF(2, 3) static void add_text(Words *words, const char *format, ...) {
  va_list values;
  char *text = words->texts[words->text_count++];
  va_start(values, format);
  vsnprintf(text, WORD_SIZE, format, values);
  va_end(values);
  add_word(words, text);
}

static void add_options(Words *words, const OptionValue *v) {
  static const struct {
    int id;
    const char *name;
  } numbers[] = {{RENDER_SPP, "spp"},
                 {RENDER_SEED, "seed"},
                 {RENDER_MAX_DEPTH, "max-depth"},
                 {RENDER_THREADS, "threads"}};
  const int64_t *crop = v[RENDER_CROP].integers, *size = v[RENDER_RESOLUTION].integers;
  for (size_t i = 0; i < LENGTH(numbers); i++)
    if (v[numbers[i].id].given)
      add_text(words, "%s=%lld", numbers[i].name, (long long)v[numbers[i].id].integer);
  if (v[RENDER_NOISE].given)
    add_text(words, "noise=%.9g", noise_threshold(v[RENDER_NOISE].text));
  if (v[RENDER_COLOR].given)
    add_text(words, "color=%s", v[RENDER_COLOR].text);
  if (v[RENDER_RESOLUTION].given)
    add_text(words, "resolution=%lld,%lld", (long long)size[0], (long long)size[1]);
  if (v[RENDER_CROP].given)
    add_text(words, "crop=%lld,%lld,%lld,%lld", (long long)crop[0], (long long)crop[1],
             (long long)crop[2], (long long)crop[3]);
  if (v[RENDER_TRANSPARENT].given)
    add_word(words, "transparent=1");
  if (v[RENDER_HALF].given)
    add_word(words, "half=1");
  text_set(words->camera, "camera=%s", v[RENDER_CAMERA].given ? v[RENDER_CAMERA].text : "");
  text_set(words->frame, "frame=%s", v[RENDER_FRAME].given ? v[RENDER_FRAME].text : "");
  add_word(words, words->camera);
  add_word(words, words->frame);
}

/* The suffixes of the outputs, behind a word that says how many there are. */
static void add_outputs(Words *words, const Arguments *arguments) {
  for (int i = 0; i < arguments->text_count; i++)
    add_word(words, output_dot(arguments->texts[i]));
}

static int start(Blender *b, const Words *words) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return report_failure(STATUS_IO, "%s: %s", b->program, strerror(errno));
  const int output = report_is_verbose() ? STDERR_FILENO : -1;
  const int code = child_start(&b->child, b->program, words->list, output, ends[1]);
  close(ends[1]);
  b->events = ends[0];
  b->runs = code == 0;
  return code == 0 ? -1 : report_failure(STATUS_IO, "%s: %s", b->program, strerror(code));
}

int blender_open(Blender *b, const char *scene, const Arguments *arguments) {
  Words words = {.count = 0};
  char module[PATH_SIZE], addons[PATH_SIZE];
  *b = (Blender){.events = -1, .scene = scene};
  if (!child_find(getenv("PATH"), "blender", b->program, sizeof b->program))
    return report_failure(STATUS_MISSING,
                          "%s: Blender is not installed, and it reads .blend files (blender in "
                          "PATH); export the scene as glTF",
                          scene);
  find_beside_program("python", "velo/__init__.py", module, sizeof module);
  find_beside_program("share/blender/scripts/addons", "velo_blender/headless.py", addons,
                      sizeof addons);
  const char *const first[] = {"blender",
                               "-b",
                               "-noaudio",
                               "--factory-startup",
                               "--disable-autoexec",
                               "--python-exit-code",
                               "9",
                               "--python-expr",
                               PROGRAM,
                               "--",
                               module,
                               addons,
                               vl_version()->text,
                               scene};
  for (size_t i = 0; i < LENGTH(first); i++)
    add_word(&words, first[i]);
  add_outputs(&words, arguments);
  add_word(&words, "--");
  add_options(&words, arguments->values);
  TRY(start(b, &words));
  return wait_for(b, EVENT_SCENE);
}

int blender_frame(Blender *b, const uint32_t *frame, const char *const *paths, int count) {
  char number[16] = "";
  if (frame)
    text_set(number, "%u", *frame);
  bool taken = child_write(&b->child, number, strlen(number) + 1);
  for (int i = 0; i < count && taken; i++)
    taken = child_write(&b->child, paths[i], strlen(paths[i]) + 1);
  return taken ? wait_for(b, EVENT_DONE) : report_end(b);
}

void blender_close(Blender *b) {
  char line[300];
  if (b->runs)
    child_finish(&b->child, b->failed || signals_pending(), CHILD_LAST_LINE, line, sizeof line);
  b->runs = false;
  if (b->events >= 0)
    close(b->events);
  b->events = -1;
}
