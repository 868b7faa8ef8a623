/* view/serve.c: see serve.h. */
#include "view/serve.h"

#include <math.h>
#include <stdlib.h>

#include "cli/report.h"
#include "render/progress.h"
#include "view/server.h"
#include "view/state.h"

/* Frames take at most this share of the time, and come at most so often (seconds). */
static const double max_share = 0.03, min_pause = 0.2;

struct Serve {
  const Job *job;
  Server *server;
  vlWorldInfo info;
  ViewCamera camera;
  vlView view;
  float exposure;
  uint32_t serial;
  atomic_uint clients;
  atomic_bool fresh; /* a page came and has no frame yet */
  double shown, cost;
};

static void greet(void *user, uint32_t client) {
  Serve *s = user;
  const ViewState state = {.scene = s->job->path,
                           .spp = s->job->defs->render.spp,
                           .crop = s->job->defs->film.crop,
                           .exposure = (double)s->exposure,
                           .view = (int)s->view,
                           .info = &s->info,
                           .camera = &s->camera};
  json_text_post(state_begin_lists(NULL), s->server, client);
  json_text_post(state_begin(&state), s->server, client);
  s->fresh = true;
}

static void refuse(void *user, UNUSED bool steers, const ViewMessage *message) {
  Serve *s = user;
  Json *json = json_text_begin("refused");
  if (!json)
    return;
  json_put(json, "id %u, change %u, message %s", message->id, message->change,
           "this page looks on: velo render --serve");
  json_text_post(json, s->server, message->client);
}

static void count(void *user, uint32_t clients) {
  ((Serve *)user)->clients = clients;
}

int serve_start(const Job *job, vlView view, float exposure, Serve **result) {
  Serve *s = calloc(1, sizeof *s);
  *result = s;
  if (!s)
    return report_no_memory();
  s->job = job;
  s->view = view;
  s->exposure = exposure;
  s->camera =
      (ViewCamera){.def = job->defs->camera, .made = job->camera, .units = {1, 1, 36, 1}};
  vl_world_info(job->world, &s->info);
  const ServerDef def = {.home = "index.html", .query = ""};
  const ServerCalls calls = {
      .user = s, .greet = greet, .types = message_types, .message = refuse, .clients = count};
  int status = server_open(&def, &s->server);
  if (status < 0)
    status = server_start(s->server, &calls);
  if (status < 0)
    report_note("the image while it renders: %s", server_address(s->server));
  return status;
}

static void post_status(Serve *s, const vlFilm *film, const vlProgress *p) {
  Json *json = json_text_begin("status");
  if (!json)
    return;
  json_put(json, "spp %u, target %u, paths_per_second %g, seconds %g, error %g, paused %i",
           vl_film_spp(film), p->spp_total,
           p->elapsed > 0 ? (double)p->paths / p->elapsed : NAN, p->elapsed, NAN, false);
  json_text_post(json, s->server, 0);
}

void serve_film(Serve *s, const vlFilm *film, const vlProgress *progress) {
  double start = monotonic_seconds(), pause = fmax(min_pause, s->cost / max_share);
  if (!s->clients ||
      (!s->fresh && start - s->shown < pause && progress->spp_done < progress->spp_total))
    return;
  s->fresh = false;
  vlImage *image = NULL;
  const vlFilmDef *def = &s->job->defs->film;
  if (vl_film_develop(film, &s->job->defs->develop, &image) != VL_OK)
    return;
  float to_rec709[9];
  ViewFrame *frame = frame_make(image, FRAME_HALF, 3, frame_to_rec709(def->space, to_rec709));
  vl_image_destroy(image);
  if (!frame)
    return;
  frame->serial = ++s->serial;
  frame->width = def->width;
  frame->height = def->height;
  frame->x0 = def->crop[0];
  frame->y0 = def->crop[1];
  frame->spp = vl_film_spp(film);
  server_show(s->server, frame);
  frame_drop(frame);
  post_status(s, film, progress);
  s->shown = monotonic_seconds();
  s->cost = s->shown - start;
}

void serve_stop(Serve *s) {
  if (!s)
    return;
  server_stop(s->server);
  free(s);
}
