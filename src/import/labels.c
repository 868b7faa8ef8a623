/* import/labels.c: see labels.h. */
#include "import/labels.h"
#include "base/text.h"

#include <stdio.h>

void vl_label_append(char path[VL_LABEL_SIZE], const char *name) {
  if (!name || !*name)
    return;
  size_t n = strlen(path), length = strlen(name);
  if (length > VL_LABEL_PART) {
    length = VL_LABEL_PART;
    while (length > 0 && ((unsigned char)name[length] & 0xc0) == 0x80)
      length--; /* a byte inside a UTF-8 character */
  }
  if (n + length + 2 > VL_LABEL_SIZE)
    return;
  if (n)
    path[n++] = '/';
  memcpy(path + n, name, length);
  path[n + length] = 0;
}

bool vl_label_make_unique(vlScene *scene, vlNameTable *table, const char *name, size_t number,
                          const char **result) {
  char text[VL_LABEL_SIZE + 64];
  uint32_t before = 0;
  snprintf(text, sizeof text, "%.*s", VL_LABEL_SIZE - 1, name);
  if (vl_names_find(table, text, &before)) {
    snprintf(text, sizeof text, "%.*s#%zu", VL_LABEL_SIZE - 1, name, number);
    for (uint32_t k = 2; vl_names_find(table, text, &before); k++)
      snprintf(text, sizeof text, "%.*s#%zu.%u", VL_LABEL_SIZE - 1, name, number, k);
  }
  *result = text;
  if (!vl_scene_copy_string(scene, result))
    return false;
  if (vl_names_add(scene->context, table, *result, 0))
    return true;
  return vl_scene_fail_memory(scene);
}

void vl_label_of_file(const char *path, char name[VL_LABEL_SIZE]) {
  const char *start = vl_file_name(path), *dot = strrchr(start, '.');
  if (dot && dot > start && vl_text_is(dot, ".gz"))
    while (dot > start && *--dot != '.') {
    }
  char stem[VL_LABEL_SIZE];
  snprintf(stem, sizeof stem, "%.*s",
           dot && dot > start ? (int)(dot - start) : (int)strlen(start), start);
  name[0] = 0;
  vl_label_append(name, stem);
}
