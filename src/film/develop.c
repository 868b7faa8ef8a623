/* film/develop.c: converts sums to an image, and to an image of the luminance. */
#include "base/cookie.h"
#include "base/error.h"
#include "base/text.h"
#include "color/color.h"
#include "film/sums.h"
#include "image/image.h"
#include "velo/image.h"

static vlResult set_box(vlImage *image, const char *name, const double numbers[4]) {
  vlAttribute a = {.name = name, .type = VL_ATTRIBUTE_BOX2I};
  for (int i = 0; i < 4; i++)
    a.numbers[i] = numbers[i];
  return vl_image_set_attribute(image, &a);
}

vlResult vl_film_set_window(const vlFilm *film, vlImage *image) {
  if (film->width == film->def.width && film->height == film->def.height)
    return VL_OK;
  const uint32_t *c = film->def.crop;
  double data[4] = {c[0], c[1], c[2] - 1.0, c[3] - 1.0},
         display[4] = {0, 0, film->def.width - 1.0, film->def.height - 1.0};
  VL_TRY(set_box(image, "dataWindow", data));
  return set_box(image, "displayWindow", display);
}

/* Writes OpenEXR's attributes: the colour space's primaries, and a crop's window. */
static vlResult set_attributes(const vlFilm *film, vlImage *image) {
  VL_TRY(vl_image_set_space(image, film->def.space));
  return vl_film_set_window(film, image);
}

vlResult vl_film_develop(const vlFilm *film, const vlDevelopDef *def, vlImage **image) {
  if (!image)
    return VL_ERROR_ARGUMENT;
  *image = NULL;
  vlDevelopDef d = def ? *def : vl_default_develop_def();
  if (!film || d.cookie != VL_COOKIE_DEVELOP)
    return VL_ERROR_ARGUMENT;
  static const char *const names[4] = {"R", "G", "B", "A"};
  vlImageDef image_def = vl_default_image_def(film->width, film->height, 4);
  image_def.names = names;
  image_def.type = VL_PIXEL_F32;
  image_def.encoding = VL_ENCODING_LINEAR;
  vlImage *made;
  VL_TRY(vl_image_create(film->context, &image_def, &made));
  vlResult result = set_attributes(film, made);
  if (result != VL_OK) {
    vl_image_destroy(made);
    return result;
  }
  /* The quotient of the sums is accurate to 2^-51: where all samples of a pixel are the same
   * float, rounding gives that float. */
  float *out = vl_image_pixels(made);
  double color_unit = 1.0 / (double)(INT64_C(1) << (VL_COLOR_BITS - VL_WEIGHT_BITS)),
         exposure = d.exposure;
  double alpha_unit = 1.0 / (double)(1 << (VL_ALPHA_BITS - VL_WEIGHT_BITS));
  /* without samples the image stays zero */
  size_t count = film->front ? vl_film_pixels(film) : 0;
  for (size_t i = 0; i < count; i++) {
    const vlFilmPixel *p = film->front + i;
    if (p->weight <= 0)
      continue;
    double weight = (double)p->weight;
    for (int c = 0; c < 3; c++)
      out[4 * i + c] = (float)((double)p->color[c] / weight * color_unit * exposure);
    double alpha = (double)p->alpha / weight * alpha_unit;
    out[4 * i + 3] = (float)(alpha > 0.0 ? (alpha < 1.0 ? alpha : 1.0) : 0.0);
  }
  *image = made;
  return VL_OK;
}

/* ---- luminance --------------------------------------------------------------------------- */

/* Whether R, G, B are linear in X, Y, Z of the light itself. */
static bool is_colorimetric(const vlFilmDef *def) {
  return def->white_balance == 0.0 && (!def->sensor || vl_text_is(def->sensor, "cie1931"));
}

/* Y of the linear colours, which is in cd/m^2 (docs/decisions/0031-units.md). */
vlResult vl_film_luminance(const vlFilm *film, vlImage **image) {
  if (!image)
    return VL_ERROR_ARGUMENT;
  *image = NULL;
  if (!film || !is_colorimetric(vl_film_def(film)))
    return VL_ERROR_ARGUMENT;
  vlImage *colors;
  VL_TRY(vl_film_develop(film, NULL, &colors));
  static const char *const names[1] = {"luminance.Y"};
  vlImageDef def = vl_default_image_def(vl_image_width(colors), vl_image_height(colors), 1);
  def.names = names;
  def.type = VL_PIXEL_F32;
  def.encoding = VL_ENCODING_LINEAR;
  vlResult r = vl_image_create(film->context, &def, image);
  if (r == VL_OK) {
    float m[9];
    vl_xyz_from_rgb(vl_film_def(film)->space, m);
    const float *rgba = vl_image_const_pixels(colors);
    float *to = vl_image_pixels(*image);
    size_t pixels = (size_t)def.width * def.height;
    for (size_t i = 0; i < pixels; i++)
      to[i] = m[3] * rgba[4 * i] + m[4] * rgba[4 * i + 1] + m[5] * rgba[4 * i + 2];
  }
  vl_image_destroy(colors);
  return r;
}
