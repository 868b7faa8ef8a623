/* view/view_run.c: runs `velo view`: loads the scene, starts server and render thread, and
 * waits for Ctrl-C. */
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/confine.h"
#include "cli/context.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/film_claim.h"
#include "render/job.h"
#include "render/output_names.h"
#include "sensor/sensor.h"
#include "view/engine.h"
#include "view/lecture.h"
#include "view/private_file.h"
#include "view/view.h"

/* A process that waits for the address, made before this one is confined (cli/confine.h). {0}:
 * none. */
typedef struct Browser {
  pid_t child;
  int pipe;
} Browser;

/* Exit codes of the process. */
enum { NO_PROGRAM = 127, NO_FILE = 126 };

static const int ignored[] = {SIGINT, SIGHUP, SIGQUIT, SIGTERM};

static void handle_signals(void (*handler)(int)) {
  for (size_t i = 0; i < LENGTH(ignored); i++)
    signal(ignored[i], handler);
}

/* ---- in the process ---------------------------------------------------------------------- */

/* Writes a page that leads to the address, readable by its owner only. The token of the address
 * would be seen by other users of the machine in the arguments of a program. */
static bool write_page(const char *address, char path[PRIVATE_PATH]) {
  static const char format[] =
      "<!doctype html>\n"
      "<html lang=\"en\">\n"
      "<meta charset=\"utf-8\">\n"
      "<title>velo</title>\n"
      "<meta http-equiv=\"refresh\" content=\"0;url=%s\">\n"
      "<p><a href=\"%s\">velo view</a></p>\n"
      "</html>\n";
  FILE *out = private_file_make(path);
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

/* Makes the process where there is a display; to be called before threads start. */
static void browser_prepare(Browser *browser) {
  int ends[2];
  *browser = (Browser){0};
  if ((!getenv("DISPLAY") && !getenv("WAYLAND_DISPLAY")) || pipe2(ends, O_CLOEXEC) != 0)
    return;
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

/* Lets it open the address. What is {0} stays so. */
static void browser_open(Browser *browser, const char *address) {
  if (browser->child &&
      (write(browser->pipe, address, strlen(address)) < 0 || write(browser->pipe, "\n", 1) < 0))
    report_note("open the address in a browser");
}

/* Collects the process when it has ended early, and says why, such as that there is no
 * xdg-open. */
static void browser_collect(Browser *browser) {
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

/* Ends the process, which removes the file. */
static void browser_end(Browser *browser) {
  if (!browser->child)
    return;
  close(browser->pipe);
  waitpid(browser->child, NULL, 0);
  browser->child = 0;
}

/* The line for the user's own machine, where this one was reached by ssh. */
static void tell_tunnel(const Server *server) {
  const char *connection = getenv("SSH_CONNECTION"), *user = getenv("USER");
  char host[64] = "HOST";
  if (!connection)
    return;
  sscanf(connection, "%*s %*s %63s", host);
  report_note("on your own machine: ssh -N -L %d:127.0.0.1:%d %s%s%s", server_port(server),
              server_port(server), user ? user : "", user ? "@" : "", host);
}

static int open_context(const Arguments *arguments, vlContext **context) {
  vlContextDef def = scene_context_def(arguments);
  TRY(context_open(&def, context));
  report_memory_of(*context, def.max_memory);
  return -1;
}

static void wait_for_end(Browser *browser) {
  const struct timespec pause = {.tv_nsec = 20000000};
  while (!signals_pending()) {
    nanosleep(&pause, NULL);
    browser_collect(browser);
  }
}

static int open_server(const Arguments *arguments, Server **server) {
  const OptionValue *v = arguments->values;
  const bool lecture = v[VIEW_LECTURE].given;
  const ServerDef def = {.address = v[VIEW_LISTEN].text,
                         .port = (int)v[VIEW_PORT].integer,
                         .home = lecture ? "lecture.html" : "index.html",
                         .query = lecture ? lecture_query(arguments) : "",
                         .steering = true};
  return server_open(&def, server);
}

/* --sandbox: what the page reads and writes besides the files of the scene. The folders of its
 * inputs are read, since an editor replaces a file that it changes by another one. Cameras and
 * images are saved in the current folder. */
static void confine(const Arguments *arguments) {
  static const int inputs[] = {RENDER_CAMERA, RENDER_TRAJECTORY, RENDER_ENVIRONMENT};
  const OptionValue *v = arguments->values;
  Confine c = {.listens = true};
  if (arguments->operand_count)
    confine_read_folder(&c, arguments->operands[0]);
  for (size_t i = 0; i < LENGTH(inputs); i++)
    confine_read_folder(&c, v[inputs[i]].text);
  if (v[VIEW_EXPOSE].given && sensor_is_file(v[VIEW_EXPOSE].text))
    confine_read_folder(&c, v[VIEW_EXPOSE].text);
  confine_write(&c, "saved.exr");
  confine_write(&c, v[RENDER_FILM].text);
  confine_apply(&c, arguments);
}

/* Locks the file of --film, which must not be there already. Returns -1 or the exit code. */
static int claim_film(FilmClaim *claim, vlContext *context, const Arguments *arguments) {
  const char *path = arguments->values[RENDER_FILM].text;
  const bool overwrite = arguments->values[RENDER_OVERWRITE].given;
  char camera[4200];
  TRY(film_claim_check(overwrite, path, NULL));
  if (!path)
    return -1;
  TRY(film_claim(claim, context, path, "", overwrite));
  if (overwrite)
    return -1;
  engine_film_camera(path, camera, sizeof camera);
  if (claim->earlier)
    return film_claim_refuse("%s is a film already", path);
  return access(camera, F_OK) == 0
             ? film_claim_refuse("%s, where its camera is written, is there already", camera)
             : -1;
}

/* Checks the names of the film and of the camera beside it (engine_film.c). */
static int check_film(vlContext *context, const char *path) {
  char camera[4200];
  OutputNames names = {0};
  engine_film_camera(path, camera, sizeof camera);
  output_names_add(&names, path, VL_OUTPUT_FILM);
  output_names_add(&names, camera, VL_OUTPUT_PLAIN);
  return output_names_check(&names, context);
}

int view_run(const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  Engine *engine = NULL;
  Server *server = NULL;
  Browser browser = {0};
  FilmClaim claim = {.lock = NULL};
  report_setup(false, v[RENDER_QUIET].given ? REPORT_QUIET : REPORT_NORMAL);
  bool lecture = v[VIEW_LECTURE].given;
  EngineDef def = {.path = lecture ? lecture_first_scene : arguments->operands[0],
                   .lecture = lecture,
                   .arguments = arguments,
                   .film_path = v[RENDER_FILM].text};
  if (!v[VIEW_NO_OPEN].given)
    browser_prepare(&browser);
  int status = open_server(arguments, &server);
  if (status < 0)
    confine(arguments);
  if (status < 0)
    status = open_context(arguments, &def.context);
  if (status < 0)
    status = claim_film(&claim, def.context, arguments);
  def.film_lock = claim.lock;
  if (status < 0)
    status = engine_create(&def, &engine);
  if (status < 0 && def.film_path)
    status = check_film(def.context, def.film_path);
  if (status < 0) {
    const ServerCalls calls = engine_calls(engine);
    signals_remember();
    status = engine_start(engine, server);
    if (status < 0)
      status = server_start(server, &calls);
  }
  if (status < 0) {
    if (v[VIEW_LISTEN].given)
      report_warning(
          "--listen %s: whoever reaches this address and knows the token sees and steers the "
          "scene; the connection is not encrypted",
          v[VIEW_LISTEN].text);
    printf("%s\n", server_address(server));
    fflush(stdout);
    tell_tunnel(server);
    report_note("Ctrl-C ends it");
    browser_open(&browser, server_address(server));
    wait_for_end(&browser);
    status = STATUS_OK;
  }
  browser_end(&browser);
  int stopped = engine ? engine_stop(engine) : STATUS_OK;
  server_stop(server);
  engine_destroy(engine);
  film_claim_release(&claim);
  report_memory_of(NULL, 0);
  context_close(def.context);
  return status == STATUS_OK ? stopped : status;
}
