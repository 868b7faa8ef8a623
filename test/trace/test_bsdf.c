/* test_bsdf.c: sampling and evaluation of every BSDF agree: chi-square of directions against
 * the density, the sampled weight is value / density, the sampled albedo is the integral of the
 * value. */
#include <math.h>
/* cmocka.h needs the headers above */

#include "bsdf_state.h"
#include "unit.h"

/* Tables of the state's coats: smooth, fine, rough, textured. */
static int build_coats(void **state) {
  if (setup(state))
    return 1;
  State *s = *state;
  vl_coat_build(s->context, 1.5f, 0.01f, 10, 0, 0, &s->coats[0]);
  vl_coat_build(s->context, 1.5f, 0.01f, 10, 0.1f, 0.1f, &s->coats[1]);
  vl_coat_build(s->context, 1.8f, 0.2f, 100, 0.4f, 0.4f, &s->coats[2]);
  vl_coat_build(s->context, 1.5f, 0.01f, 10, 0.0f, 0.5f, &s->coats[3]);
  if (s->coats[2] && vl_coat_conserve(s->context, s->coats[2]))
    return 1; /* the third conserves energy */
  return !s->coats[0] || !s->coats[1] || !s->coats[2] || !s->coats[3];
}

static const float through[VL_BSDF_ROWS] = {[VL_T_TRANSMITTANCE] = 0.5f,
                                            [VL_T_TRANSMITTANCE + 1] = 0.2f,
                                            [VL_T_TRANSMITTANCE + 2] = 0.4f};

enum { SURFACES = 16 };
static Surface surface(const State *s, int i) {
  const Surface all[SURFACES] = {
      {.kind = VL_BSDF_DIFFUSE, .reflectance = 0.7f},
      {.kind = VL_BSDF_CONDUCTOR, .eta = 0.2f, .k = 3.9f, .alpha_x = 0.1f, .alpha_y = 0.1f},
      {.kind = VL_BSDF_CONDUCTOR, .eta = 1.2f, .k = 6.0f, .alpha_x = 0.5f, .alpha_y = 0.15f},
      {.kind = VL_BSDF_CONDUCTOR, .eta = 1.2f, .k = 6.0f, .alpha_x = 1.0f, .alpha_y = 1.0f},
      {.kind = VL_BSDF_DIELECTRIC, .eta_s = 1.5f, .alpha_x = 0.1f, .alpha_y = 0.1f},
      {.kind = VL_BSDF_DIELECTRIC, .eta_s = 1.5f, .alpha_x = 0.3f, .alpha_y = 0.6f},
      {.kind = VL_BSDF_DIELECTRIC, .eta_s = 0.7f, .alpha_x = 0.4f, .alpha_y = 0.4f},
      {.kind = VL_BSDF_DIELECTRIC, .eta_s = 2.4f, .alpha_x = 0.9f, .alpha_y = 0.9f},
      {.kind = VL_BSDF_COATED_DIFFUSE, .reflectance = 0.8f, .eta_s = 1.5f, .coat = s->coats[0]},
      {.kind = VL_BSDF_COATED_DIFFUSE,
       .reflectance = 0.8f,
       .eta_s = 1.5f,
       .alpha_x = 0.1f,
       .alpha_y = 0.1f,
       .coat = s->coats[1]},
      {.kind = VL_BSDF_COATED_DIFFUSE,
       .reflectance = 0.1f,
       .eta_s = 1.8f,
       .alpha_x = 0.4f,
       .alpha_y = 0.4f,
       .coat = s->coats[2]},
      {.kind = VL_BSDF_COATED_DIFFUSE,
       .reflectance = 0.5f,
       .eta_s = 1.5f,
       .alpha_x = 0.1f,
       .alpha_y = 0.4f,
       .coat = s->coats[3]},
      {.kind = VL_BSDF_DIFFUSE_TRANSMISSION, .reflectance = 0.3f, .own = through},
      /* for the tests that do not integrate over the sphere */
      {.kind = VL_BSDF_CONDUCTOR, .eta = 0.2f, .k = 3.9f, .alpha_x = 0.01f, .alpha_y = 0.02f},
      {.kind = VL_BSDF_DIELECTRIC, .eta_s = 1.5f, .alpha_x = 0.01f, .alpha_y = 0.02f},
      {.kind = VL_BSDF_COATED_DIFFUSE,
       .reflectance = 0.8f,
       .eta_s = 1.5f,
       .alpha_x = 0.01f,
       .alpha_y = 0.01f,
       .coat = s->coats[3]}};
  return all[i];
}
enum { INTEGRABLE = 13 };
static const double thetas[] = {0.2, 1.0, 1.4, PI - 0.5, PI - 1.2};
enum { THETAS = 5 };
static const double wo_phi = 0.7;

/* ---- one direction ---- */

typedef struct {
  const State *s;
  vlBsdfKind kind;
  bool energy; /* value times the other side's index squared: energy, not radiance */
} Direction;
static void direction_set(Direction *d, const Surface *surface, double theta) {
  d->kind = surface->kind;
  for (uint32_t i = 0; i < VL_LANES; i++) {
    batch_surface(d->s->other, i, surface);
    batch_wo(d->s->other, i, theta, wo_phi);
  }
}
static void direction_eval(const Direction *d, const double w[3]) {
  Batch *b = d->s->other;
  b->ix[0] = (float)w[0];
  b->iy[0] = (float)w[1];
  b->iz[0] = (float)w[2];
  batch_eval(d->s->kernels, d->kind, 1, b);
}
static double direction_pdf(void *user, const double w[3]) {
  const Direction *d = user;
  direction_eval(d, w);
  return (double)d->s->other->pdf[0];
}
static double direction_value(void *user, double phi, double theta) {
  const Direction *d = user;
  const Batch *b = d->s->other;
  double s = sin(theta), w[3] = {s * cos(phi), s * sin(phi), cos(theta)}, scale = 1;
  direction_eval(d, w);
  if (d->kind == VL_BSDF_DIELECTRIC && d->energy && w[2] * (double)b->oz[0] < 0) {
    double eta = b->oz[0] > 0 ? (double)b->eta_s[0] : 1 / (double)b->eta_s[0];
    scale = eta * eta;
  }
  return (double)b->value[1][0] * scale * s;
}

/* ---- tests ---- */

/* The larger one; NaN if one is, so that it is found. */
static double larger(double a, double b) {
  return a > b || a != a ? a : b;
}

static void chi_square(void **state) {
  State *s = *state;
  Batch *b = s->batch;
  Direction d = {s, 0, false};
  for (int i = 0; i < INTEGRABLE; i++)
    for (int t = 0; t < THETAS; t++) {
      Surface surf = surface(s, i);
      statRng rng = stat_rng((uint64_t)(i * THETAS + t));
      statSphere hist = stat_sphere_new(24, 32);
      for (int turn = 0; turn < 64; turn++) {
        for (uint32_t j = 0; j < BATCH; j++) {
          batch_surface(b, j, &surf);
          batch_wo(b, j, thetas[t], wo_phi);
        }
        batch_numbers(b, BATCH, &rng);
        batch_sample(s->kernels, surf.kind, BATCH, b);
        for (uint32_t j = 0; j < BATCH; j++)
          if (b->flags[j] & (VL_SAMPLED_NONE | VL_SAMPLED_SPECULAR))
            stat_sphere_reject(hist);
          else
            stat_sphere_add(hist, (double)b->ix[j], (double)b->iy[j], (double)b->iz[j]);
      }
      direction_set(&d, &surf, thetas[t]);
      statResult r = stat_sphere_test(hist, direction_pdf, &d, 2e-5);
      if (!stat_accept(r, INTEGRABLE * THETAS))
        fail_msg("surface %d, theta %g: p %g, integral %g", i, thetas[t], r.p, r.integral);
      assert_true(r.integral < 1.0005);
    }
}

/* For each sample eval returns the same: pdf, and value = weight pdf. Transmission is
 * flagged. */
static void consistent(void **state) {
  State *s = *state;
  Batch *b = s->batch, *c = calloc(1, sizeof *c);
  statRng rng = stat_rng(5);
  for (int i = 0; i < SURFACES; i++) {
    Surface surf = surface(s, i);
    double worst = 0;
    uint32_t landed = 0;
    for (uint32_t j = 0; j < BATCH; j++) {
      batch_surface(b, j, &surf);
      double d[3];
      stat_direction(&rng, d);
      b->ox[j] = (float)d[0];
      b->oy[j] = (float)d[1];
      b->oz[j] = (float)d[2];
    }
    batch_numbers(b, BATCH, &rng);
    batch_sample(s->kernels, surf.kind, BATCH, b);
    *c = *b;
    batch_eval(s->kernels, surf.kind, BATCH, c);
    for (uint32_t j = 0; j < BATCH; j++) {
      if (b->flags[j] & VL_SAMPLED_NONE) {
        assert_true(b->weight[0][j] == 0 && b->pdf[j] == 0);
        continue;
      }
      double length =
          sqrt((double)(b->ix[j] * b->ix[j] + b->iy[j] * b->iy[j] + b->iz[j] * b->iz[j]));
      assert_true(fabs(length - 1) < 1e-5);
      assert_true(((b->flags[j] & VL_SAMPLED_TRANSMISSION) != 0) == (b->oz[j] * b->iz[j] < 0));
      if (!(b->flags[j] & VL_SAMPLED_TRANSMISSION))
        assert_true(b->scale[j] == 1.0f);
      if (b->flags[j] & VL_SAMPLED_SPECULAR) {
        assert_true(b->pdf[j] <= 1.0f);
        continue;
      }
      landed++;
      /* microfacets that wi meets at grazing angles are ill-conditioned: the half vector's
       * rounding over alpha */
      if (fabsf(b->iz[j]) < 0.01f || fabsf(b->oz[j]) < 0.01f)
        continue;
      for (int k = 0; k < 4; k++) {
        double v = (double)c->value[k][j], w = (double)b->weight[k][j] * (double)b->pdf[j];
        worst = larger(worst, fabs(v - w) / (fabs(v) + 1e-6));
      }
      worst =
          larger(worst, fabs((double)(b->pdf[j] - c->pdf[j])) / (double)(b->pdf[j] + 1e-6f));
    }
    if (!(worst < (i < INTEGRABLE ? 2e-4 : 5e-3)))
      fail_msg("surface %d: sample and eval differ by %g", i, worst);
    assert_true(landed > BATCH / 2);
  }
  free(c);
}

/* Sampled albedo (strata of one sample) against the integral of the value; both at most 1. */
static void albedo(void **state) {
  State *s = *state;
  Batch *b = s->batch;
  Direction d = {s, 0, true};
  enum { SIDE = 96 }; /* strata of (u, v), each with 16 lobe numbers */
  for (int i = 0; i < INTEGRABLE; i++)
    for (int t = 0; t < THETAS; t++) {
      Surface surf = surface(s, i);
      statRng rng = stat_rng((uint64_t)(77 + i * THETAS + t));
      double sum = 0, delta = 0;
      uint32_t n = 0;
      for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
          float u = ((float)x + stat_float(&rng)) / SIDE,
                v = ((float)y + stat_float(&rng)) / SIDE;
          for (int l = 0; l < 16; l++) {
            batch_surface(b, n, &surf);
            batch_wo(b, n, thetas[t], wo_phi);
            b->lobe[n] = ((float)l + stat_float(&rng)) / 16;
            b->u[n] = u;
            b->v[n] = v;
            if (++n < BATCH)
              continue;
            batch_sample(s->kernels, surf.kind, n, b);
            for (uint32_t j = 0; j < n; j++) {
              double w = (double)(b->weight[1][j] * b->scale[j]); /* scale: back to energy */
              if (b->flags[j] & VL_SAMPLED_SPECULAR)
                delta += w;
              else
                sum += w;
            }
            n = 0;
          }
        }
      double count = 16.0 * SIDE * SIDE;
      sum /= count;
      delta /= count;
      direction_set(&d, &surf, thetas[t]);
      double whole = 0;
      for (int h = 0; h < 2; h++)
        for (int q = 0; q < 8; q++) {
          double y0 = h * PI / 2, x0 = q * PI / 4;
          double first = stat_gauss_cell(direction_value, &d, x0, x0 + PI / 4, y0, y0 + PI / 2);
          whole += stat_integrate(direction_value, &d, x0, x0 + PI / 4, y0, y0 + PI / 2, first,
                                  4e-6, 9);
        }
      if (!(fabs(sum / whole - 1) < 1e-3))
        fail_msg("surface %d theta %g: sampled %g, integral %g", i, thetas[t], sum, whole);
      assert_true(sum + delta < 1.0005);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(chi_square), cmocka_unit_test(consistent),
                                     cmocka_unit_test(albedo)};
  return cmocka_run_group_tests(tests, build_coats, teardown);
}
