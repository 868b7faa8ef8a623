/* texture.c: constant, scale, mix, checkerboard, image and bilinear textures. */
#include "texture.h"

#include <stdlib.h>
#include <string.h>

#include "refuse.h"

enum { INPUTS = 4 };

static const vlTextureDef *texture_of(const world *w, vlTextureId id) {
  return vl_scene_texture(w->scene, id);
}

/* ---- reading ----------------------------------------------------------------------------------------------------- */

static bool read_image(const vlTextureDef *def, vlContext *context, image_map *map, vlError *error) {
  vlImage *image = NULL;
  vlResult r = VL_OK;
  if (def->path) r = vl_image_read(context, def->path, &image, error);
  if (def->data) r = vl_image_read_memory(context, "image", def->data, def->data_size, &image, error);
  if (r != VL_OK) return false;
  const vlImage *given = image ? image : def->image;
  bool ok = make_image_map(given, def->encoding_given ? &def->encoding : NULL, (double)def->gamma, map);
  vl_image_destroy(image);
  return ok || refuse(error, def->source, "memory for the image", "is used up");
}

static bool is_supported(const vlTextureDef *def, vlError *error) {
  switch (def->kind) {
    case VL_TEXTURE_CONSTANT:
    case VL_TEXTURE_SCALE:
    case VL_TEXTURE_MIX:
    case VL_TEXTURE_CHECKERBOARD:
    case VL_TEXTURE_IMAGE:
    case VL_TEXTURE_BILERP: break;
    default: return refuse_kind(error, def->source, "textures", (uint32_t)def->kind);
  }
  if (def->uv_set) return refuse(error, def->source, "a texture over a second uv set", NULL);
  if (def->colors) return refuse(error, def->source, "a texture with vertex colours", NULL);
  return true;
}

bool read_textures(world *w, vlError *error) {
  while (texture_of(w, (vlTextureId){w->texture_count + 1})) w->texture_count++;
  w->images = calloc(w->texture_count + 1, sizeof *w->images);
  w->texture_colors = calloc((size_t)INPUTS * (w->texture_count + 1), sizeof *w->texture_colors);
  if (!w->images || !w->texture_colors) return refuse_memory(error);
  for (uint32_t i = 0; i < w->texture_count; i++) {
    const vlTextureDef *def = texture_of(w, (vlTextureId){i + 1});
    if (!is_supported(def, error)) return false;
    if (def->kind == VL_TEXTURE_IMAGE && !read_image(def, w->context, &w->images[i], error)) return false;
    const vlSpectrumInput *inputs[INPUTS] = {&def->spectrum_a, &def->spectrum_b, &def->spectrum_c, &def->spectrum_d};
    for (int k = 0; def->spectrum && k < INPUTS; k++) {
      color *own = &w->texture_colors[INPUTS * i + (uint32_t)k];
      if (!read_color(&inputs[k]->value, VL_PARAMETER_ALBEDO, own, error)) return false;
    }
  }
  return true;
}

void free_textures(world *w) {
  for (uint32_t i = 0; w->images && i < w->texture_count; i++) free_image_map(&w->images[i]);
  free(w->images);
  free(w->texture_colors);
}

/* ---- texture coordinates (pbrt book 10.2) ------------------------------------------------------------------------ */

static vector in_texture_space(const vlTextureDef *def, const shade_record *at) {
  matrix m = load_matrix(def->texture_from_world);
  return transform_point(&m, at->point);
}

static square_point coordinates(const vlTextureDef *def, const shade_record *at) {
  if (def->st_from_uv_given) {
    const float *m = def->st_from_uv;
    return (square_point){(double)m[0] * at->u + (double)m[1] * at->v + (double)m[2],
                          (double)m[3] * at->u + (double)m[4] * at->v + (double)m[5]};
  }
  vector p = in_texture_space(def, at);
  double phi = atan2(p.y, p.x);
  switch (def->mapping) {
    case VL_MAPPING_UV:
      return (square_point){(double)def->su * at->u + (double)def->du, (double)def->sv * at->v + (double)def->dv};
    case VL_MAPPING_SPHERICAL: {
      vector d = normalize(p);
      return (square_point){acos(clamp(d.z, -1, 1)) / PI, (phi < 0 ? phi + 2 * PI : phi) / (2 * PI)};
    }
    case VL_MAPPING_CYLINDRICAL: return (square_point){(PI + phi) / (2 * PI), p.z};
    case VL_MAPPING_PLANAR:
      return (square_point){(double)def->du + dot(p, from_floats(def->planar_v1)),
                            (double)def->dv + dot(p, from_floats(def->planar_v2))};
  }
  return (square_point){0, 0};
}

/* ---- values ------------------------------------------------------------------------------------------------------ */

/* Which square or cube of the board: 0 or 1, the weight of the second input. */
static double checker(const vlTextureDef *def, const shade_record *at) {
  long sum;
  if (def->dimension == 3) {
    vector p = in_texture_space(def, at);
    sum = (long)floor(p.x) + (long)floor(p.y) + (long)floor(p.z);
  } else {
    square_point st = coordinates(def, at);
    sum = (long)floor(st.x) + (long)floor(st.y);
  }
  return (double)(sum & 1);
}

/* The four values of an image texture: red, green, blue, coverage. Texture coordinate t points up, rows go down. */
static void texel(const world *w, const vlTextureDef *def, uint32_t index, const shade_record *at, double value[4]) {
  const image_map *map = &w->images[index];
  square_point st = coordinates(def, at);
  vlWrap wrap_t = def->wrap_t_given ? def->wrap_t : def->wrap;
  if (def->filter == VL_FILTER_POINT)
    pixel_of(map, (long)floor(st.x * map->width), (long)floor((1 - st.y) * map->height), def->wrap, wrap_t, value);
  else
    pixels_around(map, st.x, 1 - st.y, def->wrap, wrap_t, value);
  for (int c = 0; c < 4; c++) {
    bool coverage_of_grey = c == 3 && (map->channels == 1 || map->channels == 3);
    double v = coverage_of_grey ? 1 : value[c] * (double)def->scale;
    if (def->invert && !coverage_of_grey) v = 1 - v;
    value[c] = fmax(0, v) * (double)def->tint[c];
  }
}

/* An image as one number: the channel that the texture selects, else coverage if there is one, else the mean. */
static double number_of_image(const world *w, const vlTextureDef *def, uint32_t index, const shade_record *at) {
  double value[4];
  texel(w, def, index, at, value);
  double number = w->images[index].channels == 4 ? value[3] : (value[0] + value[1] + value[2]) / 3;
  if (def->channel >= 0) number = value[def->channel];
  number += (double)def->bias;
  if (def->cutoff == def->cutoff) number = number >= def->cutoff ? 1 : 0;
  return number;
}

double number_at(const world *w, vlFloatInput input, const shade_record *at) {
  const vlTextureDef *def = texture_of(w, input.texture);
  if (!def) return (double)input.value;
  switch (def->kind) {
    case VL_TEXTURE_CONSTANT: return number_at(w, def->float_a, at);
    case VL_TEXTURE_SCALE: return number_at(w, def->float_a, at) * number_at(w, def->amount, at);
    case VL_TEXTURE_MIX:
    case VL_TEXTURE_CHECKERBOARD: {
      double share = def->kind == VL_TEXTURE_MIX ? number_at(w, def->amount, at) : checker(def, at);
      return (1 - share) * number_at(w, def->float_a, at) + share * number_at(w, def->float_b, at);
    }
    case VL_TEXTURE_BILERP: {
      square_point st = coordinates(def, at);
      double low = (1 - st.y) * number_at(w, def->float_a, at) + st.y * number_at(w, def->float_b, at);
      double high = (1 - st.y) * number_at(w, def->float_c, at) + st.y * number_at(w, def->float_d, at);
      return (1 - st.x) * low + st.x * high;
    }
    case VL_TEXTURE_IMAGE: return number_of_image(w, def, input.texture.index - 1, at);
    default: return 0; /* is_supported has refused the others */
  }
}

void texel_at(const world *w, vlTextureId texture, const shade_record *at, double rgb[3]) {
  double value[4];
  texel(w, texture_of(w, texture), texture.index - 1, at, value);
  for (int c = 0; c < 3; c++) rgb[c] = value[c];
}

spectrum spectrum_at(const world *w, vlSpectrumInput input, const color *own, vlParameterRole role,
                     const shade_record *at, const wavelengths *lambda) {
  const vlTextureDef *def = texture_of(w, input.texture);
  if (!def) return color_at(own, lambda);
  const color *colors = &w->texture_colors[INPUTS * (input.texture.index - 1)];
  if (def->kind == VL_TEXTURE_IMAGE) {
    double rgb[3];
    texel_at(w, input.texture, at, rgb);
    return role == VL_PARAMETER_ALBEDO ? reflectance_of(def->space, rgb, lambda)
                                       : unbounded_of(def->space, rgb, lambda);
  }
  spectrum a = spectrum_at(w, def->spectrum_a, &colors[0], role, at, lambda);
  if (def->kind == VL_TEXTURE_CONSTANT) return a;
  if (def->kind == VL_TEXTURE_SCALE) return scaled(number_at(w, def->amount, at), a);
  spectrum b = spectrum_at(w, def->spectrum_b, &colors[1], role, at, lambda);
  if (def->kind == VL_TEXTURE_BILERP) {
    square_point st = coordinates(def, at);
    spectrum c = spectrum_at(w, def->spectrum_c, &colors[2], role, at, lambda);
    spectrum d = spectrum_at(w, def->spectrum_d, &colors[3], role, at, lambda);
    spectrum low = plus(scaled(1 - st.y, a), scaled(st.y, b));
    spectrum high = plus(scaled(1 - st.y, c), scaled(st.y, d));
    return plus(scaled(1 - st.x, low), scaled(st.x, high));
  }
  double share = def->kind == VL_TEXTURE_MIX ? number_at(w, def->amount, at) : checker(def, at);
  return plus(scaled(1 - share, a), scaled(share, b));
}
