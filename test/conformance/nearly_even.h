/* conformance/nearly_even.h: the law of an index that hardly varies: glass that disperses by a
 * millionth looks as glass that does not, also in coloured fog, where paths have lost
 * wavelengths in the fog and in the glass. */
#ifndef TEST_CONFORMANCE_NEARLY_EVEN_H
#define TEST_CONFORMANCE_NEARLY_EVEN_H

#include "conformance.h"
#include "furnaces.h"
#include "transport.h"
#include "unit.h"

/* A ball of glass in a box of fog before a bright sky. */
#define BALL_IN_FOG \
  "LookAt 0 0 3 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 26\n" VIEW("12") \
  "Integrator \"volpath\" \"integer maxdepth\" 8 WorldBegin LightSource \"infinite\"\n" \
  "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.1 .5 1.5] " \
  "\"rgb sigma_s\" [.8 .3 .1] \"float g\" .5 AttributeBegin MediumInterface \"fog\" \"\"\n" \
  "Material \"interface\" " BOX_FROM("-1", "1") "AttributeEnd\n" \
  "MediumInterface \"fog\" \"fog\" Material \"dielectric\" %s Shape \"sphere\" \"float radius\" .6\n"

enum { FOGGY_GLASS_SPP = 4096 };

static void nearly_even_indices(void **state) {
  (void)state;
  static char text[TEXT];
  static const char *const indices[] = {"\"float eta\" 1.5",
                                        "\"spectrum eta\" [360 1.500001 830 1.5]"};
  vlImage *images[2];
  for (int i = 0; i < 2; i++) {
    snprintf(text, sizeof text, BALL_IN_FOG, indices[i]);
    images[i] = image_in(VL_COLOR_SPECTRAL, text, NULL, VL_PIXEL_FILTER_BOX, FOGGY_GLASS_SPP);
  }
  const double whole = mean_of_green(images[0]);
  for (uint32_t c = 0; c < 3; c++) {
    char what[80];
    Mean off = {0};
    for (uint32_t i = 0; i < 12 * 12; i++)
      mean_add(&off, (double)vl_image_get(images[1], i % 12, i / 12, c) -
                         (double)vl_image_get(images[0], i % 12, i / 12, c));
    snprintf(what, sizeof what, "glass in coloured fog, channel %u", c);
    check_mean("tracers", "volpath", what, &off, 0, (Sight){0.002 * whole, 0.05 * whole});
  }
  vl_image_destroy(images[0]);
  vl_image_destroy(images[1]);
  expect_no_failures();
}

#endif
