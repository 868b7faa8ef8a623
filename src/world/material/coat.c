/* world/material/coat.c: the coat's tables by deterministic quadrature. Integrals over directions are transformed to
 * the unit square of visible-normal sampling, with weight G/G1. The nodes then follow the distribution of microfacets
 * for any roughness. */
#include "world/material/coat.h"

#include <string.h>

#include "base/isa.h"
#include "math/fresnel.h"
#include "math/ggx.h"

/* Quadrature sizes. Azimuths: midpoint rule over half a turn (symmetric). Elevations: Gauss-Legendre with v = 1 - s^2,
 * denser at the long tail of grazing microfacets. R has a kink at the inner critical angle and needs more nodes of
 * both. OUTER: cosines of the integral for R. */
enum { TURNS = 12, HEIGHTS = 24, TURNS_BACK = 24, HEIGHTS_BACK = 40, GRID = TURNS_BACK * HEIGHTS_BACK, OUTER = 32 };

typedef struct {
  int count;
  float u[GRID], v[GRID];
  double weight[GRID];
} Grid;
typedef struct {
  Grid out, back;            /* nodes for T, and for R */
  double x[OUTER], w[OUTER]; /* Gauss-Legendre on [0, 1] */
} Rules;

/* Nodes and weights on [0, 1], by Newton's method on the Legendre polynomial (Numerical Recipes 4.6). */
static void gauss_legendre(int n, double *x, double *w) {
  for (int i = 0; i < n; i++) {
    double z = -(double)vl_sincos(3.14159265f * ((float)i + 0.75f) / ((float)n + 0.5f)).cos, derivative = 1.0;
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

/* Mean over the visible normals for direction cosine c: the share of light that the rough interface transmits (transmit
 * != 0) or reflects, attenuated by the layer. eta: far side over near side. imitation (may be null) receives the same
 * mean with the sum of the two weights that pbrt-v4 gives a direction found by both of its samplers; see coat.h. */
static double interface_mean(const Grid *grid, int transmit, float c, float eta, float alpha, float tau,
                             double *imitation) {
  float part[GRID], excess[GRID];
  vlVec3 o = vl_vec3(__builtin_sqrtf(c < 1.0f ? 1.0f - c * c : 0.0f), 0.0f, c);
  float lo = vl_ggx_length(o, alpha, alpha);
  int count = grid->count;
  VL_SIMD for (int i = 0; i < count; i++) {
    vlVec3 h = vl_ggx_sample(o, alpha, alpha, grid->u[i], grid->v[i]);
    float oh = vl_dot(o, h);
    vlFresnel f = vl_fresnel_dielectric(oh, eta);
    float cos_t = f.root / eta, t = oh / eta - cos_t;
    float a = transmit ? t : 2.0f * oh, b = transmit ? 1.0f / eta : 1.0f;
    vlVec3 w = vl_vec3(a * h.x - b * o.x, a * h.y - b * o.y, a * h.z - b * o.z);
    w.z = transmit ? -w.z : w.z;
    float li = vl_ggx_length(w, alpha, alpha);
    float g = vl_ggx_shadowing(o.z, lo, w.z, li) * layer(tau, w.z);
    float share = transmit ? 1.0f - f.reflected : f.reflected;
    part[i] = ((oh > 0.0f) & (w.z > 0.0f)) ? share * g : 0.0f;
    /* Densities of w: transmission through the interface from outside (p), the base's cosine (d), transmission from
     * inside (q). */
    float p =
        vl_ggx_visible(h, alpha, alpha, o.z, lo) * oh * cos_t / (t * t > VL_MIN_POSITIVE ? t * t : VL_MIN_POSITIVE);
    float q = p * (lo + o.z) / ((li + w.z) * eta * eta), d = w.z * VL_INV_PI;
    float base2 = d * d;
    excess[i] = part[i] * (base2 / (base2 + q * q + VL_MIN_POSITIVE) - base2 / (base2 + p * p + VL_MIN_POSITIVE));
  }
  double sum = 0.0, more = 0.0;
  for (int i = 0; i < count; i++) {
    sum += (double)part[i] * grid->weight[i];
    more += (double)excess[i] * grid->weight[i];
  }
  if (imitation) *imitation = sum + more;
  return sum;
}

static double transmittance(const Rules *rules, float c, float eta, float alpha, float tau, double *imitation) {
  if (alpha >= VL_GGX_SMOOTH && eta != 1.0f) return interface_mean(&rules->out, 1, c, eta, alpha, tau, imitation);
  vlFresnel f = vl_fresnel_dielectric(c, eta);
  double t = eta == 1.0f ? (c > 0.0f ? layer(tau, c) : 0.0f) : (1.0f - f.reflected) * layer(tau, f.root / eta);
  return *imitation = t;
}

/* Reflectance of the interface from outside at cosine c, without the base. */
static double reflectance_outside(const Rules *rules, float c, float eta, float alpha) {
  if (eta == 1.0f) return 0.0;
  if (alpha >= VL_GGX_SMOOTH) return interface_mean(&rules->back, 0, c, eta, alpha, 0.0f, NULL);
  return (double)vl_fresnel_dielectric(c, eta).reflected;
}

/* Reflectance of the interface from inside at cosine c; the layer is traversed up and down. */
static double reflectance_inside(const Rules *rules, float c, float eta, float alpha, float tau) {
  if (eta == 1.0f) return 0.0;
  float l = layer(tau, c);
  if (alpha >= VL_GGX_SMOOTH) return (double)l * interface_mean(&rules->back, 0, c, 1.0f / eta, alpha, tau, NULL);
  return (double)(vl_fresnel_dielectric(c, 1.0f / eta).reflected * l * l);
}

/* R = int_0^1 2c r(c) dc. The integral is split at the critical angle, beyond which a smooth coat's reflectance
 * falls like a square root. */
static double back_share(const Rules *rules, float eta, float alpha, float tau) {
  double critical = eta > 1.0f ? (double)__builtin_sqrtf(1.0f - 1.0f / (eta * eta)) : 0.0, sum = 0.0;
  for (int i = 0; i < OUTER; i++) {
    double x = rules->x[i], below = critical * x, above = critical + (1.0 - critical) * x * x;
    if (critical > 0.0)
      sum += rules->w[i] * critical * 2.0 * below * reflectance_inside(rules, (float)below, eta, alpha, tau);
    sum += rules->w[i] * (1.0 - critical) * 2.0 * x * 2.0 * above *
           reflectance_inside(rules, (float)above, eta, alpha, tau);
  }
  return sum;
}

static double at_cosine(const float *t, double c) {
  vlCoatPlace p = vl_coat_place((float)c);
  const float *q = t + p.first;
  return (double)vl_coat_cubic(q[0], q[1], q[2], q[3], p.t);
}

static double escape_share(const Rules *rules, const float *t, float eta) {
  double sum = 0.0;
  for (int i = 0; i < OUTER; i++) sum += rules->w[i] * 2.0 * rules->x[i] * at_cosine(t, rules->x[i]);
  return sum / ((double)eta * (double)eta);
}

static void build_row(const Rules *rules, vlCoatTable *table, uint32_t row, float alpha) {
  float *t = table->transmittance[row];
  for (int i = 0; i < VL_COAT_COS; i++) {
    float x = (float)i / (float)(VL_COAT_COS - 1);
    double imitation;
    t[i] = (float)transmittance(rules, x * x * x * x, table->eta, alpha, table->tau, &imitation);
    table->imitation[row][i] = (float)imitation;
  }
  table->back[row] = (float)back_share(rules, table->eta, alpha, table->tau);
  table->escape[row] = (float)escape_share(rules, t, table->eta);
}

static float root(float x) {
  return __builtin_sqrtf(x > 0.0f ? x : 0.0f);
}

vlResult vl_coat_build(vlContext *context, float eta, float tau, uint32_t max_depth, float alpha_min, float alpha_max,
                       vlCoatTable **result) {
  if (!context || !result) return VL_ERROR_ARGUMENT;
  *result = NULL;
  if (!(eta > 0.0f && eta < VL_INFINITY && tau >= 0.0f && alpha_min >= 0.0f && alpha_max >= alpha_min &&
        alpha_max < VL_INFINITY))
    return VL_ERROR_ARGUMENT;
  vlCoatTable *table = vl_alloc_zero(context, 1, sizeof *table);
  Rules *rules = vl_alloc(context, sizeof *rules);
  if (!table || !rules) {
    vl_free(context, table);
    vl_free(context, rules);
    return VL_ERROR_MEMORY;
  }
  make_rules(rules);
  table->eta = eta;
  table->tau = tau;
  table->bounces = max_depth > 509 ? 255 : (max_depth + 1) / 2;
  table->alphas = alpha_max > alpha_min ? VL_COAT_ALPHA : 1;
  table->alpha_min = alpha_min;
  table->alpha_max = alpha_max;
  table->row_start = root(alpha_min);
  float step = (root(alpha_max) - table->row_start) / (float)(VL_COAT_ALPHA - 1);
  if (!(step > 0.0f)) table->alphas = 1;
  table->row_scale = table->alphas > 1 ? 1.0f / step : 0.0f;
  for (uint32_t row = 0; row < table->alphas; row++) {
    float a = table->row_start + (float)row * step;
    build_row(rules, table, row, table->alphas > 1 ? a * a : alpha_min);
  }
  vl_free(context, rules);
  *result = table;
  return VL_OK;
}

/* Like escape_share, but integrates the interpolated table by the midpoint rule over x = c^(1/4), so that it agrees
 * with lookups. */
static double escape_exactly(const float *t, float eta) {
  enum { CELLS = 16 * (VL_COAT_COS - 1) };
  double sum = 0.0;
  for (int i = 0; i < CELLS; i++) {
    double x = (i + 0.5) / CELLS, cube = x * x * x;
    sum += 8.0 * cube * cube * x * at_cosine(t, cube * x) / CELLS;
  }
  return sum / ((double)eta * (double)eta);
}

static float row_alpha(const vlCoatTable *table, uint32_t row) {
  float a = table->alphas > 1 ? table->row_start + (float)row / table->row_scale : 0.0f;
  return table->alphas > 1 ? a * a : table->alpha_min;
}

static void conserve_row(const Rules *rules, vlCoatTable *table, uint32_t row) {
  float eta = table->eta, alpha = row_alpha(table, row), *t = table->transmittance[row], through[VL_COAT_COS];
  double layers = 1.0, unused;
  memcpy(table->imitation[row], t, sizeof table->imitation[row]);
  if (alpha < VL_GGX_SMOOTH || eta == 1.0f) return; /* nothing is lost */
  for (int i = VL_COAT_COS; i-- > 0;) {
    float x = (float)i / (float)(VL_COAT_COS - 1),
          c = x * x * x * x > VL_MIN_FRACTION ? x * x * x * x : VL_MIN_FRACTION;
    through[i] = (float)(1.0 - reflectance_outside(rules, c, eta, alpha));
    double clear = table->tau > 0.0f ? transmittance(rules, c, eta, alpha, 0.0f, &unused) : 0.0;
    if (clear > 0.0) layers = (double)t[i] / clear; /* otherwise as at the previous cosine */
    t[i] = (float)layers;                           /* share that the layer transmits */
  }
  double escape = escape_exactly(through, eta), limit = escape > 1.0 ? 1.0 / escape : 1.0;
  for (int i = 0; i < VL_COAT_COS; i++) table->imitation[row][i] = t[i] = (float)(limit * (double)(t[i] * through[i]));
  double back = 1.0 - limit * escape, clear = table->tau > 0.0f ? back_share(rules, eta, alpha, 0.0f) : 0.0;
  table->back[row] = (float)(clear > 0.0 ? back * (double)table->back[row] / clear : back);
  table->escape[row] = (float)escape_exactly(t, eta);
}

vlResult vl_coat_conserve(vlContext *context, vlCoatTable *table) {
  if (!context || !table) return VL_ERROR_ARGUMENT;
  if (table->conserves) return VL_OK;
  Rules *rules = vl_alloc(context, sizeof *rules);
  if (!rules) return VL_ERROR_MEMORY;
  make_rules(rules);
  for (uint32_t row = 0; row < table->alphas; row++) conserve_row(rules, table, row);
  table->bounces = 255;
  table->conserves = true;
  vl_free(context, rules);
  return VL_OK;
}

vlResult vl_coat_white_albedo(vlContext *context, const vlCoatTable *table, double *albedo) {
  if (!context || !table || !albedo) return VL_ERROR_ARGUMENT;
  Rules *rules = vl_alloc(context, sizeof *rules);
  if (!rules) return VL_ERROR_MEMORY;
  make_rules(rules);
  double power = 1.0, series = 0.0, back = (double)table->back[0], sum = 0.0;
  for (uint32_t k = 0; k < table->bounces; k++) {
    series += power;
    power *= back;
  }
  for (int i = 0; i < OUTER; i++) {
    double c = rules->x[i], own = reflectance_outside(rules, (float)c, table->eta, row_alpha(table, 0));
    sum += rules->w[i] * 2.0 * c * (own + at_cosine(table->transmittance[0], c) * (double)table->escape[0] * series);
  }
  vl_free(context, rules);
  *albedo = sum;
  return VL_OK;
}

void vl_coat_free(vlContext *context, vlCoatTable *table) {
  vl_free(context, table);
}
