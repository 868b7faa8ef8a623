/* film/noise.c: the noise of a block, in display values. Adaptive sampling compares it with its threshold.
 *
 * The error e of a display value is half the distance between the display values one standard error above and below
 * the linear value. Where the view clips, this is smaller than the derivative of the view would give. The noise of a
 * block is the root of the mean of e^2. That mean is itself estimated from the same samples, and a block that happens
 * to look too clean would stop too early: the upper limit of its one-sided 95 % confidence interval replaces it, from
 * the spread of e^2 over the block's pixels. */
#include <math.h>

#include "film/sums.h"
#include "image/pixel.h"
#include "image/view.h"

double vl_film_block_noise(const vlFilm *film, uint32_t block, vlView view, float exposure, float scale) {
  const double one_sided_95 = 1.645; /* quantile of the normal distribution */
  const double unit = 1.0 / (double)(INT64_C(1) << (VL_COLOR_BITS - VL_WEIGHT_BITS));
  if (!film->front || !film->moments[0] || vl_film_block_spp(film, block) < 2) return INFINITY;
  const double factor = (double)scale * vl_exp2_exact((double)exposure);
  uint32_t place[4];
  vl_film_block_place(film->def.crop, block, place);
  const uint32_t *crop = film->def.crop;
  double sum = 0, squares = 0, n = 0;
  for (uint32_t y = place[1]; y < place[3]; y++)
    for (uint32_t x = place[0]; x < place[2]; x++) {
      size_t at = (size_t)(y - crop[1]) * film->width + (x - crop[0]);
      const vlFilmPixel *p = film->front + at;
      float low[3], high[3];
      if (p->weight <= 0) return INFINITY;
      for (int c = 0; c < 3; c++) {
        double mean = (double)p->color[c] / (double)p->weight * unit, error = vl_film_standard_error(film, at, c);
        low[c] = (float)((mean - error) * factor), high[c] = (float)((mean + error) * factor);
      }
      vl_view_display(view, low, low);
      vl_view_display(view, high, high);
      double e = 0;
      for (int c = 0; c < 3; c++) {
        double half = 0.5 * ((double)high[c] - (double)low[c]);
        e += half * half / 3.0;
      }
      sum += e, squares += e * e, n += 1;
    }
  double mean = sum / n, spread = squares / n - mean * mean;
  return sqrt(mean + one_sided_95 * sqrt((spread > 0 ? spread : 0) / n));
}
