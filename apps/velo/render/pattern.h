/* render/pattern.h: names of files that are written many times over: %d the frame's number (%04d: four digits at
 * least), %n the name of its image in the trajectory (last part, without suffix), %c the camera's, %v the eye: left
 * or right; %% a percent sign. Names come from files of strangers: slashes and control characters do not get through.
 */
#ifndef APP_RENDER_PATTERN_H
#define APP_RENDER_PATTERN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct PatternValues {
  uint32_t number;
  const char *name, *camera, *view; /* null or empty: the number; camera: "0"; view: nothing */
} PatternValues;

/* -1, or the exit code after a sign that is not known. */
int pattern_check(const char *pattern);
/* kind: 'd', 'n', 'c', 'v' */
bool pattern_has(const char *pattern, char kind);
/* false: too long */
bool pattern_expand(const char *pattern, const PatternValues *values, char *path, size_t size);

#endif
