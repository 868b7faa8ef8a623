/* conformance/mirror_depths.h: the law of depths behind mirrors. A wall that a mirror shows,
 * and a floor beside it, are as bright by the least limit of bounces that reaches both as by a
 * greater one. Other pixels see nothing, so that paths change their places in a batch. */
#ifndef TEST_CONFORMANCE_MIRROR_DEPTHS_H
#define TEST_CONFORMANCE_MIRROR_DEPTHS_H

#include "conformance.h"
#include "transport.h"
#include "unit.h"

/* From left to right: the floor, far below; the mirror, which shows the wall; nothing. Hardly
 * any light goes between wall and floor. %d: the limit. */
static const char *const mirror_and_floor =
    "LookAt 0 0 4 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 17\n" VIEW("12")
    "Integrator \"path\" \"integer maxdepth\" %d WorldBegin\n"
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [30 30 30] Translate 1 2 1 "
    "Shape \"sphere\" \"float radius\" .2 AttributeEnd\n"
    "Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" "
    "[-.6 -1 -1 -.15 -1 -1 -.6 1 -1 -.15 1 -1]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [3 -1 .5 3 -1 -.5 3 1 .5 3 1 -.5]\n"
    "Material \"conductor\" \"float roughness\" 0 \"rgb reflectance\" [.9 .9 .9]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-.15 -1 .15 .15 -1 -.15 -.15 1 .15 .15 1 -.15]\n";

static vlImage *image_of_depth(const char *tracer, int depth) {
  static char text[TEXT];
  snprintf(text, sizeof text, mirror_and_floor, depth);
  return image_of(text, tracer, 64);
}

static void check_mirror_depth(const char *tracer, const TracerCase *c) {
  vlImage *min = image_of_depth(tracer, c->mirrors_are_free ? 1 : 2);
  vlImage *greater = image_of_depth(tracer, 4);
  const Mean off = mean_difference(min, greater);
  const double whole = mean_of_green(greater);
  check_mean("tracers", tracer, "a wall in a mirror, by the least limit of bounces", &off, 0,
             (Sight){0.02 * whole, 0.15 * whole});
  if (!(whole > 0.01))
    broken("tracers", tracer, "sees %.4f of a wall in a mirror", whole);
  vl_image_destroy(min);
  vl_image_destroy(greater);
}

static void depths_behind_mirrors(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("tracers");
  for (uint32_t k = 0; k < family->kind_count; k++)
    if (tracer_cases[k]->room_spp && tracer_cases[k]->mirror.even > 0)
      check_mirror_depth(family->rows[k]->name, tracer_cases[k]);
  expect_no_failures();
}

#endif
