/* render/plain_command.c: see plain_command.h. */
#include "render/plain_command.h"

#include <stdio.h>
#include <string.h>

#include "render/job.h"

static void add(char *text, size_t size, const char *part) {
  size_t used = strlen(text);
  snprintf(text + used, size - used, "%s", part);
}

/* A word as a shell reads it. */
static void add_word(char *text, size_t size, const char *word) {
  static const char plain[] =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:=+%@";
  add(text, size, *text ? " " : "");
  if (*word && strspn(word, plain) == strlen(word)) {
    add(text, size, word);
    return;
  }
  add(text, size, "'");
  for (const char *c = word; *c; c++) {
    const char one[2] = {*c, 0};
    add(text, size, *c == '\'' ? "'\\''" : one);
  }
  add(text, size, "'");
}

static void add_option(char *text, size_t size, const Option *option, const char *value) {
  char name[40];
  snprintf(name, sizeof name, "--%s", option->name);
  if (option->letter)
    snprintf(name, sizeof name, "-%c", option->letter);
  add_word(text, size, name);
  if (option->kind != OPTION_FLAG)
    add_word(text, size, value);
}

bool plain_command(const Arguments *arguments, char *text, size_t size) {
  const char *path = arguments->operands[0];
  *text = 0;
  add_word(text, size, "velo");
  add_word(text, size, "render");
  if (path[0] == '-') {
    char file[4200];
    snprintf(file, sizeof file, "./%s", path);
    add_word(text, size, file);
  } else {
    add_word(text, size, path);
  }
  for (const Option *option = render_options; option->name; option++) {
    const OptionValue *value = &arguments->values[option->id];
    if (!value->given)
      continue;
    if (option->kind == OPTION_TEXTS || option->kind == OPTION_FOLDERS) {
      const bool texts = option->kind == OPTION_TEXTS;
      const char *const *all = texts ? arguments->texts : arguments->folders;
      int count = texts ? arguments->text_count : arguments->folder_count;
      for (int i = 0; i < count; i++)
        add_option(text, size, option, all[i]);
    } else {
      add_option(text, size, option, value->text);
    }
  }
  add_word(text, size, "--plain");
  return strlen(text) + 1 < size;
}
