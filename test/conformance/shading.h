/* conformance/shading.h: laws of what stands between a material's parameters and its BSDF:
 * normal maps turn the normal as their texels say; a factor on a map is a factor on its texels,
 * of each layer's own map; kinds that describe the same microfacets agree; what has no material
 * is of the default one. */
#ifndef TEST_CONFORMANCE_SHADING_H
#define TEST_CONFORMANCE_SHADING_H

#include "conformance.h"
#include "materials.h"
#include "schema/schema.h"
#include "unit.h"
#include "velo/material.h"
#include "velo/texture.h"

/* How a square scatters, seen from one direction. */
typedef struct Scattering {
  double shading[3];
  float value[4][VL_OWN_BATCH], pdf[VL_OWN_BATCH];
  vlTraceRays *rays;
  vlTraceHits *hits;
} Scattering;

static void ask_scattering(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  static float directions[3][VL_OWN_BATCH];
  Scattering *s = probe->user;
  double eye[3];
  eye_direction(0.6, eye);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double w[3];
    even_direction(i, VL_OWN_BATCH, 0.1, w);
    for (int k = 0; k < 3; k++)
      directions[k][i] = (float)w[k];
    rays_towards(s->rays, i, eye);
  }
  vl_world_trace(trace, s->rays, s->hits);
  for (int k = 0; k < 3; k++)
    s->shading[k] = (double)s->hits->shading[k][0];
  vl_trace_bsdf(trace, directions, s->value, s->pdf);
}

/* Takes the scene, which it destroys. */
static Scattering *scattering_of(vlScene *scene, const char *text) {
  Scattering *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->rays = new_rays();
  s->hits = calloc(1, sizeof *s->hits);
  Probe probe = {.ask = ask_scattering, .user = s};
  probe_scene(scene, text, &probe, 1);
  return s;
}

static void free_scattering(Scattering *s) {
  free(s->rays);
  free(s->hits);
  free(s);
}

/* The square with a material of the caller's. */
static Scattering *scattering_of_def(vlScene *scene, const vlMaterialDef *material) {
  add_square(scene, material);
  return scattering_of(scene, "a material of one's own");
}

/* ---- normal maps ------------------------------------------------------------------------- */

/* The texel .7 .4 .9, whose normal is (.4, -.2, .8) before it gets its length, and its x and y
 * times a factor. */
static void known_normal(double factor, double n[3]) {
  n[0] = 0.4 * factor;
  n[1] = -0.2 * factor;
  n[2] = 0.8;
  double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (int k = 0; k < 3; k++)
    n[k] /= length;
}

static void check_normal(const char *kind, const Scattering *s, double factor) {
  double known[3];
  double off = 0;
  known_normal(factor, known);
  for (int k = 0; k < 3; k++)
    off = fmax(off, fabs(s->shading[k] - known[k]));
  if (!(off < 1e-3))
    broken("materials", kind,
           "normal map, factor %g: (%.3f, %.3f, %.3f), not (%.3f, %.3f, %.3f)", factor,
           s->shading[0], s->shading[1], s->shading[2], known[0], known[1], known[2]);
}

/* Calls `check` with each kind whose row has a normal map, and its parameters with one. */
static void for_each_mapped(const char *file, void (*check)(const vlKindRow *, const char *)) {
  char parameters[400];
  const vlKindFamily *family = vl_kind_family_find("materials");
  for (uint32_t k = 0; k < family->kind_count; k++) {
    const vlKindRow *row = family->rows[k];
    if (!vl_row_find(row, "normalmap") || row->traits & VL_MATERIAL_ABSENT)
      continue;
    snprintf(parameters, sizeof parameters, "%s \"string normalmap\" \"%s\"",
             material_cases[k]->variants[0].parameters, file);
    check(row, parameters);
  }
}

static void check_tilted_map(const vlKindRow *row, const char *parameters) {
  static char text[TEXT];
  scene_text(text, material_form, row->name, parameters);
  Scattering *s = scattering_of(need_scene(text), text);
  check_normal(row->name, s, 1);
  free_scattering(s);
}

/* The shading normals over a square whose texture coordinates are moved by whole numbers. */
static void ask_normals(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  Scattering *s = probe->user;
  (void)paths;
  set_rays_down(s->rays);
  vl_world_trace(trace, s->rays, s->hits);
}

static Scattering *mapped_square(const vlKindRow *row, const char *parameters, int moved) {
  static char text[TEXT];
  char form[800];
  snprintf(form, sizeof form,
           HEAD
           "WorldBegin LightSource \"infinite\" " NAMED
           "Material %%s Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0 1 -1 0 -1 1 0 1 1 0] "
           "\"point2 uv\" [%d %d %d %d %d %d %d %d]",
           moved, -moved, 1 + moved, -moved, moved, 1 - moved, 1 + moved, 1 - moved);
  scene_text(text, form, row->name, parameters);
  Scattering *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->rays = new_rays();
  s->hits = calloc(1, sizeof *s->hits);
  Probe probe = {.ask = ask_normals, .user = s};
  probe_world(text, &probe, 1);
  return s;
}

/* Normal maps go on beyond their edges as they begin. */
static void check_repeated_map(const vlKindRow *row, const char *parameters) {
  Scattering *inside = mapped_square(row, parameters, 0);
  Scattering *beyond = mapped_square(row, parameters, 3);
  uint32_t differ = 0;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double off = 0;
    for (int k = 0; k < 3; k++)
      off = fmax(
          off, fabs((double)inside->hits->shading[k][i] - (double)beyond->hits->shading[k][i]));
    differ += !(off < 1e-3);
  }
  if (differ > VL_OWN_BATCH / 100)
    broken("materials", row->name, "a normal map beyond its edges: %u of %u normals differ",
           differ, VL_OWN_BATCH);
  free_scattering(inside);
  free_scattering(beyond);
}

/* A texture whose texels all are the map's, with x and y times a factor. */
static vlTextureId add_map(vlScene *scene, vlImage **image, float factor) {
  vlImageDef def = vl_default_image_def(2, 2, 3);
  assert_int_equal(vl_image_create(context, &def, image), VL_OK);
  float *pixels = vl_image_pixels(*image);
  for (int i = 0; i < 4; i++) {
    pixels[3 * i] = 0.5f + 0.2f * factor;
    pixels[3 * i + 1] = 0.5f - 0.1f * factor;
    pixels[3 * i + 2] = 0.9f;
  }
  vlTextureDef texture = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  texture.image = *image;
  return vl_scene_add_texture(scene, &texture);
}

/* A coated surface; factors: on the texels of the two maps (NaN: no map), and by the
 * material. */
static Scattering *coated(const float texels[2], const float factors[2]) {
  vlScene *scene = need_scene(HEAD "WorldBegin LightSource \"infinite\"");
  vlImage *images[2] = {NULL, NULL};
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
  vlTextureId *const maps[2] = {&def.principled.normal, &def.principled.clearcoat_normal};
  for (int i = 0; i < 2; i++)
    if (!isnan(texels[i]))
      *maps[i] = add_map(scene, &images[i], texels[i]);
  def.principled.metallic.value = 0;
  def.principled.roughness.value = 0.5f;
  def.principled.clearcoat.value = 1;
  def.principled.clearcoat_roughness.value = 0.4f;
  def.principled.normal_scale = factors[0];
  def.principled.clearcoat_normal_scale = factors[1];
  Scattering *s = scattering_of_def(scene, &def);
  vl_image_destroy(images[0]);
  vl_image_destroy(images[1]);
  return s;
}

/* The number of values that differ. densities: are compared, too. */
static uint32_t differing(const Scattering *a, const Scattering *b, bool densities) {
  uint32_t differ = 0;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    differ += !close_to((double)a->value[1][i], (double)b->value[1][i], 1e-3) ||
              (densities && !close_to((double)a->pdf[i], (double)b->pdf[i], 1e-3));
  return differ;
}

/* Takes both. */
static void check_same_scattering(const char *kind, const char *what, Scattering *a,
                                  Scattering *b, bool densities) {
  const uint32_t differ = differing(a, b, densities);
  if (differ > VL_OWN_BATCH / 100) /* directions along the surface */
    broken("materials", kind, "%s: %u of %u values differ", what, differ, VL_OWN_BATCH);
  free_scattering(a);
  free_scattering(b);
}

static void check_factors_of_maps(void) {
  static const float ones[2] = {1, 1};
  static const float factors[2] = {0.5f, -0.7f};
  Scattering *by_factors = coated(ones, factors);
  check_normal("principled", by_factors, 0.5);
  check_same_scattering("principled", "factors on normal maps", by_factors,
                        coated(factors, ones), true);
}

/* Base and coat without a map have the normal of one that is flat, whatever the other has, and
 * the map of each changes how the whole scatters. */
static void check_flat_maps(void) {
  static const float ones[2] = {1, 1};
  static const float flat[2][2] = {{1, 0}, {0, 1}};
  static const float none[2][2] = {{1, NAN}, {NAN, 1}};
  check_same_scattering("principled", "a coat without a map", coated(none[0], ones),
                        coated(flat[0], ones), true);
  check_same_scattering("principled", "a base without a map", coated(none[1], ones),
                        coated(flat[1], ones), true);
  for (int layer = 0; layer < 2; layer++) {
    Scattering *one = coated(none[layer], ones);
    Scattering *both = coated(ones, ones);
    if (differing(one, both, false) < VL_OWN_BATCH / 4)
      broken("materials", "principled", "the normal map of its %s changes nothing",
             layer ? "base" : "coat");
    free_scattering(one);
    free_scattering(both);
  }
}

/* ---- anisotropy -------------------------------------------------------------------------- */

/* A density that is a mixture of `narrow` and of an even one (that of the cosine): the share of
 * the latter that comes nearest to it over the upper half. */
static double share_of_cosine(const float *mixed, const float *narrow) {
  double above = 0;
  double below = 0;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double w[3];
    even_direction(i, VL_OWN_BATCH, 0.1, w);
    double even = w[2] > 0 ? w[2] / PI - (double)narrow[i] : 0;
    above += even * (w[2] > 0 ? (double)mixed[i] - (double)narrow[i] : 0);
    below += even * even;
  }
  return above / below;
}

/* The largest difference from the mixture with that share. */
static double left_over(const float *mixed, const float *narrow, double share) {
  double left = 0;
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double w[3];
    even_direction(i, VL_OWN_BATCH, 0.1, w);
    double mixture = (1 - share) * (double)narrow[i] + share * w[2] / PI;
    left = w[2] > 0 ? fmax(left, fabs((double)mixed[i] - mixture)) : left;
  }
  return left;
}

/* glTF's KHR_materials_anisotropy: of the roughness alpha = r^2, (1 - a^2) alpha + a^2 along
 * the tangent, alpha across. A metal with these has the same density of samples, but for those
 * that stand for light between its microfacets, which are even. */
static void check_anisotropy(double roughness, double anisotropy) {
  double alpha = roughness * roughness;
  double along = alpha + (1 - alpha) * anisotropy * anisotropy;
  vlMaterialDef metals[2] = {vl_default_material_def(VL_MATERIAL_PRINCIPLED),
                             vl_default_material_def(VL_MATERIAL_CONDUCTOR)};
  metals[0].principled.metallic.value = 1;
  metals[0].principled.roughness.value = (float)roughness;
  metals[0].principled.anisotropy.value = (float)anisotropy;
  metals[1].remap_roughness = false;
  metals[1].u_roughness.value = (float)along;
  metals[1].v_roughness.value = (float)alpha;
  Scattering *s[2];
  for (int i = 0; i < 2; i++)
    s[i] =
        scattering_of_def(need_scene(HEAD "WorldBegin LightSource \"infinite\""), &metals[i]);
  double share = share_of_cosine(s[0]->pdf, s[1]->pdf);
  double left = left_over(s[0]->pdf, s[1]->pdf, share);
  if (!(left < 0.01 && share > -0.01 && share < 0.5))
    broken("materials", "principled",
           "anisotropy %g: its density is off by %.3f from %.3f even and else the metal's",
           anisotropy, left, share);
  free_scattering(s[0]);
  free_scattering(s[1]);
}

/* ---- mirrored coordinates ---------------------------------------------------------------- */

/* Texels, and the angle of a tangent, that show along mirrored coordinates what others show
 * along upright ones. A normal's x, of a map, counts along u. */
static Scattering *along_coordinates(bool mirrored) {
  const float side = mirrored ? -1 : 1;
  vlScene *scene = need_scene(HEAD "WorldBegin LightSource \"infinite\"");
  vlMaterialDef def = vl_default_material_def(VL_MATERIAL_PRINCIPLED);
  vlImage *image;
  vlImageDef size = vl_default_image_def(1, 1, 3);
  assert_int_equal(vl_image_create(context, &size, &image), VL_OK);
  float *pixel = vl_image_pixels(image);
  pixel[0] = 0.5f + 0.2f * side;
  pixel[1] = 0.4f;
  pixel[2] = 0.9f;
  vlTextureDef texture = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  texture.image = image;
  def.principled.normal = vl_scene_add_texture(scene, &texture);
  def.principled.metallic.value = 1;
  def.principled.roughness.value = 0.6f;
  def.principled.anisotropy.value = 0.7f;
  def.principled.anisotropy_rotation.value = mirrored ? (float)PI - 0.6f : 0.6f;
  add_square_of(scene, &def, mirrored);
  Scattering *s = scattering_of(scene, "mirrored coordinates");
  vl_image_destroy(image);
  return s;
}

static void check_mirrored_coordinates(void) {
  Scattering *upright = along_coordinates(false);
  Scattering *mirrored = along_coordinates(true);
  uint32_t differ = 0;
  check_normal("principled", upright, 1);
  check_normal("principled", mirrored, 1);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
    differ += !close_to((double)upright->pdf[i], (double)mirrored->pdf[i], 1e-3);
  if (differ)
    broken("materials", "principled", "mirrored coordinates: %u of %u densities differ", differ,
           VL_OWN_BATCH);
  free_scattering(upright);
  free_scattering(mirrored);
}

/* ---- no material ------------------------------------------------------------------------- */

/* What has no material is of the default one, beside other materials, too. */
static void check_no_material(void) {
  const vlMaterialDef grey = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  Scattering *s[2];
  for (int i = 0; i < 2; i++) {
    vlScene *scene = need_scene(HEAD "WorldBegin LightSource \"infinite\" " NAMED);
    s[i] = scattering_of_def(scene, i ? &grey : NULL);
  }
  if (memcmp(s[0]->value, s[1]->value, sizeof s[0]->value) != 0 ||
      memcmp(s[0]->pdf, s[1]->pdf, sizeof s[0]->pdf) != 0)
    broken("materials", "diffuse", "a shape without a material scatters in another way");
  if (memcmp(s[0]->hits->reflectance, s[1]->hits->reflectance,
             sizeof s[0]->hits->reflectance) != 0)
    broken("materials", "diffuse", "a shape without a material reflects %.3f, not %.3f",
           (double)s[0]->hits->reflectance[1][0], (double)s[1]->hits->reflectance[1][0]);
  free_scattering(s[0]);
  free_scattering(s[1]);
}

static void laws_of_shading(void **state) {
  (void)state;
  check_no_material();
  check_mirrored_coordinates();
  for_each_mapped("tilted.pfm", check_tilted_map);
  for_each_mapped("normals.pfm", check_repeated_map);
  check_factors_of_maps();
  check_flat_maps();
  check_anisotropy(0.6, 0);
  check_anisotropy(0.6, 0.7);
  expect_no_failures();
}

#endif
