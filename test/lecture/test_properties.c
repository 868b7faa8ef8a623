/* test/lecture/test_properties.c: the lecture's six properties of perspective, measured in
 * rendered images and compared with the exact projection. The shapes are those of
 * scenes/lecture/property_1.pbrt to property_6.pbrt. */
#include "lecture/measure.h"

enum { W = 160, H = 120 };

static void near_to(const char *what, double measured, double expected, double tolerance) {
  if (!(fabs(measured - expected) <= tolerance))
    fail_msg("%s: measured %.4f, exact %.4f, off by %.4f, allowed %.4f", what, measured,
             expected, measured - expected, tolerance);
}

/* Property 1: the size of an object shrinks with its distance from the centre of projection: as
 * 1 / distance. */
static void size_goes_with_one_over_distance(void **state) {
  (void)state;
  Image p = render_scene("property_1", W, H);
  const double x[4] = {-70, 0, 160, 520}, z[4] = {250, 0, -500, -1500}, eye = 500, radius = 40;
  double size[4];
  for (int k = 0; k < 4; k++) {
    P2 centre = exact(&p, (P3){x[k], 0, z[k]});
    double expected = p.camera.fx * radius / (eye - z[k]), area = 0, mx = 0, my = 0;
    for (long j = (long)(centre.y - expected - 2); j <= (long)(centre.y + expected + 2); j++)
      for (long i = (long)(centre.x - expected - 2); i <= (long)(centre.x + expected + 2);
           i++) {
        double c = coverage(&p, ALPHA, i, j);
        area += c;
        mx += c * ((double)i + 0.5);
        my += c * ((double)j + 0.5);
      }
    /* An area sums the errors of 2 pi r edge pixels, independent and 0.005 each: the radius,
     * area' / (2 pi r), errs by 0.005 / sqrt(2 pi r), below 0.002 for all of them. */
    size[k] = sqrt(area / 3.14159265358979323846);
    near_to("radius", size[k], expected, 0.01);
    near_to("centre x", mx / area, centre.x, FITTED);
    near_to("centre y", my / area, centre.y, FITTED);
  }
  /* the law itself, from the measured sizes alone */
  for (int k = 1; k < 4; k++)
    near_to("size times distance", size[k] * (eye - z[k]) / (size[0] * (eye - z[0])), 1,
            0.01 / size[k]);
  free_image(&p);
}

/* Property 2: the width of an object's image shrinks as the object turns about the vertical. */
static void width_shrinks_with_rotation(void **state) {
  (void)state;
  Image p = render_scene("property_2", W, H);
  const double x[4] = {-170, -40, 75, 160}, angle[4] = {0, 30, 60, 75};
  double before = INFINITY;
  for (int k = 0; k < 4; k++) {
    double a = angle[k] * (3.14159265358979323846 / 180), side[2];
    for (int s = 0; s < 2; s++) {
      double h = s ? 50 : -50; /* Rotate about y: (h, y, 0) goes to (h cos, y, -h sin) */
      P2 top = exact(&p, (P3){x[k] + h * cos(a), 50, -h * sin(a)}),
         bottom = exact(&p, (P3){x[k] + h * cos(a), -50, -h * sin(a)});
      assert_true(fabs(top.x - bottom.x) < 1e-9); /* it stays upright */
      Edge e = measure_edge(&p, ALPHA, top, bottom, 20);
      Line l = fit_line(&e);
      side[s] = l.offset;
      near_to("side", l.offset, top.x, FITTED);
      near_to("upright", l.slope * l.length, 0, 2 * FITTED);
    }
    double width = side[1] - side[0];
    assert_true(width < before - 1);
    before = width;
    /* Foreshortening in closed form: the ends lie at distances D + s/2 sin and D - s/2 sin, so
     * the width is f (X + s/2 cos)/(D + s/2 sin) - f (X - s/2 cos)/(D - s/2 sin) with X, D the
     * middle and s = 100. */
    double f = p.camera.fx, D = 500;
    near_to("width", width,
            f * (x[k] + 50 * cos(a)) / (D + 50 * sin(a)) -
                f * (x[k] - 50 * cos(a)) / (D - 50 * sin(a)),
            2 * FITTED);
  }
  free_image(&p);
}

/* The parallelogram p, p + d, p + d + b, p + b: corners in the order of the scene files. */
typedef struct {
  P3 p, d, b;
} Strip;

static P3 corner(Strip s, int i) {
  switch (i & 3) {
    case 1:
      return add3(s.p, s.d);
    case 2:
      return add3(add3(s.p, s.d), s.b);
    case 3:
      return add3(s.p, s.b);
    default:
      return s.p;
  }
}

/* The two long edges of a strip, measured and fitted, each checked against the exact
 * projection. */
static void long_edges(const Image *p, int channel, Strip s, int at_least, Line lines[2]) {
  for (int k = 0; k < 2; k++) {
    P2 a = exact(p, corner(s, k ? 3 : 0)), b = exact(p, corner(s, k ? 2 : 1));
    Edge e = measure_edge(p, channel, a, b, at_least);
    double worst, mean;
    compare_edge(&e, a, b, &worst, &mean);
    near_to("edge, worst row", worst, 0, ONE_ROW);
    near_to("edge, mean", mean, 0, FITTED);
    lines[k] = fit_line(&e);
  }
}

/* Property 3: straight lines stay straight, however they lie in depth. */
static void straight_lines_stay_straight(void **state) {
  (void)state;
  Image p = render_scene("property_3", W, H);
  const Strip strips[3] = {{{-130, -110, 100}, {60, 230, -700}, {45, -10, 50}},
                           {{-40, -130, 120}, {420, 130, -700}, {20, 50, 40}},
                           {{5, 45, 200}, {-20, 220, -500}, {90, -20, 30}}};
  int edges = 0, rows = 0;
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 4; i++) {
      P2 a = exact(&p, corner(strips[k], i)), b = exact(&p, corner(strips[k], i + 1));
      if (hypot(b.x - a.x, b.y - a.y) < 14)
        continue; /* too short to measure straightness */
      Edge e = measure_edge(&p, ALPHA, a, b, 8);
      Line l = fit_line(&e);
      double worst, mean;
      compare_edge(&e, a, b, &worst, &mean);
      near_to("residual of the fitted line", l.worst, 0, ONE_ROW);
      near_to("worst distance from the exact line", worst, 0, ONE_ROW);
      near_to("mean distance from the exact line", mean, 0, FITTED);
      edges++;
      rows += e.count;
    }
  assert_true(edges >= 9 && rows >= 250);
  free_image(&p);
}

/* Property 4: lines parallel to the view plane keep their direction, whatever their depth; so
 * they stay parallel. */
static void parallels_to_the_view_plane_stay_parallel(void **state) {
  (void)state;
  Image p = render_scene("property_4", W, H);
  const Strip strips[5] = {{{-130, -60, 200}, {180, 240, 0}, {40, 0, 0}},
                           {{-130, -160, 100}, {180, 240, 0}, {40, 0, 0}},
                           {{-70, -220, -100}, {180, 240, 0}, {40, 0, 0}},
                           {{90, -340, -500}, {360, 480, 0}, {90, 0, 0}},
                           {{360, -360, -900}, {360, 480, 0}, {90, 0, 0}}};
  Line lines[10];
  for (int k = 0; k < 5; k++)
    long_edges(&p, ALPHA, strips[k], 30, &lines[2 * k]);
  for (int k = 0; k < 10; k++) {
    assert_false(lines[k].flat);
    /* direction (3, 4) with y up: x falls by 3/4 a row. The ends of a fitted line are known to
     * 2 x FITTED. */
    near_to("direction, at the line's ends", lines[k].slope * lines[k].length,
            -0.75 * lines[k].length, 2 * FITTED);
    for (int j = 0; j < k; j++)
      near_to("parallel", lines[k].slope * 100, lines[j].slope * 100, 0.15);
  }
  free_image(&p);
}

/* Where the lines of direction d vanish: the ray from the eye along d stays one point of the
 * image. */
static P2 vanishing_point(const Image *p, P3 d) {
  const double *m = p->camera.world_from_camera;
  return exact(p, add3((P3){m[3], m[7], m[11]}, d));
}

/* Property 5: parallel lines that are not parallel to the view plane meet in a vanishing
 * point. */
static void other_parallels_meet(void **state) {
  (void)state;
  Image p = render_scene("property_5", W, H);
  const P3 d = {-600, 450, -3000};
  const Strip strips[6] = {
      {{-130, -60, 300}, d, {30, -25, 0}}, {{-30, -75, 300}, d, {40, 0, 0}},
      {{60, -40, 300}, d, {18, 36, 0}},    {{70, 40, 300}, d, {0, 40, 0}},
      {{-30, 62, 260}, d, {30, 4, 0}},     {{-105, 10, 300}, d, {0, 36, 0}}};
  Line lines[12];
  for (int k = 0; k < 6; k++)
    long_edges(&p, ALPHA, strips[k], 8, &lines[2 * k]);
  P2 expected = vanishing_point(&p, d), point = meet(lines, 12);
  near_to("vanishing point, in closed form", expected.x, W / 2 - p.camera.fx / 5, 1e-9);
  /* Twelve lines from all sides, each known to FITTED where it was measured and twice that at
   * the point beyond. */
  near_to("vanishing point x", point.x, expected.x, 2 * FITTED);
  near_to("vanishing point y", point.y, expected.y, 2 * FITTED);
  /* not only on average: each line passes through it */
  for (int k = 0; k < 12; k++) {
    double along = lines[k].flat ? point.x : point.y,
           across = lines[k].flat ? point.y : point.x;
    near_to("line through the vanishing point",
            lines[k].offset + lines[k].slope * (along - lines[k].middle), across, 0.1);
  }
  free_image(&p);
}

/* Property 6: bundles parallel to the scene's axes meet in the principal vanishing points,
 * where rays from the eye along the axes pierce the view plane. */
static void axes_meet_in_principal_vanishing_points(void **state) {
  (void)state;
  Image p = render_scene("property_6", W, H);
  /* offsets from the eye in the two other axes, in the order (axis + 1, axis + 2), and the
   * strips' breadth */
  const double offset[3][4] = {{-66, 2, 0, -20}, {-48, -44, 14, -14}, {2, -66, -20, 0}};
  P2 v[3];
  for (int axis = 0; axis < 3; axis++) {
    Line lines[6];
    double d[3] = {0, 0, 0};
    d[axis] = -900;
    for (int k = 0; k < 3; k++) {
      double s[3] = {300, 300, 300}, b[3] = {0, 0, 0};
      s[axis] -= 90;
      s[(axis + 1) % 3] += offset[k][0];
      s[(axis + 2) % 3] += offset[k][1];
      b[(axis + 1) % 3] = offset[k][2];
      b[(axis + 2) % 3] = offset[k][3];
      long_edges(&p, axis, (Strip){{s[0], s[1], s[2]}, {d[0], d[1], d[2]}, {b[0], b[1], b[2]}},
                 6, &lines[2 * k]);
    }
    v[axis] = meet(lines, 6);
    P2 expected = vanishing_point(&p, (P3){d[0], d[1], d[2]});
    /* The strips come from one side and were measured over 10 to 20 rows, as far again from the
     * point: an error of a row (0.01) grows to about 0.01 x sqrt(12 / 15) x (20 / 15) for one
     * line, divided by sqrt(6) / sin(30 degrees) for the place where six lines within 60
     * degrees cross: 0.01 rms, 0.05 with room. */
    near_to("principal vanishing point x", v[axis].x, expected.x, 0.05);
    near_to("principal vanishing point y", v[axis].y, expected.y, 0.05);
  }
  /* The axes are at right angles, so from the three measured points alone follow the principal
   * point (the orthocentre of their triangle) and the focal length (Hartley and Zisserman,
   * Multiple View Geometry, 8.8): f^2 = -(v_i - c)(v_j
   * - c). */
  P2 c = {p.camera.cx, p.camera.cy};
  for (int k = 0; k < 3; k++) {
    P2 a = v[k], q = v[(k + 1) % 3], r = v[(k + 2) % 3];
    /* c lies on the height through a */
    double height = (a.x - c.x) * (q.x - r.x) + (a.y - c.y) * (q.y - r.y);
    near_to("principal point on the triangle's height", height / hypot(q.x - r.x, q.y - r.y), 0,
            0.1);
    double f2 = -((q.x - c.x) * (r.x - c.x) + (q.y - c.y) * (r.y - c.y));
    near_to("focal length from vanishing points", sqrt(f2), p.camera.fx, 0.1);
  }
  free_image(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(size_goes_with_one_over_distance),
      cmocka_unit_test(width_shrinks_with_rotation),
      cmocka_unit_test(straight_lines_stay_straight),
      cmocka_unit_test(parallels_to_the_view_plane_stay_parallel),
      cmocka_unit_test(other_parallels_meet),
      cmocka_unit_test(axes_meet_in_principal_vanishing_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
