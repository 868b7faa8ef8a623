/* scene/upgrade.c: `velo scene upgrade`: rewrites a pbrt-v3 scene as a pbrt-v4 scene and lists
 * what it changed. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/report.h"
#include "cli/text.h"
#include "scene/scene.h"
#include "velo/upgrade.h"

enum { UPGRADE_STRICT, UPGRADE_ALL, UPGRADE_QUIET, UPGRADE_SEARCH, UPGRADE_SANDBOX };
enum { SHOWN = 5 }; /* changes with the same text that are printed without --all */

typedef struct Kind {
  char *text;
  unsigned count;
} Kind;

typedef struct List {
  Kind *kinds;
  size_t count, capacity;
  unsigned changes, lost;
  bool all, quiet;
} List;

/* Counts a message by its text. An old list that cannot grow counts it as new. */
static unsigned count_text(List *list, const char *text) {
  for (size_t i = list->count; i > 0; i--)
    if (strcmp(list->kinds[i - 1].text, text) == 0)
      return ++list->kinds[i - 1].count;
  if (list->count == 1000)
    return 1;
  if (list->count == list->capacity) {
    size_t wanted = list->capacity ? 2 * list->capacity : 64;
    Kind *grown = realloc(list->kinds, wanted * sizeof *grown);
    if (!grown)
      return 1;
    list->kinds = grown;
    list->capacity = wanted;
  }
  char *copy = strdup(text);
  if (copy)
    list->kinds[list->count++] = (Kind){copy, 1};
  return 1;
}

static void take_note(void *user, vlUpgradeNote note, const vlError *location,
                      const char *message) {
  static const char *const kinds[] = {"", "lost: ", "wrote: "};
  List *list = user;
  if (note == VL_UPGRADE_CHANGED)
    list->changes++;
  if (note == VL_UPGRADE_LOST)
    list->lost++;
  if (list->quiet && note != VL_UPGRADE_LOST)
    return;
  if (note == VL_UPGRADE_CHANGED && count_text(list, message) > SHOWN && !list->all)
    return;
  text_print_plain(location->file);
  if (location->line)
    printf(":%u", location->line);
  printf(": %s", kinds[note]);
  text_print_plain(message);
  putchar('\n');
}

static void print_more(const List *list) {
  for (size_t i = 0; i < list->count && !list->all && !list->quiet; i++)
    if (list->kinds[i].count > SHOWN)
      printf("%u more: %s (--all shows them)\n", list->kinds[i].count - SHOWN,
             list->kinds[i].text);
}

static int run(const Arguments *arguments, vlContext *context) {
  const OptionValue *v = arguments->values;
  vlError error = {0};
  List list = {.all = v[UPGRADE_ALL].given, .quiet = v[UPGRADE_QUIET].given};
  vlUpgradeDef def = vl_default_upgrade_def();
  def.strict = v[UPGRADE_STRICT].given;
  def.report = take_note;
  def.report_user = &list;
  def.search_path = v[UPGRADE_SEARCH].text;
  vlResult r =
      vl_scene_upgrade(context, arguments->operands[0], arguments->operands[1], &def, &error);
  print_more(&list);
  if (r == VL_OK && !list.quiet)
    printf("%u statement%s changed, %u without counterpart\n", list.changes,
           list.changes == 1 ? "" : "s", list.lost);
  int status = r == VL_OK               ? STATUS_OK
               : r == VL_ERROR_ARGUMENT ? report_usage("%s", error.message)
                                        : report_error(&error, r, arguments->operands[0]);
  for (size_t i = 0; i < list.count; i++)
    free(list.kinds[i].text);
  free(list.kinds);
  return status;
}

static Option options[] = {
    {UPGRADE_STRICT, "strict",
     "anything without a counterpart in pbrt-v4 is an error, and nothing is written"},
    {UPGRADE_ALL, "all", "print every change; default: the first 5 with the same text",
     .letter = 'a'},
    {UPGRADE_QUIET, "quiet", "print only what has no counterpart in pbrt-v4"},
    SCENE_SEARCH_OPTION(UPGRADE_SEARCH),
    SCENE_SANDBOX_OPTION(UPGRADE_SANDBOX),
    {0}};

const Command scene_upgrade_command = {
    .name = "scene upgrade",
    .usage = "OLD NEW [options]",
    .summary = "rewrite a pbrt-v3 scene as a pbrt-v4 scene",
    .text =
        "Reads the pbrt-v3 scene OLD and the files that it includes, and writes the pbrt-v4 "
        "scene NEW.\n"
        "Comments, layout and numbers are kept. Included files that change are written to "
        "NEW's folder, and\n"
        "file names are adapted to it. Images of infinite lights become equal-area octahedral "
        "maps (.exr).\n"
        "Prints each change, and everything that has no counterpart in pbrt-v4, with its line "
        "in OLD.",
    .examples =
        "velo scene upgrade old/room.pbrt room.pbrt\n"
        "velo scene upgrade --strict scene.pbrt scene-v4.pbrt",
    .options = options,
    .operands = 2,
    .context = CONTEXT_ALL,
    .run = run,
};
