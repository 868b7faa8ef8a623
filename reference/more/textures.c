/* more/textures.c: mixtures, bilinear and procedural textures, and texture coordinates from points (pbrt book 10.2). */
#include "more.h"

static vector in_texture_space(const vlTextureDef *def, const shade_record *at) {
  matrix texture_from_world = load_matrix(def->texture_from_world);
  return transform_point(&texture_from_world, at->point);
}

square_point more_coordinates(const vlTextureDef *def, const shade_record *at) {
  if (def->st_from_uv_given) {
    const float *m = def->st_from_uv;
    return (square_point){(double)m[0] * at->u + (double)m[1] * at->v + (double)m[2],
                          (double)m[3] * at->u + (double)m[4] * at->v + (double)m[5]};
  }
  vector p = in_texture_space(def, at);
  double phi = atan2(p.y, p.x);
  switch (def->mapping) {
    case VL_MAPPING_SPHERICAL: {
      vector d = normalize(p);
      return (square_point){acos(clamp(d.z, -1, 1)) / PI, (phi < 0 ? phi + 2 * PI : phi) / (2 * PI)};
    }
    case VL_MAPPING_CYLINDRICAL: return (square_point){(PI + phi) / (2 * PI), p.z};
    case VL_MAPPING_PLANAR:
      return (square_point){(double)def->du + dot(p, from_floats(def->planar_v1)),
                            (double)def->dv + dot(p, from_floats(def->planar_v2))};
    default: return (square_point){0, 0};
  }
}

/* The shares of the inputs a to d: a mixture has two; a bilinear texture has them at the corners of its square. */
static void shares_of(const world *w, const vlTextureDef *def, const shade_record *at, double share[4]) {
  square_point st = texture_coordinates(def, at);
  bool corners = def->kind == VL_TEXTURE_BILERP;
  double s = corners ? st.x : 0, second = corners ? st.y : 0;
  if (def->kind == VL_TEXTURE_MIX) second = number_at(w, def->amount, at);
  if (def->kind == VL_TEXTURE_DIRECTION_MIX) /* the first where the normal is along the direction */
    second = 1 - fabs(dot(at->normal, normalize(from_floats(def->direction))));
  if (def->kind == VL_TEXTURE_DOTS) second = is_in_dot(st) ? 1 : 0;
  for (int k = 0; k < 4; k++) share[k] = (k & 1 ? second : 1 - second) * (k & 2 ? s : 1 - s);
}

double more_number(const world *w, const vlTextureDef *def, const shade_record *at) {
  vector p = in_texture_space(def, at);
  if (def->kind == VL_TEXTURE_FBM) return fbm(p, (double)def->omega, def->octaves);
  if (def->kind == VL_TEXTURE_WRINKLED) return turbulence(p, (double)def->omega, def->octaves);
  if (def->kind == VL_TEXTURE_WINDY) return fabs(fbm(scale(0.1, p), 0.5, 3)) * fbm(p, 0.5, 6);
  const vlFloatInput inputs[4] = {def->float_a, def->float_b, def->float_c, def->float_d};
  double share[4], sum = 0;
  shares_of(w, def, at, share);
  for (int k = 0; k < 4; k++) sum += share[k] == 0 ? 0 : share[k] * number_at(w, inputs[k], at);
  return sum;
}

spectrum more_spectrum(const world *w, const vlTextureDef *def, vlParameterRole role, const shade_record *at,
                       const wavelengths *lambda) {
  if (def->kind == VL_TEXTURE_MARBLE) {
    double rgb[3];
    vector p = scale((double)def->scale, in_texture_space(def, at));
    marble(p, (double)def->omega, def->octaves, (double)def->variation, rgb);
    return texel_spectrum(VL_SPACE_SRGB, rgb, role, lambda);
  }
  const vlSpectrumInput *inputs[4] = {&def->spectrum_a, &def->spectrum_b, &def->spectrum_c, &def->spectrum_d};
  double share[4];
  spectrum sum = gray(0);
  shares_of(w, def, at, share);
  for (int k = 0; k < 4; k++)
    if (share[k] != 0) sum = plus(sum, scaled(share[k], spectrum_at(w, inputs[k], role, at, lambda)));
  return sum;
}

void adjust_texel(const vlTextureDef *def, uint32_t channels, double value[4]) {
  for (int c = 0; c < 4; c++) {
    bool missing = c == 3 && channels % 2 == 1; /* an image without coverage covers all */
    double v = missing ? 1 : value[c] * (double)def->scale;
    if (def->invert && !missing) v = 1 - v;
    value[c] = fmax(0, v) * (double)def->tint[c];
  }
}

double number_of_texel(const vlTextureDef *def, uint32_t channels, const double value[4]) {
  double number = channels == 4 ? value[3] : (value[0] + value[1] + value[2]) / 3;
  if (def->channel >= 0) number = value[def->channel];
  number += (double)def->bias;
  if (isnan(def->cutoff)) return number;
  return number >= def->cutoff ? 1 : 0;
}
