/* raw/files.c: writes and reads raw images in the format that a file's name tells. */
#include "raw/files.h"

#include "base/error.h"
#include "base/file.h"
#include "base/text.h"

double vl_raw_mean_black(const vlRawDef *def) {
  uint32_t cells = def->pattern_rows * def->pattern_columns;
  double sum = 0.0;
  for (uint32_t i = 0; i < cells; i++)
    sum += def->black[i];
  return sum / cells;
}

/* The numbers as a 16-bit image. */
static vlResult numbers_image(const vlRaw *raw, vlImage **image) {
  vlImageDef def = vl_default_image_def(raw->def.width, raw->def.height, 1);
  def.type = VL_PIXEL_U16;
  def.encoding = VL_ENCODING_LINEAR;
  VL_TRY(vl_image_create(raw->context, &def, image));
  memcpy(vl_image_pixels(*image), raw->numbers,
         (size_t)raw->def.width * raw->def.height * sizeof *raw->numbers);
  return VL_OK;
}

/* The electrons: (number - black) / gain. */
static vlResult electrons_image(const vlRaw *raw, vlImage **image) {
  const vlRawDef *raw_def = &raw->def;
  vlImageDef def = vl_default_image_def(raw_def->width, raw_def->height, 1);
  VL_TRY(vl_image_create(raw->context, &def, image));
  float *electrons = vl_image_pixels(*image);
  size_t at = 0;
  for (uint32_t y = 0; y < raw_def->height; y++)
    for (uint32_t x = 0; x < raw_def->width; x++) {
      double black = raw_def->black[vl_raw_cell(raw_def, x, y)];
      electrons[at] = (float)((raw->numbers[at] - black) / (double)raw_def->gain);
      at++;
    }
  return VL_OK;
}

static vlResult write_image(const vlRaw *raw, const char *path, vlError *error) {
  bool is_exr = vl_ends_with(path, ".exr");
  vlImage *image = NULL;
  if (is_exr && !(raw->def.gain > 0.0f))
    return vl_fail_argument(
        error, "%s: a file of electrons needs the gain, which the raw image lacks", path);
  vlResult result = is_exr ? electrons_image(raw, &image) : numbers_image(raw, &image);
  if (result != VL_OK)
    return vl_fail_memory(error);
  result = vl_image_write(image, path, NULL, error);
  vl_image_destroy(image);
  return result;
}

#ifndef VELO_TIFF
static vlResult lacks_tiff(const char *path, vlError *error) {
  return vl_fail(
      error, VL_ERROR_UNSUPPORTED,
      "%s: this build has no DNG: it was made without libtiff 4.5, which DNG and raw "
      "numbers as TIFF need",
      path);
}
#endif

/* Writes .dng, .tif, .tiff. */
static vlResult write_tiff(const vlRaw *raw, const char *path, vlError *error) {
#ifdef VELO_TIFF
  if (vl_ends_with(path, ".dng"))
    return vl_raw_write_dng(raw, path, error);
  return vl_raw_write_tiff(raw, path, error);
#else
  (void)raw;
  return lacks_tiff(path, error);
#endif
}

vlResult vl_raw_write(const vlRaw *raw, const char *path, vlError *error) {
  vl_error_clear(error);
  if (!raw || !path)
    return vl_fail_argument(error, "raw file: raw image or path is null");
  VL_TRY(vl_raw_check_numbers(raw, error));
  VL_TRY(vl_check_output(raw->context, path, VL_OUTPUT_PLAIN, error));
  if (vl_ends_with(path, ".dng") || vl_ends_with(path, ".tif") || vl_ends_with(path, ".tiff"))
    return write_tiff(raw, path, error);
  if (vl_ends_with(path, ".png") || vl_ends_with(path, ".exr"))
    return write_image(raw, path, error);
  return vl_fail_argument(
      error, "%s: raw images are written as .dng, .tif, .tiff, .png and .exr", path);
}

vlResult vl_raw_read(vlContext *context, const char *path, vlRaw **raw, vlError *error) {
  vl_error_clear(error);
  if (raw)
    *raw = NULL;
  if (!context || !path || !raw)
    return vl_fail_argument(error, "raw file: context, path or result is null");
#ifdef VELO_TIFF
  char *data;
  size_t size;
  VL_TRY(vl_file_read_given(context, path, false, &data, &size, error));
  vlResult result = vl_raw_read_dng(context, path, data, size, raw, error);
  vl_free(context, data);
  return result;
#else
  return lacks_tiff(path, error);
#endif
}
