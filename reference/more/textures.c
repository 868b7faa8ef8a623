/* more/textures.c: mixtures, bilinear and procedural textures, and texture coordinates from points (pbrt book 10.2). */
#include "more.h"
/* ---- texture coordinates ----------------------------------------------------------------------------------------- */

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

/* ---- values ------------------------------------------------------------------------------------------------------ */

/* The share of the second input in a mixture of two. */
static double share_of_second(const world *w, const vlTextureDef *def, const shade_record *at) {
  switch (def->kind) {
    case VL_TEXTURE_MIX: return number_at(w, def->amount, at);
    case VL_TEXTURE_DIRECTION_MIX: /* the first where the normal is along the direction */
      return 1 - fabs(dot(at->normal, normalize(from_floats(def->direction))));
    case VL_TEXTURE_DOTS: return is_in_dot(texture_coordinates(def, at)) ? 1 : 0;
    default: return 0;
  }
}

double more_number(const world *w, const vlTextureDef *def, const shade_record *at) {
  vector p = in_texture_space(def, at);
  if (def->kind == VL_TEXTURE_FBM) return fbm(p, (double)def->omega, def->octaves);
  if (def->kind == VL_TEXTURE_WRINKLED) return turbulence(p, (double)def->omega, def->octaves);
  if (def->kind == VL_TEXTURE_WINDY) return windy_waves(p);
  if (def->kind != VL_TEXTURE_BILERP) {
    double share = share_of_second(w, def, at);
    return (1 - share) * number_at(w, def->float_a, at) + share * number_at(w, def->float_b, at);
  }
  square_point st = texture_coordinates(def, at);
  double low = (1 - st.y) * number_at(w, def->float_a, at) + st.y * number_at(w, def->float_b, at);
  double high = (1 - st.y) * number_at(w, def->float_c, at) + st.y * number_at(w, def->float_d, at);
  return (1 - st.x) * low + st.x * high;
}

spectrum more_spectrum(const world *w, const vlTextureDef *def, vlParameterRole role, const shade_record *at,
                       const wavelengths *lambda) {
  if (def->kind == VL_TEXTURE_MARBLE) {
    double rgb[3];
    vector p = scale((double)def->scale, in_texture_space(def, at));
    marble(p, (double)def->omega, def->octaves, (double)def->variation, rgb);
    return texel_spectrum(VL_SPACE_SRGB, rgb, role, lambda);
  }
  spectrum a = spectrum_at(w, &def->spectrum_a, role, at, lambda);
  spectrum b = spectrum_at(w, &def->spectrum_b, role, at, lambda);
  if (def->kind != VL_TEXTURE_BILERP) {
    double share = share_of_second(w, def, at);
    return plus(scaled(1 - share, a), scaled(share, b));
  }
  square_point st = texture_coordinates(def, at);
  spectrum c = spectrum_at(w, &def->spectrum_c, role, at, lambda);
  spectrum d = spectrum_at(w, &def->spectrum_d, role, at, lambda);
  spectrum low = plus(scaled(1 - st.y, a), scaled(st.y, b));
  spectrum high = plus(scaled(1 - st.y, c), scaled(st.y, d));
  return plus(scaled(1 - st.x, low), scaled(st.x, high));
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
