/* test/render/agreement.h: tests whether two tracers have the same mean. Renders with several
 * seeds give the means of image bands and their standard errors. The means of two tracers must
 * agree within their standard errors. */
#ifndef TEST_RENDER_AGREEMENT_H
#define TEST_RENDER_AGREEMENT_H

#include "render/shots.h"
#include "velo/tracer.h"

enum { AGREEMENT_SEEDS = 6, AGREEMENT_BANDS = 4, AGREEMENT_CHANNELS = 3 };

typedef struct Measure { /* three bands of the image, and the whole image */
  double mean[AGREEMENT_BANDS][AGREEMENT_CHANNELS], error[AGREEMENT_BANDS][AGREEMENT_CHANNELS];
} Measure;

/* The stage to render; its tracer and seed are set here. */
typedef Stage MakeStage(const void *user, vlTracer tracer);

static UNUSED Measure measure(MakeStage *make, const void *user, vlTracer tracer) {
  Measure r;
  memset(&r, 0, sizeof r);
  for (uint32_t seed = 0; seed < AGREEMENT_SEEDS; seed++) {
    Stage s = make(user, tracer);
    s.render.tracer = tracer;
    s.render.seed = 77 * seed + (uint32_t)tracer;
    Image p = stage_finish(&s);
    assert_int_equal(p.stats.not_finite, 0);
    for (uint32_t band = 0; band < AGREEMENT_BANDS; band++)
      for (int c = 0; c < AGREEMENT_CHANNELS; c++) {
        double m = band < 3 ? image_region(&p, 0, band * p.height / 3, p.width,
                                           (band + 1) * p.height / 3, c)
                            : image_mean(&p, c);
        r.mean[band][c] += m;
        r.error[band][c] += m * m;
      }
    image_free(&p);
  }
  for (int band = 0; band < AGREEMENT_BANDS; band++)
    for (int c = 0; c < AGREEMENT_CHANNELS; c++) {
      double *mean = &r.mean[band][c], *error = &r.error[band][c];
      *mean /= AGREEMENT_SEEDS;
      double spread = *error / AGREEMENT_SEEDS - *mean * *mean;
      *error = sqrt((spread > 0 ? spread : 0) / (AGREEMENT_SEEDS - 1));
    }
  return r;
}

/* Expects agreement within five standard errors (of six values) plus `bias` times the mean, for
 * errors of the estimated standard errors and for the blur of photon merging. */
static UNUSED void assert_agree(const char *what, const char *how, const Measure *a,
                                const Measure *b, double bias) {
  for (int band = 0; band < AGREEMENT_BANDS; band++)
    for (int c = 0; c < AGREEMENT_CHANNELS; c++) {
      double x = a->mean[band][c], y = b->mean[band][c];
      double error = hypot(a->error[band][c], b->error[band][c]);
      if (!(fabs(x - y) <= 5 * error + bias * y))
        fail_msg(
            "%s, %s, band %d, channel %d: %.5f, by paths from the eye %.5f, errors %.5f %.5f",
            what, how, band, c, x, y, a->error[band][c], b->error[band][c]);
    }
}

#endif
