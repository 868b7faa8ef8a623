/* base/text.c: see text.h. */
#include "base/text.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { MAX_NAME = 96 };

static uint32_t min3(uint32_t a, uint32_t b, uint32_t c) {
  uint32_t m = a < b ? a : b;
  return m < c ? m : c;
}

uint32_t vl_edit_distance(const char *a, const char *b) {
  size_t n = strlen(a), m = strlen(b);
  if (n > MAX_NAME || m > MAX_NAME)
    return MAX_NAME;
  uint32_t before[MAX_NAME + 1], last[MAX_NAME + 1], row[MAX_NAME + 1];
  for (size_t j = 0; j <= m; j++) {
    last[j] = (uint32_t)j;
    before[j] = 0;
  }
  for (size_t i = 1; i <= n; i++) {
    row[0] = (uint32_t)i;
    for (size_t j = 1; j <= m; j++) {
      int ca = tolower((unsigned char)a[i - 1]), cb = tolower((unsigned char)b[j - 1]);
      row[j] = min3(last[j] + 1, row[j - 1] + 1, last[j - 1] + (ca != cb));
      if (i > 1 && j > 1 && ca == tolower((unsigned char)b[j - 2]) &&
          cb == tolower((unsigned char)a[i - 2]) && before[j - 2] + 1 < row[j])
        row[j] = before[j - 2] + 1;
    }
    memcpy(before, last, sizeof last);
    memcpy(last, row, sizeof row);
  }
  return last[m];
}

size_t vl_name_index(const char *word, const char *const *names, size_t count) {
  size_t index = 0;
  while (index < count && !vl_text_is(word, names[index]))
    index++;
  return index;
}

const char *vl_nearest_name(const char *name, const char *const *names, size_t count) {
  const char *best = NULL;
  uint32_t best_distance = MAX_NAME;
  for (size_t i = 0; i < count; i++) {
    uint32_t d = vl_edit_distance(name, names[i]);
    if (d < best_distance) {
      best_distance = d;
      best = names[i];
    }
  }
  size_t length = strlen(name);
  return best && best_distance * 3 <= (length > 3 ? length : 3) ? best : NULL;
}

void vl_tell_names(char *text, size_t size, const char *name, const char *const *names,
                   size_t count) {
  const char *near = vl_nearest_name(name, names, count);
  char list[512] = "";
  for (size_t i = 0; i < count && !near; i++)
    vl_list_name(list, sizeof list, names[i]);
  if (near)
    snprintf(text, size, "; the nearest is \"%s\"", near);
  else
    snprintf(text, size, "; known are%s", list + (list[0] == ':'));
}

void vl_list_name(char *list, size_t size, const char *name) {
  size_t used = strlen(list), length = strlen(name);
  if (used + 2 + length >= size)
    return;
  memcpy(list + used, used ? ", " : ": ", 2);
  memcpy(list + used + 2, name, length + 1);
}

size_t vl_utf8_length(const char *text, size_t length, uint32_t *code) {
  const unsigned char *bytes = (const unsigned char *)text;
  /* by the number of bytes: the smallest code point; the highest bits of the first byte */
  static const uint32_t min[5] = {0, 0, 0x80, 0x800, 0x10000};
  static const unsigned char lead[5] = {0, 0x00, 0xc0, 0xe0, 0xf0},
                             mask[5] = {0, 0x80, 0xe0, 0xf0, 0xf8};
  size_t n = 1;
  while (n <= 4 && (bytes[0] & mask[n]) != lead[n])
    n++;
  if (n > 4 || n > length)
    return 0;
  *code = bytes[0] & ~(uint32_t)mask[n];
  for (size_t i = 1; i < n; i++) {
    if (bytes[i] >> 6 != 2)
      return 0;
    *code = *code << 6 | (bytes[i] & 0x3fu);
  }
  return *code >= min[n] && *code <= 0x10ffff && *code >> 11 != 0x1b ? n : 0;
}

bool vl_is_utf8(const char *text) {
  size_t length = strlen(text), n = 1;
  uint32_t code;
  for (size_t at = 0; at < length && n; at += n)
    n = vl_utf8_length(text + at, length - at, &code);
  return n > 0;
}

/* Whether a character is a control character, has no width, or changes the direction of
 * writing. */
static bool is_hidden(uint32_t c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0xad || (c >= 0x200b && c <= 0x200f) ||
         (c >= 0x2028 && c <= 0x202e) || (c >= 0x2060 && c <= 0x206f) || c == 0xfeff ||
         c >= 0xe0000;
}

/* The first `max` characters, as far as they and the mark of what is left out fit into `size`
 * bytes. */
static void show(const char *text, size_t length, uint32_t max, char *result, size_t size) {
  const char *const more = "\u2026";
  size_t used = 0, at = 0;
  for (uint32_t shown = 0; at < length && shown < max; shown++) {
    uint32_t code = 0;
    size_t n = vl_utf8_length(text + at, length - at, &code);
    if (used + (n ? n : 1) + strlen(more) >= size)
      break;
    if (n == 0 || is_hidden(code)) {
      result[used++] = '?';
    } else {
      memcpy(result + used, text + at, n);
      used += n;
    }
    at += n ? n : 1;
  }
  snprintf(result + used, size - used, "%s", at < length ? more : "");
}

vlShortText vl_short_text_of(const char *text, size_t length) {
  vlShortText result;
  show(text, length, 12, result.text, sizeof result.text);
  return result;
}

vlArgumentText vl_argument_text(const char *text) {
  vlArgumentText result;
  show(text ? text : "", text ? strlen(text) : 0, 200, result.text, sizeof result.text);
  return result;
}

vlShortText vl_short_text(const char *text) {
  return vl_short_text_of(text ? text : "", text ? strlen(text) : 0);
}

void vl_shorten_quoted(vlError *error, const char *text) {
  char quoted[sizeof(vlArgumentText) + 2], tail[sizeof error->message];
  snprintf(quoted, sizeof quoted, "\"%s\"", vl_argument_text(text).text);
  char *at = strstr(error->message, quoted);
  if (!at)
    return;
  const size_t before = (size_t)(at - error->message) + 1;
  snprintf(tail, sizeof tail, "%s", at + strlen(quoted) - 1);
  snprintf(error->message + before, sizeof error->message - before, "%s%s",
           vl_short_text(text).text, tail);
}

void vl_make_printable(char *message) {
  size_t length = strlen(message), used = 0;
  for (size_t at = 0; at < length;) {
    uint32_t code = 0;
    size_t n = vl_utf8_length(message + at, length - at, &code);
    bool cut = n == 0 && length - at < 4 && (unsigned char)message[at] >= 0xc0;
    for (size_t i = at + 1; i < length && cut; i++)
      cut = (unsigned char)message[i] >> 6 == 2;
    if (cut)
      break;
    if (n == 0 || is_hidden(code)) {
      message[used++] = n == 1 && (code == '\n' || code == '\t') ? ' ' : '?';
    } else {
      memmove(message + used, message + at, n);
      used += n;
    }
    at += n ? n : 1;
  }
  message[used] = 0;
}

size_t vl_json_problem_length(const char *message) {
  const char *quote = strstr(message, " near '");
  return quote ? (size_t)(quote - message) : strlen(message);
}

bool vl_has_word_of(const char *words, const char *word, size_t length) {
  for (const char *at = words; *at; at += strspn(at, " ")) {
    const size_t n = strcspn(at, " ");
    if (n == length && memcmp(at, word, n) == 0)
      return true;
    at += n;
  }
  return false;
}

bool vl_has_word(const char *words, const char *word) {
  return word && vl_has_word_of(words, word, strlen(word));
}

size_t vl_folder_length(const char *path) {
  const char *slash = strrchr(path, '/');
  return slash ? (size_t)(slash - path) + 1 : 0;
}

const char *vl_last_part(const char *name) {
  const char *dot = strrchr(name, '.');
  return dot ? dot + 1 : name;
}

bool vl_folder_of(const char *path, char *folder, size_t size) {
  const size_t length = vl_folder_length(path);
  const int n = snprintf(folder, size, "%.*s", length ? (int)length : 1, length ? path : ".");
  return n >= 0 && (size_t)n < size;
}

bool vl_ends_with(const char *text, const char *suffix) {
  size_t n = strlen(text), m = strlen(suffix);
  return n >= m && strcasecmp(text + n - m, suffix) == 0;
}

bool vl_names_lamp(const char *path) {
  static const char *const ends[] = {".ies", ".ldt"};
  for (size_t i = 0; path && i < VL_LENGTH(ends); i++)
    if (vl_ends_with(path, ends[i]))
      return true;
  return false;
}

bool vl_path_join(const char *base_file, const char *name, char *result, size_t size) {
  const char *slash = base_file ? strrchr(base_file, '/') : NULL;
  int n = name[0] == '/' || !slash
              ? snprintf(result, size, "%s", name)
              : snprintf(result, size, "%.*s/%s", (int)(slash - base_file), base_file, name);
  return n >= 0 && (size_t)n < size;
}
