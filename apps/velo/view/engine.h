/* view/engine.h: renders what the pages ask for: the first image coarse, then finer, then more
 * samples. One thread renders; the server's thread brings messages. */
#ifndef APP_VIEW_ENGINE_H
#define APP_VIEW_ENGINE_H

#include "velo/film.h"
#include "view/model.h"
#include "view/server.h"

typedef struct Engine Engine;

typedef struct EngineDef {
  vlContext *context;
  const char *path; /* of the scene; it stays valid */
  bool lecture;     /* pages choose among the scenes of the lecture; nothing is saved */
  bool stepwise;    /* there are no threads: engine_work does the work */
  const Arguments *arguments; /* of the command line */
  const char *film_path;      /* to write the film to at the end; null: none */
  vlFilmLock *film_lock;      /* of film_path */
} EngineDef;

/* Loads the scene. Returns -1 with *engine, or the exit code after reporting the error. */
int engine_create(const EngineDef *def, Engine **engine);
/* The file beside a film that holds its camera. */
void engine_film_camera(const char *film_path, char *path, size_t size);
/* The calls for the server of this engine. */
ServerCalls engine_calls(Engine *engine);
/* Without threads, in place of engine_start: the engine sends to this server. */
void engine_attach(Engine *engine, Server *server);
/* Without threads: does a piece of work, such as a pass, a coarse image or an answer. Returns
 * whether there may be more. */
bool engine_work(Engine *engine);
/* Starts the thread that renders. Returns -1 or the exit code. */
int engine_start(Engine *engine, Server *server);
/* Ends the thread and writes the film if that is asked for. Returns the exit code. */
int engine_stop(Engine *engine);
/* Null is allowed. */
void engine_destroy(Engine *engine);

#endif
