/* view/engine_status.h: what the engine tells the pages about the render. */
#ifndef APP_VIEW_ENGINE_STATUS_H
#define APP_VIEW_ENGINE_STATUS_H

#include "view/engine_answers.h"
#include "view/state.h"

/* Samples, speed, estimated error. estimate: the error is estimated anew now. */
void status_tell(Engine *engine, bool estimate);
/* An error, with its location if there is one. */
void status_error(Engine *engine, const vlError *error, vlResult result);
/* An error, a warning or what else `type` says; a message with its location if there is one. */
void status_problem(Engine *engine, const char *type, const vlError *what, const char *message);
/* Ends the text, posts it to all pages, and keeps it in *last for new ones. */
void json_text_keep(Json *json, Engine *engine, char **last);

#endif
