/* render/outputs.c: see outputs.h. */
#include "render/outputs.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/options.h"
#include "cli/report.h"
#include "image/display.h"
#include "render/exposure.h"

static const struct Suffix {
  const char *name;
  bool eight_bit;
} suffixes[] = {{"exr", false}, {"png", true},  {"jpg", true}, {"jpeg", true},
                {"hdr", false}, {"pfm", false}, {"tga", true}};

bool output_suffix(const char *path, bool *eight_bit) {
  const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
  for (size_t i = 0; dot && i < sizeof suffixes / sizeof *suffixes; i++)
    if (strcasecmp(dot + 1, suffixes[i].name) == 0) {
      *eight_bit = suffixes[i].eight_bit;
      return true;
    }
  return false;
}

bool output_holds_layers(const char *path) {
  size_t length = strlen(path);
  return length >= 4 && strcasecmp(path + length - 4, ".exr") == 0;
}

static int fail_suffix(const char *path) {
  const char *names[8];
  int count = 0;
  for (size_t i = 0; i < sizeof suffixes / sizeof *suffixes; i++) names[count++] = suffixes[i].name;
  const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
  const char *near = dot ? did_you_mean(".", dot + 1, names, count) : "";
  return report_usage("output \"%s\": the suffix must be .exr, .png, .jpg, .hdr, .pfm or .tga%s", path, near);
}

int outputs_check_names(const Outputs *outputs) {
  bool eight_bit;
  for (int i = 0; i < outputs->count; i++) {
    if (!output_suffix(outputs->paths[i], &eight_bit)) return fail_suffix(outputs->paths[i]);
    for (int j = 0; j < i; j++)
      if (strcmp(outputs->paths[i], outputs->paths[j]) == 0)
        return report_usage("output \"%s\" is given twice", outputs->paths[i]);
  }
  return -1;
}

static int fail_write(const char *path, int code) {
  return report_failure(STATUS_IO, "cannot write %s: %s", path, strerror(code));
}

int outputs_check_folders(const Outputs *outputs) {
  for (int i = 0; i < outputs->count; i++) {
    const char *path = outputs->paths[i], *slash = strrchr(path, '/');
    char folder[4096] = ".";
    size_t length = slash ? (size_t)(slash - path) : 1;
    if (length >= sizeof folder) return fail_write(path, ENAMETOOLONG);
    if (slash) snprintf(folder, sizeof folder, "%.*s", length ? (int)length : 1, path);
    if (outputs->patterns && strchr(folder, '%')) continue;
    struct stat info;
    if (stat(path, &info) == 0 && S_ISDIR(info.st_mode)) return fail_write(path, EISDIR);
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode)) { /* devices and pipes are written in place */
      if (access(path, W_OK) != 0) return fail_write(path, errno);
      continue;
    }
    if (stat(folder, &info) != 0)
      return report_failure(STATUS_IO, "cannot write %s: folder %s: %s", path, folder, strerror(errno));
    if (!S_ISDIR(info.st_mode)) return fail_write(path, ENOTDIR);
    if (access(folder, W_OK | X_OK) != 0)
      return report_failure(STATUS_IO, "cannot write %s: folder %s: %s", path, folder, strerror(errno));
  }
  return -1;
}

/* A picture that is not finished may be replaced by the next one only where a name is renamed over, not in a pipe. */
static bool is_plain_file(const char *path) {
  struct stat info;
  return stat(path, &info) != 0 || S_ISREG(info.st_mode);
}

int outputs_write(vlContext *context, const Outputs *outputs, const vlImage *image, bool progress) {
  vlWriteDef write = vl_default_write_def();
  write.half = outputs->half;
  float exposure = outputs->meter ? exposure_meter(image) : outputs->exposure;
  vlImage *display = NULL; /* made once, when the first file wants it */
  int status = STATUS_OK;
  for (int i = 0; i < outputs->count; i++) {
    const char *path = outputs->paths[i];
    bool eight_bit = false;
    output_suffix(path, &eight_bit);
    if (progress && !is_plain_file(path)) continue;
    vlError error = {0};
    vlResult result = VL_OK;
    if (eight_bit && !display) {
      result = display_image(context, image, outputs->view, exposure, &display);
      if (outputs->meter && !progress) exposure_tell(exposure);
    }
    const vlImage *images[5] = {eight_bit ? display : image};
    uint32_t count = 1;
    for (int k = 0; k < 4 && output_holds_layers(path); k++)
      if (outputs->layers[k]) images[count++] = outputs->layers[k];
    if (result == VL_OK)
      result = count > 1 ? vl_image_write_layers(images, count, path, &write, &error)
                         : vl_image_write(images[0], path, &write, &error);
    if (result == VL_OK) continue;
    if (progress) {
      report_warning("progress picture: %s", error.message[0] ? error.message : vl_result_name(result));
      if (status == STATUS_OK) status = STATUS_IO;
    } else {
      int code = report_error(&error, result, path);
      if (status == STATUS_OK) status = code;
    }
  }
  vl_image_destroy(display);
  return status;
}
