/* view/page.c: `velo view` in WebAssembly: the page that shows the image holds the whole
 * program, in a worker. There is one page, no network and no thread: JavaScript brings the
 * page's messages and has the work done, piece by piece (web/engine/velo.mjs). The engine is
 * that of the server; this file stands for server*.c, lecture.c and view_run.c. */
#include <emscripten.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/context.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "render/job.h"
#include "view/engine.h"
#include "view/lecture.h"
#include "view/view.h"

/* web/engine/page_calls.js: whether a page holds the program; sends it a text, a frame; takes
 * its next message. */
extern int velo_page_here(void);
extern void velo_page_post(const char *text);
extern void velo_page_show(const uint8_t *bytes, size_t size);
extern int velo_page_take(char *to, int room);

struct Server {
  ServerCalls calls;
  ViewFrame *frame, *shown; /* the newest one; the one that the page has. Null: none */
  uint32_t waits_for; /* serial of the frame whose arrival the page has not told; 0: none */
};

static Server server;
static Engine *engine;

/* ---- the server -------------------------------------------------------------------------- */

void server_post(UNUSED Server *s, UNUSED uint32_t client, const char *text) {
  velo_page_post(text);
}

static void send_frame(Server *s) {
  size_t size;
  if (s->waits_for || !s->frame || s->frame == s->shown)
    return;
  uint8_t *bytes = frame_message(s->frame, s->shown, 0, &size);
  if (!bytes)
    return;
  s->waits_for = s->frame->serial;
  velo_page_show(bytes, size);
  free(bytes);
  frame_drop(s->shown);
  s->shown = frame_keep(s->frame);
}

void server_show(Server *s, ViewFrame *frame) {
  frame_drop(s->frame);
  s->frame = frame_keep(frame);
  send_frame(s);
}

double server_seconds(UNUSED const Server *s) {
  return 0;
}

/* The page has set a message. */
EMSCRIPTEN_KEEPALIVE void velo_page_message(void) {
  static char text[MESSAGE_MAX_SIZE];
  static ViewMessage message;
  char why[VL_GIVEN_MESSAGE];
  int size = velo_page_take(text, sizeof text);
  if (!message_parse(server.calls.types, text, (size_t)size, &message, why)) {
    report_warning("%s", why);
  } else if (message.type->place == MESSAGE_SEEN) {
    if (message.serial == server.waits_for)
      server.waits_for = 0;
    send_frame(&server);
  } else if (message.type->place != MESSAGE_STEER) {
    message.client = 1;
    server.calls.message(server.calls.user, true, &message);
  }
}

/* Does a piece of work. 0: there is nothing to do until the next message. */
EMSCRIPTEN_KEEPALIVE int velo_page_work(void) {
  return engine_work(engine);
}

/* ---- the lecture's scenes, which are files of the instance ------------------------------- */

const char lecture_first_scene[] = "scenes/lecture/pinhole.pbrt";

const char *lecture_scene(const char *name) {
  static const char folder[] = "scenes/lecture/";
  static char names[128][MESSAGE_NAME];
  size_t n = sizeof folder - 1;
  if (strncmp(name, folder, n) != 0 || strchr(name + n, '/') || access(name, R_OK) != 0)
    return NULL;
  for (size_t i = 0; i < LENGTH(names); i++) {
    if (!names[i][0])
      strncpy(names[i], name, sizeof names[i] - 1);
    if (strcmp(names[i], name) == 0)
      return names[i];
  }
  return NULL;
}

char *lecture_text(const char *scene) {
  char *text = NULL, part[4096];
  size_t size, n;
  FILE *in = fopen(scene, "rb"), *out = in ? open_memstream(&text, &size) : NULL;
  while (out && (n = fread(part, 1, sizeof part, in)) > 0)
    fwrite(part, 1, n, out);
  if (in)
    fclose(in);
  return out && fclose(out) == 0 ? text : NULL;
}

/* ---- the command ------------------------------------------------------------------------- */

int view_run(const Arguments *arguments) {
  const OptionValue *v = arguments->values;
  const bool lecture = v[VIEW_LECTURE].given;
  const vlContextDef context = scene_context_def(arguments);
  EngineDef def = {.path = lecture ? lecture_first_scene : arguments->operands[0],
                   .lecture = lecture,
                   .stepwise = true,
                   .arguments = arguments};
  if (!velo_page_here())
    return report_failure(
        STATUS_OTHER,
        "velo view: this program renders for the page that holds it, and there is none");
  report_setup(false, v[RENDER_QUIET].given ? REPORT_QUIET : REPORT_NORMAL);
  int status = context_open(&context, &def.context);
  if (status < 0)
    status = engine_create(&def, &engine);
  if (status >= 0)
    return status;
  engine_attach(engine, &server);
  server.calls = engine_calls(engine);
  velo_page_post(
      "{\"type\":\"role\",\"client\":1,\"steers\":true,\"steering\":true,\"pages\":1}");
  server.calls.greet(server.calls.user, 1);
  server.calls.clients(server.calls.user, 1);
  emscripten_exit_with_live_runtime(); /* the functions above follow; the arguments stay */
  return STATUS_OTHER;
}
