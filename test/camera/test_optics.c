/* test/camera/test_optics.c: lenses of many elements: focal length, focus and magnification
 * against the equations, rays against an independent trace by Snell's law, brightness against
 * the pupil's area, projection and unprojection, files. */
#include "camera/context.h"

#include <stdio.h>
#include <unistd.h>

#include "camera/optics.h"
#include "camera/rays.h"
#include "velo/projection.h"

static const char double_gauss[] =
    VELO_SOURCE_DIR "/scenes/cameras/lenses/double_gauss_50mm.dat";
static const char single[] = VELO_SOURCE_DIR "/scenes/cameras/lenses/single_50mm.dat";

static vlOptics *load(const char *path, double aperture, double focus,
                      const vlAperture *image) {
  vlOpticsDef def = vl_default_optics_def();
  def.aperture_diameter = aperture;
  def.focus_distance = focus;
  def.aperture = image;
  vlOptics *optics = NULL;
  vlError error = {0};
  if (vl_optics_load(context, path, &def, &optics, &error) != VL_OK)
    fail_msg("%s: %s", path, error.message);
  return optics;
}

static vlCamera camera_with(const vlOptics *optics, uint32_t width, uint32_t height) {
  vlCameraDef def = vl_default_camera_def(width, height);
  def.projection = VL_PROJECTION_OPTICS;
  def.lens.optics = optics;
  set3(def.eye, 1, 2, 3);
  set3(def.lookat, 1, 2, -3);
  return make_or_fail(&def);
}

static void focal_lengths(void **state) {
  (void)state;
  vlOpticsInfo info;
  vlOptics *o = load(single, VL_UNSET, INFINITY, NULL);
  vl_optics_info(o, &info);
  /* the lensmaker's equation */
  double n = 1.52, r = 0.051, d = 0.004,
         f = 1 / ((n - 1) * (2 / r - (n - 1) * d / (n * r * r)));
  assert_true(fabs(info.focal_length - f) < 1e-12);
  assert_true(fabs(info.rear_principal - f) < 1e-12);
  vl_optics_destroy(o);
  o = load(double_gauss, VL_UNSET, INFINITY, NULL);
  vl_optics_info(o, &info);
  assert_true(fabs(info.focal_length - 0.05) < 0.0005);
  assert_true(fabs(info.f_number - 2) < 0.1);
  vl_optics_destroy(o);
  /* thin lens equation from the principal planes, whatever the distance */
  for (double distance = 0.5; distance < 1e7; distance *= 7) {
    o = load(double_gauss, VL_UNSET, distance, NULL);
    vl_optics_info(o, &info);
    vlOpticsInfo far;
    vlOptics *infinite = load(double_gauss, VL_UNSET, INFINITY, NULL);
    vl_optics_info(infinite, &far);
    double image = info.rear_principal, object = 1 / (1 / info.focal_length - 1 / image);
    /* object + image + distance of the planes = distance; the planes' distance does not
     * change */
    double planes = distance - object - image;
    assert_true(image > info.focal_length && fabs(planes) < 0.05 + 1e-9 * distance);
    assert_true(fabs((info.length - info.film_distance) - (far.length - far.film_distance)) <
                1e-12);
    vl_optics_destroy(infinite);
    vl_optics_destroy(o);
  }
}

static double norm3(const double a[3]) {
  return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* Written apart from the library: vectors, quadratic formula, Snell's law by angles. Axis z,
 * film at 0, millimetres of the prescription in metres. */
static bool plain_trace(const vlOptics *o, double p[3], double d[3]) {
  double z = o->info.film_distance;
  for (int i = (int)o->count - 1; i >= 0; i--) {
    const vlLensSurface *s = &o->given[i];
    double before = s->ior == 0 ? 1 : s->ior,
           behind = i > 0 && o->given[i - 1].ior != 0 ? o->given[i - 1].ior : 1;
    double opening = s->radius == 0 && o->def.aperture_diameter < s->aperture
                         ? o->def.aperture_diameter
                         : s->aperture;
    if (s->radius == 0) {
      double t = (z - p[2]) / d[2];
      for (int a = 0; a < 3; a++)
        p[a] += t * d[a];
    } else {
      double centre = z - s->radius / 1000, oc[3] = {p[0], p[1], p[2] - centre};
      double b = oc[0] * d[0] + oc[1] * d[1] + oc[2] * d[2];
      double disc = b * b - (oc[0] * oc[0] + oc[1] * oc[1] + oc[2] * oc[2]) +
                    s->radius * s->radius * 1e-6;
      if (disc <= 0)
        return false;
      double t0 = -b - sqrt(disc), t1 = -b + sqrt(disc), z0 = p[2] + t0 * d[2],
             z1 = p[2] + t1 * d[2];
      double t = fabs(z0 - z) < fabs(z1 - z) ? t0 : t1; /* the cap that is the lens */
      if (t < 0)
        return false;
      for (int a = 0; a < 3; a++)
        p[a] += t * d[a];
      double n[3] = {p[0], p[1], p[2] - centre}, length = norm3(n);
      double cosine = 0;
      for (int a = 0; a < 3; a++) {
        n[a] /= length;
        cosine += n[a] * d[a];
      }
      if (cosine < 0)
        for (int a = 0; a < 3; a++)
          n[a] = -n[a];
      cosine = fabs(cosine);
      double sine = sqrt(1 - cosine * cosine) * before / behind;
      if (sine >= 1)
        return false;
      double across[3];
      for (int a = 0; a < 3; a++)
        across[a] = d[a] - cosine * n[a];
      double width = norm3(across);
      for (int a = 0; a < 3; a++)
        d[a] = sqrt(1 - sine * sine) * n[a] + (width > 0 ? sine * across[a] / width : 0);
    }
    if (p[0] * p[0] + p[1] * p[1] > opening * opening * 0.25e-6)
      return false;
    if (i > 0)
      z += o->given[i - 1].thickness / 1000;
  }
  return true;
}

enum { N = 1024 };
static struct {
  float film_x[N], film_y[N], u[N], v[N], time[N], out[3][11][N];
  int32_t px[N], py[N];
} s;

static void draw(uint64_t seed, const vlCamera *camera) {
  for (int i = 0; i < N; i++) {
    s.px[i] = (int32_t)(next_unit(&seed) * camera->width);
    s.py[i] = (int32_t)(next_unit(&seed) * camera->height);
    s.film_x[i] = (float)next_unit(&seed);
    s.film_y[i] = (float)next_unit(&seed);
    s.u[i] = (float)next_unit(&seed) * 0.9999f;
    s.v[i] = (float)next_unit(&seed) * 0.9999f;
  }
}

static void run(vlIsa isa, const vlCamera *camera, float out[11][N]) {
  vlCameraCompiled c;
  vl_camera_compile(camera, &c);
  vlCameraSamples in = {s.film_x, s.film_y, s.px, s.py, s.u, s.v, s.time};
  vlCameraRays r = {out[0], out[1], out[2], out[3], out[4], out[5],
                    out[6], out[7], out[8], out[9], out[10]};
  vl_camera_kernels(isa)->rays(&c, N, &in, &r);
}

/* Each ray of a batch is found again by the plain trace: from the film point, through the point
 * of the pupil that is told by its weight's place; the world is mirrored into the camera's axes
 * (it looks along -z, y down). The same bits on all sets. */
static void batches_obey_snell(void **state) {
  (void)state;
  vlOptics *o = load(double_gauss, VL_UNSET, 2, NULL);
  vlCamera camera = camera_with(o, 360, 240);
  const vlIsa sets[] = {VL_ISA_BASE, VL_ISA_V3, VL_ISA_V4};
  int blocked = 0;
  for (uint64_t seed = 1; seed < 20; seed++) {
    draw(seed, &camera);
    for (int k = 0; k < 3; k++) {
      vlIsa got;
      if (vl_isa_choose(sets[k], &got) != VL_OK)
        continue;
      run(sets[k], &camera, s.out[k]);
      assert_memory_equal(s.out[0], s.out[k], sizeof s.out[0]);
    }
    double pitch = 0.035 / sqrt(360.0 * 360 + 240.0 * 240);
    for (int i = 0; i < N; i++) {
      float(*q)[N] = s.out[0];
      assert_true(q[9][i] == 1);
      if (q[10][i] == 0) {
        assert_true(q[7][i] == -1);
        blocked++;
        continue;
      }
      /* backwards is forwards: the ray that left, traced from the film point to where it came
       * from */
      double film[3] = {-pitch * (s.px[i] + (double)s.film_x[i] - 180),
                        -pitch * (s.py[i] + (double)s.film_y[i] - 120), 0};
      const vlPupil *p = &o->pupils[(int)(hypot(film[0], film[1]) / o->half * VL_PUPILS)];
      double a = 2.0 * s.u[i] - 1, b = 2.0 * s.v[i] - 1, r, phi, along, across;
      if (fabs(a) > fabs(b)) {
        r = a;
        phi = M_PI / 4 * (b / a);
      } else {
        r = b;
        phi = M_PI / 2 - M_PI / 4 * (a / b);
      }
      if (p->fill > 0) {
        a = p->fill * r * cos(phi);
        b = p->fill * r * sin(phi);
      }
      along = (p->x0 + p->x1) / 2 + (p->x1 - p->x0) / 2 * a;
      across = p->y1 * b;
      double f = hypot(film[0], film[1]), c = film[0] / f, w = film[1] / f;
      double d[3] = {c * along - w * across - film[0], w * along + c * across - film[1],
                     o->info.film_distance};
      double length = norm3(d);
      for (int k = 0; k < 3; k++)
        d[k] /= length;
      double cosine = d[2];
      if (!plain_trace(o, film, d))
        continue; /* at the very edge of an opening */
      double weight =
          pow(cosine, 4) * p->area / (o->info.film_distance * o->info.film_distance);
      assert_true(fabs(q[10][i] - weight) < 1e-5 * weight);
      assert_true(fabs(q[3][i] - d[0]) < 2e-6 && fabs(q[4][i] + d[1]) < 2e-6 &&
                  fabs(q[5][i] + d[2]) < 2e-6);
      double t = film[2] / d[2];
      assert_true(fabs(q[0][i] - 1 - (film[0] - t * d[0])) < 1e-6 &&
                  fabs(q[1][i] - 2 + (film[1] - t * d[1])) < 1e-6);
      assert_true(fabs(q[6][i] * -q[5][i] - o->info.length) < 1e-6 && isinf(q[7][i]));
    }
  }
  /* for all that the pupil is cut at f/2 */
  assert_true(blocked > 0 && blocked < 19 * N * 3 / 10);
  vl_optics_destroy(o);
}

/* In focus: the rays of a point in the middle of the film meet at the focus distance, closer
 * than out of it; and with a small opening they meet well. */
static void focuses_where_it_says(void **state) {
  (void)state;
  const double distances[] = {0.6, 2, 30};
  for (int k = 0; k < 3; k++) {
    vlOptics *o = load(double_gauss, 4, distances[k], NULL);
    vlCamera camera = camera_with(o, 3600, 2400);
    draw(4, &camera);
    for (int i = 0; i < N; i++) {
      s.px[i] = 1800;
      s.py[i] = 1200;
      s.film_x[i] = s.film_y[i] = 0;
    }
    run(VL_ISA_BASE, &camera, s.out[0]);
    double spread[3] = {0, 0, 0};
    for (int i = 0; i < N; i++)
      for (int m = 0; m < 3 && s.out[0][10][i] > 0; m++) {
        double z = distances[k] * (0.9 + 0.1 * m), t = z / -s.out[0][5][i];
        double dx = s.out[0][0][i] + t * s.out[0][3][i] - 1,
               dy = s.out[0][1][i] + t * s.out[0][4][i] - 2;
        spread[m] = fmax(spread[m], hypot(dx, dy));
      }
    assert_true(spread[1] < 5e-5 * distances[k] && spread[1] < spread[2]);
    if (k < 2)
      assert_true(spread[1] < 0.25 * spread[0] && spread[1] < 0.25 * spread[2]);
    vl_optics_destroy(o);
  }
}

/* The mean weight on the axis is the solid angle's share that the pupil fills: pi / (4 N'^2)
 * for the working f-number of a paraxial lens at infinity (camera equation), and it falls off
 * towards the corner. */
static void brightness(void **state) {
  (void)state;
  for (int k = 0; k < 3; k++) {
    vlOptics *o = load(double_gauss, 3 + 3 * k, INFINITY, NULL);
    vlCamera camera = camera_with(o, 300, 200);
    draw(6, &camera);
    double mean[2] = {0, 0};
    for (int corner = 0; corner < 2; corner++) {
      for (int i = 0; i < N; i++) {
        s.px[i] = corner ? 0 : 150;
        s.py[i] = corner ? 0 : 100;
        s.film_x[i] = s.film_y[i] = 0;
      }
      run(VL_ISA_BASE, &camera, s.out[0]);
      for (int i = 0; i < N; i++)
        mean[corner] += s.out[0][10][i] / N;
    }
    double number = o->info.f_number, expected = M_PI / (4 * number * number);
    if (fabs(mean[0] / expected - 1) > 0.04)
      fail_msg("f/%g: %g, not %g", number, mean[0], expected);
    assert_true(mean[1] < mean[0]);
    /* pupils hold what passes: random rays over a larger disc that get through lie in them */
    uint64_t seed = 9;
    for (int i = 0; i < 20000; i++) {
      double radius = next_unit(&seed) * o->half * 0.999,
             px = next_between(&seed, -0.015, 0.015), py = next_between(&seed, -0.015, 0.015);
      double p[3] = {radius, 0, 0}, d[3] = {px - radius, py, o->info.film_distance},
             length = norm3(d);
      for (int a = 0; a < 3; a++)
        d[a] /= length;
      if (!plain_trace(o, p, d))
        continue;
      const vlPupil *u = &o->pupils[(int)(radius / o->half * VL_PUPILS)];
      double ex = (px - (u->x0 + u->x1) / 2) / ((u->x1 - u->x0) / 2), ey = py / u->y1;
      if (u->fill > 0 ? hypot(ex, ey) > u->fill : fabs(ex) > 1 || fabs(ey) > 1)
        fail_msg("a ray passes outside the pupil");
    }
    vl_optics_destroy(o);
  }
}

static void both_ways(void **state) {
  (void)state;
  const char *const paths[] = {double_gauss, single};
  for (int k = 0; k < 2; k++) {
    vlOptics *o = load(paths[k], 8, 3, NULL);
    vlCamera camera = camera_with(o, 720, 480);
    uint64_t seed = 5;
    double pixels[2 * 300], origins[3 * 300], directions[3 * 300], points[3 * 300],
        back[2 * 300], z[300], worst = 0;
    uint8_t valid[300];
    for (int i = 0; i < 300; i++) {
      pixels[2 * i] = next_unit(&seed) * 720;
      pixels[2 * i + 1] = next_unit(&seed) * 480;
    }
    vl_camera_unproject_batch(&camera, 300, pixels, origins, directions, valid);
    for (int i = 0; i < 300; i++) {
      double o1[3], d1[3];
      assert_true(valid[i] &&
                  vl_camera_unproject(&camera, pixels[2 * i], pixels[2 * i + 1], o1, d1));
      assert_memory_equal(o1, origins + 3 * i, sizeof o1);
      assert_memory_equal(d1, directions + 3 * i, sizeof d1);
      double t = next_between(&seed, 0.3, 50);
      for (int a = 0; a < 3; a++)
        points[3 * i + a] = o1[a] + t * d1[a];
    }
    vl_camera_project_batch(&camera, 300, points, back, z, valid);
    for (int i = 0; i < 300; i++) {
      double pixel[2];
      assert_true(valid[i] && vl_camera_project(&camera, points + 3 * i, pixel, NULL));
      assert_memory_equal(pixel, back + 2 * i, sizeof pixel);
      worst =
          fmax(worst, hypot(back[2 * i] - pixels[2 * i], back[2 * i + 1] - pixels[2 * i + 1]));
    }
    if (!(worst < 1e-9))
      fail_msg("%s: %g pixels", paths[k], worst);
    double behind[3] = {1, 2, 4}, pixel[2];
    assert_false(vl_camera_project(&camera, behind, pixel, NULL));
    assert_true(vl_camera_solid_angle(&camera, 360, 240) > 0);
    vl_optics_destroy(o);
  }
}

/* Paraxial rays (height, angle) through the surfaces from the scene's side, written apart from
 * the library; metres. Focal length, and the principal planes' z, the first surface at 0. */
static double paraxial(const vlOptics *o, double *front, double *rear) {
  double m[2][2] = {{1, 0}, {0, 1}}, before = 1, length = 0;
  for (uint32_t i = 0; i < o->count; i++) {
    const vlLensSurface *g = &o->given[i];
    double behind = g->radius == 0 ? before : g->ior == 0 ? 1 : g->ior;
    double power = g->radius == 0 ? 0 : (behind - before) / (g->radius / 1000);
    double step = i + 1 < o->count ? g->thickness / 1000 : 0;
    for (int k = 0; k < 2; k++) {
      m[1][k] -= power * m[0][k]; /* index times angle */
      m[0][k] += step / behind * m[1][k];
    }
    before = behind;
    length += step;
  }
  double f = -1 / m[1][0];
  *front = f * (1 - m[1][1]);
  *rear = length - f * (1 - m[0][0]);
  return f;
}

/* Chief rays near the axis have the magnification f / (s - f) of the thin lens equation, s from
 * the front principal plane; further out, the difference is the lens's distortion. */
static void magnification_is_the_thin_lens_equation(void **state) {
  (void)state;
  const double distances[] = {0.4, 1, 3, 50};
  for (int k = 0; k < 8; k++) {
    double distance = distances[k / 2], front, rear;
    vlOptics *o = load(k % 2 ? double_gauss : single, 4, distance, NULL);
    vlCamera camera = camera_with(o, 720, 480);
    double f = paraxial(o, &front, &rear);
    assert_true(fabs(o->info.focal_length - f) < 1e-9);
    double object = distance - o->info.length + front, pitch = 0.035 / hypot(720, 480), got[3];
    /* the film is in focus: 1 / object + 1 / image = 1 / f */
    double image = o->info.length - rear;
    if (!(fabs(1 / object + 1 / image - 1 / f) < 1e-6))
      fail_msg("%g: not in focus", distance);
    const double fields[] = {1e-5, 0.06, 0.12}; /* height / distance */
    for (int i = 0; i < 3; i++) {
      double height = distance * fields[i], point[3] = {1 + height, 2, 3 - distance}, pixel[2];
      assert_true(vl_camera_project(&camera, point, pixel, NULL));
      got[i] = (pixel[0] - 360) * pitch / height * (object - f) / f - 1;
    }
    if (!(fabs(got[0]) < 1e-8))
      fail_msg("%g: magnification off by %g", distance, got[0]);
    assert_true(fabs(got[2]) < (k % 2 ? 0.003 : 0.01));
    /* third order: it grows as the square of the height */
    assert_true(fabs(got[2] / got[1] - 4) < 0.2);
    vl_optics_destroy(o);
  }
}

static void image_in_the_stop(void **state) {
  (void)state;
  vlAperture *square = NULL;
  assert_int_equal(vl_aperture_create_named(context, "square", &square, NULL), VL_OK);
  vlOptics *round = load(double_gauss, 6, 5, NULL), *o = load(double_gauss, 6, 5, square);
  double mean[2] = {0, 0};
  for (int k = 0; k < 2; k++) {
    vlCamera camera = camera_with(k ? o : round, 300, 200);
    for (uint64_t seed = 1; seed < 9; seed++) {
      draw(seed, &camera);
      for (int i = 0; i < N; i++) {
        s.px[i] = 150;
        s.py[i] = 100;
        s.film_x[i] = s.film_y[i] = 0;
      }
      run(VL_ISA_BASE, &camera, s.out[0]);
      for (int i = 0; i < N; i++)
        mean[k] += s.out[0][10][i] / N / 8;
    }
  }
  assert_true(fabs(mean[1] / mean[0] - 1) < 0.03); /* as bright as a round one */
  vl_optics_destroy(o);
  vl_optics_destroy(round);
  vl_aperture_destroy(square);
}

/* The exit pupil rotates with the film point, but an aperture polygon or image does not. Near
 * the axis all directions are equally bright, also for apertures with corners. (pbrt-v4 bounds
 * the pupil only for points to the right and cuts off corners elsewhere.) */
static void corners_of_the_opening_count(void **state) {
  (void)state;
  static float white[64 * 64];
  for (int i = 0; i < 64 * 64; i++)
    white[i] = 1;
  for (int shape = 0; shape < 3; shape++) {
    vlAperture *a = NULL;
    vlResult r =
        shape ? vl_aperture_create_named(context, shape == 1 ? "pentagon" : "star", &a, NULL)
              : vl_aperture_create(context, 64, 64, white, &a, NULL);
    assert_int_equal(r, VL_OK);
    vlOptics *o = load(double_gauss, 4, INFINITY, a),
             *round = load(double_gauss, 4, INFINITY, NULL);
    double mean[17] = {0};
    for (int k = 0; k < 17; k++) {
      vlCamera camera = camera_with(k < 16 ? o : round, 600, 600);
      for (uint64_t seed = 1; seed < 65; seed++) {
        draw(seed, &camera);
        for (int i = 0; i < N; i++) {
          double angle = 2 * M_PI * k / 16, x = 300 + 40 * cos(angle),
                 y = 300 + 40 * sin(angle);
          s.px[i] = (int32_t)x;
          s.py[i] = (int32_t)y;
          s.film_x[i] = (float)(x - s.px[i]);
          s.film_y[i] = (float)(y - s.py[i]);
        }
        run(VL_ISA_BASE, &camera, s.out[0]);
        for (int i = 0; i < N; i++)
          mean[k] += s.out[0][10][i] / N / 64;
      }
    }
    for (int k = 0; k < 16; k++)
      if (fabs(mean[k] / mean[16] - 1) > 0.012)
        fail_msg("shape %d, direction %d: %g times the round opening", shape, k,
                 mean[k] / mean[16]);
    vl_optics_destroy(o);
    vl_optics_destroy(round);
    vl_aperture_destroy(a);
  }
}

/* In the middle of the film the irradiance under a wall of radiance 1 is pi sin^2 of the cone
 * that comes through, found here by the marginal ray of a plain trace. pi / (4 N^2) is its
 * limit for small openings (and all of it under Abbe's sine condition) in focus at infinity;
 * the double Gauss, whose N is 2.03 wide open, has 1.0 % more. */
static void irradiance_in_the_middle(void **state) {
  (void)state;
  const double stops[] = {VL_UNSET, 8, 4, 1, VL_UNSET};
  double off[5];
  for (int k = 0; k < 5; k++) {
    vlOptics *o = load(double_gauss, stops[k], k == 4 ? 1 : INFINITY, NULL);
    vlCamera camera = camera_with(o, 300, 200);
    double low = 0, high = 1;
    for (int i = 0; i < 60; i++) {
      double sine = 0.5 * (low + high), p[3] = {0, 0, 0},
             d[3] = {sine, 0, sqrt(1 - sine * sine)};
      if (plain_trace(o, p, d))
        low = sine;
      else
        high = sine;
    }
    double mean = 0, exact = M_PI * low * low, number = o->info.f_number;
    for (uint64_t seed = 1; seed < 129; seed++) {
      draw(seed, &camera);
      for (int i = 0; i < N; i++) {
        s.px[i] = 150;
        s.py[i] = 100;
        s.film_x[i] = s.film_y[i] = 0;
      }
      run(VL_ISA_BASE, &camera, s.out[0]);
      for (int i = 0; i < N; i++)
        mean += s.out[0][10][i] / N / 128;
    }
    if (fabs(mean / exact - 1) > 4e-3)
      fail_msg("stop %g: %g, not %g", stops[k], mean, exact);
    off[k] = exact / (M_PI / (4 * number * number)) - 1;
    vl_optics_destroy(o);
  }
  if (fabs(off[0] - 0.0102) > 5e-4)
    fail_msg("wide open: %g", off[0]);
  assert_true(fabs(off[3]) < 2e-3 && fabs(off[3]) < fabs(off[2]) &&
              fabs(off[2]) < fabs(off[1]));
}

static void refocus_and_resize(void **state) {
  (void)state;
  vlOptics *o = load(double_gauss, 6, 5, NULL), *near = NULL,
           *again = load(double_gauss, 6, 1, NULL);
  assert_int_equal(vl_optics_refocus(context, o, 1, &near, NULL), VL_OK);
  assert_memory_equal(&near->info, &again->info, sizeof near->info);
  vlCamera camera = camera_with(o, 300, 200), twice;
  assert_int_equal(vl_camera_resize(&camera, 600, 400, &twice), VL_OK);
  double o1[3], d1[3], o2[3], d2[3];
  assert_true(vl_camera_unproject(&camera, 30, 20, o1, d1) &&
              vl_camera_unproject(&twice, 60, 40, o2, d2));
  for (int a = 0; a < 3; a++)
    assert_true(fabs(d1[a] - d2[a]) < 1e-12);
  assert_true(fabs(twice.fx / camera.fx - 2) < 1e-12);
  vl_optics_destroy(again);
  vl_optics_destroy(near);
  vl_optics_destroy(o);
}

static void wrong_file(const char *text, vlResult code, uint32_t line, const char *what) {
  char path[] = "/tmp/velo_lens_XXXXXX";
  int file = mkstemp(path);
  assert_true(file >= 0 && write(file, text, strlen(text)) == (ssize_t)strlen(text));
  close(file);
  vlOpticsDef def = vl_default_optics_def();
  vlOptics *o = NULL;
  vlError error = {0};
  vlResult result = vl_optics_load(context, path, &def, &o, &error);
  unlink(path);
  if (result != code || o || error.line != line || !strstr(error.message, what))
    fail_msg("\"%s\": %d at line %u: %s", text, result, error.line, error.message);
}

static void wrong_lenses(void **state) {
  (void)state;
  wrong_file("", VL_ERROR_SCENE, 1, "0 numbers");
  wrong_file("10 2 1.5 8\n10 2 x 8\n", VL_ERROR_SCENE, 2, "\"x\" is not a number");
  wrong_file("10 2 1.5\n", VL_ERROR_SCENE, 2, "3 numbers");
  wrong_file("10 2 nan 8\n", VL_ERROR_SCENE, 1, "\"nan\"");
  wrong_file("10 2 1.5 0\n", VL_ERROR_SCENE, 0, "surface 1");
  wrong_file("10 -2 1.5 8\n-10 0 1 8\n", VL_ERROR_SCENE, 0, "surface 1");
  wrong_file("10 2 0.5 8\n-10 0 1 8\n", VL_ERROR_SCENE, 0, "surface 1");
  wrong_file("0 2 0 8\n0 2 0 8\n", VL_ERROR_SCENE, 0, "2 aperture stops");
  wrong_file("0 2 0 8\n", VL_ERROR_SCENE, 0, "no refracting surface");
  wrong_file("-10 2 1.5 8\n10 0 1 8\n", VL_ERROR_SCENE, 0, "does not gather light");
  wrong_file("50 4 1.5 10\n-50 50 1 10\n0 1 0 0.5\n5 9 2 1\n", VL_ERROR_SCENE, 0, "lens");
  char many[65 * 12 + 1] = "";
  for (int i = 0; i < 65; i++)
    strcat(many, "9 1 1.5 8\n");
  wrong_file(many, VL_ERROR_SCENE, 65, "more than 64");
  vlOpticsDef def = vl_default_optics_def();
  vlOptics *o;
  vlError error;
  assert_int_equal(vl_optics_load(context, "/nowhere/lens.dat", &def, &o, &error),
                   VL_ERROR_MISSING);
  def.focus_distance = 0.1;
  assert_int_equal(vl_optics_load(context, double_gauss, &def, &o, &error), VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "the nearest"));
  def.focus_distance = 0;
  assert_int_equal(vl_optics_load(context, double_gauss, &def, &o, &error), VL_ERROR_SCENE);
  assert_non_null(strstr(error.message, "focus distance is 0"));
  vlCameraDef camera = vl_default_camera_def(30, 20);
  vlCamera made;
  camera.projection = VL_PROJECTION_OPTICS;
  assert_int_equal(vl_camera_make(&camera, &made, NULL, &error), VL_ERROR_ARGUMENT);
  camera.lens.optics = o = load(double_gauss, 6, 5, NULL);
  camera.fov = 1;
  assert_int_equal(vl_camera_make(&camera, &made, NULL, &error), VL_ERROR_ARGUMENT);
  assert_non_null(strstr(error.message, "fov"));
  vl_optics_destroy(o);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(focal_lengths),
      cmocka_unit_test(batches_obey_snell),
      cmocka_unit_test(focuses_where_it_says),
      cmocka_unit_test(brightness),
      cmocka_unit_test(both_ways),
      cmocka_unit_test(magnification_is_the_thin_lens_equation),
      cmocka_unit_test(image_in_the_stop),
      cmocka_unit_test(corners_of_the_opening_count),
      cmocka_unit_test(irradiance_in_the_middle),
      cmocka_unit_test(refocus_and_resize),
      cmocka_unit_test(wrong_lenses),
  };
  return cmocka_run_group_tests(tests, begin, end);
}
