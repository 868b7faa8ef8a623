/* image/display.c: see display.h. The chromaticities attribute (primaries and white) gives the
 * matrix to linear Rec.709; then the view is applied. */
#include "image/display.h"

#include <math.h>
#include <string.h>

#include "cli/macros.h"
#include "cli/report.h"
#include "cli/vector.h"
#include "image/image.h"

/* CIE xy of red, green, blue and white of ITU-R BT.709. */
static const double rec709[8] = {0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290};

static void white_xyz(const double xy[8], double xyz[3]) {
  xyz[0] = xy[6] / xy[7];
  xyz[1] = 1;
  xyz[2] = (1 - xy[6] - xy[7]) / xy[7];
}

/* rgb to XYZ: the columns are the primaries, scaled so that (1, 1, 1) is the white (SMPTE RP
 * 177). */
static bool xyz_from_rgb(const double xy[8], double m[9]) {
  double inverse[9], white[3];
  for (int i = 0; i < 3; i++) {
    m[i] = xy[2 * i];
    m[3 + i] = xy[2 * i + 1];
    m[6 + i] = 1 - xy[2 * i] - xy[2 * i + 1];
  }
  white_xyz(xy, white);
  if (!matrix3_invert(m, inverse))
    return false;
  for (int i = 0; i < 3; i++) {
    double scale = vector_dot(inverse + 3 * i, white);
    for (int row = 0; row < 3; row++)
      m[3 * row + i] *= scale;
  }
  return true;
}

/* The matrix to Rec.709 for the same XYZ, without chromatic adaptation: the displayed colours
 * do not depend on the film's colour space. False: the image is in Rec.709, or its
 * chromaticities are invalid. */
static bool rec709_matrix(const vlImage *image, double m[9]) {
  vlAttribute attribute;
  if (vl_image_find_attribute(image, "chromaticities", &attribute) != VL_OK ||
      attribute.type != VL_ATTRIBUTE_CHROMATICITIES)
    return false;
  const double *xy = attribute.numbers;
  double away = 0, to_xyz[9], from_rec709[9], from_xyz[9];
  for (int i = 0; i < 8; i++)
    away = fmax(away, fabs(xy[i] - rec709[i]));
  if (!(away > 1e-3) || !(xy[7] > 0) || !xyz_from_rgb(xy, to_xyz) ||
      !xyz_from_rgb(rec709, from_rec709))
    return false;
  if (!matrix3_invert(from_rec709, from_xyz))
    return false;
  matrix3_multiply(from_xyz, to_xyz, m);
  for (int i = 0; i < 9; i++)
    if (!isfinite(m[i]))
      return false;
  return true;
}

static vlResult to_rec709(vlContext *context, const vlImage *image, const int rgb[3],
                          const double m[9], vlImage **result) {
  TRY_RESULT(image_make_like(context, image, 3, NULL, result));
  float *pixel = vl_image_pixels(*result);
  for (uint32_t y = 0; y < vl_image_height(image); y++)
    for (uint32_t x = 0; x < vl_image_width(image); x++, pixel += 3) {
      double v[3];
      for (int c = 0; c < 3; c++)
        v[c] = vl_image_get(image, x, y, (uint32_t)rgb[c]);
      for (int c = 0; c < 3; c++)
        pixel[c] = (float)vector_dot(m + 3 * c, v);
    }
  return VL_OK;
}

static vlShortText layer_name(const char *channel, const char *dot) {
  char layer[256];
  text_set(layer, "%.*s", (int)(dot - channel), channel);
  return vl_short_text(layer);
}

/* Reports which channel is displayed when the image has neither R, G, B nor Y. */
static void tell_shown(const vlImage *image) {
  uint32_t channel[4], count = vl_image_shown(image, channel);
  const char *first = vl_image_channel_name(image, channel[0]), *dot = strrchr(first, '.');
  if (vl_image_channels(image) == 1 || strcmp(first, "Y") == 0 || strcmp(first, "R") == 0)
    return;
  if (count >= 3)
    report_note("the image has no channels R, G, B or Y: the layer \"%s\" is shown",
                layer_name(first, dot).text);
  else
    report_note("the image has no channels R, G, B or Y: the channel \"%s\" is shown as grey",
                vl_short_text(first).text);
}

static vlResult display_colors(vlContext *context, const vlImage *image, vlView view,
                               float exposure, vlImage **result) {
  int rgb[3];
  double m[9];
  tell_shown(image);
  if (!image_find_rgb(image, "", rgb) || !rec709_matrix(image, m))
    return vl_image_view(image, view, exposure, NULL, result);
  vlImage *converted = NULL;
  vlResult status = to_rec709(context, image, rgb, m, &converted);
  if (status == VL_OK)
    status = vl_image_view(converted, view, exposure, NULL, result);
  vl_image_destroy(converted);
  return status;
}

/* R G B divided by alpha: the colour of what covers the pixel. */
static vlResult divide_by_alpha(vlContext *context, const vlImage *image, vlImage **result) {
  vlAttribute attribute;
  TRY_RESULT(image_make_like(context, image, 3, NULL, result));
  if (vl_image_find_attribute(image, "chromaticities", &attribute) == VL_OK)
    TRY_RESULT(vl_image_set_attribute(*result, &attribute));
  float *pixel = vl_image_pixels(*result);
  for (uint32_t y = 0; y < vl_image_height(image); y++)
    for (uint32_t x = 0; x < vl_image_width(image); x++, pixel += 3) {
      float a = vl_image_get(image, x, y, 3);
      for (uint32_t c = 0; c < 3; c++)
        pixel[c] = a > 0 ? vl_image_get(image, x, y, c) / a : 0;
    }
  return VL_OK;
}

static vlResult add_alpha(vlContext *context, const vlImage *image, vlImage **display) {
  vlImageDef def = vl_default_image_def(vl_image_width(image), vl_image_height(image), 4);
  def.type = VL_PIXEL_U8;
  def.encoding = VL_ENCODING_SRGB;
  vlImage *result = NULL;
  TRY_RESULT(vl_image_create(context, &def, &result));
  const uint8_t *from = vl_image_pixels(*display);
  uint8_t *to = vl_image_pixels(result);
  for (uint32_t y = 0; y < def.height; y++)
    for (uint32_t x = 0; x < def.width; x++, from += 3, to += 4) {
      memcpy(to, from, 3);
      to[3] = (uint8_t)(255 * vl_image_get(image, x, y, 3) + 0.5f);
    }
  vl_image_destroy(*display);
  *display = result;
  return VL_OK;
}

vlResult display_image(vlContext *context, const vlImage *image, vlView view, float exposure,
                       bool alpha, vlImage **result) {
  if (!alpha)
    return display_colors(context, image, view, exposure, result);
  vlImage *whole = NULL;
  vlResult status = divide_by_alpha(context, image, &whole);
  if (status == VL_OK)
    status = display_colors(context, whole, view, exposure, result);
  if (status == VL_OK)
    status = add_alpha(context, image, result);
  vl_image_destroy(whole);
  return status;
}
