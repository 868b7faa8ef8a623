/* cli/text.c: see text.h. */
#include "cli/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

bool text_ends_with(const char *text, const char *suffix) {
  size_t n = strlen(text), m = strlen(suffix);
  return n >= m && strcasecmp(text + n - m, suffix) == 0;
}

const char *text_file_name(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? slash + 1 : path;
}

void text_add(char *text, size_t size, const char *format, ...) {
  const size_t used = strlen(text);
  va_list values;
  va_start(values, format);
  vsnprintf(text + used, size - used, format, values);
  va_end(values);
}

void text_list(char *text, size_t size, const char *const *words, int count) {
  text[0] = 0;
  for (int i = 0; i < count; i++)
    text_add(text, size, "%s%s", i ? ", " : "", words[i]);
}

void text_print_plain(const char *text) {
  for (const char *s = text; *s; s++)
    putchar((unsigned char)*s < 0x20 || *s == 0x7f ? '?' : *s);
}

/* Control characters that a terminal may obey: all but tab and newline. */
static bool is_control(char c) {
  return ((unsigned char)c < 0x20 && c != '\t' && c != '\n') || c == 0x7f;
}

void text_shell_word(FILE *out, const char *word) {
  static const char plain[] =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+%@";
  if (*word && strspn(word, plain) == strlen(word)) {
    fprintf(out, " %s", word);
    return;
  }
  fputs(" '", out);
  for (; *word; word++) {
    if (*word == '\'')
      fputs("'\\''", out);
    else if (is_control(*word))
      fprintf(out, "'\"$(printf '\\%03o')\"'", (unsigned)(unsigned char)*word);
    else
      fputc(*word, out);
  }
  fputc('\'', out);
}

bool text_take_word(const char **list, char *word, size_t size) {
  if (!*list)
    return false;
  const size_t length = strcspn(*list, ",");
  snprintf(word, size, "%.*s", (int)length, *list);
  *list = (*list)[length] ? *list + length + 1 : NULL;
  return true;
}

bool parse_numbers(const char *text, int count, double *values) {
  for (int i = 0; i < count; i++) {
    char *end;
    values[i] = strtod(text, &end);
    if (end == text || !isfinite(values[i]))
      return false;
    text = end;
    if (i + 1 < count && *text++ != ',')
      return false;
  }
  return *text == 0;
}
