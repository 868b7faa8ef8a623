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
#define PASS static __attribute__((noinline)) void

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
  const float *r0, *r1, *r2, *r3, *ax, *ay, *eta;
  const vlCoatTable *const *coat;
  uint32_t count, live; /* number of lanes with padding (a multiple of VL_LANES), and without
                           (padding has no table) */
} Slice;

static Slice slice_of(const vlBsdfParams *p, uint32_t n, uint32_t first) {
  uint32_t left = VL_PAD(n) - first, count = left < CHUNK ? left : CHUNK;
  return (Slice){p->reflectance[0] + first,
                 p->reflectance[1] + first,
                 p->reflectance[2] + first,
                 p->reflectance[3] + first,
                 p->alpha_x + first,
                 p->alpha_y + first,
                 p->eta_s + first,
                 (const vlCoatTable *const *)p->coat + first,
                 count,
                 n - first < count ? n - first : count};
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
  float alpha =
      __builtin_sqrtf(vl_ggx_alpha(alpha_x) * vl_ggx_alpha(alpha_y)); /* textured roughness */
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
static void fetch_each(const Slice *s, const float *x, const float *y, Lanes *lanes,
                       Nodes *nodes, int of) {
  for (uint32_t i = 0; i < s->count; i++) {
    const vlCoatTable *table = s->coat[i < s->live ? i : 0];
    Row r = row_of(table, s->ax[i], s->ay[i], x[i], y[i]);
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

/* Looks up T at directions from `at` on, and for wo also the constants of the tables. */
PASS look_up(const Slice *s, vlBsdfDirections w, uint32_t at, Lanes *lanes, float *through,
             int of) {
  Nodes nodes;
  const float *x = w.x + at, *y = w.y + at, *z = w.z + at;
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    vlCoatCell p = vl_coat_cell(vl_abs(z[i]));
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
    fetch_each(s, x, y, lanes, &nodes, of);
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
static inline __attribute__((always_inline)) void weigh_loop(const Slice *s, const float *oz,
                                                             Lanes *lanes, const int bits) {
  const float *r0 = s->r0, *r1 = s->r1, *r2 = s->r2, *r3 = s->r3, *eta = s->eta;
  const float *through = lanes->transmittance_o, *back = lanes->back, *escape = lanes->escape;
  const int32_t *bounces = lanes->bounces;
  float *b0 = lanes->base[0], *b1 = lanes->base[1], *b2 = lanes->base[2], *b3 = lanes->base[3];
  float *share = lanes->coat_share, *fresnel = lanes->fresnel;
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float t = through[i], r = back[i], e = eta[i];
    int32_t k = bounces[i];
    float s0 = r0[i] * series(r0[i] * r, k, bits), s1 = r1[i] * series(r1[i] * r, k, bits);
    float s2 = r2[i] * series(r2[i] * r, k, bits), s3 = r3[i] * series(r3[i] * r, k, bits);
    float f = vl_fresnel_dielectric(vl_abs(oz[i]), e).reflected;
    f = e == 1.0f ? 0.0f : f;
    float albedo = t * escape[i] * (0.25f * ((s0 + s1) + (s2 + s3)));
    float sum = f + albedo;
    float scale = t * VL_INV_PI / (e * e);
    fresnel[i] = f;
    share[i] = f / (sum > 0.0f ? sum : 1.0f);
    b0[i] = s0 * scale;
    b1[i] = s1 * scale;
    b2[i] = s2 * scale;
    b3[i] = s3 * scale;
  }
}

PASS weigh(const Slice *s, vlBsdfDirections wo, uint32_t first, Lanes *lanes) {
  const float *oz = wo.z + first;
  look_up(s, wo, first, lanes, lanes->transmittance_o, OF_WO);
  int32_t all = 0;
  for (uint32_t i = 0; i < s->live; i++)
    all |= lanes->bounces[i];
  if (all < 8)
    weigh_loop(s, oz, lanes, 3);
  else
    weigh_loop(s, oz, lanes, 8);
}

/* The coat's lobe between o and w, both above the surface. */
typedef struct {
  float coat;     /* f |cos| of the coat's reflection, 0 when smooth */
  float coat_pdf; /* density of sampling w by this lobe */
} CoatLobe;
static inline __attribute__((always_inline)) CoatLobe coat_lobe(vlVec3 o, vlVec3 w,
                                                                float alpha_x, float alpha_y,
                                                                float eta) {
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
             float *const value[4], float *density, uint32_t first) {
  const float *ox = wo.x + first, *oy = wo.y + first, *oz = wo.z + first;
  const float *ix = wi.x + first, *iy = wi.y + first, *iz = wi.z + first;
  const float *ax = s->ax, *ay = s->ay, *eta = s->eta,
              *transmittance_i = lanes->transmittance_i, *share = lanes->coat_share;
  const float *b0 = lanes->base[0], *b1 = lanes->base[1], *b2 = lanes->base[2],
              *b3 = lanes->base[3];
  float *v0 = value[0] + first, *v1 = value[1] + first, *v2 = value[2] + first,
        *v3 = value[3] + first;
  float *pdf = density + first;
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    int valid = ((oz[i] > 0.0f) & (iz[i] > 0.0f)) | ((oz[i] < 0.0f) & (iz[i] < 0.0f));
    /* Products with 0 or 1 instead of selects: compilers would put the loads into branches. The
     * factor of 0 must be finite, so pairs that are not valid are replaced by directions along
     * the normal. */
    float on = valid ? 1.0f : 0.0f, off = 1.0f - on;
    float xo = ox[i], yo = oy[i], zo = vl_abs(oz[i]), xi = ix[i], yi = iy[i],
          zi = vl_abs(iz[i]);
    vlVec3 o = vl_vec3(xo * on, yo * on, zo * on + off),
           w = vl_vec3(xi * on, yi * on, zi * on + off);
    CoatLobe c = coat_lobe(o, w, ax[i], ay[i], eta[i]);
    float t = transmittance_i[i] * w.z;
    float p = share[i];
    float f0 = c.coat + b0[i] * t, f1 = c.coat + b1[i] * t, f2 = c.coat + b2[i] * t,
          f3 = c.coat + b3[i] * t;
    float d = p * c.coat_pdf + (1.0f - p) * (w.z * VL_INV_PI);
    v0[i] = f0 * on;
    v1[i] = f1 * on;
    v2[i] = f2 * on;
    v3[i] = f3 * on;
    pdf[i] = d * on;
  }
}

void vl_bsdf_coat_eval(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                       vlBsdfDirections wi, float *const value[4], float *pdf) {
  Lanes lanes;
  for (uint32_t first = 0; first < n; first += CHUNK) {
    Slice s = slice_of(params, n, first);
    weigh(&s, wo, first, &lanes);
    look_up(&s, wi, first, &lanes, lanes.transmittance_i, OF_LIGHT);
    combine(&s, &lanes, wo, wi, value, pdf, first);
  }
}

/* First half of sampling: chooses the lobe and samples the direction. wi.z is positive on the
 * side of wo. */
PASS choose(const Slice *s, const Lanes *lanes, vlBsdfDirections wo, const float *u_lobe,
            const float *u, const float *v, vlBsdfDirections wi, uint32_t first) {
  const float *ox = wo.x + first, *oy = wo.y + first, *oz = wo.z + first;
  const float *lobe = u_lobe + first, *uu = u + first, *vv = v + first;
  float *ix = wi.x + first, *iy = wi.y + first, *iz = wi.z + first;
  const float *ax = s->ax, *ay = s->ay, *eta = s->eta, *share = lanes->coat_share;
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    vlVec3 o = vl_vec3(ox[i], oy[i], vl_abs(oz[i]));
    int smooth = vl_ggx_is_smooth(ax[i], ay[i]) | (eta[i] == 1.0f);
    vlVec3 h = vl_ggx_sample(o, vl_ggx_alpha(ax[i]), vl_ggx_alpha(ay[i]), uu[i], vv[i]);
    h.x = smooth ? 0.0f : h.x;
    h.y = smooth ? 0.0f : h.y;
    h.z = smooth ? 1.0f : h.z;
    vlVec3 mirror = vl_reflect(o, h, vl_dot(o, h)), base = vl_cosine_direction(uu[i], vv[i]);
    int coat = lobe[i] < share[i];
    ix[i] = coat ? mirror.x : base.x;
    iy[i] = coat ? mirror.y : base.y;
    iz[i] = coat ? mirror.z : base.z;
  }
}

/* Second half of sampling: computes the weight of the direction, with the density of both
 * lobes. */
PASS settle(const Slice *s, const Lanes *lanes, vlBsdfDirections wo, const float *u_lobe,
            vlBsdfDirections wi, float *const weight[4], float *density, uint32_t *flags,
            uint32_t first) {
  const float *ox = wo.x + first, *oy = wo.y + first, *oz = wo.z + first,
              *lobe = u_lobe + first;
  float *ix = wi.x + first, *iy = wi.y + first, *iz = wi.z + first;
  const float *ax = s->ax, *ay = s->ay, *eta = s->eta,
              *transmittance_i = lanes->transmittance_i;
  const float *share = lanes->coat_share, *fresnel = lanes->fresnel;
  const float *b0 = lanes->base[0], *b1 = lanes->base[1], *b2 = lanes->base[2],
              *b3 = lanes->base[3];
  float *w0 = weight[0] + first, *w1 = weight[1] + first, *w2 = weight[2] + first,
        *w3 = weight[3] + first;
  float *pdf = density + first;
  uint32_t *flag = flags + first;
  uint32_t count = VL_WHOLE(s->count);
  /* must vectorise */
  VL_SIMD for (uint32_t i = 0; i < count; i++) {
    float xo = ox[i], yo = oy[i], zo = vl_abs(oz[i]), xi = ix[i], yi = iy[i], zi = iz[i];
    int valid = (zo > 0.0f) & (zi > 0.0f);
    float on = valid ? 1.0f : 0.0f, off = 1.0f - on; /* products instead of selects, as above */
    vlVec3 o = vl_vec3(xo * on, yo * on, zo * on + off),
           w = vl_vec3(xi * on, yi * on, zi * on + off);
    float p = share[i];
    int smooth = vl_ggx_is_smooth(ax[i], ay[i]) | (eta[i] == 1.0f),
        mirror = (lobe[i] < p) & smooth;
    CoatLobe c = coat_lobe(o, w, ax[i], ay[i], eta[i]);
    float t = transmittance_i[i] * w.z;
    float m = mirror ? 1.0f : 0.0f, k = 1.0f - m; /* c is 0 for a smooth coat */
    float d = p * (c.coat_pdf + m) + (1.0f - p) * (w.z * VL_INV_PI) * k;
    float inverse = 1.0f / (d > VL_MIN_POSITIVE ? d : VL_MIN_POSITIVE);
    float top = c.coat + fresnel[i] * m, through = t * k;
    float f0 = (top + b0[i] * through) * inverse, f1 = (top + b1[i] * through) * inverse;
    float f2 = (top + b2[i] * through) * inverse, f3 = (top + b3[i] * through) * inverse;
    w0[i] = f0 * on;
    w1[i] = f1 * on;
    w2[i] = f2 * on;
    w3[i] = f3 * on;
    pdf[i] = d * on;
    iz[i] = __builtin_copysignf(zi, oz[i]);
    int alive = valid & (d > 0.0f);
    uint32_t chosen = lobe[i] < p ? 0u : (uint32_t)VL_SAMPLED_DIFFUSE;
    flag[i] =
        alive ? (mirror ? (uint32_t)VL_SAMPLED_SPECULAR : chosen) : (uint32_t)VL_SAMPLED_NONE;
  }
}

void vl_bsdf_coat_sample(uint32_t n, const vlBsdfParams *params, vlBsdfDirections wo,
                         const float *u_lobe, const float *u, const float *v,
                         vlBsdfDirections wi, float *const weight[4], float *pdf,
                         uint32_t *flags, float *eta_scale) {
  Lanes lanes;
  for (uint32_t first = 0; first < n; first += CHUNK) {
    Slice s = slice_of(params, n, first);
    weigh(&s, wo, first, &lanes);
    choose(&s, &lanes, wo, u_lobe, u, v, wi, first);
    look_up(&s, wi, first, &lanes, lanes.transmittance_i, OF_WI);
    settle(&s, &lanes, wo, u_lobe, wi, weight, pdf, flags, first);
    for (uint32_t i = 0; i < s.count; i++)
      eta_scale[first + i] = 1.0f;
  }
}
