/* test/lecture/test_words.c: the effect of each of the lecture's camera parameters on a
 * rendered image: d and zoom, roll, exposure time, clipping planes, thin lens. The scene is
 * that of property 1: four disks at distances 250, 500, 1000, 2000. */
#include "lecture/measure.h"

#include <string.h>

enum { W = 160, H = 120 };

static const double distance[4] = {250, 500, 1000, 2000}, centre_x[4] = {-70, 0, 160, 520};

static P2 disk_centre(const Image *p, int k) {
  return exact(p, (P3){centre_x[k], 0, 500 - distance[k]});
}

static double coverage_at(const Image *p, P2 at) {
  return coverage(p, ALPHA, (long)at.x, (long)at.y);
}

static bool same_pixels(const Image *a, const Image *b) {
  return memcmp(vl_image_const_pixels(a->image), vl_image_const_pixels(b->image),
                sizeof(float) * 4 * W * H) == 0;
}

static void change_zoom(vlCameraDef *def, const void *user) {
  const double *zoom_d_s = user;
  def->zoom = zoom_d_s[0];
  def->view_distance = zoom_d_s[1];
  def->pixel_size = zoom_d_s[2];
}

/* f = zoom d / s: parameters with the same f give the same bits, and twice the f gives twice
 * the size. */
static void zoom_d_and_s_are_one_number(void **state) {
  (void)state;
  const double ways[3][3] = {{2, 500, 1}, {1, 1000, 1}, {4, 62.5, 0.25}};
  Image plain = render_scene("property_1", W, H), p[3];
  for (int k = 0; k < 3; k++)
    p[k] = render_changed("property_1", W, H, change_zoom, ways[k]);
  assert_true(same_pixels(&p[0], &p[1]) && same_pixels(&p[0], &p[2]));
  assert_false(same_pixels(&p[0], &plain));
  /* the disk in the middle, measured along the row through its centre (row 60 begins there, so
   * the mean of two rows) */
  double width[2];
  for (int k = 0; k < 2; k++) {
    const Image *q = k ? &p[0] : &plain;
    double f = q->camera.fx, sum = 0;
    for (long x = 80 - (long)(0.1 * f); x <= 80 + (long)(0.1 * f); x++)
      sum += 0.5 * (coverage(q, ALPHA, x, 59) + coverage(q, ALPHA, x, 60));
    width[k] = sum;
  }
  assert_true(fabs(width[0] - 2 * 40 * plain.camera.fx / 500) < 0.1 &&
              fabs(width[1] / width[0] - 2) < 0.02);
  for (int k = 0; k < 3; k++)
    free_image(&p[k]);
  free_image(&plain);
}

static void change_exposure(vlCameraDef *def, const void *user) {
  def->exposure_time = *(const double *)user;
}

static void exposure_time_is_a_factor(void **state) {
  (void)state;
  const double four = 4;
  Image once = render_scene("property_1", W, H),
        p = render_changed("property_1", W, H, change_exposure, &four);
  const float *a = vl_image_const_pixels(once.image), *b = vl_image_const_pixels(p.image);
  for (int i = 0; i < W * H; i++) {
    for (int c = 0; c < 3; c++)
      assert_true(fabsf(b[4 * i + c] - 4 * a[4 * i + c]) <= 1e-5f * b[4 * i + c]);
    assert_true(a[4 * i + 3] == b[4 * i + 3]); /* alpha does not depend on the exposure */
  }
  assert_true(once.full[RED] > 0.5f);
  free_image(&once);
  free_image(&p);
}

static void change_planes(vlCameraDef *def, const void *user) {
  const double *planes = user;
  def->near_plane = planes[0];
  def->far_plane = planes[1];
}

/* The clipping planes cut at their z in camera space, not at that distance along the ray. */
static void clipping_planes(void **state) {
  (void)state;
  const double inside[2] = {249.99, 2000.01}, cut[2] = {250.01, 1999.99};
  Image plain = render_scene("property_1", W, H),
        all = render_changed("property_1", W, H, change_planes, inside),
        two = render_changed("property_1", W, H, change_planes, cut);
  assert_true(same_pixels(&plain, &all));
  for (int k = 0; k < 4; k++) {
    double seen = coverage_at(&two, disk_centre(&two, k));
    assert_true(seen == (k == 1 || k == 2 ? 1 : 0));
  }
  free_image(&plain);
  free_image(&all);
  free_image(&two);
}

static void change_roll(vlCameraDef *def, const void *user) {
  def->roll = *(const double *)user;
}

/* The camera is rolled clockwise by a quarter turn, so the image turns counterclockwise: the
 * third disk moves from the right to the top. */
static void roll_turns_the_image(void **state) {
  (void)state;
  const double quarter = 3.14159265358979323846 / 2;
  Image p = render_changed("property_1", W, H, change_roll, &quarter);
  P2 third = disk_centre(&p, 2);
  double f = p.camera.fx, area = 0, my = 0;
  assert_true(fabs(third.x - W / 2) < 1e-9 && fabs(third.y - (H / 2 - f * 160 / 1000)) < 1e-9);
  for (long y = 0; y < H; y++)
    for (long x = 0; x < W; x++)
      if (hypot((double)x + 0.5 - third.x, (double)y + 0.5 - third.y) < f * 40 / 1000 + 1.5) {
        area += coverage(&p, ALPHA, x, y);
        my += coverage(&p, ALPHA, x, y) * ((double)y + 0.5);
      }
  assert_true(fabs(area / (3.14159265358979323846 * pow(f * 40 / 1000, 2)) - 1) < 0.005);
  assert_true(fabs(my / area - third.y) < FITTED);
  free_image(&p);
}

static void change_lens(vlCameraDef *def, const void *user) {
  const double *radius_focus = user;
  def->lens_radius = radius_focus[0];
  def->focus_distance = radius_focus[1];
}

/* With the focus on the disk at 500, its edge is as sharp as the pinhole's; the disk at 250 has
 * a penumbra as wide as the circle of confusion at that distance, of diameter 2 R f |1/z -
 * 1/focus|. */
static void lens_blurs_what_is_out_of_focus(void **state) {
  (void)state;
  const double radius_focus[2] = {10, 500};
  Image sharp = render_scene("property_1", W, H),
        p = render_changed("property_1", W, H, change_lens, radius_focus);
  double f = p.camera.fx, blur = 2 * 10 * f * (1 / 250.0 - 1 / 500.0);
  for (int k = 0; k < 2; k++) {
    P2 c = disk_centre(&p, k);
    /* the edge that faces away from the other disks */
    double edge = c.x + f * 40 / distance[k] * (k == 0 ? -1 : 1);
    long around = k == 0 ? 7 : 4;
    /* the width of the penumbra: partly covered pixels in the row beside the centre */
    double partial = 0, partial_sharp = 0;
    for (long x = (long)edge - around; x <= (long)edge + around; x++) {
      double a = coverage(&p, ALPHA, x, 60), b = coverage(&sharp, ALPHA, x, 60);
      partial += a > 0.001 && a < 0.999;
      partial_sharp += b > 0.001 && b < 0.999;
    }
    assert_true(partial_sharp <= 2);
    if (k == 1)
      assert_true(partial <= 2);
    else
      assert_true(partial >= blur - 1.5 && partial <= blur + 2);
  }
  free_image(&sharp);
  free_image(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(zoom_d_and_s_are_one_number),
      cmocka_unit_test(exposure_time_is_a_factor),
      cmocka_unit_test(clipping_planes),
      cmocka_unit_test(roll_turns_the_image),
      cmocka_unit_test(lens_blurs_what_is_out_of_focus),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
