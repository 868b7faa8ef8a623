/* test_hair.c: a white hair in a white furnace is invisible, sampled weights are correct,
 * samples follow their density, which integrates to 1. */
#include <math.h>
/* cmocka.h needs the headers above */

#include "bsdf_state.h"
#include "unit.h"

static void put(Batch *b, uint32_t i, float sigma_a, float h, float beta_m, float beta_n,
                float alpha) {
  float rows[VL_BSDF_ROWS] = {0};
  for (int c = 0; c < 4; c++)
    rows[VL_H_SIGMA_A + c] = sigma_a * (float)(c + 1);
  rows[VL_H_ACROSS] = h;
  rows[VL_H_BETA_M] = beta_m;
  rows[VL_H_BETA_N] = beta_n;
  rows[VL_H_ALPHA] = alpha;
  Surface s = {.eta_s = 1.55f, .own = rows};
  batch_surface(b, i, &s);
}

static const float betas[][2] = {
    {0.1f, 0.1f}, {0.3f, 0.3f}, {0.9f, 0.25f}, {0.25f, 0.9f}, {1.0f, 1.0f}};
enum { BETAS = 5 };

/* By uniform directions, as the paper's: the mean over the sphere, of one hit and of the hair's
 * whole width. */
static void white_furnace(void **state) {
  const State *s = *state;
  Batch *b = s->batch;
  for (int k = 0; k < BETAS; k++)
    for (int way = 0; way < 2; way++) { /* uniform directions; the BSDF's samples */
      statRng rng = stat_rng((uint64_t)(2 * k + way));
      double sum = 0, square = 0, count = 0;
      for (int turn = 0; turn < 400; turn++) {
        batch_numbers(b, BATCH, &rng);
        double o[3], w[3];
        stat_direction(&rng, o);
        if (k == 0)
          o[0] *= 0.5; /* narrow lobes at grazing angles take too many samples */
        double scale = 1 / sqrt(o[0] * o[0] + o[1] * o[1] + o[2] * o[2]);
        for (uint32_t j = 0; j < BATCH; j++) {
          put(b, j, 0, 2 * stat_float(&rng) - 1, betas[k][0], betas[k][1], 0);
          b->ox[j] = (float)(o[0] * scale);
          b->oy[j] = (float)(o[1] * scale);
          b->oz[j] = (float)(o[2] * scale);
          stat_direction(&rng, w);
          b->ix[j] = (float)w[0];
          b->iy[j] = (float)w[1];
          b->iz[j] = (float)w[2];
        }
        if (way)
          batch_sample(s->kernels, VL_BSDF_HAIR, BATCH, b);
        else
          batch_eval(s->kernels, VL_BSDF_HAIR, BATCH, b);
        for (uint32_t j = 0; j < BATCH; j++) {
          double x = way ? (double)b->weight[0][j] : 4 * PI * (double)b->value[0][j];
          if (way && !(fabs(x - 1) < 1e-3))
            fail_msg("betas %d: a sample of white hair is worth %g", k, x);
          sum += x;
          square += x * x;
          count++;
        }
      }
      double mean = sum / count, error = sqrt(fmax(square / count - mean * mean, 0) / count);
      if (!(fabs(mean - 1) < 4.5 * error + 3e-4) || !(error < (k ? 0.02 : 0.06)))
        fail_msg("betas %d, way %d: %g, error %g", k, way, mean, error);
    }
}

static double density(void *user, const double w[3]) {
  const State *s = user;
  Batch *b = s->other;
  b->ix[0] = (float)w[0];
  b->iy[0] = (float)w[1];
  b->iz[0] = (float)w[2];
  batch_eval(s->kernels, VL_BSDF_HAIR, 1, b);
  return (double)b->pdf[0];
}

static void samples_follow_their_density(void **state) {
  State *s = *state;
  const double thetas[] = {0.3, 1.2, PI - 0.8};
  const float across[] = {-0.8f, 0.1f, 0.6f};
  for (int k = 1; k < BETAS; k++)
    for (int t = 0; t < 3; t++) {
      statRng rng = stat_rng((uint64_t)(70 + 7 * k + t));
      statSphere hist = stat_sphere_new(24, 32);
      Batch *b = s->batch;
      for (int turn = 0; turn < 96; turn++) {
        batch_numbers(b, BATCH, &rng);
        for (uint32_t j = 0; j < BATCH; j++) {
          put(b, j, 0.3f, across[t], betas[k][0], betas[k][1], 0.035f);
          batch_wo(b, j, thetas[t], 0.7);
        }
        batch_sample(s->kernels, VL_BSDF_HAIR, BATCH, b);
        *s->other = *b;
        batch_eval(s->kernels, VL_BSDF_HAIR, BATCH, s->other);
        for (uint32_t j = 0; j < BATCH; j++) {
          assert_false(b->flags[j] & (VL_SAMPLED_NONE | VL_SAMPLED_SPECULAR));
          stat_sphere_add(hist, (double)b->ix[j], (double)b->iy[j], (double)b->iz[j]);
          assert_true(((b->flags[j] & VL_SAMPLED_TRANSMISSION) != 0) ==
                      (b->iz[j] * b->oz[j] < 0));
          assert_true(fabsf(b->pdf[j] - s->other->pdf[j]) <= 1e-5f * b->pdf[j]);
          for (int c = 0; c < 4; c++) {
            double v = (double)s->other->value[c][j], w = (double)(b->weight[c][j] * b->pdf[j]);
            if (!(fabs(v - w) <= 1e-5 * v + 1e-9))
              fail_msg("betas %d: value %g, weight %g", k, v, w);
          }
        }
      }
      for (uint32_t j = 0; j < VL_LANES; j++) {
        put(s->other, j, 0.3f, across[t], betas[k][0], betas[k][1], 0.035f);
        batch_wo(s->other, j, thetas[t], 0.7);
      }
      statResult r = stat_sphere_test(hist, density, s, 2e-5);
      if (!stat_accept(r, BETAS * 3))
        fail_msg("betas %d theta %g: p %g, integral %g", k, thetas[t], r.p, r.integral);
      if (!(fabs(r.integral - 1) < 1e-3))
        fail_msg("betas %d: the density integrates to %g", k, r.integral);
    }
}

/* More absorption, less light, and never more than came; red passes melanin more easily than
 * blue (channel 0 least). */
static void absorption(void **state) {
  const State *s = *state;
  Batch *b = s->batch;
  double last = 2;
  for (float sigma = 0; sigma < 3; sigma += 0.5f) {
    statRng rng = stat_rng(5);
    double sum[4] = {0};
    for (int turn = 0; turn < 20; turn++) {
      batch_numbers(b, BATCH, &rng);
      for (uint32_t j = 0; j < BATCH; j++) {
        put(b, j, sigma, 2 * stat_float(&rng) - 1, 0.3f, 0.3f, 0.035f);
        batch_wo(b, j, 0.9, 0.4);
      }
      batch_sample(s->kernels, VL_BSDF_HAIR, BATCH, b);
      for (uint32_t j = 0; j < BATCH; j++)
        for (int c = 0; c < 4; c++)
          sum[c] += (double)b->weight[c][j] / (20.0 * BATCH);
    }
    assert_true(sum[0] < last && sum[0] < 1.0001);
    for (int c = 1; c < 4; c++)
      assert_true(sigma > 0 ? sum[c] < sum[c - 1] : fabs(sum[c] - sum[0]) < 1e-5);
    last = sum[0];
  }
  assert_true(last < 0.35);
}

/* A clear hair met in its middle sends light on: most of it within its lobe about -wo, little
 * back; at its edge the way is bent as glass bends it. */
static void light_goes_through(void **state) {
  const State *s = *state;
  Batch *b = s->batch;
  const float across[3] = {0.0f, 0.5f, -0.5f};
  for (int k = 0; k < 3; k++) {
    statRng rng = stat_rng(3);
    double through = 0,
           turned = 2 * (asin((double)across[k] / 1.55) - asin((double)across[k])) + PI;
    batch_numbers(b, BATCH, &rng);
    for (uint32_t j = 0; j < BATCH; j++) {
      put(b, j, 0, across[k], 0.1f, 0.1f, 0);
      batch_wo(b, j, 0, 0);
    }
    batch_sample(s->kernels, VL_BSDF_HAIR, BATCH, b);
    for (uint32_t j = 0; j < BATCH; j++) {
      double phi = atan2((double)b->iz[j], (double)b->iy[j]) - PI / 2;
      through += cos(phi - turned) > 0.9 ? 1.0 / BATCH : 0;
    }
    if (!(through > 0.75))
      fail_msg("met at %g: %g of the light goes through", (double)across[k], through);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(white_furnace), cmocka_unit_test(samples_follow_their_density),
      cmocka_unit_test(absorption), cmocka_unit_test(light_goes_through)};
  return cmocka_run_group_tests(tests, setup, teardown);
}
