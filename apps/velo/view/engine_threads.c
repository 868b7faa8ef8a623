/* view/engine_threads.c: the engine's threads: one renders, one answers questions, one traces
 * the paths of pixels, one runs copied commands, one loads scenes. Where there are no threads,
 * page.c calls engine_work.
 */
#include "cli/report.h"
#include "view/engine_answers.h"

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
  const bool lecture = engine->def.lecture;
  void *(*const work[THREAD_COUNT])(void *) = {
      [THREAD_RENDER] = engine_render,
      [THREAD_ANSWER] = answer,
      [THREAD_TRACE] = trace,
      [THREAD_VERIFY] = lecture ? NULL : engine_verify_commands,
      [THREAD_WATCH] = lecture ? load : engine_watch};
  engine->server = server;
  for (int i = 0; i < THREAD_COUNT; i++) {
    Thread *thread = &engine->threads[i];
    thread->runs = work[i] && pthread_create(&thread->thread, NULL, work[i], engine) == 0;
    if (!engine->threads[THREAD_RENDER].runs)
      return report_failure(STATUS_OTHER, "the system refuses to start a thread");
  }
  return -1;
}

int engine_stop(Engine *engine) {
  if (!engine->threads[THREAD_RENDER].runs)
    return STATUS_OK;
  engine_lock(engine);
  engine->quit = true;
  engine_interrupt(engine);
  vl_cancel_request(engine->end);
  vl_cancel_request(engine->traces.stop);
  pthread_cond_broadcast(&engine->wake);
  engine_unlock(engine);
  for (int i = 0; i < THREAD_COUNT; i++) {
    if (engine->threads[i].runs)
      pthread_join(engine->threads[i].thread, NULL);
    engine->threads[i].runs = false;
  }
  return engine->def.film_path ? engine_write_film(engine) : STATUS_OK;
}
