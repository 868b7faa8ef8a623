/* render/added.h: what was added to a scene (camera, light, ground, opening), as options that
 * leave nothing to choose. */
#ifndef APP_RENDER_ADDED_H
#define APP_RENDER_ADDED_H

#include "render/scene_options.h"

/* As many as added_replaces knows. */
enum { MAX_ADDED = 10, ADDED_TEXT = 96 };

/* Each number of a text reads back as the same bits. */
typedef struct AddedOptions {
  struct {
    int id;
    const char *text; /* of a flag: null */
  } items[MAX_ADDED];
  int count;
  char texts[MAX_ADDED][ADDED_TEXT];
} AddedOptions;

/* camera: for a command that adds a camera; false: for one that gets it from a file. */
void added_options(const SceneOpening *opening, const Arguments *arguments, bool camera,
                   AddedOptions *added);
/* Whether the option is among those that added_options replaces. */
bool added_replaces(int option);
/* Whether the option is among the added ones. *text: its value, null of a flag. */
bool added_has(const AddedOptions *added, int option, const char **text);

#endif
