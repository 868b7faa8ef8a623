/* view/lecture.c: see lecture.h. */
#include "view/lecture.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/view.h"
#include "view/web_files.h"

enum { DEEPEST_INCLUDE = 4, MAX_PATH = 200 };

const char lecture_first_scene[] = "scenes/lecture/pinhole.pbrt";
static const char folder[] = "scenes/lecture/";

const WebFile *web_file_find(const char *name) {
  for (const WebFile *file = web_files; file->name; file++)
    if (strcmp(file->name, name) == 0)
      return file;
  return NULL;
}

const char *lecture_scene(const char *name) {
  size_t n = sizeof folder - 1;
  const WebFile *file =
      strncmp(name, folder, n) == 0 && !strchr(name + n, '/') ? web_file_find(name) : NULL;
  return file ? file->name : NULL;
}

/* The first `Include "PATH"` from `text` to `end` that is no comment; null: there is none. Sets
 * the file that it names, by a path relative to the scene's folder, and what follows it. */
static const char *find_include(const char *text, const char *end, const WebFile **file,
                                const char **rest) {
  static const char word[] = "Include \"";
  for (const char *s = text; s < end; s++) {
    char path[MAX_PATH];
    int size = 0;
    if (*s == '#')
      s = memchr(s, '\n', (size_t)(end - s));
    if (!s)
      return NULL;
    if (*s != 'I' || strncmp(s, word, sizeof word - 1) != 0)
      continue;
    if (sscanf(s + sizeof word - 1, "%150[^\"\n]\"%n", path + sizeof folder - 1, &size) != 1 ||
        !size)
      continue;
    memcpy(path, folder, sizeof folder - 1);
    *file = web_file_find(path);
    *rest = s + sizeof word - 1 + size;
    if (*file)
      return s;
  }
  return NULL;
}

static void write_text(const WebFile *file, int depth, FILE *out) {
  const char *text = (const char *)file->data, *end = text + file->size, *rest;
  const WebFile *inner;
  const char *at;
  while (depth < DEEPEST_INCLUDE && (at = find_include(text, end, &inner, &rest))) {
    fwrite(text, 1, (size_t)(at - text), out);
    write_text(inner, depth + 1, out);
    text = rest;
  }
  fwrite(text, 1, (size_t)(end - text), out);
}

char *lecture_text(const char *scene) {
  char *text = NULL;
  size_t size;
  const WebFile *file = web_file_find(scene);
  FILE *out = file ? open_memstream(&text, &size) : NULL;
  if (!out)
    return NULL;
  write_text(file, 0, out);
  return fclose(out) == 0 ? text : NULL;
}

const char *lecture_query(const Arguments *arguments) {
  /* the first that is set, as POSIX has it */
  static const char *const variables[] = {"LC_ALL", "LC_MESSAGES", "LANG"};
  const OptionValue *chosen = &arguments->values[VIEW_LANGUAGE];
  bool italian = chosen->given && chosen->integer == LANGUAGE_ITALIAN;
  for (int i = 0; i < 3 && !chosen->given; i++) {
    const char *value = getenv(variables[i]);
    if (!value || !*value)
      continue;
    italian = strncmp(value, "it", 2) == 0 && !isalpha((unsigned char)value[2]);
    break;
  }
  return italian ? "?language=it" : "?language=en";
}
