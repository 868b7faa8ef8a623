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
  if (n > MAX_NAME || m > MAX_NAME) return MAX_NAME;
  uint32_t before[MAX_NAME + 1], last[MAX_NAME + 1], row[MAX_NAME + 1];
  for (size_t j = 0; j <= m; j++) last[j] = (uint32_t)j, before[j] = 0;
  for (size_t i = 1; i <= n; i++) {
    row[0] = (uint32_t)i;
    for (size_t j = 1; j <= m; j++) {
      int ca = tolower((unsigned char)a[i - 1]), cb = tolower((unsigned char)b[j - 1]);
      row[j] = min3(last[j] + 1, row[j - 1] + 1, last[j - 1] + (ca != cb));
      if (i > 1 && j > 1 && ca == tolower((unsigned char)b[j - 2]) && cb == tolower((unsigned char)a[i - 2]) &&
          before[j - 2] + 1 < row[j])
        row[j] = before[j - 2] + 1;
    }
    memcpy(before, last, sizeof last);
    memcpy(last, row, sizeof row);
  }
  return last[m];
}

const char *vl_nearest_name(const char *name, const char *const *names, size_t count) {
  const char *best = NULL;
  uint32_t best_distance = MAX_NAME;
  for (size_t i = 0; i < count; i++) {
    uint32_t d = vl_edit_distance(name, names[i]);
    if (d < best_distance) best_distance = d, best = names[i];
  }
  size_t length = strlen(name);
  return best && best_distance * 3 <= (length > 3 ? length : 3) ? best : NULL;
}

void vl_tell_names(char *text, size_t size, const char *name, const char *const *names, size_t count) {
  const char *near = vl_nearest_name(name, names, count);
  char list[256] = "";
  for (size_t i = 0; i < count && !near; i++) vl_list_name(list, sizeof list, names[i]);
  if (near)
    snprintf(text, size, "; the nearest is \"%s\"", near);
  else
    snprintf(text, size, "; known are%s", list + (list[0] == ':'));
}

void vl_list_name(char *list, size_t size, const char *name) {
  size_t used = strlen(list), length = strlen(name);
  if (used + 2 + length >= size) return;
  memcpy(list + used, used ? ", " : ": ", 2);
  memcpy(list + used + 2, name, length + 1);
}

bool vl_ends_with(const char *text, const char *suffix) {
  size_t n = strlen(text), m = strlen(suffix);
  return n >= m && strcasecmp(text + n - m, suffix) == 0;
}

bool vl_path_join(const char *base_file, const char *name, char *result, size_t size) {
  const char *slash = base_file ? strrchr(base_file, '/') : NULL;
  int n = name[0] == '/' || !slash ? snprintf(result, size, "%s", name)
                                   : snprintf(result, size, "%.*s/%s", (int)(slash - base_file), base_file, name);
  return n >= 0 && (size_t)n < size;
}
