/* import/pbrt/upgrade/detect.h: recognises scenes of pbrt-v3 and pbrt-v2. */
#ifndef IMPORT_PBRT_UPGRADE_DETECT_H
#define IMPORT_PBRT_UPGRADE_DETECT_H

#include "velo/base.h"

typedef struct vlOldScene {
  int version; /* 2 or 3; 0: the file has no sign of either */
  uint32_t line, column;
  char sign[64]; /* the statement: Film "image" */
} vlOldScene;

/* Looks for statements in the file that pbrt-v4 does not have. The files that it includes are
 * not looked into. */
vlOldScene vl_old_scene(vlContext *context, const char *path);
/* The same in the text of a file, which the tokenizer changes; a zero byte follows it. */
vlOldScene vl_old_scene_text(char *text, size_t size);

#endif
