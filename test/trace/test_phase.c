/* test_phase.c: the phase function integrates to 1 over the sphere, is sampled by its density
 * and is reciprocal; free flights and transmittances through a grid do not depend on its
 * majorants. */
#include <math.h>
/* cmocka.h needs the headers above */

#include "statistics.h"
#include "trace/medium/medium.h"
#include "trace/medium/phase.h"
#include "unit.h"
#include "velo/medium.h"

static const float gs[] = {-0.99f, -0.8f, -0.3f, -0.0005f, 0.0f, 0.0005f,
                           0.002f, 0.3f,  0.7f,  0.95f,    0.99f};
enum { GS = sizeof gs / sizeof *gs };

static void normalised(void **state) {
  (void)state;
  for (int i = 0; i < GS; i++) {
    double sum = 0, mean = 0;
    const int n = 200000;
    /* finer where it is steep: cosine = 1 - 2 x^3 from both ends */
    for (int k = 0; k < n; k++) {
      double x = (k + 0.5) / n, cosine = 1 - 2 * x * x * x, width = 6 * x * x / n;
      sum += vl_phase(gs[i], (float)cosine) * 2 * M_PI * width * (gs[i] > 0);
      sum += vl_phase(gs[i], (float)-cosine) * 2 * M_PI * width * !(gs[i] > 0);
      mean += vl_phase(gs[i], (float)(gs[i] > 0 ? cosine : -cosine)) * 2 * M_PI * width *
              (gs[i] > 0 ? cosine : -cosine);
    }
    if (!(fabs(sum - 1) < 1e-3) || !(fabs(mean - (double)gs[i]) < 2e-3))
      fail_msg("g = %g: integral %g, mean cosine %g", (double)gs[i], sum, mean);
  }
}

typedef struct Lobe {
  float g;
  vlVec3 d;
} Lobe;
static double lobe_pdf(void *user, const double w[3]) {
  const Lobe *l = user;
  return (double)vl_phase(l->g, vl_dot(l->d, vl_vec3((float)w[0], (float)w[1], (float)w[2])));
}

static void sampled(void **state) {
  (void)state;
  statRng rng = stat_rng(7);
  for (int i = 1; i + 1 < GS; i++) {
    double d[3];
    stat_direction(&rng, d);
    Lobe lobe = {gs[i], vl_normalize(vl_vec3((float)d[0], (float)d[1], (float)d[2]))};
    statSphere hist = stat_sphere_new(24, 48);
    for (int k = 0; k < 200000; k++) {
      float u = stat_float(&rng), v = stat_float(&rng);
      vlVec3 w = vl_phase_sample(lobe.g, lobe.d, u, v);
      assert_true(fabs((double)vl_length(w) - 1) < 1e-6);
      stat_sphere_add(hist, (double)w.x, (double)w.y, (double)w.z);
    }
    statResult r = stat_sphere_test(hist, lobe_pdf, &lobe, 0.0);
    if (!stat_accept(r, GS))
      fail_msg("g = %g: p = %g", (double)gs[i], r.p);
  }
}

/* At the limits of u, v and g directions are finite and of unit length. */
static void ends(void **state) {
  (void)state;
  const float u[] = {0.0f, 0x1p-24f, 0.5f, VL_ONE_MINUS_EPSILON};
  for (int i = 0; i < GS; i++)
    for (int a = 0; a < 4; a++)
      for (int b = 0; b < 4; b++) {
        vlVec3 d = vl_vec3(0, 0, a & 1 ? -1.0f : 1.0f),
               w = vl_phase_sample(gs[i], d, u[a], u[b]);
        assert_true(fabs((double)vl_length(w) - 1) < 1e-6);
        float p = vl_phase(gs[i], vl_dot(d, w));
        assert_true(p > 0 && p < 1e6f);
        assert_true(p == vl_phase(gs[i], vl_dot(w, d)));
      }
}

/* A 3 x 2 x 2 grid over the box (0..3, 0..2, 0..2), coefficients by channel. */
typedef struct Fog {
  vlWorldMedium medium;
  float density[12], majorants[12];
} Fog;

static Fog fog(float factor, bool scatters) {
  Fog f = {.density = {1, 2, 0.5f, 3, 0, 1, 1, 0, 2, 1, 1, 4}};
  static const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
  f.medium = (vlWorldMedium){
      .kind = VL_MEDIUM_GRID, .scatters = scatters, .high = {3, 2, 2}, .cells = {3, 2, 2}};
  f.medium.sigma_a =
      (vlSpectral){.kind = VL_SPECTRAL_RGB, .scale = 1, .rgb = {0.2f, 0.4f, 0.1f}};
  f.medium.sigma_s = (vlSpectral){
      .kind = VL_SPECTRAL_RGB, .scale = scatters ? 1 : 0, .rgb = {0.5f, 0.2f, 0.7f}};
  memcpy(f.medium.medium_from_world, identity, sizeof identity);
  for (int i = 0; i < 12; i++)
    f.majorants[i] = 4.0f * factor;
  return f;
}
static void point_in(Fog *f) {
  f->medium.density = (vlDenseGrid){3, 2, 2, f->density};
  f->medium.majorants = f->majorants;
}

static vlFlight new_flight(uint32_t key) {
  return (vlFlight){.beta = {1, 1, 1, 0},
                    .u = {1, 1, 1, 1},
                    .l = {1, 1, 1, 1},
                    .channels = 3,
                    .hero = (int)(key % 3),
                    .first = -1,
                    .key = vl_hash(key)};
}

/* Transmittance by both trackings, single-sample MIS over the heroes, against quadrature. */
static void majorants_do_not_show(void **state) {
  (void)state;
  const vlVec3 o = {-0.5f, 0.3f, 0.6f}, d = vl_normalize(vl_vec3(1, 0.2f, 0.25f));
  const float t0 = 0.2f, t1 = 3.7f;
  for (int scatters = 0; scatters < 2; scatters++) {
    Fog exact = fog(1, scatters);
    point_in(&exact);
    double depth[3] = {0, 0, 0};
    const int steps = 20000;
    for (int k = 0; k < steps; k++) {
      float t = t0 + (t1 - t0) * ((float)k + 0.5f) / (float)steps;
      vlVec3 p = vl_add(o, vl_mul(d, t));
      if (p.x < 0 || p.x > 3 || p.y < 0 || p.y > 2 || p.z < 0 || p.z > 2)
        continue;
      float lambda[4] = {0};
      vlMediumLight whole = vl_medium_coefficients(&exact.medium, lambda);
      vlMediumLight at = vl_medium_at(&exact.medium, &whole, lambda, p, false);
      for (int c = 0; c < 3; c++)
        depth[c] += (double)(at.a[c] + at.s[c]) * (double)(t1 - t0) / steps;
    }
    for (int m = 0; m < 3; m++) {
      Fog f = fog((const float[]){1.0f, 1.7f, 6.0f}[m], scatters);
      point_in(&f);
      double flown[3] = {0}, passed[3] = {0}, square[3] = {0}, ratio_square[3] = {0};
      const int n = 60000;
      for (uint32_t k = 0; k < (uint32_t)n; k++) {
        vlFlight a = new_flight(2 * k), b = new_flight(2 * k + 1);
        float radiance[4] = {0}, t;
        a.hero = b.hero = (int)(k % 3);
        if (vl_track(&f.medium, o, d, t0, t1, false, &a, radiance, &t) == VL_FLIGHT_PASSED) {
          double inv = 1 / (double)vl_flight_mean(a.u, 3);
          for (int c = 0; c < 3; c++) {
            flown[c] += (double)a.beta[c] * inv;
            square[c] += pow((double)a.beta[c] * inv, 2);
          }
        }
        vl_track_through(&f.medium, o, d, t0, t1, &b);
        double inv = 1 / (double)vl_flight_mean(b.l, 3);
        for (int c = 0; c < 3; c++) {
          passed[c] += (double)b.beta[c] * inv;
          ratio_square[c] += pow((double)b.beta[c] * inv, 2);
        }
      }
      for (int c = 0; c < 3; c++) {
        double expected = exp(-depth[c]), e1 = sqrt(square[c]) / n,
               e2 = sqrt(ratio_square[c]) / n;
        if (fabs(flown[c] / n - expected) > 4.5 * e1 + 1e-4 ||
            fabs(passed[c] / n - expected) > 4.5 * e2 + 1e-4)
          fail_msg(
              "scatters %d, majorants %d, channel %d: %g (+- %g) and %g (+- %g), expected %g",
              scatters, m, c, flown[c] / n, e1, passed[c] / n, e2, expected);
      }
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(normalised), cmocka_unit_test(sampled),
                                     cmocka_unit_test(ends),
                                     cmocka_unit_test(majorants_do_not_show)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
