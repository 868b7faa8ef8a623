/* view/view_run.c: runs `velo view`: loads the scene, starts server and render thread, and waits for Ctrl-C. */
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cli/context.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/film_claim.h"
#include "render/job.h"
#include "render/output_names.h"
#include "view/engine.h"
#include "view/lecture.h"
#include "view/view.h"

/* Opens the page where there is a display. */
static void open_browser(const char *address) {
  if (!getenv("DISPLAY") && !getenv("WAYLAND_DISPLAY")) return;
  char *const words[] = {"xdg-open", (char *)(uintptr_t)address, NULL};
  posix_spawn_file_actions_t actions;
  pid_t child;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", 1 /* O_WRONLY */, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", 1 /* O_WRONLY */, 0);
  if (posix_spawnp(&child, words[0], &actions, NULL, words, environ) != 0)
    report_note("xdg-open is missing: open the address in a browser");
  posix_spawn_file_actions_destroy(&actions);
}

/* The line for the user's own machine, where this one was reached by ssh. */
static void tell_tunnel(const Server *server) {
  const char *connection = getenv("SSH_CONNECTION"), *user = getenv("USER");
  char host[64] = "HOST";
  if (!connection) return;
  sscanf(connection, "%*s %*s %63s", host);
  report_note("on your own machine: ssh -N -L %d:127.0.0.1:%d %s%s%s", server_port(server), server_port(server),
              user ? user : "", user ? "@" : "", host);
}

static int open_context(const Arguments *arguments, vlContext **context) {
  const OptionValue *v = arguments->values;
  vlContextDef def = vl_default_context_def();
  def.log = report_log;
  if (v[RENDER_THREADS].given) def.threads = (uint32_t)v[RENDER_THREADS].integer;
  if (v[RENDER_MAX_MEMORY].given) def.max_memory = (size_t)v[RENDER_MAX_MEMORY].integer;
  def.sandbox = arguments->folders, def.sandbox_count = (uint32_t)arguments->folder_count;
  int status = context_open(&def, context);
  if (status < 0) report_memory_of(*context, def.max_memory);
  return status;
}

static void wait_for_end(void) {
  const struct timespec pause = {.tv_nsec = 20000000};
  while (!signals_pending()) {
    nanosleep(&pause, NULL);
    waitpid(-1, NULL, WNOHANG); /* xdg-open */
  }
}

/* Locks the file of --film, which must not be there already. Returns -1 or the exit code. */
static int claim_film(FilmClaim *claim, vlContext *context, const Arguments *arguments) {
  const char *path = arguments->values[RENDER_FILM].text;
  const bool overwrite = arguments->values[RENDER_OVERWRITE].given;
  char camera[4200];
  int status = film_claim_check(overwrite, path, NULL);
  if (status >= 0 || !path) return status;
  status = film_claim(claim, context, path, "", overwrite);
  if (status >= 0 || overwrite) return status;
  engine_film_camera(path, camera, sizeof camera);
  if (claim->earlier) return film_claim_refuse("%s is a film already", path);
  return access(camera, F_OK) == 0 ? film_claim_refuse("%s, where its camera is written, is there already", camera)
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
  vlContext *context = NULL;
  Engine *engine = NULL;
  Server *server = NULL;
  FilmClaim claim = {.lock = NULL};
  report_setup(false, v[RENDER_QUIET].given ? REPORT_QUIET : REPORT_NORMAL);
  bool lecture = v[VIEW_LECTURE].given;
  const EngineDef def = {.path = lecture ? lecture_first_scene : arguments->operands[0],
                         .lecture = lecture,
                         .arguments = arguments,
                         .film_path = v[RENDER_FILM].given ? v[RENDER_FILM].text : NULL};
  int status = open_context(arguments, &context);
  if (status < 0) status = claim_film(&claim, context, arguments);
  if (status < 0) {
    EngineDef complete = def;
    complete.context = context;
    complete.film_lock = claim.lock;
    status = engine_create(&complete, &engine);
  }
  if (status < 0 && def.film_path) status = check_film(context, def.film_path);
  if (status < 0) {
    const ServerDef server_def = {.address = v[VIEW_LISTEN].given ? v[VIEW_LISTEN].text : NULL,
                                  .port = v[VIEW_PORT].given ? (int)v[VIEW_PORT].integer : 0,
                                  .home = lecture ? "lecture.html" : "index.html",
                                  .query = lecture ? lecture_query(arguments) : "",
                                  .steering = true,
                                  .calls = engine_calls(engine)};
    status = server_start(&server_def, &server);
  }
  if (status < 0) {
    signals_remember();
    status = engine_start(engine, server);
  }
  if (status < 0) {
    if (v[VIEW_LISTEN].given)
      report_warning(
          "--listen %s: whoever reaches this address and knows the token sees and steers the scene; the "
          "connection is not encrypted",
          v[VIEW_LISTEN].text);
    printf("%s\n", server_address(server));
    fflush(stdout);
    tell_tunnel(server);
    report_note("Ctrl-C ends it");
    if (!v[VIEW_NO_OPEN].given) open_browser(server_address(server));
    wait_for_end();
    status = STATUS_OK;
  }
  int stopped = engine ? engine_stop(engine) : STATUS_OK;
  server_stop(server);
  engine_destroy(engine);
  film_claim_release(&claim);
  report_memory_of(NULL, 0);
  vl_context_destroy(context);
  return status == STATUS_OK ? stopped : status;
}
