/* render/continue.c: see continue.h. */
#include "render/continue.h"

#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/context.h"
#include "cli/report.h"
#include "render/pattern.h"
#include "render/receipt.h"

static int fail_command(const Continue *c, const char *why) {
  return report_failure(STATUS_SCENE, "%s: the command in its receipt cannot be followed: %s", c->path, why);
}

/* Parses the words after "velo render". Options that do not determine the samples are ignored, so that a film cannot
 * decide where files are written; only its output names are kept. */
static int parse_command(Continue *c, const vlReceipt *receipt) {
  char *words[2 * MAX_OPTIONS + 4];
  const char *word;
  int count = 0, most = (int)(sizeof words / sizeof *words);
  for (uint32_t i = 0; (word = vl_receipt_command(receipt, i)); i++) {
    if (i < 2 && strcmp(word, i ? "render" : "velo") != 0) return fail_command(c, "it is not velo render");
    if (i < 2) continue;
    if (count == most) return fail_command(c, "it is too long");
    if (strlen(word) >= RECEIPT_MOST_WORD) return fail_command(c, "a word is too long");
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) return fail_command(c, "it asks for help");
    words[count++] = (char *)(uintptr_t)word; /* is not changed */
  }
  if (count == 0) return fail_command(c, "there is none");
  report_usage_of(c->path);
  int status = options_parse(&render_command, count, words, &c->arguments);
  report_usage_of(NULL);
  if (status >= 0) return status;
  for (const Option *option = render_options; option->name; option++)
    if (c->arguments.values[option->id].given && !receipt_option_counts(option->id))
      return report_failure(STATUS_SCENE, "%s: the command in its receipt has --%s, which does not make an image",
                            c->path, option->name);
  return c->arguments.operand_count == 1 ? -1 : fail_command(c, "it names no scene");
}

/* Given options replace those of the film. Options that must not change are compared later. */
static void take_options(Continue *c, const Arguments *given, const vlReceipt *receipt) {
  Arguments *a = &c->arguments;
  for (const Option *option = render_options; option->name; option++)
    if (given->values[option->id].given) a->values[option->id] = given->values[option->id];
  if (given->values[RENDER_TIME].given && !given->values[RENDER_SPP].given) a->values[RENDER_SPP].given = false;
  memcpy(a->texts, given->texts, sizeof given->texts);
  a->text_count = given->text_count;
  memcpy(a->folders, given->folders, sizeof given->folders);
  a->folder_count = given->folder_count;
  const char *output;
  bool part =
      given->values[RENDER_SAMPLES].given || given->values[RENDER_SHARD].given || given->values[RENDER_TILES].given;
  for (uint32_t i = 0; !given->text_count && !part && (output = vl_receipt_output(receipt, i)); i++)
    if (a->text_count < MAX_TEXTS) a->texts[a->text_count++] = output;
}

static int take_scene(Continue *c, const Arguments *given) {
  const char *path = given->operand_count ? given->operands[0] : c->arguments.operands[0];
  c->arguments.operands[0] = path;
  return given->operand_count ? -1 : receipt_check_scene(path, "the film", c->path, "--continue");
}

int continue_open(Continue *c, const Arguments **arguments) {
  const Arguments *given = *arguments;
  if (!given->values[RENDER_CONTINUE].given) return -1;
  if (given->values[RENDER_AGAIN].given) return report_usage("--continue and --again exclude each other");
  vlContextDef def = vl_default_context_def();
  vlError error = {0};
  def.threads = 1;
  def.log = report_log;
  c->path = given->values[RENDER_CONTINUE].text;
  char first[4096];
  const PatternValues left = {0, "", "", "left"};
  bool eyes = pattern_has(c->path, 'v');
  if (eyes && !pattern_expand(c->path, &left, first, sizeof first))
    return report_usage("--continue: the name is too long");
  int status = context_open(&def, &c->context);
  if (status >= 0) return status;
  vlResult result = vl_film_file_open(c->context, eyes ? first : c->path, &c->file, &error);
  if (result != VL_OK) return report_error(&error, result, NULL);
  const vlReceipt *receipt = vl_film_file_receipt(c->file);
  if (!receipt) return report_failure(STATUS_SCENE, "%s: the film has no receipt: what made it is not known", c->path);
  status = parse_command(c, receipt);
  if (status < 0) take_options(c, given, receipt);
  if (eyes && !given->values[RENDER_EYE].given) c->arguments.values[RENDER_EYE].given = false;
  if (status < 0) status = take_scene(c, given);
  *arguments = &c->arguments;
  return status;
}

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

static int compare(const char *path, const vlReceipt *then, const vlReceipt *now) {
  Difference d = {.count = 0};
  if (!then) return report_failure(STATUS_SCENE, "%s: the film has no receipt: what made it is not known", path);
  vl_receipt_compare(then, now, VL_RECEIPT_SEQUENCE | VL_RECEIPT_FILES | VL_RECEIPT_CAMERA | VL_RECEIPT_SETTINGS,
                     name_difference, &d);
  if (!d.count) return -1;
  char more[40] = "";
  if (d.more) snprintf(more, sizeof more, "; and %u more", d.more);
  return report_failure(STATUS_SCENE, "%s cannot be continued: %s%s", path, d.text, more);
}

/* Finds the pixels that have samples, and the samples of the first block. */
static int find_extent(const char *path, vlFilmFile *file, uint32_t crop[4], vlSampleRange *range) {
  vlFilmBlock block;
  vlError error = {0};
  bool any = false;
  for (;;) {
    vlResult result = vl_film_file_next(file, false, &block, &error);
    if (result != VL_OK) return report_error(&error, result, NULL);
    if (block.x1 == 0) return any ? -1 : report_failure(STATUS_SCENE, "%s: the film has no samples", path);
    if (!block.range_count) continue;
    const uint32_t place[4] = {block.x0, block.y0, block.x1, block.y1};
    for (int i = 0; i < 4; i++)
      if (!any || (i < 2 ? place[i] < crop[i] : place[i] > crop[i])) crop[i] = place[i];
    if (!any) *range = block.ranges[0];
    any = true;
  }
}

/* Returns whether the wanted part continues the film. */
static int take_extent(const char *path, vlFilmFile *file, const Arguments *arguments, vlSceneDefs *defs) {
  const OptionValue *v = arguments->values;
  uint32_t crop[4] = {0, 0, 0, 0};
  vlSampleRange range = {0, 0};
  int status = find_extent(path, file, crop, &range);
  if (status >= 0) return status;
  bool tiles = v[RENDER_TILES].given || v[RENDER_SHARD_BY].given;
  if (tiles && memcmp(crop, defs->film.crop, sizeof crop) != 0)
    return report_usage("%s holds the pixels %u,%u,%u,%u, not those of this part", path, crop[0], crop[1], crop[2],
                        crop[3]);
  memcpy(defs->film.crop, crop, sizeof crop);
  bool part = v[RENDER_SAMPLES].given || (v[RENDER_SHARD].given && !tiles);
  if (part && range.first != defs->render.first_sample)
    return report_usage("%s holds the samples %u:%u, not those of this part", path, range.first, range.end);
  defs->render.first_sample = range.first;
  if (range.end > defs->render.spp)
    return report_usage("%s holds the samples %u:%u already; --spp is %u", path, range.first, range.end,
                        defs->render.spp);
  return -1;
}

int continue_film(const char *path, const Arguments *arguments, const vlReceipt *now, vlContext *context,
                  vlSceneDefs *defs, vlFilm **film) {
  vlFilmFile *file;
  vlError error = {0};
  vlResult result = vl_film_file_open(context, path, &file, &error);
  if (result != VL_OK) return report_error(&error, result, NULL);
  int status = compare(path, vl_film_file_receipt(file), now);
  if (status < 0) status = take_extent(path, file, arguments, defs);
  vl_film_file_close(file);
  if (status >= 0) return status;
  result = vl_film_read(context, path, false, film, &error);
  return result == VL_OK ? -1 : report_error(&error, result, NULL);
}

void continue_close(Continue *c) {
  vl_film_file_close(c->file);
  vl_context_destroy(c->context);
}
