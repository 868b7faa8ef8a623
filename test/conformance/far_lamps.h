/* conformance/far_lamps.h: laws of many lamps. Whatever chooses lights, a floor has the light
 * of the sky alone, however many lamps shine elsewhere; and it has the light of the end of
 * a row of spots, though the middle of the row does not shine there. However far away a lamp
 * is, its own surface does not stop the rays to it. */
#ifndef TEST_CONFORMANCE_FAR_LAMPS_H
#define TEST_CONFORMANCE_FAR_LAMPS_H

#include "conformance.h"
#include "unit.h"

/* A floor below a sky that is brighter on one side. Lamps of each kind that has a place, and
 * some without: below the floor, or above it and turned away. */
static const char *const far_forms[] = {
    "AttributeBegin Translate %g -1 %g AreaLightSource \"diffuse\" \"rgb L\" [40 40 40] "
    "Shape \"sphere\" \"float radius\" .2 AttributeEnd\n",
    "AttributeBegin Translate %g -1 %g LightSource \"point\" \"rgb I\" [40 40 40] "
    "AttributeEnd\n",
    "AttributeBegin Translate %g 5 %g LightSource \"spot\" \"rgb I\" [40 40 40] "
    "\"point3 from\" [0 0 0] \"point3 to\" [0 1 0] AttributeEnd\n",
    "AttributeBegin Translate %g 5 %g Rotate -90 1 0 0 AreaLightSource \"diffuse\" "
    "\"rgb L\" [40 40 40] Shape \"disk\" \"float radius\" .2 AttributeEnd\n",
    "LightSource \"distant\" \"point3 from\" [%g -1 %g] \"point3 to\" [0 0 0] "
    "\"rgb L\" [40 40 40]\n",
};
enum { FAR_FORMS = sizeof far_forms / sizeof *far_forms };

#define FAR_SKY "LightSource \"infinite\" \"string filename\" \"quarters.pfm\"\n"

/* form: of each other lamp, and the next form of those between them; -1: no lamps. The sky
 * comes after the first lamp. */
static Mean light_of_floor(const char *sampler, int form, int lamps) {
  static char text[TEXT];
  enum { SPP = 64 };
  size_t used = (size_t)snprintf(
      text, sizeof text,
      HEAD
      "Integrator \"path\" \"string lightsampler\" \"%s\" WorldBegin "
      "Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-9 0 9 9 0 9 -9 0 -9 9 0 -9]\n",
      sampler);
  for (int i = 0; form >= 0 && i < lamps; i++) {
    const char *lamp = far_forms[(form + i % 2) % FAR_FORMS];
    used += (size_t)snprintf(text + used, sizeof text - used, lamp, 1.0 + i, -0.5 * i);
    if (i == 0)
      used += (size_t)snprintf(text + used, sizeof text - used, FAR_SKY);
  }
  if (form < 0)
    snprintf(text + used, sizeof text - used, FAR_SKY);
  vlImage *image = image_of_floor(text, VL_TRACER_PATH, SPP, 0.3, -0.2, 0.1);
  Mean mean = mean_of_image(image);
  vl_image_destroy(image);
  return mean;
}

/* The light beside a row of spots that shine straight down. Only the first ones' cones reach
 * there. `cone` is half the opening of each other spot. A dim sky is there to be chosen, too.
 */
static Mean light_beside_row(const char *sampler, double turn, double cone) {
  static char text[TEXT];
  enum { SPP = 256, SPOTS = 5 };
  size_t used = (size_t)snprintf(
      text, sizeof text,
      HEAD
      "Integrator \"path\" \"string lightsampler\" \"%s\" WorldBegin "
      "LightSource \"infinite\" \"rgb L\" [.05 .05 .05] "
      "Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" [-9 0 9 9 0 9 -9 0 -9 9 0 -9] "
      "Rotate %g 0 1 0\n",
      sampler, turn);
  for (int i = 0; i < SPOTS; i++)
    used += (size_t)snprintf(
        text + used, sizeof text - used,
        "LightSource \"spot\" \"rgb I\" [4 4 4] \"float coneangle\" %g \"float conedeltaangle\" %g "
        "\"point3 from\" [%g 1 0] \"point3 to\" [%g 0 0]\n",
        i % 2 ? cone : 60, i % 2 ? cone : 60, 0.6 * i, 0.6 * i);
  const double angle = turn * PI / 180;
  vlImage *image = image_of_floor(text, VL_TRACER_PATH, SPP, -cos(angle), sin(angle), 0.05);
  Mean mean = mean_of_image(image);
  vl_image_destroy(image);
  return mean;
}

static void check_row(double turn, double cone) {
  static const char *const samplers[] = {"bvh", "power"};
  const Mean alike = light_beside_row("uniform", turn, cone);
  for (int s = 0; s < 2; s++) {
    const Mean mean = light_beside_row(samplers[s], turn, cone);
    const Sight sight = {.slack = 0, .min = 0.3 * mean_of(&alike)};
    check_same_mean("lights", samplers[s], "light beside a row", &mean, &alike, sight);
  }
}

static void lamps_in_a_row(void **state) {
  (void)state;
  for (double turn = 0; turn < 360; turn += 120) {
    check_row(turn, 60);
    check_row(turn, 15);
  }
  expect_no_failures();
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
        const Sight sight = {.slack = 0, .min = 0.08 * mean_of(&alone)};
        snprintf(what, sizeof what, "%d lamps of form %d elsewhere", lamps, form);
        check_same_mean("lights", samplers[s], what, &mean, &alone, sight);
      }
  }
  expect_no_failures();
}

/* ---- rays to lamps far away -------------------------------------------------------------- */

/* Lamps of each kind of shape, at the origin. */
static const char *const far_shapes[] = {
    "\"bool twosided\" true Shape \"sphere\" \"float radius\" 1",
    "Shape \"cylinder\" \"float radius\" 1",
    "\"bool twosided\" true Shape \"disk\" \"float radius\" 1",
    "\"bool twosided\" true Shape \"bilinearmesh\" \"point3 P\" [-1 -1 .2 1 -1 0 -1 1 0 1 1 .2]",
    "\"bool twosided\" true Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [-1 -1 0 1 -1 .3 0 1 0]",
};

typedef struct FarWays {
  double distance;
  vlTraceRays *rays;
  vlTraceHits *hits;
  vlTraceLights *lights;
  uint32_t sampled, stopped;
} FarWays;

/* Points of the floor, which is `distance` below the lamp. */
static void ask_ways(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  static const double down[3] = {0, 0, -1};
  static uint8_t occluded[VL_OWN_BATCH];
  FarWays *f = probe->user;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double origin[3] = {f->distance * (fmod(i * 0.7548776662, 1.0) - 0.5),
                              f->distance * (fmod(i * 0.5698402910, 1.0) - 0.5),
                              -0.9 * f->distance};
    set_ray(f->rays, i, origin, down);
  }
  vl_world_trace(trace, f->rays, f->hits);
  vl_trace_lights(trace, 0, f->lights);
  vl_world_occluded(trace, &f->lights->rays, occluded);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const bool sampled = f->lights->pdf[i] > 0 && f->lights->radiance[1][i] > 0;
    f->sampled += sampled;
    f->stopped += sampled && occluded[i];
  }
}

static void rays_to_lamps(void **state) {
  (void)state;
  FarWays f = {.rays = new_rays(),
               .hits = calloc(1, sizeof *f.hits),
               .lights = calloc(1, sizeof *f.lights)};
  for (size_t k = 0; k < sizeof far_shapes / sizeof *far_shapes; k++)
    for (f.distance = 3; f.distance < 1e7; f.distance *= 20) {
      char text[TEXT];
      Probe probe = {.ask = ask_ways, .user = &f};
      const double d = f.distance;
      snprintf(text, sizeof text,
               HEAD
               "WorldBegin Material \"diffuse\" Shape \"bilinearmesh\" \"point3 P\" "
               "[%g %g %g %g %g %g %g %g %g %g %g %g] AreaLightSource \"diffuse\" "
               "%s\n",
               -d, -d, -d, d, -d, -d, -d, d, -d, d, d, -d, far_shapes[k]);
      f.sampled = f.stopped = 0;
      probe_world(text, &probe, 2);
      if (f.sampled < VL_OWN_BATCH / 4 || f.stopped)
        broken("lights", "diffuse", "%s, %g away: the lamp stops %u of %u rays to it",
               far_shapes[k], d, f.stopped, f.sampled);
    }
  free(f.rays);
  free(f.hits);
  free(f.lights);
  expect_no_failures();
}

#endif
