/* conformance/phases.h: the law of phase functions: light that a medium scatters once towards
 * the eye is brighter than that of an isotropic medium by the ratio of the phase functions, of
 * Henyey and Greenstein (1941) and 1 / (4 pi). */
#ifndef TEST_CONFORMANCE_PHASES_H
#define TEST_CONFORMANCE_PHASES_H

#include "conformance.h"
#include "transport.h"
#include "unit.h"

/* Parallel light, which turns by an angle whose cosine is %g on its way to the eye. */
static const char *const scattered_once =
    "LookAt 0 0 3 0 0 0 0 1 0 Camera \"orthographic\" \"float screenwindow\" [-.5 .5 -.5 .5]\n"
    VIEW("12") "Integrator \"volpath\" \"integer maxdepth\" 1\n"
    "WorldBegin LightSource \"distant\" \"point3 from\" [%g 0 %g] \"point3 to\" [0 0 0]\n"
    "MakeNamedMedium \"m\" \"string type\" \"%s\" %s%s\n"
    "MediumInterface \"m\" \"\" Material \"interface\"\n"
    BOX_FROM("-1", "1");

static vlImage *image_once_scattered(const char *kind, const MediumCase *c, double g,
                                     double cosine) {
  static char text[TEXT];
  char scatters[1000];
  const char *given = strstr(c->scatters, "\"float g\"");
  assert_non_null(given);
  const char *number = given + strlen("\"float g\"");
  char *rest;
  strtod(number, &rest);
  snprintf(scatters, sizeof scatters, "%.*s %g%s", (int)(number - c->scatters), c->scatters, g,
           rest);
  snprintf(text, sizeof text, scattered_once, -sqrt(1 - cosine * cosine), -cosine, kind,
           c->shape, scatters);
  return image_of(text, NULL, 32);
}

/* Both have the same random numbers, so that the ratio is nearly that of each pixel. */
static void check_phase(const char *kind, const MediumCase *c, double g, double cosine) {
  vlImage *even = image_once_scattered(kind, c, 0, cosine);
  vlImage *image = image_once_scattered(kind, c, g, cosine);
  const double ratio = (1 - g * g) / pow(1 + g * g - 2 * g * cosine, 1.5);
  Mean off = {0};
  double whole = 0;
  char what[100];
  for (uint32_t y = 0; y < vl_image_height(image); y++)
    for (uint32_t x = 0; x < vl_image_width(image); x++) {
      const double known = ratio * (double)vl_image_get(even, x, y, 1);
      mean_add(&off, (double)vl_image_get(image, x, y, 1) - known);
      whole += known / (vl_image_width(image) * vl_image_height(image));
    }
  snprintf(what, sizeof what, "g %g, cosine %g: off the light of %.4f", g, cosine, whole);
  check_mean("media", kind, what, &off, 0, (Sight){0.01 * whole, 0.05 * whole});
  vl_image_destroy(image);
  vl_image_destroy(even);
}

static void laws_of_phases(void **state) {
  static const double cases[][2] = {{0.97, 0.8}, {0.5, -0.3}, {-0.5, 0.6}, {-0.95, -0.7}};
  const vlKindFamily *family = vl_kind_family_find("media");
  (void)state;
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
      check_phase(family->rows[k]->name, medium_cases[k], cases[i][0], cases[i][1]);
  expect_no_failures();
}

#endif
