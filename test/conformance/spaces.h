/* conformance/spaces.h: the law of colour spaces in RGB: what takes colours of a space of their
 * own (images as textures, as emission, as the sky and as projections; grids of media) shows
 * what the constant of the same space does. Colours that sRGB has not lose their negative part
 * in both. The given power or illuminance of an image's light is that of its space's
 * luminance. */
#ifndef TEST_CONFORMANCE_SPACES_H
#define TEST_CONFORMANCE_SPACES_H

#include "conformance.h"
#include "files.h"
#include "lights.h"
#include "radiometry.h"
#include "velo/color.h"
#include "velo/texture.h"

typedef struct SpaceCase {
  const char *name; /* in pbrt files */
  vlColorSpace space;
  double chromaticities[8];
  float inside[3]; /* a saturated colour that sRGB has, too */
} SpaceCase;

static const SpaceCase space_cases[] = {
    {"dci-p3", VL_SPACE_DCI_P3, {.68, .32, .265, .69, .15, .06, .3127, .329}, {.5f, .1f, .1f}},
    {"rec2020",
     VL_SPACE_REC2020,
     {.708, .292, .17, .797, .131, .046, .3127, .329},
     {.5f, .1f, .1f}},
    {"aces2065-1",
     VL_SPACE_ACES2065_1,
     {.7347, .2653, 0, 1, .0001, -.077, .32168, .33767},
     {.3f, .2f, .2f}},
};
enum { SPACE_CASES = 3, SPACE_IMAGE = 64 };

/* Its red is negative in sRGB. */
static const float outside_srgb[3] = {.1f, .5f, .05f};

/* Writes an image of one colour. */
static void write_space_image(const SpaceCase *c, const float color[3], bool tells) {
  char path[100];
  path_of(path, "space.exr");
  vlImageDef def = vl_default_image_def(SPACE_IMAGE, SPACE_IMAGE, 3);
  vlAttribute a = {.name = "chromaticities", .type = VL_ATTRIBUTE_CHROMATICITIES};
  memcpy(a.numbers, c->chromaticities, sizeof c->chromaticities);
  vlImage *image;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  float *pixels = vl_image_pixels(image);
  for (int i = 0; i < 3 * SPACE_IMAGE * SPACE_IMAGE; i++)
    pixels[i] = color[i % 3];
  if (tells)
    assert_int_equal(vl_image_set_attribute(image, &a), VL_OK);
  assert_int_equal(vl_image_write(image, path, NULL, NULL), VL_OK);
  vl_image_destroy(image);
}

/* ---- what is compared -------------------------------------------------------------------- */

#define D65_SKY "LightSource \"infinite\" \"spectrum L\" \"stdillum-D65\"\n"
#define PLANE \
  "Shape \"trianglemesh\" \"integer indices\" [0 1 2 2 1 3] \"point3 P\" [-9 0 9 9 0 9 -9 0 -9 9 0 -9]\n"
#define IMAGE_FILE "\"string filename\" \"space.exr\" "
/* the second texture: change_texture sets its space */
#define IMAGE_TEXTURE                             \
  "Texture \"first\" \"spectrum\" \"constant\"\n" \
  "Texture \"t\" \"spectrum\" \"imagemap\" " IMAGE_FILE "\n"
#define METAL "Material \"conductor\" \"spectrum eta\" [360 1 830 1] "
#define PORTAL "\"point3 portal\" [-1 1 -1 1 1 -1 1 1 1 -1 1 1]\n"
#define AT_LAMP "AttributeBegin Translate .1 1.5 .2 Rotate 90 1 0 0 "
#define PANEL                                                          \
  "Shape \"bilinearmesh\" \"point3 P\" [-1 1 1 1 1 1 -1 1 -1 1 1 -1] " \
  "\"integer indices\" [1 0 3 2]\n"
/* %s: the colour of its one cell */
#define GRID                                                                                 \
  D65_SKY FLOOR                                                                              \
      "MakeNamedMedium \"m\" \"string type\" \"rgbgrid\" \"integer nx\" 1 \"integer ny\" 1 " \
      "\"integer nz\" 1 \"point3 p0\" [-4 .1 -4] \"point3 p1\" [4 .4 4] \"float scale\" 9 "  \
      "\"rgb sigma_s\" [0 0 0] "
#define AROUND_GRID                                                                          \
  "\nMediumInterface \"m\" \"\" Material \"interface\" Translate 0 .25 0 Scale 3.9 .14 3.9 " \
  "Shape \"sphere\"\n"

/* Two scenes that must look alike. Without an image both are of the second form: in the
 * colours of the space, and in the same colours of sRGB. */
typedef struct SpacePair {
  const char *family, *kind;
  const char *image;
  const char *constant; /* %s: the colour */
  vlParameterRole role; /* of the colour, without an image */
} SpacePair;
static const SpacePair space_pairs[] = {
    {"textures", "imagemap",
     D65_SKY IMAGE_TEXTURE "Material \"diffuse\" \"texture reflectance\" \"t\" " PLANE,
     D65_SKY "Material \"diffuse\" \"rgb reflectance\" [%s] " PLANE, VL_PARAMETER_ALBEDO},
    {"textures", "imagemap", D65_SKY IMAGE_TEXTURE METAL "\"texture k\" \"t\" " PLANE,
     D65_SKY METAL "\"rgb k\" [%s] " PLANE, VL_PARAMETER_UNBOUNDED},
    {"lights", "infinite", "LightSource \"infinite\" " IMAGE_FILE FLOOR,
     "LightSource \"infinite\" \"rgb L\" [%s]\n" FLOOR, VL_PARAMETER_ILLUMINANT},
    {"lights", "infinite", "LightSource \"infinite\" " IMAGE_FILE PORTAL FLOOR,
     "LightSource \"infinite\" \"rgb L\" [%s] " PORTAL FLOOR, VL_PARAMETER_ILLUMINANT},
    {"lights", "projection",
     AT_LAMP "LightSource \"projection\" " IMAGE_FILE "AttributeEnd\n" FLOOR,
     AT_LAMP "LightSource \"point\" \"rgb I\" [%s] AttributeEnd\n" FLOOR,
     VL_PARAMETER_ILLUMINANT},
    {"emission", "diffuse", FLOOR "AreaLightSource \"diffuse\" " IMAGE_FILE PANEL,
     FLOOR "AreaLightSource \"diffuse\" \"rgb L\" [%s] " PANEL, VL_PARAMETER_ILLUMINANT},
    {"media", "rgbgrid", NULL, GRID "\"rgb sigma_a\" [%s]" AROUND_GRID, VL_PARAMETER_UNBOUNDED},
    {"media", "rgbgrid", NULL, GRID "\"rgb sigma_a\" [1 1 1] \"rgb Le\" [%s]" AROUND_GRID,
     VL_PARAMETER_ILLUMINANT},
};

/* The colour of a piece of the floor, in RGB. */
static void look_at_floor(vlScene *scene, const char *text, double seen[3]) {
  vlSceneDefs *defs = vl_scene_defs(scene);
  defs->build.color = VL_COLOR_RGB;
  defs->film.filter = vl_default_pixel_filter(VL_PIXEL_FILTER_BOX);
  defs->render.max_depth = 1;
  defs->render.spp = 64;
  look_down(&defs->camera, 0.1, 0.2, 0.2);
  vlImage *image = need_image(scene, text);
  for (uint32_t c = 0; c < 3; c++) {
    const Mean mean = mean_of_channel(image, c);
    seen[c] = mean_of(&mean);
  }
  vl_image_destroy(image);
}

/* The same of a form with a colour of a space. */
static void look_at_form(const char *form, const char *space, const float color[3],
                         double seen[3]) {
  static char text[TEXT];
  const char *at = strstr(form, "%s");
  const size_t before = at ? (size_t)(at - form) : strlen(form);
  char numbers[80] = "";
  if (at)
    snprintf(numbers, sizeof numbers, "%.9g %.9g %.9g", (double)color[0], (double)color[1],
             (double)color[2]);
  snprintf(text, sizeof text, HEAD "WorldBegin ColorSpace \"%s\"\n%.*s%s%s", space, (int)before,
           form, numbers, at ? at + 2 : "");
  look_at_floor(need_scene(text), text, seen);
}

static void compare_colors(const char *family, const char *kind, const char *space,
                           const double seen[3], const double known[3]) {
  const double max = fmax(known[0], fmax(known[1], known[2]));
  bool same = max > 1e-3;
  for (int c = 0; c < 3; c++)
    same = same && fabs(seen[c] - known[c]) <= 0.01 * max;
  if (!same)
    broken(family, kind, "colours of %s show as %.4f %.4f %.4f, constants as %.4f %.4f %.4f",
           space, seen[0], seen[1], seen[2], known[0], known[1], known[2]);
}

/* The constant of a space as one of sRGB. */
static void constant_in_srgb(const SpaceCase *c, const float color[3], vlParameterRole role,
                             float srgb[3]) {
  vlSpectrum constant = vl_spectrum_rgb(color[0], color[1], color[2]);
  constant.space = c->space;
  assert_int_equal(vl_spectrum_linear_rgb(&constant, role, srgb, NULL), VL_OK);
}

static void check_space_pair(const SpacePair *pair, const SpaceCase *c, const float color[3]) {
  double seen[3];
  double known[3];
  float srgb[3];
  constant_in_srgb(c, color, pair->role, srgb);
  look_at_form(pair->image ? pair->image : pair->constant, c->name, color, seen);
  if (pair->image)
    look_at_form(pair->constant, c->name, color, known);
  else
    look_at_form(pair->constant, "srgb", srgb, known);
  compare_colors(pair->family, pair->kind, c->name, seen, known);
}

/* ---- spaces that only defs name ---------------------------------------------------------- */

static vlColorSpace space_of_defs;
static void set_texture_space(vlTextureDef *def) {
  def->space = space_of_defs;
}
static void set_light_space(vlLightDef *def) {
  def->space = space_of_defs;
}
static void emit_image_of_space(vlScene *scene, vlEmissionDef *def) {
  char path[100];
  path_of(path, "space.exr");
  vlTextureDef image = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  image.path = path;
  image.space = space_of_defs;
  def->texture = vl_scene_add_texture(scene, &image);
}

static void check_spaces_of_defs(const SpaceCase *c, const float color[3]) {
  static const char lamp[] = FLOOR "AreaLightSource \"diffuse\" " PANEL;
  double seen[3];
  double known[3];
  space_of_defs = c->space;
  for (size_t i = 0; i < sizeof space_pairs / sizeof *space_pairs; i++) {
    const SpacePair *pair = &space_pairs[i];
    const bool texture = strcmp(pair->family, "textures") == 0;
    if (!texture && strcmp(pair->family, "lights") != 0)
      continue;
    change_texture = texture ? set_texture_space : NULL;
    change_light = texture ? NULL : set_light_space;
    look_at_form(pair->image, c->name, color, seen);
    change_texture = NULL;
    change_light = NULL;
    look_at_form(pair->constant, c->name, color, known);
    compare_colors(pair->family, pair->kind, c->name, seen, known);
  }
  change_emission = emit_image_of_space;
  look_at_form(lamp, c->name, color, seen);
  change_emission = NULL;
  look_at_form(FLOOR "AreaLightSource \"diffuse\" \"rgb L\" [%s] " PANEL, c->name, color,
               known);
  compare_colors("emission", "diffuse", c->name, seen, known);
}

/* ---- brightness -------------------------------------------------------------------------- */

/* The power and the illuminance of images are those of the colours of their space. The colour
 * is one that sRGB has, too, or light would be added. */
static void check_space_brightness(const SpaceCase *c) {
  static char text[TEXT];
  static const double up[3] = {0, 0, 1};
  write_space_image(c, c->inside, true);
  check_power("lights", "projection", HEAD "WorldBegin " AROUND "LightSource %s",
              IMAGE_FILE "\"float power\" 10");
  check_power("emission", "diffuse",
              HEAD "WorldBegin " AROUND
                   "AreaLightSource %s Shape \"bilinearmesh\" "
                   "\"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 .3]",
              IMAGE_FILE "\"float power\" 10");
  scene_text(text,
             HEAD
             "WorldBegin LightSource %s Material \"diffuse\" Shape \"sphere\" "
             "\"float radius\" 1",
             "infinite", IMAGE_FILE "\"float illuminance\" 5");
  const Mean light = receive(text, up, ask_ball, 24);
  check_mean("lights", "infinite", "illuminance of an image of another space", &light, 5,
             (Sight){0.05, 0.2});
}

/* ---- panes whose colour is a spectrum ---------------------------------------------------- */

#define PANE_AT(z)                                                                           \
  "Material \"principled\" \"float metallic\" 0 \"float roughness\" 0 \"float specular\" 0 " \
  "\"float transmission\" 1 \"bool thinwalled\" true "                                       \
  "\"spectrum basecolor\" [360 0 499 0 500 1 560 1 561 0 830 0] "                            \
  "Shape \"bilinearmesh\" \"point3 P\" [-9 -9 " z " 9 -9 " z " -9 9 " z " 9 9 " z "]\n"

/* A base colour that is a spectrum acts at each wavelength: a second pane of a colour that
 * passes all or nothing takes no more. */
static void check_spectral_panes(void) {
  static const char *const texts[] = {HEAD "WorldBegin " D65_SKY PANE_AT("1"),
                                      HEAD "WorldBegin " D65_SKY PANE_AT("1") PANE_AT("2")};
  Mean seen[2];
  for (int i = 0; i < 2; i++) {
    vlScene *scene = need_scene(texts[i]);
    vlSceneDefs *defs = vl_scene_defs(scene);
    defs->build.color = VL_COLOR_SPECTRAL;
    defs->render.spp = 256;
    vlImage *image = need_image(scene, texts[i]);
    seen[i] = mean_of_image(image);
    vl_image_destroy(image);
  }
  if (!(mean_of(&seen[0]) > 0.7 && mean_of(&seen[0]) < 0.85))
    broken("materials", "principled", "a pane of one spectrum: green %.4f", mean_of(&seen[0]));
  check_same_mean("materials", "principled", "a second pane of one spectrum: green", &seen[1],
                  &seen[0], (Sight){0.03 * mean_of(&seen[0]), 0.15 * mean_of(&seen[0])});
}

static void colors_of_spaces(void **state) {
  (void)state;
  for (int i = 0; i < SPACE_CASES; i++) {
    const SpaceCase *c = &space_cases[i];
    for (int k = 0; k < 2; k++) {
      const float *color = k ? outside_srgb : c->inside;
      write_space_image(c, color, true);
      for (size_t pair = 0; pair < sizeof space_pairs / sizeof *space_pairs; pair++)
        check_space_pair(&space_pairs[pair], c, color);
      write_space_image(c, color, false);
      check_spaces_of_defs(c, color);
    }
    check_space_brightness(c);
  }
  check_spectral_panes();
  expect_no_failures();
}

#endif
