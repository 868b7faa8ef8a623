/* camera_files/lines.c: see lines.h. */
#include "camera_files/lines.h"
#include "base/text.h"

#include <math.h>
#include <string.h>

bool vl_camera_next_line(vlCameraLines *lines) {
  while (lines->at < lines->end) {
    const char *stop = memchr(lines->at, '\n', (size_t)(lines->end - lines->at));
    const char *start = lines->at, *first = start, *last = stop ? stop : lines->end;
    lines->at = stop ? stop + 1 : lines->end;
    lines->number++;
    while (first < last && (*first == ' ' || *first == '\t'))
      first++;
    while (last > first && (last[-1] == ' ' || last[-1] == '\t' || last[-1] == '\r'))
      last--;
    if (first == last || *first == '#')
      continue;
    size_t length = (size_t)(last - first);
    if (length > sizeof lines->text - 1)
      length = sizeof lines->text - 1;
    memcpy(lines->text, first, length);
    lines->text[length] = 0;
    lines->indent = (uint32_t)(first - start);
    return true;
  }
  return false;
}

vlResult vl_camera_wrong_line(const vlCameraFile *file, const vlCameraLines *lines,
                              const char *at, const char *format, ...) {
  char message[300];
  VL_FORMAT(message, format);
  uint32_t column = lines->indent + (uint32_t)(at - lines->text) + 1;
  return vl_camera_wrong_at(file, lines->number, column, "%s: %s", file->dialect, message);
}

vlResult vl_camera_line_numbers(const vlCameraFile *file, const vlCameraLines *lines,
                                const char *from, double *values, uint32_t min, uint32_t max) {
  uint32_t found = 0;
  const char *at = from + strspn(from, " \t");
  while (*at) {
    char *end;
    double value = vl_camera_parse(at, &end);
    if (end == at || !isfinite(value))
      return vl_camera_wrong_line(file, lines, at, "no finite number: \"%s\"",
                                  vl_short_text(at).text);
    if (found == max)
      return vl_camera_wrong_line(file, lines, at, "more than %u numbers", max);
    values[found++] = value;
    at = end + strspn(end, " \t");
  }
  if (found < min)
    return vl_camera_wrong_line(file, lines, from, "%u numbers; it must be %u", found, min);
  return VL_OK;
}

char *vl_camera_raw_line(vlRawLines *lines) {
  const bool marked = lines->number == 0 && lines->end - lines->at >= 3 &&
                      memcmp(lines->at, "\xef\xbb\xbf", 3) == 0;
  if (marked)
    lines->at += 3;
  if (lines->at >= lines->end)
    return NULL;
  char *line = lines->at;
  char *stop = memchr(line, '\n', (size_t)(lines->end - line));
  lines->at = stop ? stop + 1 : lines->end;
  lines->number++;
  if (stop)
    *stop = 0;
  const size_t length = strlen(line);
  if (length && line[length - 1] == '\r')
    line[length - 1] = 0;
  return line;
}
