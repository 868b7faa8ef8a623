/* test_texture_noise.c: noise against a plain implementation in double, and its properties;
 * dots by their geometry and places, marble by its colours, sums by their octaves, clouds by
 * pbrt's definition. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
/* cmocka.h needs the headers above */

#include "medium/lookup.h"
#include "plain_noise.h"
#include "texture/kinds.h"
#include "unit.h"

vlMediumDensity vl_medium_density_cloud;

static uint32_t seed = 3;
static double random_unit(void) {
  seed = seed * 1664525u + 1013904223u;
  return (seed >> 8) * 0x1p-24;
}

static void noise(void **state) {
  (void)state;
  double largest = 0, mean = 0;
  for (int i = 0; i < 20000; i++) {
    float p[3];
    for (int k = 0; k < 3; k++)
      p[k] = (float)(40 * random_unit() - 20);
    float n = vl_noise(p[0], p[1], p[2]);
    if (!(fabs(n - plain_noise(p[0], p[1], p[2])) < 1e-5))
      fail_msg("at %g %g %g: %g", p[0], p[1], p[2], n);
    largest = fmax(largest, fabs(n));
    mean += n / 20000.0;
  }
  assert_true(largest > 0.6 && largest <= 1);
  assert_true(fabs(mean) < 0.01);
  for (int i = -300; i < 300; i += 7) {
    assert_true(vl_noise((float)i, (float)(3 * i), (float)(i / 2)) == 0);
    float x = 0.25f * (float)i + 0.125f; /* repeats, and goes on over the edge of a cell */
    assert_true(vl_noise(x, 0.5f, 2.25f) == vl_noise(x + 256, 0.5f, 2.25f - 256));
    assert_true(fabsf(vl_noise((float)i - 1e-5f, 0.4f, 0.3f) -
                      vl_noise((float)i + 1e-5f, 0.4f, 0.3f)) < 1e-3f);
  }
  assert_true(vl_noise(NAN, 1, 2) == 0 && vl_noise(INFINITY, 0.5f, 0.5f) == 0 &&
              vl_noise(1e30f, 0.5f, 0.5f) == 0);
}

static void sums(void **state) {
  (void)state;
  for (int i = 0; i < 200; i++) {
    vlVec3 p = vl_vec3((float)(9 * random_unit()), (float)(9 * random_unit()),
                       (float)(9 * random_unit()));
    double want = 0, absolute = 0, size = 1, strength = 1;
    for (int k = 0; k < 4; k++) {
      double n = plain_noise(size * p.x, size * p.y, size * p.z);
      want += strength * n;
      absolute += strength * fabs(n);
      size *= 1.99;
      strength *= 0.6;
    }
    assert_true(fabs(vl_fractal_noise(p, 0, 0.6f, 4) - want) < 1e-4);
    /* of turbulence the next octave counts with its mean */
    assert_true(fabs(vl_turbulence(p, 0, 0.6f, 4) - absolute - 0.2 * strength) < 1e-4);
    /* a footprint of many periods sees none */
    assert_true(vl_fractal_noise(p, 100, 0.6f, 4) == 0);
    /* ever fewer octaves, without a jump */
    float last = vl_fractal_noise(p, 0.01f, 0.6f, 8);
    for (float w = 0.01f; w < 1; w *= 1.01f) {
      float now = vl_fractal_noise(p, w, 0.6f, 8);
      assert_true(fabsf(now - last) < 0.06f);
      last = now;
    }
  }
}

static vlTextureNode node_of(vlTextureKind kind, const vlTextureDef *def) {
  vlTextureNode node;
  memset(&node, 0, sizeof node);
  node.kind = kind;
  node.su = node.sv = node.scale = 1;
  node.def = def;
  for (int i = 0; i < 3; i++)
    node.texture_from_world[5 * i] = 1;
  return node;
}

/* Where the dot of the cell about (s, t) is; false: it has none. */
static bool plain_dot(double s, double t, double middle[2]) {
  middle[0] = s + 0.15 * plain_noise(s + 1.5, t + 2.8, 0.5);
  middle[1] = t + 0.15 * plain_noise(s + 4.5, t + 9.8, 0.5);
  return plain_noise(s + 0.5, t + 0.5, 0.5) > 0;
}

static void dots(void **state) {
  (void)state;
  vlTextureNode node = node_of(VL_TEXTURE_DOTS, NULL);
  int with = 0;
  enum { N = 50 };
  for (int cell = 0; cell < 400; cell++) {
    double x = 0, y = 0, u0 = cell % 20 - 10, v0 = cell / 20 - 10;
    int count = 0;
    for (int pass = 0; pass < 2; pass++)
      for (int i = 0; i < N * N; i++) {
        double u = u0 + (i % N + 0.5) / N - 0.5, v = v0 + (i / N + 0.5) / N - 0.5;
        vlTexturePoint at = {
            .u = (float)u, .v = (float)v, .n = vl_vec3(0, 0, 1), .color = {1, 1, 1, 1}};
        bool in = vl_node_dots(&node, at) > 0;
        if (pass == 0) {
          count += in;
          x += in ? u : 0;
          y += in ? v : 0;
        } else if (fabs(hypot(u - x, v - y) - 0.35) >
                   0.012) { /* one disk, about the middle of what is in */
          assert_true(in == (count && hypot(u - x, v - y) < 0.35));
        }
        if (pass == 0 && i == N * N - 1 && count) {
          x /= count;
          y /= count;
        }
      }
    with += count > 0;
    if (count)
      assert_true(fabs(count / (double)(N * N) - 3.14159265 * 0.35 * 0.35) < 0.02);
    double middle[2];
    assert_true(plain_dot(u0, v0, middle) == (count > 0));
    if (count)
      assert_true(fabs(x - middle[0]) < 2e-3 && fabs(y - middle[1]) < 2e-3);
  }
  assert_true(with > 120 && with < 280);
}

static void marble(void **state) {
  (void)state;
  vlTextureDef def = {.kind = VL_TEXTURE_MARBLE, .omega = 0.5f, .octaves = 8};
  vlTextureNode node = node_of(def.kind, &def);
  for (int k = 0; k < 2; k++) { /* a vein's both ends, where the sine is -1 and 1 */
    vlTexturePoint at = {.p = vl_vec3(7, (float)(3.14159265 * (k - 0.5)), 5),
                         .n = vl_vec3(0, 0, 1),
                         .color = {1, 1, 1, 1}};
    vlVec3 c = vl_node_marble(&node, at);
    double want[2] = {1.5 * 0.58, 1.5 * 0.6};
    assert_true(fabs(c.x - want[0]) < 2e-3 && fabs(c.y - want[0]) < 2e-3 &&
                fabs(c.z - want[1]) < 2e-3);
  }
  def.variation = 0.2f;
  double low = 2, high = 0;
  for (int i = 0; i < 5000; i++) {
    vlTexturePoint at = {
        .p = vl_vec3((float)(20 * random_unit()), (float)(20 * random_unit()), 1),
        .n = vl_vec3(0, 0, 1),
        .color = {1, 1, 1, 1}};
    vlVec3 c = vl_node_marble(&node, at);
    low = fmin(low, c.x);
    high = fmax(high, c.x);
    assert_true(c.z >= c.x - 0.05f); /* never warmer than the warmest of the nine */
  }
  assert_true(low > 1.5 * 0.2 && low < 0.75 && high < 1.5 * 0.6 && high > 0.85);
}

/* pbrt-v4's cloud (CloudMedium::Density): two octaves of wisps move the point along the noise's
 * slope, five octaves of noise are thinner with height, and below y = 0.5 a floor is added. */
static double plain_cloud(const double p[3], double density, double wispiness,
                          double frequency) {
  double q[3];
  for (int k = 0; k < 3; k++)
    q[k] = frequency * p[k];
  for (int i = 0; i < 2 && wispiness > 0; i++) {
    const double size = 10 * pow(1.99, i);
    const double at[3] = {size * q[0], size * q[1], size * q[2]};
    const double here = plain_noise(at[0], at[1], at[2]);
    for (int k = 0; k < 3; k++) {
      const double there = plain_noise(at[0] + (k == 0 ? 0.01 : 0), at[1] + (k == 1 ? 0.01 : 0),
                                       at[2] + (k == 2 ? 0.01 : 0));
      q[k] += 0.05 * wispiness * pow(0.5, i) * (there - here) / 0.01;
    }
  }
  double sum = 0;
  for (int i = 0; i < 5; i++) {
    const double size = pow(1.99, i);
    sum += pow(0.5, i + 1) * plain_noise(size * q[0], size * q[1], size * q[2]);
  }
  const double thin = fmin(fmax((1 - p[1]) * 4.5 * density * sum, 0), 1);
  return fmin(thin + 2 * fmax(0, 0.5 - p[1]), 1);
}

static void clouds(void **state) {
  (void)state;
  int between = 0;
  for (int i = 0; i < 20000; i++) {
    const double density = 0.1 + random_unit();
    const double wispiness = i % 4 ? 2 * random_unit() : 0;
    const double frequency = 1 + 7 * random_unit();
    vlWorldMedium medium = {.own = {(float)density, (float)wispiness, (float)frequency}};
    const double p[3] = {2 * random_unit() - 1, 1.4 * random_unit() - 0.2,
                         2 * random_unit() - 1};
    const vlVec3 at = vl_vec3((float)p[0], (float)p[1], (float)p[2]);
    const double want = plain_cloud(p, density, wispiness, frequency);
    const double is = (double)vl_medium_density_cloud(&medium, at, at);
    if (!(fabs(is - want) < 5e-3))
      fail_msg("at %g %g %g: %g, not %g", p[0], p[1], p[2], is, want);
    between += want > 0.01 && want < 0.99;
  }
  assert_true(between > 8000);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(noise), cmocka_unit_test(sums),
                                     cmocka_unit_test(dots), cmocka_unit_test(marble),
                                     cmocka_unit_test(clouds)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
