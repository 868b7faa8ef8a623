/* test/math/test_motion.c: interpolation of two poses: the ends are exact, rotations stay
 * rotations with constant speed, mirroring and stretching are interpolated, poses that no
 * rotation connects are rejected. */
#include <math.h>
#include <string.h>

#include "math/hash.h"
#include "math/motion.h"
#include "unit.h"

static double uniform(uint32_t *state) {
  *state = vl_hash2(*state, 12345u);
  return (double)*state / 4294967296.0;
}

static vlMat4 random_turn(uint32_t *state, double angle) {
  return vl_mat4_rotate(angle, uniform(state) - 0.5, uniform(state) - 0.5,
                        uniform(state) - 0.5);
}

static double farthest(const double *a, const double *b, int n) {
  double max = 0;
  for (int i = 0; i < n; i++)
    max = fmax(max, fabs(a[i] - b[i]));
  return max;
}

static void ends_are_met(void **unused) {
  (void)unused;
  uint32_t state = 7;
  for (int round = 0; round < 1000; round++) {
    vlMat4 m[2];
    double mirror = round % 2 ? -1 : 1;
    for (int k = 0; k < 2; k++) {
      double x = exp(4 * uniform(&state) - 2), y = exp(4 * uniform(&state) - 2),
             z = exp(4 * uniform(&state) - 2);
      vlMat4 stretch =
          vl_mat4_multiply(random_turn(&state, 3), vl_mat4_scale(mirror * x, y, z));
      m[k] = vl_mat4_multiply(
          vl_mat4_translate(uniform(&state), 5 * uniform(&state), -uniform(&state)),
          vl_mat4_multiply(stretch, random_turn(&state, 1)));
    }
    vlMotion motion;
    assert_true(vl_motion_make(m[0].m, m[1].m, &motion));
    for (int k = 0; k < 2; k++) {
      vlAffine a = vl_motion_between(&motion, k);
      for (int i = 0; i < 3; i++) {
        assert_true(farthest(a.m + 3 * i, m[k].m + 4 * i, 3) < 2e-14);
        assert_true(fabs(a.p[i] - m[k].m[4 * i + 3]) < 1e-14);
      }
    }
    double between[16], det;
    assert_true(vl_motion_at(m[0].m, m[1].m, uniform(&state), between));
    det = vl_determinant3(between);
    assert_true(det * mirror > 0);
  }
}

/* A rotation by any angle up to 180 degrees has constant speed about its axis, and the centre
 * moves on a straight line. */
static void turns_are_even(void **unused) {
  (void)unused;
  uint32_t state = 3;
  const double angles[] = {0, 1e-12, 1e-8, 1e-4, 0.3, 1.5, 3.1, 3.14159};
  for (int k = 0; k < 8; k++)
    for (int round = 0; round < 20; round++) {
      double axis[3] = {uniform(&state) - 0.5, uniform(&state) - 0.5, uniform(&state) - 0.5},
             f = uniform(&state);
      vlMat4 base = random_turn(&state, 2),
             turn = vl_mat4_rotate(angles[k], axis[0], axis[1], axis[2]);
      vlMat4 end = vl_mat4_multiply(vl_mat4_translate(1, 2, 3), vl_mat4_multiply(turn, base));
      vlMat4 part = vl_mat4_rotate(f * angles[k], axis[0], axis[1], axis[2]);
      vlMat4 want =
          vl_mat4_multiply(vl_mat4_translate(f, 2 * f, 3 * f), vl_mat4_multiply(part, base));
      double got[16];
      assert_true(vl_motion_at(base.m, end.m, f, got));
      assert_true(farthest(got, want.m, 16) < 1e-14);
    }
}

/* Turning the object first by the same rotation changes nothing but that (so a camera's axes
 * may be exchanged). */
static void axes_may_be_exchanged(void **unused) {
  (void)unused;
  const double flip[16] = {1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  vlMat4 a = vl_mat4_rotate(0.3, 1, 2, 3),
         b = vl_mat4_multiply(vl_mat4_translate(1, 0, 2), vl_mat4_rotate(1.7, -1, 0, 3));
  vlMat4 af = vl_mat4_multiply(a, vl_mat4_load(flip)),
         bf = vl_mat4_multiply(b, vl_mat4_load(flip));
  double plain[16], flipped[16];
  assert_true(vl_motion_at(a.m, b.m, 0.37, plain) && vl_motion_at(af.m, bf.m, 0.37, flipped));
  vlMat4 want = vl_mat4_multiply(vl_mat4_load(plain), vl_mat4_load(flip));
  assert_true(farthest(want.m, flipped, 16) < 1e-14);
}

static void impossible_is_refused(void **unused) {
  (void)unused;
  vlMat4 one = vl_mat4_identity(), flat = vl_mat4_scale(1, 1, 0),
         mirror = vl_mat4_scale(1, -1, 1), nan = one, w = one;
  nan.m[5] = NAN;
  w.m[15] = 2;
  vlMotion motion;
  assert_false(vl_motion_make(one.m, flat.m, &motion));
  assert_false(vl_motion_make(one.m, mirror.m, &motion));
  assert_false(vl_motion_make(nan.m, one.m, &motion));
  assert_false(vl_motion_make(one.m, w.m, &motion));
  assert_true(vl_motion_make(mirror.m, mirror.m, &motion));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ends_are_met),
      cmocka_unit_test(turns_are_even),
      cmocka_unit_test(axes_may_be_exchanged),
      cmocka_unit_test(impossible_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
