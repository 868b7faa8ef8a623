/* test_bssrdf.c: subsurface profiles against independent integrals: dipoles and single
 * scattering along the refracted ray by quadrature, with moments of the Fresnel reflectance
 * that are integrals, too (the library uses polynomials and a hundred points). Also reads from
 * the tables: sums, samples, the inversion of a reflectance. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka.h needs the headers above */

#include "material/bssrdf.h"
#include "statistics.h"
#include "unit.h"

#define PI 3.14159265358979323846

typedef struct Setup {
  vlContext *context;
  vlBssrdfTable *table;
} Setup;

static Setup setup(float eta, float g) {
  Setup s = {NULL, malloc(sizeof(vlBssrdfTable))};
  vlContextDef def = vl_default_context_def();
  def.threads = 2;
  assert_int_equal(vl_context_create(&def, &s.context), VL_OK);
  vl_bssrdf_build(s.context, eta, g, s.table);
  return s;
}
static void teardown(Setup *s) {
  free(s->table);
  vl_context_destroy(s->context);
}

static void assert_within(const char *what, double value, double expected, double tolerance) {
  if (!(fabs(value - expected) <= tolerance))
    fail_msg("%s: %.7g, expected %.7g within %.2g", what, value, expected, tolerance);
}

/* ---- integrals of its own ---------------------------------------------------------------- */

/* n: index on the side of the light over that beyond */
static double fresnel(double cosine, double n) {
  double s2 = (1 - cosine * cosine) * n * n;
  if (s2 >= 1)
    return 1;
  double t = sqrt(1 - s2), s = (n * cosine - t) / (n * cosine + t),
         p = (cosine - n * t) / (cosine + n * t);
  return (s * s + p * p) / 2;
}
static double moment(double n, int power) {
  double sum = 0;
  const int steps = 20000;
  for (int i = 0; i < steps; i++) {
    double c = (i + 0.5) / steps;
    sum += fresnel(c, n) * pow(c, power) / steps;
  }
  return sum;
}

/* R(r) for extinction 1, by the formulas of photon beam diffusion as published. */
static double profile(double albedo, double g, double eta, double r) {
  double a = 1 - albedo, s = albedo * (1 - g), t = a + s, rho = s / t;
  double m1 = moment(eta, 1), m2 = moment(eta, 2);
  double d = (2 * a + s) / (3 * t * t), k = sqrt(a / d),
         ze = 2 * d * (1 + 3 * m2) / (1 - 2 * m1);
  double cphi = (1 - 2 * m1) / 4, ce = (1 - 3 * m2) / 2, many = 0, once = 0;
  const int steps = 4000;
  for (int i = 0; i < steps; i++) {
    double u = (i + 0.5) / steps, z = -log(1 - u) / t, v = z + 2 * ze;
    double dr = hypot(r, z), dv = hypot(r, v);
    double phi = (exp(-k * dr) / dr - exp(-k * dv) / dv) / (4 * PI * d);
    double e = (z * (1 + k * dr) * exp(-k * dr) / pow(dr, 3) +
                v * (1 + k * dv) * exp(-k * dv) / pow(dv, 3)) /
               (4 * PI);
    many += rho * rho * (phi * cphi + e * ce) * (1 - exp(-2 * t * (dr + z))) / steps;
  }
  double zc = eta > 1 ? r * sqrt(eta * eta - 1) : 0;
  for (int i = 0; i < steps; i++) { /* dz exp(-z) albedo p exp(-l) T cos / l^2 */
    double z = zc - log(1 - (i + 0.5) / steps), l = hypot(r, z), c = z / l;
    double hg = (1 - g * g) / (4 * PI * pow(1 + g * g + 2 * g * c, 1.5));
    once += exp(-zc) * albedo * hg * exp(-l) * (1 - fresnel(c, eta)) * c / (l * l) / steps;
  }
  return many + once;
}

static void integrals(void **state) {
  (void)state;
  const struct { double eta, g; } bodies[] = {{1.33, 0}, {1.5, 0.5}, {1.1, -0.4}};
  for (int b = 0; b < 3; b++) {
    Setup s = setup((float)bodies[b].eta, (float)bodies[b].g);
    for (uint32_t i = 20; i < VL_BSSRDF_ALBEDOS; i += 26)
      for (uint32_t k = 15; k < 50; k += 6) {
        double r = (double)s.table->radius[k], rho = (double)s.table->albedo[i];
        double expected = 2 * PI * r * profile(rho, bodies[b].g, bodies[b].eta, r);
        char what[64];
        snprintf(what, sizeof what, "eta %g, albedo %g, radius %g", bodies[b].eta, rho, r);
        assert_within(what, (double)s.table->profile[i][k], expected, 0.03 * expected + 1e-7);
      }
    assert_within("leaves", (double)s.table->leaves, 1 - 2 * moment(1 / bodies[b].eta, 1),
                  3e-3);
    teardown(&s);
  }
}

/* ---- what is read from it ---------------------------------------------------------------- */

static void sums(void **state) {
  (void)state;
  Setup s = setup(1.4f, 0.2f);
  for (float albedo = 0.05f; albedo <= 1.0f; albedo += 0.095f) {
    vlSpline a = vl_bssrdf_albedo(s.table, albedo);
    double sum = 0;
    for (uint32_t i = 0; i + 1 < VL_BSSRDF_RADII; i++) {
      double x0 = (double)s.table->radius[i], width = (double)s.table->radius[i + 1] - x0;
      for (int k = 0; k < 16; k++)
        sum += width / 16 *
               (double)vl_bssrdf_ring(s.table, &a, (float)(x0 + width * (k + 0.5) / 16));
    }
    assert_within("sum", (double)vl_bssrdf_effective(s.table, &a), sum, 2e-3 * sum + 1e-6);
    /* R itself, also at r = 0 */
    float r = s.table->radius[1];
    assert_within("ring", (double)(vl_bssrdf_at(s.table, &a, r) * 2 * (float)PI * r),
                  (double)vl_bssrdf_ring(s.table, &a, r), 1e-5);
    assert_true(vl_bssrdf_at(s.table, &a, 0) > 0 && vl_bssrdf_at(s.table, &a, 1e30f) == 0);
    assert_true(vl_bssrdf_at(s.table, &a, 0) > vl_bssrdf_at(s.table, &a, 1));
  }
  vlSpline none = vl_bssrdf_albedo(s.table, 0);
  assert_true(vl_bssrdf_effective(s.table, &none) == 0 &&
              vl_bssrdf_sample(s.table, &none, 0.5f) < 0);
  teardown(&s);
}

static void samples(void **state) {
  (void)state;
  enum { CELLS = 60, N = 400000 };
  Setup s = setup(1.33f, 0);
  const float albedos[] = {0.3f, 0.8f, 0.97f, 0.999f, 1.0f};
  for (int k = 0; k < 5; k++) {
    vlSpline a = vl_bssrdf_albedo(s.table, albedos[k]);
    static statCell cells[CELLS];
    double edges[CELLS + 1], whole = (double)vl_bssrdf_effective(s.table, &a);
    for (int i = 0; i <= CELLS; i++)
      edges[i] = i ? 0.01 * pow(20000.0, (double)i / CELLS) : 0; /* to 200 */
    for (int i = 0; i < CELLS; i++) {
      double sum = 0, width = edges[i + 1] - edges[i];
      for (int j = 0; j < 64; j++)
        sum += width / 64 *
               (double)vl_bssrdf_ring(s.table, &a, (float)(edges[i] + width * (j + 0.5) / 64));
      cells[i] = (statCell){0, N * sum / whole};
    }
    statRng rng = stat_rng(17 + (uint64_t)k);
    for (int i = 0; i < N; i++) {
      double r = (double)vl_bssrdf_sample(s.table, &a, stat_float(&rng));
      assert_true(r >= 0 && r <= (double)s.table->radius[VL_BSSRDF_RADII - 1]);
      int cell = r < edges[1] ? 0 : 1 + (int)(log(r / 0.01) / log(20000.0) * CELLS - 1 + 1e-9);
      cell = cell < CELLS ? cell : CELLS - 1;
      while (cell > 0 && r < edges[cell])
        cell--;
      while (cell + 1 < CELLS && r >= edges[cell + 1])
        cell++;
      cells[cell].observed++;
    }
    statResult result = stat_chi2(cells, CELLS, 1);
    if (!(result.p > 1e-4))
      fail_msg("radii of albedo %g: p = %g", (double)albedos[k], result.p);
  }
  teardown(&s);
}

/* The cell that the logarithm of a radius gives is the cell that a search finds, also next to
 * nodes. */
static void cells(void **state) {
  (void)state;
  Setup s = setup(1.33f, 0);
  for (uint32_t k = 0; k < VL_BSSRDF_RADII; k++)
    for (int d = -2; d <= 2; d++) {
      float r = s.table->radius[k];
      for (int j = 0; j < abs(d); j++)
        r = nextafterf(r, d < 0 ? -1.0f : 1e9f);
      if (r < 0 || r > s.table->radius[VL_BSSRDF_RADII - 1])
        continue;
      assert_int_equal(vl_bssrdf_cell(s.table, r),
                       vl_find_interval(s.table->radius, VL_BSSRDF_RADII - 1, r));
    }
  for (float r = 1e-6f; r < 203; r *= 1.0013f)
    assert_int_equal(vl_bssrdf_cell(s.table, r),
                     vl_find_interval(s.table->radius, VL_BSSRDF_RADII - 1, r));
  teardown(&s);
}

/* The sampled radius grows with u, so stratified numbers give stratified radii. */
static void ordered(void **state) {
  (void)state;
  Setup s = setup(1.5f, 0);
  for (float albedo = 0.01f; albedo < 1; albedo += 0.11f) {
    vlSpline a = vl_bssrdf_albedo(s.table, albedo);
    float before = 0;
    for (int i = 0; i < 1000; i++) {
      float r = vl_bssrdf_sample(s.table, &a, (float)i / 1000);
      assert_true(r >= before * (1 - 1e-4f));
      before = r;
    }
  }
  teardown(&s);
}

static void there_and_back(void **state) {
  (void)state;
  const float etas[] = {0.7f, 1.0f, 1.33f, 2.0f, 2.5f};
  for (int k = 0; k < 5; k++) {
    Setup s = setup(etas[k], 0);
    float max = s.table->effective[VL_BSSRDF_ALBEDOS - 1];
    for (float e = 0; e < 1.1f; e += 0.007f) {
      float albedo = vl_bssrdf_invert(s.table, e);
      vlSpline a = vl_bssrdf_albedo(s.table, albedo);
      assert_true(albedo >= 0 && albedo <= 1);
      assert_within("back", (double)vl_bssrdf_effective(s.table, &a), (double)fminf(e, max),
                    2e-4);
    }
    teardown(&s);
  }
}

/* A table does not depend on the number of threads. At albedo 1 all light comes out, within the
 * error of diffusion, some percent. */
static void plain(void **state) {
  (void)state;
  Setup a = setup(1.33f, 0.3f), b = setup(1.33f, 0.3f);
  assert_memory_equal(a.table, b.table, sizeof *a.table);
  teardown(&b);
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  assert_int_equal(vl_context_create(&def, &b.context), VL_OK);
  b.table = malloc(sizeof *b.table);
  vl_bssrdf_build(b.context, 1.33f, 0.3f, b.table);
  assert_memory_equal(a.table, b.table, sizeof *a.table);
  for (uint32_t i = 1; i < VL_BSSRDF_ALBEDOS; i++)
    assert_true(a.table->effective[i] > a.table->effective[i - 1]);
  assert_true(a.table->effective[0] == 0);
  float max = a.table->effective[VL_BSSRDF_ALBEDOS - 1];
  assert_true(max > 0.97f && max < 1.03f);
  teardown(&a);
  teardown(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(integrals), cmocka_unit_test(sums),  cmocka_unit_test(samples),
      cmocka_unit_test(ordered),   cmocka_unit_test(cells), cmocka_unit_test(there_and_back),
      cmocka_unit_test(plain)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
