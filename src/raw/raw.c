/* raw/raw.c: raw images: their defs, checks and numbers. */
#include "raw/raw.h"

#include <math.h>

#include "base/cookie.h"
#include "base/error.h"
#include "base/free.h"
#include "base/text.h"

vlRawDef vl_default_raw_def(uint32_t width, uint32_t height) {
  vlRawDef def = {.cookie = VL_COOKIE_RAW,
                  .width = width,
                  .height = height,
                  .bits = 12,
                  .pattern_rows = 2,
                  .pattern_columns = 2,
                  .pattern = {VL_RAW_RED, VL_RAW_GREEN, VL_RAW_GREEN, VL_RAW_BLUE},
                  .white = 4095};
  return def;
}

static vlResult wrong(vlError *error, const char *field, const char *what) {
  return vl_fail_argument(error, "raw image: %s %s", field, what);
}

static vlResult check_size(const vlRawDef *def, vlError *error) {
  if (def->width < 1 || def->width > VL_RAW_MAX_LENGTH)
    return wrong(error, "width", "is not from 1 to 65535 pixels");
  if (def->height < 1 || def->height > VL_RAW_MAX_LENGTH)
    return wrong(error, "height", "is not from 1 to 65535 pixels");
  if ((uint64_t)def->width * def->height > VL_RAW_MAX_PIXELS)
    return wrong(error, "width x height", "is more than 2^28 pixels");
  if (def->bits < 1 || def->bits > 16)
    return wrong(error, "bits", "is not from 1 to 16");
  return VL_OK;
}

static vlResult check_levels(const vlRawDef *def, vlError *error) {
  uint8_t colors[VL_RAW_MAX_COLORS];
  if (!vl_raw_colors(def, colors))
    return wrong(error, "pattern",
                 "is not of 1 to 8 rows and columns with at most 4 known colours");
  if (def->white >> def->bits)
    return wrong(error, "white", "is not below 2^bits");
  for (uint32_t i = 0; i < def->pattern_rows * def->pattern_columns; i++)
    if (def->black[i] >= def->white)
      return wrong(error, "black", "is not below the white level");
  return VL_OK;
}

static vlResult check_name(const vlRawDef *def, vlError *error) {
  size_t length = strnlen(def->camera, sizeof def->camera);
  if (length == sizeof def->camera)
    return wrong(error, "camera", "is longer than 63 characters");
  for (size_t i = 0; i < length; i++)
    if (def->camera[i] < ' ' || def->camera[i] > '~')
      return wrong(error, "camera", "has a character that is not printable ASCII");
  return VL_OK;
}

/* A number of metadata, which is 0 where it is not known. Files hold fractions of two 32-bit
 * integers. */
static bool is_known_range(float value) {
  return value == 0.0f || (value >= 1e-6f && value <= 1e6f);
}

static vlResult check_metadata(const vlRawDef *def, vlError *error) {
  static const char range[] = "is neither 0 (not known) nor from 1e-6 to 1e6";
  if (!is_known_range(def->exposure_time))
    return wrong(error, "exposure_time, s,", range);
  if (!is_known_range(def->f_number))
    return wrong(error, "f_number", range);
  if (!is_known_range(def->focal_length))
    return wrong(error, "focal_length, m,", range);
  if (def->iso > 65535)
    return wrong(error, "iso", "is above 65535");
  if (!is_known_range(def->gain))
    return wrong(error, "gain, numbers per electron,", range);
  if (!is_known_range(def->read_noise))
    return wrong(error, "read_noise, electrons,", range);
  if (!(fabsf(def->baseline_exposure) <= 100.0f))
    return wrong(error, "baseline_exposure", "is not from -100 to 100 EV");
  return VL_OK;
}

/* The neutral's numbers are all 0, or all above 0 with the greatest 1. */
static vlResult check_color(const vlRawDef *def, vlError *error) {
  uint8_t colors[VL_RAW_MAX_COLORS];
  uint32_t count = vl_raw_colors(def, colors), zeros = 0;
  float greatest = 0.0f;
  for (uint32_t i = 0; i < count; i++) {
    zeros += def->neutral[i] == 0.0f;
    if (!(def->neutral[i] == 0.0f || (def->neutral[i] >= 1e-6f && def->neutral[i] <= 1.0f)))
      return wrong(error, "neutral", "is not from 1e-6 to 1");
    greatest = fmaxf(greatest, def->neutral[i]);
  }
  if (zeros != count && (zeros || greatest != 1.0f))
    return wrong(error, "neutral", "has zeros beside other numbers, or no 1");
  for (uint32_t i = 0; i < 2; i++)
    for (uint32_t k = 0; k < 3 * count; k++)
      if (!(fabsf(def->matrices[i][k]) <= 1000.0f))
        return wrong(error, "matrices", "has a number that is not from -1000 to 1000");
  return VL_OK;
}

vlResult vl_raw_check(const vlRawDef *def, vlError *error) {
  if (!def)
    return vl_fail_argument(error, "raw image: def is null");
  if (def->cookie != VL_COOKIE_RAW)
    return vl_fail_argument(error, "raw image: " VL_BAD_COOKIE);
  VL_TRY(check_size(def, error));
  VL_TRY(check_levels(def, error));
  VL_TRY(check_name(def, error));
  VL_TRY(check_metadata(def, error));
  return check_color(def, error);
}

vlResult vl_raw_check_numbers(const vlRaw *raw, vlError *error) {
  const vlRawDef *def = &raw->def;
  size_t count = (size_t)def->width * def->height;
  for (size_t i = 0; i < count; i++)
    if (raw->numbers[i] >> def->bits)
      return vl_fail_argument(
          error, "raw image: pixel (%u, %u) is %u, which has more than %u bits",
          (uint32_t)(i % def->width), (uint32_t)(i / def->width), raw->numbers[i], def->bits);
  return VL_OK;
}

bool vl_raw_has_matrices(const vlRawDef *def) {
  for (uint32_t i = 0; i < 2; i++) {
    bool any = false;
    for (uint32_t k = 0; k < 3 * VL_RAW_MAX_COLORS; k++)
      any |= def->matrices[i][k] != 0.0f;
    if (!any)
      return false;
  }
  return true;
}

vlResult vl_raw_create(vlContext *context, const vlRawDef *def, vlRaw **raw, vlError *error) {
  vl_error_clear(error);
  if (!context || !raw)
    return vl_fail_argument(error, "raw image: context or result is null");
  *raw = NULL;
  VL_TRY(vl_raw_check(def, error));
  vlRaw *r = vl_alloc_zero(context, 1, sizeof *r);
  if (!r)
    return vl_fail_memory(error);
  r->context = context;
  r->def = *def;
  r->numbers = vl_alloc_zero(context, (size_t)def->width * def->height, sizeof *r->numbers);
  if (!r->numbers) {
    vl_free(context, r);
    return vl_fail_memory(error);
  }
  *raw = r;
  return VL_OK;
}

void vl_raw_destroy(vlRaw *raw) {
  if (!raw)
    return;
  VL_FREE(raw->context, raw->numbers, raw);
}

const vlRawDef *vl_raw_def(const vlRaw *raw) {
  return &raw->def;
}

uint16_t *vl_raw_numbers(vlRaw *raw) {
  return raw->numbers;
}

const uint16_t *vl_raw_const_numbers(const vlRaw *raw) {
  return raw->numbers;
}
