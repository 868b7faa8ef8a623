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
/* Whether it has %d, and no other sign but %%. */
bool pattern_is_numbered(const char *pattern);
/* False: too long. */
bool pattern_expand(const char *pattern, const PatternValues *values, char *path, size_t size);

/* Numbers of frames: first, first + step, ... up to last. */
typedef struct FrameRange {
  uint32_t first, last, step;
} FrameRange;
/* Reads the value of --frames: "3", "0-99", "10-" (last: UINT32_MAX) or "0-100:10". Returns -1,
 * or the exit code after reporting the error. */
int pattern_range(const char *text, FrameRange *range);
/* The frames of --frames (null: all) among `count`. of: what has them, for the message. Returns
 * as pattern_range. */
int pattern_choose(const char *text, uint32_t count, const char *of, FrameRange *range);
/* The number of frames. */
uint32_t pattern_count(const FrameRange *range);

#endif
