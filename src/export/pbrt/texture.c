/* export/pbrt/texture.c: textures as pbrt's. An image of which one channel is used, or that is
 * tinted, is written as a new image (EXR, which does not round the values). */
#include <math.h>
#include <stdio.h>

#include "base/free.h"
#include "base/text.h"
#include "export/image.h"
#include "export/pbrt/pbrt.h"
#include "image/image.h"
#include "math/approx.h"
#include "math/fresnel.h"
#include "texture/texture.row.h"

static bool write_image(vlExport *x, const vlTextureDef *t, uint32_t variant, const char *bytes,
                        size_t size, const char *suffix, char name[300]) {
  snprintf(name, 300, "%.200s-%zu%s", x->stem, x->images.count, suffix);
  vlExportImage *slot = vl_export_add_image(x, t, variant);
  if (!slot)
    return false;
  bool fine = vl_export_data(x, name, bytes, size);
  memcpy(slot->name, name, sizeof slot->name);
  return fine;
}

/* Whether the image with these changes was written already, to the file of this name. */
static bool is_written(vlExport *x, const vlTextureDef *t, uint32_t variant, char name[300]) {
  const vlExportImage *known = vl_export_find_image(x, t, variant);
  if (known)
    memcpy(name, known->name, sizeof known->name);
  return known != NULL;
}

/* Whether pbrt reads files of this name. (velo recognises images by their content.) */
static bool is_name_for_pbrt(const char *name) {
  static const char *const known[] = {".exr", ".png", ".jpg", ".jpeg", ".hdr", ".pfm", ".tga"};
  for (size_t i = 0; i < VL_LENGTH(known); i++)
    if (vl_ends_with(name, known[i]))
      return true;
  return false;
}

static bool fits_pbrt(const vlImage *image, vlPbrtFile kind, const char *name) {
  uint32_t channel[4], have = vl_image_color(image, channel);
  if (!is_name_for_pbrt(name))
    return false;
  if (have >= 3 || kind == VL_PBRT_COLORS)
    return have >= 3;
  /* of images with Y and A */
  bool drops_alpha = !vl_ends_with(name, ".exr") && !vl_ends_with(name, ".pfm");
  return image->channels == 1 || (have && drops_alpha);
}

/* The pixels of a texture's image as vl_export_pixels, with the curve that the texture says. */
static const vlImage *pixels_of(vlExport *x, const vlTextureDef *t, vlImage **own) {
  const vlImage *image = vl_export_pixels(x, t, own);
  if (*own && t->encoding_given) {
    (*own)->encoding = t->encoding;
    (*own)->gamma = t->gamma;
  }
  return image;
}

/* Encodes an image that pbrt would refuse as an EXR of linear R, G and B. *bytes stays null
 * when it would not. */
static bool repair(vlExport *x, const vlTextureDef *t, vlPbrtFile kind, const char *name,
                   char **bytes, size_t *size) {
  vlImage *decoded, *rgb = NULL;
  const vlImage *image = pixels_of(x, t, &decoded);
  bool fine = image != NULL;
  if (fine && !fits_pbrt(image, kind, name)) {
    /* else the first channel, whatever it is */
    uint32_t channel[4] = {0}, have = vl_image_color(image, channel);
    vlImageDef def = vl_default_image_def(image->width, image->height, 3);
    if (have < 3)
      channel[1] = channel[2] = channel[0];
    fine = vl_image_create(x->context, &def, &rgb) == VL_OK || vl_export_no_memory(x);
    for (uint32_t y = 0; fine && y < image->height; y++)
      vl_image_row_to_float(image, y, channel, 3, vl_image_row(rgb, y));
    fine = fine && vl_export_pack(x, rgb, ".exr", bytes, size);
  }
  vl_image_destroy(rgb);
  vl_image_destroy(decoded);
  return fine;
}

bool vl_pbrt_image(vlExport *x, const vlTextureDef *t, vlPbrtFile kind, char name[300]) {
  const bool gamma = t->encoding_given && t->encoding == VL_ENCODING_GAMMA;
  const uint32_t variant = (uint32_t)kind +
                           3 * (t->encoding_given ? 1 + (uint32_t)t->encoding : 0) +
                           (gamma ? 16 * vl_float_bits(t->gamma) : 0);
  if (is_written(x, t, variant, name))
    return true;
  char *bytes = NULL;
  size_t size = 0;
  const char *suffix = ".exr", *dot = t->path ? strrchr(t->path, '.') : NULL;
  bool kept, copied = !t->image && dot && strlen(dot) < 8 && !strchr(dot, '/');
  const char *as = copied ? t->path : t->data ? ".png" : suffix;
  bool fine = kind == VL_PBRT_ANY || repair(x, t, kind, as, &bytes, &size);
  if (fine && !bytes && t->image) {
    fine = vl_export_pack(x, t->image, ".exr", &bytes, &size);
  } else if (fine && !bytes && copied) { /* unchanged, whatever its format */
    fine = vl_export_read(x, t->path, &bytes, &size);
    suffix = dot;
  } else if (fine && !bytes) {
    fine = vl_export_image(x, t, false, &bytes, &size, &suffix, &kept);
  }
  fine = fine && write_image(x, t, variant, bytes, size, suffix, name);
  vl_free(x->context, bytes);
  return fine;
}

void vl_pbrt_lose_space(vlExport *x, vlColorSpace space, const vlImage *image) {
  vlAttribute named;
  if (space == VL_SPACE_SRGB ||
      (image && vl_image_find_attribute(image, "chromaticities", &named) == VL_OK))
    return;
  vl_export_lose(x, "colour spaces that images do not name themselves: sRGB");
}

/* ---- changed images ---------------------------------------------------------------------- */

/* How the values of an image are changed. */
typedef struct Change {
  bool squared;
  float turned_back;  /* share of the light that a coat reflects back internally and that is
                         compensated; 0: none */
  float raised;       /* share of white in the colour */
  const float *metal; /* the table of make_metal_table; null: none */
  float lost; /* metal: share of light that a white metal of this roughness loses between
                 microfacets */
} Change;
static const Change as_is = {0};

/* The reflectance of pbrt's conductor whose mean, weighted by the cube of the cosine, is i /
 * METAL_STEPS. Its Fresnel curve rises earlier than Schlick's where it is dark: the weight is a
 * compromise between surfaces seen along the normal, which become darker, and those seen at
 * grazing angles, which stay brighter. */
enum { METAL_STEPS = 512 };
static void make_metal_table(float table[METAL_STEPS + 1]) {
  enum { COSINES = 64 };
  for (int i = 0; i <= METAL_STEPS; i++) {
    double low = 0, high = 0.9999;
    for (int step = 0; step < 24; step++) {
      const double r = 0.5 * (low + high);
      double mean = 0;
      for (int k = 0; k < COSINES; k++) {
        const double c = (k + 0.5) / COSINES;
        mean += 4 * c * c * c / COSINES *
                (double)vl_fresnel_conductor((float)c, 1, (float)(2 * sqrt(r) / sqrt(1 - r)));
      }
      *(mean < (double)i / METAL_STEPS ? &low : &high) = r;
    }
    table[i] = (float)low;
  }
}

/* Schlick's metal of the colour c reflects F = c + (1 - c)/21 of diffuse light, with several
 * reflections between its microfacets F E / (1 - F (1 - E)) (principled.md), as one of a
 * brighter colour without them. The mean of Schlick's curve with the weight above is c + (1 -
 * c) / 126. */
static float metal_color(float value, Change c) {
  const float v = value < 1 ? value > 0 ? value : 0 : 1, f = v + (1 - v) / 21;
  const float brighter = (21 * fminf(1, f / (1 - f * c.lost)) - 1) / 20;
  const float at = (brighter + (1 - brighter) / 126) * METAL_STEPS;
  const int i = (int)at < METAL_STEPS ? (int)at : METAL_STEPS - 1;
  return c.metal[i] + (at - (float)i) * (c.metal[i + 1] - c.metal[i]);
}

static float change_color(float value, Change c) {
  if (c.metal)
    return metal_color(value, c);
  return c.raised + (1 - c.raised) * value / (1 - c.turned_back + value * c.turned_back);
}

static bool changes_color(Change c) {
  return c.turned_back != 0 || c.raised != 0 || c.metal;
}

static float scaled(const vlTextureDef *t, float texel) {
  const float value = t->scale * texel;
  return fmaxf(0, t->invert ? 1 - value : value);
}

/* A number that tells the image of a texture and a change from others (FNV-1a). */
static uint32_t variant_of(const vlTextureDef *t, Change change) {
  uint32_t variant = 16 + (change.squared ? 1u : 0u);
  const float key[16] = {t->tint[0],
                         t->tint[1],
                         t->tint[2],
                         t->tint[3],
                         t->bias,
                         t->scale,
                         (float)t->channel,
                         (float)t->cutoff,
                         change.turned_back,
                         change.raised,
                         change.lost,
                         change.metal ? 1 : 0,
                         t->invert,
                         t->encoding_given ? 1 + (float)t->encoding : 0,
                         t->encoding_given ? t->gamma : 0,
                         t->spectrum};
  for (size_t i = 0; i < sizeof key; i++)
    variant = (variant ^ ((const uint8_t *)key)[i]) * 16777619u | 16u;
  return variant;
}

/* Changes a pixel of `have` channels: to one channel as the tracer reads it, or to three for a
 * spectrum texture. */
static void change_pixel(const vlTextureDef *t, Change change, const float *v, uint32_t have,
                         float *to) {
  /* of one or two channels: grey, and coverage */
  const bool colored = have > 2, covered = have == 2 || have == 4;
  const float texels[4] = {v[0], v[colored ? 1 : 0], v[colored ? 2 : 0],
                           covered ? v[have - 1] : 1.0f};
  float rgba[4];
  for (int k = 0; k < 4; k++)
    rgba[k] = t->tint[k] * (k < 3 || covered ? scaled(t, texels[k]) : 1);
  if (t->spectrum) {
    for (int k = 0; k < 3; k++)
      to[k] = change_color(rgba[k], change);
    return;
  }
  const float mean = have == 4 ? rgba[3] : (rgba[0] + rgba[1] + rgba[2]) / 3;
  float value = t->bias + (t->channel < 0 ? mean : rgba[t->channel]);
  if (!isnan(t->cutoff))
    value = value >= (float)t->cutoff ? 1.0f : 0.0f;
  *to = change.squared ? value * value : value;
}

/* Writes the changed image of a texture, unless it is written; it has the texture's factors. */
static bool put_changed_image(vlExport *x, const vlTextureDef *t, Change change,
                              char name[300]) {
  const uint32_t variant = variant_of(t, change), per = t->spectrum ? 3 : 1;
  if (is_written(x, t, variant, name))
    return true;
  vlImage *image, *made = NULL;
  const vlImage *from = pixels_of(x, t, &image);
  if (!from)
    return false;
  uint32_t channel[4], have = vl_image_color(from, channel);
  float *row = vl_alloc_array(x->context, from->width, 4 * sizeof *row);
  vlImageDef def = vl_default_image_def(from->width, from->height, per);
  def.type = VL_PIXEL_F32;
  bool fine = row && vl_image_create(x->context, &def, &made) == VL_OK;
  if (!fine)
    vl_export_no_memory(x);
  for (uint32_t y = 0; fine && y < from->height; y++) {
    float *to = vl_image_row(made, y);
    vl_image_row_to_float(from, y, channel, have, row);
    for (size_t i = 0; i < from->width; i++)
      change_pixel(t, change, row + i * have, have, to + i * per);
  }
  char *bytes = NULL;
  size_t size;
  fine = fine && vl_export_pack(x, made, ".exr", &bytes, &size) &&
         write_image(x, t, variant, bytes, size, ".exr", name);
  VL_FREE(x->context, bytes, row);
  vl_image_destroy(made);
  vl_image_destroy(image);
  return fine;
}

bool vl_pbrt_emitted_image(vlExport *x, const vlTextureDef *t, char name[300]) {
  bool white = t->tint[0] == 1 && t->tint[1] == 1 && t->tint[2] == 1;
  double m[6];
  vl_export_st_from_uv(t, m);
  if (t->mapping != VL_MAPPING_UV || t->uv_set || m[0] != 1 || m[1] != 0 || m[2] != 0 ||
      m[3] != 0 || m[4] != 1 || m[5] != 0)
    vl_export_lose(x, "maps of images that emit light: left out");
  if (t->filter == VL_FILTER_POINT)
    vl_export_lose(x, "filters of images that emit light: pbrt's own");
  return white && t->scale == 1 && !t->invert && !t->encoding_given
             ? vl_pbrt_image(x, t, VL_PBRT_COLORS, name)
             : put_changed_image(x, t, as_is, name);
}

static void put_mapping(vlExport *x, const vlTextureDef *t) {
  double m[6];
  vl_export_st_from_uv(t, m);
  PUT(" \"string mapping\" \"%s\"", vl_texture_mappings[t->mapping]);
  if (t->mapping == VL_MAPPING_UV) {
    if (m[1] != 0 || m[3] != 0)
      vl_export_lose(x, "textures that are turned: only moved and scaled");
    PUT(" \"float uscale\" [%.9g] \"float vscale\" [%.9g] \"float udelta\" [%.9g] "
        "\"float vdelta\" [%.9g]",
        m[0], m[4], m[2], m[5]);
  }
  if (t->mapping == VL_MAPPING_PLANAR)
    PUT(" \"vector3 v1\" [%.9g %.9g %.9g] \"vector3 v2\" [%.9g %.9g %.9g] "
        "\"float udelta\" [%.9g] \"float vdelta\" [%.9g]",
        (double)t->planar_v1[0], (double)t->planar_v1[1], (double)t->planar_v1[2],
        (double)t->planar_v2[0], (double)t->planar_v2[1], (double)t->planar_v2[2],
        (double)t->du, (double)t->dv);
  if (t->uv_set)
    vl_export_lose(x, "uv sets beyond the first: the first stands in");
}

static bool put_image(vlExport *x, const vlTextureDef *t, Change change) {
  const vlWrap wrap = t->wrap == VL_WRAP_MIRROR ? VL_WRAP_REPEAT : t->wrap;
  bool even = t->tint[0] == t->tint[1] && t->tint[1] == t->tint[2];
  bool white = even && t->tint[0] == 1;
  bool plain = t->spectrum ? white || (even && !t->invert)
                           : white && t->tint[3] == 1 && t->channel < 0 && t->bias == 0 &&
                                 isnan(t->cutoff) && !change.squared;
  plain = plain && !changes_color(change);
  char name[300];
  if (!(plain ? vl_pbrt_image(x, t, VL_PBRT_VALUES, name)
              : put_changed_image(x, t, change, name)))
    return false;
  if (t->wrap == VL_WRAP_MIRROR)
    vl_export_lose(x, "images that repeat in a mirror: repeated plainly");
  if (vl_export_wrap_t(t) != t->wrap)
    vl_export_lose(x, "wrap modes of their own for each axis: that of s");
  if (t->colors)
    vl_export_lose(x, "colours of vertices: left out");
  if (t->spectrum)
    vl_pbrt_lose_space(x, t->space, t->image);
  if (!t->spectrum && !isnan(t->cutoff))
    vl_export_lose(x, "thresholds of textures: of each texel, before these are interpolated");
  double scale = (double)t->scale * (t->spectrum ? (double)t->tint[0] : 1);
  PUT(" \"string filename\" \"%s\" \"string wrap\" \"%s\" \"string filter\" \"%s\"", name,
      vl_texture_wraps[wrap], vl_texture_filters[t->filter]);
  if (plain && scale != 1)
    PUT(" \"float scale\" [%.9g]", scale);
  if (plain && t->invert)
    PUT(" \"bool invert\" true");
  if (plain && t->encoding_given) {
    if (t->encoding == VL_ENCODING_GAMMA)
      PUT(" \"string encoding\" \"gamma %.9g\"", (double)t->gamma);
    else
      PUT(" \"string encoding\" \"%s\"", t->encoding == VL_ENCODING_LINEAR ? "linear" : "sRGB");
  }
  return true;
}

/* ---- textures ---------------------------------------------------------------------------- */

static bool put_texture(vlExport *x, uint32_t id, Change change, int depth, char name[64]);
static bool prepare_color(vlExport *x, const vlSpectrumInput *input, Change change,
                          vlPbrtInput *result);

/* Whether the kind or the mapping needs a transform; world_from_texture receives it. */
static bool is_placed(const vlTextureDef *t, const vlKindRow *row, vlMat4 *world_from_texture) {
  bool mapped = vl_row_find(row, "mapping") != NULL, placed = !mapped;
  for (uint32_t i = 0; i < row->parameter_count && !mapped; i++)
    if (row->parameters[i].offset == offsetof(vlTextureDef, texture_from_world))
      mapped = true;
  if (!mapped)
    return false;
  placed = placed || t->mapping != VL_MAPPING_UV ||
           (t->kind == VL_TEXTURE_CHECKERBOARD && t->dimension == 3);
  return placed && vl_mat4_inverse(vl_mat4_load(t->texture_from_world), world_from_texture);
}

/* The parameters of the mapping are left to put_mapping. */
static vlPbrtWished wish(VL_UNUSED const void *def, const vlParameter *p) {
  return vl_has_word("mapping uscale vscale udelta vdelta v1 v2", p->name)
             ? VL_PBRT_NEVER
             : VL_PBRT_UNLESS_DEFAULT;
}

/* Writes the texture again for each use; names are numbered in file order. name is empty when
 * there is no texture. */
static bool put_texture(vlExport *x, uint32_t id, Change change, int depth, char name[64]) {
  const vlTextureDef *t = &x->scene->textures.items[id - 1];
  const vlKindRow *row = vl_kind_row(&vl_texture_family, (int)t->kind);
  vlPbrtParameter list[VL_PBRT_PARAMETERS];
  bool image = t->kind == VL_TEXTURE_IMAGE;
  if (depth > 16)
    return vl_export_fail(x, VL_ERROR_SCENE, "textures stand in each other too deep");
  if (!row->name || (change.squared && !image)) {
    vl_export_lose(x, row->name ? "squares of computed textures: a value stands in"
                                : "colours of vertices: left out");
    name[0] = 0;
    return true;
  }
  if (!image && !vl_pbrt_prepare(x, row, t, t->spectrum, wish, depth + 1, list))
    return false;
  if (!image && changes_color(change))
    vl_export_lose(x, "colours of computed textures: not adapted to pbrt's materials");
  snprintf(name, 64, "texture%u-%zu", id, x->text.data.count);
  vlMat4 world_from_texture;
  bool placed = is_placed(t, row, &world_from_texture);
  if (placed) {
    PUT("AttributeBegin\n");
    vl_pbrt_matrix(x, world_from_texture.m);
  }
  PUT("Texture \"%s\" \"%s\" \"%s\"", name, t->spectrum ? "spectrum" : "float", row->name);
  if (image && !put_image(x, t, change))
    return false;
  if (!image)
    vl_pbrt_put(x, row, t, t->spectrum, list);
  bool solid = t->kind == VL_TEXTURE_CHECKERBOARD && t->dimension == 3;
  if (vl_row_find(row, "mapping") && !solid)
    put_mapping(x, t);
  PUT(placed ? "\nAttributeEnd\n" : "\n");
  return true;
}

bool vl_pbrt_inner_number(vlExport *x, const vlFloatInput *input, int depth,
                          vlPbrtInput *result) {
  *result = (vlPbrtInput){.number = input->value};
  return !input->texture.index ||
         put_texture(x, input->texture.index, as_is, depth, result->texture);
}

bool vl_pbrt_inner_color(vlExport *x, const vlSpectrumInput *input, int depth,
                         vlPbrtInput *result) {
  if (depth == 0)
    return prepare_color(x, input, as_is, result);
  *result = (vlPbrtInput){.spectrum = input->value};
  return !input->texture.index ||
         put_texture(x, input->texture.index, as_is, depth, result->texture);
}

/* ---- inputs ------------------------------------------------------------------------------ */

bool vl_pbrt_prepare_number(vlExport *x, const vlFloatInput *input, bool squared,
                            vlPbrtInput *result) {
  *result = (vlPbrtInput){0};
  if (input->texture.index &&
      !put_texture(x, input->texture.index, (Change){.squared = squared}, 0, result->texture))
    return false;
  float v = result->texture[0] ? 0 : vl_export_number(x, input);
  result->number = squared ? v * v : v;
  return true;
}

static bool prepare_color(vlExport *x, const vlSpectrumInput *input, Change change,
                          vlPbrtInput *result) {
  float rgb[3];
  *result = (vlPbrtInput){.spectrum = input->value};
  if (input->texture.index && !put_texture(x, input->texture.index, change, 0, result->texture))
    return false;
  if (result->texture[0] || (!input->texture.index && !changes_color(change)))
    return true;
  vl_export_rgb(x, input, rgb);
  for (int i = 0; i < 3; i++)
    rgb[i] = change_color(rgb[i], change);
  result->spectrum = vl_spectrum_rgb(rgb[0], rgb[1], rgb[2]);
  return true;
}

bool vl_pbrt_prepare_color(vlExport *x, const vlSpectrumInput *input, vlPbrtInput *result) {
  return prepare_color(x, input, as_is, result);
}

/* A coat reflects a share G of the light from a diffuse base back to it. A base of colour c
 * then appears as c (1 - G) / (1 - c G). With F the mean Fresnel reflectance from outside, 1 -
 * G = (1 - F) / eta^2. */
bool vl_pbrt_prepare_under_coat(vlExport *x, const vlSpectrumInput *input, double eta,
                                vlPbrtInput *result) {
  enum { STEPS = 64 };
  double f = 0;
  for (int i = 0; i < STEPS; i++) {
    double c = (i + 0.5) / STEPS, t = sqrt(1 - (1 - c * c) / (eta * eta));
    double s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
    f += 2 * c / STEPS * 0.5 * (s * s + p * p);
  }
  return prepare_color(x, input, (Change){.turned_back = (float)(1 - (1 - f) / (eta * eta))},
                       result);
}

bool vl_pbrt_prepare_raised(vlExport *x, const vlSpectrumInput *input, float white,
                            vlPbrtInput *result) {
  return prepare_color(x, input, (Change){.raised = white}, result);
}

bool vl_pbrt_prepare_metal(vlExport *x, const vlSpectrumInput *input, float alpha,
                           vlPbrtInput *result) {
  const double a = alpha < 1 ? (double)alpha : 1;
  float table[METAL_STEPS + 1];
  make_metal_table(table);
  /* 1 - E, averaged over all directions: a fit, within 0.0025, to the integral over GGX's
   * visible normals */
  const double lost = a * (0.138 + a * (1.784 + a * (-2.104 + 0.774 * a)));
  return prepare_color(x, input, (Change){.metal = table, .lost = (float)lost}, result);
}

void vl_pbrt_put_number(vlExport *x, const char *name, const vlPbrtInput *input) {
  if (input->texture[0])
    PUT(" \"texture %s\" \"%s\"", name, input->texture);
  else
    PUT(" \"float %s\" [%.9g]", name, (double)input->number);
}

void vl_pbrt_put_color(vlExport *x, const char *name, const vlPbrtInput *input) {
  if (input->texture[0])
    PUT(" \"texture %s\" \"%s\"", name, input->texture);
  else
    vl_pbrt_spectrum(x, name, &input->spectrum);
}
