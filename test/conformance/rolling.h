/* conformance/rolling.h: the law of rolling shutters: what moves is seen where it is when each
 * row is read, behind the border of a clear medium as without one. */
#ifndef TEST_CONFORMANCE_ROLLING_H
#define TEST_CONFORMANCE_ROLLING_H

#include "conformance.h"
#include "unit.h"

/* A black ball that moves across a bright sky while the image's rows are read; around it what
 * is given. */
static vlImage *image_by_rows(const char *around) {
  char text[TEXT];
  snprintf(text, sizeof text,
           HEAD
           "WorldBegin LightSource \"infinite\" \"rgb L\" [1 1 1] %s ObjectBegin \"o\" "
           "Material \"diffuse\" \"rgb reflectance\" [0 0 0] "
           "Shape \"sphere\" \"float radius\" .5 ObjectEnd "
           "AttributeBegin ActiveTransform EndTime Translate 2 0 0 ActiveTransform All "
           "Translate -1 .4 0 ObjectInstance \"o\" AttributeEnd",
           around);
  vlScene *scene = need_scene(text);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->build.color = VL_COLOR_RGB;
  defs->render.spp = 32;
  defs->camera.shutter_close = defs->camera.shutter_open + 0.01;
  defs->camera.readout = 1;
  return need_image(scene, text);
}

static void media_read_by_rows(void **state) {
  (void)state;
  vlImage *clear = image_by_rows("");
  vlImage *fog = image_by_rows(
      "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1e-6 1e-6 1e-6] "
      "\"rgb sigma_s\" [0 0 0] AttributeBegin MediumInterface \"m\" \"\" Material \"interface\" "
      "Translate 0 .4 0 Shape \"sphere\" \"float radius\" 3 AttributeEnd "
      "MediumInterface \"m\" \"m\"");
  double dark = 0;
  double apart = 0;
  for (uint32_t y = 0; y < vl_image_height(clear); y++)
    for (uint32_t x = 0; x < vl_image_width(clear); x++) {
      const double seen = (double)vl_image_get(clear, x, y, 1);
      dark += 1 - seen;
      apart += fabs((double)vl_image_get(fog, x, y, 1) - seen);
    }
  vl_image_destroy(clear);
  vl_image_destroy(fog);
  if (!(dark > 5 && apart < 1e-3 * dark))
    broken("tracers", "volpath", "read row by row: %.4f of %.4f is dark elsewhere", apart,
           dark);
  expect_no_failures();
}

#endif
