/* raw/info.c: `velo raw info`: what a raw file says of its numbers. Also functions shared by
 * the raw commands. */
#include <stdio.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/report.h"
#include "raw/raw.h"

int raw_load(vlContext *context, const char *path, vlRaw **raw) {
  vlError error = {0};
  return report_error(&error, vl_raw_read(context, path, raw, &error), path);
}

enum { INFO_JSON };

/* The least and greatest of the numbers, and how many reach the white level. */
typedef struct Range {
  uint32_t min, greatest;
  uint64_t saturated;
} Range;

static Range range_of(const vlRaw *raw) {
  const vlRawDef *def = vl_raw_def(raw);
  const uint16_t *numbers = vl_raw_const_numbers(raw);
  Range range = {.min = UINT16_MAX};
  for (size_t i = 0; i < (size_t)def->width * def->height; i++) {
    range.min = numbers[i] < range.min ? numbers[i] : range.min;
    range.greatest = numbers[i] > range.greatest ? numbers[i] : range.greatest;
    range.saturated += numbers[i] >= def->white;
  }
  return range;
}

static bool is_known(const float *values, uint32_t count) {
  for (uint32_t i = 0; i < count; i++)
    if (values[i] != 0.0f)
      return true;
  return false;
}

/* What is told of a file where it is known: as a line of text and as a member of JSON. */
typedef struct Fact {
  const char *name, *key, *unit;
  const float *values;
  uint32_t count;
} Fact;
enum { FACTS = 10 };

/* iso: room for a float. */
static void list_facts(const vlRawDef *def, float *iso, Fact facts[FACTS]) {
  uint8_t colors[VL_RAW_MAX_COLORS];
  const uint32_t count = vl_raw_colors(def, colors);
  *iso = (float)def->iso;
  const Fact list[FACTS] = {
      {"exposure time", "exposure_time", " s", &def->exposure_time, 1},
      {"f-number", "f_number", "", &def->f_number, 1},
      {"focal length", "focal_length", " m", &def->focal_length, 1},
      {"ISO", "iso", "", iso, 1},
      {"gain", "gain", " numbers per electron", &def->gain, 1},
      {"read noise", "read_noise", " electrons", &def->read_noise, 1},
      {"baseline exposure", "baseline_exposure", " EV", &def->baseline_exposure, 1},
      {"neutral", "neutral", "", def->neutral, count},
      {"matrix A", "matrix_a", "", def->matrices[0], 3 * count},
      {"matrix D65", "matrix_d65", "", def->matrices[1], 3 * count}};
  memcpy(facts, list, sizeof list);
}

static void print_levels(const vlRawDef *def) {
  uint32_t cells = def->pattern_rows * def->pattern_columns;
  bool is_one = true;
  for (uint32_t i = 1; i < cells; i++)
    is_one = is_one && def->black[i] == def->black[0];
  printf("%-18s", "black level");
  for (uint32_t i = 0; i < (is_one ? 1 : cells); i++)
    printf(" %u", def->black[i]);
  printf("\n%-18s %u\n", "white level", def->white);
}

static void print_text(const char *path, const vlRaw *raw) {
  const vlRawDef *def = vl_raw_def(raw);
  const Range range = range_of(raw);
  Fact facts[FACTS];
  float iso;
  char pattern[80];
  vl_raw_pattern_text(def, pattern);
  printf("%-18s %s\n%-18s %u x %u\n%-18s %u\n%-18s %s\n", "file", path, "size", def->width,
         def->height, "bits", def->bits, "pattern", pattern);
  print_levels(def);
  printf("%-18s %u to %u, %llu at the white level\n", "numbers", range.min, range.greatest,
         (unsigned long long)range.saturated);
  if (def->camera[0])
    printf("%-18s %s\n", "camera", def->camera);
  list_facts(def, &iso, facts);
  for (const Fact *f = facts; f < facts + FACTS; f++) {
    if (!is_known(f->values, f->count))
      continue;
    printf("%-18s", f->name);
    for (uint32_t i = 0; i < f->count; i++)
      printf(" %.7g", (double)f->values[i]); /* the digits of a float */
    printf("%s\n", f->unit);
  }
}

static void print_json(const char *path, const vlRaw *raw) {
  const vlRawDef *def = vl_raw_def(raw);
  const Range range = range_of(raw);
  Fact facts[FACTS];
  float iso;
  char pattern[80];
  Json *json = json_open();
  vl_raw_pattern_text(def, pattern);
  json_put(json, "file %s, width %u, height %u, bits %u, pattern %s", path, def->width,
           def->height, def->bits, pattern);
  json_begin(json, "black", '[');
  for (uint32_t i = 0; i < def->pattern_rows * def->pattern_columns; i++)
    json_integer(json, NULL, def->black[i]);
  json_end(json, ']');
  json_put(json, "white %u, least %u, greatest %u, saturated %lld, camera %s", def->white,
           range.min, range.greatest, (long long)range.saturated, def->camera);
  list_facts(def, &iso, facts);
  for (const Fact *f = facts; f < facts + FACTS; f++) {
    double values[3 * VL_RAW_MAX_COLORS];
    for (uint32_t i = 0; i < f->count; i++)
      values[i] = shortest_float(f->values[i]);
    if (!is_known(f->values, f->count))
      continue;
    if (f->values == def->neutral || f->count > 1)
      json_numbers(json, f->key, values, f->count);
    else
      json_number(json, f->key, values[0]);
  }
  json_close(json);
}

static int run_info(const Arguments *arguments, vlContext *context) {
  vlRaw *raw = NULL;
  const char *path = arguments->operands[0];
  int status = raw_load(context, path, &raw);
  if (status < 0) {
    if (arguments->values[INFO_JSON].given)
      print_json(path, raw);
    else
      print_text(path, raw);
    status = STATUS_OK;
  }
  vl_raw_destroy(raw);
  return status;
}

static Option info_options[] = {JSON_OPTION(INFO_JSON), {0}};

const Command raw_info_command = {
    .name = "raw info",
    .usage = "FILE [options]",
    .summary = "print what a raw file says of its numbers",
    .text =
        "Prints the size, the pattern of filters, the levels and the metadata of a DNG file "
        "that velo wrote.\n"
        "What is not known is left out. Matrices: for each colour the factors of X, Y and Z.",
    .examples = "velo raw info room.dng\nvelo raw info --json room.dng",
    .options = info_options,
    .operands = 1,
    .context = CONTEXT_ALL,
    .run = run_info,
};
