/* texture.c: scale, checkerboard and image textures. */
#include "texture.h"

#include <stdlib.h>

#include "more/more.h"
#include "refuse.h"

enum { INPUTS = 4 };

/* ---- reading ----------------------------------------------------------------------------------------------------- */

static bool check_texture(const vlTextureDef *def, vlError *error) {
  if (def->uv_set) return refuse(error, def->source, "a texture over a second uv set");
  if (def->colors) return refuse(error, def->source, "a texture with vertex colours");
  bool core = def->kind == VL_TEXTURE_SCALE || def->kind == VL_TEXTURE_CHECKERBOARD || def->kind == VL_TEXTURE_IMAGE;
  return core || check_more_texture(def, error);
}

bool read_textures(world *w, vlError *error) {
  const vlTextureDef *def;
  for (uint32_t i = 0; (def = vl_scene_texture(w->scene, (vlTextureId){i + 1})); i++) {
    if (!check_texture(def, error)) return false;
    w->images = resize(w->images, i + 1, sizeof *w->images);
    w->images[i] = (image_map){0};
    w->texture_count = i + 1;
    if (def->kind == VL_TEXTURE_IMAGE && !read_image_map(w->context, def, &w->images[i], error)) return false;
    w->texture_colors = resize(w->texture_colors, INPUTS * ((size_t)i + 1), sizeof *w->texture_colors);
    const vlSpectrumInput *inputs[INPUTS] = {&def->spectrum_a, &def->spectrum_b, &def->spectrum_c, &def->spectrum_d};
    for (uint32_t k = 0; def->spectrum && k < INPUTS; k++) {
      color *own = &w->texture_colors[INPUTS * i + k];
      if (!read_color(&inputs[k]->value, VL_PARAMETER_ALBEDO, own, error)) return false;
    }
  }
  return true;
}

void free_textures(world *w) {
  for (uint32_t i = 0; i < w->texture_count; i++) free_image_map(&w->images[i]);
  free(w->images);
  free(w->texture_colors);
}

/* ---- values ------------------------------------------------------------------------------------------------------ */

/* The surface's own coordinates, scaled and moved; the others are those of more/ (pbrt book 10.2). */
square_point texture_coordinates(const vlTextureDef *def, const shade_record *at) {
  if (def->mapping != VL_MAPPING_UV || def->st_from_uv_given) return more_coordinates(def, at);
  return (square_point){(double)def->su * at->u + (double)def->du, (double)def->sv * at->v + (double)def->dv};
}

/* Which square of the board, or which cube of a board in space: 0 or 1. */
static bool is_second_square(const vlTextureDef *def, const shade_record *at) {
  matrix texture_from_world = load_matrix(def->texture_from_world);
  vector p = transform_point(&texture_from_world, at->point);
  square_point st = texture_coordinates(def, at);
  if (def->dimension != 3) p = make_vector(st.x, st.y, 0);
  return ((long)floor(p.x) + (long)floor(p.y) + (long)floor(p.z)) & 1;
}

/* The four values of an image texture: red, green, blue, coverage. Texture coordinate t points up, rows go down. */
static void texel_at(const image_map *map, const vlTextureDef *def, const shade_record *at, double value[4]) {
  square_point st = texture_coordinates(def, at);
  vlWrap wrap_t = def->wrap_t_given ? def->wrap_t : def->wrap;
  if (def->filter == VL_FILTER_POINT)
    pixel_of(map, (long)floor(st.x * map->width), (long)floor((1 - st.y) * map->height), def->wrap, wrap_t, value);
  else
    pixels_around(map, st.x, 1 - st.y, def->wrap, wrap_t, value);
  for (int c = 0; c < 4; c++) {
    bool missing = c == 3 && !has_coverage(map);
    double v = missing ? 1 : value[c] * (double)def->scale;
    if (def->invert && !missing) v = 1 - v;
    value[c] = fmax(0, v) * (double)def->tint[c];
  }
}

/* An image as one number: the channel that the texture selects, else coverage if there is one, else the mean. */
static double number_of_image(const image_map *map, const vlTextureDef *def, const shade_record *at) {
  double value[4];
  texel_at(map, def, at, value);
  double number = map->channels == 4 ? value[3] : (value[0] + value[1] + value[2]) / 3;
  if (def->channel >= 0) number = value[def->channel];
  number += (double)def->bias;
  if (isnan(def->cutoff)) return number;
  return number >= def->cutoff ? 1 : 0;
}

double number_at(const world *w, vlFloatInput input, const shade_record *at) {
  const vlTextureDef *def = vl_scene_texture(w->scene, input.texture);
  if (!def) return (double)input.value;
  switch (def->kind) {
    case VL_TEXTURE_SCALE: return number_at(w, def->float_a, at) * number_at(w, def->amount, at);
    case VL_TEXTURE_CHECKERBOARD: return number_at(w, is_second_square(def, at) ? def->float_b : def->float_a, at);
    case VL_TEXTURE_IMAGE: return number_of_image(&w->images[input.texture.index - 1], def, at);
    default: return more_number(w, def, at);
  }
}

spectrum spectrum_at(const world *w, vlSpectrumInput input, const color *own, vlParameterRole role,
                     const shade_record *at, const wavelengths *lambda) {
  const vlTextureDef *def = vl_scene_texture(w->scene, input.texture);
  if (!def) return color_at(own, lambda);
  const color *colors = &w->texture_colors[INPUTS * (input.texture.index - 1)];
  double texel[4];
  switch (def->kind) {
    case VL_TEXTURE_SCALE:
      return scaled(number_at(w, def->amount, at), spectrum_at(w, def->spectrum_a, &colors[0], role, at, lambda));
    case VL_TEXTURE_CHECKERBOARD:
      if (is_second_square(def, at)) return spectrum_at(w, def->spectrum_b, &colors[1], role, at, lambda);
      return spectrum_at(w, def->spectrum_a, &colors[0], role, at, lambda);
    case VL_TEXTURE_IMAGE:
      texel_at(&w->images[input.texture.index - 1], def, at, texel);
      return texel_spectrum(def->space, texel, role, lambda);
    default: return more_spectrum(w, def, colors, role, at, lambda);
  }
}
