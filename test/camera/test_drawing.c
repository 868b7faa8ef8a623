/* test/camera/test_drawing.c: vl_camera_outline: the lines of a pinhole camera are where its
 * numbers say; projectors go through the eye and meet the view plane in their image; of curved
 * projections all points are on rays of the camera; rigs; wrong defs. */
#include <math.h>
#include <string.h>

#include "unit.h"
#include "velo/distortion.h"
#include "velo/drawing.h"
#include "velo/projection.h"

static vlContext *context;

static int begin(void **state) {
  (void)state;
  vlContextDef def = vl_default_context_def();
  def.threads = 1;
  return vl_context_create(&def, &context) != VL_OK;
}

static int end(void **state) {
  (void)state;
  size_t held = vl_context_memory(context, NULL);
  vl_context_destroy(context);
  return held != 0;
}

/* At (1, 2, 3), looking along -z: a window of 8 x 6 at distance 5. */
static vlCamera pinhole(void) {
  vlCameraDef def = vl_default_camera_def(80, 60);
  const double eye[3] = {1, 2, 3}, lookat[3] = {1, 2, -10};
  memcpy(def.eye, eye, sizeof eye);
  memcpy(def.lookat, lookat, sizeof lookat);
  def.view_distance = 5;
  def.pixel_size = 0.1;
  vlCamera camera;
  assert_int_equal(vl_camera_make(&def, &camera, NULL, NULL), VL_OK);
  return camera;
}

static vlDrawing *draw(const vlCamera *cameras, uint32_t count, const vlDrawingDef *def) {
  vlDrawing *d = NULL;
  vlError error;
  if (vl_camera_outline(context, cameras, count, def, &d, &error) != VL_OK)
    fail_msg("%s", error.message);
  return d;
}

static uint32_t count_of(const vlDrawing *d, vlDrawingPart part) {
  uint32_t n = 0;
  for (uint32_t i = 0; i < d->line_count; i++)
    n += d->lines[i].part == part;
  return n;
}

static void near3(const double a[3], double x, double y, double z) {
  if (fabs(a[0] - x) > 1e-9 || fabs(a[1] - y) > 1e-9 || fabs(a[2] - z) > 1e-9)
    fail_msg("%.12g %.12g %.12g, not %g %g %g", a[0], a[1], a[2], x, y, z);
}

static void of_a_pinhole(void **state) {
  (void)state;
  vlCamera camera = pinhole();
  camera.near_plane = 2;
  camera.far_plane = 20;
  /* depth 20: its image is a quarter as far from the axis */
  const double points[3] = {3, 3, -17};
  vlDrawingDef def = vl_default_drawing_def();
  def.plane = 5;
  def.grid = 10;
  def.points = points;
  def.point_count = 1;
  def.parts |= 1u << VL_DRAWING_FILM;
  vlDrawing *d = draw(&camera, 1, &def);
  assert_int_equal(count_of(d, VL_DRAWING_WINDOW), 4);
  assert_int_equal(count_of(d, VL_DRAWING_NEAR), 4);
  assert_int_equal(count_of(d, VL_DRAWING_FAR), 4);
  assert_int_equal(count_of(d, VL_DRAWING_VOLUME), 4);
  assert_int_equal(count_of(d, VL_DRAWING_AXES), 3);
  /* every 10 pixels, on the window and the film */
  assert_int_equal(count_of(d, VL_DRAWING_GRID), 2 * (7 + 5));
  for (uint32_t i = 0; i < d->line_count; i++) {
    const vlDrawingLine *l = &d->lines[i];
    double depth = 3 - l->from[2], x = l->from[0] - 1, y = l->from[1] - 2;
    if (l->part == VL_DRAWING_WINDOW)
      assert_true(fabs(fabs(x) - 4) < 1e-9 && fabs(fabs(y) - 3) < 1e-9);
    if (l->part == VL_DRAWING_WINDOW)
      assert_true(fabs(depth - 5) < 1e-9);
    if (l->part == VL_DRAWING_NEAR)
      assert_true(fabs(depth - 2) < 1e-9 && fabs(fabs(x) - 1.6) < 1e-9);
    if (l->part == VL_DRAWING_FAR)
      assert_true(fabs(depth - 20) < 1e-9 && fabs(fabs(x) - 16) < 1e-9);
    if (l->part == VL_DRAWING_VOLUME)
      near3(l->from, 1, 2, 3);
  }
  int found = 0;
  for (uint32_t i = 0; i < d->label_count; i++) {
    const vlDrawingLabel *l = &d->labels[i];
    if (strcmp(l->text, "P'") == 0) {
      near3(l->at, 1.5, 2.25, -2);
      found++;
    }
    if (strcmp(l->text, "P") == 0) {
      near3(l->at, 3, 3, -17);
      found++;
    }
    if (strcmp(l->text, "e") == 0) {
      near3(l->at, 1, 2, 3);
      found++;
    }
    if (strcmp(l->text, "d") == 0) {
      near3(l->at, 1, 2, 0.5);
      found++;
    }
    if (strcmp(l->text, "u") == 0) {
      assert_true(l->at[0] > 1 && l->at[1] == 2);
      found++;
    }
    if (strcmp(l->text, "v") == 0) {
      assert_true(l->at[1] > 2);
      found++;
    }
    if (strcmp(l->text, "w") == 0) {
      assert_true(l->at[2] > 3);
      found++;
    }
  }
  assert_int_equal(found, 7);
  bool behind = false; /* on the film the image is upside down */
  for (uint32_t i = 0; i < d->line_count; i++)
    if (d->lines[i].part == VL_DRAWING_PROJECTOR && d->lines[i].to[2] > 7.9) {
      near3(d->lines[i].to, 0.5, 1.75, 8);
      behind = true;
    }
  assert_true(behind);
  vl_drawing_destroy(d);
}

/* All points of window and grid are at the distance `plane`, on rays of the camera. */
static void of_curved_projections(void **state) {
  (void)state;
  static const vlProjection kinds[] = {VL_PROJECTION_EQUIDISTANT, VL_PROJECTION_EQUIRECTANGULAR,
                                       VL_PROJECTION_PANINI};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
    vlCameraDef camera_def = vl_default_camera_def(90, 60);
    camera_def.projection = kinds[k];
    vlCamera camera;
    assert_int_equal(vl_camera_make(&camera_def, &camera, NULL, NULL), VL_OK);
    vlDrawingDef def = vl_default_drawing_def();
    def.plane = 3;
    vlDrawing *d = draw(&camera, 1, &def);
    assert_true(count_of(d, VL_DRAWING_GRID) > 100 && d->face_count > 100);
    for (uint32_t i = 0; i < d->line_count; i++) {
      const double *at = d->lines[i].from;
      if (d->lines[i].part != VL_DRAWING_GRID && d->lines[i].part != VL_DRAWING_WINDOW)
        continue;
      assert_true(fabs(sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]) - 3) < 1e-9);
    }
    vl_drawing_destroy(d);
  }
}

static void of_a_distorted_lens(void **state) {
  (void)state;
  vlCameraDef camera_def = vl_default_camera_def(80, 60);
  camera_def.distortion = VL_DISTORTION_RADIAL;
  camera_def.distortion_count = 1;
  camera_def.distortion_coefficients[0] = -0.1;
  camera_def.fx = camera_def.fy = 60;
  vlCamera camera;
  assert_int_equal(vl_camera_make(&camera_def, &camera, NULL, NULL), VL_OK);
  vlDrawing *d = draw(&camera, 1, NULL);
  double min = INFINITY, max = 0; /* barrel: the true window is a cushion */
  for (uint32_t i = 0; i < d->line_count; i++) {
    const vlDrawingLine *l = &d->lines[i];
    if (l->part != VL_DRAWING_WINDOW || fabs(l->from[1]) < fabs(l->from[0]) * 0.9)
      continue;
    assert_true(fabs(l->from[2] + 1) < 1e-9);
    min = fmin(min, fabs(l->from[1]));
    max = fmax(max, fabs(l->from[1]));
  }
  assert_true(min < 0.52 && max > 0.52 && max < 0.7);
  vl_drawing_destroy(d);
}

static void of_a_rig(void **state) {
  (void)state;
  vlCamera cameras[3];
  for (int i = 0; i < 3; i++) {
    cameras[i] = pinhole();
    cameras[i].world_from_camera[3] = i;
    assert_int_equal(
        vl_camera_move(&cameras[i], cameras[i].world_from_camera, &cameras[i], NULL), VL_OK);
  }
  vlDrawing *d = draw(cameras, 3, NULL);
  assert_int_equal(count_of(d, VL_DRAWING_PATH), 2);
  assert_int_equal(count_of(d, VL_DRAWING_WINDOW), 12);
  assert_int_equal(count_of(d, VL_DRAWING_AXES), 0);
  assert_true(d->low[0] < 0 && d->high[0] > 2);
  vl_drawing_destroy(d);
}

static void wrong_defs(void **state) {
  (void)state;
  vlCamera camera = pinhole();
  vlDrawing *d = NULL;
  vlDrawingDef def = vl_default_drawing_def();
  const double bad[3] = {0, NAN, 0};
  assert_int_equal(vl_camera_outline(context, &camera, 0, &def, &d, NULL), VL_ERROR_ARGUMENT);
  assert_int_equal(vl_camera_outline(context, NULL, 1, &def, &d, NULL), VL_ERROR_ARGUMENT);
  def.points = bad;
  def.point_count = 1;
  assert_int_equal(vl_camera_outline(context, &camera, 1, &def, &d, NULL), VL_ERROR_ARGUMENT);
  def = vl_default_drawing_def();
  def.plane = 0;
  assert_int_equal(vl_camera_outline(context, &camera, 1, &def, &d, NULL), VL_ERROR_ARGUMENT);
  assert_null(d);
  vl_drawing_destroy(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(of_a_pinhole),
                                     cmocka_unit_test(of_curved_projections),
                                     cmocka_unit_test(of_a_distorted_lens),
                                     cmocka_unit_test(of_a_rig), cmocka_unit_test(wrong_defs)};
  return cmocka_run_group_tests(tests, begin, end);
}
