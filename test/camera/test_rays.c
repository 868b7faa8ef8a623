/* test/camera/test_rays.c: the batch kernels: the lecture's formula to the last bit, agreement
 * with the public functions in double, the same bits on every instruction set, lens, near and
 * far planes. */
#include "camera/cameras.h"

#include "camera/lens.h"
#include "camera/rays.h"

enum { N = 1024 };

typedef struct {
  float film_x[N], film_y[N], lens_u[N], lens_v[N], time[N];
  int32_t pixel_x[N], pixel_y[N];
} Samples;
typedef struct {
  float ox[N], oy[N], oz[N], dx[N], dy[N], dz[N], t_min[N], t_max[N], time[N], valid[N];
} Rays;

static Samples samples;
static Rays rays;

static void run(vlIsa isa, const vlCamera *camera, uint32_t n, Rays *out) {
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  vlCameraSamples s = {samples.film_x, samples.film_y, samples.pixel_x, samples.pixel_y,
                       samples.lens_u, samples.lens_v, samples.time};
  vlCameraRays r = {out->ox,    out->oy,    out->oz,   out->dx,    out->dy, out->dz,
                    out->t_min, out->t_max, out->time, out->valid, NULL};
  vl_camera_kernels(isa)->rays(&c, n, &s, &r);
}

static void random_samples(const vlCamera *camera, uint64_t seed) {
  for (int i = 0; i < N; i++) {
    samples.pixel_x[i] = (int32_t)(next_unit(&seed) * camera->width);
    samples.pixel_y[i] = (int32_t)(next_unit(&seed) * camera->height);
    samples.film_x[i] = (float)next_between(&seed, -2, 3);
    samples.film_y[i] = (float)next_between(&seed, -2, 3);
    samples.lens_u[i] = (float)next_unit(&seed) * 0.99999994f;
    samples.lens_v[i] = (float)next_unit(&seed) * 0.99999994f;
    samples.time[i] = (float)next_unit(&seed) * 0.99999994f;
  }
}

static vlIsa isas(int index) {
  const vlIsa all[] = {VL_ISA_BASE, VL_ISA_V3, VL_ISA_V4};
  return index < 3 && all[index] <= vl_isa_best() ? all[index] : VL_ISA_AUTO;
}

static void same_float(float a, float b) {
  uint32_t x, y;
  memcpy(&x, &a, 4);
  memcpy(&y, &b, 4);
  if (x != y)
    fail_msg("%.9g (%08x) is not %.9g (%08x)", a, x, b, y);
}

/* The formula of the slide is d = (s(c - h_res/2 + p_x), s(r - v_res/2 + p_y), -d), normalised,
 * o = (0, 0, e). It is evaluated in double and rounded to float. The kernel must give the same
 * bits, except that -0 may be 0. Tested are each pixel of three images (even, odd, large), at
 * its centre and at other points. */
static void slides_formula_to_the_last_bit(void **state) {
  (void)state;
  const struct {
    uint32_t width, height;
    double e, d, s;
  } views[] = {{400, 400, 500, 500, 1},
               {401, 301, 200, 120.5, 1},
               {640, 360, 15, 875, 0.5},
               {2048, 300, 100, 33, 0.25}};
  const float points[][2] = {{0.5f, 0.5f}, {0.125f, 0.71f}, {0, 0}};
  for (size_t k = 0; k < sizeof views / sizeof views[0]; k++) {
    uint32_t hres = views[k].width, vres = views[k].height;
    double s = views[k].s, d = views[k].d;
    vlCameraDef def = vl_default_camera_def(hres, vres);
    set3(def.eye, 0, 0, views[k].e);
    set3(def.lookat, 0, 0, views[k].e - 1);
    def.view_distance = d;
    def.pixel_size = s;
    vlCamera camera = make_or_fail(&def);
    for (int m = 0; m < 3; m++)
      for (int set = 0; isas(set) != VL_ISA_AUTO; set++)
        for (uint32_t first = 0; first < hres * vres; first += N) {
          uint32_t n = hres * vres - first < N ? hres * vres - first : N;
          for (uint32_t i = 0; i < n; i++) {
            samples.pixel_x[i] = (int32_t)((first + i) % hres);
            samples.pixel_y[i] = (int32_t)((first + i) / hres);
            samples.film_x[i] = points[m][0];
            /* rows of the slides count upwards: p_y is measured from the pixel's bottom */
            samples.film_y[i] = 1 - points[m][1];
          }
          run(isas(set), &camera, n, &rays);
          for (uint32_t i = 0; i < n; i++) {
            double c = samples.pixel_x[i], r = vres - 1.0 - samples.pixel_y[i];
            double py = 1 - (double)samples.film_y[i];
            double x = s * (c - hres / 2.0 + (double)points[m][0]),
                   y = s * (r - vres / 2.0 + py), z = -d;
            double length = sqrt(x * x + y * y + z * z);
            same_float(rays.dx[i], (float)(x / length));
            same_float(rays.dy[i], (float)(y / length));
            same_float(rays.dz[i], (float)(z / length));
            same_float(rays.ox[i], 0);
            same_float(rays.oy[i], 0);
            same_float(rays.oz[i], (float)views[k].e);
            same_float(rays.t_min[i], 0);
            assert_true(isinf(rays.t_max[i]));
          }
        }
  }
}

/* The batch is the public function, rounded to float. */
static void kernels_are_unproject_rounded(void **state) {
  (void)state;
  for (int k = 0; k < CAMERA_COUNT; k++) {
    vlCamera camera = camera_of(k);
    random_samples(&camera, 3 + (uint64_t)k);
    run(VL_ISA_BASE, &camera, N, &rays);
    for (int i = 0; i < N; i++) {
      double o[3], d[3];
      double x = samples.pixel_x[i] + (double)samples.film_x[i],
             y = samples.pixel_y[i] + (double)samples.film_y[i];
      assert_true(vl_camera_unproject(&camera, x, y, o, d));
      /* off by one last bit at most, where the sum pixel - cx + film is rounded in another
       * order */
      assert_true(fabs(rays.dx[i] - d[0]) <= 3.1e-8 && fabs(rays.dy[i] - d[1]) <= 3.1e-8);
      assert_true(fabs(rays.dz[i] - d[2]) <= 3.1e-8);
      for (int a = 0; a < 3; a++) {
        float got = a == 0 ? rays.ox[i] : a == 1 ? rays.oy[i] : rays.oz[i];
        assert_true(fabs(got - o[a]) <= 6e-8 * fabs(o[a]) + 1e-12);
      }
      assert_true(rays.time[i] >= 0 && rays.time[i] < 1 && rays.time[i] == samples.time[i]);
    }
  }
}

static void same_bits_on_all_instruction_sets(void **state) {
  (void)state;
  static Rays other;
  int sets = 0;
  while (isas(sets) != VL_ISA_AUTO)
    sets++;
  for (int k = 0; k < 2 * CAMERA_COUNT; k++) {
    vlCamera camera = camera_of(k / 2);
    if (k & 1) {
      camera.lens_radius = 0.3;
      camera.focus_distance = k == 1 ? INFINITY : 7.5;
    }
    camera.near_plane = 0.5;
    camera.far_plane = 100;
    random_samples(&camera, 99);
    run(VL_ISA_BASE, &camera, N, &rays);
    for (int set = 1; set < sets; set++) {
      run(isas(set), &camera, N, &other);
      assert_memory_equal(&rays, &other, sizeof rays);
    }
    /* nor do a ray's bits depend on its place in the batch or on the batch's length */
    const Rays whole = rays;
    for (int i = 0; i < N - 37; i++) {
      samples.pixel_x[i] = samples.pixel_x[i + 37];
      samples.pixel_y[i] = samples.pixel_y[i + 37];
      samples.film_x[i] = samples.film_x[i + 37];
      samples.film_y[i] = samples.film_y[i + 37];
      samples.lens_u[i] = samples.lens_u[i + 37];
      samples.lens_v[i] = samples.lens_v[i + 37];
      samples.time[i] = samples.time[i + 37];
    }
    for (int set = 0; set < sets; set++) {
      run(isas(set), &camera, N - 37, &other);
      for (int i = 0; i < N - 37; i++) {
        same_float(other.dx[i], whole.dx[i + 37]);
        same_float(other.ox[i], whole.ox[i + 37]);
        same_float(other.t_max[i], whole.t_max[i + 37]);
      }
    }
  }
  if (sets < 3)
    print_message("this machine lacks an instruction set; %d of 3 compared\n", sets);
}

/* All rays of one film point meet in the plane of focus, at the point that the pinhole sees
 * there; and they start all over the lens, evenly. */
static void thin_lens_focuses(void **state) {
  (void)state;
  for (int projection = 0; projection < 2; projection++)
    for (int infinite = 0; infinite < 2; infinite++) {
      vlCameraDef def = vl_default_camera_def(400, 300);
      def.projection = projection ? VL_PROJECTION_ORTHOGRAPHIC : VL_PROJECTION_PERSPECTIVE;
      set3(def.eye, 1, 2, 3);
      set3(def.lookat, 4, -2, -9);
      def.lens_radius = 0.25;
      def.focus_distance = infinite ? VL_UNSET : 6;
      vlCamera camera = make_or_fail(&def);
      random_samples(&camera, 5);
      for (int i = 0; i < N; i++) {
        samples.pixel_x[i] = 310;
        samples.pixel_y[i] = 40;
        samples.film_x[i] = 0.25f;
        samples.film_y[i] = 0.75f;
      }
      run(VL_ISA_BASE, &camera, N, &rays);
      double o[3], d[3], half = 0;
      assert_true(vl_camera_unproject(&camera, 310.25, 40.75, o, d));
      const double *m = camera.world_from_camera;
      double depth = d[0] * m[2] + d[1] * m[6] + d[2] * m[10];
      for (int i = 0; i < N; i++) {
        double ro[3] = {rays.ox[i], rays.oy[i], rays.oz[i]},
               rd[3] = {rays.dx[i], rays.dy[i], rays.dz[i]};
        double offset = 0, along = rd[0] * m[2] + rd[1] * m[6] + rd[2] * m[10];
        for (int a = 0; a < 3; a++) {
          if (infinite)
            assert_true(fabs(rd[a] - d[a]) < 4e-8); /* parallel */
          else
            assert_true(fabs((ro[a] + 6 / along * rd[a]) - (o[a] + 6 / depth * d[a])) < 3e-6);
          offset += (ro[a] - o[a]) * (ro[a] - o[a]);
        }
        assert_true(sqrt(offset) <= 0.25 * (1 + 1e-5));
        half += sqrt(offset) < 0.25 * sqrt(0.5); /* half of the lens's area */
      }
      assert_true(fabs(half / N - 0.5) < 4 * 0.5 / sqrt(N)); /* 4 sigma */
    }
}

static void disk_map_is_exact_enough(void **state) {
  (void)state;
  for (int i = 0; i <= 256; i++)
    for (int j = 0; j <= 256; j++) {
      float u = i / 256.0f, v = j / 256.0f;
      vlLensPoint p = vl_lens_disk(u, v);
      double a = 2.0 * u - 1, b = 2.0 * v - 1, r, phi;
      if (a == 0 && b == 0) {
        r = phi = 0;
      } else if (fabs(a) > fabs(b)) {
        r = a;
        phi = 0.78539816339744831 * (b / a);
      } else {
        r = b;
        phi = 1.5707963267948966 - 0.78539816339744831 * (a / b);
      }
      assert_true(fabs(p.x - r * cos(phi)) < 5e-7 && fabs(p.y - r * sin(phi)) < 5e-7);
    }
}

/* t_min and t_max lie on the planes z = near and z = far for every angle, scale of the matrix
 * and projection. */
static void near_and_far_planes(void **state) {
  (void)state;
  for (int k = 0; k < 2 * CAMERA_COUNT; k++) {
    vlCamera camera = camera_of(k / 2);
    camera.near_plane = 2;
    camera.far_plane = 50;
    camera.lens_radius = k & 1 ? 0.1 : 0;
    camera.focus_distance = 9;
    random_samples(&camera, 17);
    run(VL_ISA_BASE, &camera, N, &rays);
    for (int i = 0; i < N; i++) {
      double o[3] = {rays.ox[i], rays.oy[i], rays.oz[i]},
             d[3] = {rays.dx[i], rays.dy[i], rays.dz[i]}, z[2];
      const double *m = camera.camera_from_world;
      for (int e = 0; e < 2; e++) {
        double t = e ? rays.t_max[i] : rays.t_min[i];
        z[e] = m[11];
        for (int a = 0; a < 3; a++)
          z[e] += m[8 + a] * (o[a] + t * d[a]);
      }
      double size = fabs(o[0]) + fabs(o[1]) + fabs(o[2]) + 100;
      assert_true(fabs(z[0] - 2) < 2e-7 * size && fabs(z[1] - 50) < 2e-7 * size);
    }
  }
}

static void shutter_and_footprint(void **state) {
  (void)state;
  vlCameraDef def = vl_default_camera_def(100, 100);
  def.shutter_open = 2;
  def.shutter_close = 6;
  def.view_distance = 200;
  vlCamera camera = make_or_fail(&def);
  random_samples(&camera, 1);
  run(VL_ISA_BASE, &camera, N, &rays);
  for (int i = 0; i < N; i++)
    assert_true(fabs(rays.time[i] - (2 + 4 * samples.time[i])) < 1e-6);
  vlCameraCompiled c;
  vl_camera_compile(&camera, &c);
  assert_true(c.pixel_spread == 1 / 200.0f && c.pixel_width == 0);
  camera = camera_of(3);
  vl_camera_compile(&camera, &c);
  assert_true(c.pixel_spread == 0 && c.pixel_width == 0.125f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(slides_formula_to_the_last_bit),
      cmocka_unit_test(kernels_are_unproject_rounded),
      cmocka_unit_test(same_bits_on_all_instruction_sets),
      cmocka_unit_test(thin_lens_focuses),
      cmocka_unit_test(disk_map_is_exact_enough),
      cmocka_unit_test(near_and_far_planes),
      cmocka_unit_test(shutter_and_footprint),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
