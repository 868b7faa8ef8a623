/* cli/json.c: see json.h. */
#include "cli/json.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "cli/macros.h"

/* Length of the UTF-8 sequence at s; 0 when invalid (overlong forms and surrogates
 * included). */
static size_t utf8_length(const unsigned char *s) {
  if (s[0] < 0x80)
    return 1;
  size_t n = s[0] >= 0xc2 && s[0] < 0xe0   ? 2
             : (s[0] & 0xf0) == 0xe0       ? 3
             : s[0] >= 0xf0 && s[0] < 0xf5 ? 4
                                           : 0;
  for (size_t i = 1; i < n; i++)
    if ((s[i] & 0xc0) != 0x80)
      return 0;
  if (n == 3 && ((s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xed && s[1] >= 0xa0)))
    return 0;
  if (n == 4 && ((s[0] == 0xf0 && s[1] < 0x90) || (s[0] == 0xf4 && s[1] >= 0x90)))
    return 0;
  return n;
}

static void put_string(FILE *out, const char *text) {
  const unsigned char *s = (const unsigned char *)text;
  fputc('"', out);
  while (*s) {
    size_t n = utf8_length(s);
    if (n == 0) {
      fputs("\\ufffd", out);
      n = 1;
    } else if (n > 1) {
      fwrite(s, 1, n, out);
    } else if (*s == '"' || *s == '\\') {
      fprintf(out, "\\%c", *s);
    } else if (*s < 0x20 || *s == 0x7f) {
      fprintf(out, "\\u%04x", *s);
    } else {
      fputc(*s, out);
    }
    s += n;
  }
  fputc('"', out);
}

static void put_key(Json *json, const char *key) {
  if (json->comma)
    fputs(", ", json->out);
  json->comma = true;
  if (key) {
    put_string(json->out, key);
    fputs(": ", json->out);
  }
}

void json_begin(Json *json, const char *key, char bracket) {
  put_key(json, key);
  fputc(bracket, json->out);
  json->comma = false;
}

void json_end(Json *json, char bracket) {
  fputc(bracket, json->out);
  json->comma = true;
}

Json *json_open(void) {
  static Json json;
  json = (Json){.out = stdout};
  json_begin(&json, NULL, '{');
  return &json;
}

void json_close(Json *json) {
  json_end(json, '}');
  fputc('\n', json->out);
}

void json_text(Json *json, const char *key, const char *text) {
  if (!text)
    return;
  put_key(json, key);
  put_string(json->out, text);
}

void format_number(char *text, size_t size, double number) {
  static const int digits[] = {6, 9, 15, 16, 17};
  for (size_t i = 0; i < LENGTH(digits); i++) {
    snprintf(text, size, "%.*g", digits[i], number);
    double back = strtod(text, NULL);
    if (back == number || number != number)
      return;
  }
}

double shortest_float(float number) {
  double back = (double)number;
  for (int digits = 6; digits <= 9; digits++) {
    char text[40];
    text_set(text, "%.*g", digits, (double)number);
    back = strtod(text, NULL);
    if ((float)back == number)
      break;
  }
  return back;
}

void json_number(Json *json, const char *key, double number) {
  put_key(json, key);
  char text[40];
  if (isfinite(number))
    format_number(text, sizeof text, number);
  fputs(isfinite(number) ? text : "null", json->out);
}

void json_integer(Json *json, const char *key, int64_t number) {
  put_key(json, key);
  fprintf(json->out, "%lld", (long long)number);
}

void json_location(Json *json, const char *file, uint32_t line, uint32_t column) {
  json_text(json, "file", file);
  if (line)
    json_integer(json, "line", line);
  if (column)
    json_integer(json, "column", column);
}

void json_numbers(Json *json, const char *key, const double *numbers, uint32_t count) {
  json_begin(json, key, '[');
  for (uint32_t i = 0; i < count; i++)
    json_number(json, NULL, numbers[i]);
  json_end(json, ']');
}

void json_integers(Json *json, const char *key, const uint32_t *numbers, uint32_t count) {
  json_begin(json, key, '[');
  for (uint32_t i = 0; i < count; i++)
    json_integer(json, NULL, numbers[i]);
  json_end(json, ']');
}

void json_bool(Json *json, const char *key, bool value) {
  put_key(json, key);
  fputs(value ? "true" : "false", json->out);
}

void json_put_list(Json *json, const char *members, va_list values) {
  for (const char *at = members; *at;) {
    char key[40];
    const char *format = strchr(at, '%');
    text_set(key, "%.*s", (int)(format - at - 1), at);
    switch (format[1]) {
      case 's':
        json_text(json, key, va_arg(values, const char *));
        break;
      case 'g':
        json_number(json, key, va_arg(values, double));
        break;
      case 'u':
        json_integer(json, key, va_arg(values, unsigned));
        break;
      case 'd':
        json_integer(json, key, va_arg(values, int));
        break;
      case 'l':
        json_integer(json, key, va_arg(values, long long));
        break;
      default: /* i */
        json_bool(json, key, va_arg(values, int));
    }
    at = format + strcspn(format, ",");
    at += strspn(at, ", ");
  }
}

void json_put(Json *json, const char *members, ...) {
  va_list values;
  va_start(values, members);
  json_put_list(json, members, values);
  va_end(values);
}
