/* material/principled.hot.c: the BSDF of the principled material. It has five lobes: the
 * base's microfacets, the diffuse lobe (with the sheen and the multiple scattering between
 * microfacets), the clear coat, refraction, diffuse transmission. Sampling chooses one lobe;
 * the sample's density is the sum over all lobes. principled_energy.hot.c computes the energies
 * of the layers.
 *
 * There are no deltas: a mirror has microfacets with alpha VL_GGX_SMOOTH. f is symmetric in wo
 * and wi; for refraction, up to the squared index of refraction. */
#include "material/principled.hot.h"

vlBsdfEval vl_bsdf_principled_eval;
vlBsdfSample vl_bsdf_principled_sample;

static vlPrincipledSlice slice_of(const vlBsdfParams *p, uint32_t n, uint32_t first) {
  vlPrincipledSlice s;
  uint32_t left = VL_PAD(n) - first;
  s.count = left < VL_PRINCIPLED_CHUNK ? left : VL_PRINCIPLED_CHUNK;
  for (int k = 0; k < VL_BSDF_ROWS; k++)
    s.row[k] = p->own[k] + first;
  for (int c = 0; c < 4; c++) {
    s.base[c] = p->reflectance[c] + first;
    s.tint[c] = p->tint[c] ? p->tint[c] + first : s.base[c];
    s.lambda[c] = p->lambda[c] ? p->lambda[c] + first : NULL;
  }
  s.alpha_x = p->alpha_x + first;
  s.alpha_y = p->alpha_y + first;
  s.eta = p->eta_s + first;
  s.film = s.sheen = s.coat = s.solid = s.anisotropic = false;
  uint32_t live = n - first < s.count ? n - first : s.count;
  for (uint32_t i = 0; i < live; i++) {
    s.film |= s.row[VL_P_FILM][i] > 0.0f;
    s.coat |= s.row[VL_P_COAT][i] > 0.0f;
    s.solid |= s.row[VL_P_THIN][i] == 0.0f && s.row[VL_P_TRANSMISSION][i] > 0.0f;
    s.anisotropic |= s.alpha_x[i] != s.alpha_y[i];
    for (int c = 0; c < 4; c++)
      s.sheen |= s.row[VL_P_SHEEN + c][i] > 0.0f;
  }
  return s;
}

/* Factor for light that crosses a layer to the base and back, with all reflections between
 * layer and base. o, i: the layer's albedos at the two angles. A diffuse base also needs the
 * mean albedo. For a specular base both angles are the same; for a rough base the larger albedo
 * is used, so that no energy is gained. */
static inline float over_matt(float o, float i, float mean) {
  return (1.0f - o) * (1.0f - i) / (1.0f - mean);
}
static inline float over_mirror(float o, float i) {
  return 1.0f - vl_max(o, i);
}

typedef struct Facet {
  float value, pdf; /* without the Fresnel term */
  float fresnel;    /* Schlick's weight */
  float outer;      /* cosine outside of the solid */
  float opaque;     /* Schlick's weight for light from outside */
  float total;      /* 1: total reflection */
} Facet;

/* The base's microfacets. w.z > 0: reflection; w.z < 0: refraction, or for a thin sheet the
 * mirror image of the reflection. */
static inline Facet base_facet(vlVec3 o, vlVec3 w, float ax, float ay, float forth,
                               float inside, float thin) {
  int reflect = w.z > 0.0f, straight = reflect | (thin > 0.0f);
  float eta = inside > 0.0f ? 1.0f / forth : forth, inverse = 1.0f / eta;
  float down = vl_abs(w.z), s = straight ? 1.0f : eta;
  vlVec3 h =
      vl_normalize(vl_vec3(o.x + s * w.x, o.y + s * w.y, o.z + (straight ? down : s * w.z)));
  float up = h.z < 0.0f ? -1.0f : 1.0f;
  h = vl_mul(h, up);
  float oh = vl_dot(o, h), ih = straight ? oh : vl_dot(w, h);
  float lo = vl_ggx_length(o, ax, ay), li = vl_ggx_length(w, ax, ay);
  float visible = vl_ggx_visible(h, ax, ay, o.z, lo);
  float t = ih + oh * inverse, t2 = t * t;
  float jacobian = oh * vl_abs(ih) / (t2 > VL_MIN_POSITIVE ? t2 : VL_MIN_POSITIVE);
  float p = visible * (straight ? 0.25f : jacobian);
  float g = p * vl_ggx_shadowing(o.z, lo, down, li) * (straight ? 1.0f : inverse * inverse);
  int valid = (o.z > 0.0f) & (down > 0.0f) & (oh > 0.0f) & (straight | (ih < 0.0f));
  vlOuterCosine outer = vl_outer_cosine(oh, forth);
  float c = inside > 0.0f ? (reflect ? outer.cosine : vl_abs(ih)) : oh;
  int total = (inside > 0.0f) & reflect & outer.total;
  return (Facet){valid ? g : 0.0f,      valid ? p : 0.0f,   vl_schlick_weight(c), c,
                 vl_schlick_weight(oh), total ? 1.0f : 0.0f};
}

/* The coat's microfacets, around the coat's own normal n, with the Fresnel term. */
static inline Facet coat_facet(vlVec3 o, vlVec3 w, vlVec3 n, float alpha) {
  vlVec3 h = vl_normalize(vl_add(o, w)), across = vl_cross(h, n);
  float oc = vl_dot(o, n), ic = vl_dot(w, n), hc = vl_dot(h, n), oh = vl_dot(o, h);
  float a2 = alpha * alpha, e = vl_dot(across, across) / a2 + hc * hc;
  float lo = __builtin_sqrtf(a2 * (1.0f - oc * oc) + oc * oc),
        li = __builtin_sqrtf(a2 * (1.0f - ic * ic) + ic * ic);
  float visible = 2.0f * VL_INV_PI /
                  (a2 * (e * e) * (lo + oc > VL_MIN_FRACTION ? lo + oc : VL_MIN_FRACTION));
  int valid = (oc > VL_P_COAT_HORIZON) & (ic > VL_P_COAT_HORIZON) & (hc > 0.0f) & (w.z > 0.0f);
  float p = 0.25f * visible, f = 0.04f + 0.96f * vl_schlick_weight(oh);
  float g = p * f * vl_ggx_shadowing(oc, lo, ic, li) * w.z /
            (ic > VL_P_COAT_HORIZON ? ic : VL_P_COAT_HORIZON);
  return (Facet){valid ? g : 0.0f, valid ? p : 0.0f, f, oh, f, 0.0f};
}

/* The values of a pair of directions that all four channels share. */
typedef struct Pair {
  /* value of the base's microfacets without the Fresnel term */
  float facet[VL_PRINCIPLED_CHUNK];
  float weight[VL_PRINCIPLED_CHUNK]; /* Schlick's weight */
  float opaque[VL_PRINCIPLED_CHUNK]; /* Schlick's weight for light from outside */
  float total[VL_PRINCIPLED_CHUNK];  /* 1: total reflection */
  /* factors of the layers above the base, for each lobe */
  float hide_mirror[VL_PRINCIPLED_CHUNK], hide_matt[VL_PRINCIPLED_CHUNK];
  float hide_through[VL_PRINCIPLED_CHUNK];
  float coat[VL_PRINCIPLED_CHUNK];   /* value of the clear coat */
  float cosine[VL_PRINCIPLED_CHUNK]; /* |wi.z| / pi */
  float again[VL_PRINCIPLED_CHUNK];  /* multiple scattering between microfacets, f cos_i */
  /* 1: wi is on the side of wo; 1: on the other side */
  float upper[VL_PRINCIPLED_CHUNK], lower[VL_PRINCIPLED_CHUNK];
} Pair;

/* Computes the values of the pair and the density of sampling wi. has_coat is a compile-time
 * constant, so that each of its two values gets a loop without branches. */
VL_INLINE void pair_loop(const vlPrincipledSlice *s, const vlPrincipledLanes *l,
                         vlBsdfDirections wo, vlBsdfDirections wi, Pair *out, float *pdf,
                         bool has_coat) {
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float side = l->side[i], inside = l->inside[i], thin = s->row[VL_P_THIN][i];
    vlVec3 o = vl_vec3(wo.x[i], wo.y[i], l->z[i]),
           w = vl_vec3(wi.x[i], wi.y[i], wi.z[i] * side);
    int reflect = w.z > 0.0f, valid = (o.z > 0.0f) & (vl_abs(w.z) > 0.0f);
    Facet facet = base_facet(o, w, vl_ggx_alpha(s->alpha_x[i]), vl_ggx_alpha(s->alpha_y[i]),
                             s->eta[i], inside, thin);
    /* coat and sheen are only on the outside of a solid */
    float bare = 1.0f - inside, coat_value = 0.0f, coat_pdf = 0.0f;
    if (has_coat) {
      float on = s->row[VL_P_COAT][i] * bare;
      Facet coat = coat_facet(o, w,
                              vl_vec3(s->row[VL_P_COAT_X][i] * side,
                                      s->row[VL_P_COAT_Y][i] * side, s->row[VL_P_COAT_Z][i]),
                              vl_ggx_alpha(s->row[VL_P_COAT_ALPHA][i]));
      /* rows of materials without a coat may be stale */
      coat_value = on > 0.0f ? coat.value * on : 0.0f;
      coat_pdf = on > 0.0f ? coat.pdf : 0.0f;
    }
    float co = l->coat_o[i], ci = l->coat_i[i], so = l->sheen_o[i], si = l->sheen_i[i];
    float mirror = over_mirror(co, ci) * over_mirror(so, si);
    float matt = over_matt(co, ci, l->coat_mean[i]) * over_matt(so, si, l->sheen_mean[i]);
    out->hide_mirror[i] = inside > 0.0f ? 1.0f : mirror;
    out->hide_matt[i] = inside > 0.0f ? 1.0f : matt;
    /* Transmitted light crosses the layers once, on the upper side. */
    out->hide_through[i] = side < 0.0f ? (1.0f - ci) * (1.0f - si) : (1.0f - co) * (1.0f - so);
    out->facet[i] = facet.value;
    out->weight[i] = facet.fresnel;
    out->total[i] = facet.total;
    out->opaque[i] = facet.opaque;
    out->coat[i] = coat_value;
    float cosine = vl_abs(w.z) * VL_INV_PI;
    out->cosine[i] = cosine;
    /* multiple scattering between microfacets (Kulla and Conty 2017) */
    out->again[i] =
        (1.0f - l->one_o[i]) * (1.0f - l->one_i[i]) / (1.0f - l->one_mean[i]) * cosine;
    float base = vl_mean4(s->base[0][i], s->base[1][i], s->base[2][i], s->base[3][i]),
          both = l->specular[i] + l->refract[i];
    float mirrors = vl_principled_mirrors(facet.outer, facet.total > 0.0f, s->row[VL_P_F0][i],
                                          s->row[VL_P_F90][i], s->row[VL_P_METALLIC][i],
                                          s->row[VL_P_TRANSMISSION][i], base);
    float forth = inside > 0.0f ? both * mirrors : l->specular[i];
    float through = inside > 0.0f ? both * (1.0f - mirrors) : l->refract[i];
    float above = forth * facet.pdf + l->diffuse[i] * cosine + l->coat[i] * coat_pdf;
    float below = through * facet.pdf + l->through[i] * cosine;
    /* products, because gcc would turn selects into branches */
    float on = valid ? 1.0f : 0.0f, up = reflect ? on : 0.0f;
    out->upper[i] = up;
    out->lower[i] = on - up;
    pdf[i] = above * up + below * (on - up);
  }
}

/* Computes one channel of f cos_i from the pair. */
static inline void channel_loop(const vlPrincipledSlice *s, const vlPrincipledLanes *l,
                                const Pair *p, int c, float *result) {
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float metal = s->row[VL_P_METALLIC][i], dielectric = 1.0f - metal,
          clear = s->row[VL_P_TRANSMISSION][i], shares = s->row[VL_P_DIFFUSE_TRANSMISSION][i];
    float f90 = s->row[VL_P_F90][i], film = s->row[VL_P_FILM][i], base = s->base[c][i],
          tint = s->tint[c][i], f0 = s->row[VL_P_F0 + c][i], again = p->again[i],
          facet = p->facet[i];
    float m0 = f0 + metal * (base - f0), m90 = f90 + metal * (1.0f - f90);
    float f = m0 + (m90 - m0) * p->opaque[i];
    f = f + film * (l->film[c][i] - f);
    /* reflectances of the dielectric only */
    float fd = f0 + (f90 - f0) * p->weight[i], fo = f0 + (f90 - f0) * p->opaque[i];
    fd = fd + film * (l->film[c][i] - fd);
    fo = fo + film * (l->film[c][i] - fo);
    float within = p->total[i] > 0.0f
                       ? 1.0f
                       : fd; /* inside, only the transmissive part is the denser medium */
    f = f + l->inside[i] * dielectric * clear * (within - fo);
    float matt = (1.0f - l->energy_o[c][i]) * (1.0f - l->energy_i[c][i]) /
                 (1.0f - l->energy_mean[c][i]) * p->cosine[i] * dielectric * (1.0f - clear);
    float metal_mean = base + (1.0f - base) * (1.0f / 21.0f),
          sheet_mean = f0 + (f90 - f0) * (1.0f / 21.0f);
    float metal_again = metal_mean * metal_mean * l->one_mean[i] /
                        (1.0f - metal_mean * (1.0f - l->one_mean[i]));
    float sheet_again = dielectric * clear * s->row[VL_P_THIN][i] * again;
    /* multiple scattering between microfacets, to both sides */
    float body = dielectric * clear, body_pass = 1.0f - sheet_mean;
    float body_up = body * l->again_up[i] * (1.0f - l->again_pass[i] * body_pass);
    float body_down = body * l->again_down[i] * body_pass * tint;
    float bare = 1.0f - l->inside[i];
    float fuzz = s->row[VL_P_SHEEN + c][i] * l->sheen_value[i] * bare *
                 over_matt(l->coat_o[i], l->coat_i[i], l->coat_mean[i]);
    float upper =
        p->hide_mirror[i] * f * facet +
        p->hide_matt[i] * (matt * (1.0f - shares) * base + metal * metal_again * again +
                           sheet_again * sheet_mean + body_up) +
        p->coat[i] + fuzz;
    float lower = p->hide_through[i] * (dielectric * clear * tint * (1.0f - fd) * facet +
                                        matt * shares * s->row[VL_P_THROUGH + c][i] +
                                        sheet_again * (1.0f - sheet_mean) * tint + body_down);
    result[i] = upper * p->upper[i] + lower * p->lower[i];
  }
}

/* f cos_i and the density of sampling wi. */
VL_NOINLINE void combine(const vlPrincipledSlice *s, const vlPrincipledLanes *l,
                         vlBsdfDirections wo, vlBsdfDirections wi, float *const value[4],
                         float *pdf) {
  Pair pair;
  if (s->coat)
    pair_loop(s, l, wo, wi, &pair, pdf, true);
  else
    pair_loop(s, l, wo, wi, &pair, pdf, false);
  for (int c = 0; c < 4; c++)
    channel_loop(s, l, &pair, c, value[c]);
}

void vl_bsdf_principled_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                             vlBsdfDirections wi, float *const value[4], float *pdf) {
  vlPrincipledLanes lanes;
  for (uint32_t first = 0; first < n; first += VL_PRINCIPLED_CHUNK) {
    vlPrincipledSlice s = slice_of(params, n, first);
    vlBsdfDirections o = vl_directions_from(wo, first), in = vl_directions_from(wi, first);
    float *const chunk[4] = {value[0] + first, value[1] + first, value[2] + first,
                             value[3] + first};
    vl_principled_view(&s, o, &lanes);
    vl_principled_light(&s, o, in, &lanes);
    combine(&s, &lanes, o, in, chunk, pdf + first);
  }
}

/* Whether the number u chooses one of the diffuse lobes: reflection, or transmission, the last
 * of all. */
static inline bool is_diffuse(const vlPrincipledLanes *l, uint32_t i, float u) {
  float to_diffuse = l->specular[i] + l->diffuse[i];
  return (u >= l->specular[i] && u < to_diffuse) ||
         u >= to_diffuse + l->coat[i] + l->refract[i];
}

/* Chooses the lobe and samples its direction. For the last two lobes, wi is on the other side
 * of the surface than wo. */
VL_NOINLINE void choose(const vlPrincipledSlice *s, const vlPrincipledLanes *l,
                        vlBsdfDirections wo, vlBsdfRandom random, vlBsdfSampled out) {
  for (uint32_t i = 0; i < s->count; i++) {
    float side = l->side[i], inside = l->inside[i], thin = s->row[VL_P_THIN][i];
    float x = random.lobe[i], u = random.u[i], v = random.v[i];
    vlVec3 o = vl_vec3(wo.x[i], wo.y[i], l->z[i]), w;
    float to_diffuse = l->specular[i] + l->diffuse[i], to_coat = to_diffuse + l->coat[i];
    float to_refract = to_coat + l->refract[i], scale = 1.0f;
    if (x < l->specular[i] || (x >= to_coat && x < to_refract)) {
      vlVec3 h =
          vl_ggx_sample(o, vl_ggx_alpha(s->alpha_x[i]), vl_ggx_alpha(s->alpha_y[i]), u, v);
      float oh = vl_dot(o, h);
      bool mirrors = x < l->specular[i];
      if (inside > 0.0f) {
        vlOuterCosine outer = vl_outer_cosine(oh, s->eta[i]);
        float base = vl_mean4(s->base[0][i], s->base[1][i], s->base[2][i], s->base[3][i]);
        float part = mirrors ? x : l->specular[i] + (x - to_coat);
        mirrors =
            part < (l->specular[i] + l->refract[i]) *
                       vl_principled_mirrors(outer.cosine, outer.total, s->row[VL_P_F0][i],
                                             s->row[VL_P_F90][i], s->row[VL_P_METALLIC][i],
                                             s->row[VL_P_TRANSMISSION][i], base);
      }
      w = vl_reflect(o, h, oh);
      if (!mirrors && thin > 0.0f)
        w.z = -w.z;
      if (!mirrors && thin == 0.0f) {
        float eta = inside > 0.0f ? 1.0f / s->eta[i] : s->eta[i], inverse = 1.0f / eta;
        float cos2 = 1.0f - (1.0f - oh * oh) * inverse * inverse;
        float a = oh * inverse - __builtin_sqrtf(cos2 > 0.0f ? cos2 : 0.0f);
        w = vl_vec3(a * h.x - inverse * o.x, a * h.y - inverse * o.y, a * h.z - inverse * o.z);
        if (!(cos2 > 0.0f) || w.z > 0.0f)
          w = vl_vec3(0.0f, 0.0f, 0.0f);
        scale = eta * eta;
      } else if (mirrors != (w.z > 0.0f)) {
        w = vl_vec3(0.0f, 0.0f, 0.0f);
      }
    } else if (x >= to_diffuse && x < to_coat) {
      vlVec3 n = vl_principled_coat(s, i, side);
      vlFrame frame = vl_frame_from_z(n);
      float alpha = s->row[VL_P_COAT_ALPHA][i];
      vlVec3 local = vl_vec3(vl_dot(o, frame.x), vl_dot(o, frame.y), vl_dot(o, n));
      vlVec3 h = vl_from_local(frame, vl_ggx_sample(local, alpha, alpha, u, v));
      w = vl_reflect(o, h, vl_dot(o, h));
      if (!(w.z > 0.0f))
        w = vl_vec3(0.0f, 0.0f, 0.0f);
    } else {
      w = vl_cosine_direction(u, v);
      if (x >= to_refract) {
        float eta = inside > 0.0f ? 1.0f / s->eta[i] : s->eta[i];
        scale = thin > 0.0f ? 1.0f : eta * eta;
        w.z = -w.z;
      }
    }
    w.z *= side;
    vl_set_lane3(out.wi.x, out.wi.y, out.wi.z, i, w);
    out.eta_scale[i] = scale;
  }
}

void vl_bsdf_principled_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                               vlBsdfRandom random, vlBsdfSampled out) {
  vlPrincipledLanes lanes;
  for (uint32_t first = 0; first < n; first += VL_PRINCIPLED_CHUNK) {
    vlPrincipledSlice s = slice_of(params, n, first);
    vlBsdfDirections o = vl_directions_from(wo, first);
    vlBsdfRandom numbers = vl_random_from(random, first);
    vlBsdfSampled to = vl_sampled_from(out, first);
    vl_principled_view(&s, o, &lanes);
    choose(&s, &lanes, o, numbers, to);
    vl_principled_light(&s, o, to.wi, &lanes);
    combine(&s, &lanes, o, to.wi, to.weight, to.pdf);
    for (uint32_t i = 0; i < s.count; i++) {
      to.pdf[i] = to.pdf[i] > VL_MIN_POSITIVE ? to.pdf[i] : 0.0f;
      float inverse = to.pdf[i] > 0.0f ? 1.0f / to.pdf[i] : 0.0f;
      for (int c = 0; c < 4; c++)
        to.weight[c][i] *= inverse;
      int below = (to.wi.z[i] > 0.0f) != (o.z[i] > 0.0f);
      uint32_t chosen =
          (below ? (uint32_t)VL_SAMPLED_TRANSMISSION : 0u) |
          (is_diffuse(&lanes, i, numbers.lobe[i]) ? (uint32_t)VL_SAMPLED_DIFFUSE : 0u);
      to.flags[i] = to.pdf[i] > 0.0f ? chosen : (uint32_t)VL_SAMPLED_NONE;
    }
  }
}
