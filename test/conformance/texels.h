/* conformance/texels.h: the values of images at points of their own: each way in which an image
 * goes on outside of itself, one texel or an interpolation between four, and what the numbers
 * of the texture (scale, inversion, tint, channel, bias, cutoff) make of them, for images of
 * one to four channels, of floats and of bytes, as colours and as numbers. Rays wider than many
 * images side by side see the mean of one. */
#ifndef TEST_CONFORMANCE_TEXELS_H
#define TEST_CONFORMANCE_TEXELS_H

#include "conformance.h"
#include "texture/node.h"
#include "unit.h"
#include "velo/material.h"
#include "velo/texture.h"
#include "world/world.h"

enum { TEXELS_WIDE = 5, TEXELS_HIGH = 3 };
/* Of each number format; the last ones fold. */
enum { TEXEL_WORLDS = 112, FOLDED_WORLDS = 16 };
/* The square's texture coordinates go from -TEXELS_OUT to 1 + TEXELS_OUT. */
#define TEXELS_OUT 2.3

/* One texture and the numbers of its texels. */
typedef struct TexelCase {
  vlTextureDef def;
  uint32_t channels;
  bool number; /* a float texture */
  bool bytes;  /* an image of bytes */
  float texels[TEXELS_HIGH][TEXELS_WIDE][4];
  vlTraceRays *rays;
  vlTraceHits *hits;
  uint32_t index;
} TexelCase;

/* ---- by definition ----------------------------------------------------------------------- */

/* The index of a texel of the image; -1: black. */
static int32_t index_inside(int32_t i, int32_t size, vlWrap wrap) {
  if (wrap == VL_WRAP_BLACK)
    return i < 0 || i >= size ? -1 : i;
  if (wrap == VL_WRAP_CLAMP)
    return i < 0 ? 0 : i >= size ? size - 1 : i;
  while (i < 0 || i >= size) {
    if (wrap == VL_WRAP_MIRROR)
      i = i < 0 ? -1 - i : 2 * size - 1 - i;
    else
      i += i < 0 ? size : -size;
  }
  return i;
}

/* Beyond an edge of a sphere's octahedral square its own other half goes on (pbrt book 3.8.3):
 * one goes on at the place that is mirrored along the edge. */
static void fold(int32_t *across, int32_t size, int32_t *along, int32_t length) {
  if (*across >= 0 && *across < size)
    return;
  *across = *across < 0 ? -1 - *across : 2 * size - 1 - *across;
  *along = length - 1 - *along;
}

static double texel_at(const TexelCase *t, int32_t x, int32_t y, uint32_t channel) {
  if (t->def.wrap == VL_WRAP_OCTAHEDRAL) {
    fold(&x, TEXELS_WIDE, &y, TEXELS_HIGH);
    fold(&y, TEXELS_HIGH, &x, TEXELS_WIDE);
    x = index_inside(x, TEXELS_WIDE, VL_WRAP_CLAMP);
    y = index_inside(y, TEXELS_HIGH, VL_WRAP_CLAMP);
    return (double)t->texels[y][x][channel];
  }
  int32_t column = index_inside(x, TEXELS_WIDE, t->def.wrap);
  int32_t row = index_inside(y, TEXELS_HIGH, t->def.wrap_t_given ? t->def.wrap_t : t->def.wrap);
  return column < 0 || row < 0 ? 0 : (double)t->texels[row][column][channel];
}

/* x, y: texels from the image's top left corner. */
static double image_at(const TexelCase *t, double x, double y, uint32_t channel) {
  if (t->def.filter == VL_FILTER_POINT)
    return texel_at(t, (int32_t)floor(x), (int32_t)floor(y), channel);
  int32_t column = (int32_t)floor(x - 0.5);
  int32_t row = (int32_t)floor(y - 0.5);
  double right = x - 0.5 - column;
  double below = y - 0.5 - row;
  return (1 - below) * ((1 - right) * texel_at(t, column, row, channel) +
                        right * texel_at(t, column + 1, row, channel)) +
         below * ((1 - right) * texel_at(t, column, row + 1, channel) +
                  right * texel_at(t, column + 1, row + 1, channel));
}

/* Red, green, blue and coverage. Of grey images all colours are the grey; without coverage it
 * is 1. */
static void rgba_at(const TexelCase *t, double x, double y, double rgba[4]) {
  bool grey = t->channels < 3;
  bool covers = t->channels % 2 == 0;
  for (uint32_t c = 0; c < 4; c++) {
    rgba[c] = (double)t->def.tint[c];
    if (c == 3 && !covers)
      continue;
    uint32_t channel = c == 3 ? t->channels - 1 : grey ? 0 : c;
    double value = image_at(t, x, y, channel) * (double)t->def.scale;
    rgba[c] *= t->def.invert ? 1 - value : value;
  }
}

static double number_before_cutoff(const TexelCase *t, const double rgba[4]) {
  double value = (rgba[0] + rgba[1] + rgba[2]) / 3;
  if (t->def.channel >= 0)
    value = rgba[t->def.channel];
  else if (t->channels == 4)
    value = rgba[3];
  return value + (double)t->def.bias;
}

static double number_of(const TexelCase *t, const double rgba[4]) {
  double value = number_before_cutoff(t, rgba);
  return isnan(t->def.cutoff) ? value : value >= t->def.cutoff ? 1 : 0;
}

/* ---- asking ------------------------------------------------------------------------------ */

/* Near the edge of a texel, or of a cutoff, rounding decides. A square that folds is defined up
 * to its own size beyond its edges. */
static bool is_decided(const TexelCase *t, double x, double y, double number) {
  double cutoff = t->def.cutoff;
  if (t->def.wrap == VL_WRAP_OCTAHEDRAL &&
      !(fabs(x / TEXELS_WIDE - 0.5) < 1.2 && fabs(y / TEXELS_HIGH - 0.5) < 1.2))
    return false;
  if (!isnan(cutoff) && fabs(number - cutoff) < 1e-4)
    return false;
  return fabs(x - rint(x)) > 1e-3 && fabs(y - rint(y)) > 1e-3;
}

static void ask_texels(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  TexelCase *t = probe->user;
  double worst = 0;
  uint32_t compared = 0;
  set_rays_down(t->rays);
  vl_world_trace(trace, t->rays, t->hits);
  for (uint32_t i = 0; i < VL_OWN_BATCH; i++) {
    double s = (1 + 2 * TEXELS_OUT) * 0.5 * ((double)t->rays->origin[0][i] + 1) - TEXELS_OUT;
    double up = (1 + 2 * TEXELS_OUT) * 0.5 * ((double)t->rays->origin[1][i] + 1) - TEXELS_OUT;
    double x = TEXELS_WIDE * s;
    double y = TEXELS_HIGH * (1 - up);
    double rgba[4];
    rgba_at(t, x, y, rgba);
    if (!is_decided(t, x, y, number_before_cutoff(t, rgba)))
      continue;
    compared++;
    for (int c = 0; c < 3; c++) {
      double known = t->number ? number_of(t, rgba) : rgba[c];
      known = fmin(fmax(known, 0), 1); /* what a reflectance can be */
      worst = fmax(worst, fabs((double)t->hits->reflectance[c][i] - known));
    }
  }
  if (compared < VL_OWN_BATCH / (t->def.wrap == VL_WRAP_OCTAHEDRAL ? 8 : 2))
    broken("textures", "imagemap", "texels, world %u: %u points compared", t->index, compared);
  if (!(worst < 2e-3))
    broken("textures", "imagemap",
           "texels, world %u (%u channels of %s, wrap %d, filter %d, %s): off by %.4f",
           t->index, t->channels, t->bytes ? "bytes" : "floats", (int)t->def.wrap,
           (int)t->def.filter, t->number ? "a number" : "a colour", worst);
}

/* ---- worlds ------------------------------------------------------------------------------ */

/* Multiples of 1/255, which bytes hold. */
static void set_texels(TexelCase *t) {
  for (int y = 0; y < TEXELS_HIGH; y++)
    for (int x = 0; x < TEXELS_WIDE; x++)
      for (int c = 0; c < 4; c++)
        t->texels[y][x][c] =
            (float)(26 + 13 * ((7 * x + 11 * y + 5 * c + x * y * 3) % 16)) / 255;
}

/* The image of world `index`, and what its texture makes of it: all ways to go on outside, both
 * filters, all numbers of channels, with each change of the values. */
static void choose_texture(TexelCase *t, uint32_t index) {
  static const vlWrap wraps[] = {VL_WRAP_REPEAT, VL_WRAP_BLACK, VL_WRAP_CLAMP, VL_WRAP_MIRROR};
  t->index = index;
  t->number = index / 4 % 2 == 1;
  t->channels = 1 + index / 8 % 4;
  t->def = vl_default_texture_def(VL_TEXTURE_IMAGE, !t->number);
  bool folded = index >= TEXEL_WORLDS - FOLDED_WORLDS;
  t->def.wrap = folded ? VL_WRAP_OCTAHEDRAL : wraps[index % 4];
  t->def.wrap_t_given = !folded && index % 3 == 1;
  t->def.wrap_t = wraps[index / 3 % 4];
  t->def.filter = index / 32 == 1 ? VL_FILTER_POINT : VL_FILTER_BILINEAR;
  t->def.su = t->def.sv = (float)(1 + 2 * TEXELS_OUT);
  t->def.du = t->def.dv = (float)-TEXELS_OUT;
  uint32_t change = (index + index / 8) % 5;
  if (change == 1) {
    t->def.scale = 0.6f;
    t->def.invert = true;
  }
  for (int c = 0; change == 2 && c < 4; c++)
    t->def.tint[c] = 0.9f - 0.15f * (float)c;
  if (change == 3) {
    t->def.channel = (int)(index % 4);
    t->def.bias = -0.05f;
  }
  if (change == 4)
    t->def.cutoff = 0.45;
  set_texels(t);
}

/* Adds the square with the texture as its reflectance to a scene. */
static void add_textured_square(vlScene *scene, const TexelCase *t, const vlImage *image) {
  vlTextureDef def = t->def;
  def.image = image;
  vlTextureId texture = vl_scene_add_texture(scene, &def);
  if (t->number) {
    vlTextureDef scale = vl_default_texture_def(VL_TEXTURE_SCALE, true);
    scale.spectrum_a.value = vl_spectrum_rgb(1, 1, 1);
    scale.amount.texture = texture;
    texture = vl_scene_add_texture(scene, &scale);
  }
  vlMaterialDef material = vl_default_material_def(VL_MATERIAL_DIFFUSE);
  material.reflectance.texture = texture;
  add_square(scene, &material);
}

static vlImage *image_of_texels(const TexelCase *t) {
  vlImage *image;
  vlImageDef def = vl_default_image_def(TEXELS_WIDE, TEXELS_HIGH, t->channels);
  def.encoding = VL_ENCODING_LINEAR;
  if (t->bytes)
    def.type = VL_PIXEL_U8;
  assert_int_equal(vl_image_create(context, &def, &image), VL_OK);
  float *floats = vl_image_pixels(image);
  uint8_t *bytes = vl_image_pixels(image);
  for (uint32_t y = 0; y < TEXELS_HIGH; y++)
    for (uint32_t x = 0; x < TEXELS_WIDE; x++)
      for (uint32_t c = 0; c < t->channels; c++) {
        const size_t at = (y * TEXELS_WIDE + x) * t->channels + c;
        if (t->bytes)
          bytes[at] = (uint8_t)lrintf(255 * t->texels[y][x][c]);
        else
          floats[at] = t->texels[y][x][c];
      }
  return image;
}

static void ask_square(TexelCase *t, void (*ask)(Probe *, vlTrace *, const vlOwnPaths *)) {
  vlImage *image = image_of_texels(t);
  vlScene *scene = need_scene(HEAD "WorldBegin LightSource \"infinite\"");
  add_textured_square(scene, t, image);
  vl_image_destroy(image);
  Probe probe = {.ask = ask, .user = t};
  probe_scene(scene, "texels", &probe, 1);
}

/* ---- the widest rays --------------------------------------------------------------------- */

/* The mean of the image, but for the rounding of its coarser levels to bytes. */
static void ask_widest(Probe *probe, vlTrace *trace, const vlOwnPaths *paths) {
  (void)paths;
  TexelCase *t = probe->user;
  static const double widths[] = {32, 1e3, 1e9, 1e18};
  double mean[3] = {0};
  for (int y = 0; y < TEXELS_HIGH; y++)
    for (int x = 0; x < TEXELS_WIDE; x++)
      for (int c = 0; c < 3; c++)
        mean[c] += (double)t->texels[y][x][c] / (TEXELS_WIDE * TEXELS_HIGH);
  for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
    double worst = 0;
    set_rays_down(t->rays);
    for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
      t->rays->width[i] = (float)widths[w];
    vl_world_trace(trace, t->rays, t->hits);
    for (uint32_t i = 0; i < VL_OWN_BATCH; i++)
      for (int c = 0; c < 3; c++)
        worst = fmax(worst, fabs((double)t->hits->reflectance[c][i] - mean[c]));
    if (!(worst < (t->bytes ? 3.0 / 255 : 1e-5)))
      broken("textures", "imagemap", "rays of width %g: off the mean of %s by %.5f", widths[w],
             t->bytes ? "bytes" : "floats", worst);
  }
}

static void check_widest(TexelCase *t, bool bytes) {
  t->channels = 3;
  t->number = false;
  t->bytes = bytes;
  t->def = vl_default_texture_def(VL_TEXTURE_IMAGE, true);
  t->def.filter = VL_FILTER_TRILINEAR;
  set_texels(t);
  ask_square(t, ask_widest);
}

/* ---- at single points -------------------------------------------------------------------- */

/* Coverage is read at single points, without a batch: vertex colours and other sets of texture
 * coordinates count there, too. The square's second set is its first one, turned; its colours
 * are linear in x and y. */
static double covered_at(const vlTextureDef *texture, float x, float y) {
  static const float corners[12] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  static const float uvs[8] = {0, 0, 1, 0, 1, 1, 0, 1};
  static const float turned[8] = {0, 0, 0, 1, 1, 1, 1, 0};
  static const float colors[16] = {.1f, .1f, .1f, 1, .5f, .5f, .5f, 1,
                                   .9f, .9f, .9f, 1, .5f, .5f, .5f, 1};
  vlError error = {0};
  vlWorld *world;
  vlScene *scene = need_scene(HEAD "WorldBegin LightSource \"infinite\"");
  vlShapeDef square = square_def();
  square.positions = corners;
  square.uvs = uvs;
  square.more_uvs[0] = turned;
  square.colors = colors;
  square.alpha.texture = vl_scene_add_texture(scene, texture);
  vl_scene_add_shape(scene, &square);
  assert_int_equal(vl_world_build(scene, NULL, &world, &error), VL_OK);
  /* a point of the first triangle, x >= y */
  const vlTextureCorner corner = {&world->shapes.items[0], 0, {1 - x, x - y, y}};
  const vlTextureQuery query = {x, y, {x, y, 0}, {0, 0, 1}, &corner};
  const float value = vl_texture_float_at(world, world->shapes.items[0].alpha, &query);
  vl_world_destroy(world);
  vl_scene_destroy(scene);
  return (double)value;
}

static void check_single_points(void) {
  static const float points[3][2] = {{0.6f, 0.1f}, {0.8f, 0.3f}, {0.9f, 0.7f}};
  vlTextureDef of_colors = vl_default_texture_def(VL_TEXTURE_VERTEX_COLOR, false);
  vlTextureDef second = vl_default_texture_def(VL_TEXTURE_BILERP, false);
  second.float_a.value = 0;
  second.float_b.value = 0.1f; /* (0, 1) */
  second.float_c.value = 0.7f; /* (1, 0) */
  second.float_d.value = 0.8f;
  second.uv_set = 1;
  for (int i = 0; i < 3; i++) {
    const float x = points[i][0];
    const float y = points[i][1];
    const double by_color = 0.1 + 0.4 * (double)(x + y);
    const double by_second = 0.7 * (double)y + 0.1 * (double)x;
    if (!(fabs(covered_at(&of_colors, x, y) - by_color) < 1e-5))
      broken("textures", "vertex color", "at one point %.4f, not %.4f",
             covered_at(&of_colors, x, y), by_color);
    if (!(fabs(covered_at(&second, x, y) - by_second) < 1e-5))
      broken("textures", "bilerp", "by the second set of coordinates %.4f, not %.4f",
             covered_at(&second, x, y), by_second);
  }
}

static void laws_of_texels(void **state) {
  (void)state;
  TexelCase *t = calloc(1, sizeof *t);
  assert_non_null(t);
  t->rays = new_rays();
  t->hits = calloc(1, sizeof *t->hits);
  for (uint32_t i = 0; i < 2 * TEXEL_WORLDS; i++) {
    choose_texture(t, i % TEXEL_WORLDS);
    t->bytes = i >= TEXEL_WORLDS;
    ask_square(t, ask_texels);
  }
  check_widest(t, false);
  check_widest(t, true);
  free(t->rays);
  free(t->hits);
  free(t);
  check_single_points();
  expect_no_failures();
}

#endif
