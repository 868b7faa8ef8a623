/* test/camera/test_lens.c: the lens of a camera: areas of aperture shapes, the tilted plane of
 * focus, the Scheimpflug principle, f-number, focus on a point, exposure, vignetting, clipping
 * planes, rejected values. */
#include "camera/context.h"

#include "camera/lens.h"
#include "camera/parts.h"
#include "camera/rays.h"
#include "velo/distortion.h"
#include "velo/projection.h"

enum { N = 1 << 18, CHUNK = 1024 };

static float u[N], v[N], x[N], y[N];

static void draw(uint64_t seed) {
  for (int i = 0; i < N; i++) {
    u[i] = (float)(next_bits(&seed) >> 40) * 0x1p-24f;
    v[i] = (float)(next_bits(&seed) >> 40) * 0x1p-24f;
  }
}

/* Chi-square over k cells with these expected counts; below the value that one test in 10^6
 * exceeds. */
static void check_chi2(const double *counts, const double *expected, int k) {
  double chi2 = 0;
  int cells = 0;
  for (int i = 0; i < k; i++) {
    if (expected[i] < 5) {
      if (expected[i] == 0)
        assert_true(counts[i] == 0);
      continue;
    }
    chi2 += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    cells++;
  }
  /* Wilson and Hilferty */
  double n = cells - 1, limit = n * pow(1 - 2 / (9 * n) + 4.76 * sqrt(2 / (9 * n)), 3);
  if (!(chi2 < limit))
    fail_msg("chi2 %g of %d cells, limit %g", chi2, cells, limit);
}

static double cross(double ax, double ay, double bx, double by) {
  return ax * by - ay * bx;
}

static bool in_polygon(const vlBlades *b, double px, double py) {
  for (uint32_t i = 0; i < b->count; i++)
    if (cross(b->x[i + 1] - b->x[i], b->y[i + 1] - b->y[i], px - b->x[i], py - b->y[i]) < 0)
      return false;
  return true;
}

/* Cells of a grid that lie wholly inside the polygon hold their share of its area; nothing lies
 * outside. */
static void blades_are_even(void **state) {
  (void)state;
  enum { GRID = 24 };
  for (uint32_t count = 3; count <= 9; count += 3) {
    static double counts[GRID * GRID], expected[GRID * GRID];
    vlBlades b;
    vl_blades_make(count, 0.3, &b);
    /* up, turned clockwise */
    assert_true(fabs(b.x[0] - sin(0.3)) < 1e-6 && fabs(b.y[0] + cos(0.3)) < 1e-6);
    draw(count);
    vl_blades_points(&b, N, u, v, x, y);
    memset(counts, 0, sizeof counts);
    for (int i = 0; i < N; i++) {
      assert_true(in_polygon(&b, x[i] * (1 - 1e-6), y[i] * (1 - 1e-6)));
      counts[(int)((y[i] + 1) * GRID / 2) * GRID + (int)((x[i] + 1) * GRID / 2)]++;
    }
    double area = 0.5 * count * sin(2 * M_PI / count);
    for (int k = 0; k < GRID * GRID; k++) {
      double x0 = 2.0 * (k % GRID) / GRID - 1, y0 = 2.0 * (k / GRID) / GRID - 1, s = 2.0 / GRID;
      bool whole = in_polygon(&b, x0, y0) && in_polygon(&b, x0 + s, y0) &&
                   in_polygon(&b, x0, y0 + s) && in_polygon(&b, x0 + s, y0 + s);
      expected[k] = whole ? N * s * s / area : 1; /* 1: not looked at */
    }
    check_chi2(counts, expected, GRID * GRID);
  }
}

/* Each cell of the image is hit as often as it is bright, and evenly inside; black ones
 * never. */
static void image_is_density(void **state) {
  (void)state;
  enum { W = 7, H = 5, PARTS = 2 };
  float values[W * H];
  uint64_t seed = 11;
  double sum = 0;
  for (int i = 0; i < W * H; i++) {
    values[i] = i % 4 == 1 || i / W == 3 ? 0.0f : (float)next_between(&seed, 0.1, 2);
    sum += values[i];
  }
  vlAperture *a = NULL;
  assert_int_equal(vl_aperture_create(context, W, H, values, &a, NULL), VL_OK);
  draw(3);
  u[0] = v[0] = 0;
  u[1] = v[1] = 0.99999994f;
  vl_aperture_points(a, N, u, v, x, y);
  static double counts[W * H * PARTS * PARTS], expected[W * H * PARTS * PARTS];
  memset(counts, 0, sizeof counts);
  for (int i = 0; i < N; i++) {
    assert_true(x[i] >= -1 && x[i] < 1 && y[i] >= -1 && y[i] < 1);
    counts[(int)((y[i] + 1) / 2 * H * PARTS) * W * PARTS + (int)((x[i] + 1) / 2 * W * PARTS)]++;
  }
  for (int k = 0; k < W * H * PARTS * PARTS; k++)
    expected[k] = N * values[k / (W * PARTS) / PARTS * W + k % (W * PARTS) / PARTS] / sum /
                  (PARTS * PARTS);
  check_chi2(counts, expected, W * H * PARTS * PARTS);
  /* as a mask its mean is a disc's */
  double mean = 0;
  for (int i = 0; i < W * H; i++)
    mean +=
        vl_aperture_value(a, 2 * (i % W + 0.5) / W - 1, 2 * (i / W + 0.5) / H - 1) / (W * H);
  assert_true(fabs(mean - M_PI / 4) < 1e-6);
  assert_true(vl_aperture_value(a, 1.01, 0) == 0);
  vl_aperture_destroy(a);
}

static void named_images(void **state) {
  (void)state;
  static const char *const names[] = {"gaussian", "square", "pentagon", "star"};
  for (int i = 0; i < 4; i++) {
    vlAperture *a = NULL;
    assert_int_equal(vl_aperture_create_named(context, names[i], &a, NULL), VL_OK);
    if (i == 2)
      /* upright */
      assert_true(vl_aperture_value(a, 0, -0.75) > 0 && vl_aperture_value(a, 0, 0.75) == 0);
    if (i == 3)
      assert_true(vl_aperture_value(a, 0.5, 0) == 0 && vl_aperture_value(a, -0.9, 0) > 0);
    vl_aperture_destroy(a);
  }
  vlError error;
  vlAperture *a;
  assert_int_equal(vl_aperture_create_named(context, "a regular heptagon", &a, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "unknown shape \"a regular heptagon\" (known: "));
  assert_int_equal(vl_aperture_create_named(context, "pentagram", &a, &error),
                   VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "pentagon"));
  float bad[2] = {1, -1};
  assert_int_equal(vl_aperture_create(context, 2, 1, bad, &a, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "1, 0 is -1"));
  bad[0] = bad[1] = 0;
  assert_int_equal(vl_aperture_create(context, 2, 1, bad, &a, &error), VL_ERROR_ARGUMENT);
}

/* The first points of the opening of a camera. */
static void lens_points_of(const vlAperture *image, uint32_t blades, double rotation,
                           double ratio, float px[CHUNK], float py[CHUNK]) {
  vlCameraDef def = vl_default_camera_def(64, 64);
  def.lens_radius = 0.5;
  def.focus_distance = 3;
  def.lens.aperture = image;
  def.lens.blades = blades;
  def.lens.rotation = rotation;
  def.lens.ratio = ratio;
  vlCamera camera = make_or_fail(&def);
  vlCameraCompiled c;
  vl_camera_compile(&camera, &c);
  assert_true(c.shaped);
  vl_lens_points(&c, CHUNK, u, v, px, py);
}

/* Openings are turned clockwise, then squeezed along x. A round one stays as it is when it is
 * turned. */
static void shapes_are_turned_and_squeezed(void **state) {
  (void)state;
  static const float dots[6] = {0, 1, 0, 0, 0, 2};
  static float plain[2][CHUNK], changed[2][CHUNK];
  const double rotation = 0.6, ratio = 2;
  vlAperture *image = NULL;
  assert_int_equal(vl_aperture_create(context, 3, 2, dots, &image, NULL), VL_OK);
  draw(5);
  for (int opening = 0; opening < 3; opening++) {
    const vlAperture *a = opening == 2 ? image : NULL;
    const uint32_t blades = opening == 1 ? 5 : 0;
    const double turn = opening ? rotation : 0;
    if (opening)
      lens_points_of(a, blades, 0, 1, plain[0], plain[1]);
    for (int i = 0; i < CHUNK && !opening; i++) {
      vlLensPoint p = vl_lens_disk(u[i], v[i]);
      plain[0][i] = p.x;
      plain[1][i] = p.y;
    }
    lens_points_of(a, blades, rotation, ratio, changed[0], changed[1]);
    for (int i = 0; i < CHUNK; i++) {
      double px = (double)plain[0][i], py = (double)plain[1][i];
      assert_true(fabs(changed[0][i] - (cos(turn) * px - sin(turn) * py) / ratio) < 1e-6);
      assert_true(fabs(changed[1][i] - (sin(turn) * px + cos(turn) * py)) < 1e-6);
    }
  }
  vl_aperture_destroy(image);
}

/* Any point of the tilted plane is met by the rays from all points of the lens; in double, to
 * 1e-12. */
static void tilted_plane_is_sharp(void **state) {
  (void)state;
  uint64_t seed = 21;
  for (int k = 0; k < 400; k++) {
    vlCameraDef def = vl_default_camera_def(300, 200);
    bool orthographic = k % 4 == 1, hinge = k % 4 == 2;
    if (orthographic)
      def.projection = VL_PROJECTION_ORTHOGRAPHIC;
    def.lens_radius = 0.2;
    double focus = next_between(&seed, 2, 9), normal[3], through[3] = {0, 0, focus};
    def.focus_distance = focus;
    if (hinge) {
      def.fov = 0.7;
      def.lens.f_number = 2;
      def.lens_radius = 0;
      def.lens.unit_mm = 10;
      def.fov_axis = VL_FOV_HORIZONTAL;
      def.focal_mm = 50;
      def.lens.lens_tilt_x = next_between(&seed, -0.15, 0.15);
      def.lens.lens_tilt_y = k % 8 == 2 ? 0 : next_between(&seed, -0.15, 0.15);
      if (k % 16 == 6)
        def.focus_distance = VL_UNSET; /* infinity: the plane is parallel to the axis */
      double f = 5;                    /* scene units */
      normal[0] = sin(def.lens.lens_tilt_y) / f;
      normal[1] = sin(def.lens.lens_tilt_x) / f;
      normal[2] = 1 / focus;
      if (k % 16 == 6)
        normal[2] = 0;
    } else {
      def.lens.tilt_x = next_between(&seed, -0.5, 0.5);
      def.lens.tilt_y = next_between(&seed, -0.5, 0.5);
      normal[0] = tan(def.lens.tilt_y);
      normal[1] = tan(def.lens.tilt_x);
      normal[2] = 1;
    }
    vlCamera camera = make_or_fail(&def);
    if (hinge)
      assert_true(fabs(camera.lens_radius - 5.0 / 4) < 1e-12);
    vlCameraCompiled c;
    vl_camera_compile(&camera, &c);
    double level = hinge ? 1 : normal[2] * focus;
    if (!hinge)
      assert_true(fabs(normal[2] * through[2] - level) < 1e-12);
    /* the film point that sees the plane's point p */
    vlCameraLocal pin = {0, 0, next_between(&seed, -0.6, 0.6), next_between(&seed, -0.4, 0.4),
                         1};
    if (orthographic)
      pin = (vlCameraLocal){pin.dx, pin.dy, 0, 0, 1};
    double along = (level - normal[0] * pin.ox - normal[1] * pin.oy) /
                   (normal[0] * pin.dx + normal[1] * pin.dy + normal[2] * pin.dz);
    double p[3] = {pin.ox + along * pin.dx, pin.oy + along * pin.dy, along * pin.dz};
    for (int i = 0; i < 50; i++) {
      vlLensPoint l = {(float)next_between(&seed, -1, 1), (float)next_between(&seed, -1, 1)};
      vlCameraLocal r = vl_lens_refract(&c, pin, l);
      assert_true(fabs(r.ox - pin.ox - camera.lens_radius * l.x) < 1e-12);
      double t = (p[2]) / r.dz;
      double size = 1 + fabs(along);
      assert_true(fabs(r.ox + t * r.dx - p[0]) < 1e-12 * size &&
                  fabs(r.oy + t * r.dy - p[1]) < 1e-12 * size);
    }
  }
}

/* A thin lens of focal length f through the origin, its axis along the unit vector n: the image
 * of p. Lines stay lines, so the images of two points of a ray are two points of its other
 * half. */
static void tilted_image(double f, const double n[3], const double p[3], double image[3]) {
  double scale = f / (f - (n[0] * p[0] + n[1] * p[1] + n[2] * p[2]));
  for (int a = 0; a < 3; a++)
    image[a] = scale * p[a];
}

/* Where the ray through p and q meets the film, z = -d, behind that lens, as a slope of the ray
 * through its middle. */
static void on_film(double f, const double n[3], double d, const double p[3], const double q[3],
                    double slope[2]) {
  double a[3], b[3];
  tilted_image(f, n, p, a);
  tilted_image(f, n, q, b);
  double t = (-d - a[2]) / (b[2] - a[2]);
  for (int k = 0; k < 2; k++)
    slope[k] = -(a[k] + t * (b[k] - a[k])) / d;
}

static double determinant(const double m[3][3]) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* The plane p.a = 1 through three points, by Cramer's rule. */
static void plane_through(const double points[3][3], double a[3]) {
  for (int k = 0; k < 3; k++) {
    double m[3][3];
    memcpy(m, points, sizeof m);
    for (int i = 0; i < 3; i++)
      m[i][k] = 1;
    a[k] = determinant(m) / determinant(points);
  }
}

enum { HINGES = 200, SPREAD = 32 };

static vlCamera tilted_lens(uint64_t *seed, double *focus, double n[3]) {
  vlCameraDef def = vl_default_camera_def(600, 400);
  def.focal_mm = 50;
  def.sensor_width_mm = 36;
  def.lens.f_number = 2;
  def.lens.unit_mm = 10;
  def.focus_distance = *focus = next_between(seed, 8, 40);
  def.lens.lens_tilt_x = next_between(seed, 0.02, 0.2);
  def.lens.lens_tilt_y = next_between(seed, -0.2, 0.2);
  n[0] = sin(def.lens.lens_tilt_y);
  n[1] = sin(def.lens.lens_tilt_x);
  n[2] = sqrt(1 - n[0] * n[0] - n[1] * n[1]);
  return make_or_fail(&def);
}

/* The Scheimpflug principle, by Gaussian optics of a lens that is really tilted: all rays of a
 * film point meet, the points where they meet lie in a plane, and this plane, the lens's and
 * the film's share one line. */
static void three_planes_share_a_line(void **state) {
  (void)state;
  uint64_t seed = 31;
  for (int k = 0; k < HINGES; k++) {
    double focus, n[3], f = 5, meet[3][3], plane[3], blur = 0;
    vlCamera camera = tilted_lens(&seed, &focus, n);
    double d = 1 / (n[2] / f - 1 / focus);
    vlCameraCompiled c;
    vl_camera_compile(&camera, &c);
    for (int point = 0; point < 3; point++) {
      double angle = 2.1 * point + 0.3;
      vlCameraLocal pin = {0, 0, 0.3 * cos(angle), 0.25 * sin(angle), 1};
      vlCameraLocal one = vl_lens_refract(&c, pin, (vlLensPoint){-1, 0}),
                    two = vl_lens_refract(&c, pin, (vlLensPoint){1, 0});
      double t =
          (two.ox - one.ox) /
          (one.dx / one.dz - two.dx / two.dz); /* the depth at which both have the same x */
      meet[point][0] = one.ox + t * one.dx / one.dz;
      meet[point][1] = one.oy + t * one.dy / one.dz;
      meet[point][2] = t;
      for (int i = 0; i < SPREAD; i++) {
        vlLensPoint l = {(float)cos(i), (float)sin(i)};
        vlCameraLocal r = vl_lens_refract(&c, pin, l);
        double p[3] = {r.ox, r.oy, 0},
               q[3] = {r.ox + 3 * r.dx / r.dz, r.oy + 3 * r.dy / r.dz, 3}, slope[2];
        on_film(f, n, d, p, q, slope);
        blur = fmax(blur, hypot(slope[0] - pin.dx, slope[1] - pin.dy) * camera.fx);
      }
    }
    if (!(blur < 1e-9))
      fail_msg("lens %d: %g pixels", k, blur);
    plane_through(meet, plane);
    /* the point of the line that is nearest to the axis, and the line's direction */
    double away = d * n[2] / (n[0] * n[0] + n[1] * n[1]),
           at = plane[0] * n[0] * away + plane[1] * n[1] * away - plane[2] * d;
    double along = (plane[0] * n[1] - plane[1] * n[0]) / hypot(n[0], n[1]);
    if (!(fabs(at - 1) < 1e-9 && fabs(along) < 1e-9))
      fail_msg("lens %d: %g, %g", k, at - 1, along);
    /* the hinge rule: at z = 0 the plane is f / sin t away */
    assert_true(fabs(hypot(plane[0], plane[1]) * f - hypot(n[0], n[1])) < 1e-9);
  }
}

/* The circle of confusion of a point q: its edge is where the tilted lens's ray through the
 * aperture's edge meets the film. Its radius is fx R |q.a - 1| / z, but for the factor 1 / (1 -
 * o.a) of an aperture that is not in the lens's plane. It is nothing in the plane in focus. */
static void blur_off_the_tilted_plane(void **state) {
  (void)state;
  uint64_t seed = 32;
  for (int k = 0; k < HINGES; k++) {
    double focus, n[3], f = 5, largest = 0;
    vlCamera camera = tilted_lens(&seed, &focus, n);
    double d = 1 / (n[2] / f - 1 / focus), a[3] = {n[0] / f, n[1] / f, 1 / focus};
    vlCameraCompiled c;
    vl_camera_compile(&camera, &c);
    double qx = next_between(&seed, -0.3, 0.3), qy = next_between(&seed, -0.2, 0.2);
    double sharp = 1 / (a[0] * qx + a[1] * qy + a[2]),
           z = k % 4 == 0 ? sharp : sharp * next_between(&seed, 0.5, 2);
    double q[3] = {qx * z, qy * z, z}, off = z / sharp - 1;
    for (int i = 0; i < SPREAD; i++) {
      vlLensPoint l = {(float)cos(i), (float)sin(i)};
      double o[3] = {camera.lens_radius * l.x, camera.lens_radius * l.y, 0}, slope[2];
      on_film(f, n, d, o, q, slope);
      vlCameraLocal r = vl_lens_refract(&c, (vlCameraLocal){0, 0, slope[0], slope[1], 1}, l);
      double miss = hypot(r.ox + z * r.dx / r.dz - q[0], r.oy + z * r.dy / r.dz - q[1]);
      if (!(miss < 1e-10 * z))
        fail_msg("lens %d: misses by %g of %g", k, miss, z);
      double radius = hypot(slope[0] - qx, slope[1] - qy) * camera.fx;
      double expected =
          camera.fx * camera.lens_radius * fabs(off) / z / (1 - a[0] * o[0] - a[1] * o[1]);
      assert_true(fabs(radius - expected) < 1e-6 + 1e-7 * expected); /* l is a float */
      largest = fmax(largest, radius);
    }
    assert_true(k % 4 == 0 ? largest < 1e-6 : largest > 20 * fabs(off) / z);
  }
}

/* The batch's rays are those of the formula above, for tilted and shaped lenses, on each
 * instruction set. */
static void batches_hold_the_lens(void **state) {
  (void)state;
  static float film[CHUNK], rows[3][11][CHUNK];
  static int32_t px[CHUNK], py[CHUNK];
  for (int k = 0; k < 3; k++) {
    vlCameraDef def = vl_default_camera_def(320, 240);
    def.lens_radius = 0.1;
    def.focus_distance = 4;
    def.lens.blades = 6;
    if (k < 2)
      def.lens.tilt_x = 0.4;
    if (k == 1)
      def.projection = VL_PROJECTION_ORTHOGRAPHIC;
    if (k == 2)
      def.projection = VL_PROJECTION_EQUIDISTANT;
    set3(def.eye, 0, 0, 0);
    set3(def.lookat, 0, 0, -1);
    vlCamera camera = make_or_fail(&def);
    vlCameraCompiled c;
    vl_camera_compile(&camera, &c);
    uint64_t seed = 8;
    draw(9);
    for (int i = 0; i < CHUNK; i++) {
      film[i] = 0.5f;
      px[i] = 80 + (int)(next_unit(&seed) * 160);
      py[i] = 60 + (int)(next_unit(&seed) * 120);
    }
    const vlIsa sets[] = {VL_ISA_BASE, VL_ISA_V3, VL_ISA_V4};
    for (int set = 0; set < 3; set++) {
      vlIsa got;
      if (vl_isa_choose(sets[set], &got) != VL_OK)
        continue;
      vlCameraSamples s = {film, film, px, py, u, v, u};
      float(*q)[CHUNK] = rows[set];
      vlCameraRays r = {q[0], q[1], q[2], q[3], q[4], q[5], q[6], q[7], q[8], q[9], q[10]};
      vl_camera_kernels(sets[set])->rays(&c, CHUNK, &s, &r);
      assert_memory_equal(rows[0], rows[set], sizeof rows[0]);
    }
    /* all rays of a pixel cross where the pinhole's ray meets the plane (or sphere) in focus;
     * the camera looks along -z with y up, so camera z = -z, y = -y */
    for (int i = 0; i < CHUNK; i++) {
      double o[3], d[3];
      assert_true(vl_camera_unproject(&camera, px[i] + 0.5, py[i] + 0.5, o, d));
      double ny = k < 2 ? tan(0.4) : 0, t = (4 + ny * o[1]) / (-d[2] - ny * d[1]);
      if (k == 2)
        t = 4;
      double p[3] = {o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]}, near = 0;
      const float(*q)[CHUNK] = (const float(*)[CHUNK])rows[0];
      for (int a = 0; a < 3; a++)
        near += (p[a] - q[a][i]) * q[3 + a][i];
      for (int a = 0; a < 3; a++)
        assert_true(fabs(q[a][i] + near * q[3 + a][i] - p[a]) < 3e-6 * (1 + t));
    }
  }
}

static void f_number_and_focus_point(void **state) {
  (void)state;
  vlCameraDef def = vl_default_camera_def(360, 240);
  def.focal_mm = 50;
  def.sensor_width_mm = 36;
  def.lens.f_number = 2;
  set3(def.eye, 1, 2, 3);
  set3(def.lookat, 1, 2, -3);
  set3(def.lens.focus_point, 4, 0, -1.5);
  vlCamera camera = make_or_fail(&def);
  assert_true(fabs(camera.lens_radius - 0.0125) < 1e-15);
  assert_true(fabs(camera.focus_distance - 4.5) < 1e-12);
  def.lens_radius = 0.0125; /* agrees */
  make_or_fail(&def);
  /* only the sensor's width is given: the focal length follows from the field of view */
  def.focal_mm = VL_UNSET;
  def.fov = 2 * atan(18.0 / 50);
  def.fov_axis = VL_FOV_HORIZONTAL;
  assert_true(fabs(make_or_fail(&def).lens_radius - 0.0125) < 1e-12);
  /* the tilted plane contains the point, too; spheres of focus have the point's distance as
   * radius */
  def.lens.tilt_x = 0.3;
  camera = make_or_fail(&def);
  assert_true(fabs(camera.focus_distance - (4.5 + tan(0.3) * 2)) < 1e-12);
  def.lens.tilt_x = 0;
  def.lens_radius = 0;
  def.projection = VL_PROJECTION_EQUIDISTANT;
  camera = make_or_fail(&def);
  assert_true(fabs(camera.focus_distance - sqrt(9 + 4 + 4.5 * 4.5)) < 1e-12);
}

static void exposure_by_the_cameras_numbers(void **state) {
  (void)state;
  vlCameraDef def = vl_default_camera_def(360, 240);
  def.lens.f_number = 16;
  def.lens.iso = 100;
  def.lens.seconds = 0.01;
  vlCamera camera = make_or_fail(&def);
  /* sunny 16: EV 14.64 */
  double ev = log2(16.0 * 16 / 0.01);
  assert_true(fabs(camera.exposure_time * 1.2 * exp2(ev) - 1) < 1e-12);
  assert_true(camera.lens_radius == 0); /* without a focal length it speaks of exposure alone */
  def.lens.seconds = VL_UNSET;
  def.shutter_open = 1;
  def.shutter_close = 1.02;
  assert_true(fabs(make_or_fail(&def).exposure_time / camera.exposure_time - 2) < 1e-12);
}

static void vignetting_is_cos4(void **state) {
  (void)state;
  static float film[16], rows[11][16];
  static int32_t px[16], py[16];
  for (int k = 0; k < 2; k++) {
    vlCameraDef def = vl_default_camera_def(300, 200);
    def.lens.vignetting = true;
    def.fov = 1;
    if (k) {
      def.distortion = VL_DISTORTION_RADIAL;
      def.distortion_count = 1;
      def.distortion_coefficients[0] = -0.05;
    }
    vlCamera camera = make_or_fail(&def);
    vlCameraCompiled c;
    vl_camera_compile(&camera, &c);
    assert_true(vl_camera_weighted(&c));
    for (int i = 0; i < 16; i++) {
      film[i] = 0.25f;
      px[i] = 17 * i + 3;
      py[i] = 11 * i;
    }
    vlCameraSamples s = {film, film, px, py, film, film, film};
    vlCameraRays r = {rows[0], rows[1], rows[2], rows[3], rows[4], rows[5],
                      rows[6], rows[7], rows[8], rows[9], rows[10]};
    vl_camera_kernels(VL_ISA_BASE)->rays(&c, 16, &s, &r);
    for (int i = 0; i < 16; i++)
      assert_true(fabs(rows[10][i] - pow(rows[5][i], 4)) < 1e-6); /* looks along -z */
  }
}

/* Models that see only what lies ahead are cut by planes. */
static void planes_of_the_orthographic_fisheye(void **state) {
  (void)state;
  static float film[16], rows[10][16];
  static int32_t px[16], py[16];
  for (int k = 0; k < 2; k++) {
    vlCameraDef def = vl_default_camera_def(300, 300);
    def.projection = k ? VL_PROJECTION_FOV : VL_PROJECTION_SINE;
    if (k)
      def.shape[0] = 0.9;
    def.near_plane = 2;
    def.far_plane = 5;
    vlCamera camera = make_or_fail(&def);
    vlCameraCompiled c;
    vl_camera_compile(&camera, &c);
    for (int i = 0; i < 16; i++) {
      film[i] = 0.25f;
      px[i] = 60 + 10 * i;
      py[i] = 80 + 9 * i;
    }
    vlCameraSamples s = {film, film, px, py, film, film, film};
    vlCameraRays r = {rows[0], rows[1], rows[2], rows[3], rows[4], rows[5],
                      rows[6], rows[7], rows[8], rows[9], NULL};
    vl_camera_kernels(VL_ISA_BASE)->rays(&c, 16, &s, &r);
    for (int i = 0; i < 16; i++)
      assert_true(fabs(-rows[5][i] * rows[6][i] - 2) < 1e-6 &&
                  fabs(-rows[5][i] * rows[7][i] - 5) < 1e-6);
  }
}

static void pixels_of_focus_move_with_the_size(void **state) {
  (void)state;
  vlCameraDef def = vl_default_camera_def(300, 200);
  def.lens.focus_pixel[0] = 75;
  def.lens.focus_pixel[1] = 150;
  vlCamera camera = make_or_fail(&def), larger;
  assert_true(camera.lens.focus_pixel[0] == 75);
  assert_int_equal(vl_camera_resize(&camera, 600, 400, &larger), VL_OK);
  assert_true(larger.lens.focus_pixel[0] == 150 && larger.lens.focus_pixel[1] == 300);
}

static void refused(const char *what, const char *also, const vlCameraDef *def) {
  vlCamera camera;
  vlError error;
  assert_int_equal(vl_camera_make(def, &camera, NULL, &error), VL_ERROR_ARGUMENT);
  if (!strstr(error.message, what) || !strstr(error.message, also) ||
      strchr(error.message, '\n'))
    fail_msg("\"%s\" does not say \"%s\" and \"%s\"", error.message, what, also);
}
#define REFUSED(change, what, also)                  \
  do {                                               \
    vlCameraDef d = vl_default_camera_def(320, 240); \
    change;                                          \
    refused(what, also, &d);                         \
  } while (0)

static void wrong_lenses(void **state) {
  (void)state;
  REFUSED(d.lens.f_number = 2, "f_number 2", "focal length");
  REFUSED((d.focal_mm = 50, d.sensor_width_mm = 36, d.lens.f_number = 2, d.lens_radius = 1),
          "0.0125", "lens_radius is 1");
  REFUSED((d.focal_mm = 50, d.lens.f_number = 2), "focal_mm is given", "sensor_width_mm");
  REFUSED((d.projection = VL_PROJECTION_ORTHOGRAPHIC, d.lens.f_number = 2), "f_number 2",
          "focal length");
  REFUSED(d.lens.blades = 2, "2 blades", "3 to 32");
  REFUSED((d.lens.tilt_x = 0.1, d.lens.lens_tilt_y = 0.1), "tilt_x 0.1", "lens_tilt_y 0.1");
  REFUSED(d.lens.lens_tilt_y = 0.1, "focal length", "focal_mm");
  REFUSED((d.projection = VL_PROJECTION_EQUIDISTANT, d.lens.tilt_x = 0.1), "tilted plane",
          "equidistant");
  REFUSED((d.projection = VL_PROJECTION_EQUIDISTANT, d.lens.vignetting = true), "vignetting",
          "equidistant");
  REFUSED(d.lens.focus_point[0] = 1, "focus_point", "all of its numbers");
  REFUSED(set3(d.lens.focus_point, 0, 0, 1), "focus_point", "not before the camera");
  REFUSED((set3(d.lens.focus_point, 0, 0, -2), d.focus_distance = 3), "of 2",
          "focus_distance is 3");
  REFUSED((d.lens.focus_pixel[0] = 1, d.lens.focus_pixel[1] = 1, d.focus_distance = 3),
          "focus_pixel", "focus_distance");
  REFUSED((d.lens.focus_pixel[0] = 400, d.lens.focus_pixel[1] = 1), "focus_pixel 400, 1",
          "320 x 240");
  REFUSED(d.lens.iso = 100, "iso 100", "f_number");
  REFUSED(d.lens.seconds = 1, "seconds 1", "iso");
  REFUSED((d.lens.iso = 100, d.lens.f_number = 8, d.exposure_time = 2), "exposure_time 2",
          "iso 100");
  REFUSED((d.lens.iso = 100, d.lens.f_number = 8, d.shutter_close = 0), "0 seconds", "iso 100");
}

/* Each allocation in turn fails: the failure is reported, and no memory leaks. */
static int fails_at, calls;
static void *allocate(void *user, size_t size) {
  (void)user;
  return calls++ == fails_at ? NULL : malloc(size);
}
static void release(void *user, void *block) {
  (void)user;
  free(block);
}
static void no_memory(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.allocator = (vlAllocator){NULL, allocate, release};
  def.threads = 1;
  vlContext *c;
  fails_at = -1;
  assert_int_equal(vl_context_create(&def, &c), VL_OK);
  size_t before = vl_context_memory(c, NULL);
  vlResult result = VL_ERROR_MEMORY;
  for (int at = 0; result != VL_OK; at++) {
    vlAperture *a;
    calls = 0;
    fails_at = at;
    assert_true(at < 20);
    result = vl_aperture_create_named(c, "star", &a, NULL);
    if (result == VL_OK)
      vl_aperture_destroy(a);
    else
      assert_int_equal(result, VL_ERROR_MEMORY);
    assert_int_equal(vl_context_memory(c, NULL), before);
  }
  fails_at = -1;
  vl_context_destroy(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blades_are_even),
      cmocka_unit_test(image_is_density),
      cmocka_unit_test(named_images),
      cmocka_unit_test(shapes_are_turned_and_squeezed),
      cmocka_unit_test(tilted_plane_is_sharp),
      cmocka_unit_test(three_planes_share_a_line),
      cmocka_unit_test(blur_off_the_tilted_plane),
      cmocka_unit_test(batches_hold_the_lens),
      cmocka_unit_test(f_number_and_focus_point),
      cmocka_unit_test(exposure_by_the_cameras_numbers),
      cmocka_unit_test(vignetting_is_cos4),
      cmocka_unit_test(planes_of_the_orthographic_fisheye),
      cmocka_unit_test(pixels_of_focus_move_with_the_size),
      cmocka_unit_test(wrong_lenses),
      cmocka_unit_test(no_memory),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
