/* view/model.h: a scene file as the viewer has it: the scene, its world, its job, and the files
 * that it was made of. */
#ifndef APP_VIEW_MODEL_H
#define APP_VIEW_MODEL_H

#include "render/job.h"
#include "render/scene_options.h"

/* Paths of files, each once. */
typedef struct FileList {
  char **paths;
  uint32_t count;
} FileList;
/* Adds a path unless the list has it, or there is no memory. */
void file_list_add(FileList *list, const char *path);
void file_list_free(FileList *list);

/* The time at which an animated model is shown. */
typedef struct ModelTime {
  double at, shutter; /* seconds, as --at and --shutter; shutter 0: no motion blur */
  float exposure;     /* EV; it is not metered anew for each time */
} ModelTime;

typedef struct Model {
  vlScene *scene;
  vlWorld *world;
  Job job;
  SceneOpening opening;
  vlWorldInfo info;
  double lookat;  /* distance of what the middle of the image shows, or of the scene's middle */
  float exposure; /* EV of the first view */
  vlCamera *cameras; /* of --trajectory; null: none */
  uint32_t camera_count;
  uint32_t load;  /* Engine.loads at this load */
  double seconds; /* duration of the animation that is chosen; 0: none */
  bool timed;     /* loaded for another time of the same file */
} Model;

/* Loads, completes and builds. path: a file; with --lecture, a scene of the lecture. time:
 * null: as the arguments give it. Adds the paths of the files that were read to the list.
 * Returns -1, or the exit code after reporting the error; *model is empty then. */
int model_load(vlContext *context, const char *path, const Arguments *arguments,
               const ModelTime *time, const vlWorld *previous, const vlCancel *cancel,
               Model *model, FileList *files);
/* Frees what the model has and empties it. */
void model_free(Model *model);
/* Frees the model, too. Null is allowed. */
void model_destroy(Model *model);

enum { MODEL_TIME_TEXT = 80 };
/* The value of --at for a shutter that is open from `open` to `close`, in seconds. close: NaN:
 * there is no motion blur. */
void model_time_text(double open, double close, char text[MODEL_TIME_TEXT]);

#endif
