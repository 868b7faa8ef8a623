/* view/engine_paths.c: the paths of a pixel, traced again for a page, on a thread beside the
 * render. A page has one request at a time: a newer one, another camera or another scene ends
 * it. */

#include "camera/paths.h"
#include "cli/kinds.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "velo/tracer.h"
#include "view/engine_status.h"

enum { DEFAULT_SAMPLES = 16, DEFAULT_SHOWN = 16 };

void engine_drop_traces(Engine *e, uint32_t client, const char *why) {
  TaskList *traces = &e->traces.pixels;
  uint32_t kept = 0;
  for (uint32_t i = 0; i < traces->count; i++) {
    if (client && traces->messages[i].client != client)
      traces->messages[kept++] = traces->messages[i];
    else
      engine_refuse(e, &traces->messages[i], why);
  }
  traces->count = kept;
  if (e->traces.client && (!client || e->traces.client == client))
    vl_cancel_request(e->traces.stop);
}

void engine_add_trace(Engine *e, const ViewMessage *m) {
  engine_drop_traces(e, m->client, "another pixel was chosen");
  engine_add_task(e, m, &e->traces.pixels);
}

static void post_paths(Engine *e, const ViewMessage *m, const TracedPaths *traced) {
  uint32_t max = m->show ? m->show : DEFAULT_SHOWN, count = traced->paths->count;
  const PathsReport report = {.file = e->def.path,
                              .world = e->model.world,
                              .traced = traced,
                              .shown = count < max ? count : max};
  Json *json = engine_reply_begin(m, "paths");
  if (!json)
    return;
  paths_put_json(json, &report);
  json_text_post(json, e->server, m->client);
}

/* Traces the pixel's paths: the samples of the image. */
static void answer(Engine *e, const ViewMessage *m, const ViewCamera *camera) {
  const vlCamera *c = &camera->made;
  vlRenderDef render = e->model.job.defs->render;
  vlError error = {0};
  TracedPaths traced = {.paths = NULL};
  engine_set_tracer(&render, engine_shown(e));
  if (!engine_is_in_image(e, m, c))
    return;
  if (render.tracer != VL_TRACER_PATH && render.tracer != VL_TRACER_VOLPATH) {
    char why[200];
    text_set(
        why,
        "paths of the tracer %s are not recorded; start velo view with --tracer path or volpath",
        kind_name("tracers", (int)render.tracer));
    engine_refuse(e, m, why);
    return;
  }
  render.cancel = e->traces.stop;
  render.priority = 2;
  const PathsRequest request = {.world = e->model.world,
                                .camera = c,
                                .film = &e->model.job.defs->film,
                                .render = &render,
                                .pixel = {(uint32_t)m->x, (uint32_t)m->y},
                                .count = m->samples ? m->samples : DEFAULT_SAMPLES,
                                .by_sample = m->by_sample};
  vlResult result = paths_trace(&request, &traced, &error);
  if (result == VL_OK)
    post_paths(e, m, &traced);
  else
    engine_refuse(e, m, error_text(&error, result));
  paths_free(&traced);
}

bool engine_trace_next(Engine *e) {
  static ViewMessage pixel; /* the thread that traces alone uses them */
  static ViewCamera camera;
  engine_lock(e);
  bool any = engine_take_task(e, &e->traces.pixels, &pixel);
  if (any) {
    camera = e->wanted.camera;
    e->traces.client = pixel.client;
    vl_cancel_clear(e->traces.stop);
  }
  engine_unlock(e);
  if (!any)
    return false;
  pthread_rwlock_rdlock(&e->model_lock);
  answer(e, &pixel, &camera);
  pthread_rwlock_unlock(&e->model_lock);
  engine_lock(e);
  e->traces.client = 0;
  engine_unlock(e);
  return true;
}
