/* render/outputs.c: see outputs.h. */
#include "render/outputs.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/text.h"
#include "image/display.h"
#include "image/image.h"
#include "render/exposure.h"

static const char stdout_path[] = "/dev/stdout";
enum { MAX_NAME = 255 }; /* bytes; of a file name without its directory */

static const struct Suffix {
  const char *name;
  bool eight_bit;
  uint32_t largest; /* largest width and height in pixels */
} suffixes[] = {{"exr", false, 1 << 26}, {"png", true, 1 << 30},  {"jpg", true, 65500},
                {"jpeg", true, 65500},   {"hdr", false, 1 << 30}, {"pfm", false, 1 << 30},
                {"tga", true, 65535}};

bool output_is_stdout(const char *path) {
  return path[0] == '-' && (!path[1] || path[1] == '.') && !strchr(path, '/');
}

bool output_is_same(const char *a, const char *b) {
  vlFileId one, two;
  return strcmp(a, b) == 0 ||
         (vl_file_id(a, &one) && vl_file_id(b, &two) && memcmp(&one, &two, sizeof one) == 0);
}

const char *output_opened(const char *path) {
  return output_is_stdout(path) ? stdout_path : path;
}

const char *output_dot(const char *path) {
  if (strcmp(path, "-") == 0)
    return ".exr";
  return strrchr(text_file_name(path), '.');
}

static const struct Suffix *find_suffix(const char *path) {
  const char *dot = output_dot(path);
  for (size_t i = 0; dot && i < LENGTH(suffixes); i++)
    if (strcasecmp(dot + 1, suffixes[i].name) == 0)
      return &suffixes[i];
  return NULL;
}

bool output_is_known(const char *path) {
  return find_suffix(path) != NULL;
}

bool output_is_display(const char *path) {
  const struct Suffix *suffix = find_suffix(path);
  return suffix && suffix->eight_bit;
}

int output_check_drawing(const char *path) {
  return output_is_display(path)
             ? -1
             : report_usage("-o \"%s\": the drawing is written as .png, .jpg or .tga", path);
}

bool outputs_any(const Outputs *outputs, bool (*test)(const char *path)) {
  for (int i = 0; i < outputs->count; i++)
    if (test(outputs->paths[i]))
      return true;
  return false;
}

uint32_t output_largest_side(const char *path) {
  const struct Suffix *suffix = find_suffix(path);
  return suffix ? suffix->largest : UINT32_MAX;
}

bool output_has_suffix(const char *path, const char *suffix) {
  const char *dot = output_dot(path);
  return dot && strcasecmp(dot, suffix) == 0;
}

bool output_holds_alpha(const char *path) {
  return output_holds_layers(path) || output_has_suffix(path, ".png");
}

bool output_holds_layers(const char *path) {
  return output_has_suffix(path, ".exr");
}

static int fail_suffix(const char *path) {
  const char *names[8];
  int count = 0;
  for (size_t i = 0; i < LENGTH(suffixes); i++)
    names[count++] = suffixes[i].name;
  const char *dot = output_dot(path);
  const char *near = dot ? did_you_mean(".", dot + 1, names, count) : "";
  return report_usage(
      "output \"%s\": the suffix must be .exr, .png, .jpg, .hdr, .pfm or .tga%s", path, near);
}

void outputs_take_names(Outputs *outputs, const Arguments *arguments) {
  outputs->count = arguments->text_count;
  memcpy(outputs->paths, arguments->texts, sizeof arguments->texts);
}

int outputs_check_names(const Outputs *outputs) {
  for (int i = 0; i < outputs->count; i++) {
    if (!output_is_known(outputs->paths[i]))
      return fail_suffix(outputs->paths[i]);
    if (output_is_stdout(outputs->paths[i]) && !outputs->to_stdout)
      return report_usage(
          "output \"%s\": this command does not write images to the standard output; a file "
          "of that name is ./%s",
          outputs->paths[i], outputs->paths[i]);
    for (int j = 0; j < i; j++)
      if (strcmp(outputs->paths[i], outputs->paths[j]) == 0)
        return report_usage("output \"%s\" is given twice", outputs->paths[i]);
  }
  return -1;
}

int output_check(vlContext *context, const char *path, vlOutputKind kind) {
  vlError error = {0};
  vlResult result = vl_check_output(context, output_opened(path), kind, &error);
  if (result == VL_ERROR_ARGUMENT)
    return report_usage("%s", error.message);
  return result == VL_OK ? -1 : report_failure(STATUS_IO, "%s", error.message);
}

int outputs_check_folders(const Outputs *outputs) {
  for (int i = 0; i < outputs->count; i++) {
    const char *path = outputs->paths[i];
    const size_t folder = (size_t)(text_file_name(path) - path);
    if (outputs->patterns && memchr(path, '%', folder))
      continue; /* made later */
    TRY(output_check(NULL, path, VL_OUTPUT_PLAIN));
    if (!output_is_stream(path))
      vl_remove_leftovers(path);
  }
  return -1;
}

/* ---- names ------------------------------------------------------------------------------- */

/* Joins the first `keep` bytes of the path and `tail`. Keeps fewer bytes if the name would be
 * too long. */
static bool name_beside(const char *path, size_t keep, const char *tail, char *result,
                        size_t size) {
  const size_t folder = (size_t)(text_file_name(path) - path);
  if (keep > folder + MAX_NAME - strlen(tail)) {
    keep = folder + MAX_NAME - strlen(tail);
    while (keep > folder && ((unsigned char)path[keep] & 0xc0) == 0x80)
      keep--; /* does not split a UTF-8 sequence */
  }
  return snprintf(result, size, "%.*s%s", (int)keep, path, tail) < (int)size;
}

bool output_is_stream(const char *path) {
  struct stat info;
  return output_is_stdout(path) || strcmp(path, stdout_path) == 0 ||
         (stat(path, &info) == 0 && !S_ISREG(info.st_mode));
}

bool output_part_path(const char *path, char *part, size_t size) {
  char target[PATH_MAX], tail[32];
  struct stat info;
  if (output_is_stream(path))
    return false;
  if (lstat(path, &info) == 0 && S_ISLNK(info.st_mode) && realpath(path, target))
    path = target;
  const char *dot = strrchr(text_file_name(path), '.');
  size_t stem = dot ? (size_t)(dot - path) : strlen(path);
  text_set(tail, ".part%.20s", dot ? dot : "");
  return name_beside(path, stem, tail, part, size);
}

void output_remove_part(const char *path) {
  char part[PATH_MAX + 64], ids[PATH_MAX + 80], own[PATH_MAX + 80];
  if (!output_part_path(path, part, sizeof part))
    return;
  unlink(part);
  if (!output_holds_layers(path) || !output_ids_path(part, ids, sizeof ids) ||
      !output_ids_path(path, own, sizeof own))
    return;
  if (strcmp(ids, own) != 0)
    unlink(ids); /* both may be cut to the same name */
}

bool output_ids_path(const char *path, char *ids, size_t size) {
  return name_beside(path, strlen(path), ".ids.json", ids, size);
}

const char *output_written(const Outputs *outputs, int i, OutputStage stage, char *part,
                           size_t size) {
  const char *path = outputs->paths[i];
  return stage != OUTPUT_FINISHED && output_part_path(path, part, size) ? part : path;
}

/* ---- writing ----------------------------------------------------------------------------- */

/* Reports when an output fails for the first time, and when it works again. */
static void report_progress_failure(Outputs *outputs, int i, vlResult result,
                                    const vlError *error) {
  bool failing = result != VL_OK;
  if (failing && !outputs->files[i].failing)
    report_warning("progress image: %s; tried again later", error_text(error, result));
  if (!failing && outputs->files[i].failing)
    report_note("the progress image of %s is written again", outputs->paths[i]);
  outputs->files[i].failing = failing;
}

/* After a write: NAME.part.EXT is removed once NAME.EXT is complete. Otherwise a note says how
 * many samples it holds. */
static void keep_part(Outputs *outputs, int i, const char *part, OutputStage stage,
                      bool written, uint32_t spp) {
  if (stage != OUTPUT_FINISHED && written)
    outputs->files[i].part_spp = spp;
  else if (written)
    output_remove_part(outputs->paths[i]);
  else if (stage != OUTPUT_PROGRESS && outputs->files[i].part_spp && access(part, F_OK) == 0)
    report_note("%s holds the image of %u samples per pixel", part, outputs->files[i].part_spp);
}

vlResult output_write_layers(const vlImage *const *images, uint32_t count, const char *path,
                             vlWriteDef def, vlError *error) {
  const char *opened = output_opened(path);
  def.format = output_dot(path);
  return count > 1 ? vl_image_write_layers(images, count, opened, &def, error)
                   : vl_image_write(images[0], opened, &def, error);
}

static vlResult write_one(const Outputs *outputs, const vlImage *image, bool layers,
                          const char *path, vlError *error) {
  vlWriteDef write = vl_default_write_def();
  write.half = outputs->half;
  const vlImage *images[5] = {image};
  uint32_t count = 1;
  for (int k = 0; k < 4 && layers; k++)
    if (outputs->layers[k])
      images[count++] = outputs->layers[k];
  return output_write_layers(images, count, path, write, error);
}

int outputs_write(vlContext *context, Outputs *outputs, const vlImage *image, uint32_t spp,
                  OutputStage stage) {
  float exposure = outputs->exposure, *shared = outputs->shared;
  const bool known = !outputs->meter || (shared && !isnan(*shared));
  if (outputs->meter)
    exposure = known ? *shared : exposure_meter(image);
  if (outputs->meter && shared && stage != OUTPUT_PROGRESS)
    *shared = exposure;
  /* made when the first file needs it: without and with alpha */
  vlImage *displays[2] = {NULL, NULL};
  int status = STATUS_OK;
  for (int i = 0; i < outputs->count; i++) {
    const char *path = outputs->paths[i];
    char part[PATH_MAX + 64];
    const bool eight_bit = output_is_display(path),
               has_part = output_part_path(path, part, sizeof part);
    if (stage == OUTPUT_PROGRESS && !has_part)
      continue;
    vlError error = {0};
    vlResult result = VL_OK;
    bool alpha = outputs->transparent && output_holds_alpha(path);
    if (eight_bit && !displays[alpha]) {
      result = display_image(context, image, outputs->view, exposure, alpha, &displays[alpha]);
      if (result == VL_OK && outputs->comment)
        result = image_set_text(displays[alpha], "comments", outputs->comment);
      if (!known && stage != OUTPUT_PROGRESS)
        exposure_tell(exposure);
    }
    const char *to = has_part && stage != OUTPUT_FINISHED ? part : path;
    if (result == VL_OK)
      result = write_one(outputs, eight_bit ? displays[alpha] : image,
                         output_holds_layers(path), to, &error);
    if (stage == OUTPUT_PROGRESS)
      report_progress_failure(outputs, i, result, &error);
    if (stage != OUTPUT_PROGRESS && result != VL_OK)
      status = first_failure(status, report_error(&error, result, to));
    if (has_part)
      keep_part(outputs, i, part, stage, result == VL_OK, spp);
  }
  for (int k = 0; k < 2; k++)
    vl_image_destroy(displays[k]);
  return status;
}
