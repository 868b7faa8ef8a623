/* material/coated_diffuse.hot.c: the BSDF of a Lambertian base under a dielectric coat. It has
 * the closed form of material/coat.h, without random walks and their noise, and two lobes: the
 * coat's reflection (a delta if the coat is smooth) and the base under the coat.
 *
 * Lanes are processed in chunks, in a few passes over small arrays, because the lookup of T(w)
 * does not vectorise (gcc makes no gathers for generic x86-64, and lanes may have different
 * tables): a scalar pass copies the four nodes of each lane side by side, vector passes do the
 * rest. */
#include <string.h>

#include "material/local.hot.h"

vlBsdfEval vl_bsdf_coat_eval;
vlBsdfSample vl_bsdf_coat_sample;

enum { CHUNK = 64 };

/* The passes must not be inlined. Where gcc sees the local arrays, it moves their loads into
 * the selects, which become branches. */
#define PASS VL_NOINLINE void

/* Data between the passes, for a chunk of lanes. */
typedef struct {
  float transmittance_o[CHUNK], transmittance_i[CHUNK]; /* T(wo), T(wi) */
  float back[CHUNK], escape[CHUNK];
  int32_t bounces[CHUNK];
  float coat_share[CHUNK]; /* probability of the coat's lobe */
  float fresnel[CHUNK];    /* Fresnel reflectance at wo */
  float base[4][CHUNK];    /* the base's f without T(wi) */
} Lanes;

/* One chunk's slice of the parameters. */
typedef struct {
  const float *reflectance[4], *ax, *ay, *eta;
  const vlCoatTable *const *coat;
  uint32_t count, live; /* number of lanes with padding (a multiple of VL_LANES), and without
                           (padding has no table) */
} Slice;

static Slice slice_of(const vlBsdfParams *p, uint32_t n, uint32_t first) {
  uint32_t left = VL_PAD(n) - first, count = left < CHUNK ? left : CHUNK;
  Slice s = {.ax = p->alpha_x + first,
             .ay = p->alpha_y + first,
             .eta = p->eta_s + first,
             .coat = (const vlCoatTable *const *)p->coat + first,
             .count = count,
             .live = n - first < count ? n - first : count};
  for (int c = 0; c < 4; c++)
    s.reflectance[c] = p->reflectance[c] + first;
  return s;
}

enum { OF_WO, OF_WI, OF_LIGHT }; /* OF_LIGHT: a wi from a light sample */

/* The table rows of T. */
static const float (*rows_of(const vlCoatTable *table, int of))[VL_COAT_COS] {
  return of == OF_LIGHT && table->imitate ? table->imitation : table->transmittance;
}

/* Four neighbouring nodes of T for each lane. */
typedef struct {
  int32_t first[CHUNK];
  float at[CHUNK]; /* position between the nodes */
  float value[CHUNK][4];
} Nodes;

/* Where T(w) lies between two rows of a table. */
typedef struct {
  uint32_t low, high;
  float t;
} Row;

static inline Row row_at(float row, uint32_t rows) {
  row = row > 0.0f ? row : 0.0f; /* NaN becomes 0, too */
  uint32_t low = row < (float)(rows - 2) ? (uint32_t)row : rows - 2;
  float t = row - (float)low;
  return (Row){low, low + 1, t < 1.0f ? t : 1.0f};
}

static inline Row row_of(const vlCoatTable *table, float alpha_x, float alpha_y, float x,
                         float y) {
  if (table->rows == 1)
    return (Row){0, 0, 0.0f};
  if (table->anisotropic) { /* by azimuth; along the normal all rows are the same */
    float across = x * x + y * y, rough = vl_abs(table->rough_y ? y : x);
    float share = across > VL_MIN_POSITIVE ? rough / __builtin_sqrtf(across) : 0.0f;
    return row_at(__builtin_sqrtf(share) * (float)(VL_COAT_AZIMUTHS - 1), VL_COAT_AZIMUTHS);
  }
  /* textured roughness */
  float alpha = __builtin_sqrtf(vl_ggx_alpha(alpha_x) * vl_ggx_alpha(alpha_y));
  return row_at((__builtin_sqrtf(alpha) - table->row_start) * table->row_scale, VL_COAT_ALPHA);
}

/* One table with one row for the whole slice, the usual case. */
static void fetch_row(const vlCoatTable *table, uint32_t count, Lanes *lanes, Nodes *nodes,
                      int of) {
  const float *row = rows_of(table, of)[0];
  for (uint32_t i = 0; i < count; i++)
    memcpy(nodes->value[i], row + nodes->first[i], sizeof nodes->value[i]);
  if (of != OF_WO)
    return;
  float back = table->back[0], escape = table->escape[0];
  int32_t bounces = (int32_t)table->bounces;
  for (uint32_t i = 0; i < count; i++) {
    lanes->back[i] = back;
    lanes->escape[i] = escape;
    lanes->bounces[i] = bounces;
  }
}

/* Each lane has its own table, or interpolates between two rows. Without interpolation, results
 * are the same as fetch_row's, bit for bit. */
static void fetch_each(const Slice *s, vlBsdfDirections w, Lanes *lanes, Nodes *nodes, int of) {
  for (uint32_t i = 0; i < s->count; i++) {
    const vlCoatTable *table = s->coat[i < s->live ? i : 0];
    Row r = row_of(table, s->ax[i], s->ay[i], w.x[i], w.y[i]);
    uint32_t low = r.low, high = r.high;
    float t = r.t;
    const float(*rows)[VL_COAT_COS] = rows_of(table, of);
    const float *a = rows[low] + nodes->first[i], *b = rows[high] + nodes->first[i];
    for (int k = 0; k < 4; k++)
      nodes->value[i][k] = a[k] + t * (b[k] - a[k]);
    if (of == OF_WO) {
      lanes->back[i] = table->back[low] + t * (table->back[high] - table->back[low]);
      lanes->escape[i] = table->escape[low] + t * (table->escape[high] - table->escape[low]);
      lanes->bounces[i] = (int32_t)table->bounces;
    }
  }
}

/* Looks up T at directions, and for wo also the constants of the tables. */
PASS look_up(const Slice *s, vlBsdfDirections w, Lanes *lanes, float *through, int of) {
  Nodes nodes;
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    vlCoatCell p = vl_coat_cell(vl_abs(w.z[i]));
    nodes.first[i] = p.first;
    nodes.at[i] = p.t;
  }
  const vlCoatTable *table = s->coat[0];
  uintptr_t differ = 0;
  for (uint32_t i = 0; i < s->live; i++)
    differ |= (uintptr_t)s->coat[i] ^ (uintptr_t)table;
  if (differ == 0 && table->rows == 1)
    fetch_row(table, count, lanes, &nodes, of);
  else
    fetch_each(s, w, lanes, &nodes, of);
  const float(*value)[4] = (const float(*)[4])nodes.value;
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float q0 = value[i][0], q1 = value[i][1], q2 = value[i][2], q3 = value[i][3];
    through[i] = vl_coat_cubic(q0, q1, q2, q3, nodes.at[i]);
  }
}

/* The sum 1 + x + ... + x^(k-1) = (1 - x^k) / (1 - x), for x in [0, 1) and k < 2^bits. The
 * power is computed from the bits of k. */
static inline float series(float x, int32_t k, const int bits) {
  float power = 1.0f, square = x;
  for (int b = 0; b < bits; b++) {
    power = (k >> b) & 1 ? power * square : power;
    square = square * square;
  }
  float down = 1.0f - x;
  return (1.0f - power) / (down > VL_MIN_FRACTION ? down : VL_MIN_FRACTION);
}

/* Computes from T(wo) the base's f in each channel and the probabilities of the lobes, which
 * are proportional to the energy that each lobe reflects. The energy of a rough coat is
 * approximated by that of a smooth coat. */
VL_INLINE void weigh_loop(const Slice *s, vlBsdfDirections wo, Lanes *lanes, const int bits) {
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float t = lanes->transmittance_o[i], r = lanes->back[i], e = s->eta[i];
    int32_t k = lanes->bounces[i];
    float r0 = s->reflectance[0][i], r1 = s->reflectance[1][i];
    float r2 = s->reflectance[2][i], r3 = s->reflectance[3][i];
    float s0 = r0 * series(r0 * r, k, bits), s1 = r1 * series(r1 * r, k, bits);
    float s2 = r2 * series(r2 * r, k, bits), s3 = r3 * series(r3 * r, k, bits);
    float f = vl_fresnel_dielectric(vl_abs(wo.z[i]), e).reflected;
    f = e == 1.0f ? 0.0f : f;
    float albedo = t * lanes->escape[i] * (0.25f * ((s0 + s1) + (s2 + s3)));
    float sum = f + albedo;
    float scale = t * VL_INV_PI / (e * e);
    lanes->fresnel[i] = f;
    lanes->coat_share[i] = f / (sum > 0.0f ? sum : 1.0f);
    lanes->base[0][i] = s0 * scale;
    lanes->base[1][i] = s1 * scale;
    lanes->base[2][i] = s2 * scale;
    lanes->base[3][i] = s3 * scale;
  }
}

PASS weigh(const Slice *s, vlBsdfDirections wo, Lanes *lanes) {
  look_up(s, wo, lanes, lanes->transmittance_o, OF_WO);
  int32_t all = 0;
  for (uint32_t i = 0; i < s->live; i++)
    all |= lanes->bounces[i];
  if (all < 8)
    weigh_loop(s, wo, lanes, 3);
  else
    weigh_loop(s, wo, lanes, 8);
}

/* The coat's lobe between o and w, both above the surface. */
typedef struct {
  float coat;     /* f |cos| of the coat's reflection, 0 when smooth */
  float coat_pdf; /* density of sampling w by this lobe */
} CoatLobe;
VL_INLINE CoatLobe coat_lobe(vlVec3 o, vlVec3 w, float alpha_x, float alpha_y, float eta) {
  float rx = vl_ggx_alpha(alpha_x), ry = vl_ggx_alpha(alpha_y);
  int rough = (vl_ggx_is_smooth(alpha_x, alpha_y) | (eta == 1.0f)) == 0;
  vlVec3 h = vl_normalize(vl_add(o, w));
  float f = vl_fresnel_dielectric(vl_dot(o, h), eta).reflected;
  float lo = vl_ggx_length(o, rx, ry), li = vl_ggx_length(w, rx, ry);
  float p = 0.25f * vl_ggx_visible(h, rx, ry, o.z, lo);
  p = rough ? p : 0.0f;
  return (CoatLobe){f * p * vl_ggx_shadowing(o.z, lo, w.z, li), p};
}

PASS combine(const Slice *s, const Lanes *lanes, vlBsdfDirections wo, vlBsdfDirections wi,
             float *const value[4], float *pdf) {
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    int valid = ((wo.z[i] > 0.0f) & (wi.z[i] > 0.0f)) | ((wo.z[i] < 0.0f) & (wi.z[i] < 0.0f));
    /* Products with 0 or 1 instead of selects: compilers would put the loads into branches. The
     * factor of 0 must be finite, so pairs that are not valid are replaced by directions along
     * the normal. */
    float on = valid ? 1.0f : 0.0f, off = 1.0f - on;
    vlVec3 o = vl_vec3(wo.x[i] * on, wo.y[i] * on, vl_abs(wo.z[i]) * on + off),
           w = vl_vec3(wi.x[i] * on, wi.y[i] * on, vl_abs(wi.z[i]) * on + off);
    CoatLobe lobe = coat_lobe(o, w, s->ax[i], s->ay[i], s->eta[i]);
    float t = lanes->transmittance_i[i] * w.z, p = lanes->coat_share[i];
    for (int c = 0; c < 4; c++)
      value[c][i] = (lobe.coat + lanes->base[c][i] * t) * on;
    pdf[i] = (p * lobe.coat_pdf + (1.0f - p) * (w.z * VL_INV_PI)) * on;
  }
}

void vl_bsdf_coat_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                       vlBsdfDirections wi, float *const value[4], float *pdf) {
  Lanes lanes;
  for (uint32_t first = 0; first < n; first += CHUNK) {
    Slice s = slice_of(params, n, first);
    vlBsdfDirections o = vl_directions_from(wo, first), in = vl_directions_from(wi, first);
    float *const chunk[4] = {value[0] + first, value[1] + first, value[2] + first,
                             value[3] + first};
    weigh(&s, o, &lanes);
    look_up(&s, in, &lanes, lanes.transmittance_i, OF_LIGHT);
    combine(&s, &lanes, o, in, chunk, pdf + first);
  }
}

/* First half of sampling: chooses the lobe and samples the direction. wi.z is positive on the
 * side of wo. */
PASS choose(const Slice *s, const Lanes *lanes, vlBsdfDirections wo, vlBsdfRandom random,
            vlBsdfDirections wi) {
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    vlVec3 o = vl_vec3(wo.x[i], wo.y[i], vl_abs(wo.z[i]));
    int smooth = vl_ggx_is_smooth(s->ax[i], s->ay[i]) | (s->eta[i] == 1.0f);
    vlVec3 h = vl_microfacet(o, vl_ggx_alpha(s->ax[i]), vl_ggx_alpha(s->ay[i]), smooth,
                             random.u[i], random.v[i]);
    vlVec3 mirror = vl_reflect(o, h, vl_dot(o, h)),
           base = vl_cosine_direction(random.u[i], random.v[i]);
    int coat = random.lobe[i] < lanes->coat_share[i];
    wi.x[i] = coat ? mirror.x : base.x;
    wi.y[i] = coat ? mirror.y : base.y;
    wi.z[i] = coat ? mirror.z : base.z;
  }
}

/* Second half of sampling: computes the weight of the direction, with the density of both
 * lobes. */
PASS settle(const Slice *s, const Lanes *lanes, vlBsdfDirections wo, const float *lobe,
            vlBsdfSampled out) {
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float zo = vl_abs(wo.z[i]), zi = out.wi.z[i];
    int valid = (zo > 0.0f) & (zi > 0.0f);
    float on = valid ? 1.0f : 0.0f, off = 1.0f - on; /* products instead of selects, as above */
    vlVec3 o = vl_vec3(wo.x[i] * on, wo.y[i] * on, zo * on + off),
           w = vl_vec3(out.wi.x[i] * on, out.wi.y[i] * on, zi * on + off);
    float p = lanes->coat_share[i];
    int smooth = vl_ggx_is_smooth(s->ax[i], s->ay[i]) | (s->eta[i] == 1.0f),
        mirror = (lobe[i] < p) & smooth;
    CoatLobe above = coat_lobe(o, w, s->ax[i], s->ay[i], s->eta[i]);
    float m = mirror ? 1.0f : 0.0f, k = 1.0f - m; /* `above` is 0 for a smooth coat */
    float d = p * (above.coat_pdf + m) + (1.0f - p) * (w.z * VL_INV_PI) * k;
    float inverse = 1.0f / (d > VL_MIN_POSITIVE ? d : VL_MIN_POSITIVE);
    float top = above.coat + lanes->fresnel[i] * m,
          through = lanes->transmittance_i[i] * w.z * k;
    for (int c = 0; c < 4; c++)
      out.weight[c][i] = (top + lanes->base[c][i] * through) * inverse * on;
    out.pdf[i] = d * on;
    out.wi.z[i] = __builtin_copysignf(zi, wo.z[i]);
    int alive = valid & (d > 0.0f);
    uint32_t chosen = lobe[i] < p ? 0u : (uint32_t)VL_SAMPLED_DIFFUSE;
    out.flags[i] =
        alive ? (mirror ? (uint32_t)VL_SAMPLED_SPECULAR : chosen) : (uint32_t)VL_SAMPLED_NONE;
    out.eta_scale[i] = 1.0f;
  }
}

void vl_bsdf_coat_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                         vlBsdfRandom random, vlBsdfSampled out) {
  Lanes lanes;
  for (uint32_t first = 0; first < n; first += CHUNK) {
    Slice s = slice_of(params, n, first);
    vlBsdfDirections o = vl_directions_from(wo, first);
    vlBsdfRandom numbers = vl_random_from(random, first);
    vlBsdfSampled to = vl_sampled_from(out, first);
    weigh(&s, o, &lanes);
    choose(&s, &lanes, o, numbers, to.wi);
    look_up(&s, to.wi, &lanes, lanes.transmittance_i, OF_WI);
    settle(&s, &lanes, o, numbers.lobe, to);
  }
}
