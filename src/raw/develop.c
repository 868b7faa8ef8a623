/* raw/develop.c: develops a raw image: black level, white balance, demosaic, colour, tone. */
#include <math.h>

#include "base/cookie.h"
#include "base/error.h"
#include "image/image.h"
#include "image/pixel.h"
#include "raw/demosaic.h"
#include "raw/raw.h"
#include "raw/tone.h"

enum { COLORS = VL_RAW_MAX_COLORS };

vlRawDevelopDef vl_default_raw_develop_def(void) {
  vlRawDevelopDef def = {.cookie = VL_COOKIE_RAW_DEVELOP, .stop_at = VL_RAW_STEP_TONE};
  return def;
}

/* What the steps know beside the numbers. */
typedef struct Develop {
  const vlRaw *raw;
  const vlRawDevelopDef *def;
  uint32_t colors;
  uint8_t planes[VL_RAW_MAX_CELLS];
  double neutral[COLORS];
  double matrix[3 * COLORS]; /* linear sRGB from white-balanced colours */
  const float *from;
  vlImage *to;        /* of the parallel step */
  const vlTone *tone; /* of the step TONE */
  double scale;       /* before it */
} Develop;

static vlResult check(const vlRaw *raw, const vlRawDevelopDef *def, vlImage **image,
                      vlError *error) {
  if (!raw || !image)
    return vl_fail_argument(error, "develop: raw image or result is null");
  if (def->cookie != VL_COOKIE_RAW_DEVELOP)
    return vl_fail_argument(error, "develop: " VL_BAD_COOKIE);
  if ((unsigned)def->stop_at > VL_RAW_STEP_TONE)
    return vl_fail_argument(error, "develop: stop_at is no step");
  if (!(fabsf(def->exposure) <= 100.0f))
    return vl_fail_argument(error, "develop: exposure is not from -100 to 100 EV");
  return VL_OK;
}

/* ---- the steps --------------------------------------------------------------------------- */

/* BLACK and WHITE: one row of the mosaic. */
static void level_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  const Develop *d = user;
  const vlRawDef *def = &d->raw->def;
  const uint16_t *numbers = d->raw->numbers + (size_t)y * def->width;
  float *result = vl_image_row(d->to, y);
  for (uint32_t x = 0; x < def->width; x++) {
    uint32_t cell = vl_raw_cell(def, x, y);
    double black = def->black[cell], value = (numbers[x] - black) / (def->white - black);
    if (d->def->stop_at >= VL_RAW_STEP_WHITE)
      value = fmin(value / d->neutral[d->planes[cell]], 1.0);
    result[x] = (float)value;
  }
}

/* COLOR: one row of pixels. */
static void color_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  const Develop *d = user;
  const float *from = d->from + (size_t)y * d->raw->def.width * d->colors;
  float *to = vl_image_row(d->to, y);
  for (uint32_t x = 0; x < d->raw->def.width; x++)
    for (uint32_t i = 0; i < 3; i++) {
      double sum = 0.0;
      for (uint32_t k = 0; k < d->colors; k++)
        sum += d->matrix[i * d->colors + k] * (double)from[x * d->colors + k];
      to[3 * x + i] = (float)sum;
    }
}

/* TONE: one row of values. */
static void tone_row(void *user, uint32_t y, VL_UNUSED uint32_t worker) {
  const Develop *d = user;
  size_t count = (size_t)d->to->width * d->to->channels;
  vl_tone_apply(d->tone, d->scale, d->from + y * count, count, vl_image_row(d->to, y));
}

/* ---- their images ------------------------------------------------------------------------ */

/* Creates the image of a step. names may be null. */
static vlResult make_image(const Develop *d, uint32_t channels, const char *const *names,
                           vlPixelType type, vlImage **image, vlError *error) {
  vlImageDef def = vl_default_image_def(d->raw->def.width, d->raw->def.height, channels);
  def.names = names;
  def.type = type;
  def.encoding = type == VL_PIXEL_U16 ? VL_ENCODING_SRGB : VL_ENCODING_LINEAR;
  return vl_image_create(d->raw->context, &def, image) == VL_OK ? VL_OK : vl_fail_memory(error);
}

/* Runs a step over all rows, from *image (null: from the numbers) to a new image, which
 * replaces it. */
static vlResult run_step(Develop *d, vlParallelFn *row, uint32_t channels, vlPixelType type,
                         vlImage **image, vlError *error) {
  VL_TRY(make_image(d, channels, NULL, type, &d->to, error));
  d->from = *image ? vl_image_const_pixels(*image) : NULL;
  vl_parallel_for(d->raw->context, d->raw->def.height, row, d);
  vl_image_destroy(*image);
  *image = d->to;
  return VL_OK;
}

static vlResult demosaic(Develop *d, vlImage **image, vlError *error) {
  uint8_t colors[COLORS];
  char letters[COLORS][2];
  const char *names[COLORS];
  uint32_t count = vl_raw_colors(&d->raw->def, colors);
  for (uint32_t k = 0; k < count; k++) {
    letters[k][0] = vl_raw_letter(colors[k]);
    letters[k][1] = 0;
    names[k] = letters[k];
  }
  VL_TRY(make_image(d, count, names, VL_PIXEL_F32, &d->to, error));
  vl_raw_demosaic(d->raw->context, &d->raw->def, vl_image_const_pixels(*image),
                  vl_image_pixels(d->to));
  vl_image_destroy(*image);
  *image = d->to;
  return VL_OK;
}

static vlResult apply_tone(Develop *d, uint32_t channels, vlImage **image, vlError *error) {
  vlTone *tone = vl_alloc_array(d->raw->context, 1, sizeof *tone);
  if (!tone)
    return vl_fail_memory(error);
  vl_tone_make(d->raw->context, tone);
  d->tone = tone;
  d->scale = vl_exp2_exact((double)d->raw->def.baseline_exposure + (double)d->def->exposure);
  vlResult result = run_step(d, tone_row, channels, VL_PIXEL_U16, image, error);
  vl_free(d->raw->context, tone);
  return result;
}

/* Prepares the matrix for white-balanced colours. */
static vlResult prepare(Develop *d, vlError *error) {
  double kelvin;
  d->colors = vl_raw_planes(&d->raw->def, d->planes);
  vl_raw_neutral(&d->raw->def, d->neutral);
  if (d->def->stop_at < VL_RAW_STEP_COLOR || d->colors == 1)
    return VL_OK;
  if (!vl_raw_has_matrices(&d->raw->def))
    return vl_fail_argument(
        error,
        "develop: the raw image has no colour matrices; the last step without them "
        "is demosaic");
  if (!vl_raw_color_matrix(&d->raw->def, d->matrix, &kelvin))
    return vl_fail_argument(error,
                            "develop: the colour matrices of the raw image have no inverse");
  for (uint32_t i = 0; i < 3; i++)
    for (uint32_t k = 0; k < d->colors; k++)
      d->matrix[i * d->colors + k] *= d->neutral[k];
  return VL_OK;
}

vlResult vl_raw_develop(const vlRaw *raw, const vlRawDevelopDef *def, vlImage **image,
                        vlError *error) {
  const vlRawDevelopDef standard = vl_default_raw_develop_def();
  Develop d = {.raw = raw, .def = def ? def : &standard};
  vlImage *made = NULL;
  vl_error_clear(error);
  if (image)
    *image = NULL;
  vlResult result = check(raw, d.def, image, error);
  if (result == VL_OK)
    result = prepare(&d, error);
  if (result == VL_OK)
    result = run_step(&d, level_row, 1, VL_PIXEL_F32, &made, error);
  bool is_mono = d.colors == 1;
  if (result == VL_OK && d.def->stop_at >= VL_RAW_STEP_DEMOSAIC && !is_mono)
    result = demosaic(&d, &made, error);
  if (result == VL_OK && d.def->stop_at >= VL_RAW_STEP_COLOR && !is_mono)
    result = run_step(&d, color_row, 3, VL_PIXEL_F32, &made, error);
  if (result == VL_OK && d.def->stop_at >= VL_RAW_STEP_TONE)
    result = apply_tone(&d, is_mono ? 1 : 3, &made, error);
  if (result == VL_OK)
    *image = made;
  else
    vl_image_destroy(made);
  return result;
}
