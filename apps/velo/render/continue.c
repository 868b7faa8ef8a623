/* render/continue.c: see continue.h. */
#include "render/continue.h"

#include <string.h>

#include "cli/context.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "render/pattern.h"
#include "render/receipt.h"
#include "render/receipt_repeat.h"

/* Given options replace those of the film. Options that must not change are compared later. */
static void take_options(Continue *c, const Arguments *given, const vlReceipt *receipt) {
  Arguments *a = &c->arguments;
  a->channels_later = given->values[RENDER_CHANNELS].given && !a->values[RENDER_CHANNELS].given;
  for (const Option *option = render_options; option->name; option++)
    if (given->values[option->id].given)
      a->values[option->id] = given->values[option->id];
  /* --time and --noise say when the render ends; the --spp of the film does so no longer */
  bool ends = given->values[RENDER_TIME].given || given->values[RENDER_NOISE].given;
  if (ends && !given->values[RENDER_SPP].given)
    a->values[RENDER_SPP].given = false;
  receipt_take_names(a, given);
  bool part = given->values[RENDER_SAMPLES].given || given->values[RENDER_SHARD].given ||
              given->values[RENDER_TILES].given;
  if (given->text_count || part)
    return;
  for (uint32_t i = 0; a->text_count < MAX_TEXTS && vl_receipt_output(receipt, i); i++) {
    a->texts[a->text_count] = vl_receipt_output(receipt, i);
    a->text_count++;
  }
}

int continue_open(Continue *c, const Arguments **arguments) {
  const Arguments *given = *arguments;
  if (!given->values[RENDER_CONTINUE].given)
    return -1;
  TRY(options_exclude(given, RENDER_CONTINUE, RENDER_AGAIN));
  vlError error = {0};
  c->path = given->values[RENDER_CONTINUE].text;
  char first[4096];
  const PatternValues left = {0, "", "", "left"};
  bool eyes = pattern_has(c->path, 'v'); /* two films; the left one tells the command */
  if (eyes && !pattern_expand(c->path, &left, first, sizeof first))
    return report_usage("--continue: the name is too long");
  TRY(context_open_one(&c->context));
  TRY(report_error(
      &error, vl_film_file_open(c->context, eyes ? first : c->path, &c->file, &error), NULL));
  const vlReceipt *receipt = vl_film_file_receipt(c->file);
  if (!receipt)
    return report_failure(STATUS_SCENE,
                          "%s: the film has no receipt: what made it is not known", c->path);
  TRY(receipt_parse_command(receipt, c->path, &c->arguments));
  take_options(c, given, receipt);
  if (eyes && !given->values[RENDER_EYE].given)
    c->arguments.values[RENDER_EYE].given = false;
  TRY(receipt_take_scene(&c->arguments, given, c->arguments.operands[0], "the film", c->path,
                         "--continue"));
  *arguments = &c->arguments;
  return -1;
}

/* A film whose samples a render takes up. */
typedef struct Source {
  const char *path;
  bool repeats; /* it is in the file of --film, and the command is repeated */
  vlFilmFile *file;
} Source;

static int refuse(const Source *source, int status, const char *format, ...) PRINTF(3, 4);
static int refuse(const Source *source, int status, const char *format, ...) {
  FORMATTED(text, format);
  if (source->repeats)
    return film_claim_refuse("%s", text);
  return status == STATUS_USAGE ? report_usage("%s", text) : report_failure(status, "%s", text);
}

static int compare(const Source *source, const vlReceipt *now) {
  const uint32_t parts =
      VL_RECEIPT_SEQUENCE | VL_RECEIPT_FILES | VL_RECEIPT_CAMERA | VL_RECEIPT_SETTINGS;
  const vlReceipt *then = vl_film_file_receipt(source->file);
  char text[600];
  if (!then)
    return refuse(source, STATUS_SCENE,
                  "%s: the film has no receipt: what made it is not known", source->path);
  if (!receipt_differences(then, now, parts, text, sizeof text))
    return -1;
  return refuse(source, STATUS_SCENE,
                source->repeats ? "%s is of another render: %s" : "%s cannot be continued: %s",
                source->path, text);
}

/* Finds the pixels that have samples, the first sample of the first block, and the last sample
 * of any. */
static int find_extent(const Source *source, uint32_t crop[4], vlSampleRange *range) {
  vlFilmBlock block;
  vlError error = {0};
  bool any = false;
  for (;;) {
    vlResult result = vl_film_file_next(source->file, false, &block, &error);
    if (result == VL_ERROR_SCENE)
      return refuse(source, STATUS_SCENE, "%s", error.message);
    if (result != VL_OK)
      return report_error(&error, result, NULL);
    if (block.x1 == 0)
      return any ? -1
                 : refuse(source, STATUS_SCENE, "%s: the film has no samples", source->path);
    if (!block.range_count)
      continue;
    const uint32_t window[4] = {block.x0, block.y0, block.x1, block.y1};
    const uint32_t end = block.ranges[block.range_count - 1].end;
    if (!any) {
      memcpy(crop, window, sizeof window);
      *range = block.ranges[0];
    }
    any = true;
    for (int i = 0; i < 2; i++) {
      crop[i] = window[i] < crop[i] ? window[i] : crop[i];
      crop[i + 2] = window[i + 2] > crop[i + 2] ? window[i + 2] : crop[i + 2];
    }
    range->end = end > range->end ? end : range->end;
  }
}

/* Whether the wanted part continues the film. --continue without a part continues whatever part
 * the film has. */
static int take_extent(const Source *source, const Arguments *arguments, vlSceneDefs *defs) {
  const OptionValue *v = arguments->values;
  uint32_t crop[4] = {0, 0, 0, 0};
  vlSampleRange range = {0, 0};
  TRY(find_extent(source, crop, &range));
  bool tiles = v[RENDER_TILES].given || v[RENDER_SHARD_BY].given;
  if ((tiles || source->repeats) && memcmp(crop, defs->film.crop, sizeof crop) != 0)
    return refuse(source, STATUS_USAGE,
                  "%s holds the pixels %u,%u,%u,%u, not those of this part", source->path,
                  crop[0], crop[1], crop[2], crop[3]);
  memcpy(defs->film.crop, crop, sizeof crop);
  bool part = v[RENDER_SAMPLES].given || (v[RENDER_SHARD].given && !tiles);
  if ((part || source->repeats) && range.first != defs->render.first_sample)
    return refuse(source, STATUS_USAGE, "%s holds the samples %u:%u, not those of this part",
                  source->path, range.first, range.end);
  defs->render.first_sample = range.first;
  if (range.end > defs->render.spp)
    return refuse(source, STATUS_USAGE, "%s holds the samples %u:%u already; %s is %u",
                  source->path, range.first, range.end, part ? "the end of this part" : "--spp",
                  defs->render.spp);
  return -1;
}

/* Whether a film has all samples of another one of the same render. Files that cannot be read
 * are reported later. */
static bool has_all(const char *path, const char *other, vlContext *context) {
  vlFilmFile *a = NULL, *b = NULL;
  bool all = vl_film_file_open(context, path, &a, NULL) == VL_OK &&
             vl_film_file_open(context, other, &b, NULL) == VL_OK;
  vlFilmBlock mine = {.x1 = 1}, its = {.x1 = 1};
  while (all && its.x1) {
    all = vl_film_file_next(a, false, &mine, NULL) == VL_OK &&
          vl_film_file_next(b, false, &its, NULL) == VL_OK;
    for (uint32_t i = 0, k = 0; all && i < its.range_count; i++) {
      while (k < mine.range_count && mine.ranges[k].end < its.ranges[i].end)
        k++;
      all = k < mine.range_count && mine.ranges[k].first <= its.ranges[i].first;
    }
  }
  vl_film_file_close(a);
  vl_film_file_close(b);
  return all;
}

/* Checks the film and, if film is not null, reads it. */
static int take_film(Source *source, const Arguments *arguments, const vlReceipt *now,
                     vlContext *context, vlSceneDefs *defs, vlFilm **film) {
  vlError error = {0};
  TRY(report_error(&error, vl_film_file_open(context, source->path, &source->file, &error),
                   NULL));
  int status = compare(source, now);
  if (status < 0)
    status = take_extent(source, arguments, defs);
  vl_film_file_close(source->file);
  if (status >= 0 || !film)
    return status;
  vlResult result = vl_film_read(context, source->path, false, film, &error);
  if (result == VL_ERROR_SCENE)
    return refuse(source, STATUS_SCENE, "%s", error.message);
  return report_error(&error, result, NULL);
}

int continue_film(const FilmClaim *claim, const Arguments *arguments, const vlReceipt *now,
                  vlContext *context, vlSceneDefs *defs, vlFilm **film) {
  Source own = {.path = claim->path, .repeats = true};
  Source from = {.path = claim->from};
  if (!claim->earlier)
    return from.path[0] ? take_film(&from, arguments, now, context, defs, film) : -1;
  if (!from.path[0])
    return take_film(&own, arguments, now, context, defs, film);
  /* --continue FROM --film FILE, which is there: repeated after FILE got more samples, or FILE
   * holds fewer */
  vlSceneDefs unused = *defs;
  TRY(take_film(&own, arguments, now, context, &unused, NULL));
  if (has_all(own.path, from.path, context))
    return take_film(&own, arguments, now, context, defs, film);
  if (has_all(from.path, own.path, context))
    return take_film(&from, arguments, now, context, defs, film);
  return film_claim_refuse("%s has samples that %s lacks", own.path, from.path);
}

void continue_close(Continue *c) {
  vl_film_file_close(c->file);
  context_close(c->context);
}
