/* texture.c: scale, checkerboard and image textures. */
#include "more/more.h"

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
  adjust_texel(def, map->channels, value);
}

double number_at(const world *w, vlFloatInput input, const shade_record *at) {
  const vlTextureDef *def = vl_scene_texture(w->scene, input.texture);
  if (!def) return (double)input.value;
  double texel[4];
  switch (def->kind) {
    case VL_TEXTURE_SCALE: return number_at(w, def->float_a, at) * number_at(w, def->amount, at);
    case VL_TEXTURE_CHECKERBOARD: return number_at(w, is_second_square(def, at) ? def->float_b : def->float_a, at);
    case VL_TEXTURE_IMAGE:
      texel_at(&w->images[input.texture.index - 1], def, at, texel);
      return number_of_texel(def, w->images[input.texture.index - 1].channels, texel);
    default: return more_number(w, def, at);
  }
}

spectrum spectrum_at(const world *w, const vlSpectrumInput *input, vlParameterRole role, const shade_record *at,
                     const wavelengths *lambda) {
  const vlTextureDef *def = vl_scene_texture(w->scene, input->texture);
  if (!def) return color_at(find_color(&input->value, role), lambda);
  double texel[4];
  switch (def->kind) {
    case VL_TEXTURE_SCALE:
      return scaled(number_at(w, def->amount, at), spectrum_at(w, &def->spectrum_a, role, at, lambda));
    case VL_TEXTURE_CHECKERBOARD:
      return spectrum_at(w, is_second_square(def, at) ? &def->spectrum_b : &def->spectrum_a, role, at, lambda);
    case VL_TEXTURE_IMAGE:
      texel_at(&w->images[input->texture.index - 1], def, at, texel);
      return texel_spectrum(def->space, texel, role, lambda);
    default: return more_spectrum(w, def, role, at, lambda);
  }
}
