/* material/principled_energy.hot.c: computes the energies of the principled material's layers
 * (directional albedos from tables, thin film, sheen) and from these the probabilities of the
 * lobes. Table lookups are scalar because they do not vectorise. */
#include "material/principled.hot.h"

/* ---- thin film --------------------------------------------------------------------------- */

/* Reflectance of two parallel interfaces for one polarisation, with all reflections between
 * them. */
static float interfere(float first, float second, float phase) {
  float product = first * second,
        sum = first * first + second * second + 2.0f * product * phase;
  float down = 1.0f + product * product + 2.0f * product * phase;
  /* numerator and denominator are 0 if two opposite total reflections meet at grazing angles */
  float r = sum / vl_max(down, VL_MIN_POSITIVE);
  return vl_clamp(r, 0.0f, 1.0f);
}

/* Reflectance of a film of index n2 and thickness d (nm) over a base with reflectance f0 at
 * normal incidence (as a dielectric of index n3), in air: Airy's sum, both polarisations.
 * Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for the Modeling of
 * Varying Iridescence", evaluated at single wavelengths, so that no integral is needed. */
static float airy(float cosine, float n2, float n3, float d, float lambda) {
  float sin2 = 1.0f - cosine * cosine;
  float c2 = vl_safe_sqrt(1.0f - sin2 / (n2 * n2));
  float c3 = vl_safe_sqrt(1.0f - sin2 / (n3 * n3));
  float s12 = (cosine - n2 * c2) / (cosine + n2 * c2),
        p12 = (n2 * cosine - c2) / (n2 * cosine + c2);
  float s23 = (n2 * c2 - n3 * c3) / (n2 * c2 + n3 * c3),
        p23 = (n3 * c2 - n2 * c3) / (n3 * c2 + n2 * c3);
  float phase = vl_sincos(4.0f * VL_PI * n2 * d * c2 / lambda).cos;
  return 0.5f * (interfere(s12, s23, phase) + interfere(p12, p23, phase));
}

/* Wavelengths (nm) for R, G and B in RGB mode: three per channel, spread over the channel's
 * sensitivity. */
static const float rgb_lambda[3][3] = {{595, 615, 635}, {525, 545, 565}, {435, 452, 470}};

static float film_reflection(const vlPrincipledSlice *s, uint32_t i, int channel, float cosine,
                             float f0) {
  float root = __builtin_sqrtf(vl_clamp(f0, 0.0f, 0.9999f));
  float n3 = (1.0f + root) / (1.0f - root), n2 = s->row[VL_P_FILM_INDEX][i],
        d = s->row[VL_P_FILM_NM][i];
  const float grazing = 1e-4f; /* 0.006 degrees from the horizon, where the reflectance is 1 to
                                  three digits; it also replaces NaNs in padding lanes */
  float c = cosine > grazing ? vl_min(cosine, 1.0f) : grazing;
  if (s->lambda[channel])
    return airy(c, n2, n3, d, s->lambda[channel][i]);
  if (channel == 3)
    return 0.0f;
  float sum = 0.0f;
  for (int k = 0; k < 3; k++)
    sum += airy(c, n2, n3, d, rgb_lambda[channel][k]);
  return sum * (1.0f / 3.0f);
}

/* ---- directional albedos ----------------------------------------------------------------- */

/* Positions in the albedo tables, for a chunk. */
typedef struct Cells {
  int32_t alpha[VL_PRINCIPLED_CHUNK], cosine[VL_PRINCIPLED_CHUNK];
  float alpha_t[VL_PRINCIPLED_CHUNK], cosine_t[VL_PRINCIPLED_CHUNK];
} Cells;

VL_NOINLINE void find_cells(const vlPrincipledSlice *s, const float *z, Cells *p) {
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float a = vl_base_alpha(s->alpha_x[i], s->alpha_y[i]), c = vl_abs(z[i]);
    a = __builtin_sqrtf(a < 1.0f ? a : 1.0f) * (float)(VL_ALBEDO_ALPHA - 1);
    c = __builtin_sqrtf(c < 1.0f ? c : 1.0f) * (float)(VL_ALBEDO_COS - 1);
    int32_t ia = (int32_t)a, ic = (int32_t)c;
    ia = ia < VL_ALBEDO_ALPHA - 2 ? ia : VL_ALBEDO_ALPHA - 2;
    ic = ic < VL_ALBEDO_COS - 2 ? ic : VL_ALBEDO_COS - 2;
    p->alpha[i] = ia > 0 ? ia : 0;
    p->cosine[i] = ic > 0 ? ic : 0;
    p->alpha_t[i] = a - (float)ia;
    p->cosine_t[i] = c - (float)ic;
  }
}

/* Scalar, since not every instruction set has gathers. */
VL_NOINLINE void look_up(const Cells *p, uint32_t count, float *a, float *b) {
  const vlPrincipledTables *t = &vl_principled_tables;
  for (uint32_t i = 0; i < count; i++) {
    vlAlbedoCell alpha = {(uint32_t)p->alpha[i], p->alpha_t[i]},
                 c = {(uint32_t)p->cosine[i], p->cosine_t[i]};
    a[i] = vl_albedo_at(t->a, alpha, c);
    b[i] = vl_albedo_at(t->b, alpha, c);
  }
}

VL_NOINLINE void look_up_means(const Cells *p, uint32_t count, float *a, float *b) {
  const vlPrincipledTables *t = &vl_principled_tables;
  for (uint32_t i = 0; i < count; i++) {
    vlAlbedoCell alpha = {(uint32_t)p->alpha[i], p->alpha_t[i]};
    a[i] = vl_albedo_mean(t->a_mean, alpha);
    b[i] = vl_albedo_mean(t->b_mean, alpha);
  }
}

/* Turns albedos of an isotropic layer into those of an anisotropic one. */
static void stretch_pair(float loss, float edge, float *a, float *b) {
  float one = 1.0f - loss * (1.0f - *a - *b);
  *b *= edge;
  *a = vl_max(one - *b, 0.0f);
}

static bool is_stretched(const vlPrincipledSlice *s, uint32_t i) {
  return s->alpha_x[i] != s->alpha_y[i];
}

static vlStretch stretch_of(const vlPrincipledSlice *s, uint32_t i, vlVec3 w) {
  return vl_stretch_of(s->alpha_x[i], s->alpha_y[i], w);
}

static void stretch_albedos(const vlPrincipledSlice *s, const float *x, const float *y,
                            const float *z, float *a, float *b) {
  for (uint32_t i = 0; i < s->count; i++) {
    if (!is_stretched(s, i))
      continue;
    vlStretch at = stretch_of(s, i, vl_lane3(x, y, z, i));
    stretch_pair(vl_stretched_at(VL_STRETCHED_LOSS, at), vl_stretched_at(VL_STRETCHED_B, at),
                 a + i, b + i);
  }
}

static void stretch_means(const vlPrincipledSlice *s, float *a, float *b) {
  for (uint32_t i = 0; i < s->count; i++) {
    if (!is_stretched(s, i))
      continue;
    vlStretch at = stretch_of(s, i, vl_vec3(0.0f, 0.0f, 1.0f));
    stretch_pair(vl_stretched_mean(VL_STRETCHED_LOSS, at),
                 vl_stretched_mean(VL_STRETCHED_B, at), a + i, b + i);
  }
}

/* Computes the dielectric's specular albedo F0 a + F90 b. */
VL_NOINLINE void energies(const vlPrincipledSlice *s, const float *a, const float *b,
                          float energy[4][VL_PRINCIPLED_CHUNK], float *one) {
  uint32_t count = VL_WHOLE(s->count);
  for (int c = 0; c < 4; c++) {
    /* must vectorise */
    VL_SIMD for (uint32_t i = 0; i < count; i++) {
      float e = s->row[VL_P_F0 + c][i] * a[i] + s->row[VL_P_F90][i] * b[i];
      energy[c][i] = e < 0.9999f ? e : 0.9999f;
    }
  }
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float sum = a[i] + b[i];
    one[i] = sum < 0.999999f ? sum : 0.999999f;
  }
}

/* Computes the base's energies with a thin film from the film's reflectance at the cosines z.
 * If z is null, computes the mean over cosines, by Gauss-Legendre quadrature in cos^2. */
static void film_energies(const vlPrincipledSlice *s, const float *z, const float *one,
                          float energy[4][VL_PRINCIPLED_CHUNK]) {
  for (uint32_t i = 0; i < s->count; i++) {
    float film = s->row[VL_P_FILM][i];
    if (!(film > 0.0f))
      continue;
    for (int c = 0; c < 4; c++) {
      float f0 = s->row[VL_P_F0 + c][i];
      float r = z ? film_reflection(s, i, c, vl_abs(z[i]), f0)
                  : (5.0f * film_reflection(s, i, c, 0.33571f, f0) +
                     8.0f * film_reflection(s, i, c, 0.70711f, f0) +
                     5.0f * film_reflection(s, i, c, 0.94197f, f0)) *
                        (1.0f / 18.0f);
      float e = energy[c][i] + film * (r * one[i] - energy[c][i]);
      energy[c][i] = e < 0.9999f ? e : 0.9999f;
    }
  }
}

static float brightest_sheen(const vlPrincipledSlice *s, uint32_t i) {
  const float *const *row = &s->row[VL_P_SHEEN];
  return vl_largest4(row[0][i], row[1][i], row[2][i], row[3][i]);
}

/* Computes the coat's albedo for directions with cosine z to the coat's normal; z null: the
 * mean albedo. In `directions`, up is the side of wo. */
static void coat_energies(const vlPrincipledSlice *s, const vlPrincipledLanes *l,
                          const float *x, const float *y, const float *z, float *energy) {
  const vlPrincipledTables *t = &vl_principled_tables;
  for (uint32_t i = 0; i < s->count; i++) {
    float coat = s->row[VL_P_COAT][i];
    energy[i] = 0.0f;
    if (!(coat > 0.0f))
      continue;
    vlAlbedoCell alpha = vl_albedo_cell(s->row[VL_P_COAT_ALPHA][i], VL_ALBEDO_ALPHA);
    if (!z) {
      energy[i] =
          coat * (0.04f * vl_albedo_mean(t->a_mean, alpha) + vl_albedo_mean(t->b_mean, alpha));
      continue;
    }
    vlVec3 n = vl_principled_coat(s, i, l->side[i]);
    vlAlbedoCell c = vl_albedo_cell(vl_abs(vl_dot(vl_lane3(x, y, z, i), n)), VL_ALBEDO_COS);
    energy[i] = coat * (0.04f * vl_albedo_at(t->a, alpha, c) + vl_albedo_at(t->b, alpha, c));
  }
}

static void sheen_at_view(const vlPrincipledSlice *s, vlPrincipledLanes *l) {
  const vlPrincipledTables *t = &vl_principled_tables;
  for (uint32_t i = 0; i < s->count; i++) {
    float fuzz = brightest_sheen(s, i);
    if (!(fuzz > 0.0f))
      continue;
    vlAlbedoCell rough = vl_albedo_cell(s->row[VL_P_SHEEN_ALPHA][i], VL_ALBEDO_ALPHA);
    l->sheen_raw[i] = vl_albedo_at(t->sheen, rough, vl_albedo_cell(l->z[i], VL_ALBEDO_COS));
    l->sheen_o[i] = fuzz * vl_min(l->sheen_raw[i], 1.0f);
    l->sheen_mean[i] = fuzz * vl_albedo_mean(t->sheen_mean, rough);
  }
}

static void sheen_at_light(const vlPrincipledSlice *s, vlBsdfDirections wo, vlBsdfDirections wi,
                           const float *z, vlPrincipledLanes *l) {
  const vlPrincipledTables *t = &vl_principled_tables;
  for (uint32_t i = 0; i < s->count; i++) {
    float fuzz = brightest_sheen(s, i), c = vl_abs(z[i]);
    if (!(fuzz > 0.0f))
      continue;
    float alpha = s->row[VL_P_SHEEN_ALPHA][i];
    float raw = vl_albedo_at(t->sheen, vl_albedo_cell(alpha, VL_ALBEDO_ALPHA),
                             vl_albedo_cell(c, VL_ALBEDO_COS));
    float max = vl_max(vl_max(raw, l->sheen_raw[i]), 1.0f);
    vlVec3 h = vl_normalize(vl_vec3(wo.x[i] + wi.x[i], wo.y[i] + wi.y[i], l->z[i] + c));
    l->sheen_i[i] = fuzz * vl_min(raw, 1.0f);
    l->sheen_value[i] =
        l->z[i] > 0.0f && z[i] > 0.0f ? vl_sheen(l->z[i], z[i], h.z, alpha) / max : 0.0f;
  }
}

/* ---- multiple scattering in a transmissive solid's surface ------------------------------- */

/* The boundary of a lane for one direction. */
typedef struct Boundary {
  vlAlbedoCell index, alpha, cosine;
  vlStretch at;
  bool stretched;
} Boundary;

static Boundary boundary_of(const vlPrincipledSlice *s, uint32_t i, vlVec3 w) {
  Boundary b = {
      .index = vl_loss_cell(s->eta[i]),
      .alpha = vl_albedo_cell(vl_base_alpha(s->alpha_x[i], s->alpha_y[i]), VL_LOSS_ALPHA),
      .cosine = vl_albedo_cell(vl_abs(w.z), VL_LOSS_COS),
      .stretched = is_stretched(s, i)};
  if (b.stretched)
    b.at = stretch_of(s, i, w);
  return b;
}

static float loss_of(const Boundary *b, uint32_t side) {
  float loss = vl_loss_at(side, b->index, b->alpha, b->cosine);
  return b->stretched ? loss * vl_stretched_at(VL_STRETCHED_OUTSIDE + side, b->at) : loss;
}

static float mean_loss(const Boundary *b, uint32_t side) {
  float mean = vl_loss_mean(side, b->index, b->alpha);
  return b->stretched ? mean * vl_stretched_mean(VL_STRETCHED_OUTSIDE + side, b->at) : mean;
}

/* Kulla and Conty 2017, extended to a boundary that transmits light. m(w) is the fraction of
 * energy that single scattering loses for direction w, M its mean over the cosine-weighted
 * hemisphere, n the index inside divided by that outside, and T the mean of 1 - F from outside.
 * The lost energy is scattered back uniformly to both sides:
 *     f_up(o, i)   = (1 - p) m(o) m(i) / (pi M)
 *     f_down(o, i) = n_o^2 T m(o) m(i) / (pi max(n^2 M_in, M_out))
 *     p_out = T n^2 M_in / max(n^2 M_in, M_out),  p_in = T M_out / max(n^2 M_in, M_out)
 * If radiance divided by the squared index is the same everywhere (a furnace), each side gets
 * back its loss, and f is reciprocal. */
static void losses_at_view(const vlPrincipledSlice *s, vlBsdfDirections wo,
                           vlPrincipledLanes *l) {
  for (uint32_t i = 0; i < s->count; i++) {
    float eta = s->eta[i];
    if (s->row[VL_P_THIN][i] > 0.0f || !(s->row[VL_P_TRANSMISSION][i] > 0.0f) || !(eta > 1.0f))
      continue;
    Boundary b = boundary_of(s, i, vl_lane3(wo.x, wo.y, wo.z, i));
    uint32_t side = l->inside[i] > 0.0f;
    l->loss_o[i] = loss_of(&b, side);
    for (uint32_t k = 0; k < 2; k++)
      l->loss_mean[k][i] = vl_max(mean_loss(&b, side ^ k), VL_MIN_FRACTION);
    float here = l->loss_mean[0][i], there = l->loss_mean[1][i],
          n2 = side ? 1.0f / (eta * eta) : eta * eta;
    l->again_pass[i] = n2 * there / vl_max(here, n2 * there);
    float f0 = s->row[VL_P_F0][i], mean = f0 + (s->row[VL_P_F90][i] - f0) * (1.0f / 21.0f);
    float passes = l->again_pass[i] * (1.0f - mean), lost = l->loss_o[i] / (1.0f - l->one_o[i]);
    l->lost_up[i] = lost * (1.0f - passes);
    l->lost_down[i] = lost * passes;
  }
}

static void losses_at_light(const vlPrincipledSlice *s, vlBsdfDirections wi, const float *z,
                            vlPrincipledLanes *l) {
  for (uint32_t i = 0; i < s->count; i++) {
    float eta = s->eta[i], c = vl_abs(z[i]);
    if (!(l->loss_mean[0][i] > 0.0f))
      continue;
    Boundary b = boundary_of(s, i, vl_lane3(wi.x, wi.y, z, i));
    uint32_t side = l->inside[i] > 0.0f, crosses = z[i] < 0.0f;
    float both = l->loss_o[i] * loss_of(&b, side ^ crosses) * c * VL_INV_PI;
    float here = l->loss_mean[0][i], there = l->loss_mean[1][i],
          n2 = side ? 1.0f / (eta * eta) : eta * eta;
    l->again_up[i] = both / here;
    l->again_down[i] = both / vl_max(here, n2 * there);
  }
}

/* Computes the probabilities of the lobes, roughly in proportion to their energies. Each lobe
 * whose value can be above 0 has a probability above 0. */
VL_NOINLINE void weigh(const vlPrincipledSlice *s, const float *coat_cos,
                       vlPrincipledLanes *l) {
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float b0 = s->base[0][i], b1 = s->base[1][i], b2 = s->base[2][i], b3 = s->base[3][i];
    float e0 = l->energy_o[0][i], e1 = l->energy_o[1][i], e2 = l->energy_o[2][i],
          e3 = l->energy_o[3][i];
    float base = vl_mean4(b0, b1, b2, b3), energy = vl_mean4(e0, e1, e2, e3);
    float seen =
        vl_mean4(b0 * (1.0f - e0), b1 * (1.0f - e1), b2 * (1.0f - e2), b3 * (1.0f - e3));
    float through = vl_mean4(s->row[VL_P_THROUGH][i], s->row[VL_P_THROUGH + 1][i],
                             s->row[VL_P_THROUGH + 2][i], s->row[VL_P_THROUGH + 3][i]);
    float metal = s->row[VL_P_METALLIC][i], dielectric = 1.0f - metal,
          clear = s->row[VL_P_TRANSMISSION][i], shares = s->row[VL_P_DIFFUSE_TRANSMISSION][i];
    float inside = l->inside[i], f0 = s->row[VL_P_F0][i];
    float cover = (1.0f - l->coat_o[i]) * (1.0f - l->sheen_o[i]);
    cover = inside > 0.0f ? 1.0f : cover;
    vlOuterCosine outer = vl_outer_cosine(l->z[i], s->eta[i]);
    float inner = f0 + (s->row[VL_P_F90][i] - f0) * vl_schlick_weight(outer.cosine);
    inner = outer.total ? 1.0f : inner;
    float reflected = inside > 0.0f ? inner : energy;
    float mirror = cover * (metal * (base > 0.02f ? base : 0.02f) + dielectric * reflected) +
                   VL_P_MIN_MIRROR;
    float lost = 1.0f - l->one_o[i];
    float matt = cover * (dielectric * (1.0f - clear) * (1.0f - shares) * seen +
                          (metal * base + dielectric * clear * l->lost_up[i]) * lost) +
                 l->sheen_o[i];
    float coat = ((coat_cos[i] > VL_P_COAT_HORIZON) & (inside == 0.0f)) ? 1.0f : 0.0f;
    coat = coat * l->coat_o[i];
    float refract = cover * dielectric * clear * base * (1.0f - reflected);
    float beyond = cover * dielectric *
                   ((1.0f - clear) * shares * through * (1.0f - energy) +
                    clear * base * lost * l->lost_down[i]);
    float inverse = 1.0f / (mirror + matt + coat + refract + beyond);
    l->specular[i] = mirror * inverse;
    l->diffuse[i] = matt * inverse;
    l->coat[i] = coat * inverse;
    l->refract[i] = refract * inverse;
    l->through[i] = beyond * inverse;
  }
}

void vl_principled_view(const vlPrincipledSlice *s, vlBsdfDirections wo, vlPrincipledLanes *l) {
  float a[VL_PRINCIPLED_CHUNK], b[VL_PRINCIPLED_CHUNK], coat_cos[VL_PRINCIPLED_CHUNK];
  const float *thin = s->row[VL_P_THIN];
  uint32_t count = VL_WHOLE(s->count);
  VL_SIMD
  for (uint32_t i = 0; i < count; i++) {
    float z = wo.z[i], solid = 1.0f - thin[i];
    l->z[i] = vl_abs(z);
    l->side[i] = z < 0.0f ? -1.0f : 1.0f;
    l->inside[i] = z < 0.0f ? solid : 0.0f;
    l->coat_o[i] = l->coat_mean[i] = l->sheen_o[i] = l->sheen_mean[i] = l->sheen_raw[i] =
        coat_cos[i] = 0.0f;
    l->loss_mean[0][i] = l->again_up[i] = l->again_down[i] = l->again_pass[i] = 0.0f;
    l->lost_up[i] = l->lost_down[i] = 1.0f;
    l->coat_i[i] = l->sheen_i[i] = l->sheen_value[i] = 0.0f;
    for (int c = 0; c < 4; c++)
      l->film[c][i] = 0.0f;
  }
  Cells cells;
  find_cells(s, l->z, &cells);
  look_up_means(&cells, count, a, b);
  if (s->anisotropic)
    stretch_means(s, a, b);
  energies(s, a, b, l->energy_mean, l->one_mean);
  if (s->film)
    film_energies(s, NULL, l->one_mean, l->energy_mean);
  look_up(&cells, count, a, b);
  if (s->anisotropic)
    stretch_albedos(s, wo.x, wo.y, l->z, a, b);
  energies(s, a, b, l->energy_o, l->one_o);
  if (s->film)
    film_energies(s, l->z, l->one_o, l->energy_o);
  if (s->coat) {
    coat_energies(s, l, wo.x, wo.y, l->z, l->coat_o);
    coat_energies(s, l, NULL, NULL, NULL, l->coat_mean);
    for (uint32_t i = 0; i < count; i++)
      coat_cos[i] = vl_dot(vl_lane3(wo.x, wo.y, l->z, i), vl_principled_coat(s, i, l->side[i]));
  }
  if (s->sheen)
    sheen_at_view(s, l);
  if (s->solid)
    losses_at_view(s, wo, l);
  weigh(s, coat_cos, l);
}

void vl_principled_light(const vlPrincipledSlice *s, vlBsdfDirections wo, vlBsdfDirections wi,
                         vlPrincipledLanes *l) {
  float a[VL_PRINCIPLED_CHUNK], b[VL_PRINCIPLED_CHUNK], z[VL_PRINCIPLED_CHUNK];
  uint32_t count = VL_WHOLE(s->count);
  for (uint32_t i = 0; i < count; i++)
    z[i] = wi.z[i] * l->side[i];
  Cells cells;
  find_cells(s, z, &cells);
  look_up(&cells, count, a, b);
  if (s->anisotropic)
    stretch_albedos(s, wi.x, wi.y, z, a, b);
  energies(s, a, b, l->energy_i, l->one_i);
  if (s->coat)
    coat_energies(s, l, wi.x, wi.y, z, l->coat_i);
  if (s->sheen)
    sheen_at_light(s, wo, wi, z, l);
  if (s->solid)
    losses_at_light(s, wi, z, l);
  if (!s->film)
    return;
  film_energies(s, z, l->one_i, l->energy_i);
  for (uint32_t i = 0; i < count; i++) {
    if (!(s->row[VL_P_FILM][i] > 0.0f))
      continue;
    vlVec3 o = vl_lane3(wo.x, wo.y, l->z, i),
           h = vl_normalize(vl_vec3(o.x + wi.x[i], o.y + wi.y[i], o.z + vl_abs(z[i])));
    for (int c = 0; c < 4; c++) {
      float f0 = s->row[VL_P_F0 + c][i];
      f0 = f0 + s->row[VL_P_METALLIC][i] * (s->base[c][i] - f0);
      l->film[c][i] = film_reflection(s, i, c, vl_dot(o, h), f0);
    }
  }
}
