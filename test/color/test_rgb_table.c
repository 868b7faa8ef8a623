/* test/color/test_rgb_table.c: RGB to spectrum: round trips in every space, exact greys and
 * ends, spectra within [0, 1], no discontinuities. */
#include <math.h>

#include "color/rgb_table.h"
#include "unit.h"

static uint32_t seed;
static float uniform(void) {
  seed = seed * 747796405u + 2891336453u;
  uint32_t word = ((seed >> ((seed >> 28) + 4)) ^ seed) * 277803737u;
  return (float)((word >> 22 ^ word) >> 8) * 0x1p-24f;
}

/* Colour of the spectrum under the space's illuminant. */
static double weight[3][VL_LAMBDA_COUNT];
static void prepare(vlColorSpace space) {
  float m[9];
  vl_rgb_from_xyz(space, m);
  const float *light = vl_space_illuminant(space),
              *cmf[3] = {vl_cie_x(), vl_cie_y(), vl_cie_z()};
  double unit = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    unit += (double)vl_cie_y()[i];
  for (int c = 0; c < 3; c++)
    for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
      weight[c][i] = 0;
      for (int k = 0; k < 3; k++)
        weight[c][i] += (double)m[3 * c + k] * (double)cmf[k][i] * (double)light[i] / unit;
    }
}
static double round_trip(vlSigmoid s, const float rgb[3]) {
  double back[3] = {0}, worst = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++) {
    float v = vl_sigmoid(s, (float)(360 + i));
    if (!(v >= 0 && v <= 1))
      fail_msg("%g at %d nm of %g %g %g", (double)v, 360 + i, (double)rgb[0], (double)rgb[1],
               (double)rgb[2]);
    for (int c = 0; c < 3; c++)
      back[c] += weight[c][i] * (double)v;
  }
  for (int c = 0; c < 3; c++)
    worst = fmax(worst, fabs(back[c] - (double)rgb[c]));
  return worst;
}

static vlSigmoid table_of(vlColorSpace space, const float rgb[3]) {
  return vl_rgb_table_lookup(vl_rgb_table(space), rgb[0], rgb[1], rgb[2]);
}

/* Kinds of colours: anywhere, on the faces and edges, near the corners, dark, light. */
static void draw(int kind, float rgb[3]) {
  for (int c = 0; c < 3; c++) {
    float u = uniform(), v = uniform();
    switch (kind) {
      case 0:
        rgb[c] = u;
        break;
      case 1:
        rgb[c] = v < 0.33f ? 0 : v < 0.66f ? 1 : u;
        break;
      case 2:
        rgb[c] = v < 0.5f ? 0.02f * u * u : 1 - 0.02f * u * u;
        break;
      case 3:
        rgb[c] = 0.05f * u * u * u;
        break;
      default:
        rgb[c] = 1 - 0.05f * u * u * u;
        break;
    }
  }
}

static void test_srgb(void **state) {
  (void)state;
  seed = 1;
  prepare(VL_SPACE_SRGB);
  double mean = 0;
  for (int kind = 0; kind < 5; kind++)
    for (int i = 0; i < 1500; i++) {
      float rgb[3];
      draw(kind, rgb);
      double e = round_trip(table_of(VL_SPACE_SRGB, rgb), rgb);
      if (e > 1e-3)
        fail_msg("%g %g %g comes back with an error of %g", (double)rgb[0], (double)rgb[1],
                 (double)rgb[2], e);
      if (kind == 0)
        mean += e / 1500;
    }
  assert_true(mean < 3e-4);
}

/* Colours of real surfaces, that is of sRGB, said in the wider spaces; and any colour at all,
 * to which the nearest possible spectrum is given. */
static void test_wide(void **state) {
  (void)state;
  static const double bound[4] = {1e-3, 0.065, 0.2, 0.4};
  for (int space = VL_SPACE_DCI_P3; space <= VL_SPACE_ACES2065_1; space++) {
    seed = 2;
    prepare((vlColorSpace)space);
    for (int i = 0; i < 1000; i++) {
      float rgb[3], any[3];
      draw(i % 5, any);
      if (round_trip(table_of((vlColorSpace)space, any), any) > bound[space])
        fail_msg("space %d: %g %g %g is far off", space, (double)any[0], (double)any[1],
                 (double)any[2]);
      draw(0, any);
      vlSpectrum s =
          vl_spectrum_rgb(0.05f + 0.9f * any[0], 0.05f + 0.9f * any[1], 0.05f + 0.9f * any[2]);
      assert_int_equal(vl_spectrum_to_rgb(&s, VL_ROLE_ALBEDO, (vlColorSpace)space, rgb, NULL),
                       VL_OK);
      double e = round_trip(table_of((vlColorSpace)space, rgb), rgb);
      if (e > 2.5e-3)
        fail_msg("space %d: %g %g %g comes back with an error of %g", space, (double)rgb[0],
                 (double)rgb[1], (double)rgb[2], e);
    }
  }
}

/* What is asked for once is polished: exact for every colour of sRGB, never worse than the
 * table anywhere. */
static void test_refined(void **state) {
  (void)state;
  for (int space = VL_SPACE_SRGB; space <= VL_SPACE_ACES2065_1; space++) {
    seed = 4;
    prepare((vlColorSpace)space);
    for (int i = 0; i < 1500; i++) {
      float rgb[3];
      draw(i % 5, rgb);
      double refined =
          round_trip(vl_sigmoid_from_rgb((vlColorSpace)space, rgb[0], rgb[1], rgb[2]), rgb);
      double table = round_trip(table_of((vlColorSpace)space, rgb), rgb);
      if (refined > table + 1e-6 || (space == VL_SPACE_SRGB && refined > 2e-6))
        fail_msg("space %d: %g %g %g has an error of %g, by the table %g", space,
                 (double)rgb[0], (double)rgb[1], (double)rgb[2], refined, table);
    }
  }
}

static void test_greys(void **state) {
  (void)state;
  for (int space = VL_SPACE_SRGB; space <= VL_SPACE_ACES2065_1; space++) {
    for (int i = 0; i <= 1000; i++) {
      float g = (float)i / 1000.0f;
      vlSigmoid s = vl_sigmoid_from_rgb((vlColorSpace)space, g, g, g);
      assert_true(s.c0 == 0 && s.c1 == 0);
      float v = vl_sigmoid(s, 500);
      assert_float_equal(v, g, 3e-7);
      if (i == 0 || i == 1000)
        assert_true(v == g);
    }
  }
  /* out of range and not a number: clamped */
  vlSigmoid s = vl_sigmoid_from_rgb(VL_SPACE_SRGB, -3, 7, NAN),
            t = vl_sigmoid_from_rgb(VL_SPACE_SRGB, 0, 1, 0);
  assert_true(s.c0 == t.c0 && s.c1 == t.c1 && s.c2 == t.c2);
  float tiny[3] = {1e-40f, 1e-30f, 1e-20f};
  for (int i = 0; i < 27; i++) {
    s = vl_sigmoid_from_rgb(VL_SPACE_SRGB, tiny[i % 3], tiny[i / 3 % 3], tiny[i / 9]);
    /* where the eye is all but blind, dark purples may shine */
    for (int l = 420; l <= 700; l += 10)
      assert_true(vl_sigmoid(s, (float)l) >= 0 && vl_sigmoid(s, (float)l) < 1e-6f);
  }
}

static void color_of(vlSigmoid s, double rgb[3]) {
  rgb[0] = rgb[1] = rgb[2] = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    for (int c = 0; c < 3; c++)
      rgb[c] += weight[c][i] * (double)vl_sigmoid(s, (float)(360 + i));
}

/* A small step in RGB is a small step in what the spectrum shows, across all borders of cells,
 * faces and halves; for sRGB the spectrum itself steps little, too. */
static void test_continuous(void **state) {
  (void)state;
  for (int space = VL_SPACE_SRGB; space <= VL_SPACE_ACES2065_1; space++) {
    seed = 3;
    prepare((vlColorSpace)space);
    for (int walk = 0; walk < 24; walk++) {
      float a[3], b[3];
      draw(walk % 2, a);
      draw(0, b);
      double last[3] = {0}, now[3];
      float last_values[26] = {0};
      enum { STEPS = 1000 };
      for (int i = 0; i <= STEPS; i++) {
        float t = (float)i / STEPS;
        float rgb[3] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]),
                        a[2] + t * (b[2] - a[2])};
        vlSigmoid s = table_of((vlColorSpace)space, rgb);
        color_of(s, now);
        for (int c = 0; c < 3; c++) {
          if (i > 0 && fabs(now[c] - last[c]) > (space == VL_SPACE_SRGB         ? 0.005
                                                 : space == VL_SPACE_ACES2065_1 ? 0.06
                                                                                : 0.02))
            fail_msg("space %d: a jump of %g, t %g from %g %g %g to %g %g %g", space,
                     now[c] - last[c], (double)t, (double)a[0], (double)a[1], (double)a[2],
                     (double)b[0], (double)b[1], (double)b[2]);
          last[c] = now[c];
        }
        for (int l = 0; l < 26; l++) {
          float v = vl_sigmoid(s, 420.0f + 10.0f * (float)l);
          if (i > 0 && space == VL_SPACE_SRGB && fabsf(v - last_values[l]) > 0.06f)
            fail_msg("a jump of %g at %d nm", (double)(v - last_values[l]), 420 + 10 * l);
          last_values[l] = v;
        }
      }
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_srgb),       cmocka_unit_test(test_wide),
      cmocka_unit_test(test_refined),    cmocka_unit_test(test_greys),
      cmocka_unit_test(test_continuous),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
