/* view/view_run.c: runs `velo view`: loads the scene, starts server and render thread, and
 * waits for Ctrl-C. */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "cli/confine.h"
#include "cli/context.h"
#include "cli/report.h"
#include "cli/signals.h"
#include "render/film_claim.h"
#include "render/job.h"
#include "render/output_names.h"
#include "sensor/sensor.h"
#include "view/browser.h"
#include "view/engine.h"
#include "view/lecture.h"
#include "view/view.h"

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
  int status = context_open(&def, context);
  if (status < 0)
    report_memory_of(*context, def.max_memory);
  return status;
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
  for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++)
    if (v[inputs[i]].given)
      confine_read_folder(&c, v[inputs[i]].text);
  if (v[VIEW_EXPOSE].given && sensor_is_file(v[VIEW_EXPOSE].text))
    confine_read_folder(&c, v[VIEW_EXPOSE].text);
  confine_write(&c, "saved.exr");
  if (v[RENDER_FILM].given)
    confine_write(&c, v[RENDER_FILM].text);
  confine_apply(&c, arguments);
}

/* Locks the file of --film, which must not be there already. Returns -1 or the exit code. */
static int claim_film(FilmClaim *claim, vlContext *context, const Arguments *arguments) {
  const char *path = arguments->values[RENDER_FILM].text;
  const bool overwrite = arguments->values[RENDER_OVERWRITE].given;
  char camera[4200];
  int status = film_claim_check(overwrite, path, NULL);
  if (status >= 0 || !path)
    return status;
  status = film_claim(claim, context, path, "", overwrite);
  if (status >= 0 || overwrite)
    return status;
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
  vlContext *context = NULL;
  Engine *engine = NULL;
  Server *server = NULL;
  Browser browser = {0};
  FilmClaim claim = {.lock = NULL};
  report_setup(false, v[RENDER_QUIET].given ? REPORT_QUIET : REPORT_NORMAL);
  bool lecture = v[VIEW_LECTURE].given;
  const EngineDef def = {.path = lecture ? lecture_first_scene : arguments->operands[0],
                         .lecture = lecture,
                         .arguments = arguments,
                         .film_path = v[RENDER_FILM].text};
  if (!v[VIEW_NO_OPEN].given)
    browser_prepare(&browser);
  int status = open_server(arguments, &server);
  if (status < 0)
    confine(arguments);
  if (status < 0)
    status = open_context(arguments, &context);
  if (status < 0)
    status = claim_film(&claim, context, arguments);
  if (status < 0) {
    EngineDef complete = def;
    complete.context = context;
    complete.film_lock = claim.lock;
    status = engine_create(&complete, &engine);
  }
  if (status < 0 && def.film_path)
    status = check_film(context, def.film_path);
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
  context_close(context);
  return status == STATUS_OK ? stopped : status;
}
