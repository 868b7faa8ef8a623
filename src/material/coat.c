/* material/coat.c: the coat's tables by deterministic quadrature. Integrals over
 * directions are transformed to the unit square of visible-normal sampling, with weight G/G1.
 * The nodes then follow the distribution of microfacets for any roughness. */
#include "material/coat.h"

#include <string.h>

#include "base/free.h"
#include "base/isa.h"
#include "math/fresnel.h"
#include "math/ggx.h"

/* Quadrature sizes. Azimuths: midpoint rule over half a turn (symmetric). Elevations:
 * Gauss-Legendre with v = 1 - s^2, denser at the long tail of grazing microfacets. R has a kink
 * at the inner critical angle and needs more nodes of both. OUTER: cosines of the integral for
 * R. */
enum {
  TURNS = 12,
  HEIGHTS = 24,
  TURNS_BACK = 24,
  HEIGHTS_BACK = 40,
  GRID = TURNS_BACK * HEIGHTS_BACK,
  OUTER = 32
};
/* Azimuths of means over all directions: midpoint rules over a quarter turn, of integrals and
 * of tables' rows. */
enum { QUARTER = 6, QUARTER_ROWS = 64 };

typedef struct {
  int count;
  float u[GRID], v[GRID];
  double weight[GRID];
} Grid;
/* An interface seen from one side, and the layer below it. */
typedef struct {
  float eta; /* far side over near side */
  float alpha_x, alpha_y, tau;
} Interface;
typedef struct {
  float sin, cos;
} Azimuth;

typedef struct {
  Grid out, back;            /* nodes for T, and for R */
  double x[OUTER], w[OUTER]; /* Gauss-Legendre on [0, 1] */
} Rules;

/* Nodes and weights on [0, 1], by Newton's method on the Legendre polynomial (Numerical Recipes
 * 4.6). */
static void gauss_legendre(int n, double *x, double *w) {
  for (int i = 0; i < n; i++) {
    double z = -(double)vl_sincos(3.14159265f * ((float)i + 0.75f) / ((float)n + 0.5f)).cos,
           derivative = 1.0;
    for (int step = 0; step < 8; step++) {
      double p0 = 1.0, p1 = z;
      for (int k = 2; k <= n; k++) {
        double p2 = ((2.0 * k - 1.0) * z * p1 - (k - 1.0) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      derivative = n * (z * p1 - p0) / (z * z - 1.0);
      z -= p1 / derivative;
    }
    x[i] = 0.5 * (1.0 + z);
    w[i] = 1.0 / ((1.0 - z * z) * derivative * derivative);
  }
}

static void make_grid(Grid *grid, int turns, int heights) {
  double s[HEIGHTS_BACK], w[HEIGHTS_BACK];
  gauss_legendre(heights, s, w);
  grid->count = turns * heights;
  for (int i = 0; i < heights; i++)
    for (int j = 0; j < turns; j++) {
      int k = i * turns + j;
      grid->u[k] = (float)((j + 0.5) / (2.0 * turns));
      grid->v[k] = (float)(1.0 - s[i] * s[i]);
      grid->weight[k] = 2.0 * s[i] * w[i] / turns;
    }
}

static void make_rules(Rules *rules) {
  gauss_legendre(OUTER, rules->x, rules->w);
  make_grid(&rules->out, TURNS, HEIGHTS);
  make_grid(&rules->back, TURNS_BACK, HEIGHTS_BACK);
}

static inline float layer(float tau, float c) {
  float down = c > VL_MIN_FRACTION ? c : VL_MIN_FRACTION;
  return vl_exp(-tau / down);
}

static inline bool is_smooth(const Interface *s) {
  return vl_ggx_is_smooth(s->alpha_x, s->alpha_y);
}

/* Mean over the visible normals for cosine c and azimuth a: the share of light that the rough
 * interface transmits (transmit != 0) or reflects, attenuated by the layer. side: 1 or -1; the
 * half turn of the normals that is summed. imitation (may be null) receives the same mean with
 * the sum of the two weights that pbrt-v4 gives a direction found by both of its samplers; see
 * coat.h. */
static double half_mean(const Grid *grid, int transmit, float c, Azimuth a, const Interface *s,
                        float side, double *imitation) {
  float part[GRID], excess[GRID];
  float sine = __builtin_sqrtf(c < 1.0f ? 1.0f - c * c : 0.0f);
  float eta = s->eta, tau = s->tau, ax = vl_ggx_alpha(s->alpha_x),
        ay = vl_ggx_alpha(s->alpha_y);
  vlVec3 o = vl_vec3(sine * a.cos, sine * a.sin, c);
  float lo = vl_ggx_length(o, ax, ay);
  int count = grid->count;
  VL_SIMD for (int i = 0; i < count; i++) {
    vlVec3 h =
        vl_ggx_sample(o, ax, ay, side > 0.0f ? grid->u[i] : 1.0f - grid->u[i], grid->v[i]);
    float oh = vl_dot(o, h);
    vlFresnel f = vl_fresnel_dielectric(oh, eta);
    float cos_t = f.root / eta, t = oh / eta - cos_t;
    float k = transmit ? t : 2.0f * oh, b = transmit ? 1.0f / eta : 1.0f;
    vlVec3 w = vl_vec3(k * h.x - b * o.x, k * h.y - b * o.y, k * h.z - b * o.z);
    w.z = transmit ? -w.z : w.z;
    float li = vl_ggx_length(w, ax, ay);
    float g = vl_ggx_shadowing(o.z, lo, w.z, li) * layer(tau, w.z);
    float share = transmit ? 1.0f - f.reflected : f.reflected;
    part[i] = ((oh > 0.0f) & (w.z > 0.0f)) ? share * g : 0.0f;
    /* Densities of w: transmission through the interface from outside (p), the base's cosine
     * (d), transmission from inside (q). */
    float p = vl_ggx_visible(h, ax, ay, o.z, lo) * oh * cos_t /
              (t * t > VL_MIN_POSITIVE ? t * t : VL_MIN_POSITIVE);
    float q = p * (lo + o.z) / ((li + w.z) * eta * eta), d = w.z * VL_INV_PI;
    float base2 = d * d;
    excess[i] = part[i] * (base2 / (base2 + q * q + VL_MIN_POSITIVE) -
                           base2 / (base2 + p * p + VL_MIN_POSITIVE));
  }
  double sum = 0.0, more = 0.0;
  for (int i = 0; i < count; i++) {
    sum += (double)part[i] * grid->weight[i];
    more += (double)excess[i] * grid->weight[i];
  }
  if (imitation)
    *imitation = sum + more;
  return sum;
}

/* The mean over all normals. Both halves are the same where the plane of incidence is one of
 * symmetry, as it always is if both alphas are equal. */
static double interface_mean(const Grid *grid, int transmit, float c, Azimuth a,
                             const Interface *s, double *imitation) {
  double one, other, sum = half_mean(grid, transmit, c, a, s, 1.0f, &one);
  if (s->alpha_x == s->alpha_y) {
    if (imitation)
      *imitation = one;
    return sum;
  }
  sum = 0.5 * (sum + half_mean(grid, transmit, c, a, s, -1.0f, &other));
  if (imitation)
    *imitation = 0.5 * (one + other);
  return sum;
}

static double transmittance(const Rules *rules, float c, Azimuth a, const Interface *s,
                            double *imitation) {
  if (!is_smooth(s) && s->eta != 1.0f)
    return interface_mean(&rules->out, 1, c, a, s, imitation);
  vlFresnel f = vl_fresnel_dielectric(c, s->eta);
  double t = s->eta == 1.0f ? (c > 0.0f ? layer(s->tau, c) : 0.0f)
                            : (1.0f - f.reflected) * layer(s->tau, f.root / s->eta);
  return *imitation = t;
}

/* Reflectance of the interface from outside at cosine c, without the base. */
static double reflectance_outside(const Rules *rules, float c, Azimuth a, const Interface *s) {
  if (s->eta == 1.0f)
    return 0.0;
  Interface bare = *s;
  bare.tau = 0.0f;
  if (!is_smooth(s))
    return interface_mean(&rules->back, 0, c, a, &bare, NULL);
  return (double)vl_fresnel_dielectric(c, s->eta).reflected;
}

/* Reflectance of the interface from inside at cosine c; the layer is traversed up and down. */
static double reflectance_inside(const Rules *rules, float c, Azimuth a, const Interface *s) {
  if (s->eta == 1.0f)
    return 0.0;
  float l = layer(s->tau, c);
  Interface inside = *s;
  inside.eta = 1.0f / s->eta;
  if (!is_smooth(s))
    return (double)l * interface_mean(&rules->back, 0, c, a, &inside, NULL);
  return (double)(vl_fresnel_dielectric(c, 1.0f / s->eta).reflected * l * l);
}

/* The i-th of n azimuths of a midpoint rule over a quarter turn, after which an interface
 * repeats itself, mirrored. */
static Azimuth azimuth_at(int i, int n) {
  vlSinCos x = vl_sincos_turn(0.25f * ((float)i + 0.5f) / (float)n);
  return (Azimuth){x.sin, x.cos};
}

/* R = int_0^1 2c r(c) dc, r the mean over azimuths. The integral is split at the critical
 * angle, beyond which a smooth coat's reflectance falls like a square root. */
static double back_share(const Rules *rules, const Interface *s) {
  double critical =
             s->eta > 1.0f ? (double)__builtin_sqrtf(1.0f - 1.0f / (s->eta * s->eta)) : 0.0,
         sum = 0.0;
  bool same = s->alpha_x == s->alpha_y;
  int azimuths = same ? 1 : QUARTER;
  for (int k = 0; k < azimuths; k++) {
    Azimuth a = same ? (Azimuth){0.0f, 1.0f} : azimuth_at(k, QUARTER);
    for (int i = 0; i < OUTER; i++) {
      double x = rules->x[i], below = critical * x, above = critical + (1.0 - critical) * x * x;
      if (critical > 0.0)
        sum += rules->w[i] * critical * 2.0 * below *
               reflectance_inside(rules, (float)below, a, s);
      sum += rules->w[i] * (1.0 - critical) * 2.0 * x * 2.0 * above *
             reflectance_inside(rules, (float)above, a, s);
    }
  }
  return sum / azimuths;
}

static double at_cosine(const float *t, double c) {
  vlCoatCell p = vl_coat_cell((float)c);
  const float *q = t + p.first;
  return (double)vl_coat_cubic(q[0], q[1], q[2], q[3], p.t);
}

static double escape_share(const Rules *rules, const float *t, float eta) {
  double sum = 0.0;
  for (int i = 0; i < OUTER; i++)
    sum += rules->w[i] * 2.0 * rules->x[i] * at_cosine(t, rules->x[i]);
  return sum / ((double)eta * (double)eta);
}

static float root(float x) {
  return __builtin_sqrtf(x > 0.0f ? x : 0.0f);
}

/* The interface and the azimuth that a row is for. */
static Interface row_interface(const vlCoatTable *table, uint32_t row) {
  float a = table->rows > 1 ? table->row_start + (float)row / table->row_scale : 0.0f;
  float alpha = table->rows > 1 ? a * a : table->alpha_min;
  if (!table->anisotropic)
    return (Interface){table->eta, alpha, alpha, table->tau};
  return (Interface){table->eta, table->rough_y ? table->alpha_min : table->alpha_max,
                     table->rough_y ? table->alpha_max : table->alpha_min, table->tau};
}

static Azimuth row_azimuth(const vlCoatTable *table, uint32_t row) {
  if (!table->anisotropic)
    return (Azimuth){0.0f, 1.0f};
  float x = (float)row / (float)(VL_COAT_AZIMUTHS - 1), rough = x * x,
        smooth = root(1.0f - rough * rough);
  return table->rough_y ? (Azimuth){rough, smooth} : (Azimuth){smooth, rough};
}

/* Sets a number of each row of an anisotropic table to its mean over azimuths, as lookups
 * interpolate it. */
static void average_azimuths(const vlCoatTable *table, float *of_row) {
  double sum = 0.0;
  if (!table->anisotropic)
    return;
  for (int i = 0; i < QUARTER_ROWS; i++) {
    float row = root(azimuth_at(i, QUARTER_ROWS).sin) * (float)(VL_COAT_AZIMUTHS - 1);
    uint32_t low = row < (float)(VL_COAT_AZIMUTHS - 2) ? (uint32_t)row : VL_COAT_AZIMUTHS - 2;
    double t = (double)row - low;
    sum += ((1.0 - t) * (double)of_row[low] + t * (double)of_row[low + 1]) / QUARTER_ROWS;
  }
  for (uint32_t row = 0; row < VL_COAT_AZIMUTHS; row++)
    of_row[row] = (float)sum;
}

static void build_row(const Rules *rules, vlCoatTable *table, uint32_t row) {
  float *t = table->transmittance[row];
  Interface s = row_interface(table, row);
  Azimuth a = row_azimuth(table, row);
  for (int i = 0; i < VL_COAT_COS; i++) {
    float x = (float)i / (float)(VL_COAT_COS - 1);
    double imitation;
    t[i] = (float)transmittance(rules, x * x * x * x, a, &s, &imitation);
    table->imitation[row][i] = (float)imitation;
  }
  table->back[row] = table->anisotropic && row > 0
                         ? table->back[0]
                         : (float)back_share(rules, &s); /* the same for each azimuth */
  table->escape[row] = (float)escape_share(rules, t, table->eta);
}

/* Builds the rows of a table whose ranges are given. Takes the table. */
static vlResult build_rows(vlContext *context, const vlCoatTable *ranges,
                           vlCoatTable **result) {
  vlCoatTable *table = vl_alloc(context, sizeof *table);
  Rules *rules = vl_alloc(context, sizeof *rules);
  if (!table || !rules) {
    VL_FREE(context, table, rules);
    return VL_ERROR_MEMORY;
  }
  *table = *ranges;
  make_rules(rules);
  for (uint32_t row = 0; row < table->rows; row++)
    build_row(rules, table, row);
  average_azimuths(table, table->escape);
  vl_free(context, rules);
  *result = table;
  return VL_OK;
}

static uint32_t bounces_of(uint32_t max_depth) {
  return max_depth > 509 ? 255 : (max_depth + 1) / 2;
}

vlResult vl_coat_build(vlContext *context, float eta, float tau, uint32_t max_depth,
                       float alpha_min, float alpha_max, vlCoatTable **result) {
  if (!context || !result)
    return VL_ERROR_ARGUMENT;
  *result = NULL;
  if (!(eta > 0.0f && eta < VL_INFINITY && tau >= 0.0f && alpha_min >= 0.0f &&
        alpha_max >= alpha_min && alpha_max < VL_INFINITY))
    return VL_ERROR_ARGUMENT;
  float start = root(alpha_min), step = (root(alpha_max) - start) / (float)(VL_COAT_ALPHA - 1);
  bool range = alpha_max > alpha_min && step > 0.0f;
  const vlCoatTable ranges = {.eta = eta,
                              .tau = tau,
                              .bounces = bounces_of(max_depth),
                              .rows = range ? VL_COAT_ALPHA : 1,
                              .alpha_min = alpha_min,
                              .alpha_max = alpha_max,
                              .row_start = start,
                              .row_scale = range ? 1.0f / step : 0.0f};
  return build_rows(context, &ranges, result);
}

vlResult vl_coat_build_anisotropic(vlContext *context, float eta, float tau, uint32_t max_depth,
                                   float alpha_x, float alpha_y, vlCoatTable **result) {
  bool rough_y = alpha_y > alpha_x;
  float low = rough_y ? alpha_x : alpha_y, high = rough_y ? alpha_y : alpha_x;
  if (alpha_x == alpha_y || !(low >= 0.0f && high < VL_INFINITY) ||
      !(eta > 0.0f && eta < VL_INFINITY && tau >= 0.0f))
    return vl_coat_build(context, eta, tau, max_depth, low, high, result);
  if (!context || !result)
    return VL_ERROR_ARGUMENT;
  *result = NULL;
  const vlCoatTable ranges = {.eta = eta,
                              .tau = tau,
                              .bounces = bounces_of(max_depth),
                              .rows = VL_COAT_AZIMUTHS,
                              .alpha_min = low,
                              .alpha_max = high,
                              .anisotropic = true,
                              .rough_y = rough_y};
  return build_rows(context, &ranges, result);
}

/* Like escape_share, but integrates the interpolated table by the midpoint rule over x =
 * c^(1/4), so that it agrees with lookups. */
static double escape_exactly(const float *t, float eta) {
  enum { CELLS = 16 * (VL_COAT_COS - 1) };
  double sum = 0.0;
  for (int i = 0; i < CELLS; i++) {
    double x = (i + 0.5) / CELLS, cube = x * x * x;
    sum += 8.0 * cube * cube * x * at_cosine(t, cube * x) / CELLS;
  }
  return sum / ((double)eta * (double)eta);
}

/* First half of conserving: a row of T becomes the share that the layer transmits; through
 * receives what the interface does not reflect, escape what of the base's light passes it. */
static void conserve_row(const Rules *rules, vlCoatTable *table, uint32_t row, float *through,
                         float *escape) {
  Interface s = row_interface(table, row), clear = s;
  Azimuth a = row_azimuth(table, row);
  float *t = table->transmittance[row];
  double layers = 1.0, unused;
  clear.tau = 0.0f;
  for (int i = VL_COAT_COS; i-- > 0;) {
    float x = (float)i / (float)(VL_COAT_COS - 1),
          c = x * x * x * x > VL_MIN_FRACTION ? x * x * x * x : VL_MIN_FRACTION;
    through[i] = (float)(1.0 - reflectance_outside(rules, c, a, &s));
    double all = s.tau > 0.0f ? transmittance(rules, c, a, &clear, &unused) : 0.0;
    if (all > 0.0)
      layers = (double)t[i] / all; /* otherwise as at the previous cosine */
    t[i] = (float)layers;          /* share that the layer transmits */
  }
  *escape = (float)escape_exactly(through, table->eta);
}

/* Second half, with the mean escape of all azimuths. */
static void limit_row(const Rules *rules, vlCoatTable *table, uint32_t row,
                      const float *through, double escape) {
  Interface clear = row_interface(table, row);
  float *t = table->transmittance[row];
  clear.tau = 0.0f;
  double limit = escape > 1.0 ? 1.0 / escape : 1.0;
  for (int i = 0; i < VL_COAT_COS; i++)
    table->imitation[row][i] = t[i] = (float)(limit * (double)(t[i] * through[i]));
  double back = 1.0 - limit * escape, all = table->tau > 0.0f ? back_share(rules, &clear) : 0.0;
  table->back[row] = (float)(all > 0.0 ? back * (double)table->back[row] / all : back);
  table->escape[row] = (float)escape_exactly(t, table->eta);
}

vlResult vl_coat_conserve(vlContext *context, vlCoatTable *table) {
  if (!context || !table)
    return VL_ERROR_ARGUMENT;
  if (table->conserves)
    return VL_OK;
  typedef struct {
    Rules rules;
    float through[VL_COAT_ALPHA][VL_COAT_COS], escape[VL_COAT_ALPHA];
  } Work;
  Work *work = vl_alloc(context, sizeof *work);
  if (!work)
    return VL_ERROR_MEMORY;
  make_rules(&work->rules);
  bool lossy[VL_COAT_ALPHA];
  for (uint32_t row = 0; row < table->rows; row++) {
    Interface s = row_interface(table, row);
    lossy[row] = !is_smooth(&s) && table->eta != 1.0f;
    if (lossy[row])
      conserve_row(&work->rules, table, row, work->through[row], &work->escape[row]);
    else
      memcpy(table->imitation[row], table->transmittance[row], sizeof table->imitation[row]);
  }
  average_azimuths(table, work->escape);
  for (uint32_t row = 0; row < table->rows; row++)
    if (lossy[row])
      limit_row(&work->rules, table, row, work->through[row], (double)work->escape[row]);
  average_azimuths(table, table->escape);
  table->bounces = 255;
  table->conserves = true;
  vl_free(context, work);
  return VL_OK;
}

vlResult vl_coat_white_albedo(vlContext *context, const vlCoatTable *table, double *albedo) {
  if (!context || !table || !albedo)
    return VL_ERROR_ARGUMENT;
  Rules *rules = vl_alloc(context, sizeof *rules);
  if (!rules)
    return VL_ERROR_MEMORY;
  make_rules(rules);
  double power = 1.0, series = 0.0, back = (double)table->back[0];
  float of_row[VL_COAT_ALPHA];
  for (uint32_t k = 0; k < table->bounces; k++) {
    series += power;
    power *= back;
  }
  for (uint32_t row = 0; row < (table->anisotropic ? table->rows : 1); row++) {
    Interface s = row_interface(table, row);
    Azimuth a = row_azimuth(table, row);
    double sum = 0.0;
    for (int i = 0; i < OUTER; i++) {
      double c = rules->x[i], own = reflectance_outside(rules, (float)c, a, &s);
      double base = at_cosine(table->transmittance[row], c) * (double)table->escape[0] * series;
      sum += rules->w[i] * 2.0 * c * (own + base);
    }
    of_row[row] = (float)sum;
  }
  average_azimuths(table, of_row);
  vl_free(context, rules);
  *albedo = (double)of_row[0];
  return VL_OK;
}

void vl_coat_free(vlContext *context, vlCoatTable *table) {
  vl_free(context, table);
}
