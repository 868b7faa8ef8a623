/* conformance/neighbours.h: two materials of one kind, or two textures, beside each other in
 * one plane: each has the bits that it has beside itself; a medium those that it has alone. So
 * nothing of a kind is shared between two of its things, nor of their images in files. Surfaces
 * with the same medium on both sides are no borders. */
#ifndef TEST_CONFORMANCE_NEIGHBOURS_H
#define TEST_CONFORMANCE_NEIGHBOURS_H

#include "materials.h"
#include "textures.h"
#include "transport.h"

/* How many numbers of two images differ in the columns from `first` to before `last`. */
static uint32_t other_numbers(const vlImage *image, const vlImage *other, uint32_t first,
                              uint32_t last) {
  uint32_t others = 0;
  for (uint32_t y = 0; y < vl_image_height(image); y++)
    for (uint32_t x = first; x < last; x++)
      for (uint32_t channel = 0; channel < 3; channel++)
        others += vl_image_get(image, x, y, channel) != vl_image_get(other, x, y, channel);
  return others;
}

/* ---- media ------------------------------------------------------------------------------- */

/* A box of glow beside a box of the medium: the same random numbers meet the medium whether or
 * not there is glow, so its part of the image has the same bits. The border between them goes
 * through the blocks of pixels whose paths fly together. */
static const char *const neighbour_form =
    "LookAt 0 0 3 0 0 0 0 1 0 Camera \"orthographic\" \"float screenwindow\" [-.5 .5 -.5 .5]\n" VIEW("16") "WorldBegin "
    "LightSource \"infinite\" \"rgb L\" [1 1 1] "
    "MakeNamedMedium \"glow\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.3 .6 .2] "
    "\"rgb sigma_s\" [0 0 0] \"rgb Le\" [2 3 4] MakeNamedMedium \"m\" \"string type\" %s\n"
    "Material \"interface\" MediumInterface \"m\" \"\"\n" BOX_FROM("-.1", "1")
    "MediumInterface \"glow\" \"\"\n" BOX_FROM("-1", "-.11");

enum { PLATE_SPP = 64 };

static void check_neighbour(const char *name, const MediumCase *c, vlColorMode color) {
  static char text[TEXT];
  char all[2000];
  vlImage *images[2];
  snprintf(all, sizeof all, "%s%s", c->shape, c->absorbs);
  scene_text(text, neighbour_form, name, all);
  images[0] = image_in(color, text, NULL, VL_PIXEL_FILTER_BOX, SAMPLES);
  char *glow = strstr(text, "MediumInterface \"glow\"");
  assert_non_null(glow);
  memcpy(strstr(glow, "\"glow\""), "\"\"    ", 6);
  images[1] = image_in(color, text, NULL, VL_PIXEL_FILTER_BOX, SAMPLES);
  /* x grows to the left; the ninth column ends at -.06 */
  const uint32_t others = other_numbers(images[0], images[1], 0, 9);
  if (others)
    broken("media", name, "%u numbers of its image are others beside another medium", others);
  vl_image_destroy(images[0]);
  vl_image_destroy(images[1]);
}

/* A plate in the middle of the box, with glow on both of its sides: no border of a medium, so
 * rays go on through the medium that they are in. */
#define PLATE_IN_MEDIUM                                                               \
  "MakeNamedMedium \"glow\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [3 6 2] " \
  "\"rgb sigma_s\" [0 0 0] \"rgb Le\" [2 3 4] MediumInterface \"glow\" \"glow\"\n"    \
  "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0]\n"

static void check_plate_inside(const char *name, const MediumCase *c) {
  static char text[TEXT];
  char all[2000];
  vlImage *images[2];
  snprintf(all, sizeof all, "%s%s", c->shape, c->absorbs);
  scene_text(text, medium_form, name, all);
  images[0] = image_of(text, NULL, PLATE_SPP);
  strcat(text, PLATE_IN_MEDIUM);
  images[1] = image_of(text, NULL, PLATE_SPP);
  const Mean off = mean_difference(images[0], images[1]);
  check_mean("media", name, "light that passes a plate with one medium on both sides", &off, 0,
             (Sight){.slack = 2e-3, .min = 0.1});
  vl_image_destroy(images[0]);
  vl_image_destroy(images[1]);
}

static void neighbouring_media(void **state) {
  (void)state;
  const vlKindFamily *family = vl_kind_family_find("media");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    check_neighbour(family->rows[k]->name, medium_cases[k], VL_COLOR_RGB);
    check_neighbour(family->rows[k]->name, medium_cases[k], VL_COLOR_SPECTRAL);
    check_plate_inside(family->rows[k]->name, medium_cases[k]);
  }
  expect_no_failures();
}

/* ---- materials and textures -------------------------------------------------------------- */

/* Two rectangles that do not see each other; the border goes through blocks of pixels. */
#define LEFT_PART "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 -.1 -1 0 -1 1 0 -.1 1 0]\n"
#define RIGHT_PART "Shape \"bilinearmesh\" \"point3 P\" [-.1 -1 0 1 -1 0 -.1 1 0 1 1 0]\n"
#define PARTS_SEEN                                                                       \
  "LookAt 0 0 3 0 0 0 0 1 0 Camera \"orthographic\" \"float screenwindow\" [-.5 .5 -.5 " \
  ".5]\n" VIEW("16") "WorldBegin LightSource \"infinite\" \"rgb L\" [.5 1 2] " NAMED HALVES

/* What a part is made of, as statements. */
typedef void PartText(char text[TEXT], const vlKindRow *row, const char *parameters,
                      int number);

static void material_part(char text[TEXT], const vlKindRow *row, const char *parameters,
                          int number) {
  (void)number;
  snprintf(text, TEXT, "Material \"%s\" %s\n", row->name, parameters);
}
static void texture_part(char text[TEXT], const vlKindRow *row, const char *parameters,
                         int number) {
  static const char *const forms[] = {
      "Texture \"t%d\" \"spectrum\" \"%s\" %s "
      "Material \"diffuse\" \"texture reflectance\" \"t%d\"\n",
      "Texture \"f%d\" \"float\" \"%s\" %s Texture \"t%d\" \"spectrum\" \"scale\" "
      "\"rgb tex\" [1 1 1] \"texture scale\" \"f%d\" Material \"diffuse\" "
      "\"texture reflectance\" \"t%d\"\n"};
  const bool float_only = row->traits & VL_TEXTURE_FLOAT_ONLY;
  snprintf(text, TEXT, forms[float_only], number, row->name, parameters, number, number,
           number);
}

/* The scene that a file of it gives, seen as before. */
static vlScene *through_file(vlScene *scene, const char *suffix) {
  char file[20];
  snprintf(file, sizeof file, "parts.%s", suffix);
  vlScene *read = read_again(scene, file);
  const vlSceneDefs *from = vl_scene_defs(scene);
  vlSceneDefs *to = vl_scene_defs(read);
  to->camera = from->camera;
  to->film = from->film;
  to->render = from->render;
  to->build = from->build;
  return read;
}

/* suffix: of the file that holds the scene; null: it is in no file. */
static vlImage *image_of_parts(const vlKindRow *row, PartText *part, const char *left,
                               const char *right, const char *suffix) {
  static char text[TEXT];
  static char parts[2][TEXT];
  part(parts[0], row, left, 0);
  part(parts[1], row, right, 1);
  int length = snprintf(text, sizeof text, "%s%s" LEFT_PART "%s" RIGHT_PART, PARTS_SEEN,
                        parts[0], parts[1]);
  assert_true(length > 0 && length < TEXT);
  vlScene *scene = scene_in(VL_COLOR_RGB, text, NULL, VL_PIXEL_FILTER_BOX, SAMPLES);
  if (!suffix)
    return need_image(scene, text);
  vlImage *image = need_image(through_file(scene, suffix), text);
  vl_scene_destroy(scene);
  return image;
}

static void check_parts(const char *family, const vlKindRow *row, PartText *part,
                        const char *left, const char *right, const char *suffix) {
  vlImage *both = image_of_parts(row, part, left, right, suffix);
  vlImage *lefts = image_of_parts(row, part, left, left, suffix);
  vlImage *rights = image_of_parts(row, part, right, right, suffix);
  /* x grows to the left; the border is in the tenth column */
  uint32_t others =
      other_numbers(both, rights, 0, 9) + other_numbers(both, lefts, 10, vl_image_width(both));
  if (others)
    broken(family, row->name, "%s beside %s%s%s: %u numbers are others than beside itself",
           left, right, suffix ? ", as ." : "", suffix ? suffix : "", others);
  vl_image_destroy(both);
  vl_image_destroy(lefts);
  vl_image_destroy(rights);
}

/* The parameters of variant i of kind k; null: it has no more. */
typedef const char *VariantOf(uint32_t k, int i);

static const char *material_variant(uint32_t k, int i) {
  return i < MATERIAL_VARIANTS ? material_cases[k]->variants[i].parameters : NULL;
}
static const char *texture_variant(uint32_t k, int i) {
  return i < TEXTURE_VARIANTS ? texture_cases[k]->variants[i].parameters : NULL;
}

static void check_neighbours(const char *name, PartText *part, VariantOf *variant) {
  static const char *const suffixes[] = {NULL, "pbrt", "gltf"};
  const size_t count = strcmp(name, "materials") == 0 ? 2 : 3; /* glTF has few of them */
  const vlKindFamily *family = vl_kind_family_find(name);
  for (uint32_t k = 0; k < family->kind_count; k++)
    for (int i = 0; variant(k, i) && variant(k, i + 1); i++)
      for (size_t s = 0; s < count; s++)
        check_parts(name, family->rows[k], part, variant(k, i), variant(k, i + 1), suffixes[s]);
  expect_no_failures();
}

static void neighbouring_materials(void **state) {
  (void)state;
  check_neighbours("materials", material_part, material_variant);
}

static void neighbouring_textures(void **state) {
  (void)state;
  check_neighbours("textures", texture_part, texture_variant);
}

#endif
