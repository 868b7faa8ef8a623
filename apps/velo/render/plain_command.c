/* render/plain_command.c: see plain_command.h. */
#include "render/plain_command.h"

#include <stdio.h>
#include <string.h>

#include "cli/text.h"
#include "render/job.h"

static void add_option(FILE *out, const Option *option, const char *value) {
  char name[40];
  snprintf(name, sizeof name, "--%s", option->name);
  if (option->letter)
    snprintf(name, sizeof name, "-%c", option->letter);
  text_shell_word(out, name);
  if (option->kind != OPTION_FLAG)
    text_shell_word(out, value);
}

bool plain_command(const Arguments *arguments, char *text, size_t size) {
  const char *path = arguments->operands[0];
  FILE *out = fmemopen(text, size, "w");
  *text = 0;
  if (!out)
    return false;
  fputs("velo render", out);
  if (path[0] == '-') {
    char file[4200];
    snprintf(file, sizeof file, "./%s", path);
    text_shell_word(out, file);
  } else {
    text_shell_word(out, path);
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
        add_option(out, option, all[i]);
    } else {
      add_option(out, option, value->text);
    }
  }
  fputs(" --plain", out);
  return fclose(out) == 0 && strlen(text) + 1 < size;
}
