/* view/engine_answers.h: messages that wait, and their answers. Only engine*.c include it. */
#ifndef APP_VIEW_ENGINE_ANSWERS_H
#define APP_VIEW_ENGINE_ANSWERS_H

#include "velo/camera_file.h"
#include "view/engine_parts.h"

/* Adds a task to a list that has room, or refuses it; the caller holds the lock. */
void engine_add_task(Engine *engine, const ViewMessage *message, TaskList *tasks);
/* Takes the first of a list of tasks; the caller holds the lock. False: there is none, or the
 * engine ends. */
bool engine_take_task(const Engine *engine, TaskList *tasks, ViewMessage *first);
/* Answers the first question. False: there is none. */
bool engine_answer_question(Engine *engine);
/* Begins the answer to a task, as json_text_begin. */
Json *engine_reply_begin(const ViewMessage *message, const char *type);
/* Begins the answer with a result, or posts why there is none. Null: nothing is to be sent. */
Json *engine_reply_with(Engine *engine, const ViewMessage *message, const char *type,
                        vlResult result, const vlError *error);
/* Whether a message's point is in the image; if not, that is posted. */
bool engine_is_in_image(Engine *engine, const ViewMessage *message, const vlCamera *camera);
/* Posts why a message is not answered. */
void engine_refuse(Engine *engine, const ViewMessage *message, const char *why);

/* Answers of engine_messages.c's table. */
/* Posts what a pixel sees. */
void engine_pick(Engine *engine, const ViewMessage *message);
/* Focuses the camera on what a pixel sees. */
void engine_focus(Engine *engine, const ViewMessage *message);
/* Writes the present camera. Errors: those of vl_camera_write. */
vlResult engine_write_camera(const Engine *engine, const char *path, vlCameraDialect dialect,
                             vlError *error);
/* Writes a camera or an image; posts its name. */
void engine_save(Engine *engine, const ViewMessage *message);
/* Writes the camera and posts the command that renders the present image. */
void engine_command(Engine *engine, const ViewMessage *message);
/* Posts vanishing points, horizon and, if asked for, the boxes of objects and the curves of
 * engine_put_curves. */
void engine_overlay(Engine *engine, const ViewMessage *message);
/* Posts the lines that draw the camera from outside; a small image of the scene from
 * outside. */
void engine_outline(Engine *engine, const ViewMessage *message);
void engine_outside(Engine *engine, const ViewMessage *message);
/* Posts the cameras of --trajectory, and the lines that draw them. */
void engine_cameras(Engine *engine, const ViewMessage *message);
/* Writes the drawings over the image as curves in pixels, for every projection and distortion;
 * field: also where a pinhole would show the same things. */
void engine_put_curves(Json *json, const ViewCamera *camera, const vlWorldInfo *info,
                       bool field);

/* Adds a pixel whose paths are to be traced, in place of the page's one before; the caller
 * holds the lock. */
void engine_add_trace(Engine *engine, const ViewMessage *message);
/* Drops the pixels of a page, or of all (0), because of `why`; the caller holds the lock. */
void engine_drop_traces(Engine *engine, uint32_t client, const char *why);
/* Traces the paths of the first pixel. False: there is none. */
bool engine_trace_next(Engine *engine);

/* The thread that runs the copied command and compares its image. */
void *engine_verify_commands(void *engine);
/* The settings of the present image; its crop, its samples and its tracer are those of the
 * film. */
vlSceneDefs engine_present_defs(const Engine *engine);
/* Writes the film of --film; when the threads have ended. Returns the exit code. */
int engine_write_film(Engine *engine);

#endif
