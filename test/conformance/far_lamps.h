/* conformance/far_lamps.h: the law of lamps that do not reach a point: whatever chooses lights
 * there, a floor has the light of the sky alone, however many lamps shine elsewhere. */
#ifndef TEST_CONFORMANCE_FAR_LAMPS_H
#define TEST_CONFORMANCE_FAR_LAMPS_H

#include "conformance.h"
#include "unit.h"

/* A floor below a sky that is brighter on one side. Lamps of each kind that has a place: below
 * the floor, or above it and turned away. */
static const char *const far_forms[] = {
    "AttributeBegin Translate %g -1 %g AreaLightSource \"diffuse\" \"rgb L\" [40 40 40] "
    "Shape \"sphere\" \"float radius\" .2 AttributeEnd\n",
    "AttributeBegin Translate %g -1 %g LightSource \"point\" \"rgb I\" [40 40 40] "
    "AttributeEnd\n",
    "AttributeBegin Translate %g 5 %g LightSource \"spot\" \"rgb I\" [40 40 40] "
    "\"point3 from\" [0 0 0] \"point3 to\" [0 1 0] AttributeEnd\n",
    "AttributeBegin Translate %g 5 %g Rotate -90 1 0 0 AreaLightSource \"diffuse\" "
    "\"rgb L\" [40 40 40] Shape \"disk\" \"float radius\" .2 AttributeEnd\n",
};
enum { FAR_FORMS = sizeof far_forms / sizeof *far_forms };

/* form: -1: no lamps. */
static Mean light_of_floor(const char *sampler, int form, int lamps) {
  static char text[TEXT];
  enum { SPP = 64 };
  size_t used = (size_t)snprintf(
      text, sizeof text,
      HEAD
      "Integrator \"path\" \"string lightsampler\" \"%s\" WorldBegin "
      "LightSource \"infinite\" \"string filename\" \"quarters.pfm\" "
      "Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-9 0 9 9 0 9 -9 0 -9 9 0 -9]\n",
      sampler);
  for (int i = 0; form >= 0 && i < lamps; i++)
    used +=
        (size_t)snprintf(text + used, sizeof text - used, far_forms[form], 1.0 + i, -0.5 * i);
  vlImage *image = image_of_floor(text, VL_TRACER_PATH, SPP, 0.3, -0.2, 0.1);
  Mean mean = mean_of_image(image);
  vl_image_destroy(image);
  return mean;
}

static void lamps_elsewhere(void **state) {
  (void)state;
  static const char *const samplers[] = {"bvh", "power", "uniform"};
  for (int s = 0; s < 3; s++) {
    const Mean alone = light_of_floor(samplers[s], -1, 0);
    for (int form = 0; form < FAR_FORMS; form++)
      for (int lamps = 1; lamps < 6; lamps += 2) {
        char what[100];
        const Mean mean = light_of_floor(samplers[s], form, lamps);
        const Sight sight = {.slack = 0, .least = 0.08 * mean_of(&alone)};
        snprintf(what, sizeof what, "%d lamps of form %d elsewhere", lamps, form);
        check_same_mean("lights", samplers[s], what, &mean, &alone, sight);
      }
  }
  expect_no_failures();
}

#endif
