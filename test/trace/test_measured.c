/* test_measured.c: measured reflection against the surface that was measured: metal with GGX
 * microfacets, in files made by measured_file.h. Values, densities, sampling, albedo, furnace,
 * reciprocity, symmetries, wavelengths. */
#include <math.h>
/* cmocka.h needs the headers above */

#include "bsdf_state.h"
#include "color/color.h"
#include "material/measured_lookup.h"
#include "math/ggx.h"
#include "measured_file.h"
#include "unit.h"

static vlMeasured *measure(const State *s, const mfSurface *metal, bool rgb) {
  const char *path = VELO_BINARY_DIR "/measured.bsdf";
  mfFile file = mf_measure(metal);
  vlMeasured *m = NULL;
  vlError error = {0};
  assert_true(mf_write(path, &file));
  if (vl_measured_read(s->context, path, rgb, &m, &error) != VL_OK)
    fail_msg("%s", error.message);
  free(file.bytes);
  remove(path);
  return m;
}

static void put_surface(Batch *b, const vlMeasured *m, uint32_t n) {
  for (uint32_t i = 0; i < n; i++) {
    b->measured[i] = m;
    for (int c = 0; c < 4; c++)
      b->lambda[c][i] = 420.0f + 80.0f * (float)c;
  }
}

/* Sets random directions on both sides of the surface for lane i, within the cone of cos >
 * least. */
static void put_random(Batch *b, uint32_t n, statRng *rng, double min) {
  for (uint32_t i = 0; i < n; i++) {
    double o[3], w[3];
    do
      stat_direction(rng, o);
    while (fabs(o[2]) < min);
    do
      stat_direction(rng, w);
    while (fabs(w[2]) < min || o[2] * w[2] < 0);
    b->ox[i] = (float)o[0];
    b->oy[i] = (float)o[1];
    b->oz[i] = (float)o[2];
    b->ix[i] = (float)w[0];
    b->iy[i] = (float)w[1];
    b->iz[i] = (float)w[2];
  }
}

static const mfSurface *surfaces(uint32_t i) {
  static mfSurface all[6];
  all[0] = mf_surface(0.5, 0.5);
  all[1] = mf_surface(0.3, 0.3);
  all[2] = mf_surface(0.6, 0.3);
  all[3] = mf_surface(0.6, 0.3);
  all[4] = mf_surface(0.3, 0.6);
  all[5] = mf_surface(0.4, 0.4);
  all[3].parts = 2;
  all[4].parts = 4;
  all[5].phis = 24; /* isotropic, measured as if it were not */
  return &all[i];
}
enum { SURFACES = 6 };

/* ---- the maps ---- */

static void maps(void **state) {
  const State *s = *state;
  mfSurface metal = mf_surface(0.5, 0.25);
  vlMeasured *m = measure(s, &metal, false);
  statRng rng = stat_rng(1);
  assert_false(m->isotropic);
  for (int turn = 0; turn < 20000; turn++) {
    float phi = (float)(PI * (2 * stat_double(&rng) - 1)),
          theta = (float)(1.5 * stat_double(&rng));
    vlMeasuredSlices slices = vl_measured_slices(m, phi, theta);
    const vlMeasuredTable *t = turn & 1 ? &m->vndf : &m->luminance;
    float u = stat_float(&rng), v = stat_float(&rng);
    vlMeasuredPoint p = vl_measured_sample(t, slices, u, v),
                    back = vl_measured_invert(t, slices, p.x, p.y);
    assert_true(p.x >= 0 && p.x <= 1 && p.y >= 0 && p.y <= 1);
    if (fabsf(back.x - u) > 2e-5f / (p.pdf + 0.01f) + 2e-5f || fabsf(back.y - v) > 2e-5f)
      fail_msg("(%g %g) by (%g %g) to (%g %g)", (double)u, (double)v, (double)p.x, (double)p.y,
               (double)back.x, (double)back.y);
    float value = vl_measured_at(t, slices, p.x, p.y);
    assert_true(fabsf(value - p.pdf) < 1e-4f * (value + 1) &&
                fabsf(back.pdf - p.pdf) < 1e-3f * (value + 1));
    /* density times the Jacobian of the map, by differences */
    float d = 1e-2f, x = 0.1f + 0.8f * u, y = 0.1f + 0.8f * v;
    if (turn % 7 == 0) {
      vlMeasuredPoint a = vl_measured_invert(t, slices, x, y),
                      e = vl_measured_invert(t, slices, x, y + d);
      double sum = 0;
      for (int k = 0; k < 64; k++)
        for (int c = 0; c < 64; c++)
          sum += (double)vl_measured_at(t, slices, ((float)c + 0.5f) / 64,
                                        y + d * ((float)k + 0.5f) / 64) /
                 4096;
      assert_true(fabs((double)(e.y - a.y) - sum * (double)d) < 1e-3 * sum * (double)d + 2e-5);
    }
  }
  vl_measured_free(s->context, m);
}

/* ---- against the metal ---- */

/* Values where there is light to speak of; how far off they are, in all and at worst. */
static void values(void **state) {
  const State *s = *state;
  Batch *b = s->batch;
  for (uint32_t k = 0; k < SURFACES; k++) {
    const mfSurface *metal = surfaces(k);
    vlMeasured *m = measure(s, metal, false);
    statRng rng = stat_rng(20 + k);
    double worst = 0, off = 0, all = 0, ours = 0;
    for (int turn = 0; turn < 8; turn++) {
      put_surface(b, m, BATCH);
      put_random(b, BATCH, &rng, 0.15);
      batch_eval(s->kernels, VL_BSDF_MEASURED, BATCH, b);
      for (uint32_t i = 0; i < BATCH; i++)
        for (int c = 0; c < 4; c++) {
          /* from below: turned about a line in the surface */
          double flip = b->oz[i] < 0 ? -1 : 1;
          double o[3] = {flip * (double)b->ox[i], flip * (double)b->oy[i],
                         flip * (double)b->oz[i]};
          double w[3] = {flip * (double)b->ix[i], flip * (double)b->iy[i],
                         flip * (double)b->iz[i]};
          double f = mf_value(metal, o, w, (double)b->lambda[c][i]), g = (double)b->value[c][i];
          off += fabs(f - g);
          all += f;
          ours += g;
          if (f > 0.1)
            worst = fmax(worst, fabs(g / f - 1));
        }
    }
    print_message("surface %u: off by %.4f of the light, at worst %.3f, on the whole %.4f\n", k,
                  off / all, worst, ours / all - 1);
    assert_true(off / all < 0.012 && worst < 0.5 && fabs(ours / all - 1) < 0.0055);
    vl_measured_free(s->context, m);
  }
}

typedef struct Direction {
  const State *s;
} Direction;
static double direction_pdf(void *user, const double w[3]) {
  Batch *b = ((const Direction *)user)->s->other;
  b->ix[0] = (float)w[0];
  b->iy[0] = (float)w[1];
  b->iz[0] = (float)w[2];
  batch_eval(((const Direction *)user)->s->kernels, VL_BSDF_MEASURED, 1, b);
  return (double)b->pdf[0];
}

/* Directions as the density says, which sums up to 1 with what goes below the horizon; the
 * samples' mean is the metal's albedo. */
static void sampling(void **state) {
  const State *s = *state;
  Batch *b = s->batch;
  Direction d = {s};
  const double thetas[4] = {0.1, 0.9, 1.45, PI - 0.7};
  for (uint32_t k = 0; k < SURFACES; k++) {
    const mfSurface *metal = surfaces(k);
    vlMeasured *m = measure(s, metal, false);
    for (int t = 0; t < 4; t++) {
      statRng rng = stat_rng(40 + 4 * k + (uint32_t)t);
      statSphere hist = stat_sphere_new(24, 32);
      double sum = 0, lost = 0, known = 0, count = 0;
      put_surface(b, m, BATCH);
      put_surface(s->other, m, 1);
      batch_wo(s->other, 0, thetas[t], 0.6 + (double)k);
      for (uint32_t i = 0; i < BATCH; i++)
        batch_wo(b, i, thetas[t], 0.6 + (double)k);
      double flip = b->oz[0] < 0 ? -1 : 1;
      double o[3] = {flip * (double)b->ox[0], flip * (double)b->oy[0], flip * (double)b->oz[0]};
      for (int turn = 0; turn < 64; turn++) {
        batch_numbers(b, BATCH, &rng);
        batch_sample(s->kernels, VL_BSDF_MEASURED, BATCH, b);
        for (uint32_t i = 0; i < BATCH; i++) {
          count++;
          if (b->flags[i] & VL_SAMPLED_NONE) {
            stat_sphere_reject(hist);
            lost++;
            continue;
          }
          assert_true(b->flags[i] == 0 && b->iz[i] * b->oz[i] > 0);
          stat_sphere_add(hist, (double)b->ix[i], (double)b->iy[i], (double)b->iz[i]);
          sum += (double)b->weight[1][i];
          double w[3] = {flip * (double)b->ix[i], flip * (double)b->iy[i],
                         flip * (double)b->iz[i]};
          known += mf_value(metal, o, w, 500) / (double)b->pdf[i];
        }
      }
      statResult r = stat_sphere_test(hist, direction_pdf, &d, 4e-5);
      if (!stat_accept(r, SURFACES * 4))
        fail_msg("surface %u, theta %g: integral %g", k, thetas[t], r.integral);
      print_message("surface %u theta %.2f: pdf %.4f + %.4f lost; albedo %.4f, metal's %.4f\n",
                    k, thetas[t], r.integral, lost / count, sum / count, known / count);
      double error = 4 * sqrt(lost / count * (1 - lost / count) / count);
      assert_true(fabs(sum / known - 1) < 0.01 &&
                  fabs(r.integral + lost / count - 1) < 1e-3 + error);
    }
    vl_measured_free(s->context, m);
  }
}

/* ---- limits ---- */

static double mean_weight(const State *s, const vlMeasured *m, double theta, uint32_t channel) {
  Batch *b = s->batch;
  statRng rng = stat_rng(3);
  double sum = 0;
  put_surface(b, m, BATCH);
  for (uint32_t i = 0; i < BATCH; i++)
    batch_wo(b, i, theta, 0.3);
  for (uint32_t turn = 0; turn < 64; turn++) {
    for (uint32_t i = 0; i < BATCH; i++) {
      b->u[i] = ((float)(turn % 64) + stat_float(&rng)) / 64;
      double v = i * 0.6180339887498949;
      b->v[i] = (float)(v - floor(v)) * 0.999999f;
    }
    batch_sample(s->kernels, VL_BSDF_MEASURED, BATCH, b);
    for (uint32_t i = 0; i < BATCH; i++)
      sum += (double)b->weight[channel][i];
  }
  return sum / 64 / BATCH;
}

/* White metal gives back what single scattering leaves: never more than came, and nearly all
 * where it is smooth. */
static void furnace(void **state) {
  const State *s = *state;
  const double alphas[4] = {0.2, 0.4, 0.7, 1.0};
  for (int i = 0; i < 4; i++) {
    mfSurface white = mf_surface(alphas[i], alphas[i]);
    white.k = -1;
    white.nodes = 96;
    vlMeasured *m = measure(s, &white, false);
    for (int t = 0; t < 6; t++) {
      double theta = 0.02 + 0.29 * t, back = mean_weight(s, m, theta, 0), o[3], known = 0;
      /* the metal's own: samples of its visible normals are worth G / G1 */
      mf_direction(theta, 0.3, o);
      for (int y = 0; y < 200; y++)
        for (int x = 0; x < 200; x++) {
          vlVec3 h =
              vl_ggx_sample(vl_vec3((float)o[0], (float)o[1], (float)o[2]), (float)alphas[i],
                            (float)alphas[i], ((float)x + 0.5f) / 200, ((float)y + 0.5f) / 200);
          double oh = o[0] * (double)h.x + o[1] * (double)h.y + o[2] * (double)h.z;
          double w[3] = {2 * oh * (double)h.x - o[0], 2 * oh * (double)h.y - o[1],
                         2 * oh * (double)h.z - o[2]};
          known += mf_share(&white, o, w, oh, 500) / 40000;
        }
      print_message("alpha %.1f theta %.2f: %.4f back, metal %.4f\n", alphas[i], theta, back,
                    known);
      if (t == 0)
        assert_true(fabs((double)vl_measured_albedo(m, 0, 500) - known) < 0.004);
      assert_true(back < 1.001 && fabs(back - known) < 0.006);
    }
    vl_measured_free(s->context, m);
  }
}

/* f is the same both ways, as far as it was sampled both ways. */
static void reciprocity(void **state) {
  const State *s = *state;
  Batch *b = s->batch, *c = s->other;
  for (uint32_t k = 0; k < 3; k++) {
    vlMeasured *m = measure(s, surfaces(k), false);
    statRng rng = stat_rng(60 + k);
    double off = 0, all = 0;
    put_surface(b, m, BATCH);
    put_random(b, BATCH, &rng, 0.2);
    *c = *b;
    memcpy(c->ox, b->ix, sizeof b->ox);
    memcpy(c->oy, b->iy, sizeof b->ox);
    memcpy(c->oz, b->iz, sizeof b->ox);
    memcpy(c->ix, b->ox, sizeof b->ox);
    memcpy(c->iy, b->oy, sizeof b->ox);
    memcpy(c->iz, b->oz, sizeof b->ox);
    batch_eval(s->kernels, VL_BSDF_MEASURED, BATCH, b);
    batch_eval(s->kernels, VL_BSDF_MEASURED, BATCH, c);
    for (uint32_t i = 0; i < BATCH; i++) {
      double f = (double)(b->value[0][i] / fabsf(b->iz[i])),
             g = (double)(c->value[0][i] / fabsf(c->iz[i]));
      off += fabs(f - g);
      all += f + g;
    }
    print_message("surface %u: not reciprocal %.4f\n", k, off / all);
    assert_true(off / all < 0.012);
    vl_measured_free(s->context, m);
  }
}

/* ---- what files may say ---- */

/* The share of the values by which two measurements of one surface differ. */
static double difference(const State *s, vlMeasured *whole, vlMeasured *part) {
  Batch *b = s->batch, *c = s->other;
  statRng rng = stat_rng(80);
  double off = 0, all = 0;
  put_surface(b, whole, BATCH);
  put_random(b, BATCH, &rng, 0.2);
  *c = *b;
  put_surface(c, part, BATCH);
  batch_eval(s->kernels, VL_BSDF_MEASURED, BATCH, b);
  batch_eval(s->kernels, VL_BSDF_MEASURED, BATCH, c);
  for (uint32_t i = 0; i < BATCH; i++) {
    double f = (double)b->value[0][i], g = (double)c->value[0][i];
    off += fabs(f - g);
    all += f;
  }
  return off / all;
}

/* Spectra that hold f cos itself (no "jacobian") mean the same; so does a part of a symmetric
 * whole. */
static void forms(void **state) {
  const State *s = *state;
  mfSurface metal = mf_surface(0.6, 0.3);
  metal.samples = metal.nodes = 65; /* symmetric themselves */
  vlMeasured *whole = measure(s, &metal, false);
  assert_true(whole->scaled && !whole->halves && !whole->quarters);
  for (uint32_t form = 0; form < 3; form++) {
    mfSurface other = metal;
    other.plain = form == 0;
    other.parts = form == 0 ? 1 : form == 1 ? 2 : 4;
    vlMeasured *m = measure(s, &other, false);
    assert_true(fabsf(vl_measured_albedo(m, 0, 500) - vl_measured_albedo(whole, 0, 500)) <
                0.01f);
    assert_true(m->scaled == (form != 0) && m->halves == (form == 1) &&
                m->quarters == (form == 2));
    double off = difference(s, whole, m);
    print_message("form %u: off by %.5f\n", form, off);
    assert_true(off < (form == 0 ? 0.02 : 5e-3));
    vl_measured_free(s->context, m);
  }
  vl_measured_free(s->context, whole);
}

/* A grain that lies aslant is the same after half a turn, but no plane mirrors it. */
static void slant_halves(void **state) {
  const State *s = *state;
  mfSurface metal = mf_surface(0.6, 0.3);
  metal.samples = metal.nodes = 65;
  metal.turn = 0.5;
  vlMeasured *whole = measure(s, &metal, false);
  metal.parts = 2;
  vlMeasured *half = measure(s, &metal, false);
  assert_true(half->halves && !half->quarters);
  double off = difference(s, whole, half);
  print_message("halves of a slant grain: off by %.5f\n", off);
  assert_true(off < 5e-3);
  vl_measured_free(s->context, half);
  vl_measured_free(s->context, whole);
}

/* Between wavelengths straight lines, beyond them the last; colours are those of the
 * spectra. */
static void wavelengths(void **state) {
  const State *s = *state;
  Batch *b = s->batch, *c = s->other;
  mfSurface metal = mf_surface(0.5, 0.5);
  metal.color = 2;
  vlMeasured *m = measure(s, &metal, false), *rgb = measure(s, &metal, true);
  assert_true(rgb->lambda == NULL && rgb->lambdas == 3 && rgb->file == NULL);
  const float nm[9] = {300, 360, 418.75f, 477.5f, 500, 595, 712.5f, 830, 900};
  put_surface(b, m, 16);
  for (uint32_t i = 0; i < 16; i++) {
    batch_wo(b, i, 0.5, 0.2);
    b->ix[i] = -0.28f;
    b->iy[i] = 0;
    b->iz[i] = 0.96f;
    b->lambda[0][i] = nm[i < 9 ? i : 8];
  }
  batch_eval(s->kernels, VL_BSDF_MEASURED, 16, b);
  const float *f = b->value[0];
  assert_true(f[0] == f[1] && f[7] == f[8] && f[1] < f[3] && f[3] < f[5]);
  assert_true(fabsf(f[2] - 0.5f * (f[1] + f[3])) < 1e-5f * f[2]);
  /* sRGB by integration */
  double sum[3] = {0}, white[3] = {0};
  float matrix[9];
  const float *observer[3] = {vl_cie_x(), vl_cie_y(), vl_cie_z()},
              *light = vl_space_illuminant(VL_SPACE_SRGB);
  vl_rgb_from_xyz(VL_SPACE_SRGB, matrix);
  for (int l = 0; l < VL_LAMBDA_COUNT; l++) {
    for (uint32_t i = 0; i < 16; i++)
      b->lambda[0][i] = 360.0f + (float)l;
    batch_eval(s->kernels, VL_BSDF_MEASURED, 1, b);
    for (int k = 0; k < 3; k++)
      for (int d = 0; d < 3; d++) {
        double x = (double)matrix[3 * k + d] * (double)observer[d][l] * (double)light[l];
        sum[k] += x * (double)b->value[0][0];
        white[k] += x;
      }
  }
  *c = *b;
  put_surface(c, rgb, 16);
  batch_eval(s->kernels, VL_BSDF_MEASURED, 16, c);
  for (int k = 0; k < 3; k++)
    assert_true(vl_measured_albedo(rgb, k, 0) < 1 && vl_measured_albedo(rgb, k, 0) > 0.2f);
  assert_true(vl_measured_albedo(rgb, 0, 0) > vl_measured_albedo(rgb, 2, 0));
  for (int k = 0; k < 3; k++)
    assert_true(fabs(sum[k] / white[k] / (double)c->value[k][0] - 1) < 1e-4 &&
                c->value[3][0] == 0);
  vl_measured_free(s->context, m);
  vl_measured_free(s->context, rgb);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(maps),         cmocka_unit_test(values),      cmocka_unit_test(sampling),
      cmocka_unit_test(furnace),      cmocka_unit_test(reciprocity), cmocka_unit_test(forms),
      cmocka_unit_test(slant_halves), cmocka_unit_test(wavelengths)};
  return cmocka_run_group_tests(tests, setup, teardown);
}
