/* render/pattern.c: see pattern.h. */
#include "render/pattern.h"

#include <stdlib.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"

/* Parses the text after a percent sign: digits of the width, then a letter, which is returned.
 * 0: unknown. *length: number of characters after the sign. */
static char sign_at(const char *at, size_t *length, int *width) {
  size_t digits = strspn(at, "0123456789");
  *width = 0;
  for (size_t i = 0; i < digits && i < 3; i++)
    *width = 10 * *width + (at[i] - '0');
  char kind = at[digits];
  *length = digits + (kind != 0);
  if (kind == 'd')
    return digits <= 2 ? 'd' : 0;
  return digits == 0 && kind && strchr("ncv%", kind) ? kind : 0;
}

/* The bytes of an unknown sign: up to the end of its character in UTF-8. */
static int sign_length(const char *at, size_t length) {
  size_t bytes = at[1] ? length + 1 : 1;
  while (((unsigned char)at[bytes] & 0xC0) == 0x80)
    bytes++;
  return (int)bytes;
}

int pattern_check(const char *pattern) {
  for (const char *at = strchr(pattern, '%'); at; at = strchr(at, '%')) {
    size_t length;
    int width;
    if (!sign_at(at + 1, &length, &width))
      return report_usage(
          "output \"%s\": \"%.*s\" is not known; there are %%d or %%04d (the frame's "
          "number), %%n (its name), %%c (camera), %%v (eye), %%%%",
          pattern, sign_length(at, length), at);
    at += 1 + length;
  }
  return -1;
}

bool pattern_has(const char *pattern, char kind) {
  for (const char *at = strchr(pattern, '%'); at; at = strchr(at, '%')) {
    size_t length;
    int width;
    if (sign_at(at + 1, &length, &width) == kind)
      return true;
    at += 1 + length;
  }
  return false;
}

bool pattern_is_numbered(const char *pattern) {
  return pattern_has(pattern, 'd') && !pattern_has(pattern, 'n') &&
         !pattern_has(pattern, 'c') && !pattern_has(pattern, 'v');
}

/* The last component of a path, without its suffix. Characters that some systems do not allow
 * in file names become "_". */
static void clean(const char *name, char *result, size_t size) {
  const char *file = text_file_name(name);
  const char *back = strrchr(file, '\\');
  const char *start = back ? back + 1 : file;
  const char *dot = strrchr(start, '.');
  size_t length =
      dot && dot > start && strlen(dot) <= 6 ? (size_t)(dot - start) : strlen(start);
  if (length >= size)
    length = size - 1;
  for (size_t i = 0; i < length; i++) {
    unsigned char c = (unsigned char)start[i];
    bool bad =
        c < 0x20 || c == 0x7f || strchr("\"*:<>?|", c) || (i == 0 && (c == '.' || c == '-'));
    result[i] = bad ? '_' : (char)c;
  }
  result[length] = 0;
}

bool pattern_expand(const char *pattern, const PatternValues *v, char *path, size_t size) {
  size_t used = 0;
  for (const char *at = pattern; *at;) {
    char piece[300] = "";
    if (*at != '%') {
      size_t n = strcspn(at, "%");
      if (used + n >= size)
        return false;
      memcpy(path + used, at, n);
      used += n;
      at += n;
      continue;
    }
    size_t length;
    int width;
    char kind = sign_at(at + 1, &length, &width);
    if (kind == 'n' && v->name)
      clean(v->name, piece, sizeof piece);
    if (kind == 'c')
      clean(v->camera && *v->camera ? v->camera : "0", piece, sizeof piece);
    if (kind == 'v' && v->view)
      text_set(piece, "%s", v->view);
    if (kind == '%')
      text_set(piece, "%%");
    if (kind == 'd' || (kind == 'n' && !*piece))
      text_set(piece, "%0*u", width, v->number);
    size_t n = strlen(piece);
    if (used + n >= size)
      return false;
    memcpy(path + used, piece, n);
    used += n;
    at += 1 + length;
  }
  if (size == 0)
    return false;
  path[used] = 0;
  return true;
}

static bool read_range(const char *text, FrameRange *range) {
  char *end;
  const char *at = text;
  unsigned long long numbers[3] = {0, UINT32_MAX, 1};
  if (!(*at >= '0' && *at <= '9'))
    return false;
  numbers[0] = strtoull(at, &end, 10);
  if (*end != '-')
    numbers[1] = numbers[0];
  if (*end == '-') {
    at = end + 1;
    end = (char *)at;
    if (*at >= '0' && *at <= '9')
      numbers[1] = strtoull(at, &end, 10);
  }
  if (*end == ':' && end[1] >= '0' && end[1] <= '9')
    numbers[2] = strtoull(end + 1, &end, 10);
  if (*end || numbers[0] > UINT32_MAX || numbers[1] > UINT32_MAX || numbers[2] > UINT32_MAX)
    return false;
  *range = (FrameRange){(uint32_t)numbers[0], (uint32_t)numbers[1], (uint32_t)numbers[2]};
  return range->first <= range->last && range->step > 0;
}

int pattern_range(const char *text, FrameRange *range) {
  if (read_range(text, range))
    return -1;
  return report_usage("--frames \"%s\": must be A, A-B, A- or A-B:STEP, numbers from 0", text);
}

int pattern_choose(const char *text, uint32_t count, const char *of, FrameRange *range) {
  *range = (FrameRange){0, count - 1, 1};
  if (text)
    TRY(pattern_range(text, range));
  if (range->first >= count || (range->last != UINT32_MAX && range->last >= count))
    return report_usage("--frames \"%s\": the %s has %u frames, numbered from 0", text, of,
                        count);
  if (range->last >= count)
    range->last = count - 1;
  return -1;
}

uint32_t pattern_count(const FrameRange *range) {
  return (range->last - range->first) / range->step + 1;
}
