/* render/pattern.h: patterns of file names:
 *   %d  the frame's number (%04d: at least four digits)
 *   %n  the image's name in the trajectory (last component, without suffix)
 *   %c  the camera's name
 *   %v  the eye: left or right
 *   %%  a percent sign
 * Names may come from untrusted files: slashes and control characters are replaced. */
#ifndef APP_RENDER_PATTERN_H
#define APP_RENDER_PATTERN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct PatternValues {
  uint32_t number;
  const char *name, *camera, *view; /* null or empty: %n gives the number, %c "0", %v nothing */
} PatternValues;

/* Returns -1, or the exit code after an unknown field. */
int pattern_check(const char *pattern);
/* Whether the pattern has a field of that kind: 'd', 'n', 'c', 'v'. */
bool pattern_has(const char *pattern, char kind);
/* False: too long. */
bool pattern_expand(const char *pattern, const PatternValues *values, char *path, size_t size);

/* Parses the value of --frames: "3", "0-99", "10-" (last: UINT32_MAX) or "0-100:10". */
bool pattern_range(const char *text, uint32_t *first, uint32_t *last, uint32_t *step);

#endif
