/* film/luminance.c: the luminance of a film's pixels: Y of its linear colours, which is in
 * cd/m^2 (docs/decisions/0031-units.md). */
#include "base/text.h"
#include "color/color.h"
#include "film/sums.h"
#include "velo/image.h"

/* Whether R, G, B are linear in X, Y, Z of the light itself. */
static bool is_colorimetric(const vlFilmDef *def) {
  return def->white_balance == 0.0 && (!def->sensor || vl_text_is(def->sensor, "cie1931"));
}

vlResult vl_film_luminance(const vlFilm *film, vlImage **image) {
  if (!image)
    return VL_ERROR_ARGUMENT;
  *image = NULL;
  if (!film || !is_colorimetric(vl_film_def(film)))
    return VL_ERROR_ARGUMENT;
  vlImage *colors;
  vlResult r = vl_film_develop(film, NULL, &colors);
  if (r != VL_OK)
    return r;
  static const char *const names[1] = {"luminance.Y"};
  vlImageDef def = vl_default_image_def(vl_image_width(colors), vl_image_height(colors), 1);
  def.names = names;
  def.type = VL_PIXEL_F32;
  def.encoding = VL_ENCODING_LINEAR;
  r = vl_image_create(film->context, &def, image);
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
