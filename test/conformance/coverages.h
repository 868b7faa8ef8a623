/* conformance/coverages.h: the law of coverage: behind a plate on a transparent background an
 * image has the alpha 1, beside it 0, nowhere less or more, and on average the plate's share,
 * whatever the filter. */
#ifndef TEST_CONFORMANCE_COVERAGES_H
#define TEST_CONFORMANCE_COVERAGES_H

#include "conformance.h"
#include "unit.h"
#include "velo/filter_kinds.h"

/* A plate over .55 of the image's width; the camera sees from -1 to 1. */
static const char *const half_covered = HEAD
    "WorldBegin LightSource \"infinite\" Shape \"bilinearmesh\" "
    "\"point3 P\" [-2 -2 0 .1 -2 0 -2 2 0 .1 2 0]";

static void check_coverage(vlPixelFilterKind kind, const char *name, bool shared) {
  enum { SIDE_PIXELS = 24, SPP = 64, EDGE = 5 };
  vlScene *scene = need_scene(half_covered);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->camera = vl_default_camera_def(SIDE_PIXELS, SIDE_PIXELS);
  defs->camera.eye[2] = 1;
  defs->camera.fx = defs->camera.fy = SIDE_PIXELS / 2.0;
  defs->film = vl_default_film_def(SIDE_PIXELS, SIDE_PIXELS);
  defs->film.filter = vl_default_pixel_filter(kind);
  defs->render.transparent = true;
  defs->render.share_samples = shared;
  defs->render.spp = SPP;
  defs->render.max_depth = 1;
  vlImage *image = need_image(scene, half_covered);
  const uint32_t edge = (uint32_t)(0.55 * SIDE_PIXELS);
  double sum = 0;
  int outside = 0;
  int wrong = 0;
  for (uint32_t y = 0; y < SIDE_PIXELS; y++)
    for (uint32_t x = 0; x < SIDE_PIXELS; x++) {
      const double alpha = (double)vl_image_get(image, x, y, 3);
      sum += alpha / (SIDE_PIXELS * SIDE_PIXELS);
      outside += !(alpha >= 0 && alpha <= 1);
      wrong += (x + EDGE < edge && alpha < 0.9999) || (x > edge + EDGE && alpha > 1e-4);
    }
  if (outside || wrong || !(fabs(sum - 0.55) < 0.02))
    broken("filters", name, "%s: alpha %.4f on average, not 0.55; %d outside 0 to 1, %d wrong",
           shared ? "shared" : "own samples", sum, outside, wrong);
  vl_image_destroy(image);
}

static void coverages_of_filters(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("filters");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    check_coverage((vlPixelFilterKind)k, family->rows[k]->name, false);
    check_coverage((vlPixelFilterKind)k, family->rows[k]->name, true);
  }
  expect_no_failures();
}

#endif
