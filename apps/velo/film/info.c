/* film/info.c: `velo film info`: lists the content of a film file, and the commands that render
 * its missing samples. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/crop.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "render/receipt.h"
#include "render/shard.h"
#include "velo/film.h"

/* A list of ranges of samples. */
typedef struct RangeList {
  vlSampleRange *ranges;
  uint32_t count;
} RangeList;

/* A rectangle of pixels and its samples. */
typedef struct FilmPart {
  uint32_t window[4];
  RangeList samples;
} FilmPart;

typedef struct FilmParts {
  FilmPart *parts;
  uint32_t count;
  RangeList *lists; /* owned; the parts point into these lists */
  uint32_t list_count;
} FilmParts;

typedef struct Grid {
  uint32_t *ids; /* by block: index of its list + 1; 0: none */
  uint32_t across, down;
} Grid;

/* Finds the parts of [0, planned) that are not in the ranges. `gaps` has room for count + 1
 * ranges. */
static uint32_t find_gaps(const vlSampleRange *ranges, uint32_t count, uint32_t planned,
                          vlSampleRange *gaps) {
  uint32_t n = 0, at = 0;
  for (uint32_t i = 0; i < count; i++) {
    uint32_t first = ranges[i].first < planned ? ranges[i].first : planned;
    if (at < first)
      gaps[n++] = (vlSampleRange){at, first};
    if (ranges[i].end > at)
      at = ranges[i].end;
  }
  if (at < planned)
    gaps[n++] = (vlSampleRange){at, planned};
  return n;
}

/* Returns the number of the list with these ranges, counted from 1. Returns 0 if out of
 * memory. */
static uint32_t find_list(FilmParts *parts, const vlSampleRange *ranges, uint32_t count) {
  for (uint32_t i = parts->list_count; i > 0; i--) {
    const RangeList *list = &parts->lists[i - 1];
    if (list->count == count && memcmp(list->ranges, ranges, count * sizeof *ranges) == 0)
      return i;
  }
  RangeList *more = realloc(parts->lists, (parts->list_count + 1) * sizeof *more);
  if (!more)
    return 0;
  parts->lists = more;
  vlSampleRange *copy = malloc(count * sizeof *copy);
  if (!copy)
    return 0;
  memcpy(copy, ranges, count * sizeof *copy);
  more[parts->list_count] = (RangeList){copy, count};
  return ++parts->list_count;
}

static int read_blocks(vlFilmFile *file, bool check, uint32_t planned, FilmParts *parts,
                       Grid *grid) {
  vlFilmBlock block;
  vlError error = {0};
  vlSampleRange *gaps = NULL;
  int status = -1;
  for (uint32_t i = 0; status < 0; i++) {
    vlResult result = vl_film_file_next(file, check, &block, &error);
    status = report_error(&error, result, NULL);
    if (status >= 0 || block.x1 == 0)
      break;
    const vlSampleRange *ranges = block.ranges;
    uint32_t count = block.range_count;
    if (planned) {
      vlSampleRange *more = realloc(gaps, (count + 1) * sizeof *gaps);
      if (!more) {
        status = report_no_memory();
        break;
      }
      gaps = more;
      count = find_gaps(ranges, count, planned, gaps);
      ranges = gaps;
    }
    grid->ids[i] = count ? find_list(parts, ranges, count) : 0;
    if (count && !grid->ids[i])
      status = report_no_memory();
  }
  free(gaps);
  return status;
}

/* Whether a run of blocks has this list. */
static bool same_run(const Grid *grid, uint32_t x, uint32_t y, uint32_t width, uint32_t id) {
  for (uint32_t i = 0; i < width; i++)
    if (grid->ids[(size_t)y * grid->across + x + i] != id)
      return false;
  return true;
}

/* Takes a rectangle that begins at a block. It is extended as far as possible to the right, and
 * then down. */
static void take_part(Grid *grid, uint32_t x, uint32_t y, const uint32_t crop[4],
                      FilmParts *parts) {
  uint32_t id = grid->ids[(size_t)y * grid->across + x], width = 1, height = 1;
  while (x + width < grid->across && grid->ids[(size_t)y * grid->across + x + width] == id)
    width++;
  while (y + height < grid->down && same_run(grid, x, y + height, width, id))
    height++;
  for (uint32_t k = 0; k < height; k++)
    memset(grid->ids + (size_t)(y + k) * grid->across + x, 0, width * sizeof *grid->ids);
  FilmPart *part = &parts->parts[parts->count++];
  const uint32_t left = crop[0] / FILM_BLOCK + x, top = crop[1] / FILM_BLOCK + y;
  const uint32_t blocks[4] = {left, top, left + width, top + height};
  shard_block_window(blocks, crop, part->window);
  part->samples = parts->lists[id - 1];
}

/* Reads all blocks and groups them; `check` also verifies their checksums. If planned is 0, the
 * parts list the samples that the film has. Otherwise they list the samples of [0, planned)
 * that it lacks. Parts without samples are omitted. Returns -1, or the exit code after
 * reporting the error. */
static int film_parts_read(vlFilmFile *file, bool check, uint32_t planned, FilmParts *parts) {
  const uint32_t *crop = vl_film_file_def(file)->crop;
  Grid grid = {.across = (crop[2] + FILM_BLOCK - 1) / FILM_BLOCK - crop[0] / FILM_BLOCK,
               .down = (crop[3] + FILM_BLOCK - 1) / FILM_BLOCK - crop[1] / FILM_BLOCK};
  memset(parts, 0, sizeof *parts);
  size_t blocks = (size_t)grid.across * grid.down;
  grid.ids = calloc(blocks, sizeof *grid.ids);
  int status = grid.ids ? read_blocks(file, check, planned, parts, &grid) : report_no_memory();
  uint32_t used = 0;
  for (size_t i = 0; i < blocks && status < 0; i++)
    used += grid.ids[i] != 0;
  if (status < 0 && !(parts->parts = calloc(used ? used : 1, sizeof *parts->parts)))
    status = report_no_memory();
  for (uint32_t y = 0; y < grid.down && status < 0; y++)
    for (uint32_t x = 0; x < grid.across; x++)
      if (grid.ids[(size_t)y * grid.across + x])
        take_part(&grid, x, y, crop, parts);
  free(grid.ids);
  return status;
}

static void film_parts_free(FilmParts *parts) {
  for (uint32_t i = 0; i < parts->list_count; i++)
    free(parts->lists[i].ranges);
  free(parts->lists);
  free(parts->parts);
}

enum { INFO_MISSING, INFO_CHECK };

static bool same_rectangle(const uint32_t a[4], const uint32_t b[4]) {
  return memcmp(a, b, 4 * sizeof *a) == 0;
}

static void print_rectangle(const char *before, const uint32_t r[4]) {
  printf("%s%u,%u,%u,%u", before, r[0], r[1], r[2], r[3]);
}

static void print_ranges(const RangeList *list) {
  for (uint32_t i = 0; i < list->count; i++)
    printf("%s%u:%u", i ? " " : "", list->ranges[i].first, list->ranges[i].end);
}

/* The samples per pixel that the render was to have; 0: not known. */
static uint32_t planned_of(const vlFilmFile *file) {
  uint32_t planned = 0;
  const vlReceipt *receipt = vl_film_file_receipt(file);
  if (receipt)
    vl_receipt_samples(receipt, &planned);
  return planned;
}

static void print_command(const vlReceipt *receipt) {
  const char *word;
  printf("velo");
  for (uint32_t i = 1; (word = vl_receipt_command(receipt, i)); i++)
    text_shell_word(stdout, word);
}

static void print_contents(const char *path, const vlFilmFile *file, const FilmParts *parts) {
  const vlFilmDef *def = vl_film_file_def(file);
  const vlReceipt *receipt = vl_film_file_receipt(file);
  const uint32_t *c = def->crop;
  uint32_t planned = planned_of(file);
  printf("%s\n  size      %u x %u pixels", path, def->width, def->height);
  if (!crop_is_whole(c, def->width, def->height))
    print_rectangle(", crop ", c);
  printf("\n  sums      colour%s", def->errors ? ", errors" : "");
  if (def->buckets)
    printf(", spectrum of %u buckets, %g to %g nm", def->buckets, def->lambda_min,
           def->lambda_max);
  printf("\n  sequence  %u\n", vl_film_file_sequence(file));
  for (uint32_t i = 0; i < parts->count; i++) {
    const FilmPart *p = &parts->parts[i];
    printf("  samples   ");
    print_ranges(&p->samples);
    if (planned)
      printf(" of %u", planned);
    if (!same_rectangle(p->window, c))
      print_rectangle(", pixels ", p->window);
    putchar('\n');
  }
  if (!parts->count)
    printf("  samples   none\n");
  if (!receipt)
    return;
  const char *output;
  printf("  velo      ");
  receipt_print_version(receipt);
  printf("\n  command   ");
  print_command(receipt);
  putchar('\n');
  for (uint32_t i = 0; (output = vl_receipt_output(receipt, i)); i++) {
    printf("  output    ");
    text_print_plain(output);
    putchar('\n');
  }
}

static void print_merge(const char *path, const char *stem, uint32_t count) {
  char name[4200];
  printf("velo film merge");
  text_shell_word(stdout, path);
  for (uint32_t i = 1; i <= count; i++) {
    text_set(name, "%s-missing-%u.film", stem, i);
    text_shell_word(stdout, name);
  }
  printf(" -o");
  text_shell_word(stdout, path);
  putchar('\n');
}

/* Prints the command that renders missing samples of a part into the film `name`. */
static void print_render(const vlFilmFile *file, const FilmPart *part,
                         const vlSampleRange *range, const char *name) {
  const uint32_t *crop = vl_film_file_def(file)->crop, *w = part->window;
  print_command(vl_film_file_receipt(file));
  if (range->first || range->end != planned_of(file))
    printf(" --samples %u:%u", range->first, range->end);
  if (!same_rectangle(w, crop))
    print_rectangle(" --tiles ", w);
  printf(" --film");
  text_shell_word(stdout, name);
  putchar('\n');
}

/* Prints one command for each rectangle and range, and then the command that merges their
 * films. With --noise, only rectangles without any sample are listed: how many samples the
 * others need is not known before. A last command continues the film until they have enough. */
static int print_missing(const char *path, const vlFilmFile *file, const FilmParts *parts) {
  const vlReceipt *receipt = vl_film_file_receipt(file);
  uint32_t count = 0;
  size_t length = strlen(path);
  char stem[4096], name[4200];
  double noise = receipt ? vl_receipt_noise(receipt) : 0;
  if (!receipt || !planned_of(file))
    return report_failure(STATUS_SCENE,
                          "%s: the film has no receipt: what made it is not known", path);
  if (length > 5 && strcmp(path + length - 5, ".film") == 0)
    length -= 5;
  text_set(stem, "%.*s", (int)length, path);
  for (uint32_t i = 0; i < parts->count; i++)
    for (uint32_t k = 0; k < parts->parts[i].samples.count; k++) {
      const FilmPart *p = &parts->parts[i];
      const vlSampleRange *r = &p->samples.ranges[k];
      if (noise > 0 && r->first)
        continue;
      text_set(name, "%s-missing-%u.film", stem, ++count);
      print_render(file, p, r, name);
    }
  if (count)
    print_merge(path, stem, count);
  if (noise > 0) {
    printf("velo render --continue");
    text_shell_word(stdout, path);
    putchar('\n');
  }
  return STATUS_OK;
}

static int run_info(const Arguments *arguments, vlContext *context) {
  const char *path = arguments->operands[0];
  bool missing = arguments->values[INFO_MISSING].given;
  vlFilmFile *file = NULL;
  vlError error = {0};
  FilmParts parts = {.count = 0};
  const vlResult result = vl_film_file_open(context, path, &file, &error);
  int status = report_error(&error, result, NULL);
  if (status < 0)
    status = film_parts_read(file, arguments->values[INFO_CHECK].given,
                             missing ? planned_of(file) : 0, &parts);
  if (status < 0 && missing) {
    status = print_missing(path, file, &parts);
  } else if (status < 0) {
    print_contents(path, file, &parts);
    status = STATUS_OK;
  }
  film_parts_free(&parts);
  vl_film_file_close(file);
  return status;
}

static Option info_options[] = {
    {INFO_MISSING, "missing",
     "print, as shell commands, the renders of the missing samples or pixels, and the merge "
     "of the results"},
    {INFO_CHECK, "check", "also read all sums, which detects any damage of the file"},
    {0}};

const Command film_info_command = {
    .name = "film info",
    .usage = "FILE [options]",
    .summary = "print what a film file contains, and what is missing",
    .text = "Prints the size of a film, its samples, and the command and scene that made it.",
    .examples = "velo film info room.film\nvelo film info --missing room.film | sh",
    .options = info_options,
    .operands = 1,
    .context = CONTEXT_ONE,
    .run = run_info,
};
