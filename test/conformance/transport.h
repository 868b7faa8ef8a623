/* conformance/transport.h: the laws of media (light is kept where nothing absorbs; emission and
 * surroundings in balance; known transmittance) and of tracers (known radiance of a tilted
 * plate below a sky and below a lamp). */
#ifndef TEST_CONFORMANCE_TRANSPORT_H
#define TEST_CONFORMANCE_TRANSPORT_H

#include "conformance.h"
#include "velo/medium.h"

/* The mean of green over the image, each pixel a number of its own. */
static Mean mean_image(const char *text, const char *tracer, uint32_t spp) {
  vlError error = {0};
  Mean mean = {0};
  vlScene *scene = load_text(context, text, &error);
  if (!scene)
    fail_msg("%s\n%s", error.message, text);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->build.color = VL_COLOR_RGB;
  defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  defs->render.spp = spp;
  const vlKindFamily *family = vl_kind_family_find("tracers");
  for (uint32_t k = 0; tracer && k < family->kind_count; k++)
    if (strcmp(family->rows[k]->name, tracer) == 0)
      defs->render.tracer = (vlTracer)k;
  vlImage *image = render_scene(context, scene, &error);
  if (!image)
    fail_msg("%s\n%s", error.message, text);
  for (uint32_t y = 0; y < vl_image_height(image); y++)
    for (uint32_t x = 0; x < vl_image_width(image); x++)
      mean_add(&mean, (double)vl_image_get(image, x, y, 1));
  vl_image_destroy(image);
  return mean;
}

#define VIEW(size)                                                              \
  "Film \"rgb\" \"integer xresolution\" " size " \"integer yresolution\" " size \
  " \"string filename\" \"x.pfm\"\n"                                            \
  "Sampler \"independent\" Integrator \"volpath\" \"integer maxdepth\" 200\n"

/* ---- media ------------------------------------------------------------------------------- */

/* The medium fills a box from -1 to 1, seen along z by parallel rays that all cross it from
 * front to back. */
static const char *const medium_form =
    "LookAt 0 0 3 0 0 0 0 1 0 Camera \"orthographic\" \"float screenwindow\" [-.5 .5 -.5 .5]\n" VIEW("16") "WorldBegin "
    "LightSource \"infinite\" \"rgb L\" [1 1 1] MakeNamedMedium \"m\" \"string type\" %s\n"
    "MediumInterface \"m\" \"\" Material \"interface\"\n"
    "Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 1 1 1 1 -1 1 1] \"integer "
    "indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 2 3 7 2 7 6 1 2 6 1 6 5 0 4 7 0 7 3]\n";

typedef struct MediumCase {
  const char *shape;    /* parameters of all variants */
  const char *scatters; /* nothing absorbs: what enters leaves */
  const char *glows;    /* absorbs, and emits what it absorbs of a sky of 1; null: cannot */
  const char *absorbs;  /* absorbs alone */
  double transmittance; /* of that; 0: not known, but below 1 */
  double glow;          /* where the emission fades at the box's sides; 0: 1 */
} MediumCase;

#define BOX "\"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1] "
#define BLOCKS BOX "\"integer nx\" 2 \"integer ny\" 2 \"integer nz\" 2 "
#define ONES "[1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1]"
#define NONE "[0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0]"
#define HALF_OF "[.5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5 .5]"
static const MediumCase homogeneous_medium = {
    .shape = "",
    .scatters = "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"float g\" .6",
    .glows =
        "\"rgb sigma_a\" [.7 .7 .7] \"rgb sigma_s\" [.5 .5 .5] \"rgb Le\" [.5 .5 .5] \"float "
        "Lescale\" 2",
    .absorbs = "\"rgb sigma_a\" [.2 .2 .2] \"rgb sigma_s\" [0 0 0] \"float scale\" 2",
    .transmittance = 0.44932896};
/* As of the next: exp(-.5 * 1.75). */
static const MediumCase grid_medium = {
    .shape = BLOCKS,
    .scatters =
        "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"float g\" -.5 \"float density\" [1 "
        ".5 "
        ".2 1 .7 .1 .4 .9]",
    .glows =
        "\"rgb sigma_a\" [.7 .7 .7] \"rgb sigma_s\" [.5 .5 .5] \"rgb Le\" [.5 .5 .5] \"float "
        "Lescale\" 2 \"float "
        "density\" [1 .5 .2 1 .7 .1 .4 .9]",
    .absorbs =
        "\"rgb sigma_a\" [.5 .5 .5] \"rgb sigma_s\" [0 0 0] \"float density\" [1 1 1 1 1 1 1 "
        "1]",
    .transmittance = 0.416862};
/* Le of these grids, as in pbrt, is in units of a constant spectrum's luminance, 106.857. It is
 * interpolated, too: both fade to half at the box's sides, w(z) = 1.5 - |z| from |z| = .5 on.
 * The integrals of that: */
static const MediumCase rgb_grid_medium = {
    .shape = BLOCKS,
    .scatters = "\"rgb sigma_a\" " NONE " \"rgb sigma_s\" " EIGHT_COLORS " \"float g\" .4",
    .glows = "\"rgb sigma_a\" " HALF_OF " \"rgb sigma_s\" " NONE " \"rgb Le\" " ONES
             " \"float Lescale\" .00935831",
    .absorbs = "\"rgb sigma_a\" " HALF_OF " \"rgb sigma_s\" " NONE,
    .transmittance = 0.416862,
    .glow = 0.942249};
static const MediumCase cloud_medium = {
    .shape = BOX "\"float density\" 3 ",
    .scatters = "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"float g\" .5",
    .absorbs = "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [0 0 0]"};
static const MediumCase nanovdb_medium = {
    .shape = "\"string filename\" \"a.nvdb\" \"float scale\" .003 ",
    .scatters = "\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 1] \"float g\" .5",
    .absorbs = "\"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [0 0 0]"};

#define MEDIUM_CASE(NAME, name) &name##_medium,
static const MediumCase *const medium_cases[] = {VL_MEDIUM_KINDS(MEDIUM_CASE)};

static Mean mean_medium(const char *kind, const MediumCase *c, const char *parameters,
                        uint32_t spp) {
  static char text[TEXT];
  char all[2000];
  snprintf(all, sizeof all, "%s%s", c->shape, parameters);
  scene_text(text, medium_form, kind, all);
  return mean_image(text, NULL, spp);
}

/* The light that passes without being scattered, where the medium scatters what it absorbs by
 * `absorbs`: no bounce. */
static Mean mean_unscattered(const char *kind, const MediumCase *c) {
  static char text[TEXT];
  char all[2000];
  snprintf(all, sizeof all, "%s%s", c->shape, c->absorbs);
  for (char *at = all; (at = strstr(at, "sigma_")); at += 7)
    at[6] = at[6] == 'a' ? 's' : 'a';
  scene_text(text, medium_form, kind, all);
  char *depth = strstr(text, "maxdepth\" 200");
  assert_non_null(depth);
  memcpy(strstr(depth, "200"), "  0", 3);
  return mean_image(text, NULL, 32);
}

static void laws_of_media(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("media");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const MediumCase *c = medium_cases[k];
    const char *name = family->rows[k]->name;
    assert_non_null(c->scatters);
    Mean kept = mean_medium(name, c, c->scatters, 32);
    if (!mean_is(&kept, 1, 2e-3))
      broken("media", name, "keeps %.4f of the light", mean_of(&kept));
    Mean balance = c->glows ? mean_medium(name, c, c->glows, 32) : kept;
    double glow = c->glow > 0 ? c->glow : 1;
    if (c->glows && !mean_is(&balance, glow, 2e-3))
      broken("media", name, "glows with %.4f of its surroundings' light, not %.4f",
             mean_of(&balance), glow);
    Mean passes = mean_medium(name, c, c->absorbs, 16);
    if (c->transmittance > 0 && !mean_is(&passes, c->transmittance, 2e-3))
      broken("media", name, "lets %.4f of the light pass, not %.4f", mean_of(&passes),
             c->transmittance);
    Mean unscattered = mean_unscattered(name, c);
    if (!mean_agrees(&unscattered, &passes, 2e-3))
      broken("media", name, "absorbs 1 - %.4f of the light, but scatters 1 - %.4f",
             mean_of(&passes), mean_of(&unscattered));
    if (!(mean_of(&passes) < 0.98 && mean_of(&passes) > 0.001))
      broken("media", name, "lets %.4f of the light pass", mean_of(&passes));
  }
  expect_no_failures();
}

/* ---- tracers ----------------------------------------------------------------------------- */

/* A plate that reflects half of the light, turned by 60 degrees from the eye. */
#define PLATE \
  "LookAt 0 0 3 0 0 0 0 1 0 Camera \"orthographic\" \"float screenwindow\" [-.1 .1 -.1 " \
  ".1]\n" VIEW("12") \
  "WorldBegin Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] AttributeBegin Rotate 60 1 0 0\n"   \
  "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0] AttributeEnd\n"

static const char *const below_sky = PLATE "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
/* The plate's normal is (0, -.866, .5). A ball of radius .5, two away along it, and radiance 4.
 */
static const char *const below_lamp = PLATE
    "Translate 0 -1.7320508 1 AreaLightSource \"diffuse\" \"rgb L\" [4 4 4] Material "
    "\"diffuse\" "
    "\"rgb "
    "reflectance\" [0 0 0] Shape \"sphere\" \"float radius\" .5\n";

typedef struct TracerCase {
  double sky, lamp; /* the plate's mean radiance */
  uint32_t spp;     /* 0: 64 */
} TracerCase;

/* below a sky of 1: half of it. Below the ball: .5 * 4 (.5 / 2)^2 */
#define TRANSPORT \
  { .sky = 0.5, .lamp = 0.125 }
static const TracerCase path_tracer = TRANSPORT;
static const TracerCase raycast_tracer = {
    .sky = 0.25, .lamp = 0.25}; /* the reflectance times the cosine to the eye */
static const TracerCase ambient_occlusion_tracer = {
    .sky = 1, .lamp = 1 - 0.0625}; /* the ball hides a 16th */
static const TracerCase volpath_tracer = TRANSPORT;
static const TracerCase bidirectional_tracer = TRANSPORT;
static const TracerCase merging_tracer = TRANSPORT;
static const TracerCase sppm_tracer = TRANSPORT;
static const TracerCase light_path_tracer = {.sky = 0.5, .lamp = 0.125, .spp = 512};
static const TracerCase random_walk_tracer = {.sky = 0.5, .lamp = 0.125, .spp = 1024};

#define TRACER_CASE(NAME, name) &name##_tracer,
static const TracerCase *const tracer_cases[] = {VL_TRACER_KINDS(TRACER_CASE)};

static void check_tracer(const char *name, const char *variant, const char *text, double known,
                         uint32_t spp) {
  Mean mean = mean_image(text, name, spp);
  if (!mean_is(&mean, known, 0.005 * known))
    broken("tracers", name, "%s: %.4f +- %.4f, not %.4f", variant, mean_of(&mean),
           sqrt(variance_of_mean(&mean)), known);
  if (!(sqrt(variance_of_mean(&mean)) < 0.02 * known))
    broken("tracers", name, "%s: too noisy a test", variant);
}

static void laws_of_tracers(void **state) {
  (void)state;
  static char uniform[TEXT];
  const vlKindFamily *family = vl_kind_family_find("tracers");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const char *name = family->rows[k]->name;
    uint32_t spp = tracer_cases[k]->spp ? tracer_cases[k]->spp : 64;
    check_tracer(name, "sky", below_sky, tracer_cases[k]->sky, spp);
    check_tracer(name, "lamp", below_lamp, tracer_cases[k]->lamp, spp);
    if (k != VL_TRACER_AMBIENT_OCCLUSION)
      continue;
    const char *rest = strstr(below_lamp, "WorldBegin");
    snprintf(uniform, sizeof uniform,
             "%.*s Integrator \"ambientocclusion\" \"bool cossample\" false\n%s",
             (int)(rest - below_lamp), below_lamp, rest);
    check_tracer(name, "uniform", uniform, tracer_cases[k]->lamp, spp);
  }
  expect_no_failures();
}

#endif
