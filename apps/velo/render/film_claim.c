/* render/film_claim.c: see film_claim.h. */
#include "render/film_claim.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/kinds.h"
#include "cli/macros.h"
#include "cli/report.h"
#include "render/outputs.h"
#include "velo/tracer.h"

int film_claim_refuse(const char *format, ...) {
  FORMATTED(text, format);
  return report_usage("--film: %s; --overwrite replaces it", text);
}

int film_claim_check(bool overwrite, const char *film, const char *from) {
  if (!overwrite)
    return -1;
  if (!film)
    return report_usage("--overwrite goes with --film FILE");
  return from && output_is_same(film, from)
             ? report_usage("--overwrite: %s is the film that --continue continues", film)
             : -1;
}

/* Whether a file begins as film files do, damaged or not. One that cannot be read is reported
 * when it is opened. */
static bool is_film(const char *path) {
  char magic[8];
  FILE *file = fopen(path, "rb");
  bool is = !file || (fread(magic, 1, sizeof magic, file) == sizeof magic &&
                      memcmp(magic, "VELOFILM", sizeof magic) == 0);
  if (file)
    fclose(file);
  return is;
}

int film_claim(FilmClaim *claim, vlContext *context, const char *path, const char *from,
               bool overwrite) {
  vlError error = {0};
  struct stat info;
  memset(claim, 0, sizeof *claim);
  text_set(claim->path, "%s", path);
  text_set(claim->from, "%s", from);
  TRY(report_error(&error, vl_film_lock(context, path, &claim->lock, &error), path));
  if (!claim->lock)
    return report_usage("--film: another process is rendering into %s", path);
  if (stat(path, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size == 0)
    return -1;
  if (!is_film(path))
    return report_usage("--film: %s is not a film file, and is not replaced", path);
  if (overwrite || (*from && output_is_same(path, from)))
    return -1;
  vlResult result = vl_film_file_open(context, path, &claim->earlier, &error);
  if (result == VL_ERROR_SCENE || result == VL_ERROR_UNSUPPORTED)
    return film_claim_refuse("%s", error.message);
  return report_error(&error, result, NULL);
}

void film_claim_release(FilmClaim *claim) {
  vl_film_file_close(claim->earlier);
  vl_film_unlock(claim->lock);
  memset(claim, 0, sizeof *claim);
}

void film_claim_take(const FilmClaim *claim, vlFilmDef *film) {
  if (claim->earlier)
    film->errors |= vl_film_file_def(claim->earlier)->errors;
}

/* The word after an option in the film's command; null: it has none. */
static const char *word_after(const vlReceipt *receipt, const char *option) {
  const char *word;
  for (uint32_t i = 0; (word = vl_receipt_command(receipt, i)); i++)
    if (strcmp(word, option) == 0)
      return vl_receipt_command(receipt, i + 1);
  return NULL;
}

bool film_claim_take_tracer(const FilmClaim *claim, vlRenderDef *render) {
  static const vlTracer raced[] = {VL_TRACER_VOLPATH, VL_TRACER_BIDIRECTIONAL,
                                   VL_TRACER_MERGING};
  const vlReceipt *receipt = vl_film_file_receipt(claim->earlier);
  if (!receipt)
    return false;
  const char *name = word_after(receipt, "--tracer"),
             *paths = word_after(receipt, "--light-paths");
  for (size_t i = 0; i < LENGTH(raced) && name; i++)
    if (strcmp(name, kind_name("tracers", (int)raced[i])) == 0)
      render->tracer = raced[i];
  if (paths)
    render->light_paths = (uint32_t)strtoul(paths, NULL, 10);
  return name || paths;
}
