/* material/layered.hot.c: the BSDF of a dielectric coat over a metal or diffuse base, with a
 * medium between them that may scatter. f is estimated by position-free random walks (Guo,
 * Hasan, Zhao 2018; pbrt book 14.3). A walk begins at wo and is connected with wi at every
 * vertex. Two strategies sample the direction between the layers; multiple importance sampling
 * combines them. Terms that need no walk are exact: the coat's own reflection, and a mirror
 * under a smooth coat.
 *
 * Directions are sampled with a density in closed form (the coat's microfacets, the base's lobe
 * through a smooth coat, a cosine lobe), not by walks. The walks' random numbers depend only on
 * the lane's seed and both directions, so sampling and evaluation give the same bits. The code
 * is scalar because walks diverge. */
#include "material/layers.hot.h"

vlBsdfEval vl_bsdf_layered_eval;
vlBsdfSample vl_bsdf_layered_sample;

static inline float next(uint32_t *state) {
  *state += 0x9e3779b9u;
  return vl_unit_float(vl_hash(*state));
}
static inline float power(float a, float b) {
  float a2 = a * a, b2 = b * b;
  return a2 < VL_INFINITY ? a2 / (a2 + b2) : 1.0f;
}

/* Connects the walk's vertex, reached in direction w, with the direction `to` under the coat
 * that leads to wi. height: optical depth above the base. */
static void join_base(const Layers *l, vlVec3 w, const Step *to, const float beta[4],
                      float f[4]) {
  if (l->mirror || !to->valid)
    return;
  float value[4], pdf;
  base_eval(l, vl_neg(w), vl_neg(to->w), value, &pdf);
  float weight = (l->smooth ? 1.0f : power(to->pdf, pdf)) * layers_pass(l->thickness, to->w);
  for (int c = 0; c < 4; c++)
    f[c] += beta[c] * value[c] * to->weight[c] * weight;
}
/* Connects a vertex in the medium between a smooth coat and a mirror base. Walks cannot make
 * these connections, so they are summed over all numbers of reflections at coat and base. */
static void join_between_mirrors(const Layers *l, vlVec3 w, float height, const Step *to,
                                 const float beta[4], float f[4]) {
  if (!to->valid)
    return;
  float c = vl_max(-to->w.z, VL_MIN_FRACTION),
        back = vl_fresnel_dielectric(c, 1.0f / l->eta).reflected;
  back = l->eta == 1.0f ? 0.0f : back;
  float p = vl_phase(l->g, -vl_dot(w, to->w)),
        q = vl_phase(l->g, vl_dot(w, vl_vec3(-to->w.x, -to->w.y, to->w.z)));
  float pass = layers_pass(l->thickness, to->w),
        above = p * layers_pass(l->thickness - height, to->w);
  float below = q * layers_pass(l->thickness + height, to->w);
  for (int k = 0; k < 4; k++) {
    float r = vl_fresnel_conductor(c, l->e[k], l->k[k]);
    float turns = 1.0f / vl_max(1.0f - r * back * pass * pass, VL_MIN_FRACTION);
    f[k] += beta[k] * l->albedo[k] * to->weight[k] * (above + r * below) * turns / c;
  }
}
static void join_medium(const Layers *l, vlVec3 w, float height, const Step *to,
                        const float beta[4], float f[4]) {
  if (l->smooth && l->mirror)
    join_between_mirrors(l, w, height, to, beta, f);
  if (!to->valid || (l->smooth && l->mirror))
    return;
  float p = vl_phase(l->g, -vl_dot(w, to->w));
  float weight = p * (l->smooth ? 1.0f : power(to->pdf, p)) *
                 layers_pass(l->thickness - height, to->w) /
                 vl_max(-to->w.z, VL_MIN_FRACTION); /* a vertex in the medium has no cosine */
  for (int c = 0; c < 4; c++)
    f[c] += beta[c] * l->albedo[c] * to->weight[c] * weight;
}
/* The other strategy: direction w was sampled with density pdf (0: by a delta) and goes up
 * through a rough coat to wi. */
static void join_coat(const Layers *l, vlVec3 w, float height, vlVec3 wi, const float beta[4],
                      float pdf, float f[4]) {
  if (l->smooth || !(w.z > 0.0f))
    return;
  float other, value = coat_transmit(l, wi, vl_neg(w), &other);
  if (!(value > 0.0f))
    return;
  float weight =
      value * (pdf > 0.0f ? power(pdf, other) : 1.0f) * layers_pass(l->thickness - height, w);
  for (int c = 0; c < 4; c++)
    f[c] += beta[c] * weight;
}

/* Samples a flight through the medium. Returns true if it scattered between the layers. */
static bool fly(const Layers *l, vlVec3 *w, float *height, const Step *to, vlVec3 wi,
                float beta[4], uint32_t *state, float f[4]) {
  float distance = -vl_ln(1.0f - next(state)) * vl_abs(w->z), z = *height;
  z = w->z > 0.0f ? z + distance : z - distance;
  if (!(z > 0.0f) || !(z < l->thickness)) {
    *height = w->z > 0.0f ? l->thickness : 0.0f;
    return false;
  }
  join_medium(l, *w, z, to, beta, f);
  float u = next(state), v = next(state);
  vlVec3 d = vl_phase_sample(l->g, *w, u, v);
  for (int c = 0; c < 4; c++)
    beta[c] *= l->albedo[c];
  join_coat(l, d, z, wi, beta, vl_phase(l->g, vl_dot(*w, d)), f);
  *w = d;
  *height = z;
  return true;
}

/* Adds the estimate of one walk to f. o and wi both point up. */
static void walk(const Layers *l, vlVec3 o, vlVec3 wi, uint32_t *state, float f[4]) {
  float u = next(state), v = next(state);
  Step from = coat_enter(l, o, u, v);
  u = next(state);
  v = next(state);
  Step to = coat_enter(l, wi, u, v);
  if (!from.valid)
    return;
  float beta[4], height = l->thickness, radiance_scale = 1.0f / (l->eta * l->eta);
  for (int c = 0; c < 4; c++)
    beta[c] = from.weight[c] * radiance_scale;
  vlVec3 w = from.w;
  for (uint32_t depth = 0; depth < l->depth; depth++) {
    float max = vl_largest_of4(beta);
    if (depth > 3 && max < 0.25f) {
      if (!(next(state) < max))
        return;
      for (int c = 0; c < 4; c++)
        beta[c] *= 1.0f / max;
    }
    if (l->scatters) {
      if (fly(l, &w, &height, &to, wi, beta, state, f))
        continue;
    } else {
      float pass = layers_pass(l->thickness, w);
      for (int c = 0; c < 4; c++)
        beta[c] *= pass;
    }
    bool down = w.z < 0.0f;
    if (down)
      join_base(l, w, &to, beta, f);
    u = next(state);
    v = next(state);
    Step s = down ? base_sample(l, vl_neg(w), u, v) : coat_back(l, w, u, v);
    if (!s.valid)
      return;
    for (int c = 0; c < 4; c++)
      beta[c] *= s.weight[c];
    w = s.w;
    if (down)
      join_coat(l, w, 0.0f, wi, beta, l->mirror ? 0.0f : s.pdf, f);
  }
}

/* ---- lobes ------------------------------------------------------------------------------- */

/* The lobes from which directions are sampled, with the probabilities of the coat's reflection,
 * the base under the coat, and a cosine lobe. */
typedef struct Lobes {
  float coat, base, wide;
  float mirror[4]; /* reflectance of a smooth coat with smooth metal under it */
  float bx, by;    /* alpha of the base's lobe, below the coat */
} Lobes;

static float refracted(float z, float eta) { /* cosine after refraction; 0: total reflection */
  float s = 1.0f - (1.0f - z * z) / (eta * eta);
  return s > 0.0f ? __builtin_sqrtf(s) : 0.0f;
}

static Lobes lobes_of(const Layers *l, vlVec3 o) {
  float f = l->eta == 1.0f ? 0.0f : vl_fresnel_dielectric(o.z, l->eta).reflected;
  float inside = refracted(o.z, l->eta), below = 0.0f;
  Lobes lobes = {.coat = f};
  float pass = layers_pass(l->thickness, vl_vec3(0, 0, inside));
  for (int c = 0; c < 4; c++) {
    float r = l->metal ? vl_fresnel_conductor(inside, l->e[c], l->k[c]) : l->rho[c];
    below += 0.25f * r;
    lobes.mirror[c] = f;
    if (!l->mirror || !(inside > 0.0f))
      continue;
    float turn = r * pass * pass, sum = 0.0f, back = turn * (1.0f - f) * (1.0f - f);
    for (uint32_t k = 0; k < l->depth; k += 2) { /* every second step is at the base */
      sum += back;
      back *= turn * f;
    }
    lobes.mirror[c] += sum;
  }
  below *= (1.0f - f) * pass * pass;
  float haze =
      l->scatters ? (1.0f - f) * (1.0f - pass * pass) * vl_largest_of4(l->albedo) : 0.0f;
  bool all_mirror = l->smooth && l->mirror;
  lobes.base = l->metal && !all_mirror && inside > 0.0f ? 0.8f * below : 0.0f;
  lobes.wide = all_mirror ? haze : haze + below - lobes.base;
  if (all_mirror)
    lobes.coat =
        0.25f * (lobes.mirror[0] + lobes.mirror[1] + lobes.mirror[2] + lobes.mirror[3]);
  /* Unless f is 0, each lobe gets some samples. */
  float sum = lobes.coat + lobes.base + lobes.wide;
  if (!(sum > VL_MIN_FRACTION))
    lobes.coat = sum = 1.0f;
  bool matt = !all_mirror || l->scatters;
  lobes.coat /= sum;
  lobes.base /= sum;
  lobes.wide /= sum;
  if (matt) {
    lobes.wide = 0.95f * lobes.wide + 0.05f;
    lobes.base *= 0.95f;
    lobes.coat *= 0.95f;
  }
  /* Light crosses the coat twice, and each time a microfacet deflects it by (1 - 1/eta) times
   * the microfacet's slope. Reflection by the metal deflects it by twice the slope. */
  float bend = l->smooth ? 0.0f : 0.5f * (1.0f - 1.0f / l->eta) * (1.0f - 1.0f / l->eta);
  float bx = l->mirror ? 0.0f : l->bx, by = l->mirror ? 0.0f : l->by;
  lobes.bx = vl_clamp(__builtin_sqrtf(bx * bx + bend * l->ax * l->ax), VL_GGX_SMOOTH, 1.0f);
  lobes.by = vl_clamp(__builtin_sqrtf(by * by + bend * l->ay * l->ay), VL_GGX_SMOOTH, 1.0f);
  return lobes;
}

/* Refracts a direction at a smooth coat; the result has z > 0. z = 0: total internal
 * reflection. */
static vlVec3 bent(vlVec3 w, float eta) {
  return vl_vec3(w.x / eta, w.y / eta, refracted(w.z, eta));
}

static float density(const Layers *l, const Lobes *lobes, vlVec3 o, vlVec3 w) {
  float coat, base = 0.0f;
  coat_reflection(l, o, w, &coat);
  if (lobes->base > 0.0f) {
    vlVec3 oi = bent(o, l->eta), wi = bent(w, l->eta), h = vl_normalize(vl_add(oi, wi));
    float lo = vl_ggx_length(oi, lobes->bx, lobes->by);
    if (wi.z > 0.0f)
      base = 0.25f * vl_ggx_visible(h, lobes->bx, lobes->by, oi.z, lo) * w.z /
             (l->eta * l->eta * wi.z);
  }
  return lobes->coat * coat + lobes->base * base + lobes->wide * w.z * VL_INV_PI;
}

/* Samples a direction with z > 0; a result with z <= 0 is no sample. mirror: the sample is the
 * delta. */
static vlVec3 draw(const Layers *l, const Lobes *lobes, vlVec3 o, float lobe, float u, float v,
                   bool *mirror) {
  *mirror = false;
  if (lobe < lobes->coat) {
    *mirror = l->smooth;
    vlVec3 h = l->smooth ? vl_vec3(0, 0, 1) : vl_ggx_sample(o, l->ax, l->ay, u, v);
    return vl_reflect(o, h, vl_dot(o, h));
  }
  if (lobe < lobes->coat + lobes->base) {
    vlVec3 oi = bent(o, l->eta), h = vl_ggx_sample(oi, lobes->bx, lobes->by, u, v);
    vlVec3 w = vl_reflect(oi, h, vl_dot(oi, h));
    float z = refracted(w.z, 1.0f / l->eta);
    return w.z > 0.0f ? vl_normalize(vl_vec3(w.x * l->eta, w.y * l->eta, z)) : vl_vec3(0, 0, 0);
  }
  return vl_cosine_direction(u, v);
}

/* ---- kernels ----------------------------------------------------------------------------- */

/* f cos between o and w, which both point up, without the delta. */
static void scattered(const Layers *l, vlVec3 o, vlVec3 w, uint32_t seed, float value[4]) {
  float f[4] = {0, 0, 0, 0}, pdf, coat = coat_reflection(l, o, w, &pdf);
  if (!(l->smooth && l->mirror) || l->scatters) {
    uint32_t state =
        vl_hash3(seed, vl_float_bits(o.x) ^ vl_hash(vl_float_bits(o.y)), vl_float_bits(o.z));
    state =
        vl_hash3(state, vl_float_bits(w.x) ^ vl_hash(vl_float_bits(w.y)), vl_float_bits(w.z));
    for (uint32_t k = 0; k < l->walks; k++)
      walk(l, o, w, &state, f);
  }
  float scale = w.z / (float)l->walks;
  for (int c = 0; c < 4; c++)
    value[c] = coat + f[c] * scale;
}

void vl_bsdf_layered_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                          vlBsdfDirections wi, float *const value[4], float *pdf) {
  for (uint32_t i = 0; i < n; i++) {
    pdf[i] = 0.0f;
    for (int c = 0; c < 4; c++)
      value[c][i] = 0.0f;
    if (!(wo.z[i] * wi.z[i] > 0.0f))
      continue;
    Layers l = layers_of(params, i);
    vlVec3 o = vl_vec3(wo.x[i], wo.y[i], vl_abs(wo.z[i])),
           w = vl_vec3(wi.x[i], wi.y[i], vl_abs(wi.z[i]));
    Lobes lobes = lobes_of(&l, o);
    float f[4];
    scattered(&l, o, w, params->seed[i], f);
    for (int c = 0; c < 4; c++)
      value[c][i] = f[c];
    pdf[i] = density(&l, &lobes, o, w);
  }
}

void vl_bsdf_layered_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                            vlBsdfRandom random, vlBsdfSampled out) {
  for (uint32_t i = 0; i < n; i++) {
    Layers l = layers_of(params, i);
    vlVec3 o = vl_vec3(wo.x[i], wo.y[i], vl_abs(wo.z[i]));
    Lobes lobes = lobes_of(&l, o);
    bool mirror, valid = o.z > 0.0f;
    vlVec3 w = draw(&l, &lobes, o, random.lobe[i], random.u[i], random.v[i], &mirror);
    valid = valid && w.z > 0.0f;
    if (!valid)
      w = vl_vec3(0, 0, 1);
    float f[4] = {0, 0, 0, 0}, p = 0.0f;
    if (valid && mirror) {
      p = lobes.coat;
      for (int c = 0; c < 4; c++)
        f[c] = lobes.mirror[c];
    } else if (valid) {
      p = density(&l, &lobes, o, w);
      scattered(&l, o, w, params->seed[i], f);
    }
    valid = p > 0.0f;
    for (int c = 0; c < 4; c++)
      out.weight[c][i] = valid ? f[c] / p : 0.0f;
    out.wi.x[i] = w.x;
    out.wi.y[i] = w.y;
    out.wi.z[i] = __builtin_copysignf(w.z, wo.z[i]);
    out.pdf[i] = valid ? p : 0.0f;
    uint32_t chosen =
        random.lobe[i] < lobes.coat + lobes.base ? 0u : (uint32_t)VL_SAMPLED_DIFFUSE;
    out.flags[i] =
        valid ? (mirror ? (uint32_t)VL_SAMPLED_SPECULAR : chosen) : (uint32_t)VL_SAMPLED_NONE;
    out.eta_scale[i] = 1.0f;
  }
}
