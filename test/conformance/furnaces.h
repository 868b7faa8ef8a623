/* conformance/furnaces.h: the law of closed furnaces: in a room whose walls emit 3/4 and
 * reflect 1/4, the radiance is 1 everywhere and in each direction, whatever stands within that
 * absorbs nothing, by every tracer that finds all light, and in wavelengths, too. */
#ifndef TEST_CONFORMANCE_FURNACES_H
#define TEST_CONFORMANCE_FURNACES_H

#include "conformance.h"
#include "transport.h"
#include "unit.h"
#include "velo/tracer.h"

/* The ball fills most of the room and of the view. */
#define FURNACE \
  "LookAt 0 0 .95 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 70\n" VIEW("12")          \
  "Integrator \"path\" \"integer maxdepth\" 20 WorldBegin AttributeBegin\n"                  \
  "Material \"diffuse\" \"rgb reflectance\" [.25 .25 .25] AreaLightSource \"diffuse\" "      \
  "\"rgb L\" [.75 .75 .75] \"bool twosided\" true Shape \"trianglemesh\" \"point3 P\" "      \
  "[-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 1 1 1 1 -1 1 1] \"integer indices\" "       \
  "[0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 2 3 7 2 7 6 1 2 6 1 6 5 0 4 7 0 7 3] AttributeEnd\n" \
  "Material %s Shape \"sphere\" \"float radius\" .7\n"
#define WHITE "\"principled\" \"rgb basecolor\" [1 1 1] "
#define CLEAR WHITE "\"float metallic\" 0 "

/* What absorbs nothing. Dispersion: at its two surfaces in turn. */
static const char *const lossless[] = {
    CLEAR
    "\"float roughness\" 0 \"float transmission\" 1 \"float dispersion\" 2 "
    "\"bool thinwalled\" false",
    CLEAR "\"float roughness\" 0 \"float transmission\" 1",
    CLEAR "\"float roughness\" .5 \"float specular\" 0 \"float diffusetransmission\" .5",
    WHITE "\"float roughness\" .2 \"float anisotropy\" 1",
    "\"dielectric\" \"spectrum eta\" [360 1.6 560 1.55 830 1.5]",
    "\"dielectric\"",
    "\"thindielectric\"",
    "\"diffusetransmission\" \"rgb reflectance\" [.4 .4 .4] \"rgb transmittance\" [.6 .6 .6]",
};

/* The mean of the image by a tracer, in wavelengths. */
static Mean spectral_mean(const char *text, const char *tracer, uint32_t spp) {
  vlImage *image = image_in(VL_COLOR_SPECTRAL, text, tracer, VL_PIXEL_FILTER_BOX, spp);
  const Mean mean = mean_of_image(image);
  vl_image_destroy(image);
  return mean;
}

static void check_furnace(const char *tracer, const char *material, uint32_t spp,
                          double slack) {
  static char text[TEXT];
  char what[300];
  snprintf(text, sizeof text, FURNACE, material);
  const Mean mean = spectral_mean(text, tracer, spp);
  snprintf(what, sizeof what, "furnace with %.200s", material);
  check_mean("tracers", tracer, what, &mean, 1, (Sight){slack, slack + 0.08});
}

/* A point of light and the eye, each in the middle of a ball of glass, between two grey walls
 * that face each other: both parts of a path that meet between the walls have passed a surface
 * that disperses. */
#define TWO_BALLS \
  "LookAt 0 0 .6 0 0 -1 0 1 0 Camera \"perspective\" \"float fov\" 70\n" VIEW("12") \
  "Integrator \"path\" \"integer maxdepth\" 6 WorldBegin AttributeBegin Material \"diffuse\" " \
  "\"rgb reflectance\" [.5 .5 .5] Shape \"trianglemesh\" \"point3 P\" "                       \
  "[-4 -4 -1 4 -4 -1 4 4 -1 -4 4 -1 -4 -4 1 4 -4 1 4 4 1 -4 4 1] \"integer indices\" "       \
  "[0 1 2 0 2 3 4 6 5 4 7 6] AttributeEnd\n" \
  "Translate 0 0 .6 LightSource \"point\" \"point3 from\" [0 .7 -.6] Material \"dielectric\" "       \
  "%s Shape \"sphere\" \"float radius\" .2 Translate 0 .7 -.6 "    \
  "Shape \"sphere\" \"float radius\" .3\n"

/* Dispersion spreads wavelengths, and takes no light away. */
static void check_dispersed_light(const char *tracer, const TracerCase *c) {
  static char text[TEXT];
  static const char *const indices[] = {"\"float eta\" 1.55",
                                        "\"spectrum eta\" [360 1.6 560 1.55 830 1.5]"};
  Mean means[2];
  for (int dispersed = 0; dispersed < 2; dispersed++) {
    snprintf(text, sizeof text, TWO_BALLS, indices[dispersed]);
    means[dispersed] = spectral_mean(text, tracer, c->blurs ? 128 : 64);
  }
  const double whole = mean_of(&means[0]);
  if (!(whole > 1e-3))
    broken("tracers", tracer, "finds no light that has passed two balls of glass");
  check_same_mean("tracers", tracer, "dispersed light", &means[1], &means[0],
                  (Sight){0.03 * whole, (c->blurs ? 1.6 : 0.5) * whole});
}

static void laws_of_furnaces(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("tracers");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const TracerCase *c = tracer_cases[k];
    if (k == VL_TRACER_PATH || (c->room_spp && c->mirror.even > 0))
      check_furnace(family->rows[k]->name, lossless[0], c->blurs ? 64 : 256,
                    c->blurs ? 0.05 : 0.002);
    if (c->room_spp && c->mirror.even > 0 && k != VL_TRACER_VOLPATH)
      check_dispersed_light(family->rows[k]->name, c);
  }
  for (size_t i = 1; i < sizeof lossless / sizeof *lossless; i++)
    check_furnace("path", lossless[i], strstr(lossless[i], "spectrum") ? 256 : 64, 0.002);
  expect_no_failures();
}

#endif
