/* conformance/transport.h: the laws of media (light is kept where nothing absorbs; emission and
 * surroundings in balance; known transmittance) and of tracers (known radiance of a tilted
 * plate below a sky and below a lamp). */
#ifndef TEST_CONFORMANCE_TRANSPORT_H
#define TEST_CONFORMANCE_TRANSPORT_H

#include "../world/plain_noise.h"
#include "color/color.h"
#include "conformance.h"
#include "medium/medium.case.h"
#include "tracer/tracer.case.h"
#include "unit.h"
#include "velo/edit.h"
#include "velo/filter_kinds.h"
#include "velo/tracer.h"

/* The scene, to be rendered by a tracer (null: its own), in RGB or in wavelengths, and with a
 * pixel filter. */
static vlScene *scene_in(vlColorMode color, const char *text, const char *tracer,
                         vlPixelFilterKind filter, uint32_t spp) {
  vlScene *scene = need_scene(text);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->build.color = color;
  defs->film.filter = vl_default_pixel_filter(filter);
  defs->render.spp = spp;
  const vlKindFamily *family = vl_kind_family_find("tracers");
  for (uint32_t k = 0; tracer && k < family->kind_count; k++)
    if (strcmp(family->rows[k]->name, tracer) == 0)
      defs->render.tracer = (vlTracer)k;
  return scene;
}

static vlImage *image_in(vlColorMode color, const char *text, const char *tracer,
                         vlPixelFilterKind filter, uint32_t spp) {
  return need_image(scene_in(color, text, tracer, filter, spp), text);
}

static vlImage *filtered_image(const char *text, const char *tracer, vlPixelFilterKind filter,
                               uint32_t spp) {
  return image_in(VL_COLOR_RGB, text, tracer, filter, spp);
}

static vlImage *image_of(const char *text, const char *tracer, uint32_t spp) {
  return filtered_image(text, tracer, VL_PIXEL_FILTER_BOX, spp);
}

/* The mean of the differences of their pixels, whose true values may differ from each other. */
static Mean mean_difference(const vlImage *image, const vlImage *other) {
  Mean mean = {0};
  for (uint32_t y = 0; y < vl_image_height(image); y++)
    for (uint32_t x = 0; x < vl_image_width(image); x++)
      mean_add(&mean,
               (double)vl_image_get(image, x, y, 1) - (double)vl_image_get(other, x, y, 1));
  return mean;
}

#define VIEW(size)                                                              \
  "Film \"rgb\" \"integer xresolution\" " size " \"integer yresolution\" " size \
  " \"string filename\" \"x.pfm\"\n"                                            \
  "Sampler \"independent\" Integrator \"volpath\" \"integer maxdepth\" 200\n"

/* A box with these limits along x, and -1 to 1 along y and z; the outside faces out. */
#define BOX_FROM(low, high)                                                              \
  "Shape \"trianglemesh\" \"point3 P\" [" low " -1 -1 " high " -1 -1 " high " 1 -1 " low \
  " 1 -1 " low " -1 1 " high " -1 1 " high " 1 1 " low                                   \
  " 1 1] \"integer indices\" "                                                           \
  "[0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 2 3 7 2 7 6 1 2 6 1 6 5 0 4 7 0 7 3]\n"

/* ---- media ------------------------------------------------------------------------------- */

/* The medium fills a box from -1 to 1, seen along z by parallel rays that all cross it from
 * front to back. */
static const char *const medium_form =
    "LookAt 0 0 3 0 0 0 0 1 0 Camera \"orthographic\" \"float screenwindow\" [-.5 .5 -.5 .5]\n" VIEW("16") "WorldBegin "
    "LightSource \"infinite\" \"rgb L\" [1 1 1] MakeNamedMedium \"m\" \"string type\" %s\n"
    "MediumInterface \"m\" \"\" Material \"interface\"\n"
    BOX_FROM("-1", "1");

enum { MEDIUM_SPP = 384 };

static vlImage *image_of_medium(const char *kind, const MediumCase *c, const char *parameters) {
  static char text[TEXT];
  char all[2000];
  snprintf(all, sizeof all, "%s%s", c->shape, parameters);
  scene_text(text, medium_form, kind, all);
  return image_of(text, NULL, MEDIUM_SPP);
}
static Mean mean_medium(const char *kind, const MediumCase *c, const char *parameters) {
  vlImage *image = image_of_medium(kind, c, parameters);
  Mean mean = mean_of_image(image);
  vl_image_destroy(image);
  return mean;
}

/* The same in wavelengths. Light and medium are grey. */
static Mean mean_spectral(const char *kind, const MediumCase *c, const char *parameters) {
  static char text[TEXT];
  char all[2000];
  snprintf(all, sizeof all, "%s%s", c->shape, parameters);
  scene_text(text, medium_form, kind, all);
  vlImage *image = image_in(VL_COLOR_SPECTRAL, text, NULL, VL_PIXEL_FILTER_BOX, MEDIUM_SPP);
  Mean mean = mean_of_image(image);
  vl_image_destroy(image);
  return mean;
}

/* The light that passes without being scattered, where the medium scatters what it absorbs by
 * `absorbs`: no bounce. */
static vlImage *image_unscattered(const char *kind, const MediumCase *c) {
  static char text[TEXT];
  char all[2000];
  snprintf(all, sizeof all, "%s%s", c->shape, c->absorbs);
  for (char *at = all; (at = strstr(at, "sigma_")); at += 7)
    at[6] = at[6] == 'a' ? 's' : 'a';
  scene_text(text, medium_form, kind, all);
  char *depth = strstr(text, "maxdepth\" 200");
  assert_non_null(depth);
  memcpy(strstr(depth, "200"), "  0", 3);
  return image_of(text, NULL, MEDIUM_SPP);
}

/* The transmittance of a way through the box along z. */
static double passes_along_z(const MediumCase *c, double x, double y) {
  enum { STEPS = 64 };
  double sum = 0;
  for (int i = 0; i < STEPS; i++) {
    const double p[3] = {x, y, 2 * (i + 0.5) / STEPS - 1};
    sum += c->density(p, plain_noise) * 2 / STEPS;
  }
  return exp(-sum);
}

/* The mean transmittance of a pixel's ways: x grows to the left, y upwards. */
static double passes_pixel(const MediumCase *c, uint32_t width, uint32_t column, uint32_t row) {
  enum { STEPS = 3 };
  double sum = 0;
  for (int i = 0; i < STEPS * STEPS; i++) {
    const double right = (column + (i % STEPS + 0.5) / STEPS) / width - 0.5;
    const double down = (row + (i / STEPS + 0.5) / STEPS) / width - 0.5;
    sum += passes_along_z(c, -right, -down) / (STEPS * STEPS);
  }
  return sum;
}

/* The light that passes, in each quarter of the image, beyond what is known of each pixel. */
static void check_quarters(const char *name, const MediumCase *c, const vlImage *image) {
  uint32_t width = vl_image_width(image);
  uint32_t half = width / 2;
  for (uint32_t k = 0; k < 4; k++) {
    char what[80];
    Mean off = {0};
    for (uint32_t i = 0; i < half * half; i++) {
      const uint32_t column = k % 2 * half + i % half;
      const uint32_t row = k / 2 * half + i / half;
      mean_add(&off, (double)vl_image_get(image, column, row, 1) -
                         passes_pixel(c, width, column, row));
    }
    snprintf(what, sizeof what, "light that passes in quarter %u, beyond the known", k);
    check_mean("media", name, what, &off, 0, (Sight){.slack = 2e-3, .min = 0.035});
  }
}

/* Two descriptions of one medium give the same colours. */
static void check_alike(const char *name, const MediumCase *c) {
  vlImage *images[2];
  double worst = 0;
  for (int i = 0; i < 2; i++)
    images[i] = image_of_medium(name, c, c->alike[i]);
  for (uint32_t channel = 0; channel < 3; channel++) {
    double sums[2] = {0, 0};
    for (int i = 0; i < 2; i++)
      for (uint32_t y = 0; y < vl_image_height(images[i]); y++)
        for (uint32_t x = 0; x < vl_image_width(images[i]); x++)
          sums[i] += (double)vl_image_get(images[i], x, y, channel);
    worst = fmax(worst, fabs(sums[1] / sums[0] - 1));
  }
  vl_image_destroy(images[0]);
  vl_image_destroy(images[1]);
  if (!(worst < 2e-3))
    broken("media", name, "the same by another scale: colours differ by %.4f", worst);
}

/* A border in the middle of the box, behind which the medium goes on. */
#define MEDIUM_IN_TWO_PARTS \
  "MediumInterface \"m\" \"m\" Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0]\n"

/* Absorption by channel, as glTF has it (KHR_materials_volume): in wavelengths, too, exp(-scale
 * sigma x) of each channel of linear sRGB remains behind the box, whose way has two parts. */
static void check_channels(void) {
  static char text[TEXT];
  static const float sigma[3] = {0.1f, 0.3f, 0.6f};
  const double scale = 1.7;
  vlError error = {0};
  scene_text(text, medium_form, "homogeneous", "\"rgb sigma_s\" [0 0 0]");
  strcat(text, MEDIUM_IN_TWO_PARTS);
  vlScene *scene = need_scene(text);
  const vlMediumId id = {1};
  vlMediumDef medium = *vl_scene_medium(scene, id);
  medium.rgb_absorption = true;
  medium.sigma_a = vl_spectrum_rgb(sigma[0], sigma[1], sigma[2]);
  medium.scale = (float)scale;
  assert_int_equal(vl_scene_set_medium(scene, id, &medium, &error), VL_OK);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->build.color = VL_COLOR_SPECTRAL;
  defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  defs->render.spp = MEDIUM_SPP;
  vlImage *image = need_image(scene, text);
  for (uint32_t channel = 0; channel < 3; channel++) {
    char what[60];
    Mean passes = {0};
    for (uint32_t i = 0; i < vl_image_width(image) * vl_image_height(image); i++)
      mean_add(&passes, (double)vl_image_get(image, i % vl_image_width(image),
                                             i / vl_image_width(image), channel));
    snprintf(what, sizeof what, "absorption by channel: channel %u behind the box", channel);
    check_mean("media", "homogeneous", what, &passes, exp(-2 * scale * (double)sigma[channel]),
               (Sight){.slack = 3e-3, .min = 0.03});
  }
  vl_image_destroy(image);
}

static void check_medium(const char *name, const MediumCase *c) {
  const Sight sight = {.slack = 2e-3, .min = 0.02};
  Mean kept = mean_medium(name, c, c->scatters);
  check_mean("media", name, "light that is kept", &kept, 1, sight);
  if (c->emits) {
    Mean balance = mean_medium(name, c, c->emits);
    check_mean("media", name, "glow and surroundings", &balance,
               c->emission > 0 ? c->emission : 1, sight);
    Mean glow = mean_spectral(name, c, c->emits);
    check_same_mean("media", name, "glow and surroundings, by wavelengths", &glow, &balance,
                    (Sight){.slack = 3e-3, .min = 0.1});
  }
  if (c->emits_by_cell) {
    Mean by_cell = mean_medium(name, c, c->emits_by_cell);
    check_mean("media", name, "emission by a scale of each cell", &by_cell, c->emission_by_cell,
               sight);
  }
  vlImage *absorbing = image_of_medium(name, c, c->absorbs);
  vlImage *scattering = image_unscattered(name, c);
  Mean passes = mean_of_image(absorbing);
  Mean more = mean_difference(scattering, absorbing);
  if (c->density)
    check_quarters(name, c, absorbing);
  if (c->alike[0])
    check_alike(name, c);
  vl_image_destroy(absorbing);
  vl_image_destroy(scattering);
  Mean spectral = mean_spectral(name, c, c->absorbs);
  check_same_mean("media", name, "light that passes, by wavelengths", &spectral, &passes,
                  (Sight){.slack = 3e-3, .min = 0.1});
  if (c->transmittance > 0)
    check_mean("media", name, "light that passes", &passes, c->transmittance, sight);
  check_mean("media", name, "light that is not scattered, beyond what is not absorbed", &more,
             0, sight);
  if (c->layers) {
    static char text[TEXT];
    scene_text(text, medium_form, name, c->layers);
    vlImage *image = image_of(text, NULL, MEDIUM_SPP);
    Mean through = mean_of_image(image);
    vl_image_destroy(image);
    check_mean("media", name, "light that passes layers", &through, c->passes, sight);
  }
  if (!(mean_of(&passes) < 0.98 && mean_of(&passes) > 0.001))
    broken("media", name, "lets %.4f of the light pass", mean_of(&passes));
}

#define BAND_LIGHT "\"spectrum L\" [360 1 830 1] "
/* Seen through the medium: a sky; a plate that light reaches through the medium. */
static const char *const band_forms[] = {
    "LightSource \"infinite\" " BAND_LIGHT,
    "LightSource \"distant\" \"point3 from\" [0 0 3] " BAND_LIGHT
    "Material \"diffuse\" \"spectrum reflectance\" [360 1 830 1] "
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 2 1 3] "
    "\"point3 P\" [-1 -1 -2 1 -1 -2 -1 1 -2 1 1 -2] "};

/* The luminance of what is seen, without the medium or through it. */
static Mean luminance_of_band(const char *form, bool through) {
  static const double weights[3] = {0.212639, 0.715169, 0.072192};
  static char text[TEXT];
  snprintf(text, sizeof text,
           "LookAt 0 0 3 0 0 0 0 1 0 Camera \"orthographic\" "
           "\"float screenwindow\" [-.5 .5 -.5 .5]\n" VIEW("16") "WorldBegin %s %s",
           form,
           through
               ? "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"spectrum sigma_a\" "
                 "[360 90 524.9 90 525 0 550 0 550.1 90 830 90] "
                 "\"spectrum sigma_s\" [360 0 830 0]\n"
                 "MediumInterface \"m\" \"\" Material \"interface\"\n" BOX_FROM("-1", "1")
               : "");
  vlImage *image = image_in(VL_COLOR_SPECTRAL, text, NULL, VL_PIXEL_FILTER_BOX, MEDIUM_SPP);
  Mean mean = {0};
  for (uint32_t i = 0; i < 16 * 16; i++) {
    double luminance = 0;
    for (uint32_t c = 0; c < 3; c++)
      luminance += weights[c] * (double)vl_image_get(image, i % 16, i / 16, c);
    mean_add(&mean, luminance);
  }
  vl_image_destroy(image);
  return mean;
}

/* A medium that absorbs all but one band of wavelengths passes the band's share of the
 * luminance. */
static void check_band(void) {
  enum { FIRST = 525, LAST = 550 };
  const float *y = vl_cie_y();
  double share = 0;
  for (int k = FIRST; k <= LAST; k++) /* the trapezoids between its ends */
    share += (k == FIRST || k == LAST ? 0.5 : 1) * (double)y[k - VL_LAMBDA_MIN];
  double all = 0;
  for (int i = 0; i < VL_LAMBDA_COUNT; i++)
    all += (double)y[i];
  for (size_t i = 0; i < sizeof band_forms / sizeof *band_forms; i++) {
    const Mean plain = luminance_of_band(band_forms[i], false);
    const Mean mean = luminance_of_band(band_forms[i], true);
    const double known = mean_of(&plain) * share / all;
    check_mean("media", "homogeneous", "one band of wavelengths that passes", &mean, known,
               (Sight){0.02 * known, 0.15 * known});
  }
}

static void laws_of_media(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("media");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    assert_non_null(medium_cases[k]->scatters);
    check_medium(family->rows[k]->name, medium_cases[k]);
  }
  check_channels();
  check_band();
  expect_no_failures();
}

/* ---- tracers ----------------------------------------------------------------------------- */

/* A plate that reflects half of the light, turned by 60 degrees from the eye; its normal is
 * (0, -.866, .5). The eye is 100 away (a perspective camera, which light paths find) and sees a
 * square of 2.4 around the origin, which is nearly the whole plate. */
#define PLATE PLATE_OF("\"diffuse\" \"rgb reflectance\" [.5 .5 .5]")
#define PLATE_OF(material) PLATE_FACING("", material)
#define PLATE_FACING(side, material)                                                 \
  "LookAt 0 0 100 0 0 0 0 1 0 Camera \"perspective\" \"float fov\" 1.375033\n" VIEW( \
      "12") "WorldBegin Material " material " AttributeBegin " side                  \
            " Rotate 60 1 0 0\n"                                                     \
            "Shape \"bilinearmesh\" \"point3 P\" [-1.25 -2.5 0 1.25 -2.5 0 -1.25 2.5 0 1.25 2.5 0] AttributeEnd\n"

static const char *const below_sky = PLATE "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
/* A ball of radius .5, two away along the normal, and radiance 4. The plate's outside is on its
 * other side, which changes nothing. */
static const char *const below_lamp = PLATE_FACING("ReverseOrientation",
                                                   "\"diffuse\" \"rgb reflectance\" [.5 .5 .5]")
    "Translate 0 -1.7320508 1 AreaLightSource \"diffuse\" \"rgb L\" [4 4 4] "
    "Material \"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"sphere\" \"float radius\" .5\n";

enum { PLATE_SIDE = 12, PLATE_STEPS = 8, PLATE_EYE = 100 };

/* The part of the hemisphere, by the cosine, that the ball covers from the plate's point that
 * the eye sees at (x, y) of the plane z = 0: (r / d)^2 cos. */
static double ball_share(double x, double y) {
  y /= 1 + 1.7320508 * y / PLATE_EYE;
  x *= 1 - 1.7320508 * y / PLATE_EYE;
  const double to[3] = {-x, -1.7320508 - y, 1 - 1.7320508 * y};
  double d2 = to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
  double cosine = (-0.8660254 * to[1] + 0.5 * to[2]) / sqrt(d2);
  return 0.25 / d2 * cosine;
}

/* The mean of that over a pixel. */
static double ball_share_of_pixel(uint32_t column, uint32_t row) {
  double sum = 0;
  for (int j = 0; j < PLATE_STEPS; j++)
    for (int i = 0; i < PLATE_STEPS; i++)
      sum += ball_share(2.4 * ((column + (i + 0.5) / PLATE_STEPS) / PLATE_SIDE - 0.5),
                        2.4 * (0.5 - (row + (j + 0.5) / PLATE_STEPS) / PLATE_SIDE));
  return sum / (PLATE_STEPS * PLATE_STEPS);
}

/* The plate as a mirror: a metal that has no reflectance, but an index. */
#define MIRROR \
  "\"conductor\" \"spectrum eta\" [300 .001 900 .001] \"spectrum k\" [300 30 900 30]"
static const char *const mirrored_sky =
    PLATE_OF(MIRROR) "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

/* The kinds of tracers with what the plate looks like by them. */
#define TRACER_CASE(kind, name) &name##_tracer,
static const TracerCase *const tracer_cases[] = {VL_TRACER_KINDS(TRACER_CASE)};

/* A closed room whose lamp shines at the ceiling: nearly all light comes by two bounces and
 * more. */
static const char *const room_text =
    "LookAt 0 0 .9 0 0 -1 0 1 0 Camera \"perspective\" \"float fov\" 80\n" VIEW("12")
    "Integrator \"path\" \"integer maxdepth\" 3 WorldBegin Material \"diffuse\" \"rgb reflectance\" [.7 .7 .7]\n"
    BOX_FROM("-1", "1")
    "AreaLightSource \"diffuse\" \"rgb L\" [20 20 20] Shape \"bilinearmesh\" \"point3 P\" "
    "[-.2 .6 .2 .2 .6 .2 -.2 .6 -.2 .2 .6 -.2]\n";

enum { ROOM_SPP = 1024 };

/* Tracers that find the light of the room agree with the path tracer. */
static void check_room(const char *name, const vlImage *paths, const TracerCase *c) {
  vlImage *image = image_of(room_text, name, c->room_spp);
  Mean off = mean_difference(image, paths);
  double whole = mean_of_green(paths);
  vl_image_destroy(image);
  check_mean("tracers", name, "room", &off, 0,
             (Sight){(c->blurs ? 0.02 : 0.002) * whole, (c->blurs ? 0.1 : 0.06) * whole});
}

/* The mean over the image of what a pixel is beyond its known value, over the mean known. */
static void check_tracer(const char *name, const char *variant, const char *text, Plate plate,
                         const TracerCase *c) {
  vlImage *image = image_of(text, name, c->spp ? c->spp : 64);
  double min = c->least_of_lamp > 0 && plate.ball != 0 ? c->least_of_lamp : 0.03;
  Mean off = {0};
  Mean known = {0};
  for (uint32_t y = 0; y < PLATE_SIDE; y++)
    for (uint32_t x = 0; x < PLATE_SIDE; x++) {
      double value = plate.even + plate.ball * ball_share_of_pixel(x, y);
      mean_add(&known, value);
      mean_add(&off, (double)vl_image_get(image, x, y, 1) - value);
    }
  vl_image_destroy(image);
  double scale = mean_of(&known);
  check_mean("tracers", name, variant, &off, 0, (Sight){0.001 * scale, min * scale});
}

/* The sun stands above the plate: half of it. */
static const char *const below_sun = PLATE
    "LightSource \"distant\" \"point3 from\" [0 -.8660254 .5] \"point3 to\" [0 0 0] \"rgb L\" "
    "[3.1415927 3.1415927 3.1415927]\n";

/* The scene's text with further statements before its world, and with a seed. */
static void with_seed(const char *scene, const char *more, uint32_t seed, char text[TEXT]) {
  const char *rest = strstr(scene, "WorldBegin");
  snprintf(text, TEXT, "%.*s %s Sampler \"zsobol\" \"integer seed\" %u\n%s",
           (int)(rest - scene), scene, more, seed, rest);
}

/* The sun again, through a pane that reflects nothing, but that no connection passes. */
static const char *const below_pane = PLATE
    "LightSource \"distant\" \"point3 from\" [0 -.8660254 .5] \"point3 to\" [0 0 0] \"rgb L\" "
    "[3.1415927 3.1415927 3.1415927]\n"
    "Rotate 60 1 0 0 Material \"thindielectric\" \"float eta\" 1 Shape \"bilinearmesh\" "
    "\"point3 P\" [-9 -9 1 9 -9 1 -9 9 1 9 9 1]\n";

/* Merging alone finds light that passes a pane on both of its ways. The plate is even, so that
 * it does not matter how far merging blurs. Pixels share photons; images of other seeds do
 * not. */
static void check_merging(const char *name) {
  enum { SEEDS = 16, SPP_OF_PANE = 256 };
  Mean off = {0};
  for (uint32_t seed = 0; seed < SEEDS; seed++) {
    char text[TEXT];
    with_seed(below_pane, "", seed + 1, text);
    vlImage *image = image_of(text, name, SPP_OF_PANE);
    mean_add(&off, mean_of_green(image));
    vl_image_destroy(image);
  }
  check_mean("tracers", name, "pane", &off, 0.5, (Sight){0.002 * 0.5, 0.08 * 0.5});
}

/* The floor y = 0 below a pane, which lies below the camera; the sun stands above, where a
 * plate hides it from all points with x < 0. Merging alone finds its light. */
static const char *const below_edge = HEAD
    "WorldBegin LightSource \"distant\" \"point3 from\" [0 1 0] \"point3 to\" [0 0 0] "
    "\"rgb L\" [3.1415927 3.1415927 3.1415927]\n"
    "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] Shape \"bilinearmesh\" \"point3 P\" "
    "[-1.4 0 1.4 1.4 0 1.4 -1.4 0 -1.4 1.4 0 -1.4]\n"
    "Material \"thindielectric\" \"float eta\" 1 Shape \"bilinearmesh\" \"point3 P\" "
    "[-1.5 .1 1.5 1.5 .1 1.5 -1.5 .1 -1.5 1.5 .1 -1.5]\n"
    "Material \"diffuse\" \"rgb reflectance\" [0 0 0] Shape \"bilinearmesh\" \"point3 P\" "
    "[-1.5 .5 1.5 0 .5 1.5 -1.5 .5 -1.5 0 .5 -1.5]\n";

/* The mean radiance of the half of the view that lies in the shadow. */
static double light_in_shadow(vlTracer tracer, double radius, uint32_t passes, uint32_t seed) {
  enum { SIDE_OF_EDGE = 24 };
  double sum = 0;
  vlScene *scene = need_scene(below_edge);
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->build.color = VL_COLOR_RGB;
  look_down(&defs->camera, 0, 0, 2);
  defs->camera.width = defs->camera.height = SIDE_OF_EDGE;
  defs->camera.fx = defs->camera.fy = defs->camera.fx * SIDE_OF_EDGE / WIDTH;
  defs->film = vl_default_film_def(SIDE_OF_EDGE, SIDE_OF_EDGE);
  defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  defs->render.tracer = tracer;
  defs->render.merge_radius = radius;
  defs->render.spp = passes;
  defs->render.seed = seed;
  vlImage *image = need_image(scene, below_edge);
  for (uint32_t y = 0; y < SIDE_OF_EDGE; y++)
    for (uint32_t x = 0; x < SIDE_OF_EDGE / 2; x++)
      sum += (double)vl_image_get(image, x, y, 1);
  vl_image_destroy(image);
  return sum / (SIDE_OF_EDGE * SIDE_OF_EDGE / 2);
}

/* Merging blurs the edge by a disk of the radius that is given: of a disk of radius r, 2 r / (3
 * pi) is the mean depth of what reaches beyond a line through its middle. The radius of pass i
 * is r i^(-1/6) (Knaus and Zwicker 2011, with alpha = 2/3). */
static void check_radius(vlTracer tracer, const char *name) {
  enum { PASSES = 48, SEEDS = 8 };
  const double radius = 0.3;
  double mean_radius = 0;
  Mean found = {0};
  for (int i = 1; i <= PASSES; i++)
    mean_radius += radius * pow(i, -1.0 / 6) / PASSES;
  for (uint32_t seed = 0; seed < SEEDS; seed++)
    mean_add(&found, light_in_shadow(tracer, radius, PASSES, seed));
  const double known = 0.5 * 2 * mean_radius / (3 * PI);
  check_mean("tracers", name, "radius: light in the shadow", &found, known,
             (Sight){0.02 * known, 0.3 * known});
}

/* Light paths add their light to the pixels around the point where the camera sees their end,
 * by the filter: the image of an even plate stays as bright, where no light comes from beyond
 * the image's edge. A pixel's filter takes light from its neighbours, so pixels are not
 * independent; images of other seeds are. Pixels are divided by the weights of the
 * camera's samples, whose sum varies, least for samples in a sequence: by .8 % for the sinc. */
static void check_splats(const char *name, vlPixelFilterKind kind) {
  enum { EDGE = 4, SEEDS = 8, SIDE_OF_SPLATS = 24, SPP_OF_SPLATS = 64 };
  Mean off = {0};
  for (uint32_t seed = 0; seed < SEEDS; seed++) {
    char text[TEXT];
    char film[200];
    snprintf(film, sizeof film,
             "Film \"rgb\" \"integer xresolution\" %d \"integer yresolution\" %d "
             "\"string filename\" \"x.pfm\"",
             SIDE_OF_SPLATS, SIDE_OF_SPLATS);
    with_seed(below_sun, film, seed + 1, text);
    vlImage *image = filtered_image(text, "lightpath", kind, SPP_OF_SPLATS);
    double sum = 0;
    for (uint32_t y = EDGE; y < SIDE_OF_SPLATS - EDGE; y++)
      for (uint32_t x = EDGE; x < SIDE_OF_SPLATS - EDGE; x++)
        sum += (double)vl_image_get(image, x, y, 1);
    vl_image_destroy(image);
    mean_add(&off, sum / ((SIDE_OF_SPLATS - 2 * EDGE) * (SIDE_OF_SPLATS - 2 * EDGE)));
  }
  check_mean("filters", name, "light paths", &off, 0.5, (Sight){0.01 * 0.5, 0.05 * 0.5});
}

static void filters_of_light_paths(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("filters");
  for (uint32_t k = 0; k < family->kind_count; k++)
    check_splats(family->rows[k]->name, (vlPixelFilterKind)k);
  expect_no_failures();
}

/* ---- limits of a path's bounces of one kind ---------------------------------------------- */

enum { DIFFUSE = 1, GLOSSY = 2, TRANSMITTED = 4, SCATTERED = 8 };

/* Worlds with the kinds of their bounces: a bowl of a material, or a cloud. */
#define BOWL(material)                                                       \
  "WorldBegin LightSource \"infinite\" \"rgb L\" [1 1 1] Material " material \
  " Shape \"sphere\" \"float zmax\" .3 Translate 0 0 -.3 Shape \"sphere\" \"float radius\" .4\n"
static const struct {
  unsigned bounces;
  const char *world;
} limited_worlds[] = {
    {DIFFUSE, BOWL("\"diffuse\" \"rgb reflectance\" [.8 .8 .8]")},
    {GLOSSY, BOWL("\"conductor\" \"float roughness\" .4")},
    {TRANSMITTED, BOWL("\"diffusetransmission\" \"rgb reflectance\" [0 0 0] "
                       "\"rgb transmittance\" [.9 .9 .9]")},
    {DIFFUSE | TRANSMITTED, BOWL("\"diffusetransmission\" \"rgb reflectance\" [.5 .5 .5] "
                                 "\"rgb transmittance\" [.4 .4 .4]")},
    {GLOSSY | TRANSMITTED, BOWL("\"dielectric\" \"float roughness\" .3")},
    {GLOSSY | TRANSMITTED, BOWL("\"thindielectric\"")},
    {DIFFUSE | GLOSSY, BOWL("\"subsurface\" \"rgb reflectance\" [.8 .8 .8] "
                            "\"rgb mfp\" [.05 .05 .05]")},
    {SCATTERED,
     "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.2 .2 .2] "
     "\"rgb sigma_s\" [3 3 3] WorldBegin LightSource \"infinite\" \"rgb L\" [1 1 1] "
     "MediumInterface \"m\" \"\" Material \"interface\" Shape \"sphere\"\n"},
};
static const char *const limits[] = {"maxdiffusedepth", "maxglossydepth",
                                     "maxtransmissiondepth", "maxvolumedepth"};
enum {
  BOUNCE_KINDS = sizeof limits / sizeof *limits,
  LIMITED_WORLDS = sizeof limited_worlds / sizeof *limited_worlds,
  SPP_OF_BOWL = 16
};

/* The image of world `w` where bounces of kind `k` (-1: none) end after the first. */
static vlImage *limited_image(int w, int k) {
  char text[TEXT];
  char limit[80] = "";
  if (k >= 0)
    snprintf(limit, sizeof limit, "\"integer %s\" 1", limits[k]);
  snprintf(text, sizeof text,
           "LookAt 0 -3 1.5 0 0 0 0 0 1 Camera \"perspective\" \"float fov\" 45\n" VIEW(
               "12") "Integrator \"volpath\" \"integer maxdepth\" 8 %s %s",
           limit, limited_worlds[w].world);
  return image_of(text, NULL, SPP_OF_BOWL);
}

/* The limit of a kind changes the worlds that have bounces of that kind, and no others. */
static void limits_of_kinds(void **state) {
  (void)state;
  for (int w = 0; w < LIMITED_WORLDS; w++) {
    vlImage *whole = limited_image(w, -1);
    for (int k = 0; k < BOUNCE_KINDS; k++) {
      vlImage *image = limited_image(w, k);
      Mean lost = mean_difference(whole, image);
      bool changes = mean_of(&lost) != 0;
      if (changes != ((limited_worlds[w].bounces >> k & 1) != 0))
        broken("tracers", "volpath", "\"%s\" %s bounces of world %d", limits[k],
               changes ? "limits" : "does not limit", w);
      vl_image_destroy(image);
    }
    vl_image_destroy(whole);
  }
  expect_no_failures();
}

static void laws_of_tracers(void **state) {
  (void)state;
  static char uniform[TEXT];
  const vlKindFamily *family = vl_kind_family_find("tracers");
  vlImage *paths = image_of(room_text, "path", ROOM_SPP);
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const char *name = family->rows[k]->name;
    const TracerCase *c = tracer_cases[k];
    if (c->room_spp)
      check_room(name, paths, c);
    check_tracer(name, "sky", below_sky, c->sky, c);
    check_tracer(name, "lamp", below_lamp, c->lamp, c);
    check_tracer(name, "mirror", mirrored_sky, c->mirror, c);
    if (c->blurs) {
      check_merging(name);
      check_radius((vlTracer)k, name);
    }
    if (k != VL_TRACER_AMBIENT_OCCLUSION)
      continue;
    const char *rest = strstr(below_lamp, "WorldBegin");
    snprintf(uniform, sizeof uniform,
             "%.*s Integrator \"ambientocclusion\" \"bool cossample\" false\n%s",
             (int)(rest - below_lamp), below_lamp, rest);
    check_tracer(name, "uniform", uniform, c->lamp, c);
  }
  vl_image_destroy(paths);
  expect_no_failures();
}

#endif
