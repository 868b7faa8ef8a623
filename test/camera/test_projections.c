/* test/camera/test_projections.c: every projection and calibrated model: round trips, batches
 * against single calls, the limit of the field of view, solid angles, folds, names, error
 * messages. */
#include "camera/cameras.h"

#include "camera/parts.h"
#include "camera/rays.h"
#include "velo/distortion.h"
#include "velo/projection.h"

static const double pi = 3.14159265358979323846;

/* One of each, some with distortion. What is 0 or null stays at its default. */
typedef struct Model {
  vlProjection projection;
  double shape[2];
  double fov; /* radians */
  vlFovAxis fov_axis;
  double fx;
  vlDistortion distortion;
  uint32_t count; /* of coefficients */
  double k[14];
  const char *colmap; /* COLMAP's model with the parameters p, in place of all above */
  double p[12];
  uint32_t parameters;
} Model;

#define FULL_TURN 6.28318530717958647692
/* The models that tests name; they have indices of their own in the table. */
enum {
  PLAIN = 0,
  WINDOW = 6,
  CUBE = 9,
  ALL_OF_OPENCV = 21,
  FOLDS = 28,
  FOLDS_ASLANT = 29,
  ORTHOGRAPHIC = 30,
  MODELS = 32
};

static const Model models[MODELS] = {
    [PLAIN] = {VL_PROJECTION_PERSPECTIVE},
    {VL_PROJECTION_EQUIDISTANT},
    {VL_PROJECTION_EQUISOLID, .fov = FULL_TURN, .fov_axis = VL_FOV_DIAGONAL},
    {VL_PROJECTION_STEREOGRAPHIC, .fov = 4.5, .fov_axis = VL_FOV_HORIZONTAL},
    {VL_PROJECTION_SINE},
    {VL_PROJECTION_EQUIRECTANGULAR},
    [WINDOW] = {VL_PROJECTION_EQUIRECTANGULAR},
    {VL_PROJECTION_EQUAL_AREA},
    {VL_PROJECTION_CYLINDRICAL},
    [CUBE] = {VL_PROJECTION_CUBE},
    {VL_PROJECTION_PANINI, .fov = 4, .fov_axis = VL_FOV_HORIZONTAL},
    {VL_PROJECTION_PANINI, {0.5}, .fov = 3, .fov_axis = VL_FOV_HORIZONTAL},
    {VL_PROJECTION_PANINI, {3}},
    {VL_PROJECTION_FOV, {0.9}},
    {VL_PROJECTION_DIVISION, {-0.3}, .fov = 3.6},
    {VL_PROJECTION_DIVISION, {0.1}},
    {VL_PROJECTION_UNIFIED, {0.8}, .fov = 3.5},
    {VL_PROJECTION_UNIFIED, {1.7}, .fov = 3.5},
    {VL_PROJECTION_EUCM, {0.6, 1.1}, .fov = 3.3},
    {VL_PROJECTION_DOUBLE_SPHERE, {-0.2, 0.58}, .fov = 3.3},
    {VL_PROJECTION_DOUBLE_SPHERE, {0.3, 0.4}},
    [ALL_OF_OPENCV] = {.fx = 500,
                       .distortion = VL_DISTORTION_OPENCV,
                       .count = 14,
                       .k = {-0.28, 0.07, 1e-3, -2e-3, 0.01, 0.02, -0.01, 0.003, 1e-3, -5e-4,
                             2e-3, 3e-4, 0.03, -0.02}},
    /* strong barrel that does not fold within the image; pincushion */
    {.fx = 500, .distortion = VL_DISTORTION_OPENCV, .count = 5, .k = {-0.3, 0.1, 0, 0, 0.02}},
    {.fx = 600, .distortion = VL_DISTORTION_OPENCV, .count = 4, .k = {0.4, 0.2}},
    /* OpenCV's fisheye */
    {VL_PROJECTION_EQUIDISTANT, .fx = 210, .distortion = VL_DISTORTION_RADIAL, .count = 4,
     .k = {0.03, -0.02, 0.004, -0.0003}},
    {.colmap = "THIN_PRISM_FISHEYE",
     .p = {220, 225, 310, 240, 0.02, -0.01, 1e-3, -5e-4, 2e-3, -2e-4, 3e-4, -4e-4},
     .parameters = 12},
    {.colmap = "RADIAL", .p = {450, 320, 240, -0.12, 0.05}, .parameters = 5},
    /* unified with distortion: Mei's whole model */
    {VL_PROJECTION_UNIFIED,
     {0.9},
     .fx = 400,
     .distortion = VL_DISTORTION_OPENCV,
     .count = 4,
     .k = {-0.2, 0.04, 1e-3}},
    /* these fold inside the image, the second with tangential terms */
    [FOLDS] = {.fx = 300, .distortion = VL_DISTORTION_RADIAL, .count = 1, .k = {-0.4}},
    [FOLDS_ASLANT] = {.fx = 300,
                      .distortion = VL_DISTORTION_OPENCV,
                      .count = 4,
                      .k = {-0.4, 0, 0.02, 0.01}},
    [ORTHOGRAPHIC] = {VL_PROJECTION_ORTHOGRAPHIC},
    {VL_PROJECTION_EQUIDISTANT, .fov = FULL_TURN}};

/* The model's def, with a pose that is of no matter here but not trivial. */
static vlCameraDef model_def(int index) {
  const Model *m = &models[index];
  vlCameraDef d = vl_default_camera_def(641, 479);
  set3(d.eye, 1, 2, 3);
  set3(d.lookat, -3, 4, 5);
  d.roll = 0.3;
  if (m->colmap) {
    assert_int_equal(vl_camera_def_colmap(&d, m->colmap, m->p, m->parameters, NULL), VL_OK);
    return d;
  }
  d.projection = m->projection;
  for (int i = 0; i < 2; i++)
    if (m->shape[i] != 0)
      d.shape[i] = m->shape[i];
  if (m->fov > 0)
    d.fov = m->fov;
  if (m->fov_axis)
    d.fov_axis = m->fov_axis;
  if (m->fx > 0)
    d.fx = m->fx;
  if (m->count)
    d.distortion = m->distortion;
  d.distortion_count = m->count;
  memcpy(d.distortion_coefficients, m->k, sizeof m->k);
  switch (index) {
    case WINDOW:
      d.screen_min_x = -2;
      d.screen_max_x = 1;
      d.screen_min_y = -0.5;
      d.screen_max_y = 1.4;
      break;
    case CUBE:
      d.width = 600;
      d.height = 100;
      break;
    case ALL_OF_OPENCV:
      d.fy = 510;
      d.cx = 300;
      d.cy = 250;
      d.skew = 0.7;
      break;
    case ORTHOGRAPHIC:
      d.pixel_size = 0.01;
      break;
    default:
      break;
  }
  return d;
}

static vlCamera model(int index) {
  vlCameraDef def = model_def(index);
  vlCamera camera;
  vlError error;
  if (vl_camera_make(&def, &camera, NULL, &error) != VL_OK)
    fail_msg("model %d: %s", index, error.message);
  return camera;
}

static void there_and_back(void **state) {
  (void)state;
  double worst = 0;
  for (int k = 0; k < MODELS; k++) {
    vlCamera camera = model(k);
    uint64_t random = 5;
    int seen = 0, n = 4000;
    double here = 0;
    for (int i = 0; i < n; i++) {
      double x = next_between(&random, 0, camera.width),
             y = next_between(&random, 0, camera.height);
      double o[3], d[3], p[3], pixel[2], z, t = exp(next_between(&random, -1, 3));
      if (!vl_camera_unproject(&camera, x, y, o, d))
        continue;
      seen++;
      for (int a = 0; a < 3; a++)
        p[a] = o[a] + t * d[a];
      if (!vl_camera_project(&camera, p, pixel, &z)) {
        /* only at the very edge of the domain may rounding put it outside: a little further in
         * it is inside */
        double cx = camera.cx + (x - camera.cx) * (1 - 1e-9),
               cy = camera.cy + (y - camera.cy) * (1 - 1e-9);
        assert_true(vl_camera_unproject(&camera, cx, cy, o, d));
        for (int a = 0; a < 3; a++)
          p[a] = o[a] + t * d[a];
        if (!vl_camera_project(&camera, p, pixel, &z))
          fail_msg("model %d: (%g %g) does not come back", k, x, y);
        continue;
      }
      here = fmax(here, fmax(fabs(pixel[0] - x), fabs(pixel[1] - y)));
    }
    if (here > 1e-9)
      fail_msg("model %d: off by %g pixels", k, here);
    worst = fmax(worst, here);
    assert_true(fabs((n - seen) / (double)n - camera.outside) < 0.03);
    if (k < 22 && k != 1 && k != 2 && k != 3 && k != 4 && k != 14 && k != 16 && k != 17 &&
        k != 18 && k != 19)
      assert_int_equal(seen, n);
  }
  print_message("there and back: %.3g pixels at worst\n", worst);
}

/* If a camera projects a direction, unprojection returns the same direction. No result is ever
 * NaN. */
static void back_and_there(void **state) {
  (void)state;
  for (int k = 0; k < MODELS; k++) {
    if (k == ORTHOGRAPHIC)
      continue;
    vlCamera camera = model(k);
    uint64_t random = 9;
    int seen = 0;
    for (int i = 0; i < 4000; i++) {
      double z = next_between(&random, -1, 1), phi = next_between(&random, -pi, pi),
             s = sqrt(1 - z * z);
      double d[3] = {s * cos(phi), s * sin(phi), z}, p[3], o[3], e[3], pixel[2], depth;
      if (i == 0) {
        d[0] = d[1] = 0;
        d[2] = -1;
      }
      if (i == 1) {
        d[0] = d[1] = 0;
        d[2] = 1;
      }
      for (int a = 0; a < 3; a++) {
        const double *m = camera.world_from_camera + 4 * a;
        p[a] = m[0] * d[0] + m[1] * d[1] + m[2] * d[2];
      }
      double point[3] = {p[0] + camera.world_from_camera[3], p[1] + camera.world_from_camera[7],
                         p[2] + camera.world_from_camera[11]};
      if (!vl_camera_project(&camera, point, pixel, &depth))
        continue;
      assert_true(isfinite(pixel[0]) && isfinite(pixel[1]));
      if (fabs(pixel[0] - camera.cx) > camera.width ||
          fabs(pixel[1] - camera.cy) > camera.height)
        continue;
      if (!vl_camera_unproject(&camera, pixel[0], pixel[1], o, e)) {
        /* at the rim */
        double x = camera.cx + (pixel[0] - camera.cx) * (1 - 1e-9),
               y = camera.cy + (pixel[1] - camera.cy) * (1 - 1e-9);
        if (!vl_camera_unproject(&camera, x, y, o, e))
          fail_msg("model %d: %g %g seen but not there", k, x, y);
      }
      double error = fmax(fabs(e[0] - p[0]), fmax(fabs(e[1] - p[1]), fabs(e[2] - p[2])));
      if (error > 1e-7)
        fail_msg("model %d: direction off by %g", k, error);
      seen++;
    }
    assert_true(seen > 50);
    const double bad[4][3] = {{NAN, 0, 0}, {INFINITY, 1, 1}, {1e300, -1e300, 1e300}, {1, 2, 3}};
    for (int i = 0; i < 4; i++) {
      double pixel[2] = {0, 0}, z;
      if (vl_camera_project(&camera, bad[i], pixel, &z))
        assert_true(isfinite(pixel[0]) && isfinite(pixel[1]));
    }
  }
}

/* What project calls valid has a ray, however far outside the image it is, one by one and in
 * batches, and the ray comes back to the same pixel. Strong lenses as calibrations have them,
 * with tangential terms, beside the models. */
static void valid_points_have_rays(void **state) {
  (void)state;
  static const double lenses[4][8] = {{0.1}, /* OpenCV's k1 k2 p1 p2 k3 k4 k5 k6 */
                                      {0.262383, -0.953104, -0.005358, 0.002628, 1.163314},
                                      {0.3, -0.05, 0.001, 0.001, 0.01, 0.1, 0.01, 0.001},
                                      {-0.28, 0.07, 1e-3, -2e-3, 0.01, 0.02, -0.01, 0.003}};
  enum { POINTS = 4000 };
  static double points[POINTS][3], pixels[POINTS][2], depth[POINTS], directions[POINTS][3];
  static uint8_t valid[POINTS], answered[POINTS];
  for (int k = 0; k < MODELS + 4; k++) {
    vlCameraDef def = model_def(k < MODELS ? k : PLAIN);
    if (k >= MODELS) {
      def.fx = 500;
      def.distortion = VL_DISTORTION_OPENCV;
      def.distortion_count = 8;
      memcpy(def.distortion_coefficients, lenses[k - MODELS], sizeof lenses[0]);
    }
    vlCamera camera;
    assert_int_equal(vl_camera_make(&def, &camera, NULL, NULL), VL_OK);
    uint64_t random = 21;
    int outside = 0;
    for (int i = 0; i < POINTS; i++) {
      double p[3] = {next_between(&random, -3, 3), next_between(&random, -3, 3), 1};
      if (i == 0)
        set3(p, 1.9, 0, 1);
      const double *m = camera.world_from_camera;
      for (int a = 0; a < 3; a++, m += 4)
        points[i][a] = m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3];
    }
    vl_camera_project_batch(&camera, POINTS, points[0], pixels[0], depth, valid);
    vl_camera_unproject_batch(&camera, POINTS, pixels[0], NULL, directions[0], answered);
    for (int i = 0; i < POINTS; i++) {
      double x = pixels[i][0], y = pixels[i][1], o[3], d[3], p[3], again[2], z;
      if (!valid[i])
        continue;
      bool inside = x >= 0 && y >= 0 && x <= camera.width && y <= camera.height;
      outside += !inside;
      if (!answered[i] || !vl_camera_unproject(&camera, x, y, o, d))
        fail_msg("model %d: %.17g %.17g is valid and has no ray", k, x, y);
      assert_memory_equal(d, directions[i], sizeof d);
      for (int a = 0; a < 3; a++)
        p[a] = o[a] + 2 * d[a];
      assert_true(vl_camera_project(&camera, p, again, &z));
      double error = fmax(fabs(again[0] - x), fabs(again[1] - y));
      if (error > 1e-9 * (1000 + fabs(x) + fabs(y)))
        fail_msg("model %d: %g %g comes back %g pixels off", k, x, y, error);
    }
    if (k >= MODELS)
      assert_true(outside > POINTS / 20);
  }
}

static void batches_are_single_calls(void **state) {
  (void)state;
  enum { N = 1000 };
  static double pixels[2 * N], o[3 * N], d[3 * N], points[3 * N], back[2 * N], z[N];
  static uint8_t seen[N], landed[N];
  for (int k = 0; k < MODELS; k++) {
    vlCamera camera = model(k);
    uint64_t random = 31;
    for (int i = 0; i < N; i++) {
      pixels[2 * i] = next_between(&random, -0.2, 1.2) * camera.width;
      pixels[2 * i + 1] = next_between(&random, -0.2, 1.2) * camera.height;
      for (int a = 0; a < 3; a++)
        points[3 * i + a] = next_between(&random, -9, 9);
    }
    pixels[0] = NAN;
    pixels[3] = INFINITY;
    points[0] = NAN;
    points[4] = INFINITY;
    vl_camera_unproject_batch(&camera, N, pixels, o, d, seen);
    vl_camera_project_batch(&camera, N, points, back, z, landed);
    for (int i = 0; i < N; i++) {
      double oi[3] = {0}, di[3] = {0}, pi2[2] = {0}, zi = 0;
      bool s = vl_camera_unproject(&camera, pixels[2 * i], pixels[2 * i + 1], oi, di);
      bool l = vl_camera_project(&camera, points + 3 * i, pi2, &zi);
      if (s != seen[i] || l != landed[i])
        fail_msg("model %d, %d: valid %d %d, %d %d", k, i, s, seen[i], l, landed[i]);
      if (!s)
        oi[0] = oi[1] = oi[2] = di[0] = di[1] = di[2] = 0;
      if (memcmp(oi, o + 3 * i, 24) || memcmp(di, d + 3 * i, 24))
        fail_msg("model %d: rays differ", k);
      if (memcmp(pi2, back + 2 * i, 16) || memcmp(&zi, z + i, 8))
        fail_msg("model %d: points differ", k);
    }
    vl_camera_unproject_batch(&camera, 3, pixels, NULL, d, NULL);
    vl_camera_project_batch(&camera, 3, points, back, NULL, NULL);
    vl_camera_project_batch(&camera, 0, NULL, NULL, NULL, NULL);
  }
}

/* The render loop's rays: the double ones rounded, the same bits on every set, with and without
 * a lens. */
static void rays_of_all_sets(void **state) {
  (void)state;
  enum { N = 1024 };
  static float in[5][N], out[2][10][N];
  static int32_t px[2][N];
  double worst = 0;
  for (int k = 0; k < 2 * MODELS; k++) {
    vlCamera camera = model(k / 2);
    if (k & 1) {
      camera.lens_radius = 0.1;
      camera.focus_distance = 5;
    }
    camera.near_plane = 0.5;
    camera.far_plane = 90;
    uint64_t random = 3;
    for (int i = 0; i < N; i++) {
      for (int a = 0; a < 5; a++)
        in[a][i] = (float)next_unit(&random) * 0.9999f;
      px[0][i] = (int32_t)(next_unit(&random) * camera.width);
      px[1][i] = (int32_t)(next_unit(&random) * camera.height);
    }
    vlCameraCompiled c;
    vl_camera_compile(&camera, &c);
    vlCameraSamples s = {in[0], in[1], px[0], px[1], in[2], in[3], in[4]};
    const vlIsa sets[] = {VL_ISA_BASE, VL_ISA_V3, VL_ISA_V4};
    for (int set = 0; set < 3 && sets[set] <= vl_isa_best(); set++) {
      float(*r)[N] = out[set > 0];
      vlCameraRays rays = {r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], r[9], NULL};
      vl_camera_kernels(sets[set])->rays(&c, N, &s, &rays);
      if (set > 0 && memcmp(out[0], out[1], sizeof out[0]))
        fail_msg("model %d: sets differ", k / 2);
    }
    for (int i = 0; i < N; i++) {
      double o[3], d[3];
      bool seen = vl_camera_unproject(&camera, px[0][i] + (double)in[0][i],
                                      px[1][i] + (double)in[1][i], o, d);
      if (camera.projection == VL_PROJECTION_CUBE && (k & 1) == 0)
        seen = out[0][9][i] > 0; /* the pixel's face */
      if (seen != (out[0][9][i] > 0))
        fail_msg("model %d: validity differs", k / 2);
      assert_true(seen ? out[0][7][i] > out[0][6][i] : out[0][7][i] == -1);
      double length = 0;
      for (int a = 0; a < 3; a++)
        length += (double)out[0][3 + a][i] * (double)out[0][3 + a][i];
      assert_true(fabs(length - 1) < 1e-6);
      for (int a = 0; a < 3 && seen && !(k & 1); a++)
        if (fabs(out[0][3 + a][i] - d[a]) > 1e-7)
          fail_msg("model %d: ray off by %g", k / 2, out[0][3 + a][i] - d[a]);
      /* and back: the ray in floats leads to its film point, but for those at the last edge of
       * a domain */
      double p[3], pixel[2], z;
      for (int a = 0; a < 3; a++)
        p[a] = (double)out[0][a][i] + 5 * (double)out[0][3 + a][i];
      if (!seen || (k & 1) || !vl_camera_project(&camera, p, pixel, &z))
        continue;
      double off = fmax(fabs(pixel[0] - px[0][i] - (double)in[0][i]),
                        fabs(pixel[1] - px[1][i] - (double)in[1][i]));
      /* a seam: another face's pixel */
      if (off > 1e-3 && !(camera.projection == VL_PROJECTION_CUBE && off > 1))
        fail_msg("model %d: a float ray leads %g pixels away", k / 2, off);
      if (off <= 1e-3)
        worst = fmax(worst, off);
    }
  }
  print_message("rays in floats, and back: %.3g pixels at worst\n", worst);
}

/* All rays of a film point meet in one point: at z = 5 for those that see only ahead, at the
 * distance 5 for all others. */
static void lens_focuses(void **state) {
  (void)state;
  enum { N = 64 };
  for (int k = 0; k < MODELS; k++) {
    vlCamera camera = model(k);
    camera.lens_radius = 0.2;
    camera.focus_distance = 5;
    float film[N], u[N], v[N], time[N] = {0}, out[10][N];
    int32_t px[N], py[N];
    uint64_t random = 41;
    for (int i = 0; i < N; i++) {
      film[i] = 0.25f;
      px[i] = (int32_t)(0.6 * camera.width);
      py[i] = (int32_t)(0.55 * camera.height);
      u[i] = (float)next_unit(&random) * 0.9999f;
      v[i] = (float)next_unit(&random) * 0.9999f;
    }
    vlCameraCompiled c;
    vl_camera_compile(&camera, &c);
    vlCameraSamples s = {film, film, px, py, u, v, time};
    vlCameraRays rays = {out[0], out[1], out[2], out[3], out[4], out[5],
                         out[6], out[7], out[8], out[9], NULL};
    vl_camera_kernels(VL_ISA_BASE)->rays(&c, N, &s, &rays);
    double o[3], d[3], p[3];
    assert_true(vl_camera_unproject(&camera, px[0] + 0.25, py[0] + 0.25, o, d));
    const double *m = camera.world_from_camera;
    double depth = d[0] * m[2] + d[1] * m[6] + d[2] * m[10];
    double reach = vl_camera_sees_ahead(camera.projection) ? 5 / depth : 5;
    for (int a = 0; a < 3; a++)
      p[a] = o[a] + reach * d[a];
    for (int i = 0; i < N; i++) {
      double to[3], along = 0, off = 0;
      for (int a = 0; a < 3; a++) {
        to[a] = p[a] - out[a][i];
        along += to[a] * out[3 + a][i];
      }
      for (int a = 0; a < 3; a++)
        off += pow(to[a] - along * out[3 + a][i], 2);
      if (!(along > 0 && sqrt(off) < 1e-5))
        fail_msg("model %d: a ray misses the focus by %g", k, sqrt(off));
    }
  }
}

/* Known from the equations: cos^3 for the perspective; constant for equal-area maps;
 * cos(latitude), ... */
static void solid_angles(void **state) {
  (void)state;
  for (int k = 0; k < MODELS; k++) {
    vlCamera c = model(k);
    uint64_t random = 21;
    for (int i = 0; i < 200; i++) {
      double x = next_between(&random, 1, c.width - 1),
             y = next_between(&random, 1, c.height - 1), o[3], d[4][3];
      double got = vl_camera_solid_angle(&c, x, y), u = (x - c.cx) / c.fx,
             v = (y - c.cy) / c.fy;
      double r = sqrt(u * u + v * v), area = 1 / (c.fx * c.fy), wanted = -1;
      if (k == 0)
        wanted = area / pow(1 + r * r, 1.5);
      if (k == 1 && r < 1.57)
        wanted = area * sin(r) / r;
      if (k == 2 && r < 1.99)
        wanted = area;
      if (k == 4 && r < 0.98)
        wanted = area / sqrt(1 - r * r);
      if (k == 5 || k == 6)
        wanted = area * cos(v);
      if (k == 7)
        wanted = 4 * pi / (641.0 * 479.0);
      if (k == 8)
        wanted = area / pow(1 + v * v, 1.5);
      if (k == 7 && (fabs(u) < 0.02 || fabs(v) < 0.02 || fabs(fabs(u) + fabs(v) - 1) < 0.02))
        continue; /* creases */
      if (wanted >= 0 && fabs(got / wanted - 1) > 1e-7)
        fail_msg("model %d: %g, not %g", k, got, wanted);
      if (k == CUBE || k == ORTHOGRAPHIC || got == 0)
        continue;
      /* and a little quadrilateral of rays */
      const double h = 1e-3;
      bool ok = vl_camera_unproject(&c, x - h, y, o, d[0]) &&
                vl_camera_unproject(&c, x + h, y, o, d[1]) &&
                vl_camera_unproject(&c, x, y - h, o, d[2]) &&
                vl_camera_unproject(&c, x, y + h, o, d[3]);
      if (!ok)
        continue;
      double a[3], b[3], n[3];
      for (int j = 0; j < 3; j++) {
        a[j] = d[1][j] - d[0][j];
        b[j] = d[3][j] - d[2][j];
      }
      for (int j = 0; j < 3; j++)
        n[j] = a[(j + 1) % 3] * b[(j + 2) % 3] - a[(j + 2) % 3] * b[(j + 1) % 3];
      double quad = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / (4 * h * h);
      /* where it folds, differences see two sides */
      bool rim = (k == FOLDS || k == FOLDS_ASLANT) && r > 0.57;
      if (!rim && fabs(got / quad - 1) > 1e-5)
        fail_msg("model %d at %g %g: %g, by rays %g", k, x, y, got, quad);
    }
  }
}

static void framing_and_image_circles(void **state) {
  (void)state;
  double o[3], d[3];
  /* a circular fisheye of 180 degrees: the circle touches the smaller side, the corners are
   * empty */
  vlCameraDef def = vl_default_camera_def(600, 400);
  def.projection = VL_PROJECTION_EQUISOLID;
  def.fov = pi;
  vlCamera c = make_or_fail(&def);
  assert_true(fabs(c.fy * 2 * sin(pi / 4) - 200) < 1e-9);
  assert_true(vl_camera_unproject(&c, 300, 0.001, o, d) &&
              !vl_camera_unproject(&c, 300, -0.001, o, d));
  assert_true(!vl_camera_unproject(&c, 0, 0, o, d));
  assert_true(fabs(c.outside - (1 - pi * 200 * 200 / (600 * 400))) < 0.02);
  /* cropped: across the larger side; diagonal: no empty corner */
  def.fov_axis = VL_FOV_LARGER;
  c = make_or_fail(&def);
  assert_true(vl_camera_unproject(&c, 0.001, 200, o, d) &&
              !vl_camera_unproject(&c, -0.001, 200, o, d));
  def.fov_axis = VL_FOV_DIAGONAL;
  c = make_or_fail(&def);
  assert_true(c.outside == 0 && vl_camera_unproject(&c, 0.001, 0.001, o, d) &&
              !vl_camera_unproject(&c, -1, -1, o, d));
  /* an image circle of its own; behind it points do not land */
  def = vl_default_camera_def(600, 400);
  def.projection = VL_PROJECTION_EQUIDISTANT;
  def.fx = 100;
  def.max_angle = 1;
  c = make_or_fail(&def);
  assert_true(vl_camera_unproject(&c, 399.9, 200, o, d) &&
              !vl_camera_unproject(&c, 400.1, 200, o, d));
  const double in[3] = {0.84, 0, -0.55}, out[3] = {0.85, 0, -0.53};
  double pixel[2], z;
  assert_true(vl_camera_project(&c, in, pixel, &z) && !vl_camera_project(&c, out, pixel, &z));
  /* equirectangular: the centre ahead, a quarter to the right on the right, the top up */
  def = vl_default_camera_def(400, 200);
  def.projection = VL_PROJECTION_EQUIRECTANGULAR;
  c = make_or_fail(&def);
  assert_true(vl_camera_unproject(&c, 300, 100, o, d) && d[0] > 1 - 1e-12);
  assert_true(vl_camera_unproject(&c, 200, 0, o, d) && d[1] > 1 - 1e-12);
  assert_true(vl_camera_unproject(&c, 405, 100, o, d) &&
              !vl_camera_unproject(&c, 420, 100, o, d));
  /* cube: right left up down front back */
  const double axis[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                             {0, -1, 0}, {0, 0, -1}, {0, 0, 1}};
  def = vl_default_camera_def(600, 100);
  def.projection = VL_PROJECTION_CUBE;
  c = make_or_fail(&def);
  for (int face = 0; face < 6; face++) {
    assert_true(vl_camera_project(&c, axis[face], pixel, &z));
    assert_true(fabs(pixel[0] - (100 * face + 50)) < 1e-9 && fabs(pixel[1] - 50) < 1e-9);
  }
  const double above_front[3] = {0.1, 0.999, -1}, below_up[3] = {0.1, 1.001, -1};
  assert_true(vl_camera_project(&c, above_front, pixel, &z) && pixel[0] > 400 &&
              pixel[1] < 0.2);
  assert_true(vl_camera_project(&c, below_up, pixel, &z) && fabs(pixel[0] - 255) < 0.1 &&
              pixel[1] > 99.8);
  /* Panini keeps verticals straight */
  def = vl_default_camera_def(600, 400);
  def.projection = VL_PROJECTION_PANINI;
  def.fov = 2.5;
  def.fov_axis = VL_FOV_HORIZONTAL;
  c = make_or_fail(&def);
  double column = 0;
  for (int i = -3; i <= 3; i++) {
    const double p[3] = {2, 0.5 * i, -1};
    assert_true(vl_camera_project(&c, p, pixel, &z));
    if (i > -3)
      assert_true(fabs(pixel[0] - column) < 1e-9);
    column = pixel[0];
  }
}

static void folding_is_found(void **state) {
  (void)state;
  /* r (1 + k r^2) turns where 1 + 3 k r^2 = 0 */
  vlCamera c = model(FOLDS);
  assert_true(fabs(c.distortion.radius - sqrt(1 / 1.2)) < 1e-9);
  vlCameraDef def = model_def(FOLDS);
  const char *warning = NULL;
  assert_int_equal(vl_camera_make(&def, &c, &warning, NULL), VL_OK);
  assert_non_null(warning);
  assert_true(strstr(warning, "folds") && !strchr(warning, '\n') && c.outside > 0.3 &&
              c.outside < 0.9);
  /* beyond it, a point ahead of the camera does not land, though the polynomial gives it a
   * place in the image */
  double pixel[2], z;
  for (int i = 0; i < 2; i++) {
    double x = (i ? 0.999 : 1.001) * c.distortion.radius;
    double p[3];
    for (int a = 0; a < 3; a++) {
      const double *m = c.world_from_camera + 4 * a;
      p[a] = m[0] * x + m[2] + m[3];
    }
    assert_int_equal(vl_camera_project(&c, p, pixel, &z), i);
  }
  /* no fold: k > 0; a pole of the denominator is one */
  c = model(23);
  assert_true(c.distortion.radius >= 1e3 && c.outside == 0);
  def = vl_default_camera_def(640, 480);
  def.fx = 400;
  def.distortion = VL_DISTORTION_OPENCV;
  def.distortion_count = 8;
  def.distortion_coefficients[5] = -0.25;
  assert_int_equal(vl_camera_make(&def, &c, NULL, NULL), VL_OK);
  assert_true(fabs(c.distortion.radius - 2) < 1e-9);
  /* the general search agrees with the polynomial's root when the tangential terms vanish */
  def = model_def(FOLDS_ASLANT);
  def.distortion_coefficients[2] = 1e-12;
  def.distortion_coefficients[3] = 0;
  assert_int_equal(vl_camera_make(&def, &c, NULL, NULL), VL_OK);
  assert_true(fabs(c.distortion.radius / sqrt(1 / 1.2) - 1) < 0.003);
  /* zero coefficients are no distortion, and no other image */
  def = vl_default_camera_def(640, 480);
  def.distortion = VL_DISTORTION_OPENCV;
  def.distortion_count = 5;
  c = make_or_fail(&def);
  assert_true(c.distortion.steps == 0);
}

static void error_messages(void **state) {
  (void)state;
  EXPECT_ERROR(d.fx = 0, "fx must be a number above 0; it is 0", NULL);
  EXPECT_ERROR((d.has_matrix = true, d.world_from_camera[0] = NAN), "not finite", NULL);
  EXPECT_ERROR(d.shape[0] = 1, "perspective", "shape[0] is 1");
  EXPECT_ERROR(d.projection = VL_PROJECTION_UNIFIED, "unified", "needs its xi");
  EXPECT_ERROR((d.projection = VL_PROJECTION_EUCM, d.shape[0] = 0.5), "EUCM", "beta");
  EXPECT_ERROR((d.projection = VL_PROJECTION_EUCM, d.shape[0] = 1.5, d.shape[1] = 1), "alpha",
               "1.5");
  EXPECT_ERROR((d.projection = VL_PROJECTION_PANINI, d.shape[0] = -1), "d of the Panini", "-1");
  EXPECT_ERROR((d.projection = VL_PROJECTION_SINE, d.fov = 4), "orthographic fisheye", "229");
  EXPECT_ERROR((d.projection = VL_PROJECTION_EQUIDISTANT, d.fov = 7), "360", NULL);
  EXPECT_ERROR((d.projection = VL_PROJECTION_CUBE, d.fov = 1), "fov has no meaning", "cube");
  EXPECT_ERROR((d.projection = VL_PROJECTION_PANINI, d.fov = 1, d.fov_axis = VL_FOV_DIAGONAL),
               "diagonal", "Panini");
  EXPECT_ERROR((d.projection = VL_PROJECTION_CYLINDRICAL, d.max_angle = 1), "max_angle",
               "cylindrical");
  EXPECT_ERROR((d.projection = VL_PROJECTION_EQUIDISTANT, d.max_angle = 4), "max_angle must be",
               "180 degrees");
  EXPECT_ERROR((d.projection = VL_PROJECTION_SINE, d.max_angle = 2), "does not see", NULL);
  EXPECT_ERROR(d.distortion_count = 4, "4 distortion coefficients", "without");
  EXPECT_ERROR((d.distortion = VL_DISTORTION_OPENCV, d.distortion_count = 6), "6 OpenCV",
               "4, 5, 8, 12 or 14");
  EXPECT_ERROR((d.distortion = VL_DISTORTION_RADIAL, d.distortion_count = 5), "5 radial", NULL);
  EXPECT_ERROR((d.distortion = VL_DISTORTION_THIN_PRISM, d.distortion_count = 5),
               "5 thin-prism", NULL);

  EXPECT_ERROR((d.distortion = VL_DISTORTION_OPENCV, d.distortion_count = 4,
                d.distortion_coefficients[1] = NAN),
               "coefficient 2 is nan", NULL);
  EXPECT_ERROR((d.distortion = VL_DISTORTION_OPENCV, d.distortion_count = 14,
                d.distortion_coefficients[12] = 2),
               "tilt", NULL);
  EXPECT_ERROR((d.projection = VL_PROJECTION_CUBE, d.distortion = VL_DISTORTION_RADIAL,
                d.distortion_count = 1),
               "no meaning", "cube");
  vlError error;
  vlCameraDef d = vl_default_camera_def(640, 480);
  const double p[12] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  assert_int_equal(vl_camera_def_colmap(&d, "PINHOL", p, 4, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "the nearest is \"PINHOLE\""));
  assert_int_equal(vl_camera_def_colmap(&d, "A_MODEL_OF_MY_OWN", p, 4, &error),
                   VL_ERROR_ARGUMENT);
  /* the caller's own words are not cut */
  assert_non_null(strstr(error.message, "\"A_MODEL_OF_MY_OWN\""));
  assert_int_equal(vl_camera_def_colmap(&d, "OPENCV", p, 7, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "8 parameters, not 7"));
  assert_int_equal(vl_camera_def_colmap(&d, "SIMPLE_RADIAL", p, 4, &error), VL_OK);
  assert_true(d.fx == 1 && d.fy == 1 && d.cx == 2 && d.cy == 3 &&
              d.distortion_coefficients[0] == 4);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(there_and_back),         cmocka_unit_test(back_and_there),
      cmocka_unit_test(valid_points_have_rays), cmocka_unit_test(batches_are_single_calls),
      cmocka_unit_test(rays_of_all_sets),       cmocka_unit_test(lens_focuses),
      cmocka_unit_test(solid_angles),           cmocka_unit_test(framing_and_image_circles),
      cmocka_unit_test(folding_is_found),       cmocka_unit_test(error_messages),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
