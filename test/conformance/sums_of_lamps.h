/* conformance/sums_of_lamps.h: the law of several lamps: by every tracer that finds all light a
 * floor, a wall and a ball have the sum of the light of each lamp alone. Some points see one of
 * the two only, and some lamps are dark on one half. */
#ifndef TEST_CONFORMANCE_SUMS_OF_LAMPS_H
#define TEST_CONFORMANCE_SUMS_OF_LAMPS_H

#include "conformance.h"
#include "transport.h"
#include "unit.h"

/* %s: whatever chooses lights. The lens blurs, so that neighbouring samples see all of it. */
static const char *const lamps_form =
    "LookAt 0 2.4 3.2 0 .7 0 0 1 0 Camera \"perspective\" \"float fov\" 40 "
    "\"float lensradius\" .4 \"float focaldistance\" 1\n" VIEW("8")
    "Integrator \"path\" \"integer maxdepth\" 2 \"string lightsampler\" \"%s\"\n"
    "WorldBegin Material \"diffuse\" \"rgb reflectance\" [.6 .6 .6]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-2 0 2 2 0 2 -2 0 -2 2 0 -2]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-2 0 -1 2 0 -1 -2 4 -1 2 4 -1]\n"
    "AttributeBegin Translate 0 .5 0 Shape \"sphere\" \"float radius\" .5 AttributeEnd\n";

/* The shape is there whether or not it shines. */
static const struct {
  const char *place, *light, *shape;
} lamps_of_pairs[] = {
    {"", "LightSource \"infinite\" \"rgb L\" [.5 .5 .5]", ""},
    {"", "LightSource \"infinite\" \"string filename\" \"quarters.pfm\"", ""},
    {"Rotate 130 .6 .8 0",
     "LightSource \"infinite\" \"string filename\" \"sky.pfm\" \"float scale\" 6", ""},
    {"Translate -1 1.2 .4",
     "LightSource \"goniometric\" \"rgb I\" [1.5 1.5 1.5] \"string filename\" \"lamp.ies\"",
     ""},
    {"",
     "LightSource \"spot\" \"rgb I\" [4 4 4] \"point3 from\" [1.2 1.5 1] "
     "\"point3 to\" [0 .4 0] \"float coneangle\" 50",
     ""},
    {"Translate -1.2 .8 1 Rotate 35 0 1 0",
     "AreaLightSource \"diffuse\" \"float scale\" 3 \"string filename\" \"halves.pfm\"",
     "Shape \"trianglemesh\" \"point3 P\" [-.4 -.4 0 .4 -.4 0 .4 .4 0 -.4 .4 0] "
     "\"point2 uv\" [0 0 1 0 1 1 0 1] \"integer indices\" [0 2 1 0 3 2]"},
    {"Translate .2 1.3 .6 Rotate 90 1 0 0", "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9]",
     "Shape \"disk\" \"float radius\" .2"},
    {"Translate -.6 1.25 .5", "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9]",
     "Shape \"trianglemesh\" \"point3 P\" [-.15 0 -.15 .15 0 -.15 .15 0 .15 -.15 0 .15] "
     "\"integer indices\" [0 1 2 0 2 3]"},
    {"Translate 1.2 .3 .2", "AreaLightSource \"diffuse\" \"rgb L\" [6 6 6]",
     "Shape \"sphere\" \"float radius\" .15"},
};
enum { PAIR_LAMPS = sizeof lamps_of_pairs / sizeof *lamps_of_pairs };

/* on: a bit for each that shines. */
static vlImage *image_of_lamps(const char *tracer, const char *sampler, unsigned on,
                               uint32_t spp) {
  static char text[TEXT];
  size_t used = (size_t)snprintf(text, sizeof text, lamps_form, sampler);
  for (int i = 0; i < PAIR_LAMPS; i++)
    used +=
        (size_t)snprintf(text + used, sizeof text - used,
                         "AttributeBegin %s %s %s AttributeEnd\n", lamps_of_pairs[i].place,
                         on >> i & 1 ? lamps_of_pairs[i].light : "", lamps_of_pairs[i].shape);
  return image_of(text, tracer, spp);
}

static void check_sum(const char *tracer, const char *sampler, unsigned on,
                      vlImage *const alone[PAIR_LAMPS], uint32_t spp, Sight sight) {
  vlImage *all = image_of_lamps(tracer, sampler, on, spp);
  const uint32_t size = vl_image_width(all);
  Mean off = {0};
  double whole = 0;
  char what[100];
  for (uint32_t y = 0; y < size; y++)
    for (uint32_t x = 0; x < size; x++) {
      double sum = 0;
      for (int i = 0; i < PAIR_LAMPS; i++)
        if (on >> i & 1)
          sum += (double)vl_image_get(alone[i], x, y, 1);
      mean_add(&off, (double)vl_image_get(all, x, y, 1) - sum);
      whole += sum / (size * size);
    }
  snprintf(what, sizeof what, "%s: lamps 0x%x, off their sum of %.3f", sampler, on, whole);
  check_mean("lights", tracer, what, &off, 0, (Sight){sight.slack * whole, sight.min * whole});
  vl_image_destroy(all);
}

static void sums_of_lamps(void **state) {
  (void)state;
  enum { FIRST_WITH_PLACE = 3 };
  const vlKindFamily *family = vl_kind_family_find("tracers");
  vlImage *alone[PAIR_LAMPS];
  for (int i = 0; i < PAIR_LAMPS; i++)
    alone[i] = image_of_lamps("path", "power", 1u << i, 1024);
  for (int i = 0; i < PAIR_LAMPS; i++)
    for (int j = i + 1; j < PAIR_LAMPS; j++) /* those in the tree beside the sky */
      check_sum("path", "bvh", 1u << i | 1u << j | (i >= FIRST_WITH_PLACE), alone, 256,
                (Sight){0, 0.25});
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const TracerCase *c = tracer_cases[k];
    for (int i = 1; c->room_spp && i + 1 < PAIR_LAMPS; i += 2)
      check_sum(family->rows[k]->name, "power", 3u << i, alone, 512,
                (Sight){c->blurs ? 0.05 : 0, 0.3});
  }
  for (int i = 0; i < PAIR_LAMPS; i++)
    vl_image_destroy(alone[i]);
  expect_no_failures();
}

#endif
