/* view/engine_threads.c: the engine's threads: one renders, one answers questions, one traces
 * the paths of pixels, one runs copied commands, one loads scenes. Where there are no threads,
 * page.c calls engine_work.
 */
#include "cli/report.h"
#include "view/engine_parts.h"

/* Does one kind of work whenever some waits, until the engine ends. */
static void *serve(Engine *e, bool (*waits)(const Engine *), bool (*work)(Engine *)) {
  for (;;) {
    engine_lock(e);
    while (!e->quit && !waits(e))
      pthread_cond_wait(&e->wake, &e->lock);
    bool quit = e->quit;
    engine_unlock(e);
    if (quit)
      return NULL;
    work(e);
  }
}

static bool question_waits(const Engine *e) {
  return e->questions.count > 0;
}
static void *answer(void *user) {
  return serve(user, question_waits, engine_answer_question);
}

static bool trace_waits(const Engine *e) {
  return e->traces.pixels.count > 0;
}
static void *trace(void *user) {
  return serve(user, trace_waits, engine_trace_next);
}

static bool choice_waits(const Engine *e) {
  return e->choice.scene != NULL;
}
static void *load(void *user) {
  return serve(user, choice_waits, engine_load_choice);
}

int engine_start(Engine *engine, Server *server) {
  engine->server = server;
  if (pthread_create(&engine->threads.render, NULL, engine_render, engine) != 0)
    return report_failure(STATUS_OTHER, "the system refuses to start a thread");
  engine->threads.renders = true;
  engine->threads.answers = pthread_create(&engine->threads.answer, NULL, answer, engine) == 0;
  engine->threads.traces = pthread_create(&engine->threads.trace, NULL, trace, engine) == 0;
  if (!engine->def.lecture)
    engine->threads.verifies =
        pthread_create(&engine->threads.verify, NULL, engine_verify_commands, engine) == 0;
  void *(*watch)(void *) = engine->def.lecture ? load : engine_watch;
  engine->threads.watches = pthread_create(&engine->threads.watch, NULL, watch, engine) == 0;
  return -1;
}

int engine_stop(Engine *engine) {
  if (!engine->threads.renders)
    return STATUS_OK;
  engine_lock(engine);
  engine->quit = true;
  engine_interrupt(engine);
  vl_cancel_request(engine->end);
  vl_cancel_request(engine->traces.stop);
  pthread_cond_broadcast(&engine->wake);
  engine_unlock(engine);
  pthread_join(engine->threads.render, NULL);
  if (engine->threads.watches)
    pthread_join(engine->threads.watch, NULL);
  if (engine->threads.answers)
    pthread_join(engine->threads.answer, NULL);
  if (engine->threads.traces)
    pthread_join(engine->threads.trace, NULL);
  if (engine->threads.verifies)
    pthread_join(engine->threads.verify, NULL);
  engine->threads.renders = false;
  return engine->def.film_path ? engine_write_film(engine) : STATUS_OK;
}
