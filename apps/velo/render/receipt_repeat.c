/* render/receipt_repeat.c: see receipt_repeat.h. */
#include "render/receipt_repeat.h"

#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "render/receipt.h"

/* ---- the command ------------------------------------------------------------------------- */

static int fail_command(const char *path, const char *why) {
  return report_failure(STATUS_SCENE, "%s: the command in its receipt cannot be followed: %s",
                        path, why);
}

int receipt_parse_command(const vlReceipt *receipt, const char *path, Arguments *arguments) {
  char *words[2 * MAX_OPTIONS + 4];
  const char *word;
  int count = 0, max = (int)(LENGTH(words));
  for (uint32_t i = 0; (word = vl_receipt_command(receipt, i)); i++) {
    if (i < 2 && strcmp(word, i ? "render" : "velo") != 0)
      return fail_command(path, "it is not velo render");
    if (i < 2)
      continue;
    if (count == max)
      return fail_command(path, "it is too long");
    if (strlen(word) >= RECEIPT_MAX_WORD)
      return fail_command(path, "a word is too long");
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0)
      return fail_command(path, "it asks for help");
    words[count++] = (char *)(uintptr_t)word; /* is not changed */
  }
  if (count == 0)
    return fail_command(path, "there is none");
  report_usage_of(path);
  int status = options_parse(&render_command, count, words, arguments);
  report_usage_of(NULL);
  if (status >= 0)
    return status;
  for (const Option *option = render_options; option->name; option++)
    if (arguments->values[option->id].given && !receipt_option_counts(arguments, option->id))
      return report_failure(
          STATUS_SCENE, "%s: the command in its receipt has --%s, which does not make an image",
          path, option->name);
  return arguments->operand_count == 1 ? -1 : fail_command(path, "it names no scene");
}

void receipt_take_names(Arguments *arguments, const Arguments *given) {
  memcpy(arguments->texts, given->texts, sizeof given->texts);
  arguments->text_count = given->text_count;
  memcpy(arguments->folders, given->folders, sizeof given->folders);
  arguments->folder_count = given->folder_count;
}

/* ---- differences ------------------------------------------------------------------------- */

/* The first differences are named in one line; the rest are counted. */
typedef struct Difference {
  char text[500];
  uint32_t count, more;
} Difference;

static bool name_difference(void *user, const char *text) {
  Difference *d = user;
  size_t used = strlen(d->text), room = sizeof d->text - used;
  if (d->count++ == 0 || strlen(text) + 3 < room)
    snprintf(d->text + used, room, "%s%s", used ? "; " : "", text);
  else
    d->more++;
  return true;
}

bool receipt_differences(const vlReceipt *then, const vlReceipt *now, uint32_t parts,
                         char *text, size_t size) {
  Difference difference = {.count = 0};
  vl_receipt_compare(then, now, parts, name_difference, &difference);
  char more[40] = "";
  if (difference.more)
    text_set(more, "; and %u more", difference.more);
  snprintf(text, size, "%s%s", difference.text, more);
  return difference.count > 0;
}

int receipt_report_differences(const vlReceipt *then, const vlReceipt *now, uint32_t parts,
                               const char *path) {
  char text[600];
  if (!receipt_differences(then, now, parts, text, sizeof text))
    return -1;
  return report_failure(STATUS_SCENE, "%s: %s", path, text);
}
