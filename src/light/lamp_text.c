/* light/lamp_text.c: see lamp_text.h. The C library's strtod depends on the language of the
 * process; numbers of lamp files are short, so that one division or product of exact doubles
 * gives the nearest one. */
#include "light/lamp_text.h"

#include <math.h>

#include "base/error.h"
#include "base/text.h"
#include "math/elementary.h"

bool vl_lamp_fail(const vlLampText *t, uint32_t line, const char *format, ...) {
  char message[400];
  VL_FORMAT(message, format);
  vl_fail_at(t->error, VL_ERROR_SCENE, t->name, line, 0, "%s", message);
  return false;
}

static bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0' || c == 0x1a;
}

static bool is_end(char c) {
  return c == '\n' || c == '\r';
}

/* Passes the end of a line: LF, CR, or CR and LF. */
static void pass_end(vlLampText *t) {
  if (t->at < t->end && *t->at == '\r')
    t->at++;
  if (t->at < t->end && *t->at == '\n')
    t->at++;
  t->line++;
}

bool vl_lamp_line(vlLampText *t, vlLampLine *line) {
  if (t->at >= t->end)
    return false;
  const char *first = t->at;
  while (t->at < t->end && !is_end(*t->at))
    t->at++;
  const char *last = t->at;
  while (first < last && is_blank(*first))
    first++;
  while (last > first && is_blank(last[-1]))
    last--;
  *line = (vlLampLine){first, (size_t)(last - first), t->line};
  if (t->at < t->end)
    pass_end(t);
  return true;
}

bool vl_lamp_decimal(const char *text, size_t length, bool comma, double *value) {
  const char *at = text, *end = text + length;
  bool negative = at < end && *at == '-';
  if (at < end && (*at == '-' || *at == '+'))
    at++;
  double digits = 0;
  int exponent = 0;
  uint32_t count = 0;
  bool point = false;
  for (; at < end; at++) {
    if (!point && (*at == '.' || (comma && *at == ','))) {
      point = true;
      continue;
    }
    if (*at < '0' || *at > '9')
      break;
    count++;
    if (digits < 1e14) {
      digits = 10 * digits + (*at - '0');
      exponent -= point;
    } else {
      exponent += !point; /* digits beyond the fifteenth are cut off */
    }
  }
  if (count == 0)
    return false;
  if (at < end && (*at == 'e' || *at == 'E')) {
    at++;
    bool down = at < end && *at == '-';
    if (at < end && (*at == '-' || *at == '+'))
      at++;
    if (at == end)
      return false;
    int written = 0;
    for (; at < end && *at >= '0' && *at <= '9'; at++)
      written = written < 1000 ? 10 * written + (*at - '0') : written;
    exponent += down ? -written : written;
  }
  if (at != end)
    return false;
  while (exponent < 0 && digits > 0) {
    int step = exponent < -22 ? 22 : -exponent;
    digits /= vl_powers_of_ten[step];
    exponent += step;
  }
  for (; exponent > 0 && digits > 0 && digits <= 1e30; exponent--)
    digits *= 10;
  *value = negative ? -digits : digits;
  return digits <= 1e30;
}

/* Passes blanks, commas and ends of lines. */
static void pass_blanks(vlLampText *t) {
  while (t->at < t->end && (is_blank(*t->at) || is_end(*t->at) || *t->at == ','))
    if (is_end(*t->at))
      pass_end(t);
    else
      t->at++;
}

bool vl_lamp_end(vlLampText *t, uint32_t planes, uint32_t angles) {
  pass_blanks(t);
  if (t->at < t->end)
    vl_lamp_fail(t, t->line, "lamp file: more numbers than %u x %u angles need", planes,
                 angles);
  return t->at >= t->end;
}

bool vl_lamp_number(vlLampText *t, const char *what, double *value) {
  pass_blanks(t);
  if (t->at >= t->end)
    return vl_lamp_fail(t, t->line, "lamp file: it ends before the %s", what);
  const char *first = t->at;
  while (t->at < t->end && !is_blank(*t->at) && !is_end(*t->at) && *t->at != ',')
    t->at++;
  size_t length = (size_t)(t->at - first);
  if (vl_lamp_decimal(first, length, false, value))
    return true;
  return vl_lamp_fail(t, t->line, "lamp file: the %s: \"%s\" is not a number", what,
                      vl_short_text_of(first, length).text);
}

bool vl_lamp_whole(vlLampText *t, const char *what, double low, double high, uint32_t *value) {
  double number;
  if (!vl_lamp_number(t, what, &number))
    return false;
  if (number >= low && number <= high && number == floor(number)) {
    *value = (uint32_t)number;
    return true;
  }
  return vl_lamp_fail(t, t->line,
                      "lamp file: the %s is %g; a whole number from %.0f to %.0f is needed",
                      what, number, low, high);
}
