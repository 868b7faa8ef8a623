/* conformance/mirrored_textures.h: the law of widths behind mirrors: a flat mirror shows a
 * texture as blurred as it is from as far away without the mirror, and a ray that leaves a
 * surface is as wide as the one that came. */
#ifndef TEST_CONFORMANCE_MIRRORED_TEXTURES_H
#define TEST_CONFORMANCE_MIRRORED_TEXTURES_H

#include "conformance.h"
#include "transport.h"
#include "unit.h"

/* %s: the view; how often the image repeats, twice; what else there is. */
static const char *const far_texture =
    "LookAt %s 0 1 0 Camera \"perspective\" \"float fov\" 12\n" VIEW("64")
    "Integrator \"path\" \"integer maxdepth\" 2 WorldBegin\n"
    "LightSource \"distant\" \"point3 from\" [2 0 -1] \"point3 to\" [0 0 0]\n"
    "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"grain.pfm\" "
    "\"string filter\" \"trilinear\" \"float uscale\" %g \"float vscale\" %g "
    "Material \"diffuse\" \"texture reflectance\" \"t\"\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-2 -2 4 2 -2 4 -2 2 4 2 2 4]\n%s";
/* The mirror is in the middle between the eye and its own image. */
static const char *const seen_directly = "0 0 -2 0 0 4";
static const char *const seen_in_mirror = "0 0 2 0 0 0";
static const char *const far_mirror =
    "Material \"conductor\" \"float roughness\" 0 \"rgb reflectance\" [.9 .9 .9]\n"
    "Shape \"bilinearmesh\" \"point3 P\" [-.5 -.5 0 .5 -.5 0 -.5 .5 0 .5 .5 0]\n";

/* The standard deviation of the pixels over their mean. */
static double contrast(const char *view, double repeats, const char *more) {
  static char text[TEXT];
  snprintf(text, sizeof text, far_texture, view, repeats, repeats, more);
  vlImage *image = image_of(text, "path", 1);
  const Mean mean = mean_of_image(image);
  vl_image_destroy(image);
  return sqrt(variance_of_mean(&mean) * (mean.count - 1)) / mean_of(&mean);
}

static void check_mirrored_texture(double repeats) {
  const double direct = contrast(seen_directly, repeats, "");
  const double mirrored = contrast(seen_in_mirror, repeats, far_mirror);
  /* five standard errors of the ratio of two contrasts of 4,096 pixels */
  if (!(direct > 0.01 && fabs(mirrored / direct - 1) < 0.08))
    broken("tracers", "path", "a texture in a mirror has a contrast of %.4f, without it %.4f",
           mirrored, direct);
}

/* ---- widths after bounces ---------------------------------------------------------------- */

/* Rays of different widths, each other one beside the square. */
static void ask_widths(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  static const double down[3] = {0, 0, -1};
  uint32_t *others = probe->user;
  vlTraceRays *rays = new_rays();
  vlTraceHits *hits = calloc(1, sizeof *hits);
  vlTraceBounce *next = calloc(1, sizeof *next);
  assert_non_null(hits);
  assert_non_null(next);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    const double origin[3] = {i % 2 ? 5 : 0.1, 0.2, 1};
    set_ray(rays, i, origin, down);
    rays->width[i] = 1e-3f * (float)(i + 1);
  }
  vl_world_trace(trace, rays, hits);
  vl_trace_bounce(trace, 0, next);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    *others += next->pdf[i] > 0 && fabsf(next->rays.width[i] - rays->width[i]) > 1e-4f;
  free(rays);
  free(hits);
  free(next);
}

static void widths_after_bounces(void **state) {
  (void)state;
  uint32_t others = 0;
  Probe probe = {.ask = ask_widths, .user = &others};
  vlScene *scene = NULL;
  assert_int_equal(vl_scene_create(context, &scene), VL_OK);
  const vlMaterialDef diffuse = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  add_square(scene, &diffuse);
  probe_scene(scene, "a square", &probe, 1);
  if (others)
    broken("tracers", "own", "%u rays leave a plane with another width than they had", others);
  expect_no_failures();
}

static void textures_in_mirrors(void **state) {
  (void)state;
  check_mirrored_texture(24);
  check_mirrored_texture(32);
  expect_no_failures();
}

#endif
