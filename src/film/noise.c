/* film/noise.c: the noise of a block, in display values. Adaptive sampling compares it with its
 * threshold.
 *
 * The error e of a display value is half the distance between the display values one standard
 * error above and below the linear value. Where the view clips, this is smaller than the
 * derivative of the view would give. The noise of a block is the root of the mean of e^2. That
 * mean is itself estimated from the same samples, and a block that happens to look too clean
 * would stop too early: the mean plus three of its standard errors replaces it, from the spread
 * of e^2 over the block's pixels. Where pixels share samples their e^2 are correlated, and the
 * mean of them is less certain.
 *
 * Where light is rare and bright, a few pixels have found it and the others have not. The view
 * is steep in the dark and flat in the bright, so the first look too clean, and the second have
 * no error at all. There the means over 3 x 3 pixels are closer to the truth, of the linear
 * values (between black and white) and of the squares of their errors. The noise is computed
 * both ways, and the larger one counts.
 *
 * These errors treat a pixel's samples as independent, but they are better distributed than
 * that. The difference D between the display values of the first part, m samples
 * (vl_first_part), and of all n samples shows it. Where D has no correlation with the error
 * after n, the variance after m is that after n plus the mean of D^2. So if the variance falls
 * at least as fast as 1 / n, D^2 m / (n - m) is in the mean at least the variance after n, and
 * equal to it for independent samples. The ratio of its mean to that of e^2, plus two standard
 * errors, reduces the noise if it is below 1. Rare bright samples that were not found are
 * missing in both, so the ratio says nothing about them. */
#include <math.h>

#include "film/sums.h"
#include "image/pixel.h"
#include "image/view.h"

/* The linear values of a block's pixels and the squares of their standard errors. */
typedef struct Block {
  uint32_t width, height;
  double mean[VL_FILM_BLOCK][VL_FILM_BLOCK][3], square[VL_FILM_BLOCK][VL_FILM_BLOCK][3];
} Block;

/* Numbers of standard errors that are added to the mean of e^2, and to the ratio of D^2 to
 * e^2. */
static const double ERRORS_OF_MEAN = 3, ERRORS_OF_RATIO = 2;
/* Samples; the mean of fewer than 8 says little about the distribution of more. */
enum { MIN_FOR_RATIO = 12 };

typedef struct Display {
  vlView view;
  double factor; /* exposure and scale */
} Display;

/* e^2 of a pixel, the mean over R, G, B. */
static double display_square(const Display *d, const double mean[3], const double square[3]) {
  float low[3], high[3];
  double e = 0;
  for (int c = 0; c < 3; c++) {
    double error = sqrt(square[c]);
    low[c] = (float)((mean[c] - error) * d->factor);
    high[c] = (float)((mean[c] + error) * d->factor);
  }
  vl_view_display(d->view, low, low);
  vl_view_display(d->view, high, high);
  for (int c = 0; c < 3; c++) {
    double half = 0.5 * ((double)high[c] - (double)low[c]);
    e += half * half / 3.0;
  }
  return e;
}

/* The linear values between black and white that a pixel's standard error leaves possible, as
 * mean and square. Beyond white an error is hardly seen in the pixel, and must not be seen in
 * its neighbours. */
static void limit(double white, double *mean, double *square) {
  double error = sqrt(*square), low = *mean - error, high = *mean + error;
  low = low < 0 ? 0 : low > white ? white : low;
  high = high < 0 ? 0 : high > white ? white : high;
  *mean = 0.5 * (low + high);
  *square = 0.25 * (high - low) * (high - low);
}

/* The limited values, each replaced by the mean over the pixels of the block that are next to
 * it. */
static void pool(const Block *from, double white, Block *to) {
  Block limited = *from;
  for (uint32_t y = 0; y < from->height; y++)
    for (uint32_t x = 0; x < from->width; x++)
      for (int c = 0; c < 3; c++)
        limit(white, &limited.mean[y][x][c], &limited.square[y][x][c]);
  to->width = from->width;
  to->height = from->height;
  for (uint32_t y = 0; y < from->height; y++)
    for (uint32_t x = 0; x < from->width; x++) {
      uint32_t x0 = x > 0 ? x - 1 : 0, x1 = x + 1 < from->width ? x + 2 : from->width;
      uint32_t y0 = y > 0 ? y - 1 : 0, y1 = y + 1 < from->height ? y + 2 : from->height;
      double n = (double)((x1 - x0) * (y1 - y0));
      for (int c = 0; c < 3; c++) {
        double mean = 0, square = 0;
        for (uint32_t j = y0; j < y1; j++)
          for (uint32_t i = x0; i < x1; i++) {
            mean += limited.mean[j][i][c];
            square += limited.square[j][i][c];
          }
        to->mean[y][x][c] = mean / n;
        to->square[y][x][c] = square / n;
      }
    }
}

/* A mean over the pixels of a block, and its standard error. */
typedef struct Mean {
  double value, error;
} Mean;

static Mean mean_of(double sum, double squares, double count, double correlation) {
  double mean = sum / count, spread = squares / count - mean * mean;
  return (Mean){mean, sqrt(correlation * (spread > 0 ? spread : 0) / count)};
}

static double pixels_of(const Block *b) {
  return (double)(b->width * b->height);
}

/* The mean of e^2. */
static Mean block_square(const Block *b, const Display *d, double correlation) {
  double sum = 0, squares = 0;
  for (uint32_t y = 0; y < b->height; y++)
    for (uint32_t x = 0; x < b->width; x++) {
      double e = display_square(d, b->mean[y][x], b->square[y][x]);
      sum += e;
      squares += e * e;
    }
  return mean_of(sum, squares, pixels_of(b), correlation);
}

static double upper_limit(Mean mean) {
  return mean.value + ERRORS_OF_MEAN * mean.error;
}

/* The square of the difference between the display values of two linear values, the mean over
 * R, G, B. */
static double difference_square(const Display *d, const double mean[3],
                                const double earlier[3]) {
  float now[3], then[3];
  double sum = 0;
  for (int c = 0; c < 3; c++) {
    now[c] = (float)(mean[c] * d->factor);
    then[c] = (float)(earlier[c] * d->factor);
  }
  vl_view_display(d->view, now, now);
  vl_view_display(d->view, then, then);
  for (int c = 0; c < 3; c++)
    sum += ((double)now[c] - (double)then[c]) * ((double)now[c] - (double)then[c]) / 3.0;
  return sum;
}

/* The upper limit of the ratio of the mean of D^2 m / (n - m) to that of e^2, at most 1. The
 * errors of both means count as independent, although both see the same rare bright samples:
 * those that are missing are missing in both. first: of the block's first pixel. */
static double square_ratio(const vlFilm *film, size_t first, const Block *b, const Display *d,
                           double correlation, Mean square) {
  if (!(square.value > 0))
    return 1;
  double sum = 0, squares = 0;
  for (uint32_t y = 0; y < b->height; y++)
    for (uint32_t x = 0; x < b->width; x++) {
      size_t at = first + (size_t)y * film->width + x;
      double share = vl_film_first_share(film, at), earlier[3]; /* m / n */
      if (!(share > 0))
        return 1;
      for (int c = 0; c < 3; c++)
        earlier[c] = vl_film_first_mean(film, at, c);
      double p = share / (1 - share) * difference_square(d, b->mean[y][x], earlier);
      sum += p;
      squares += p * p;
    }
  Mean difference = mean_of(sum, squares, pixels_of(b), correlation);
  double ratio = difference.value / square.value, other = ratio * square.error;
  double error = sqrt(difference.error * difference.error + other * other) / square.value;
  double limit = ratio + ERRORS_OF_RATIO * error;
  return limit < 1 ? limit : 1;
}

double vl_film_view_factor(float exposure, float scale) {
  return (double)scale * vl_exp2_exact((double)exposure);
}

double vl_film_block_noise(const vlFilm *film, uint32_t block, vlView view, float exposure,
                           float scale, double correlation) {
  if (!film->front || !film->moments[0] || vl_film_block_spp(film, block) < 2)
    return INFINITY;
  Display d = {view, vl_film_view_factor(exposure, scale)};
  uint32_t block_window[4];
  vl_film_block_window(film->def.crop, block, block_window);
  const uint32_t *crop = film->def.crop;
  Block b = {.width = block_window[2] - block_window[0],
             .height = block_window[3] - block_window[1]};
  for (uint32_t y = 0; y < b.height; y++)
    for (uint32_t x = 0; x < b.width; x++) {
      size_t at = (size_t)(block_window[1] + y - crop[1]) * film->width +
                  (block_window[0] + x - crop[0]);
      const vlFilmPixel *p = film->front + at;
      if (p->weight <= 0)
        return INFINITY;
      for (int c = 0; c < 3; c++) {
        double error = vl_film_independent_error(film, at, c);
        b.mean[y][x][c] = vl_film_linear_mean(p, c);
        b.square[y][x][c] = error * error;
      }
    }
  Block pooled;
  pool(&b, 1.0 / d.factor, &pooled);
  Mean square = block_square(&b, &d, correlation);
  double each = upper_limit(square),
         together = upper_limit(block_square(&pooled, &d, correlation)), ratio = 1;
  if (vl_film_block_spp(film, block) >= MIN_FOR_RATIO) {
    size_t first =
        (size_t)(block_window[1] - crop[1]) * film->width + (block_window[0] - crop[0]);
    ratio = square_ratio(film, first, &b, &d, correlation, square);
  }
  return sqrt(ratio * (each > together ? each : together));
}

void vl_film_compare_block(vlFilm *film, uint32_t block, vlView view, float exposure,
                           float scale, double correlation) {
  film->compared[block] = (vlComparedNoise){
      .spp = vl_film_block_spp(film, block),
      .noise = (float)vl_film_block_noise(film, block, view, exposure, scale, correlation),
      .factor = (float)vl_film_view_factor(exposure, scale),
      .view = (uint32_t)view};
}
