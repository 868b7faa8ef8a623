/* test_coat.c: the coat's tables against an independent random walk in double through
 * interface, layer and base, with microfacets drawn from D(h) cos h (the library draws visible
 * ones). Also the properties that vl_coat_build guarantees. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
/* cmocka.h needs the headers above */

#include "material/coat.h"
#include "statistics.h"
#include "unit.h"

#define PI 3.14159265358979323846
enum { BINS = 4, KEPT = 12 };

typedef struct {
  double x, y, z;
} Vec;

/* ---- an interface of its own, in double ---- */

static double lambda(Vec w, double alpha) {
  double tan2 = fmax(0.0, 1.0 - w.z * w.z) / (w.z * w.z);
  return 0.5 * (sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}
/* Reflectance for a cosine > 0 on the side of the light; index eta beyond over before. */
static double fresnel(double c, double eta, double *cos_t) {
  double sin2 = (1.0 - c * c) / (eta * eta);
  if (sin2 >= 1.0)
    return 1.0;
  *cos_t = sqrt(1.0 - sin2);
  double s = (c - eta * *cos_t) / (c + eta * *cos_t),
         p = (eta * c - *cos_t) / (eta * c + *cos_t);
  return 0.5 * (s * s + p * p);
}
/* o.z > 0 towards where light comes from. Returns false when it is lost; else mirrored (w.z >
 * 0) or not (w.z < 0) and weight is multiplied by f cos / density, energy (no 1/eta^2). */
static bool interface(statRng *rng, Vec o, double eta, double alpha, Vec *w, double *weight) {
  Vec h = {0, 0, 1};
  bool rough = alpha >= 1e-3;
  if (rough) {
    double u = stat_double(rng), phi = 2 * PI * stat_double(rng),
           tan2 = alpha * alpha * u / (1 - u);
    h.z = 1 / sqrt(1 + tan2);
    double s = sqrt(fmax(0, 1 - h.z * h.z));
    h.x = s * cos(phi);
    h.y = s * sin(phi);
  }
  double oh = o.x * h.x + o.y * h.y + o.z * h.z, cos_t = 0;
  if (oh <= 0)
    return false;
  double f = fresnel(oh, eta, &cos_t);
  bool mirror = stat_double(rng) < f;
  double a = mirror ? 2 * oh : oh / eta - cos_t, b = mirror ? 1 : 1 / eta;
  *w = (Vec){a * h.x - b * o.x, a * h.y - b * o.y, a * h.z - b * o.z};
  if (mirror ? w->z <= 0 : w->z >= 0)
    return false;
  /* f cos_i / (D cos h dh/dwi) = (F or T) G |o.h| / (cos o cos h) */
  if (rough)
    *weight *= oh / (o.z * h.z) / (1 + lambda(o, alpha) + lambda(*w, alpha));
  return true;
}

typedef struct {
  /* light that left after k + 1 meetings with a white base, by bins of cos^2; sums of values
   * and squares */
  double sum[KEPT][BINS], square[KEPT][BINS];
  double paths;
} Walk;

static void walk(Walk *tally, statRng *rng, double cos_o, double eta, double tau, double alpha,
                 int paths) {
  for (int i = 0; i < paths; i++) {
    double weight = 1, found[KEPT][BINS] = {{0}};
    Vec w, o = {sqrt(1 - cos_o * cos_o), 0, cos_o};
    bool on = interface(rng, o, eta, alpha, &w, &weight) && w.z < 0;
    for (int k = 0; on && k < KEPT; k++) {
      weight *= exp(tau / w.z); /* down */
      double r = sqrt(stat_double(rng)), phi = 2 * PI * stat_double(rng);
      Vec up = {r * cos(phi), r * sin(phi), sqrt(fmax(1e-300, 1 - r * r))};
      weight *= exp(-tau / up.z);
      /* seen from inside, mirrored so that the light comes from z > 0 */
      on = interface(rng, up, 1 / eta, alpha, &w, &weight);
      if (on && w.z < 0) {
        int bin = (int)(w.z * w.z * BINS);
        found[k][bin < BINS ? bin : BINS - 1] += weight;
        on = false;
      }
      w.z = -w.z;
    }
    for (int k = 0; k < KEPT; k++)
      for (int b = 0; b < BINS; b++) {
        tally->sum[k][b] += found[k][b];
        tally->square[k][b] += found[k][b] * found[k][b];
      }
  }
  tally->paths += paths;
}

static double through(const float *row, double c) {
  vlCoatCell p = vl_coat_cell((float)c);
  const float *q = row + p.first;
  return (double)vl_coat_cubic(q[0], q[1], q[2], q[3], p.t);
}
/* int over the bin of T(c) 2c dc */
static double bin_escape(const vlCoatTable *t, int bin) {
  double sum = 0;
  for (int i = 0; i < 200; i++)
    sum += through(t->transmittance[0], sqrt((bin + (i + 0.5) / 200) / BINS)) / 200 / BINS;
  return sum;
}

static void against_walk(void **state) {
  const float alphas[] = {0.0f, 0.001f, 0.05f, 0.1f, 0.3f};
  const double cosines[] = {0.95, 0.5, 0.15}, rhos[] = {0.1, 0.5, 0.9};
  const float eta = 1.5f, tau = 0.05f;
  double worst = 0;
  for (size_t a = 0; a < 5; a++) {
    vlCoatTable *t;
    assert_int_equal(vl_coat_build(*state, eta, tau, 10, alphas[a], alphas[a], &t), VL_OK);
    assert_int_equal(t->bounces, 5);
    for (size_t c = 0; c < 3; c++) {
      static Walk tally;
      memset(&tally, 0, sizeof tally);
      statRng rng = stat_rng(100 * a + c);
      walk(&tally, &rng, cosines[c], (double)eta, (double)tau, (double)alphas[a], 600000);
      for (size_t r = 0; r < 3; r++) {
        double rho = rhos[r], series = 0, all_seen = 0, all_closed = 0, all_variance = 0;
        for (int k = 0; k < 5; k++)
          series += pow(rho * (double)t->back[0], k);
        for (int b = 0; b < BINS; b++) {
          double seen = 0, variance = 0;
          for (int k = 0; k < 5; k++) { /* pbrt's depth: five meetings */
            double f = pow(rho, k + 1), mean = tally.sum[k][b] / tally.paths;
            seen += f * mean;
            variance += f * f * (tally.square[k][b] / tally.paths - mean * mean) / tally.paths;
          }
          double closed = through(t->transmittance[0], cosines[c]) * rho / (double)(eta * eta) *
                          series * bin_escape(t, b);
          double off = fabs(seen - closed) / sqrt(variance);
          worst = fmax(worst, off);
          if (off > 4.5)
            fail_msg("alpha %g cos %g rho %g bin %d: walk %g, closed %g (%.1f sigma)",
                     (double)alphas[a], cosines[c], rho, b, seen, closed, off);
          all_seen += seen;
          all_closed += closed;
          all_variance += variance;
        }
        double ratio = all_seen / all_closed, error = sqrt(all_variance) / all_closed;
        if (fabs(ratio - 1) > 4 * error + 5e-4 || error > 6e-3)
          fail_msg("alpha %g cos %g rho %g: ratio %.4f +- %.4f", (double)alphas[a], cosines[c],
                   rho, ratio, error);
      }
    }
    vl_coat_free(*state, t);
  }
  print_message("worst bin: %.2f sigma\n", worst);
}

/* The table that imitates pbrt-v4: its walk leaves through the coat by two samplers, visible
 * normals from wi (density p) and the base's cosine (density d), weighed p^2/(p^2 + d^2) and
 * d^2/(d^2 + q^2): q should be p and is the density of wi by visible normals from inside.
 * Integrated here over cosine-distributed directions. */
static void imitation(void **state) {
  const float alphas[] = {0.2f, 0.4f}, eta_f = 1.5f, tau = 0.01f;
  const double eta = 1.5, cosines[] = {0.9, 0.3};
  for (int a = 0; a < 2; a++) {
    vlCoatTable *t;
    assert_int_equal(vl_coat_build(*state, eta_f, tau, 10, alphas[a], alphas[a], &t), VL_OK);
    for (int k = 0; k < 2; k++) {
      statRng rng = stat_rng((uint64_t)(7 + k));
      double alpha = (double)alphas[a], excess = 0, square = 0;
      Vec o = {sqrt(1 - cosines[k] * cosines[k]), 0, cosines[k]};
      enum { TRIES = 400000 };
      for (int i = 0; i < TRIES; i++) {
        double r = sqrt(stat_double(&rng)), phi = 2 * PI * stat_double(&rng);
        Vec w = {r * cos(phi), r * sin(phi), -sqrt(fmax(1e-12, 1 - r * r))};
        Vec h = {-(o.x + eta * w.x), -(o.y + eta * w.y), -(o.z + eta * w.z)}; /* eta > 1: up */
        double n = sqrt(h.x * h.x + h.y * h.y + h.z * h.z), cos_t = 0;
        h = (Vec){h.x / n, h.y / n, h.z / n};
        double oh = o.x * h.x + o.y * h.y + o.z * h.z, wh = w.x * h.x + w.y * h.y + w.z * h.z,
               c = -w.z;
        if (oh <= 0 || wh >= 0 || h.z <= 0)
          continue;
        double e = (h.x * h.x + h.y * h.y) / (alpha * alpha) + h.z * h.z,
               density = 1 / (PI * alpha * alpha * e * e);
        double lo = lambda(o, alpha), lw = lambda(w, alpha), out = wh + oh / eta,
               in = oh + wh * eta;
        double p = density * oh / (1 + lo) / o.z * -wh / (out * out),
               q = density * -wh / (1 + lw) / c * oh / (in * in);
        double ft = (1 - fresnel(oh, eta, &cos_t)) * density * oh * -wh /
                    (o.z * c * out * out) / (1 + lo + lw);
        double x = ft * PI * exp(-(double)tau / c), d = c / PI;
        double y = x * (p * p / (p * p + d * d) + d * d / (d * d + q * q) - 1);
        excess += y;
        square += y * y;
      }
      excess /= TRIES;
      double error = sqrt((square / TRIES - excess * excess) / TRIES);
      double plain = through(t->transmittance[0], cosines[k]),
             got = through(t->imitation[0], cosines[k]) - plain;
      if (fabs(got - excess) > 4 * error || error > 1e-3)
        fail_msg("alpha %g cos %g: excess %g, should be %g +- %g", alpha, cosines[k], got,
                 excess, error);
      assert_true(excess > 0.03 * plain); /* it is worth a table */
    }
    vl_coat_free(*state, t);
  }
}

/* A clear coat over white: nothing is lost at a smooth one, and never more leaves or comes back
 * than was there. */
static void energy(void **state) {
  for (int i = 0; i < 24; i++) {
    float eta = (float[]){1.2f, 1.5f, 2.4f}[i % 3], tau = (float[]){0.0f, 0.1f}[i / 3 % 2];
    float alpha = (float[]){0.0f, 0.01f, 0.2f, 0.8f}[i / 6];
    vlCoatTable *t;
    assert_int_equal(vl_coat_build(*state, eta, tau, 10, alpha, alpha, &t), VL_OK);
    float sum = t->back[0] + t->escape[0];
    assert_true(sum < 1.0002f && t->back[0] >= 0 && t->escape[0] > 0);
    if (alpha == 0 && tau == 0)
      assert_true(fabsf(sum - 1) < 1e-4f);
    for (int k = 0; k < VL_COAT_COS; k++)
      assert_true(t->transmittance[0][k] >= 0 && t->transmittance[0][k] <= 1);
    for (int k = 0; k < VL_COAT_COS; k++)
      assert_true(t->imitation[0][k] >= t->transmittance[0][k] * 0.99f);
    assert_false(t->imitate);
    vl_coat_free(*state, t);
  }
  /* no interface at all */
  vlCoatTable *t;
  assert_int_equal(vl_coat_build(*state, 1.0f, 0.0f, 10, 0.3f, 0.3f, &t), VL_OK);
  assert_true(t->transmittance[0][50] == 1.0f && t->back[0] == 0.0f);
  vl_coat_free(*state, t);
}

/* The albedo over white: of a rough coat pbrt's loss, of one that conserves energy none, or
 * what the layer absorbs, which a smooth coat loses, too. */
static void conserving(void **state) {
  vlCoatTable *t, *smooth;
  double albedo, other;
  assert_int_equal(vl_coat_build(*state, 1.5f, 0.01f, 10, 0.4f, 0.4f, &t), VL_OK);
  assert_int_equal(vl_coat_white_albedo(*state, t, &albedo), VL_OK);
  if (!(fabs(albedo - 0.572) < 0.002))
    fail_msg("a rough coat keeps %g", albedo);
  assert_int_equal(vl_coat_conserve(*state, t), VL_OK);
  float once = t->back[0];
  assert_int_equal(vl_coat_conserve(*state, t), VL_OK); /* once is enough */
  assert_true(t->back[0] == once && t->conserves);
  assert_int_equal(vl_coat_white_albedo(*state, t, &albedo), VL_OK);
  assert_int_equal(vl_coat_build(*state, 1.5f, 0.01f, 1000, 0, 0, &smooth), VL_OK);
  assert_int_equal(vl_coat_white_albedo(*state, smooth, &other), VL_OK);
  if (!(fabs(albedo - other) < 0.02 && albedo < 1))
    fail_msg("conserving %g, smooth %g", albedo, other);
  vl_coat_free(*state, t);
  vl_coat_free(*state, smooth);
  for (int i = 0; i < 16; i++) {
    float eta = (float[]){0.7f, 1.2f, 1.5f, 2.4f}[i % 4],
          alpha = (float[]){0.01f, 0.1f, 0.4f, 1.0f}[i / 4];
    assert_int_equal(vl_coat_build(*state, eta, 0.0f, 10, alpha, alpha, &t), VL_OK);
    assert_int_equal(vl_coat_conserve(*state, t), VL_OK);
    float sum = t->back[0] + t->escape[0];
    assert_true(fabsf(sum - 1) < 1e-4f && t->back[0] >= 0 && t->escape[0] > 0);
    for (int k = 0; k < VL_COAT_COS; k++) {
      assert_true(t->transmittance[0][k] >= 0 && t->transmittance[0][k] <= 1);
      assert_true(t->imitation[0][k] == t->transmittance[0][k]);
    }
    assert_int_equal(vl_coat_white_albedo(*state, t, &albedo), VL_OK);
    if (!(eta < 1 || (albedo > 0.999 && albedo < 1.001)))
      fail_msg("eta %g alpha %g: %g", eta, alpha, albedo);
    vl_coat_free(*state, t);
  }
  /* Two alphas: what leaves in other directions than it came from, too. */
  for (int i = 0; i < 3; i++) {
    const float alphas[3][2] = {{0.1f, 0.5f}, {0.6f, 0.05f}, {0, 0.3f}};
    assert_int_equal(
        vl_coat_build_anisotropic(*state, 1.5f, 0.0f, 1000, alphas[i][0], alphas[i][1], &t),
        VL_OK);
    assert_int_equal(t->rows, VL_COAT_AZIMUTHS);
    assert_int_equal(vl_coat_white_albedo(*state, t, &other), VL_OK);
    assert_int_equal(vl_coat_conserve(*state, t), VL_OK);
    assert_int_equal(vl_coat_white_albedo(*state, t, &albedo), VL_OK);
    if (!(other < 0.97 && albedo > 0.998 && albedo < 1.002))
      fail_msg("anisotropic %d: %g, %g", i, other, albedo);
    vl_coat_free(*state, t);
  }
}

/* Rows of a textured roughness against tables of one alpha. */
static void textured(void **state) {
  vlCoatTable *t, *one;
  assert_int_equal(vl_coat_build(*state, 1.5f, 0.01f, 10, 0.0f, 0.5f, &t), VL_OK);
  assert_int_equal(t->rows, VL_COAT_ALPHA);
  for (int i = 0; i < 12; i++) {
    float alpha = 0.5f * powf(((float)i + 0.5f) / 12, 2),
          row = (sqrtf(alpha) - t->row_start) * t->row_scale;
    int low = (int)row;
    float f = row - (float)low;
    assert_int_equal(vl_coat_build(*state, 1.5f, 0.01f, 10, alpha, alpha, &one), VL_OK);
    for (int k = 1; k <= 20; k++) {
      double c = k / 20.0, a = through(t->transmittance[low], c),
             b = through(t->transmittance[low + 1], c);
      double got = a + (double)f * (b - a), want = through(one->transmittance[0], c);
      if (fabs(got / want - 1) > (c > 0.1 ? 2e-3 : 1e-2))
        fail_msg("alpha %g cos %g: %g, not %g", (double)alpha, c, got, want);
    }
    float back = t->back[low] + f * (t->back[low + 1] - t->back[low]);
    assert_true(fabsf(back / one->back[0] - 1) < 2e-3f);
    vl_coat_free(*state, one);
  }
  vl_coat_free(*state, t);
}

static void arguments(void **state) {
  vlCoatTable *t;
  const float nan = NAN;
  assert_int_equal(vl_coat_build(*state, 0.0f, 0.01f, 10, 0, 0, &t), VL_ERROR_ARGUMENT);
  assert_null(t);
  assert_int_equal(vl_coat_build(*state, nan, 0.01f, 10, 0, 0, &t), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_coat_build(*state, 1.5f, -1.0f, 10, 0, 0, &t), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_coat_build(*state, 1.5f, 0.01f, 10, 0.2f, 0.1f, &t), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_coat_build(*state, 1.5f, 0.01f, 10, nan, nan, &t), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_coat_build_anisotropic(*state, 1.5f, 0.01f, 10, 0.1f, nan, &t),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_coat_build_anisotropic(*state, 1.5f, 0.01f, 10, -0.1f, 0.2f, &t),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_coat_build_anisotropic(*state, nan, 0.01f, 10, 0.1f, 0.2f, &t),
                   VL_ERROR_ARGUMENT);
  assert_int_equal(vl_coat_build(*state, 1.5f, 0.01f, 0xffffffffu, 0, 0, &t), VL_OK);
  assert_int_equal(t->bounces, 255);
  vl_coat_free(*state, t);
  vl_coat_free(*state, NULL);
}

static size_t calls_left, blocks;
static void *few(void *user, size_t size) {
  (void)user;
  if (calls_left == 0)
    return NULL;
  calls_left--;
  void *block = malloc(size);
  blocks += block != NULL;
  return block;
}
static void give_back(void *user, void *block) {
  (void)user;
  blocks -= block != NULL;
  free(block);
}
static void out_of_memory(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.allocator = (vlAllocator){NULL, few, give_back};
  def.threads = 1;
  int failed = 0;
  for (size_t limit = 0;; limit++) {
    vlContext *context;
    calls_left = 100;
    assert_int_equal(vl_context_create(&def, &context), VL_OK);
    size_t before = blocks;
    calls_left = limit;
    vlCoatTable *t;
    vlResult result = vl_coat_build(context, 1.5f, 0.01f, 10, 0, 0, &t);
    if (result == VL_OK) {
      result = vl_coat_conserve(context, t);
      assert_true(t->conserves == (result == VL_OK));
      vl_coat_free(context, t);
    }
    if (result != VL_OK) {
      assert_int_equal(result, VL_ERROR_MEMORY);
      failed++;
    }
    assert_int_equal(blocks, before);
    vl_context_destroy(context);
    assert_int_equal(blocks, 0);
    if (result == VL_OK)
      break;
  }
  assert_true(failed >= 3);
}

static int setup(void **state) {
  vlContextDef def = vl_default_context_def();
  return vl_context_create(&def, (vlContext **)state);
}
static int teardown(void **state) {
  vl_context_destroy(*state);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(against_walk), cmocka_unit_test(imitation), cmocka_unit_test(energy),
      cmocka_unit_test(conserving),   cmocka_unit_test(textured),  cmocka_unit_test(arguments),
      cmocka_unit_test(out_of_memory)};
  return cmocka_run_group_tests(tests, setup, teardown);
}
