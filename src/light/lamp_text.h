/* light/lamp_text.h: reads lines and numbers of lamp files. */
#ifndef LIGHT_LAMP_TEXT_H
#define LIGHT_LAMP_TEXT_H

#include "base/attributes.h"
#include "velo/base.h"

typedef struct vlLampText {
  const char *name; /* of the file, for messages */
  const char *at, *end;
  uint32_t line; /* of `at`, from 1 */
  vlError *error;
} vlLampText;

typedef struct vlLampLine {
  const char *text; /* without blanks at both ends */
  size_t length;
  uint32_t number;
} vlLampLine;

/* The next line. False at the end of the text. Lines end with LF, CR or both. */
bool vl_lamp_line(vlLampText *t, vlLampLine *line);
/* The next number on this line or a later one; blanks and commas separate. `what`: what the
 * number is, for messages. False: the error is set. */
bool vl_lamp_number(vlLampText *t, const char *what, double *value);
/* The same for a whole number from low to high. */
bool vl_lamp_whole(vlLampText *t, const char *what, double low, double high, uint32_t *value);
/* Whether nothing but blanks follows the last of planes x angles intensities; else the error is
 * set. */
bool vl_lamp_end(vlLampText *t, uint32_t planes, uint32_t angles);
/* Converts a plain decimal number, the whole of text[0, length); comma: the decimal sign may be
 * a comma. False: it is none, or above 1e30. */
bool vl_lamp_decimal(const char *text, size_t length, bool comma, double *value);
/* Sets the error at a line. Returns false. */
bool vl_lamp_fail(const vlLampText *t, uint32_t line, const char *format, ...) VL_PRINTF(3, 4);

#endif
