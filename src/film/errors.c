/* film/errors.c: the standard errors of a film's pixels, for samples that are better
 * distributed than independent ones.
 *
 * The samples of a pixel divide into two parts, of n0 and n1 samples, n together
 * (vl_first_part). The difference D of their means has the variance V of the mean of all n in
 * it: D^2 n0 n1 / n^2 is in the mean V where the samples are independent. Where the parts are
 * point sets that fill each other's gaps, it is larger than V; it is
 *
 *   V = c n^-p:   D^2 n0 n1 / n^2 = (n0 / n1) c (n0^-p - n^-p)
 *
 * since the mean of all has no correlation with D. What of a pixel's variance falls with which
 * power is not known, but p is 1 for what sampling does not improve (light over many bounces),
 * 3/2 for edges and 2 for what is smoother, by scrambled nets (Owen 1997, "Monte Carlo variance
 * of scrambled net quadrature"; He and Wang 2015, "On the convergence rate of randomized
 * quasi-Monte Carlo for discontinuous functions"). So r, the ratio of D^2 n0 n1 / n^2 to the
 * variance of independent samples, tells how V divides into two neighbouring powers, and V is
 * linear in r between them. Where the parts are from different sequences, which are
 * independent, V is r itself.
 *
 * D^2 of one pixel says little: r is the mean over the pixels of a cell of 8 x 8 pixels whose
 * variance of independent samples is within a factor of 4. Sampling acts alike in such pixels,
 * but not in the edge of a lamp and the wall behind it. */
#include <math.h>

#include "base/cookie.h"
#include "base/error.h"
#include "film/sums.h"

enum { CELL = 8, MIN_SAMPLES = 8 };
static const double ALIKE = 4;

typedef struct Pixel {
  double independent[3]; /* the variance of the mean of independent samples */
  double sum, parts;     /* over the channels: of that, and of D^2 n0 n1 / n^2 */
  double samples, share; /* n, n0 / n */
  bool valid;            /* with two parts, and some variance */
} Pixel;

static Pixel take_pixel(const vlFilm *film, size_t at) {
  Pixel p = {.share = film->front ? vl_film_first_share(film, at) : 0};
  for (int c = 0; c < 3; c++) {
    double error = vl_film_independent_error(film, at, c);
    p.independent[c] = error * error;
    p.sum += error * error;
    if (!(p.share > 0))
      continue;
    double d = vl_film_linear_mean(film->front + at, c) - vl_film_first_mean(film, at, c);
    p.parts += p.share / (1 - p.share) * d * d; /* d = (n1 / n) D */
  }
  if (p.share > 0)
    p.samples = (double)film->moments[0][at].samples;
  p.valid = p.share > 0 && p.sum > 0 && p.sum < (double)INFINITY;
  return p;
}

/* The variance relative to that of independent samples, from the ratio r, as above. */
static double variance_of_ratio(double r, double n, double share) {
  double n0 = n * share, scale = n0 / (n - n0) * n, root = 1 / sqrt(n);
  double edges = scale * (1 / (n0 * sqrt(n0)) - root / n),
         smooth = scale * (1 / (n0 * n0) - 1 / (n * n)); /* r of p */
  if (!(smooth < edges && edges < 0.8))
    return r; /* too few samples, or one part far smaller than the other */
  if (r >= edges)
    return root + (r - edges) / (1 - edges) * (1 - root);
  if (r >= smooth)
    return 1 / n + (r - smooth) / (edges - smooth) * (root - 1 / n);
  return r / smooth / n;
}

/* The square of the factor on the standard error of independent samples, for a pixel of a
 * cell. */
static double pixel_factor(const Pixel *p, const Pixel *cell, uint32_t count, bool apart) {
  if (!p->valid)
    return 1;
  double sum = 0, parts = 0;
  for (uint32_t i = 0; i < count; i++) {
    const Pixel *q = &cell[i];
    bool alike = q->valid && q->sum <= ALIKE * p->sum && p->sum <= ALIKE * q->sum;
    sum += alike ? q->sum : 0;
    parts += alike ? q->parts : 0;
  }
  double r = parts / sum;
  return apart || p->samples < MIN_SAMPLES ? r : variance_of_ratio(r, p->samples, p->share);
}

/* Whether the parts of a block's samples are from independent sequences. */
static bool parts_are_apart(const vlFilm *film, uint32_t block) {
  uint32_t length = film->sequence.length, spp = vl_film_block_spp(film, block);
  uint32_t part = vl_first_part(film->block_spp ? film->sequence.first + spp : film->end);
  return length && part && part % length == 0;
}

/* Fills the errors of the cell of the film's pixels x0, y0 to x1, y1; `to` as of
 * vl_film_window_errors. */
static void fill_cell(const vlFilm *film, uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1,
                      float exposure, float *to, size_t step) {
  Pixel cell[CELL * CELL];
  uint32_t n = 0;
  for (uint32_t y = y0; y < y1; y++)
    for (uint32_t x = x0; x < x1; x++)
      cell[n++] = take_pixel(film, (size_t)y * film->width + x);
  const uint32_t *crop = film->def.crop;
  bool apart = parts_are_apart(film, vl_film_block_at(crop, crop[0] + x0, crop[1] + y0));
  for (uint32_t i = 0; i < n; i++) {
    size_t at = (size_t)(y0 + i / (x1 - x0)) * film->width + x0 + i % (x1 - x0);
    double factor = pixel_factor(&cell[i], cell, n, apart);
    for (int c = 0; c < 3; c++)
      to[step * at + (size_t)c] = (float)sqrt(factor * cell[i].independent[c]) * exposure;
  }
}

/* The end of the cell, along an axis, that a pixel of the film is in; first: the crop's; end:
 * the last. */
static uint32_t cell_end(uint32_t pixel, uint32_t first, uint32_t end) {
  uint32_t next = (first + pixel) / CELL * CELL + CELL - first;
  return next < end ? next : end;
}

/* The errors of independent samples of the pixels x0, y0 to x1, y1 of the film. */
static void fill_independent(const vlFilm *film, uint32_t x0, uint32_t y0, uint32_t x1,
                             uint32_t y1, float exposure, float *to, size_t step) {
  for (uint32_t y = y0; y < y1; y++)
    for (uint32_t x = x0; x < x1; x++) {
      size_t at = (size_t)y * film->width + x;
      for (int c = 0; c < 3; c++)
        to[step * at + (size_t)c] = (float)vl_film_independent_error(film, at, c) * exposure;
    }
}

void vl_film_window_errors(const vlFilm *film, const uint32_t window[4],
                           const vlDevelopDef *def, float *to, size_t step) {
  const uint32_t *crop = film->def.crop;
  uint32_t x0 = window[0] - crop[0], y0 = window[1] - crop[1];
  uint32_t x1 = window[2] - crop[0], y1 = window[3] - crop[1];
  if (def->independent) {
    fill_independent(film, x0, y0, x1, y1, def->exposure, to, step);
    return;
  }
  for (uint32_t y = y0, yn; y < y1; y = yn) {
    yn = cell_end(y, crop[1], y1);
    for (uint32_t x = x0, xn; x < x1; x = xn) {
      xn = cell_end(x, crop[0], x1);
      fill_cell(film, x, y, xn, yn, def->exposure, to, step);
    }
  }
}

vlResult vl_film_errors(const vlFilm *film, const vlDevelopDef *def, vlImage **image) {
  if (image)
    *image = NULL;
  vlDevelopDef standard = vl_default_develop_def();
  if (!def)
    def = &standard;
  if (!film || !image || !film->def.errors || def->cookie != VL_COOKIE_DEVELOP)
    return VL_ERROR_ARGUMENT;
  static const char *const names[3] = {"error.R", "error.G", "error.B"};
  vlImageDef image_def = vl_default_image_def(film->width, film->height, 3);
  image_def.names = names;
  image_def.type = VL_PIXEL_F32;
  VL_TRY(vl_image_create(film->context, &image_def, image));
  vl_film_window_errors(film, film->def.crop, def, vl_image_pixels(*image), 3);
  return VL_OK;
}
