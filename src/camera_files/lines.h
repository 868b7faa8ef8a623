/* camera_files/lines.h: reads text files line by line. */
#ifndef CAMERA_FILES_LINES_H
#define CAMERA_FILES_LINES_H

#include "camera_files/files.h"

typedef struct vlCameraLines {
  const char *at, *end; /* the unread text */
  char text[4096];      /* the line without blanks at its ends, truncated to fit */
  uint32_t number, indent;
} vlCameraLines;

/* Reads the next line that is neither empty nor a comment (#). Returns false at the end of the
 * text. */
bool vl_camera_next_line(vlCameraLines *lines);
/* Reports an error at a character of the line. */
vlResult vl_camera_wrong_line(const vlCameraFile *file, const vlCameraLines *lines,
                              const char *at, const char *format, ...) VL_PRINTF(4, 5);
/* Parses finite numbers up to the end of the line. Any other text is an error at its column. */
vlResult vl_camera_line_numbers(const vlCameraFile *file, const vlCameraLines *lines,
                                const char *from, double *values, uint32_t min, uint32_t max);

/* Lines whose blanks and comments have a meaning. The text is writable; each line of it becomes
 * a text of its own. */
typedef struct vlRawLines {
  char *at, *end; /* the unread text */
  uint32_t number;
} vlRawLines;
/* The next line without its end, LF or CR LF; null: there is none. A byte order mark is
 * skipped. */
char *vl_camera_raw_line(vlRawLines *lines);

#endif
