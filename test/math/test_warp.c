/* test/math/test_warp.c: warps: densities by chi-square, integrals of 1, inverses, small cones
 * and triangles. */
#include "math/octahedral.h"
#include "math/warp.h"
#include "statistics.h"
#include "unit.h"

enum { COUNT = 400000, TESTS = 24 };

static void assert_unit(vlVec3 w) {
  double l = sqrt((double)w.x * w.x + (double)w.y * w.y + (double)w.z * w.z);
  assert_true(fabs(l - 1) < 1e-6);
}

/* ---- inverses ---- */

static vlVec2 unwarp_disk(float x, float y) {
  int flat = vl_abs(x) > vl_abs(y);
  float along = flat ? x : y, across = flat ? y : x;
  float r = __builtin_copysignf(__builtin_sqrtf(x * x + y * y), along);
  float other = r * 1.27323954473516268615f * vl_atan(across / (along == 0.0f ? 1.0f : along));
  float a = flat ? r : other, b = flat ? other : r;
  return (vlVec2){vl_clamp(0.5f * (a + 1.0f), 0.0f, 1.0f),
                  vl_clamp(0.5f * (b + 1.0f), 0.0f, 1.0f)};
}

static vlVec2 unwarp_cosine_hemisphere(vlVec3 w) {
  return unwarp_disk(w.x, w.y);
}

static vlVec2 unwarp_cone(vlVec3 w, float one_minus_cos_max) {
  float s2 = one_minus_cos_max * vl_max(0.0f, 1.0f + w.z);
  float s = s2 > 0.0f ? 1.0f / __builtin_sqrtf(s2) : 0.0f;
  return unwarp_disk(w.x * s, w.y * s);
}

static vlVec2 unwarp_sphere(vlVec3 w) {
  float a = vl_atan2(w.y, w.x) * VL_INV_2PI;
  return (vlVec2){vl_clamp(0.5f * (1.0f - w.z), 0.0f, 1.0f), a < 0.0f ? a + 1.0f : a};
}

static vlVec2 unwarp_triangle(float b0, float b1) {
  float less = vl_min(b0, b1), sum = b0 + b1;
  int upper = b0 < b1;
  return (vlVec2){upper ? 2.0f * less : sum, upper ? sum : 2.0f * less};
}

/* ---- square to square-like domains ---- */

static double disk_density(void *user, double x, double y) {
  (void)user;
  return x * x + y * y < 1 ? 1 / 3.14159265358979 : 0;
}
static double triangle_density(void *user, double x, double y) {
  (void)user;
  return x + y < 1 ? 2 : 0;
}

static void test_flat(void **state) {
  (void)state;
  statRng rng = stat_rng(1);
  statGrid *disk = stat_grid_new(24, 24, -1, 1, -1, 1),
           *triangle = stat_grid_new(24, 24, 0, 1, 0, 1);
  for (int i = 0; i < COUNT; i++) {
    float u = stat_float(&rng), v = stat_float(&rng);
    vlDiskPoint d = vl_warp_disk(u, v);
    assert_true(fabs(d.r * d.r - (d.x * d.x + d.y * d.y)) < 1e-6);
    stat_grid_add(disk, d.x, d.y);
    vlVec2 back = unwarp_disk(d.x, d.y);
    assert_true(fabsf(back.x - u) < 1e-6f && fabsf(back.y - v) < 1e-6f);
    vlVec2 t = vl_warp_triangle(u, v);
    assert_true(t.x >= 0 && t.y >= 0 && t.x + t.y <= 1);
    stat_grid_add(triangle, t.x, t.y);
    back = unwarp_triangle(t.x, t.y);
    assert_true(fabsf(back.x - u) < 1e-6f && fabsf(back.y - v) < 1e-6f);
  }
  statResult r = stat_grid_test(disk, disk_density, NULL, 1e-6);
  assert_true(stat_accept(r, TESTS) && fabs(r.integral - 1) < 1e-3);
  r = stat_grid_test(triangle, triangle_density, NULL, 1e-6);
  assert_true(stat_accept(r, TESTS) && fabs(r.integral - 1) < 1e-3);
  vlDiskPoint centre = vl_warp_disk(0.5f, 0.5f);
  assert_true(centre.x == 0 && centre.y == 0 && centre.r == 0);
}

/* ---- directions ---- */

static double cosine_pdf(void *user, const double d[3]) {
  (void)user;
  return fmax(0.0, d[2]) * VL_INV_PI;
}
static double cone_pdf(void *user, const double d[3]) {
  float h = *(float *)user;
  return 1 - d[2] < h ? VL_INV_2PI / h : 0;
}
static double sphere_pdf(void *user, const double d[3]) {
  (void)user;
  (void)d;
  return VL_INV_4PI;
}

static void test_directions(void **state) {
  (void)state;
  statRng rng = stat_rng(2);
  enum { CONES = 5 };
  float cones[CONES] = {1, 0.5f, 0.125f, 1.5f, 2};
  statSphere cosine = stat_sphere_new(32, 32), sphere = stat_sphere_new(32, 32),
             octahedral = stat_sphere_new(32, 32);
  statSphere cone[CONES];
  for (int k = 0; k < CONES; k++)
    cone[k] = stat_sphere_new(48, 32);
  for (int i = 0; i < COUNT; i++) {
    float u = stat_float(&rng), v = stat_float(&rng);
    vlVec3 w = vl_warp_cosine_hemisphere(u, v);
    assert_unit(w);
    assert_true(w.z >= 0);
    stat_sphere_add(cosine, w.x, w.y, w.z);
    vlVec2 back = unwarp_cosine_hemisphere(w);
    assert_true(fabsf(back.x - u) < 1e-6f && fabsf(back.y - v) < 1e-6f);
    for (int k = 0; k < CONES; k++) {
      w = vl_warp_cone(u, v, cones[k]);
      assert_unit(w);
      assert_true(1 - w.z <= cones[k] + 1e-6f);
      stat_sphere_add(cone[k], w.x, w.y, w.z);
      back = unwarp_cone(w, cones[k]);
      if (w.z > -0.9f)
        assert_true(fabsf(back.x - u) < 2e-6f && fabsf(back.y - v) < 2e-6f);
    }
    w = vl_warp_sphere(u, v);
    assert_unit(w);
    stat_sphere_add(sphere, w.x, w.y, w.z);
    back = unwarp_sphere(w);
    assert_true(fabsf(back.x - u) < 1e-6f);
    if (u > 1e-4f && u < 1 - 1e-4f)
      assert_true(fabsf(back.y - v) < 1e-5f || fabsf(back.y - v) > 1 - 1e-5f);
    w = vl_octahedral_decode(u, v);
    assert_unit(w);
    stat_sphere_add(octahedral, w.x, w.y, w.z);
    back = vl_octahedral_encode(w);
    /* near the poles 1 - |z| has few bits left; on the outer edge the square meets itself */
    if (fabsf(w.z) < 0.999f)
      assert_true(fabsf(back.x - u) < 2e-5f && fabsf(back.y - v) < 2e-5f);
  }
  statResult r = stat_sphere_test(cosine, cosine_pdf, NULL, 0);
  assert_true(stat_accept(r, TESTS) && fabs(r.integral - 1) < 1e-6);
  for (int k = 0; k < CONES; k++) {
    r = stat_sphere_test(cone[k], cone_pdf, &cones[k], 1e-6);
    assert_true(stat_accept(r, TESTS) && fabs(r.integral - 1) < 1e-3);
  }
  r = stat_sphere_test(sphere, sphere_pdf, NULL, 0);
  assert_true(stat_accept(r, TESTS) && fabs(r.integral - 1) < 1e-6);
  r = stat_sphere_test(octahedral, sphere_pdf, NULL, 0);
  assert_true(stat_accept(r, TESTS));
}

/* A cone of half a microradian keeps its shape: the mean of sin^2 is half the largest. */
static void test_small_cone(void **state) {
  (void)state;
  statRng rng = stat_rng(3);
  double sin_max = 5e-7, sum = 0;
  float h = (float)(sin_max * sin_max / (1 + sqrt(1 - sin_max * sin_max)));
  for (int i = 0; i < 10000; i++) {
    vlVec3 w = vl_warp_cone(stat_float(&rng), stat_float(&rng), h);
    double s2 = (double)w.x * w.x + (double)w.y * w.y;
    assert_true(s2 <= sin_max * sin_max * 1.00001);
    sum += s2;
  }
  assert_true(fabs(sum / 10000 / (sin_max * sin_max) - 0.5) < 0.01);
}

/* The equal-area map as pbrt draws it (book, figure 3.8.3): corners and middles of the
 * square. */
static void test_octahedral_convention(void **state) {
  (void)state;
  static const struct {
    float u, v, x, y, z;
  } POINTS[] = {{0.5f, 0.5f, 0, 0, 1},
                {1, 0.5f, 1, 0, 0},
                {0, 0.5f, -1, 0, 0},
                {0.5f, 1, 0, 1, 0},
                {0.5f, 0, 0, -1, 0},
                {0, 0, 0, 0, -1},
                {1, 1, 0, 0, -1},
                {1, 0, 0, 0, -1},
                {0.75f, 0.75f, 0.7071068f, 0.7071068f, 0},
                {0.25f, 0.75f, -0.7071068f, 0.7071068f, 0}};
  for (size_t i = 0; i < sizeof POINTS / sizeof POINTS[0]; i++) {
    vlVec3 w = vl_octahedral_decode(POINTS[i].u, POINTS[i].v);
    assert_true(fabsf(w.x - POINTS[i].x) < 1e-6f && fabsf(w.y - POINTS[i].y) < 1e-6f &&
                fabsf(w.z - POINTS[i].z) < 1e-6f);
  }
}

/* ---- spherical triangles ---- */

typedef struct Triangle {
  double n[3][3]; /* inward normals of its sides */
  double pdf;
} Triangle;
static double spherical_pdf(void *user, const double d[3]) {
  const Triangle *t = user;
  for (int k = 0; k < 3; k++)
    if (t->n[k][0] * d[0] + t->n[k][1] * d[1] + t->n[k][2] * d[2] < 0)
      return 0;
  return t->pdf;
}
static vlVec3 unit(double x, double y, double z) {
  double l = 1 / sqrt(x * x + y * y + z * z);
  return vl_vec3((float)(x * l), (float)(y * l), (float)(z * l));
}
static void side_normal(vlVec3 a, vlVec3 b, vlVec3 inside, double n[3]) {
  n[0] = (double)a.y * b.z - (double)a.z * b.y;
  n[1] = (double)a.z * b.x - (double)a.x * b.z;
  n[2] = (double)a.x * b.y - (double)a.y * b.x;
  double side = n[0] * inside.x + n[1] * inside.y + n[2] * inside.z;
  for (int k = 0; k < 3; k++)
    n[k] *= side < 0 ? -1 : 1;
}

static void test_spherical_triangle(void **state) {
  (void)state;
  const vlVec3 corners[][3] = {
      {unit(1, 0, 0), unit(0, 1, 0), unit(0, 0, 1)},                     /* an octant */
      {unit(1, 0.2, -0.9), unit(-0.8, 1, 0.1), unit(-0.5, -1, 0.4)},     /* large */
      {unit(1, 0.1, 0.3), unit(1, 0.5, 0.2), unit(1, 0.2, 0.9)},         /* middling */
      {unit(0.1, 1, 0.3), unit(0.1, 1, 0.2), unit(-0.9, 0.2, 0.25)},     /* thin */
      {unit(-1, 0.1, 0.3), unit(-0.9, 0.2, 0.35), unit(-1, 0.15, 0.24)}, /* small */
  };
  statRng rng = stat_rng(4);
  for (size_t k = 0; k < sizeof corners / sizeof corners[0]; k++)
    for (int turn = 0; turn < 3; turn++) {
      vlVec3 a = corners[k][turn], b = corners[k][(turn + 1) % 3],
             c = corners[k][(turn + 2) % 3];
      vlSphericalTriangle s = vl_spherical_triangle(a, b, c);
      if (k == 0)
        assert_true(fabs(s.solid_angle - 1.5707963) < 1e-6);
      Triangle t = {.pdf = 1.0 / s.solid_angle};
      side_normal(a, b, c, t.n[0]);
      side_normal(b, c, a, t.n[1]);
      side_normal(c, a, b, t.n[2]);
      /* Histogram over the bounding box of angles that the samples fill, so that cells are
       * small beside the triangle */
      static double phi[COUNT / 4], theta[COUNT / 4];
      double box[4] = {10, -10, 10, -10};
      for (int i = 0; i < COUNT / 4; i++) {
        vlVec3 w = vl_warp_spherical_triangle(s, stat_float(&rng), stat_float(&rng));
        assert_unit(w);
        for (int e = 0; e < 3; e++)
          assert_true(t.n[e][0] * w.x + t.n[e][1] * w.y + t.n[e][2] * w.z > -1e-6);
        phi[i] = atan2(w.y, w.x);
        theta[i] = acos(w.z);
        if (k == 4 && phi[i] < 0)
          phi[i] += 6.283185307179586;
        box[0] = fmin(box[0], phi[i]);
        box[1] = fmax(box[1], phi[i]);
        box[2] = fmin(box[2], theta[i]);
        box[3] = fmax(box[3], theta[i]);
      }
      double rim_x = 0.01 * (box[1] - box[0]), rim_y = 0.01 * (box[3] - box[2]);
      box[0] -= rim_x;
      box[1] += rim_x;
      if (box[1] - box[0] > 6.2) {
        box[0] = -3.14159265358979;
        box[1] = 3.14159265358979;
      } /* all around */
      statGrid *grid = stat_grid_new(20, 20, box[0], box[1], fmax(0, box[2] - rim_y),
                                     fmin(3.14159265358979, box[3] + rim_y));
      for (int i = 0; i < COUNT / 4; i++)
        stat_grid_add(grid, phi[i], theta[i]);
      statSphereUser user = {spherical_pdf, &t};
      statResult r = stat_grid_test(grid, stat_sphere_density, &user, 3e-6);
      if (!stat_accept(r, TESTS))
        fail_msg("triangle %zu from corner %d", k, turn);
      assert_true(fabs(r.integral - 1) < 2e-3);
    }
  /* u = 0, v = 0 and the rest of the border */
  vlSphericalTriangle s = vl_spherical_triangle(corners[2][0], corners[2][1], corners[2][2]);
  for (int i = 0; i < 4; i++) {
    vlVec3 w = vl_warp_spherical_triangle(s, i & 1 ? VL_ONE_MINUS_EPSILON : 0,
                                          i & 2 ? VL_ONE_MINUS_EPSILON : 0);
    assert_unit(w);
  }
  vlSphericalTriangle flat = vl_spherical_triangle(corners[0][0], corners[0][0], corners[0][1]);
  assert_true(flat.solid_angle == 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_flat),
      cmocka_unit_test(test_directions),
      cmocka_unit_test(test_small_cone),
      cmocka_unit_test(test_octahedral_convention),
      cmocka_unit_test(test_spherical_triangle),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
