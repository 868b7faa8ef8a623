/* trace/bsdf_principled_energy.hot.c: how the principled material's layers share the light: what each reflects in all
 * directions together (tables), the thin film, the sheen, and from it the chances of the lobes. Scalar, since tables
 * do not vectorise. */
#include "trace/bsdf_principled.h"

/* ---- thin film --------------------------------------------------------------------------------------------------- */

/* Reflection of a film of index n2 and thickness d (nm) over a base that reflects f0 at normal incidence (taken as a
 * dielectric of that index), in air: Airy's sum, both polarisations. Belcour and Barla 2017, "A Practical Extension to
 * Microfacet Theory for the Modeling of Varying Iridescence", for one wavelength: nothing need be integrated. */
static float airy(float cosine, float n2, float n3, float d, float lambda) {
  float sin2 = 1.0f - cosine * cosine;
  float c2 = __builtin_sqrtf(vl_max(0.0f, 1.0f - sin2 / (n2 * n2)));
  float c3 = __builtin_sqrtf(vl_max(0.0f, 1.0f - sin2 / (n3 * n3)));
  float s12 = (cosine - n2 * c2) / (cosine + n2 * c2), p12 = (n2 * cosine - c2) / (n2 * cosine + c2);
  float s23 = (n2 * c2 - n3 * c3) / (n2 * c2 + n3 * c3), p23 = (n3 * c2 - n2 * c3) / (n3 * c2 + n2 * c3);
  float phase = vl_sincos(4.0f * VL_PI * n2 * d * c2 / lambda).cos;
  float s = s12 * s23, p = p12 * p23;
  float rs = (s12 * s12 + s23 * s23 + 2.0f * s * phase) / (1.0f + s * s + 2.0f * s * phase);
  float rp = (p12 * p12 + p23 * p23 + 2.0f * p * phase) / (1.0f + p * p + 2.0f * p * phase);
  return 0.5f * (rs + rp);
}

/* Wavelengths that stand for R, G, B where there is no spectrum: three a channel, across its sensitivity. */
static const float rgb_lambda[3][3] = {{595, 615, 635}, {525, 545, 565}, {435, 452, 470}};

static float film_reflection(const vlPrincipledSlice *s, uint32_t i, int channel, float cosine, float f0) {
  float root = __builtin_sqrtf(vl_clamp(f0, 0.0f, 0.9999f));
  float n3 = (1.0f + root) / (1.0f - root), n2 = s->row[VL_P_FILM_INDEX][i], d = s->row[VL_P_FILM_NM][i];
  float c = vl_clamp(cosine, 1e-4f, 1.0f);
  if (s->lambda[channel]) return airy(c, n2, n3, d, s->lambda[channel][i]);
  if (channel == 3) return 0.0f;
  float sum = 0.0f;
  for (int k = 0; k < 3; k++) sum += airy(c, n2, n3, d, rgb_lambda[channel][k]);
  return sum * (1.0f / 3.0f);
}

/* ---- directional albedos ----------------------------------------------------------------------------------------- */

/* The dielectric's specular albedo at a cosine, or its mean. a, b: from the tables. */
static float mixed_energy(const vlPrincipledSlice *s, uint32_t i, int c, float cosine, float a, float b) {
  float f0 = s->row[VL_P_F0 + c][i], e = f0 * a + s->row[VL_P_F90][i] * b, film = s->row[VL_P_FILM][i];
  if (film > 0.0f) {
    float r;
    if (cosine >= 0.0f) {
      r = film_reflection(s, i, c, cosine, f0);
    } else { /* the mean: Gauss-Legendre in cos^2 */
      r = (5.0f * film_reflection(s, i, c, 0.33571f, f0) + 8.0f * film_reflection(s, i, c, 0.70711f, f0) +
           5.0f * film_reflection(s, i, c, 0.94197f, f0)) *
          (1.0f / 18.0f);
    }
    e = e + film * (r * (a + b) - e);
  }
  return e < 0.9999f ? e : 0.9999f;
}

static float brightest(const vlPrincipledSlice *s, uint32_t row, uint32_t i) {
  return vl_max(vl_max(s->row[row][i], s->row[row + 1][i]), vl_max(s->row[row + 2][i], s->row[row + 3][i]));
}

static float base_alpha(const vlPrincipledSlice *s, uint32_t i) {
  return __builtin_sqrtf(s->alpha_x[i] * s->alpha_y[i]);
}

/* Share that the coat reflects of light at this cosine to its normal. */
static float coat_energy(const vlPrincipledSlice *s, uint32_t i, float cosine) {
  vlAlbedoPlace alpha = vl_albedo_place(s->row[VL_P_COAT_ALPHA][i], VL_ALBEDO_ALPHA),
                c = vl_albedo_place(vl_abs(cosine), VL_ALBEDO_COS);
  const vlPrincipledTables *t = &vl_principled_tables;
  return s->row[VL_P_COAT][i] * (0.04f * vl_albedo_at(t->a, alpha, c) + vl_albedo_at(t->b, alpha, c));
}

void VL_HOT(vl_principled_view)(const vlPrincipledSlice *s, vlBsdfDirections wo, uint32_t first, vlPrincipledLanes *l) {
  const vlPrincipledTables *t = &vl_principled_tables;
  for (uint32_t i = 0; i < s->count; i++) {
    float oz = wo.z[first + i], z = vl_abs(oz), side = oz < 0.0f ? -1.0f : 1.0f;
    l->z[i] = z, l->side[i] = side;
    float inside = side < 0.0f && s->row[VL_P_THIN][i] == 0.0f ? 1.0f : 0.0f;
    l->inside[i] = inside;
    vlAlbedoPlace alpha = vl_albedo_place(base_alpha(s, i), VL_ALBEDO_ALPHA), c = vl_albedo_place(z, VL_ALBEDO_COS);
    float a = vl_albedo_at(t->a, alpha, c), b = vl_albedo_at(t->b, alpha, c);
    float am = vl_albedo_mean(t->a_mean, alpha), bm = vl_albedo_mean(t->b_mean, alpha);
    l->one_o[i] = vl_min(a + b, 1.0f), l->one_mean[i] = vl_min(am + bm, 0.999999f);
    float base = 0.0f, energy = 0.0f, seen = 0.0f, through = 0.0f, metal = s->row[VL_P_METALLIC][i];
    for (int k = 0; k < 4; k++) {
      l->energy_o[k][i] = mixed_energy(s, i, k, z, a, b);
      l->energy_mean[k][i] = mixed_energy(s, i, k, -1.0f, am, bm);
      base += 0.25f * s->base[k][i];
      through += 0.25f * s->row[VL_P_THROUGH + k][i];
      energy += 0.25f * l->energy_o[k][i];
      seen += 0.25f * s->base[k][i] * (1.0f - l->energy_o[k][i]);
    }
    vlVec3 n = vl_principled_coat(s, i, side), o = vl_vec3(wo.x[first + i], wo.y[first + i], z);
    float coat_cos = vl_dot(o, n);
    l->coat_o[i] = l->coat_mean[i] = 0.0f;
    if (s->row[VL_P_COAT][i] > 0.0f) {
      vlAlbedoPlace rough = vl_albedo_place(s->row[VL_P_COAT_ALPHA][i], VL_ALBEDO_ALPHA);
      l->coat_o[i] = coat_energy(s, i, coat_cos);
      l->coat_mean[i] =
          s->row[VL_P_COAT][i] * (0.04f * vl_albedo_mean(t->a_mean, rough) + vl_albedo_mean(t->b_mean, rough));
    }
    l->sheen_o[i] = l->sheen_i[i] = l->sheen_mean[i] = l->sheen_raw[i] = l->sheen_value[i] = 0.0f;
    float fuzz = brightest(s, VL_P_SHEEN, i);
    if (fuzz > 0.0f) {
      vlAlbedoPlace rough = vl_albedo_place(s->row[VL_P_SHEEN_ALPHA][i], VL_ALBEDO_ALPHA);
      l->sheen_raw[i] = vl_albedo_at(t->sheen, rough, c);
      l->sheen_o[i] = fuzz * vl_min(l->sheen_raw[i], 1.0f);
      l->sheen_mean[i] = fuzz * vl_albedo_mean(t->sheen_mean, rough);
    }
    /* Chances: about what each lobe sends back, none of those that can shine left at 0. */
    float clear = s->row[VL_P_TRANSMISSION][i], shares = s->row[VL_P_DIFFUSE_TRANSMISSION][i];
    float dielectric = 1.0f - metal, f90 = s->row[VL_P_F90][i];
    float cover = inside > 0.0f ? 1.0f : (1.0f - l->coat_o[i]) * (1.0f - l->sheen_o[i]);
    vlOuterCosine outer = vl_outer_cosine(z, s->eta[i]);
    float fresnel = inside > 0.0f ? (outer.total ? 1.0f : vl_schlick_weight(outer.cosine)) : 0.0f;
    float reflected = inside > 0.0f ? s->row[VL_P_F0][i] + (f90 - s->row[VL_P_F0][i]) * fresnel : energy;
    reflected = inside > 0.0f && outer.total ? 1.0f : reflected;
    float mirror = cover * (metal * vl_max(base, 0.02f) + dielectric * reflected) + 1e-3f;
    float matt = cover * (dielectric * (1.0f - clear) * (1.0f - shares) * seen +
                          (metal * base + dielectric * clear) * (1.0f - l->one_o[i])) +
                 l->sheen_o[i];
    float coat = coat_cos > 1e-3f && inside == 0.0f ? l->coat_o[i] : 0.0f;
    float refract = cover * dielectric * clear * base * (1.0f - reflected);
    float beyond = cover * dielectric *
                   ((1.0f - clear) * shares * through * (1.0f - energy) + clear * base * (1.0f - l->one_o[i]));
    float inverse = 1.0f / (mirror + matt + coat + refract + beyond);
    l->specular[i] = mirror * inverse, l->diffuse[i] = matt * inverse, l->coat[i] = coat * inverse;
    l->refract[i] = refract * inverse, l->through[i] = beyond * inverse;
  }
}

void VL_HOT(vl_principled_light)(const vlPrincipledSlice *s, vlBsdfDirections wo, vlBsdfDirections wi, uint32_t first,
                                 vlPrincipledLanes *l) {
  const vlPrincipledTables *t = &vl_principled_tables;
  for (uint32_t i = 0; i < s->count; i++) {
    float side = l->side[i], iz = wi.z[first + i] * side, z = vl_abs(iz);
    vlAlbedoPlace alpha = vl_albedo_place(base_alpha(s, i), VL_ALBEDO_ALPHA), c = vl_albedo_place(z, VL_ALBEDO_COS);
    float a = vl_albedo_at(t->a, alpha, c), b = vl_albedo_at(t->b, alpha, c);
    l->one_i[i] = vl_min(a + b, 1.0f);
    for (int k = 0; k < 4; k++) l->energy_i[k][i] = mixed_energy(s, i, k, z, a, b);
    vlVec3 n = vl_principled_coat(s, i, side);
    vlVec3 o = vl_vec3(wo.x[first + i], wo.y[first + i], l->z[i]), w = vl_vec3(wi.x[first + i], wi.y[first + i], iz);
    l->coat_i[i] = s->row[VL_P_COAT][i] > 0.0f ? coat_energy(s, i, vl_dot(w, n)) : 0.0f;
    vlVec3 h = vl_normalize(vl_vec3(o.x + w.x, o.y + w.y, o.z + z));
    float fuzz = s->sheen ? brightest(s, VL_P_SHEEN, i) : 0.0f;
    if (fuzz > 0.0f) {
      vlAlbedoPlace rough = vl_albedo_place(s->row[VL_P_SHEEN_ALPHA][i], VL_ALBEDO_ALPHA);
      float raw = vl_albedo_at(t->sheen, rough, c), most = vl_max(vl_max(raw, l->sheen_raw[i]), 1.0f);
      l->sheen_i[i] = fuzz * vl_min(raw, 1.0f);
      l->sheen_value[i] =
          l->z[i] > 0.0f && iz > 0.0f ? vl_sheen(l->z[i], iz, h.z, s->row[VL_P_SHEEN_ALPHA][i]) / most : 0.0f;
    }
    for (int k = 0; k < 4; k++) {
      l->film[k][i] = 0.0f;
      if (!(s->row[VL_P_FILM][i] > 0.0f)) continue;
      float metal = s->row[VL_P_METALLIC][i], f0 = s->row[VL_P_F0 + k][i];
      l->film[k][i] = film_reflection(s, i, k, vl_dot(o, h), f0 + metal * (s->base[k][i] - f0));
    }
  }
}
